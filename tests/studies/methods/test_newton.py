"""Newton iteration on the global system and constrained integration, against the closed forms, for all groups."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import NotGivenError
from kinetostatics.machine.group import MEMBERS, Group
from kinetostatics.studies.methods import running
from kinetostatics.studies.methods.global_system import constraints, newton
from support.machines import CLOSE, KINDS, LINKS, Machine
from support.studied import error

TURN = np.linspace(0.2, 0.2 + 2 * np.pi, 72, endpoint=False)
HEAVY = ks.Link(2.0, (0.07, -0.03), 0.04)
FOUR_BAR = ks.RockerGroup(0.4, 0.3, (0.35, 0.05), -1, HEAVY, HEAVY)
SLIDER = {"coupler": HEAVY, "slider": ks.Link(5.0, (0.04, 0.02), 0.3)}
CHAINS = {
    "four-bar": (FOUR_BAR,),
    "six-bar": (FOUR_BAR, ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.05), on="B", pin="C", label="2", **SLIDER)),
    "V engine": (
        ks.SliderGroup(0.4, ks.Guide.at(0.8), **SLIDER),
        ks.SliderGroup(0.5, ks.Guide.at(2.3, 0.02), -1, pin="C", label="2", **SLIDER),
    ),
}


def drag(motion):
    return -20.0 * motion.slider_velocity


def solved(name, angle=TURN, speed=12.0, acceleration=-30.0):
    """A mechanism in which every link has mass, under loads of every kind it can bear."""
    if name in KINDS:
        return Machine(name, assembly=-1).solve(
            angle,
            [ks.Gravity(9.81, -1.2), ks.Spring(500.0, 0.8), ks.ProcessForce(40.0), ks.ProcessForce(drag)],
            crank_speed=speed,
            crank_acceleration=acceleration,
        )
    mechanism = ks.Mechanism(name, ks.Crank(0.1, ks.Link(*LINKS["crank"])), CHAINS[name])
    sliders = [link for link in mechanism.links if link.startswith("slider")]
    loads = [kind for on in sliders for kind in (ks.Spring(300.0, 0.4, on), ks.ProcessForce(25.0, on))]
    return ks.solve(mechanism, angle, crank_speed=speed, crank_acceleration=acceleration, loads=[ks.Gravity(), *loads])


(NEWTON,) = newton.NEWTON_METHODS


def names(s):
    """All that the methods are to give."""
    motions = [link + ending for link in s.mechanism.links for ending in ("_rate", "_angular_acceleration")]
    slides = ["slider_position", "slider_velocity", "slider_acceleration"] if "slider" in s.mechanism.links else []
    return {*s.reactions, *s.scalars, *motions, *slides}


every_mechanism = pytest.mark.parametrize("name", [*KINDS, *CHAINS])


@every_mechanism
def test_global_system_equals_closed_forms(name):
    """At the table's own positions, which continuation finds from one position of the library."""
    s = solved(name)
    model = constraints.Model(s.mechanism)
    angle, positions, _ = newton.position_table(model, TURN)
    s = solved(name, angle)
    errors = {wanted: error(s, wanted, constraints.components(model, s, wanted, positions)) for wanted in names(s)}
    assert {wanted: value for wanted, value in errors.items() if not value < CLOSE} == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cosine law", *CHAINS])
def test_each_newton_iteration_squares_the_error(name):
    s = solved(name)
    wanted = s.reactions[0]
    errors = [error(s, wanted, NEWTON.prepare(s, wanted, count)()) for count in NEWTON.settings[:4]]
    assert errors[0] > 1e-8
    assert all(after < 3 * before**2 + CLOSE for before, after in pairwise(errors)), errors


@pytest.mark.slow
def test_speed_and_angles_may_vary_freely():
    angle = np.random.default_rng(1).uniform(-8.0, 8.0, 40)
    s = solved("circle", angle, speed=10.0 + np.sin(angle), acceleration=5.0 * np.cos(angle))
    assert error(s, "B", NEWTON.prepare(s, "B", 4)()) < CLOSE


@pytest.mark.parametrize("method", [NEWTON, *newton.INTEGRATION_METHODS], ids=lambda method: method.name)
def test_what_no_constraint_equation_gives_is_refused(method):
    setting, s = method.settings[-1], solved("circle", acceleration=0.0)
    designs = ks.solve(ks.crank_slider(np.array([[0.1], [0.2]]), 0.5), TURN, crank_speed=1.0)
    short = ks.solve(ks.crank_slider(0.2, 0.1), TURN, crank_speed=1.0, on_gap="nan")
    members = (
        dict.fromkeys(MEMBERS) | {name: {} for name in ("links", "references", "joints", "outputs")} | {"bars": ()}
    )
    members |= {"hangs_on": (), "links": {"gear": ks.Link()}, "references": {"gear": "O"}}
    gear = type("Gear", (Group,), members)()
    foreign = replace(s, mechanism=ks.Mechanism("gear", ks.Crank(0.1), (gear,)))
    for refused, wanted, words in [
        (s, "pressure_angle", "no pressure_angle, but O, balancing_torque, slot_force"),
        (designs, "O", r"not a batch of shape \(2, 72\)"),
        (short, "O", "finds no position of crank-slider at 0"),
        (foreign, "O", "Gear does not declare its pairs, .*: joints of gear"),
    ]:
        with pytest.raises(NotGivenError, match=words):
            method.prepare(refused, wanted, setting)


@pytest.mark.filterwarnings("ignore::kinetostatics.errors.ConditionWarning")
def test_singular_change_point_is_refused_in_a_line():
    deltoid = ks.four_bar(0.1, 0.2, 0.2, rocker_pivot=(0.1, 0.0), assembly="open", coupler=ks.Link(1.0, 0.1))
    s = ks.solve(deltoid, np.linspace(0.0, 6.0, 7), crank_speed=10.0)
    for method in (NEWTON, *newton.INTEGRATION_METHODS):
        with pytest.raises(
            NotGivenError, match="four-bar passes change points, where constraint equations are singular"
        ):
            method.prepare(s, "balancing_torque", method.settings[-1])()


# Integration over the turn

WANTED = "A", "coupler_rate", "balancing_torque"


@pytest.mark.slow
@pytest.mark.parametrize("method", newton.INTEGRATION_METHODS, ids=lambda method: method.name.split()[-1])
@pytest.mark.parametrize("name", ["plain", "cosine law", "six-bar"])
def test_error_of_integration_falls_with_its_tolerance(monkeypatch, name, method):
    def all_of_them(model, solution, quantity, *state):
        return {wanted: constraints.components(model, solution, wanted, *state) for wanted in WANTED}

    monkeypatch.setattr(newton, "components", all_of_them)  # of one integration
    s = solved(name, acceleration=0.0)
    limits = (
        {1e-4: 0.1, 1e-8: 1e-4, 1e-12: 1e-8} if "Baumgarte" in method.name else {1e-4: 1e-4, 1e-8: 1e-11, 1e-12: CLOSE}
    )
    found = [method.prepare(s, WANTED[0], tolerance)() for tolerance in limits]
    for wanted in WANTED:
        errors = [error(s, wanted, parts[wanted]) for parts in found]
        assert all(found < limit for found, limit in zip(errors, limits.values(), strict=True)), (wanted, errors)
        assert all(after < 0.01 * before + CLOSE for before, after in pairwise(errors)), errors


@pytest.mark.slow
@pytest.mark.parametrize("method", newton.INTEGRATION_METHODS, ids=lambda method: method.name.split()[-1])
def test_integration_needs_constant_speed(method):
    s = solved("plain", acceleration=0.0)
    for change in (
        {"crank_acceleration": 1.0},
        {"crank_speed": np.full(TURN.size, 12.0)},
        {"crank_angle": TURN[::-1]},
        {"crank_angle": 1.1 * TURN},
        {"crank_angle": TURN[:1]},
    ):
        with pytest.raises(NotGivenError, match="integration runs"):
            method.prepare(replace(s, **change), "O", 1e-6)


# Ways to a motion over time


@pytest.mark.slow
@pytest.mark.parametrize("name", running.BENCHMARKS)
@pytest.mark.parametrize(
    ("method", "setting", "error"),
    [("ours, NumPy", None, 1e-11), ("reduced inertia, RK45", 1e-7, 1e-3), ("reduced inertia, LSODA", 1e-9, 1e-4)],
)
def test_methods_reach_the_published_ends_of_motions(name, method, setting, error):
    problem = running.BENCHMARKS[name]()
    (found,) = (one for one in running.MOTION_METHODS if one.name == method)
    assert abs(found.prepare(problem, "", setting)() - problem.exact) < error


@pytest.mark.slow
def test_constraints_reach_the_published_end():
    (constraints,) = (one for one in running.MOTION_METHODS if one.name.startswith("constraint"))
    problem = running.slider_crank()
    assert abs(constraints.prepare(problem, "", 1e-5)() - problem.exact) < 1e-6
    with pytest.raises(ks.errors.NotGivenError, match="change points"):
        constraints.prepare(running.two_four_bars(), "", 1e-5)
