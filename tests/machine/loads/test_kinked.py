"""Loads with kinks and periods."""

import pickle
import re
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import Table, has_significant_kinks, kink_sources, period_on
from support.every import every
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


@every("kind", LOADS)
def test_a_pulse_that_is_declared_is_swept_whole(kind):
    scene = ks.Scene(PUMP, 30.0, loads=[LOADS[kind]])
    outputs = ["largest B", "smallest_at balancing_torque", "mean balancing_torque"]
    found = sweep(scene, pd.DataFrame({"slider.mass": [1.0, 2.0]}), outputs, engine="numpy")
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


@every("declared", OUTSIDE)
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


@every("declared", [None, [1.0, 2.0, 3.0], ([np.nan], [1.0]), ([], [np.inf]), (["a"], []), ([1j], [])])
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


# Forces by a table over one turn or several

TURN = 2 * np.pi
STROKES = np.radians([0, 170, 180, 190, 360, 720])
GAS = np.array([0.0, 0.0, -5e3, -1e3, 0.0, 0.0])
"""A power stroke in the first turn, nothing in the second."""

CASE = """
title = "engine"
reference = "a"
[variants.a]
mechanism = "crank-slider"
crank_speed = "1500 rpm"
crank_length = "40 mm"
coupler_length = "140 mm"
slider = { mass = "0.5 kg" }
"""


def pushed(table, angle):
    machine = ks.crank_slider(0.04, 0.14)
    solution = ks.solve(machine, angle, crank_speed=100.0, loads=ks.ProcessForce(table, period=table.period))
    return table(solution)


def written(folder, angles, forces, period=""):
    rows = (f"{angle!r}, {force!r}" for angle, force in zip(np.degrees(angles).tolist(), forces.tolist(), strict=True))
    (folder / "gas.csv").write_text("\n".join(["crank_angle [deg], force [N]", *rows]))
    told = f', period = "{period}"' if period else ""
    (folder / "case.toml").write_text(CASE + f'process_force = {{ table = "gas.csv"{told} }}')
    return folder / "case.toml"


def test_a_table_is_linear_and_periodic():
    table = Table(np.radians([0, 90, 180, 270]), np.array([0.0, 10.0, 4.0, -2.0]))
    angle = np.radians([0, 45, 90, 315, 360 + 45, -45])
    assert pushed(table, angle) == pytest.approx([0, 5, 10, -1, 5, -1], abs=1e-12)


def test_a_table_over_two_turns_is_not_folded_to_one():
    table = Table(STROKES, GAS, period=2 * TURN)
    angle = np.radians([175, 175 + 360, 175 + 720, 175 - 360, 180, 540])
    assert pushed(table, angle) == pytest.approx([-2500, 0, -2500, 0, -5000, 0], abs=1e-9)


def test_period_end_is_optional_and_angles_may_fall():
    closed, left_out, falling = (
        Table(*rows, period=2 * TURN)
        for rows in ((STROKES, GAS), (np.append(STROKES[:-1], 3 * np.pi), GAS), (STROKES[::-1], GAS[::-1]))
    )
    angle = np.linspace(-3.0, 20.0, 500)
    for other in (left_out, falling):
        np.testing.assert_allclose(pushed(other, angle), pushed(closed, angle), rtol=0, atol=1e-9)
    assert closed.x.size == 5


def test_an_end_rounded_in_radians_counts_as_the_start():
    angle = np.round(np.linspace(0, TURN, 37), 3)
    assert Table(angle, np.sin(angle) * (angle < 6.28)).x.size == 36


def test_tables_are_frozen_comparable_and_pickled():
    table, same = (Table(STROKES, GAS, period=2 * TURN) for _ in range(2))
    assert table == same == pickle.loads(pickle.dumps(table))
    assert hash(table) == hash(same)
    assert table != Table(STROKES, 2 * GAS, period=2 * TURN)
    assert table != 3
    with pytest.raises(ValueError, match="read-only"):
        table.y[0] = 1.0
    with pytest.raises(AttributeError):
        table.period = TURN


@every("turns", [1, 2, 3, 7])
def test_whole_turns_are_taken_up_to_rounding(turns):
    assert ks.ProcessForce(1.0).period == TURN
    assert ks.ProcessForce(1.0, period=turns * TURN * (1 + 1e-12)).period == turns * TURN


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow)])
def test_four_stroke_gas_force_acts_every_other_turn(tmp_path, engine):
    if engine == "compiled":
        pytest.importorskip("numba")
    variant = ks.load_case(written(tmp_path, STROKES, GAS, "720 deg")).variants["a"]
    (load,) = variant.loads
    assert load.period == 2 * TURN
    angle = np.linspace(0.0, 2 * TURN, 144, endpoint=False)
    with_gas, without = (
        ks.solve(variant.mechanism, angle, crank_speed=variant.crank_speed, loads=loads, engine=engine)
        for loads in (variant.loads, ())
    )
    expected = np.interp(angle, STROKES, GAS) * with_gas.slider_velocity / variant.crank_speed
    np.testing.assert_allclose(with_gas.balancing_torque, without.balancing_torque - expected, rtol=0, atol=1e-9)


@pytest.mark.slow
def test_a_table_changed_after_loading_changes_nothing(tmp_path):
    """Neither solutions nor sweeps, in this process or in others."""
    angle, designs = np.radians(np.arange(0, 360, 10)), pd.DataFrame({"slider.mass": [0.4, 0.6]})
    case = ks.load_case(written(tmp_path, angle, 1e3 * np.sin(angle)))

    def results(executor=None):
        swept = ks.sweep(
            case, designs, ["mean_absolute balancing_torque"], angles=36, executor=executor, progress=False
        )
        return case.solve("a", 36).balancing_torque.tolist(), swept.iloc[:, 1].tolist()

    before = results()
    written(tmp_path, angle, 5e3 * np.cos(angle))
    assert results() == before
    (tmp_path / "gas.csv").unlink()
    with ProcessPoolExecutor(1) as executor:
        assert results(executor) == before
    assert case.variants["a"].varied({"slider.mass": 0.5}).loads[0].force == case.variants["a"].loads[0].force
