"""Friction: its equations, the passes that solve them, and jamming."""

import itertools
import warnings
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics import jamming
from kinetostatics.mechanics.friction import (
    Channel,
    FrictionEquations,
    FrictionLaw,
    direction_of,
    kink_functions,
    size_of,
)
from support.every import every, quick
from support.friction_machines import FOLLOWERS, JOINTS, KINDS, RUBBED, Drawn, differences
from support.pulsed_scenes import PulsedScene

TURN = np.linspace(0.0, 2 * np.pi, 90, endpoint=False) + 0.01
CENTRIC = ks.crank_slider(0.1, 0.3)
STEEP = ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0), coupler=ks.Link(1.0, (0.05, 0.02), 0.01))
DRIVE = {"crank_speed": 30.0, "crank_acceleration": 5.0, "loads": (ks.Gravity(), ks.ProcessForce(200.0))}
SCENE = ks.Scene(RUBBED, friction=JOINTS, **DRIVE)


def rubbed(friction=JOINTS, **drive):
    return ks.solve(RUBBED, TURN, friction=friction, **DRIVE | drive)


@pytest.mark.slow
@pytest.mark.parametrize("kind", quick([*KINDS, *FOLLOWERS], 3))
def test_forces_obey_newton_for_all_bodies(kind):
    difference, solution = differences(kind, 1)
    assert difference < 1e-13
    assert solution.converged
    assert solution.power_residual < 1e-13


@pytest.mark.slow
@every("kind", [*KINDS, *FOLLOWERS])
def test_four_times_the_friction_obeys_newton_too(kind):
    assert differences(kind, 100, 4.0)[0] < 1e-13


def _from_rest(drawn):
    object.__setattr__(drawn.scene, "crank_speed", 0.0)
    drawn.system.speed = mp.mpf(0)


@pytest.mark.slow
@every("kind", ["slider", "cam", "lever"])
def test_friction_from_rest_opposes_the_coming_motion(kind):
    difference, solution = differences(kind, 3, changed=_from_rest)
    assert difference < 1e-13
    assert solution.friction_loss == 0.0


@every("way", [1.0, -1.0])
@every("angle, side", [(0.0, 1.0), (np.pi, -1.0)])
def test_static_torque_at_dead_centres_is_closed_form(angle, side, way):
    a, b, o, load, ratio = 0.02, 0.015, 0.01, 1000.0, 1.0 / 3.0
    friction = {name: ks.PinFriction(1.0, rho) for name, rho in {"O": o, "A": a, "B": b}.items()}
    s = ks.solve(
        CENTRIC, angle, crank_speed=0.0, crank_acceleration=way, loads=ks.ProcessForce(load), friction=friction
    )
    sine = (a + side * b) / 0.3
    torque = load / np.sqrt(1.0 - sine**2) * (o + a * (1.0 + side * ratio) + ratio * b)
    assert s.balancing_torque == pytest.approx(way * torque, rel=1e-13)


@every("speed", [12.0, -12.0])
def test_a_guide_alone_has_its_closed_form(speed):
    drive = {"crank_speed": speed, "loads": ks.Gravity()}
    free = ks.solve(STEEP, TURN, **drive)
    s = ks.solve(STEEP, TURN, **drive, friction={"guide": ks.GuideFriction(0.3)})
    coupler = s.placement.links["coupler"].direction
    feedback = 0.3 * np.sign(s.slider_velocity) * coupler[1] / coupler[0]
    expected = free.guide_force / (1.0 + feedback * np.sign(free.guide_force))
    assert np.abs(s.guide_force - expected).max() < 1e-13 * np.abs(expected).max()
    assert np.allclose(s.friction_margin, 1.0 - np.abs(feedback), rtol=0, atol=1e-14)
    assert np.allclose(s.guide_friction, -0.3 * np.sign(s.slider_velocity) * np.abs(s.guide_force), rtol=1e-14)


def test_tilted_shoe_has_more_friction():
    yoke = ks.scotch_yoke(0.1, slider=ks.Link(3.0))
    drive = {"crank_speed": 3.0, "loads": (ks.ProcessForce(100.0), ks.Gravity())}
    s = ks.solve(yoke, TURN, **drive, friction={"guide": ks.GuideFriction(0.2, 0.03)})
    pressed = np.maximum(np.abs(s.guide_force), np.abs(s.guide_moment) / 0.03)
    assert np.allclose(np.abs(s.guide_friction), 0.2 * pressed, rtol=1e-14)
    assert (np.abs(s.guide_force) * 0.03 > np.abs(s.guide_moment)).any()


def test_losses_are_extra_drive_power():
    s = rubbed()
    assert s.power_residual < 1e-14
    assert (s.friction_loss >= 0.0).all()
    parts = sum(s.friction_loss_at(name) for name in JOINTS)
    assert np.allclose(parts, s.friction_loss, rtol=1e-14)
    free = rubbed({})
    gained = (s.balancing_torque - free.balancing_torque) * 30.0
    assert np.allclose(gained, s.friction_loss, rtol=0, atol=1e-13 * np.abs(free.balancing_torque).max() * 30.0)


def test_cam_friction_feeds_on_itself():
    cam = ks.cam_crank_slider(ks.cams.Circle(0.1, (0.02, 0.0)), 0.4, slider=ks.Link(10.0))
    s = ks.solve(cam, TURN, crank_speed=20.0, friction={"cam": ks.RollerFriction(0.2, 0.03, 0.05)})
    share = 0.2 * 0.03 / 0.05
    along = np.abs(s.friction_at("cam"))
    assert np.allclose(along, share * np.hypot(s.cam_force, along), rtol=1e-14)
    assert s.power_residual < 1e-14


def test_guide_reaction_includes_friction():
    s = rubbed()
    assert np.array_equal(s.reaction("guide"), [s.guide_friction, s.guide_force])
    outer = rubbed({})
    assert not outer.guide_friction.any()
    assert not outer.friction_loss.any()
    assert outer.converged.all()


def test_a_pin_carries_all_its_rods():
    drawn = Drawn("six-bar", 1)
    s = drawn.scene.solve(8)
    assert np.allclose(s.pin_load("B"), s.reaction("B") - s.reaction("B2"), rtol=1e-15)
    assert np.allclose(s.pin_load("A"), -s.reaction("A"), rtol=0)


def test_without_friction_no_bit_changes():
    none = {"O": ks.PinFriction(0.0, 0.02), "guide": ks.GuideFriction(0.0, 0.1)}
    free, s = rubbed({}), rubbed(none)
    for name in free.reactions:
        assert np.array_equal(free.reaction(name), s.reaction(name))
    assert np.array_equal(free.balancing_torque, s.balancing_torque)
    assert free.apart[0] == rubbed({}).apart[0]


# Jamming


def test_jamming_guide_is_refused_with_angles():
    drive = {"crank_speed": 12.0, "loads": ks.Gravity(), "friction": {"guide": ks.GuideFriction(1.2)}}
    with pytest.raises(ks.JammingError, match=r"friction jams at .* crank angles, 5") as caught:
        ks.solve(STEEP, TURN, **drive)
    s = ks.solve(STEEP, TURN, **drive, on_gap="nan")
    jams = s.friction_margin <= 0.0
    assert np.array_equal(TURN[jams], caught.value.angles)
    assert np.array_equal(np.isnan(s.balancing_torque), jams)
    assert np.array_equal(s.converged, ~jams)


@every("half_length, jams", [(0.0201, False), (0.0199, True)])
def test_yoke_jams_with_a_short_shoe(half_length, jams):
    yoke, angle = ks.scotch_yoke(0.1, slider=ks.Link(3.0)), np.array([np.pi / 2])
    friction = {"guide": ks.GuideFriction(0.2, half_length)}
    s = ks.solve(yoke, angle, crank_speed=3.0, loads=ks.ProcessForce(100.0), friction=friction, on_gap="nan")
    assert (s.friction_margin[0] <= 0.0) == jams


@every("factor", [0.999, 1.001])
def test_centric_guide_jams_at_the_known_coefficient(factor):
    friction = {"guide": ks.GuideFriction(factor * np.sqrt((0.13 / 0.1) ** 2 - 1.0))}
    s = ks.solve(STEEP, np.array([np.pi / 2]), crank_speed=1.0, friction=friction, on_gap="nan")
    assert (s.friction_margin[0] > 0.0) == (factor < 1.0)


def test_what_is_not_found_to_rounding_is_said():
    s = rubbed()
    s._values["friction_residual"] = np.full(TURN.shape, 1e-6)
    assert not s.converged.any()
    with pytest.warns(ks.ConditionWarning, match="not converged to rounding at 90 of 90 crank angles"):
        jamming.check(s, "raise")


# Engines and derivatives


@pytest.mark.slow
def test_compiled_and_plain_programs_agree():
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    scene = ks.Scene(RUBBED, friction={name: JOINTS[name] for name in ("B", "guide")}, **DRIVE)
    compiled, plain = (ks.compile(scene, ("guide", "balancing_torque"), engine=name) for name in ("compiled", "numpy"))
    for name, values in plain(TURN).items():
        assert np.abs(compiled(TURN)[name] - values).max() < 1e-15 * np.abs(values).max()
    plain = rubbed()
    single = ks.solve(RUBBED, float(TURN[7]), friction=JOINTS, **DRIVE)
    assert single.balancing_torque == pytest.approx(plain.balancing_torque[7], rel=1e-14)


def test_enclosures_hold_what_is_computed():
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    from kinetostatics.mechanics.quantities import components
    from kinetostatics.studies.methods.high_precision.enclosures import enclosure

    s = ks.solve(RUBBED, TURN[::30], friction=JOINTS, **DRIVE)
    for name in ("balancing_torque", "friction_loss", "guide_friction", "B"):
        found = enclosure(s, name)
        for exact, own in zip(found.middle, components(s, name), strict=True):
            assert np.abs(exact - own).max() < 1e-14 * found.largest


@pytest.mark.slow
def test_derivatives_are_those_of_differences():
    program = ks.compile(SCENE, ("balancing_torque", "friction_loss"), engine="numpy")
    found = program.derivatives(TURN)
    for path in ("friction.guide.mu", "friction.A.radius", "coupler_length", "slider.mass", "crank_speed"):
        value = program.parameters[path]
        step = 1e-6 * abs(value)
        for name in ("balancing_torque", "friction_loss"):
            up, down = (program(TURN, {path: value + way * step})[name] for way in (1, -1))
            size = np.abs(found[name][path]).max()
            assert np.abs((up - down) / (2 * step) - found[name][path]).max() < 1e-6 * size


@pytest.mark.slow
def test_program_takes_other_coefficients():
    program = ks.compile(SCENE, "friction_loss", engine="numpy")
    two = np.array([[0.05], [0.2]])
    both = program(TURN, {"friction.guide.mu": two})["friction_loss"]
    for row, mu in zip(both, two.ravel(), strict=True):
        alone = SCENE.varied({"friction.guide.mu": float(mu)}).solve(TURN)
        assert np.allclose(row, alone.friction_loss, rtol=1e-13)
    assert rubbed({**JOINTS, "guide": ks.GuideFriction(two)}).shape == (2, 90)


# Where friction jumps


def test_extremes_stand_on_both_sides_of_a_jump():
    machine = ks.crank_slider(0.1, 0.3, coupler=ks.Link(2.0, (0.1, 0.0), 0.01), slider=ks.Link(4.0))
    friction = {"guide": ks.GuideFriction(0.1)}
    s = ks.solve(machine, TURN, crank_speed=5.0, friction=friction, loads=ks.Gravity())
    found = ks.extremes(s, "guide_friction")
    before, after = s.at(np.array([-1e-12, 1e-12])).guide_friction
    assert before * after < 0.0
    at_start = found.value[np.isclose(np.cos(found.angle), 1.0, atol=1e-15)]
    for limit in (before, after):
        assert np.isclose(found.value, limit, rtol=1e-10).any() or np.abs(found.value).max() > abs(limit)
    assert at_start.size
    fine = s.at(np.linspace(0.0, 2 * np.pi, 40001)).guide_friction
    assert found.range[0] <= fine.min() + 1e-9
    assert found.range[1] >= fine.max() - 1e-9
    there = s.at(s.sampled.kinks)
    zero = np.minimum(np.abs(there.slider_velocity), np.abs(there.guide_force) / 40.0)
    assert (zero < 1e-12).all()
    assert np.isclose(s.sampled.kinks, np.pi, atol=1e-12).any()


@pytest.mark.slow
def test_the_mean_torque_is_right_across_the_jumps():
    from kinetostatics.cycle.comparison import mean_absolute_torque

    s = rubbed(crank_acceleration=0.0, loads=ks.Gravity())
    ends = np.unique(np.concatenate([[0.0, 2 * np.pi], s.sampled.kinks]))
    edges = np.unique(np.concatenate([np.linspace(*pair, 9) for pair in itertools.pairwise(ends)]))
    nodes, weights = np.polynomial.legendre.leggauss(20)
    torque = lost = size = 0.0
    for start, stop in itertools.pairwise(edges):
        at, half = s.at(start + (stop - start) * (nodes + 1) / 2), (stop - start) / 2
        torque += half * np.dot(weights, at.balancing_torque)
        size += half * np.dot(weights, np.abs(at.balancing_torque))
        lost += half * np.dot(weights, at.friction_loss)
    assert torque * 30.0 == pytest.approx(lost, rel=1e-12)
    assert mean_absolute_torque(s) == pytest.approx(size / (2 * np.pi), rel=1e-4)


def test_tables_have_friction_and_losses():
    s = rubbed()
    columns = set(s.frame().columns)
    assert {"O_friction [N m]", "guide_friction [N]", "B_friction_loss [W]", "friction_loss [W]"} <= columns
    assert not [name for name in rubbed({}).frame().columns if "friction" in name]


def test_ordinary_machines_say_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rubbed()


def test_program_refuses_unsolved_friction():
    weak = {"O": ks.PinFriction(1e-4, 0.01), "B": ks.PinFriction(1e-4, 0.01), "guide": ks.GuideFriction(1e-4)}
    program = ks.compile(ks.Scene(RUBBED, friction=weak, **DRIVE), "balancing_torque", engine="numpy")
    program(TURN, {"friction.O.mu": 1.1e-4})
    strong = {"friction.B.mu": 0.9, "friction.B.radius": 0.2, "friction.O.mu": 0.9, "friction.O.radius": 0.2}
    with pytest.warns(ks.ConditionWarning, match="not converged to rounding"):
        program(TURN, strong)
    with pytest.raises(ks.ParameterError, match="crank_speed and crank_acceleration are both 0"):
        program(TURN, {"crank_speed": 0.0, "crank_acceleration": 0.0})


# What never moves, and what cannot be made


def test_a_rigid_triangle_does_not_rub_at_its_corners():
    """Two bars of a dyad on pins of one link do not turn against it; rounding decides no sign of friction there."""
    crank = ks.Crank(0.1, ks.Link(1.0, 0.05, 0.01))
    bars = {name: ks.Link(1.0, (0.1, 0.02), 0.01) for name in ("dyad1", "dyad2")}
    parts = ks.Pin(on="crank", at=(0.02, 0.1), name="C"), ks.Dyad(0.3, 0.4, on=("A", "C"), **bars)
    further = ks.Dyad(0.3, 0.35, on=("D", "C"), pin="E", label="_2")
    triangle = ks.Mechanism("rigid", crank, (*parts, further))
    pins = ("O", "dyad1_A", "dyad2_C", "D", "dyad1_2_D", "dyad2_2_C", "E")
    friction = {name: ks.PinFriction(0.2, 0.02) for name in pins}
    drive = {"crank_speed": 10.0, "crank_acceleration": 3.0, "loads": ks.Gravity()}
    s = ks.solve(triangle, TURN, **drive, friction=friction)
    for name in pins[1:]:
        assert not s.friction_at(name).any()
    alone = ks.solve(triangle, TURN, **drive, friction={"O": ks.PinFriction(0.2, 0.02)})
    assert np.array_equal(s.balancing_torque, alone.balancing_torque)


def test_roller_larger_than_its_path_is_refused():
    cam = ks.cam_crank_slider(ks.cams.Circle(0.1, (0.02, 0.0)), 0.4, slider=ks.Link(10.0))
    ks.Scene(cam, 1.0, friction={"cam": ks.RollerFriction(0.01, 0.02, 0.0999)})
    with pytest.raises(ks.ParameterError, match=r"roller_radius of 'cam', 0\.1 m, must be less than .* 0\.1 m"):
        ks.Scene(cam, 1.0, friction={"cam": ks.RollerFriction(0.01, 0.02, 0.1 + 1e-12)})


OPEN = {"coupler": ks.Link(2.0, 0.1, 0.01), "rocker": ks.Link(1.0, 0.05)}
LEGS = {name: ks.PinFriction(0.1, 0.01) for name in ("O", "A", "B", "O2")}


def parallelogram(angles, assembly):
    four_bar = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0.0), assembly=assembly, **OPEN)
    return ks.solve(four_bar, angles, crank_speed=10.0, loads=ks.Gravity(), friction=LEGS)


@pytest.mark.slow
@every("angle, assembly", [(0.7, "open"), (2.2, "crossed")])
def test_friction_follows_the_side_of_a_change_point(angle, assembly):
    """The same posture by its sign, off the change points: an assembly that keeps to one side passes none."""
    passing, *sides = (parallelogram([angle], side) for side in (assembly, 1, -1))
    same = min(sides, key=lambda s: float(np.abs(s.position("B") - passing.position("B")).max()))
    assert np.abs(same.position("B") - passing.position("B")).max() < 1e-12
    assert passing.balancing_torque == pytest.approx(same.balancing_torque, rel=1e-12)
    assert passing.friction_loss == pytest.approx(same.friction_loss, rel=1e-12)
    assert passing.power_residual < 1e-13


def test_jamming_at_change_points_is_reported():
    with pytest.raises(ks.JammingError, match="jams at 2 of 3 crank angles"):
        parallelogram([1e-3, np.pi - 1e-4, 1.0], "open")
    between = parallelogram([1.0, 2.0], "open")
    with pytest.warns(ks.ConditionWarning, match=r"friction jams between 0\.25 \.\.\. 359\.75 deg"):
        ks.extremes(between, "balancing_torque")
    with pytest.raises(ks.JammingError, match=r"^losses: four-bar: friction jams"):
        between.efficiency  # noqa: B018


# Friction of one pair, and the equations of all friction of a part

PASSES = 6
PARTS = [(3.0, -4.0), (-3.0, None), (None, 2.0), (-1.0, 0.5), (2.0, 2.5)]
SIZES = {"length": np.hypot, "larger": lambda a, b: max(abs(a), abs(b))}


@every("parts", PARTS)
@every("kind", SIZES)
def test_factor_times_direction_times_parts(kind, parts):
    law = FrictionLaw("B", 0.3, None, kind, ())
    size = SIZES[kind](*(0.0 if part is None else part for part in parts))
    assert size_of(kind, parts) == pytest.approx(size, rel=1e-15)
    along = zip(direction_of(law, parts), parts, strict=True)
    assert sum(one * other for one, other in along if other is not None) == pytest.approx(0.3 * size, rel=1e-15)


def test_a_number_has_its_size_or_is_itself():
    assert size_of("size", (-2.0,)) == 2.0
    assert size_of("itself", (-2.0,)) == -2.0
    assert direction_of(FrictionLaw("B", 0.3, None, "itself", ()), (-2.0,)) == (0.3,)
    assert direction_of(FrictionLaw("B", 0.3, None, "size", ()), (-2.0,)) == (-0.3,)
    assert size_of("length", (None, None)) is None


def test_kinks_lie_where_a_size_or_the_larger_changes():
    assert kink_functions("size", (-2.0,)) == [-2.0]
    assert kink_functions("length", (3.0, 4.0)) == []
    assert kink_functions("larger", (3.0, -4.0)) == [3.0, -4.0, -1.0]


def equations(factors, free, columns, kinds=None):
    """Laws whose reactions are ``free + columns amounts``, each with a channel of its own, one way."""
    names = [f"channel {number}" for number in range(len(factors))]
    kinds = kinds or ["size"] * len(factors)

    def reaction(place):
        return lambda found: (found.values[place],)

    laws = [
        FrictionLaw(name, factor, reaction(place), kind, ((Channel(name), 1),))
        for place, (name, factor, kind) in enumerate(zip(names, factors, kinds, strict=True))
    ]
    of = [SimpleNamespace(values=values) for values in (free, *np.transpose(columns).tolist())]
    return FrictionEquations(laws, names, of[0], of[1:])


@every("load, kappa", [(3.0, 0.4), (-3.0, 0.4), (3.0, -0.4), (-3.0, -0.4)])
def test_one_force_is_its_closed_form(load, kappa):
    """N = N0 + kappa mu |N|."""
    made = equations([0.5], [load], [[kappa]])
    (amount,) = made.solve(PASSES, 0.0)
    normal = load / (1.0 - 0.5 * kappa * np.sign(load))
    assert amount == pytest.approx(0.5 * abs(normal), rel=1e-15)
    assert made.margin == pytest.approx(0.8)
    assert made.residual < 1e-15


def test_coupled_friction_forces_satisfy_their_laws():
    columns, free, factors = np.array([[0.2, -0.5], [0.7, 0.1]]), np.array([4.0, -7.0]), np.array([0.3, 0.2])
    found = np.array(equations(factors.tolist(), free.tolist(), columns).solve(PASSES, 0.0))
    np.testing.assert_allclose(found, factors * np.abs(free + columns @ found), rtol=1e-15)


@every("kappa, jams", [(0.99, False), (1.01, True)])
def test_it_jams_where_feedback_reaches_one(kappa, jams):
    made = equations([1.0], [3.0], [[kappa]])
    with np.errstate(invalid="ignore"):
        (amount,) = made.solve(PASSES, 0.0)
    assert (made.margin < 0.0) == jams
    assert np.isnan(amount) == jams


def test_without_feedback_friction_is_found_at_once():
    made = equations([0.5, 0.25], [3.0, -2.0], [[None, None], [None, None]])
    assert made.margin is None
    assert made.solve(PASSES, 0.0) == [1.5, 0.5]


# Where friction jams

PUMP = ks.crank_slider(0.1, 0.2, slider=ks.Link(2.0))
AROUND = np.linspace(0.1, 2 * np.pi, 30)


@every("speed, acceleration, stands", [(0.0, 0.0, True), (0.0, 1.0, False), (2.0, 0.0, False)])
def test_a_crank_at_rest_has_no_friction_direction(speed, acceleration, stands):
    s = ks.solve(PUMP, AROUND, crank_speed=speed, crank_acceleration=acceleration)
    assert bool(jamming.problem_at_rest(s)) == stands


def test_friction_converges_to_the_last_digit():
    assert jamming.converged(np.array([1.0, 1.0, -1.0]), np.array([1e-14, 1e-9, 0.0])).tolist() == [True, False, False]


@every(
    "margin, residuals, passes",
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


def test_other_crank_angles_get_the_passes_that_they_need():
    scene, angles = PulsedScene(125).scene, np.linspace(0.0, 2 * np.pi, 1000)
    start, whole = scene.solve(1), scene.solve(angles)
    assert (start.friction.passes, whole.friction.passes) == (3, 6)
    assert np.array_equal(start.at(angles).balancing_torque, whole.balancing_torque)
    assert start.unsolved_at(angles).friction.passes == 3  # for motion alone


def test_friction_that_does_not_converge_at_other_crank_angles_is_said(monkeypatch):
    s = ks.Scene(PUMP, 3.0, loads=ks.Gravity(), friction={"A": ks.PinFriction(0.1, 0.01)}).solve(1)
    monkeypatch.setattr(jamming, "MAX_CHANGE", -1.0)
    with pytest.warns(ks.ConditionWarning, match="not converged to rounding") as found:
        s.at(TURN)
    assert found[0].filename == __file__


def states(kappa, free):
    """Forces N of a guide alone with N = free - kappa |N|."""
    both = free / (1.0 + kappa), free / (1.0 - kappa)
    return [force for force, sign in zip(both, (1.0, -1.0), strict=True) if sign * force > 0.0]


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_the_margin_of_a_guide_decides_uniqueness():
    loads, friction = (ks.Gravity(), ks.ProcessForce(500.0)), {"guide": ks.GuideFriction(2.5)}
    s = ks.solve(PUMP, AROUND, crank_speed=3.0, loads=loads, friction=friction, on_gap="nan")
    kappa = 1.0 - s.friction_margin
    assert kappa == pytest.approx(2.5 * np.abs(np.sin(AROUND)) / np.sqrt(4.0 - np.sin(AROUND) ** 2), rel=1e-12)
    for size, jams in zip(kappa, np.isnan(s.balancing_torque), strict=True):
        counts = {len(states(way * size, free)) for way in (1.0, -1.0) for free in (1.0, -1.0)}
        assert counts == ({0, 2} if jams else {1})
