"""The sawframe under its motor, methods for its running by name, and its speed to many digits."""

import json
import math

import numpy as np

import kinetostatics as ks
from kinetostatics.studies.methods import running

from . import DATA

REFERENCE = json.loads((DATA / "driven_sawframe.json").read_text(encoding="utf-8"))
TURN = 2 * math.pi
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
FAN = ks.Torque(lambda motion: -2.0 * motion.crank_speed * motion.crank_speed, on="crank")
CUT = ks.ProcessForce(ks.Table(np.linspace(0.0, TURN, 41)[:-1], 4e3 + 4e3 * np.sin(TURN / 40 * np.arange(40))))
IDLE = ks.Scene(SAW, 33.5, loads=ks.Gravity())
ANGLES = np.arange(24) * np.pi / 12
BY_NAME = {method.name: method for method in running.METHODS}


def saw(*loads):
    """The saw at 33 rad/s under its weight and more."""
    return ks.Scene(SAW, 33.0, loads=(ks.Gravity(), *loads))
