"""Means and the rounding of results."""

from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.means import (
    _mean_of_absolute_torque,
    closed_turn,
    drive_means,
    mean_absolute_torque,
    mean_absolute_torque_errors,
    means,
)
from kinetostatics.cycle.rounding import BoundedExtremes, without_rounding

TURN = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0)), 0.0, crank_speed=3.0).sampled
WHOLE = 2 * np.pi

FUNCTIONS = {
    "power": (lambda x: x**3, WHOLE**3 / 4),
    "sine": (np.sin, 0.0),
    "corner": (lambda x: np.abs(np.sin(x - 0.123)), 2 / np.pi),
    "root": (lambda x: np.sqrt(np.abs(x - 1.0)), (2 / 3 * (1 + (WHOLE - 1) ** 1.5)) / WHOLE),
    "jump": (lambda x: np.where(x > 1.2345, 2.0, -1.0), 2.0 - 3.0 * 1.2345 / WHOLE),
    "peak": (lambda x: 1e-4 / ((x - 2.0) ** 2 + 1e-8), (np.arctan(2e4) + np.arctan((WHOLE - 2) * 1e4)) / WHOLE),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_mean_is_that_of_calculus(name):
    function, expected = FUNCTIONS[name]
    found, error, *_ = means(lambda x: function(x)[None], TURN, 1e-14)
    assert found[0] == pytest.approx(expected, rel=1e-11, abs=1e-14)
    assert error[0] < 1e-10


@pytest.mark.parametrize("of", [mean_absolute_torque, drive_means])
def test_jamming_leaves_no_mean(of):
    solution = ks.solve(
        ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0)), 0.3, crank_speed=3.0, friction={"guide": ks.GuideFriction(0.9)}
    )
    with pytest.raises(ks.JammingError, match="friction jams at") as caught:
        of(solution)
    assert caught.value.angles
    assert "on_gap" not in str(caught.value)


def test_errors_of_a_mean_are_rounding_and_quadrature():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    s = ks.solve(saw, 8, crank_speed=33.5, loads=[ks.Gravity()])
    rounding, quadrature = mean_absolute_torque_errors(s)
    mean = mean_absolute_torque(s)
    assert 0 < rounding < 1e-13 * mean
    assert 0 <= quadrature < 1e-12 * mean
    assert ks.compare(s, s).mean_torque_errors[0] == (rounding, quadrature)


def _exact_weights(count):
    """Weights of Fejer's first rule on [-1, 1] in 40 digits."""
    mp = pytest.importorskip("mpmath")
    with mp.workdps(40):
        angles = [(2 * k + 1) * mp.pi / (2 * count) for k in range(count)]
        orders = range(1, count // 2 + 1)
        return [(2 - 4 * sum(mp.cos(2 * j * a) / (4 * j * j - 1) for j in orders)) / count for a in angles]


def test_rounding_bound_of_a_mean_is_near():
    """The torque of a Scotch yoke is m r^2 omega^2 sin 2 phi / 2; the sum of its points is taken in 40 digits."""
    mp = pytest.importorskip("mpmath")
    s = ks.solve(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), 0.0, crank_speed=7.0)
    mean, _, _, pieces = _mean_of_absolute_torque(closed_turn(s, "mean torque"))
    weights = _exact_weights(pieces.count)
    with mp.workdps(40):
        size = mp.mpf(0.1) ** 2 * 3 * 49 / 2
        total = mp.mpf(0)
        for row, half in zip(pieces.angle.tolist(), pieces.half[:, 0].tolist(), strict=True):
            parts = (weight * abs(mp.sin(2 * mp.mpf(x))) for x, weight in zip(row, weights, strict=True))
            total += mp.mpf(half) * mp.fsum(parts)
        error = abs(mp.mpf(mean) - size * total / mp.mpf(s.period))
    rounding = mean_absolute_torque_errors(s).rounding
    assert mean == mean_absolute_torque(s)
    assert 0 < error <= rounding < 5e-15 * mean


def test_unbounded_torque_has_infinite_mean(monkeypatch):
    s = ks.solve(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), 0.0, crank_speed=7.0)
    found = ks.extremes(s, "balancing_torque")
    growing = replace(found, value=np.where(found.maximum, np.inf, found.value))
    monkeypatch.setattr("kinetostatics.cycle.means.extrema", lambda *_: growing)
    with pytest.warns(ks.ConditionWarning, match="grows without bound"):
        assert mean_absolute_torque(s) == np.inf
    assert mean_absolute_torque_errors(s) == (np.inf, np.inf)


# What of a table is rounding

YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0))
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def known(solution, *names):
    return BoundedExtremes(solution, {name: ks.extremes(solution, name) for name in names})


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
