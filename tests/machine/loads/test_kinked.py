"""What loads declare of their kinks: tables, functions of the motion, loads of the user's own; others declare none."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import has_significant_kinks, kink_sources, period_on
from support.sweeping import sweep

PUMP = ks.crank_slider(0.05, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0))


def push(motion):
    """A force that is there for a thousandth of a degree."""
    angle = np.mod(motion.crank_angle, 2 * np.pi)
    return np.where((angle > 1.0) & (angle < 1.0 + 2e-5), 4e4, 0.0)


class Pulse:
    """The same, which declares where it jumps."""

    def __call__(self, motion):
        """Force, N."""
        return push(motion)

    def kinks(self, motion):
        """No kinks, and two jumps."""
        return np.empty(0), np.array([1.0, 1.0 + 2e-5])


class Knock:
    """A load of the user's own that does so itself."""

    on = "slider"

    def push(self, motion):
        """Force, N."""
        return push(motion)

    def kinks(self, motion):
        """As of the pulse."""
        return Pulse().kinks(motion)


LOADS = {"value": ks.ProcessForce(Pulse()), "load": Knock()}


def test_what_declares_kinks_is_found_and_nothing_else():
    table = ks.ProcessForce(ks.Table([0.0, 1.0, 2.0, 2 * np.pi], [0.0, 1.0, 0.0, 0.0]))
    found = kink_sources([ks.Gravity(), table, ks.ProcessForce(push), *LOADS.values()])
    assert found == [table.force, LOADS["value"].force, LOADS["load"]]
    assert has_significant_kinks(found[1], 1e-5)
    assert period_on(found[1], PUMP) == 2 * np.pi


@pytest.mark.parametrize("kind", LOADS)
def test_a_pulse_that_is_declared_is_swept_whole(kind):
    scene = ks.Scene(PUMP, 30.0, loads=[LOADS[kind]])
    designs, outputs = (
        pd.DataFrame({"slider.mass": [1.0, 2.0]}),
        ["largest B", "smallest_at balancing_torque", "mean balancing_torque"],
    )
    found = sweep(scene, designs, outputs, engine="numpy")
    assert found["failed"].tolist() == ["", ""]
    middle = ks.solve(PUMP, 1.0 + 1e-5, crank_speed=30.0, loads=[LOADS[kind]])
    assert found["largest B [N]"][1] == pytest.approx(float(np.hypot(*middle.reaction("B"))), rel=1e-4)
    work = -4e4 * float(middle.slider_velocity) / 30.0 * 2e-5
    assert found["mean balancing_torque [N m]"][1] == pytest.approx(work / (2 * np.pi), rel=1e-4)


def test_extremes_know_a_pulse_that_is_declared():
    s = ks.solve(PUMP, 0.0, crank_speed=30.0, loads=[LOADS["value"]])
    middle = s.at(np.array([1.0 + 1e-5]))
    assert ks.extremes(s, "B").largest == pytest.approx(float(np.hypot(*middle.reaction("B"))[0]), rel=1e-4)


class Declaring(Pulse):
    """A pulse that declares whatever it is told."""

    def __init__(self, declared):
        self.declared = declared

    def kinks(self, motion):
        """As told."""
        return self.declared


OUTSIDE = ([8.0], [1.0 - 4 * np.pi, 1.0 + 2e-5 + 2 * np.pi, -1.0]), ([9.0, -20.0], [[1.0], [1.0 + 2e-5]])


@pytest.mark.parametrize("declared", OUTSIDE)
def test_kinks_outside_the_period_are_wrapped(declared):
    tables = [
        sweep(
            ks.Scene(PUMP, 30.0, loads=ks.ProcessForce(pulse)),
            pd.DataFrame({"slider.mass": [1.0, 2.0]}),
            ["mean balancing_torque", "rms O"],
            engine="numpy",
        )
        for pulse in (Pulse(), Declaring(declared))
    ]
    assert tables[1]["failed"].tolist() == ["", ""]
    for name in ("mean balancing_torque [N m]", "rms O [N]"):
        assert tables[1][name].to_numpy() == pytest.approx(tables[0][name].to_numpy(), rel=1e-9)


@pytest.mark.parametrize(
    "declared", [None, [1.0, 2.0, 3.0], ([np.nan], [1.0]), ([], [np.inf]), (["a"], []), ([1j], [])]
)
def test_wrong_kink_angles_are_refused_by_name(declared):
    s = ks.solve(PUMP, 0.0, crank_speed=30.0, loads=ks.ProcessForce(Declaring(declared)))
    with pytest.raises(ks.ParameterError, match=r"Declaring\.kinks must return two arrays of finite crank angles"):
        ks.extremes(s, "O")


def test_documented_narrow_load_is_seen():
    page = Path(__file__).parents[3] / "docs" / "api" / "loads.md"
    names = {"ks": ks, "np": np}
    exec(re.search("```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)[1], names)
    s = ks.solve(PUMP, 0.0, crank_speed=30.0, loads=ks.ProcessForce(names["Knock"]()))
    assert ks.extremes(s, "B").largest > 3e4
