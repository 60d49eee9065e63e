"""Friction in the equations of independent methods, which share no formula with the kernels'."""

from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import NotGivenError
from kinetostatics.studies.methods.global_system import newton
from kinetostatics.studies.methods.high_precision import certified, independent
from kinetostatics.studies.methods.kane import equations
from support.case_files import shipped, unlike_variants
from support.every import every
from support.friction_machines import FOLLOWERS, KINDS, Drawn
from support.studied import error

ANGLES = np.linspace(0.0, 2 * np.pi, 24, endpoint=False) + 0.05
(NEWTON,) = newton.NEWTON_METHODS


def drawn(kind, seed=1, angles=ANGLES):
    return Drawn(kind, seed).scene.solve(angles)


@pytest.mark.slow
@every("kind", (*KINDS, *FOLLOWERS))
def test_repeated_linear_systems_equal_the_kernels(kind):
    s = drawn(kind)
    model = newton.model_of(s, "O")
    q = newton.iteration(model, s.crank_angle, 6)()
    for quantity in ("balancing_torque", *s.reactions, *(name for name in s.scalars if "force" in name)):
        assert error(s, quantity, newton.components(model, s, quantity, q)) < 1e-11, quantity


@pytest.mark.slow
@every("kind", KINDS)
def test_independent_path_confirms_30_digits(flint, kind):
    s = drawn(kind, 2, ANGLES[:2])
    for quantity in ("balancing_torque", *(name for name in s.reactions if "guide" in name)):
        assert certified.certified(s, quantity).agreement < 1e-30


@pytest.mark.slow
@every("variant", unlike_variants("sawframe_2r63_friction"))
def test_shipped_saw_friction_is_certified(flint, variant):
    s = shipped("sawframe_2r63_friction").variants[variant].scene.solve(ANGLES[::3])
    assert s.friction
    for quantity in ("balancing_torque", "O", "B"):
        reference = certified.certified(s, quantity)
        for method in (NEWTON, *(newton.INTEGRATION_METHODS if quantity == "O" else ())):
            found = method.prepare(s, quantity, method.settings[-1])()
            assert ks.precision.relative_errors(found, reference).max() < (1e-13 if method is NEWTON else 1e-8)


def test_friction_changes_the_pin_force():
    """So that agreement is not that of forces which friction leaves alone."""
    s = drawn("four-bar")
    idle = replace(s, friction=type(s.friction)())
    without, with_friction = (NEWTON.prepare(one, "B", 6)() for one in (idle, s))
    assert error(s, "B", without) > 1e-3 > 1e-11 > error(s, "B", with_friction)


def test_what_cannot_be_found_is_refused():
    rests = Drawn("slider", 1).scene
    rests = replace(rests, crank_speed=0.0, crank_acceleration=5.0).solve(ANGLES)
    for prepare in (NEWTON.prepare, lambda s, quantity, _: independent.independent(s, quantity, [0])):
        with pytest.raises(NotGivenError, match="friction of a crank at rest has no direction"):
            prepare(rests, "O", 6)
    with pytest.raises(NotGivenError, match="its equations have no friction, but the scene has some in O, A, B, guide"):
        equations.METHODS[0].prepare(drawn("slider"), "O", None)


def test_friction_that_does_not_settle_is_told(monkeypatch):
    monkeypatch.setattr("kinetostatics.studies.methods.structures.MAX_FRICTION_ITERATIONS", 2)
    with pytest.raises(NotGivenError, match="forces and friction still change after 2 iterations"):
        NEWTON.prepare(drawn("slider"), "O", 6)()


def test_friction_in_a_given_sense_is_refused():
    s = drawn("slider")
    by_joint = tuple(replace(item, sense=1.0) for item in s.friction.by_joint)
    held = replace(s, friction=replace(s.friction, by_joint=by_joint))
    with pytest.raises(NotGivenError, match="friction with a given sense"):
        NEWTON.prepare(held, "O", 6)()
