"""How long a function takes, and where that was measured."""

import platform
import time

import numpy as np

from kinetostatics.studies import timing


def test_times_are_those_of_one_call_and_in_order():
    short, long = timing.seconds(lambda: time.sleep(0.001), lambda: time.sleep(0.004), repeats=1)
    assert 0.001 <= short < long
    assert 0.004 <= long < 0.4


def test_machine_and_versions_are_told():
    found = timing.circumstances()
    assert f"numpy {np.__version__}" in found["versions"]
    assert platform.python_version() in found["versions"]
    assert "cores" in found["machine"]
