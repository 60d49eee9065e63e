"""How many digits results have: `condition` as a bound, at limit positions, and its warning."""

import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.assembly import HALF_DIGITS_CONDITION
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.solution import condition
from kinetostatics.solution.condition import is_surely_well_conditioned
from support.every import every
from support.machines import ANGLES, planar, turning

TURN = np.linspace(0.0, 2 * np.pi, 1441)
BODY = ks.Link(3.0, 0.5, 2.0)
ROD = ks.Link(2.0, 0.5, 1.0)


def solved(mechanism, angle=ANGLES, loads=(), **options):
    return ks.solve(mechanism, angle, crank_speed=3.0, loads=loads, **options)


def unwarned(mechanism, angle, loads=(ks.Gravity(),), speed=5.0):
    """A solution without any check."""
    return ks.Solution(mechanism, np.asarray(angle, dtype=float), speed, 0.0, tuple(loads))


# What it means


def test_a_batch_has_a_row_of_conditions_per_design():
    lengths = np.array([[0.31], [0.5], [2.0]])
    found = solved(ks.crank_slider(0.3, lengths)).condition
    assert found.shape == (3, ANGLES.size)
    for row, length in zip(found, lengths[:, 0], strict=True):
        np.testing.assert_allclose(row, solved(ks.crank_slider(0.3, length)).condition, rtol=1e-12)


def test_conditions_of_many_angles_come_in_blocks(monkeypatch):
    whole = solved(ks.crank_slider(0.3, 0.5)).condition
    monkeypatch.setattr(condition, "BLOCK_SIZE", 7)
    assert np.array_equal(solved(ks.crank_slider(0.3, 0.5)).condition, whole)


def test_condition_grows_with_the_number_of_turns():
    turns = 2 * np.pi * np.array([1e3, 1e5, 1e7])
    found = unwarned(ks.crank_slider(0.3, 2.0, slider=BODY), 0.7 + turns).condition
    assert np.all(found > turns)
    np.testing.assert_allclose(found[1:] / found[:-1], 100.0, rtol=0.05)


def test_a_radius_table_has_the_cam_s_condition():
    """Of a table the size alone counts as a length, not each radius."""
    circle = ks.cams.Circle(0.3, (0.1, 0.05))
    table = ks.cams.Sampled(TURN[:-1], circle.radius(TURN[:-1])[0])
    exact, sampled = (unwarned(ks.cam_crank_slider(cam, 2.0, slider=BODY), ANGLES).condition for cam in (circle, table))
    assert np.all((sampled > 0.1 * exact) & (sampled < 3 * exact))


@every(
    "force",
    [
        200.0,
        200.0 + 10.0 * ANGLES,
        lambda motion: -40.0 * motion.slider_velocity,
        lambda motion: np.where(motion.slider_velocity > 0, -200.0, 100.0),
        lambda motion: np.interp(motion.crank_angle, TURN, 200.0 + np.cos(TURN)),
        lambda motion: 1e2 + np.arange(motion.crank_angle.size),
    ],
)
def test_condition_knows_every_kind_of_process_force(force):
    found = unwarned(ks.crank_slider(0.3, 2.0, slider=BODY), ANGLES, [ks.ProcessForce(force)]).condition
    assert np.all((found > 3) & (found < 3e3))


class Choosy(ks.SliderGroup):
    """A group of the user's own that looks at values, so it takes one crank angle at a time."""

    def place(self, placement):
        """Look at where A is."""
        super().place(placement)
        assert placement.joints["A"].position[0] < 10.0


class Opaque(ks.SliderGroup):
    """A group of the user's own by functions of plain numbers."""

    def place(self, placement):
        """Take an angle."""
        super().place(placement)
        np.arctan2(*placement.joints["A"].position)


@pytest.mark.parametrize(("kind", "angles"), [(Choosy, ANGLES[:1]), (Opaque, ANGLES)])
def test_groups_not_recorded_have_it_by_differences(kind, angles):
    own = unwarned(ks.Mechanism("own", ks.Crank(0.3), (kind(0.5, slider=BODY),)), angles)
    with pytest.warns(ks.ConditionWarning, match=r"own: a group of it .* condition follows from differences"):
        found = own.condition
    exact = unwarned(ks.crank_slider(0.3, 0.5, slider=BODY), angles).condition
    np.testing.assert_allclose(found, exact, rtol=1e-6)


@pytest.mark.slow
def test_lengths_of_another_library_are_refused():
    jnp = pytest.importorskip("jax.numpy", reason="JAX is not installed (extra: grad)")
    s = unwarned(ks.crank_slider(jnp.asarray(0.3), 0.5, slider=BODY), ANGLES)
    with pytest.raises(ks.errors.NotGivenError, match=r"no condition, .* arrays of another library"):
        s.condition  # noqa: B018


@pytest.mark.parametrize(
    "mechanism",
    [
        ks.crank_slider(1.0, 0.6, guide_angle=0.3, guide_offset=0.1),
        ks.four_bar(3.5, 1.0, 3.0, rocker_pivot=(4.0, 0.0)),
        ks.four_bar(2.0, 3.0, 3.5, rocker_pivot=(0.3, 5.0)),
    ],
)
def test_condition_is_nan_exactly_in_gaps(mechanism):
    s = solved(mechanism, TURN, on_gap="nan")
    gap = np.isnan(s.position("B")[0])
    assert 0 < gap.sum() < TURN.size
    for values in (s.condition, s.rate("coupler"), s.balancing_torque, s.reaction("A")[0]):
        assert np.array_equal(np.isnan(values), gap)


# At limit positions


def at_limits():
    """Mechanisms with a crank angle at which they stand in a limit position, exact but for rounding."""
    for turn in (0.0, 0.3, np.pi):
        for crank, coupler, offset, angle in (
            (0.3, 0.5, 0.2, -np.pi / 2),
            (0.3, 0.5, -0.2, np.pi / 2),
            (0.5, 0.5, 0.0, np.pi / 2),
            (0.5, 0.5, 0.0, -np.pi / 2),
        ):
            for assembly in (1, -1):
                guide = {"guide_angle": turn, "guide_offset": offset, "assembly": assembly}
                yield ks.crank_slider(crank, coupler, **guide, **SLIDER), turn + angle
        for crank, coupler, rocker, frame, angle in (
            (0.3, 0.7, 0.6, 1.0, np.pi),
            (0.3, 0.9, 0.2, 1.0, 0.0),
            (0.3, 0.2, 0.9, 1.0, 0.0),
            (1.0, 2.0, 1.0, 2.0, 0.0),
            (1.0, 2.0, 2.0, 1.0, 0.0),
            (1.0, 0.7, 0.7, 1.0, 0.0),
        ):
            for assembly in (1, -1):
                pivot = frame * np.cos(turn), frame * np.sin(turn)
                yield ks.four_bar(crank, coupler, rocker, rocker_pivot=pivot, assembly=assembly, **ROCKER), turn + angle


SLIDER = {"coupler": ks.Link(2.0, (0.2, 0.05), 0.1), "slider": ks.Link(3.0)}
ROCKER = {"coupler": ks.Link(2.0, (0.2, 0.05), 0.1), "rocker": ks.Link(3.0, 0.1, 0.1)}


def everything(s):
    """All positions, velocities, accelerations, rates, forces and moments."""
    points = [*s.placement.joints, *s.mechanism.links]
    vectors = [ask(name) for ask in (s.position, s.velocity, s.acceleration) for name in points]
    rates = [ask(name) for ask in (s.rate, s.angular_acceleration) for name in s.mechanism.links]
    forces = [*map(s.reaction, s.reactions), *map(s.scalar, s.scalars), s.shaking_force, s.shaking_moment]
    return [*vectors, *rates, *forces, s.balancing_torque_by_power]


@pytest.mark.slow
def test_results_at_limit_positions_are_finite():
    for mechanism, angle in at_limits():
        with pytest.warns(ks.ConditionWarning, match="near a limit position"):
            s = solved(mechanism, np.array([angle, angle + 0.3]), [ks.Gravity()], on_gap="raise")
        assert all(np.all(np.isfinite(values[..., 0])) for values in everything(s)), (mechanism, angle)
        assert s.condition[0] > 1e14


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*near a limit position:kinetostatics.errors.ConditionWarning")
def test_loops_close_around_limits_on_the_chosen_side():
    """Coupler and rocker keep their lengths to rounding, the slider stays on its guide, and B on its side."""
    steps = np.concatenate([[0.0], *(sign * 10.0 ** -np.arange(1.0, 18.0) for sign in (1, -1))])
    for mechanism, angle in at_limits():
        s = solved(mechanism, angle + steps, on_gap="nan")
        (group,) = mechanism.groups
        A, B = planar(s.position("A")), planar(s.position("B"))
        closed = np.isfinite(B)
        assert closed.sum() > 5
        rounding = 2e-15 * (mechanism.crank.length + max(bar.length for bar in group.bars))
        for bar in group.bars:
            gap = abs(B - planar(s.position(bar.start))) - bar.length
            assert np.all(abs(gap[closed]) <= rounding), (mechanism.bars, angle, bar.link)
        if isinstance(group, ks.SliderGroup):
            guide = complex(*group.guide.direction)
            assert np.all(abs((B / guide).imag - group.guide.guide_offset)[closed] <= rounding)
            ahead = ((B - A) / guide).real
        else:
            ahead = turning(complex(*group.pivot) - A, B - A)
        assert np.all(group.assembly * ahead[closed] >= -rounding)
        assert np.all(group.assembly * ahead[1:5] > 0) or np.isnan(ahead[1])


# The warning


def caught(mechanism, angle, loads=(ks.Gravity(),), **options):
    """Condition warnings of `solve`."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", ks.ConditionWarning)
        ks.solve(mechanism, np.asarray(angle, dtype=float), crank_speed=5.0, loads=loads, **options)
    return [str(item.message) for item in found]


def four_bar(*lengths):
    crank, coupler, rocker, frame = lengths
    return ks.four_bar(crank, coupler, rocker, rocker_pivot=(frame, 0.0), coupler=BODY, rocker=ROD)


@pytest.mark.slow
@every("loads", [(), ks.Gravity()])
@every(
    ("mechanism", "angle", "digits"),
    [
        (four_bar(1, 1, 1, 1), 1e-6, "0"),
        (four_bar(1, 3, 2, 4), np.pi - 1e-6, "0"),
        (ks.crank_slider(1.0, 1.0), np.pi / 2 + 1e-4, "2"),
        (ks.four_bar(1, 1, 1, rocker_pivot=(1, 0)), np.pi + 1.3e-4, "2"),
        (ks.crank_slider(1.0, 1.0), np.pi / 2, "0"),
    ],
)
def test_the_warning_names_the_digits_left(mechanism, angle, digits, loads):
    (text,) = caught(mechanism, [0.7, angle, 0.9], loads)
    assert f"about {digits} correct digits" in text
    assert f"at crank angle {np.degrees(angle):.9g} deg" in text
    assert "1 of 3 crank angles lose half of their digits" in text


def test_a_torque_without_a_correct_digit_is_reported():
    """6706 N m for 39.24 N m, 1e-6 rad after A has passed O2."""
    with pytest.warns(ks.ConditionWarning, match="about 0 correct digits"):
        s = ks.solve(four_bar(1, 1, 1, 1), 1e-6, crank_speed=5.0, loads=ks.Gravity())
    assert s.condition > 1e16


def test_angles_after_too_many_turns_give_a_warning():
    (text,) = caught(ks.crank_slider(0.3, 2.0, slider=BODY), [0.3, 1e9 + 0.3])
    assert "1 of 2 crank angles" in text


def test_ordinary_mechanisms_skip_the_condition(monkeypatch):
    def never(*_):
        raise AssertionError

    monkeypatch.setattr(condition, "condition", never)
    link = ks.Link(150.0, 1.0, 20.5)
    for mechanism in (
        ks.crank_slider(0.3, 2.0, guide_offset=0.1, guide_angle=0.4, coupler=link),
        ks.cam_crank_slider(ks.cams.Circle(0.3, (0.1, 0.05)), 2.0, coupler=link),
        ks.cam_crank_slider(cosine := ks.cams.CosineLaw(0.3, 2.0), cosine.coupler_length, coupler=link),
        ks.four_bar(0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.4), coupler=link),
    ):
        assert caught(mechanism, ANGLES) == []


# Against the true magnification


class Draw:
    """Random designs, shape (designs, 1)."""

    def __init__(self, seed, count):
        self.random, self.shape = np.random.default_rng(seed), (count, 1)

    def between(self, low, high):
        """Evenly."""
        return self.random.uniform(low, high, self.shape)

    def scale(self, low, high):
        """Evenly by the logarithm."""
        return np.exp(self.between(np.log(low), np.log(high)))

    def link(self, length):
        """A link with its mass centre beside its axis."""
        centre = self.between(0.0, 1.0) * length, self.between(-0.2, 0.2) * length
        return ks.Link(self.scale(0.1, 10.0), centre, self.scale(0.01, 1.0) * length**2)

    def slider(self, share=1.0):
        """Crank-slider on an inclined guide off O; shorter couplers by a smaller share."""
        crank, coupler = self.scale(0.1, 1.0), self.scale(0.5, 5.0) * share
        links = {"crank": self.link(crank), "coupler": self.link(coupler), "slider": ks.Link(self.scale(0.1, 10.0))}
        guide = {"guide_angle": float(self.random.uniform(-3, 3)), "guide_offset": self.between(-0.3, 0.3)}
        return ks.crank_slider(crank, coupler, **guide, **links)

    def cam(self):
        """Circle cam."""
        radius, coupler = self.scale(0.1, 1.0), self.scale(0.5, 5.0)
        cam = ks.cams.Circle(radius, (radius * self.between(-0.69, 0.69), radius * self.between(-0.69, 0.69)))
        links = {"coupler": self.link(coupler), "block": self.link(0.1 * radius), "slider": self.link(0.1 * coupler)}
        return ks.cam_crank_slider(cam, coupler, guide_angle=0.4, guide_offset=self.between(-0.3, 0.3), **links)

    def rocker(self, **names):
        """Rocker group."""
        coupler, rocker = self.scale(0.5, 3.0), self.scale(0.5, 3.0)
        pivot = (self.between(-1.5, 1.5), self.between(-1.5, 1.5))
        links = self.link(coupler), self.link(rocker)
        return ks.RockerGroup(coupler, rocker, pivot, int(self.random.choice([-1, 1])), *links, **names)

    def four_bar(self):
        """Four-bar."""
        crank = self.scale(0.1, 1.0)
        return ks.Mechanism("four-bar", ks.Crank(crank, self.link(crank)), (self.rocker(),))

    def six_bar(self):
        """Four-bar that drives a slider."""
        coupler = self.scale(0.5, 5.0)
        slider = ks.Link(self.scale(0.1, 10.0))
        guide = ks.Guide.at(0.4, self.between(-0.5, 0.5))
        group = ks.SliderGroup(coupler, guide, 1, self.link(coupler), slider, on="B", pin="C", label="2")
        four_bar = self.four_bar()
        return ks.Mechanism("six-bar", four_bar.crank, (*four_bar.groups, group))

    def two_rockers(self):
        """Four-bar that drives a four-bar."""
        four_bar = self.four_bar()
        group = self.rocker(on="B", pin="C", pivot_name="O3", label="2")
        return ks.Mechanism("two four-bars", four_bar.crank, (*four_bar.groups, group))


RANDOM = {
    "slider": lambda draw: draw.slider(),
    "slider with a short coupler": lambda draw: draw.slider(0.3),
    "cam": Draw.cam,
    "four-bar": Draw.four_bar,
    "six-bar": Draw.six_bar,
    "two four-bars": Draw.two_rockers,
}


def assert_bound(solution, allowed=1e4):
    """True magnification <= condition <= `allowed` times it; errors within a hundred roundings of the condition."""
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    from support import magnification

    true, errors = magnification.truly_magnified(solution)
    found = solution.condition
    closed = np.isfinite(true) & ~np.isnan(found)
    assert closed.any()
    assert np.all(true[closed] <= found[closed])
    known = closed & np.isfinite(found)
    assert np.all(found[known] <= allowed * true[known])
    assert np.all(errors[known] <= 100 * UNIT_ROUNDOFF * found[known])
    return known.sum()


@pytest.mark.slow
@pytest.mark.parametrize("kind", RANDOM)
def test_condition_bounds_the_true_magnification(kind):
    """Twenty of each kind, at four crank angles."""
    draw = Draw(11, 20)
    angle = draw.random.uniform(0.0, 2 * np.pi, (20, 4))
    loads = (ks.Gravity(), ks.Spring(500.0, 1.0)) if "slider" in kind or kind == "cam" else (ks.Gravity(),)
    mechanism = RANDOM[kind](draw)
    s = ks.Solution(mechanism, angle, draw.scale(1.0, 30.0), draw.between(-9.0, 9.0), loads)
    with np.errstate(all="ignore"):
        assert assert_bound(s, allowed=100.0) >= 20


COSINE = ks.cams.CosineLaw(0.3, 2.0)
HEAVY = {"coupler": BODY, "slider": ks.Link(2.0)}
SPECIAL = {
    "rhombus folded": (four_bar(1, 1, 1, 1), np.pi),
    "rhombus, A passes O2": (four_bar(1, 1, 1, 1), 0.0),
    "kite, A passes O2": (four_bar(1, 2, 2, 1), 0.0),
    "kite folded": (four_bar(1, 1, 2, 2), np.pi),
    "parallelogram": (four_bar(1, 2, 1, 2), 0.0),
    "parallelogram folded": (four_bar(1, 2, 1, 2), np.pi),
    "one change point": (four_bar(1, 3, 2, 4), np.pi),
    "toggle": (four_bar(0.3, 0.9, 0.2, 1.0), 0.0),
    "coupler as long as the crank": (ks.crank_slider(1.0, 1.0, **HEAVY), np.pi / 2),
    "limit position": (ks.crank_slider(0.3, 0.5, guide_offset=0.2, **HEAVY), -np.pi / 2),
    "limit position, inclined": (ks.crank_slider(2.0, 2 * np.sin(0.7), guide_angle=0.3, **HEAVY), 1.0),
    "dead centre, inclined": (ks.crank_slider(0.3, 2.2, guide_angle=1.3, **HEAVY), 1.3),
    "dead centre, inclined off O": (ks.crank_slider(0.3, 2.2, guide_angle=1.3, guide_offset=0.4, **HEAVY), 1.3),
    "singular angle": (ks.cam_crank_slider(COSINE, COSINE.coupler_length, **HEAVY), float(COSINE.singular_angle)),
}


@pytest.mark.slow
@every("name", SPECIAL)
def test_condition_bounds_it_near_special_positions(name):
    """From 0.1 to 1e-10 rad on both sides; infinite within some roundings of the position."""
    mechanism, angle = SPECIAL[name]
    steps = 10.0 ** -np.arange(1.0, 11.0)
    s = unwarned(mechanism, np.concatenate([angle - steps, angle + steps]))
    with np.errstate(all="ignore"):
        assert assert_bound(s, allowed=200.0) >= 5


@pytest.mark.parametrize("distance", 10.0 ** -np.arange(1.0, 11.0, 3.0))
def test_condition_bounds_it_for_unequal_lengths(distance):
    far = 1 / distance
    for mechanism, angle in (
        (ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.3 * (1 - distance), 0.0)), 2.0, **HEAVY), [0.0, 0.3, np.pi / 2]),
        (ks.crank_slider(0.3, 2 * far, guide_offset=1.9 * far, **HEAVY), [1.0, 2.0]),
        (ks.crank_slider(far, 2.0, guide_offset=far * np.sin(1.0) + 0.3, **HEAVY), [1.0]),
        (four_bar(far, 1.2, 1.0, far), [0.3 * distance, distance]),
        (ks.crank_slider(0.3, 2.0, guide_offset=0.1, **HEAVY), [0.1 * far, 0.2 * far]),
    ):
        with np.errstate(all="ignore"):
            assert_bound(unwarned(mechanism, angle), allowed=200.0)


# The first look


def near_limits(draw, kind):
    """Designs of any proportions with sines or cosines down to 1e-5, and a crank angle of each."""
    crank, coupler, rocker = (draw.scale(0.01, 10.0) for _ in range(3))
    angle, turn, square = draw.between(0.0, 6.28), draw.between(0.0, 6.28), 10.0 ** draw.between(-10.0, 0.0)
    cosine = np.sign(draw.between(-1.0, 1.0)) * np.sqrt(1 - square)
    links = {"crank": draw.link(crank), "coupler": draw.link(coupler)}
    if kind == "slider":
        offset = crank * np.sin(angle - 0.7) + cosine * coupler
        return ks.crank_slider(
            crank, coupler, guide_angle=0.7, guide_offset=offset, slider=ks.Link(1.0), **links
        ), angle
    distance = np.sqrt(coupler**2 + rocker**2 - 2 * coupler * rocker * cosine)
    pivot = crank * np.exp(1j * angle) + distance * np.exp(1j * turn)
    links["rocker"] = draw.link(rocker)
    return ks.four_bar(crank, coupler, rocker, rocker_pivot=(pivot.real, pivot.imag), **links), angle


def rows(item, number):
    """One design of a batch."""
    from kinetostatics.numbers.parameter_tree import map_numbers

    return map_numbers(item, lambda value: float(np.broadcast_to(value, (400, 1))[number, 0]))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["slider", "four-bar"])
def test_the_plausibility_test_misses_no_large_loss(kind):
    draw = Draw(23, 400)
    batch, angle = near_limits(draw, kind)
    s = unwarned(batch, angle)
    lost = s.condition[:, 0] > HALF_DIGITS_CONDITION
    (margin,) = s.closure
    passed = [
        is_surely_well_conditioned(unwarned(rows(batch, number), angle[number]), [margin[number]])
        for number in range(400)
    ]
    assert 100 < lost.sum() < 300
    assert sum(passed) > 40
    assert not np.any(lost & passed)


@pytest.mark.parametrize("kind", ["slider with a short coupler", "cam", "two four-bars"])
def test_lossy_angles_are_those_of_large_condition(kind):
    draw = Draw(29, 12)
    s = ks.Solution(RANDOM[kind](draw), TURN[::4], 7.0, 0.0, (ks.Gravity(),))
    lost = s.condition > HALF_DIGITS_CONDITION
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        condition.warn_of_lost_digits(s.dynamics, s.dynamics.closure)
    texts = [str(item.message) for item in found]
    assert bool(texts) == lost.any()
    for text in texts:
        assert f"; {lost.sum()} of {lost.size} crank angles lose half" in text
        assert f"magnified {np.nanmax(s.condition):.3g} times" in text


def test_a_slotted_lever_is_ordinary_at_dead_centres():
    """There it stands still for an instant, and forces are what they are nearby."""
    lever = ks.slotted_lever(0.1, pivot=(0.0, -0.2), lever=ks.Link(3.0, 0.2, 0.05), block=ks.Link(1.0))
    dead = -np.arcsin(0.5) + np.array([-1e-3, -1e-9, 0.0, 1e-9, 1e-3])
    s = ks.solve(lever, dead, crank_speed=9.0, loads=ks.Gravity())
    assert np.all(s.condition < 100.0)
    assert np.all(s.condition > 1.0)


def test_cylinder_and_yoke_are_ordinary_at_rest():
    swinging = ks.Mechanism("pump", ks.Crank(0.1), (ks.CylinderGroup((0.4, 0.0), cylinder=ks.Link(3.0, 0.1, 0.02)),))
    yoke = ks.Mechanism("yoke", ks.Crank(0.1), (ks.YokeGroup(ks.Guide.at(0.0), slider=ks.Link(3.0)),))
    still = ks.solve(swinging, [np.arccos(0.25), np.arccos(0.25) + 1e-9], crank_speed=9.0)
    assert np.all(still.condition < 200.0)
    assert np.all(ks.solve(yoke, [0.0, 1e-9, 1.0], crank_speed=9.0).condition < 100.0)
