"""What tests of sweeps share: a case, a sweep without a bar, tables compared bit by bit."""

from functools import partial

import pandas as pd

import kinetostatics as ks
from support.shipped import shipped

SAW = shipped("sawframe_2r63")
sweep = partial(ks.sweep, progress=False)


def assert_equal(found, expected):
    pd.testing.assert_frame_equal(found, expected, check_exact=True)


def rising(count=200):
    """Designs of the sawframe of which every tenth cannot be."""
    designs = ks.designs.latin_hypercube({"coupler_length": "0.5..2.5 m", "slider.mass": "100..900 kg"}, count)
    designs.loc[::10, "slider.mass [kg]"] *= -1
    return designs
