"""Errors of methods under study over their settings."""

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
