"""Where friction jams: a guide with a wide shoe and a steep rod, by the closed form of its couple."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics import jamming

PUMP = ks.crank_slider(0.1, 0.2, slider=ks.Link(2.0))
AROUND = np.linspace(0.1, 2 * np.pi, 30)


def solved(mu, **options):
    loads, friction = (ks.Gravity(), ks.ProcessForce(500.0)), {"guide": ks.GuideFriction(mu)}
    return ks.solve(PUMP, AROUND, crank_speed=3.0, loads=loads, friction=friction, **options)


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_a_rod_within_the_friction_angle_jams():
    """The rod leans by at most 30 degrees: a slider jams where mu times its slope reaches one."""
    assert np.isfinite(solved(1.7).balancing_torque).all()
    with pytest.raises(ks.errors.JammingError, match="friction jams at") as caught:
        solved(2.5)
    slope = np.abs(np.sin(AROUND)) / np.sqrt(4.0 - np.sin(AROUND) ** 2)
    assert set(caught.value.angles) <= set(AROUND[2.5 * slope >= 1.0].tolist())


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_it_is_left_open_where_asked():
    found = solved(2.5, on_gap="nan").balancing_torque
    assert 0 < np.isnan(found).sum() < found.size


@pytest.mark.parametrize(("speed", "acceleration", "stands"), [(0.0, 0.0, True), (0.0, 1.0, False), (2.0, 0.0, False)])
def test_a_crank_at_rest_has_no_friction_direction(speed, acceleration, stands):
    s = ks.solve(PUMP, AROUND, crank_speed=speed, crank_acceleration=acceleration)
    assert bool(jamming.problem_at_rest(s)) == stands


def test_friction_converges_to_the_last_digit():
    assert jamming.converged(np.array([1.0, 1.0, -1.0]), np.array([1e-14, 1e-9, 0.0])).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("margin", "residuals", "passes"),
    [
        (0.5, (1e-16,), (3,)),
        (0.5, (1e-4, 1e-9, 1e-16), (3, 6, 12)),
        (0.5, (1e-4, 1e-9, 1e-9), (3, 6, 12)),
        (-0.1, (np.nan,), (3,)),
    ],
)
def test_passes_grow_until_friction_is_found(margin, residuals, passes):
    scene, taken, left = ks.Scene(PUMP, 3.0, friction={"guide": ks.GuideFriction(0.1)}), [], iter(residuals)

    def evaluate(item):
        taken.append(item.friction.passes)
        return np.array([1.0, margin]), np.array([0.0, next(left)])

    assert jamming.solve_friction(scene, evaluate).friction.passes == passes[-1]
    assert tuple(taken) == passes
    assert jamming.solve_friction(scene).friction.passes == 6  # nobody looks at it afterwards


def states(kappa, free):
    """Forces N of a guide alone with N = free - kappa |N|."""
    both = free / (1.0 + kappa), free / (1.0 - kappa)
    return [force for force, sign in zip(both, (1.0, -1.0), strict=True) if sign * force > 0.0]


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_the_margin_of_a_guide_decides_uniqueness():
    s = solved(2.5, on_gap="nan")
    kappa = 1.0 - s.friction_margin
    assert kappa == pytest.approx(2.5 * np.abs(np.sin(AROUND)) / np.sqrt(4.0 - np.sin(AROUND) ** 2), rel=1e-12)
    for size, jams in zip(kappa, np.isnan(s.balancing_torque), strict=True):
        counts = {len(states(way * size, free)) for way in (1.0, -1.0) for free in (1.0, -1.0)}
        assert counts == ({0, 2} if jams else {1})
