"""Programs, batches, sweeps and case files keep to the kind that the words have chosen."""

import numpy as np
import pytest

import kinetostatics as ks
from support.change_points import LINKS, SPEED, four_bar, solve


def program(name, quantities="balancing_torque"):
    return ks.compile(ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()), quantities, engine="numpy")


def test_program_takes_values_that_keep_the_kind():
    longer = {"crank_length": 2.0, "rocker_length": 2.0, "coupler_length": 3.0, "rocker_pivot.x": 3.0}
    found = program("parallelogram")(0.3, longer)["balancing_torque"]
    made = ks.four_bar(2.0, 3.0, 2.0, rocker_pivot=(3.0, 0.0), assembly="open", **LINKS)
    assert found == ks.Scene(made, SPEED, loads=ks.Gravity()).solve(0.3).balancing_torque
    assert program("parallelogram")(0.3, {"crank_length": 1.0 + 2.0**-52})["balancing_torque"] > 0


def test_program_of_no_change_point_refuses_values_that_make_one():
    made = ks.four_bar(1.0, 3.0, 2.5, rocker_pivot=(3.0, 0.0), assembly="open", **LINKS)
    found = ks.compile(ks.Scene(made, SPEED), "balancing_torque", engine="numpy")
    assert found.derivatives(0.3, "crank_length")["balancing_torque"]["crank_length"] != 0
    with pytest.raises(ks.ParameterError, match="another kind"):
        found(0.3, {"rocker_length": 1.0})


@pytest.mark.parametrize("path", ["crank_length", "coupler_length", "rocker_length", "rocker_pivot.x"])
def test_derivatives_by_lengths_are_refused_and_those_by_masses_given(path):
    found = program("4/1/3/2")
    with pytest.raises(ks.ParameterError, match=f"no derivative by {path}"):
        found.derivatives(0.3, (path, "crank.mass"))
    slopes = found.derivatives(0.3)["balancing_torque"]
    assert path not in slopes
    step = 1e-3
    difference = (
        found(0.3, {"coupler.mass": 1.5 + step})["balancing_torque"]
        - found(0.3, {"coupler.mass": 1.5 - step})["balancing_torque"]
    )
    assert slopes["coupler.mass"] == pytest.approx(difference / (2 * step), rel=1e-9)


def test_batches_of_one_kind_are_solved_and_of_several_refused():
    scale = np.array([[1.0], [2.5], [0.3]])
    made = ks.four_bar(scale, 3 * scale, 2 * scale, rocker_pivot=(4 * scale, 0.0), assembly="open")
    assert solve(made, np.linspace(0.0, 12.0, 9)).position("B").shape == (2, 3, 9)
    with pytest.raises(
        ks.ParameterError, match=r"must be of one kind, but these have change points none; a \+ d = b"
    ) as error:
        ks.four_bar(scale, 3 * scale, 2 * scale, rocker_pivot=(4.0, 0.0), assembly="open")
    assert error.value.designs.tolist() == [True, False, False]


def test_reductions_of_forces_that_grow_are_refused_in_sweeps():
    import pandas as pd

    scene = ks.Scene(four_bar("4/1/3/2", "open"), SPEED, loads=ks.Gravity())
    designs = pd.DataFrame({"coupler.mass": [1.0, 2.0]})
    with pytest.raises(ks.ParameterError, match="no mean and no largest value"):
        ks.sweep(scene, designs, ["mean B"], progress=False)
    table = ks.sweep(scene, designs, ["largest balancing_torque"], angles=720, progress=False)
    with_mass = scene.varied({"coupler.mass": 2.0})
    largest = ks.extremes(with_mass.solve(12), "balancing_torque").range[1]
    assert table.iloc[1, 1] == pytest.approx(largest, rel=1e-6)
