"""Errors of methods under study over their settings."""

from functools import cache

import kinetostatics as ks
from kinetostatics.studies import precision
from kinetostatics.studies.methods import METHODS

FEW = [
    method
    for method in METHODS
    if method.name
    in (
        "ours, NumPy",
        "ours, torque by powers",
        "differences, 2nd order",
        "differences, 4th order",
        "spectral differentiation",
        "harmonic series",
        "two-mass coupler",
    )
]


@cache
def torque_study():
    """The study of one case, the plain sawframe."""
    return precision.study(ks.load_case("sawframe_2r63").solve("plain", 48), methods=FEW, repeats=1)
