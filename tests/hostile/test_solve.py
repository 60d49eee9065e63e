"""What cannot be solved, at what are no crank angles, under what are no loads: one error each."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.sliders import TURN, crank_slider, solve


@every("bad", [None, 3.0, "m", {}, ks.Mechanism, ks.Crank(0.1)])
def test_solve_wants_a_mechanism(bad):
    with pytest.raises(ks.ParameterError, match="mechanism must be a Mechanism"):
        ks.solve(bad, TURN, crank_speed=1.0)


@pytest.mark.slow_start
def test_a_variant_of_a_case_is_solved_by_itself():
    case = ks.load_case("sawframe_2r63")
    for whole in (case, *case.variants.values()):
        with pytest.raises(ks.ParameterError, match=r"it is solved by its own \.solve\(angles\)"):
            ks.solve(whole, TURN, crank_speed=1.0)


@every("bad", [None, 9.81, "gravity", {}, ks.Gravity, ks.Spring, (g for g in ()), object(), ks.Link()])
@every("wrapped", [False, True])
def test_loads_are_loads(bad, wrapped):
    with pytest.raises(ks.ParameterError, match=r"loads must be Gravity, Spring, .* or TorsionDamper, got"):
        solve(loads=[bad] if wrapped else bad)


@every("angles", [[], (), np.empty(0), np.empty((3, 0)), "0.1", ["0.1", "0.2"], [True, False], [None], {}])
def test_angles_are_angles(angles):
    with pytest.raises(ks.ParameterError, match=r"crank_angle|no crank angles"):
        solve(crank_angle=angles)


THREE, TWO = np.array([[1.0], [1.1], [1.2]]), np.array([[1.0], [1.1]])


@every(
    "make",
    [
        lambda: ks.Link(TWO, THREE),
        lambda: ks.cams.Circle(TWO, (0.01 * THREE, 0.0)),
        lambda: ks.cams.CosineLaw(TWO, 5.0 * THREE),
        lambda: ks.RockerGroup(TWO, THREE, (1.0, 0.0)),
        lambda: solve(crank_slider(coupler_length=TWO, slider=ks.Link(THREE))),
        lambda: solve(crank_slider(coupler_length=TWO), crank_speed=THREE),
        lambda: solve(crank_slider(coupler_length=TWO), THREE + TURN),
        lambda: solve(crank_slider(coupler_length=TWO), loads=[ks.Gravity(THREE)]),
        lambda: solve(crank_slider(coupler_length=TWO), loads=[ks.ProcessForce(THREE)]),
        lambda: solve(loads=[ks.ProcessForce(np.ones(71))]),
        lambda: solve(crank_speed=np.ones(71)),
        lambda: solve(loads=[ks.Gravity(TWO), ks.Spring(THREE, 0.1)]),
    ],
)
def test_batches_of_unequal_length_do_not_fit_together(make):
    with pytest.raises(ks.ParameterError, match=r"these shapes do not fit together: .*\("):
        make()
