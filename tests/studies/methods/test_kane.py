"""SymPy's Kane method and the papers' formulas against the library, and where they fail."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.linkage import chain_unit, chain_unit_angle
from kinetostatics.mechanics import quantities
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies.methods import papers
from kinetostatics.studies.methods.kane import equations
from support import followers
from support.machines import ANGLES, CLOSE, FourBar, Machine, largest
from support.studied import error

pytestmark = pytest.mark.slow

(KANE,), (PAPERS,) = equations.METHODS, papers.METHODS
METHODS = KANE, PAPERS
COSINE_LAW = Machine("cosine law")
CAM = COSINE_LAW.mechanism.groups[0].cam
SINGULAR = CAM.guide_angle + CAM.singular_angle
"""Crank angle at which the cosine law's root, as published, is zero; another lies as far behind the guide."""
HEAVY = ks.Link(2.0, (0.07, -0.03), 0.04)
TURN = np.linspace(0.2, 0.2 + 2 * np.pi, 24, endpoint=False)
LOADED = {
    "plain": Machine("plain", assembly=-1).solve(),
    "circle": Machine("circle", assembly=-1).solve(),
    "four-bar": FourBar().solve(),
    "four-bar, other assembly": FourBar(assembly=-1).solve(),
    "cosine law": COSINE_LAW.solve(ANGLES[abs(np.cos(ANGLES - CAM.guide_angle) - np.cos(CAM.singular_angle)) > 0.3]),
}
"""Every link has mass off its line, loads of every kind act, the crank accelerates."""

every_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
every_mechanism = pytest.mark.parametrize("s", LOADED.values(), ids=LOADED)


def names(s):
    """All that the methods are to give."""
    motions = [f"{link}_{rate}" for link in ("coupler", "rocker") for rate in ("rate", "angular_acceleration")]
    motions += ["slider_position", "slider_velocity", "slider_acceleration"]
    there = [name for name in motions if name.split("_")[0] in s.mechanism.links]
    return [*s.reactions, *s.scalars, "balancing_torque_by_power", *there]


def assert_sound(s):
    """All forces are there, and right, as near as their condition leaves them."""
    found = equations.all_forces(s)()
    assert set(found) == {*s.reactions, *s.scalars}
    errors = {name: error(s, name, parts) for name, parts in found.items()}
    most = {name: max(CLOSE, UNIT_ROUNDOFF * np.max(s.condition_of(name))) for name in found}
    assert {name: value for name, value in errors.items() if not value < most[name]} == {}


@every_method
@every_mechanism
def test_every_quantity_equals_the_librarys(s, method):
    errors = {name: error(s, name, method.prepare(s, name, None)()) for name in names(s)}
    assert {name: value for name, value in errors.items() if not value < CLOSE} == {}


@every_mechanism
def test_all_forces_come_from_one_function(s):
    found = equations.all_forces(s)()
    assert set(found) == {*s.reactions, *s.scalars}
    assert max(error(s, name, parts) for name, parts in found.items()) < CLOSE


SIX_BAR = (
    ks.RockerGroup(0.4, 0.3, (0.35, 0.05), -1, HEAVY, HEAVY),
    ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.05), on="B", pin="C", label="2", coupler=HEAVY, slider=HEAVY),
)
CHAINS = {
    "two loops": SIX_BAR,
    "slotted lever and dyad": (
        ks.LeverGroup((0.0, -0.3), offset=0.02, lever=HEAVY, block=HEAVY),
        ks.Pin(on="lever", at=(0.5, 0.03), name="C"),
        ks.Dyad(0.4, 0.5, on=("A", "C"), dyad1=HEAVY, dyad2=HEAVY),
    ),
    "swinging cylinder and oblique yoke": (
        ks.CylinderGroup((0.4, 0.1), rod=HEAVY, cylinder=HEAVY),
        ks.YokeGroup(ks.Guide.at(0.3, 0.02), 1.2, slider=HEAVY, block=HEAVY, label="2"),
    ),
}
"""Chains of the other groups, in both assemblies or with all their offsets."""


def loaded(name, groups):
    """A chain under loads of every kind: numbers, functions of the motion, at points, couples, two springs."""
    mechanism = ks.Mechanism(name, ks.Crank(0.1, ks.Link(3.0, (0.1, 0.04), 0.2)), groups)
    free = next(link for link in mechanism.links if link not in ("crank", *mechanism.guides))
    loads = [ks.Gravity(9.81, -1.2), ks.Force(40.0, at=(free, 0.1, 0.05), along=free, direction=0.7)]
    loads += [
        ks.Torque(lambda motion: -3.0 * motion.rate(free), on=free),
        ks.PointSpring(400.0, 0.1, between=("A", (1, 2))),
    ]
    for slider in mechanism.guides:
        loads += [
            ks.Spring(300.0, 0.4, slider, cubic=50.0),
            ks.Spring(90.0, 0.1, slider),
            ks.ProcessForce(25.0, slider),
        ]
        loads += [ks.ProcessForce(lambda motion, slider=slider: -20.0 * motion.travel_velocity(slider), slider)]
    return ks.Scene(mechanism, 12.0, -30.0, tuple(loads)).solve(TURN)


@pytest.mark.parametrize("name", CHAINS)
def test_all_groups_and_loads_follow_declarations(name):
    s = loaded(name, CHAINS[name])
    assert_sound(s)


@pytest.mark.parametrize("kind", ["roller, offset", "flat", "swinging, other side"])
def test_followers_take_their_law(kind):
    s = followers.scene(followers.KINDS[kind]()).solve(followers.ANGLES)
    assert_sound(s)


def test_cams_without_formula_give_own_derivatives():
    turn = np.linspace(0.0, 2 * np.pi, 60, endpoint=False)
    sampled = ks.cams.Sampled(turn, 0.3 + 0.02 * np.cos(turn))
    harmonic = ks.cams.Harmonic((0.3, 0.02, 0.001), (0.003,), 0.2)
    for cam in (sampled, harmonic):
        mechanism = ks.cam_crank_slider(cam, 0.8, coupler=HEAVY, slider=HEAVY)
        s = ks.solve(mechanism, ANGLES, crank_speed=9.0, loads=ks.Spring(90.0, 0.5))
        assert_sound(s)


@every_method
def test_published_cosine_law_loses_digits_cubically(method):
    """Rounding of the radicand, over the distance in w, over its square more in w''; the slider does not feel it."""
    distances = np.array([1e-1, 1e-2, 1e-3])
    s = COSINE_LAW.solve(SINGULAR + distances)
    (found,) = method.prepare(s, "coupler_angular_acceleration", None)()
    exact = s.angular_acceleration("coupler")
    errors = abs(found - exact) / largest(exact)
    assert np.all(errors < 1e-14 / distances**3)
    assert errors[-1] > 1e-8
    assert error(s, "slider_acceleration", method.prepare(s, "slider_acceleration", None)()) < CLOSE


def test_forces_follow_the_misplaced_pin():
    """At some crank angles only: none elsewhere, and not all of those within 20 units in the last place."""
    astray = []
    for guide_angle in np.linspace(0.1, 1.5, 30):
        mechanism = ks.crank_slider(0.04, 0.3, guide_angle=guide_angle, slider=ks.Link(5.0))
        s = ks.solve(mechanism, guide_angle + np.arange(-20, 21) * 2.0**-53, crank_speed=60.0)
        (travel,), force = (PAPERS.prepare(s, name, None)() for name in ("slider_position", "O"))
        wrong, exact = abs(travel - s.slider_position) > 1e-3, s.reaction("O")
        np.testing.assert_array_equal(~(quantities.magnitude(np.subtract(force, exact)) < 0.1 * largest(exact)), wrong)
        astray.append(np.mean(wrong))
    assert 0.005 < np.mean(astray) < 0.2


def test_four_bar_formulas_are_those_of_the_chain_unit():
    """Whose x axis is level, not the frame line, and whose angles count clockwise."""
    lengths, pivot_x, angle = (0.15, 0.3, 0.2), 0.28, np.linspace(0.0, 6.2, 40)
    gamma, psi, *rates = papers.chain_unit_by_atan_acos(*lengths, pivot_x, angle)
    pivot = chain_unit(*lengths, pivot_x=pivot_x).groups[0].pivot
    links = papers.four_bar_by_atan_acos(*lengths, pivot, 1, chain_unit_angle(angle))
    for (direction, rate, _), expected, expected_rate in zip(links, (-gamma, np.pi / 2 - psi), rates, strict=True):
        assert largest(np.exp(1j * direction) - np.exp(1j * expected)) < CLOSE
        assert largest(rate - expected_rate) < CLOSE


def test_atan_of_four_bar_is_off_by_half_a_turn():
    bar = FourBar(crank=0.6, coupler=0.7, rocker=0.65, pivot=0.2 + 0.1j)
    s = bar.solve()
    lengths, pivot = (bar.crank, bar.coupler, bar.rocker), (bar.pivot.real, bar.pivot.imag)
    (direction, rate, _), _ = papers.four_bar_by_atan_acos(*lengths, pivot, 1, ANGLES)
    x, y = s.placement.links["coupler"].direction
    beyond = bar.crank * np.cos(ANGLES - np.angle(bar.pivot)) > abs(bar.pivot)
    assert 0 < np.sum(beyond) < ANGLES.size
    assert largest(x * np.cos(direction) + y * np.sin(direction) - np.where(beyond, -1.0, 1.0)) < CLOSE
    assert largest(rate - s.rate("coupler") / s.crank_speed) < CLOSE
