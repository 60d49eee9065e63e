"""The search: starts, limits, fronts, what it finds and reports, and demands that cannot be met."""

import re

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.cycle.reductions import parsed
from kinetostatics.design import problem, search
from kinetostatics.design.constraints import Constraint, parse_constraint
from support.improved_saws import CAM, CIRCLE, ENDS, FORCE, FRONT_OF, RATIO, SAW, SPRING, TORQUE, bound, front

pytestmark = pytest.mark.slow


def test_starts_agree_and_the_seed_repeats_them():
    one, other = (
        ks.design.optimise(SAW, SPRING, TORQUE, variant="cam-circle", starts=4, seed=3, angles=360) for _ in range(2)
    )
    assert one.starts == other.starts
    assert_allclose(one.starts, one.starts[0], rtol=1e-6)


def test_demands_end_with_how_near_the_best_comes():
    with pytest.raises(ks.DesignError, match=r"nearest misses ratio .* >= 100, where it is 52\.8") as error:
        ks.design.optimise(SAW, SPRING, TORQUE, limits=f"{RATIO} >= 100", variant="cam-circle", angles=180)
    assert set(error.value.values) == {"spring.stiffness"}


class Circle:
    """Numbers within bounds, and by how much the sum of their squares exceeds a limit."""

    def __init__(self, high):
        self.low, self.high, self.parts = np.zeros(2), np.array(high), {"": self}

    def duty(self, _):
        """The same: there are no duties."""
        return self

    def output(self, output, values):
        """The sum of squares, and its derivatives."""
        return float(values @ values), 2.0 * values


LIMIT = Constraint(parsed("mean_absolute balancing_torque"), "<=", 1.0)


def test_a_small_miss_is_corrected_least():
    values = search.restore_limits(Circle([2.0, 2.0]), [LIMIT], np.array([0.6, 0.8]) * (1.0 + 1e-6))
    assert_allclose(values, [0.6, 0.8], rtol=1e-12)
    kept = np.array([0.3, 0.4])
    assert search.restore_limits(Circle([2.0, 2.0]), [LIMIT], kept) is kept


def test_what_is_made_good_stays_within_its_bounds():
    level = Constraint(LIMIT.output, "=", 1.0)
    values = search.restore_limits(Circle([0.6, 2.0]), [level], np.array([0.6, 0.8 - 1e-6]))
    assert_allclose(values, [0.6, 0.8], rtol=1e-12)
    assert values[0] <= 0.6


def test_what_has_no_derivatives_is_not_made_good():
    class Corner(Circle):
        def output(self, output, values):
            found, slopes = super().output(output, values)
            return found, np.nan * slopes

    missed = np.array([0.6, 0.8]) * (1.0 + 1e-6)
    assert search.restore_limits(Corner([2.0, 2.0]), [LIMIT], missed) is missed


# Texts of what is asked of a design


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("largest O <= 0.75 kN", ("<=", 750.0)),
        ("largest O ≤ 750 N", ("<=", 750.0)),
        ("  smallest cam_force >= -2 kN ", (">=", -2000.0)),
        ("largest slider_position == 2300 mm", ("=", 2.3)),
        ("largest_absolute pressure_angle <= 30 deg", ("<=", np.pi / 6)),
        (f"{RATIO} >= 50", (">=", 50.0)),
    ],
)
def test_limits_are_read_with_their_units(text, expected):
    found = parse_constraint(text, CIRCLE.scene)
    assert (found.relation, found.value) == (expected[0], pytest.approx(expected[1], rel=1e-15))


# What a search found


def test_report_shows_before_and_after_and_what_binds():
    table = bound().report()
    assert_allclose(
        table.loc[f"{RATIO} [1]", "before"], SAW.compare("plain", "cam-circle").frame().iloc[0]["ratio"], rtol=1e-6
    )
    assert (
        table.loc["largest_absolute cam_force [N]", "after"]
        < 0.31 * table.loc["largest_absolute cam_force [N]", "before"]
    )
    assert table["binds"].to_list() == [False, True, True, True, False]
    assert set(bound().active) == {*ENDS, f"{RATIO} >= 50"}
    assert isinstance(bound().numbers(), pd.DataFrame)


def test_price_of_a_limit_is_what_giving_way_gains():
    eased = ks.design.optimise(
        SAW, CAM, "largest_absolute cam_force", [*ENDS, f"{RATIO} >= 49.9"], variant="cam-circle", begin=bound().values
    )
    row = "largest_absolute cam_force [N]"
    gained = bound().report().loc[row, "after"] - eased.report().loc[row, "after"]
    assert_allclose(bound().prices[f"{RATIO} >= 50"], gained / 0.1, rtol=0.02)


def test_price_of_a_bound_is_the_slope_there():
    found = ks.design.optimise(SAW, {"spring.stiffness": (5e5, 6e5)}, TORQUE, variant="cam-circle")
    assert dict(found.values) == {"spring.stiffness": 6e5}
    assert found.active == ("spring.stiffness",)
    program = ks.compile(CIRCLE.scene, "balancing_torque", engine="numpy")
    angle = np.linspace(0, 2 * np.pi, 1440, endpoint=False)
    torque = program(angle, {"spring.stiffness": 6e5})["balancing_torque"]
    slope = program.derivatives(angle, "spring.stiffness", {"spring.stiffness": 6e5})["balancing_torque"]
    expected = -np.mean(np.sign(torque) * slope["spring.stiffness"])
    assert_allclose(found.prices["spring.stiffness"], expected, rtol=1e-3)


def test_what_starts_came_to_is_told_as_asked():
    found = ks.design.optimise(SAW, SPRING, maximise=RATIO, variant="cam-circle", angles=360)
    assert_allclose(found.starts, [found.report().loc[f"{RATIO} [1]", "after"]], rtol=1e-5)


@pytest.mark.parametrize("name", ["reference", "before", 5, None])
def test_a_design_takes_the_name_of_no_other_variant(tmp_path, name):
    with pytest.raises(ks.ParameterError, match="name must be a text, not one of"):
        bound().case(tmp_path / "case.toml", name=name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["", "a\0b", "x" * 300])
def test_a_case_that_cannot_be_written_is_a_file_error(name):
    with pytest.raises(ks.errors.FileError):
        bound().case(name)
    with pytest.raises(ks.ParameterError, match="path must be the name of a file"):
        bound().case(None)


# Fronts of two outputs


def test_no_design_of_a_front_is_better_in_both():
    force, ratio = (front().table[f"{name} [{unit}]"].to_numpy() for name, unit in ((FORCE, "N"), (RATIO, "1")))
    assert np.all(np.diff(force) > 0)
    assert np.all(np.diff(ratio) > 0)


def test_ends_are_the_best_of_each_output_alone():
    least = ks.design.optimise(SAW, FRONT_OF, FORCE, variant="cam-circle", angles=180)
    greatest = ks.design.optimise(SAW, FRONT_OF, maximise=RATIO, variant="cam-circle", angles=180)
    assert front().table.iloc[0, 0] == pytest.approx(least.report().iloc[0]["after"], rel=1e-6)
    assert front().table.iloc[-1, 1] == pytest.approx(greatest.report().iloc[0]["after"], rel=1e-6)


# Bars of searches


@pytest.mark.parametrize("wanted", [True, False])
def test_searches_find_the_same_with_a_bar(capsys, monkeypatch, wanted):
    monkeypatch.setattr(problem, "BAR_DELAY", 0.0)
    found = ks.design.optimise(
        ks.load_case("sawframe_2r63"), {"spring.stiffness": (6e5, 9e5)}, "mean_absolute balancing_torque",
        variant="cam-circle", angles=72, progress=wanted,
    )  # fmt: skip
    assert bool(re.search(r"search 1 of 1: \d+ steps", capsys.readouterr().err)) is wanted
    assert dict(found.values)["spring.stiffness"] == pytest.approx(804e3, rel=0.02)
