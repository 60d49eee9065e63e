"""Commands that are refused: a case with a file of its own, and the one error that a command ends with."""

import math

from kinetostatics.cli import main

TEXT = """
title = "Säge, пила, 鋸"
reference = "plain"
[common]
crank_speed = "60 rpm"
coupler_length = "2 m"
slider = { mass = "600 kg" }
[variants.plain]
mechanism = "crank-slider"
crank_length = "0.3 m"
[variants.cam]
mechanism = "cam-crank-slider"
cam = { kind = "sampled", table = "saw_precision.csv" }
"""
CAM = "\n".join(["angle [deg], radius [m]", *(f"{a}, {0.3 + 0.01 * math.cos(math.radians(a))}" for a in range(360))])
VARY = ["--vary", "slider.mass=600..700 kg:2"]


def refused(arguments, capsys):
    """The one error that a command ends with."""
    status = main([str(item) for item in arguments])
    captured = capsys.readouterr()
    assert (status, captured.out) == (2, "")
    assert captured.err.startswith("kinetostatics: ")
    assert "Traceback" not in captured.err
    return captured.err
