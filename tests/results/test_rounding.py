"""What of a table is rounding: within proven bounds, or by the terms of each machine, never by a size of its own."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.rounding import Known, without_rounding

YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0))
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def known(solution, *names):
    return Known(solution, {name: ks.extremes(solution, name) for name in names})


@pytest.mark.parametrize("speed", [10.0, 1e-6])
def test_small_values_are_0_beside_their_terms_only(speed):
    """The inertia force of the slider is 3 kg x 0.1 m x speed^2: 30 N, and 3e-13 N in a machine that creeps."""
    solution = ks.solve(YOKE, np.linspace(0, 6, 24), crank_speed=speed)
    force = 0.3 * speed**2
    values = [1e-10 * force, 1e-15 * force, -1e-15 * force]
    assert without_rounding(solution, "guide_force", values).tolist() == [1e-10 * force, 0.0, 0.0]
    assert ks.extremes(solution, "O").largest == pytest.approx(force)


@pytest.mark.slow
def test_the_compiled_engine_is_not_waited_for():
    solution = ks.solve(SAW, 0.0, crank_speed=33.5)
    wanted = known(solution, "O").errors("O")
    pytest.importorskip("numba")
    fast = ks.solve(SAW, 0.0, crank_speed=33.5, engine="compiled")
    np.testing.assert_allclose(known(fast, "O").errors("O"), wanted, rtol=1e-6)


def test_error_without_a_bound_is_unknown():
    pressed = ks.ProcessForce(lambda motion: np.interp(np.cos(motion.crank_angle), [-1, 1], [0, 7]))
    found = known(ks.solve(SAW, 0.0, crank_speed=1.0, loads=[pressed]), "O")
    assert np.isnan(found.errors("O")).all()
    assert np.isnan(found.end("O", np.argmax).error)


@pytest.mark.slow
def test_value_beside_a_jump_has_its_sides_bound():
    """At the dead centre of the knuckle the force jumps by 400 kN; on which side a crank angle lies is not sure."""
    solution = ks.load_case("toggle_press").solve("coining")
    several = known(solution, "balancing_torque", "B2")
    at_jump = np.isclose(np.degrees(several.found["balancing_torque"].angle), 4.80845, atol=1e-4)
    assert at_jump.any()
    bounds = several.found["balancing_torque"].error_bound[at_jump]
    assert (bounds > 10.0).all()
    assert (several.errors("balancing_torque")[at_jump] < 1e-9).all()


def test_many_extremes_print_smallest_and_largest():
    angle = np.linspace(0.0, 2 * np.pi, 361)
    force = 1e3 * np.sin(angle) + np.where(np.arange(361) % 2, 20.0, -20.0) * np.sin(angle)
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    s = ks.solve(pump, 0.0, crank_speed=10.0, loads=ks.ProcessForce(ks.Table(angle, force)))
    found = ks.extremes(s, "guide_force")
    head, *ends, more = str(found).splitlines()
    assert head == f"{len(found)} extremes of guide_force"
    assert len(found) > 100
    assert sorted(float(line.split()[2]) for line in ends) == pytest.approx(found.range, rel=1e-5)
    assert more == f"the smallest and the largest; .angle and .value have {len(found) - 2} more between"
