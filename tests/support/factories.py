"""Designs of sweeps and functions that make them, in a module that workers are quick to import."""

import math
import os
import signal
import time
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

import kinetostatics as ks

OUTPUTS = ["largest O", "mean_absolute balancing_torque"]
DESIGNS = pd.DataFrame({"crank [mm]": np.linspace(100.0, 500.0, 41), "mass": np.linspace(1.0, 9.0, 41)})


def pump(crank, mass=1.0, speed=100.0):
    """A crank-slider with a coupler four times the crank."""
    return ks.Scene(ks.crank_slider(crank, 4.0 * crank, slider=ks.Link(mass)), speed, 0.0, (ks.Gravity(),))


def by_plain_numbers(crank, mass):
    """The same by what takes no arrays."""
    return pump(math.hypot(crank, 0.0), math.sqrt(mass) ** 2)


def picky(crank, mass):
    """The same for some masses only, without telling which of an array are wrong."""
    if np.any((crank < 0.3) & (mass > 5.0)):
        raise ValueError(f"a crank of {float(np.min(crank)):g} m does not carry {float(np.max(mass)):g} kg")
    return pump(crank, mass)


def _deadly(crank, mass, at, marker=None):
    if np.any(np.isin(crank, at)) and not (marker and Path(marker).exists()):
        if marker:
            Path(marker).touch()
        die()
    return pump(crank, mass)


def deadly(*at):
    """A function whose process dies whenever it makes one of these cranks."""
    return partial(_deadly, at=at)


def deadly_once(at, marker):
    """A function whose process dies when it makes this crank the first time."""
    return partial(_deadly, at=at, marker=str(marker))


def slow(crank, mass):
    """The same after a while, with the number of this process written down as the name of a file."""
    Path(os.environ["KINETOSTATICS_TEST_NOTES"], str(os.getpid())).touch()
    time.sleep(0.1)
    return pump(crank, mass)


def die():
    """Kill this process, and no other."""
    os.kill(os.getpid(), signal.SIGKILL)


class Poison:
    """A function that no other process survives to receive."""

    def __call__(self, crank, mass):
        """As others do."""
        return pump(crank, mass)

    def __reduce__(self):
        return die, ()
