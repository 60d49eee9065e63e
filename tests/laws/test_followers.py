"""Followers on a cam that turns with the crank, beside full systems of equations and by the laws of mechanics."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.chains import error_beside_constraints, errors_beside_full_systems
from support.followers import ANGLES, KINDS, scene

every_kind = pytest.mark.parametrize("kind", KINDS)


@every_kind
def test_derivatives_forces_and_power_are_right(kind):
    report = ks.check(KINDS[kind]())
    assert report.ok, report
    assert max(report.errors.values()) < 1e-12


@every_kind
def test_followers_agree_with_the_mpmath_system(kind):
    solution = scene(KINDS[kind]()).solve(ANGLES)
    found = errors_beside_full_systems(solution, 2)
    assert max(found.values()) < 1e-13, found


@every_kind
def test_follower_forces_agree_with_multipliers(kind):
    assert error_beside_constraints(scene(KINDS[kind]()).solve(ANGLES)) < 1e-11


@every_kind
def test_the_torque_from_forces_is_that_of_the_powers(kind):
    s = scene(KINDS[kind]()).solve(360)
    size = np.max(s.dynamics.largest_torque_term)
    assert_allclose(s.balancing_torque, s.balancing_torque_by_power, rtol=0, atol=1e-13 * size)


@pytest.mark.slow
def test_the_compiled_engine_agrees():
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    drive = scene(KINDS["roller, offset"]())
    plain, compiled = (drive.solve(ANGLES, engine=engine) for engine in ("numpy", "compiled"))
    name = "contact_force" + drive.mechanism.groups[-1].label
    assert_allclose(compiled.scalar(name), plain.scalar(name), rtol=1e-13)
    assert_allclose(compiled.balancing_torque, plain.balancing_torque, rtol=1e-12)


@every_kind
def test_any_law_gives_the_same_program(kind):
    def solved(law):
        follower = KINDS[kind](law)
        return scene(follower).solve(ANGLES).scalar("contact_force" + follower.label)

    swings = kind.startswith("swinging")
    law = ks.laws.cosine(0.1, 0.6) if swings else ks.laws.cosine(0.01, 0.08)
    own = solved(lambda phi: law(phi))
    assert_allclose(own, solved(law), rtol=1e-15)
    assert np.all(own != solved(law.shifted(0.2)))
