"""Inertia of sliders together with springs that nearly balance it."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import NUMPY
from kinetostatics.engines.program import program_of
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.parameter_tree import replace_unchecked
from kinetostatics.studies.methods.high_precision.enclosures import on_arb
from support.enclosed import differences
from support.every import every

TURN = np.linspace(0.0, 2 * np.pi, 60, endpoint=False) + 0.013
SPEED = 33.5
MASS = 600.0
SLIDER = ks.Link(MASS, (0.1, -0.05), 3.0)
ROD = ks.Link(150.0, (1.0, 0.02), 20.5)
CAM = ks.cams.CosineLaw(0.3, 2.0)
CAMS = {
    "cosine": (CAM, CAM.coupler_length),
    "circle": (ks.cams.Circle(0.3, (-0.0219, 0.001)), 2.0219),
    "harmonic": (ks.cams.Harmonic((0.2987, -0.0199, 0.0013), (-0.0006,)), 2.02),
}
LEVEL, INCLINED = ks.Guide.at(), ks.Guide.at(0.7, -0.04)


class Apart(ks.SliderGroup):
    """A slider group that does not tell how its slider departs."""

    def departure(self, placement, position):
        """Not known."""
        return


def saw(cam, length, guide=LEVEL, kind=ks.SliderGroup):
    rod = kind(length, guide, coupler=ROD, slider=SLIDER)
    return ks.Mechanism("saw", ks.Crank(link=ks.Link(40.0, 0.1, 1.0)), (ks.CamRoller(cam), rod))


def plain(guide=LEVEL, assembly=1, length=2.0):
    rod = ks.SliderGroup(length, guide, assembly=assembly, coupler=ROD, slider=SLIDER)
    return ks.Mechanism("plain", ks.Crank(0.3), (rod,))


MACHINES = {
    **{name: saw(*made) for name, made in CAMS.items()},
    "inclined": saw(*CAMS["circle"], INCLINED),
    "crank": plain(),
    "behind": plain(INCLINED, -1),
    "open": plain(assembly="open"),
    "through change points": plain(assembly="open", length=0.3),
    "rocker": ks.Mechanism(
        "rocker",
        ks.Crank(0.1),
        (
            ks.RockerGroup(0.4, 0.3, (0.35, 0.1)),
            ks.SliderGroup(1.0, INCLINED, slider=SLIDER, on="B", pin="C", label="2"),
        ),
    ),
    "follower": ks.Mechanism(
        "follower", ks.Crank(None), (ks.RollerFollower(ks.laws.cosine(0.1, 0.3), follower=ks.Link(MASS)),)
    ),
}
APART = "rocker", "follower", "through change points"
SPRINGS = {
    "balancing": [ks.Spring.balancing(MASS, SPEED, 2.0)],
    "stiff": [ks.Spring(5e6, 1.7)],
    "soft": [ks.Spring(3e3, 0.2)],
    "cubic": [ks.Spring(2e5, 2.0, cubic=1.2e7)],
    "two and a force": [ks.Spring(4e5, 2.1), ks.ProcessForce(700.0), ks.Spring(2e5, 1.9, cubic=-1e6)],
}


def loaded(machine, given, acceleration=0.0):
    moved = next(iter(machine.guides))
    weight = [ks.Gravity(9.81, -1.4), ks.Force(360.0, at=(moved, 0.2, 0.1), direction=-0.6)]
    loads = [replace_unchecked(load, on=moved) for load in SPRINGS[given]] + weight
    return ks.Scene(machine, SPEED, acceleration, loads).solve(TURN)


@pytest.mark.slow
@every("name, given, acceleration", [(n, g, -50.0 * (k % 2)) for k, n in enumerate(MACHINES) for g in SPRINGS])
def test_forces_are_those_of_inertia_and_springs_apart(name, given, acceleration):
    run = loaded(MACHINES[name], given, acceleration).dynamics
    apart = run.mechanism.resolve(run.placement, run.link_loads, run.pushes)
    for joint, force in apart.reactions.items():
        assert np.allclose(run.reaction(joint), run.as_vector(force), rtol=0.0, atol=1e-13 * run.largest_force_term)
    error = run.balancing_torque - apart.scalars["balancing_torque"]
    assert np.max(np.abs(error)) < 1e-13 * run.largest_torque_term


@pytest.mark.slow
@every("name", [name for name in MACHINES if name not in APART])
def test_inertia_and_a_balancing_spring_are_one_force(name):
    run = loaded(MACHINES[name], "balancing").dynamics
    loads, pushes = run.acting
    assert loads["slider"].force is not run.link_loads["slider"].force
    assert pushes["slider"] is not run.pushes["slider"]
    assert {part: loads[part] for part in loads if part != "slider"} == {
        part: run.link_loads[part] for part in loads if part != "slider"
    }


@every("name", APART)
def test_where_no_departure_is_known_they_stay_apart(name):
    run = loaded(MACHINES[name], "balancing").dynamics
    assert all(taken is given for taken, given in zip(run.acting, (run.link_loads, run.pushes), strict=True))


def test_without_springs_or_mass_nothing_is_done():
    for load in (ks.ProcessForce(3.0), ks.Spring(1e3, 2.0)):
        run = ks.solve(ks.crank_slider(0.3, 2.0), TURN, crank_speed=SPEED, loads=load).dynamics
        assert all(taken is given for taken, given in zip(run.acting, (run.link_loads, run.pushes), strict=True))


@pytest.mark.slow
@every("name, guide", [(name, INCLINED) for name in CAMS])
def test_one_force_takes_hardly_more_operations(name, guide):
    """Two products and two sums more at each crank angle."""
    counts = []
    for kind in (ks.SliderGroup, Apart):
        run = ks.Scene(saw(*CAMS[name], guide, kind), SPEED, 0.0, SPRINGS["balancing"]).solve(TURN).dynamics
        program, _ = program_of(run, ("B", "balancing_torque"))
        counts.append(program.recording.operations)
    assert counts[0] <= counts[1] + 4


class Preloaded(ks.Spring):
    """A spring of a user's that pushes in a way of its own."""

    def push(self, motion):
        """With a constant force besides."""
        return super().push(motion) + 1000.0


class Stiffened(ks.Spring):
    """A spring of a user's with a rate of its own."""

    def spring_rate(self, motion):
        """Twice as large."""
        return 2.0 * super().spring_rate(motion)


class Softened(ks.Spring):
    """A spring of a user's with a rate of its own, which is not parted."""

    def spring_rate(self, motion):
        """Half as large."""
        return 0.5 * super().spring_rate(motion)


STIFF, PRELOAD = ks.Spring(4e5, 2.1), ks.ProcessForce(1000.0)


@pytest.mark.slow
@every("machine, own, plain", [
    ("crank", [Preloaded(2e5, 1.9)], [ks.Spring(2e5, 1.9), PRELOAD]),
    ("crank", [Preloaded(2e5, 1.9), STIFF], [ks.Spring(2e5, 1.9), PRELOAD, STIFF]),
    ("crank", [Stiffened(2e5, 1.9)], [ks.Spring(4e5, 1.9)]),
    ("harmonic", [Softened(2e5, 2.0, cubic=1.2e7)], [ks.Spring(1e5, 2.0, cubic=6e6)]),
])  # fmt: skip
def test_a_spring_of_the_user_s_pushes_as_it_says(machine, own, plain):
    one, other = (ks.Scene(MACHINES[machine], SPEED, 0.0, loads).solve(TURN) for loads in (own, plain))
    for name in ("B", "O"):
        np.testing.assert_allclose(
            one.reaction(name), other.reaction(name), rtol=0.0, atol=1e-13 * other.largest_force_term
        )
    assert one.power_residual < 1e-14


@every("name", CAMS)
def test_a_balancing_spring_leaves_the_exact_force(name, flint):
    """Within 1e-16 of the spring's force, most of it the rounding of m omega^2; subtracted it were 3e-16."""
    s = ks.Scene(saw(*CAMS[name]), SPEED, 0.0, SPRINGS["balancing"]).solve(TURN)
    found = NUMPY.values(s.dynamics, ("B",))["B"][0]
    exact = components(on_arb(flint.arb, s), "B")[0]
    errors = [float(flint.arb(float(one)) - other) for one, other in zip(found, exact, strict=True)]
    spring = MASS * SPEED * SPEED * 0.3
    assert np.max(np.abs(errors)) < 1.7e-16 * spring


@pytest.mark.slow
@every("guide", [LEVEL, INCLINED])
def test_a_stiffening_spring_leaves_the_exact_force(guide, flint):
    """Within 4e-16 of the spring's force; by a rate that changes with the crank angle it were 7e-16."""
    cam = ks.cams.Harmonic((0.27, -0.012, 0.024), (0.0002,))
    s = ks.Scene(saw(cam, 2.012, guide), SPEED, 0.0, [ks.Spring(1e4, 2.0, cubic=1.2e7)]).solve(360)
    errors = differences(NUMPY.values(s.dynamics, ("B",))["B"], components(on_arb(flint.arb, s), "B"))
    assert np.max(np.hypot(*errors)) < 4e-16 * np.max(np.abs(s.dynamics.pushes["slider"]))


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("speed", [0.0, 1e-12])
def test_a_slow_machine_at_a_limit_keeps_its_spring(speed):
    """There the slider's second derivative is a million times its elongation, and nothing of it counts."""
    close = plain(length=0.3 * (1.0 + 1e-13))
    run = ks.Scene(close, speed, 0.0, SPRINGS["balancing"]).solve(np.pi / 2 + np.array([-1e-7, 0.0, 1e-7])).dynamics
    assert np.min(np.abs(run.placement.travels["slider"].second)) > 1e5
    assert np.allclose(run.acting[1]["slider"], run.pushes["slider"], rtol=3e-16, atol=0.0)


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@every("strokes", [1.0, 1e2, 1e4, 1e6])
def test_a_soft_spring_that_is_long_loses_no_digit(flint, strokes):
    """Its force is as large as inertia, its elongation many times the stroke."""
    rod = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
    spring = ks.Spring(600 * SPEED**2 / strokes, 2.0 + 0.6 * strokes)
    s = ks.solve(rod, TURN, crank_speed=SPEED, loads=spring)
    with flint.ctx.workprec(200):
        exact = np.array([float(part) for part in components(on_arb(flint.arb, s), "B")[0]])
    assert np.abs(s.reaction("B")[0] - exact).max() < 1e-15 * np.abs(exact).max()
