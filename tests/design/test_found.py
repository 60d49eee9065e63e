"""What a search found: reports, prices of what binds, what starts came to."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.improved_saws import CAM, CIRCLE, ENDS, RATIO, SAW, SPRING, TORQUE, bound


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
