"""How fast the calls are that a user makes: plain sawframe, torque and all reactions, against SymPy's Kane method.

Run by ``python -m pytest tests/benchmarks --benchmark-only``. New mechanism and load objects are made inside each timed
call. Rivals take turns within one run and least times are compared; Kane's method, lambdified with common
subexpressions taken out, is the peer whose time is 1.
"""

from functools import partial

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.studies.methods.kane import equations
from support.speed import COUPLER, COUPLER_INERTIA, COUPLER_MASS, CRANK, SLIDER_MASS, SPEED, seconds, turn

QUANTITIES = ("O", "A", "B", "guide_force", "balancing_torque")
LIMITS = {360: {"numpy": 1.5, "compiled": 0.9, "program": 0.3}, 3600: {"numpy": 1.0, "compiled": 0.5, "program": 0.35}}

needs_numba = pytest.mark.skipif(not numba_backend.numba_available(), reason="numba is not installed (extra: fast)")


def saw(mass=SLIDER_MASS):
    return ks.crank_slider(
        CRANK, COUPLER, coupler=ks.Link(COUPLER_MASS, COUPLER / 2, COUPLER_INERTIA), slider=ks.Link(mass)
    )


def solved(angles, engine):
    s = ks.solve(saw(), angles, crank_speed=SPEED, loads=[ks.Gravity()], engine=engine)
    return s.reaction("O"), s.reaction("A"), s.reaction("B"), s.guide_force, s.balancing_torque


@needs_numba
@pytest.mark.parametrize("count", LIMITS)
def test_users_calls_keep_to_their_share_of_kanes_time(benchmark, tell, count):
    angles = turn(count)
    program = ks.compile(ks.Scene(saw(), SPEED, loads=ks.Gravity()), QUANTITIES)
    rivals = {
        "numpy": partial(solved, angles, "numpy"),
        "compiled": partial(solved, angles, "compiled"),
        "program": partial(program, angles, {"slider.mass": 620.0, "crank_length": 0.31}),
    }
    peer = equations.all_forces(ks.Scene(saw(), SPEED, loads=ks.Gravity()).solve(count))
    for found, name in zip(solved(angles, "compiled"), QUANTITIES, strict=True):
        assert np.abs(found - np.squeeze(peer()[name])).max() <= 1e-12 * np.abs(found).max()
    benchmark(rivals["program"])
    kanes, *times = seconds(peer, *rivals.values())
    shares = {name: spent / kanes for name, spent in zip(rivals, times, strict=True)}
    benchmark.extra_info.update(shares)
    told = ", ".join(
        f"{name} {1e6 * spent:.0f} us ({spent / kanes:.2f})" for name, spent in zip(rivals, times, strict=True)
    )
    tell(f"{count} angles, new objects in each call: {told}; Kane {1e6 * kanes:.0f} us")
    assert {name: share for name, share in shares.items() if share > LIMITS[count][name]} == {}


@needs_numba
def test_one_angle_takes_some_microseconds(benchmark, tell):
    program = ks.compile(ks.Scene(saw(), SPEED, loads=ks.Gravity()), QUANTITIES)

    def solve():
        return ks.solve(saw(), 0.3, crank_speed=SPEED, loads=[ks.Gravity()]).balancing_torque

    benchmark(program, 0.3)
    called, alone = 1e6 * seconds(partial(program, 0.3, {"slider.mass": 620.0}), solve)
    tell(f"one angle: program {called:.1f} us, ks.solve and one quantity {alone:.1f} us")
    assert called <= 10
    assert alone <= 60


def test_a_mechanism_is_made_with_its_checks_in_25_us(benchmark, tell):
    benchmark(saw)
    (spent,) = 1e6 * seconds(saw)
    tell(f"mechanism with two links and all checks: {spent:.1f} us")
    assert spent <= 25


@needs_numba
def test_torque_derivatives_cost_a_few_values(benchmark, tell):
    angles = turn(360)
    scene = ks.Scene(saw(), SPEED, loads=ks.Gravity())
    limits = {"compiled": 3.0, "numpy": 4.0}
    for engine, limit in limits.items():
        program = ks.compile(scene, "balancing_torque", engine=engine)
        value, slopes = seconds(partial(program, angles), partial(program.derivatives, angles))
        tell(
            f"{engine}: all {len(program.parameters)} derivatives of the torque take {slopes / value:.2f} times as long"
        )
        assert slopes <= limit * value
    benchmark(program.derivatives, angles)
