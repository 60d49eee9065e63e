"""Forces by a table over one turn or several: what is read between its rows, and from a case file."""

import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import Table

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
    closed, left_out = (
        Table(STROKES, GAS, period=2 * TURN),
        Table(np.append(STROKES[:-1], 3 * np.pi), GAS, period=2 * TURN),
    )
    falling = Table(STROKES[::-1], GAS[::-1], period=2 * TURN)
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


@pytest.mark.parametrize("turns", [1, 2, 3, 7])
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
