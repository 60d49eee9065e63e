"""How many digits results have: `condition` by its meaning, at limit positions, and against true changes."""

from typing import NamedTuple

import numpy as np
import pytest
from four_bars import turning
from machines import ANGLES, planar

import kinetostatics as ks

UNIT = 2.0**-53
TURN = np.linspace(0.0, 2 * np.pi, 1441)
each_assembly = pytest.mark.parametrize("assembly", [1, -1])


def solved(mechanism, angle=ANGLES, loads=(), **options):
    return ks.solve(mechanism, angle, crank_speed=3.0, loads=loads, **options)


# What it means


def assert_from_first_to_second_power(condition, cosine, proportion):
    """1 / cos^2 in proportion, and more, up to its square, only where terms of the angular acceleration cancel."""
    first = np.maximum(proportion / cosine**2, 1 / abs(cosine))
    assert np.all(condition > first * (1 - 1e-12))
    assert np.all(condition < first / cosine**2 * (1 + 1e-12))


@each_assembly
def test_condition_of_a_slider_group_is_that_of_the_coupler_against_the_guide(assembly):
    s = solved(ks.crank_slider(0.3, 0.5, guide_angle=0.4, guide_offset=0.07, assembly=assembly))
    coupler = planar(s.position("B")) - planar(s.position("A"))
    assert_from_first_to_second_power(s.condition, (coupler * np.exp(-0.4j)).real / 0.5, 1 + 0.3 / 0.5)


@each_assembly
def test_condition_of_a_four_bar_is_that_of_the_transmission_angle(assembly):
    s = solved(ks.four_bar(0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.4), assembly=assembly))
    span = abs(planar(s.position("A")) - (0.7 + 0.4j))
    proportion = span * (0.3 + abs(0.7 + 0.4j) + 0.8 + 0.6) / (0.8 * 0.6)
    assert_from_first_to_second_power(s.condition, np.sin(ks.linkage.transmission_angle(s)), proportion)


def test_condition_of_a_cam_is_that_of_the_pressure_angle():
    cam = ks.cams.Circle(0.3, (-0.2, 0.1))
    s = solved(ks.Mechanism("cam", ks.Crank(), (ks.CamRoller(cam),)))
    np.testing.assert_allclose(s.condition, 1 / np.cos(cam.pressure_angle(ANGLES)) ** 2, rtol=1e-14)


def test_condition_of_a_chain_is_the_product_over_its_groups():
    left, right = ks.SliderGroup(0.9), ks.SliderGroup(0.8, ks.Guide.at(1.2, 0.1), pin="C", label="2")
    engines = (ks.Mechanism("V engine", ks.Crank(0.5), groups) for groups in ((left, right), (left,), (right,)))
    both, *alone = (solved(engine).condition for engine in engines)
    np.testing.assert_allclose(both, alone[0] * alone[1], rtol=1e-14)
    assert both.max() > 1.5


def test_condition_of_a_batch_has_a_row_for_each_design():
    lengths = np.array([[0.31], [0.5], [2.0]])
    found = solved(ks.crank_slider(0.3, lengths)).condition
    assert found.shape == (3, ANGLES.size)
    assert found[0].max() > 10 > 1.3 > found[2].max()


@pytest.mark.parametrize(
    "mechanism",
    [
        ks.crank_slider(1.0, 0.6, guide_angle=0.3, guide_offset=0.1),
        ks.four_bar(3.5, 1.0, 3.0, rocker_pivot=(4.0, 0.0)),
        ks.four_bar(2.0, 3.0, 3.5, rocker_pivot=(0.3, 5.0)),
    ],
)
def test_condition_is_nan_exactly_in_gaps_as_all_results_are(mechanism):
    s = solved(mechanism, TURN, on_gap="nan")
    gap = np.isnan(s.position("B")[0])
    assert 0 < gap.sum() < TURN.size
    for values in (s.condition, s.rate("coupler"), s.balancing_torque, s.reaction("A")[0]):
        assert np.array_equal(np.isnan(values), gap)


# At limit positions


def at_limits():
    """Mechanisms with a crank angle at which they stand in a limit position, exact but for rounding."""
    for turn in (0.0, 0.3, np.pi / 2, 2.0, np.pi, -0.7):
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


def test_all_results_at_exact_limit_positions_are_finite_and_warned_of():
    for mechanism, angle in at_limits():
        with pytest.warns(ks.ConditionWarning, match="near a limit position"):
            s = solved(mechanism, np.array([angle, angle + 0.3]), [ks.Gravity()], on_gap="raise")
        assert all(np.all(np.isfinite(values[..., 0])) for values in everything(s)), (mechanism, angle)
        assert s.condition[0] > 1e14


def test_loops_close_at_and_around_limit_positions_on_the_chosen_side():
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


# Against true changes


class Family(NamedTuple):
    """Random designs near limit positions: numbers by name, shape (designs, 1), and crank angles of that shape."""

    numbers: dict
    angle: np.ndarray
    assembly: int
    sine: float

    def solve(self, numbers, angle):
        """Under a force of 1 N on the last slider, or a weight of 1 N at the rocker pin."""
        own = dict(zip(self.numbers, numbers, strict=True))
        loads = [ks.ProcessForce(1.0, on="slider2" if "coupler2" in own else "slider")]
        if "rocker" in own:
            pin = {"rocker": ks.Link(1.0, own["rocker"])}
            loads = [ks.Gravity(1.0)]
            group = ks.RockerGroup(own["coupler"], own["rocker"], (own["x"], own["y"]), self.assembly, **pin)
        else:
            group = ks.SliderGroup(own["coupler"], ks.Guide((own["ux"], own["uy"]), own["offset"]), self.assembly)
        groups = [group]
        if "coupler2" in own:
            guide = ks.Guide((own["uy"], own["ux"]), own["offset2"])
            groups.append(ks.SliderGroup(own["coupler2"], guide, -self.assembly, on="B", pin="C", label="2"))
        mechanism = ks.Mechanism("family", ks.Crank(own["crank"]), tuple(groups))
        return ks.solve(mechanism, angle, crank_speed=1.0, loads=loads, on_gap="nan")

    def results(self, numbers, angle):
        """Rates, angular accelerations and torque (quantities, designs)."""
        s = self.solve(numbers, angle)
        links = [name for name in ("coupler", "rocker", "coupler2") if name in s.mechanism.links]
        rates = [s.rate(name) for name in links] + [s.angular_acceleration(name) for name in links]
        return np.array([*rates, s.balancing_torque])[..., 0]

    def magnified(self, flint):
        """Condition, largest true change of a result by that of a length, largest error by rounding, (designs,).

        Relative to the result or, where it passes through zero, to what it is if the crank pin moves as it is worst.
        """
        numbers = list(self.numbers.values())
        condition, found = self.solve(numbers, self.angle).condition[:, 0], self.results(numbers, self.angle)
        exact = np.vectorize(flint.arb, otypes="O")
        numbers, angle, step = exact(numbers), exact(self.angle), flint.arb("1e-25")
        true = self.results(numbers, angle)
        lengths = [self.numbers[name][:, 0] for name in ("coupler", "rocker", "coupler2") if name in self.numbers]
        pin = self.numbers["crank"][:, 0] / self.sine
        fast = [pin / length for length in lengths]
        if "coupler2" in self.numbers:
            fast[1], pin = fast[1] / self.sine, pin / self.sine
        scale = np.maximum(np.abs(true.astype(float)), [*fast, *fast, pin])
        changes = np.zeros(scale.shape)
        for number, name in enumerate(self.numbers):
            if name not in ("ux", "uy"):
                more = numbers.copy()
                more[number] *= 1 + step
                changes = np.maximum(changes, np.abs((self.results(more, angle) - true) / step).astype(float))
        errors = np.abs((exact(found) - true).astype(float))
        return condition, np.max(changes / scale, axis=0), np.max(errors / scale, axis=0) / UNIT


def family(kind, proportion, margin, random, count=16):
    """Designs with a square of sine or cosine of `margin`; crank, or rocker, `proportion` times the coupler."""
    coupler, angle, turn = 10.0 ** random.uniform(-1, 1, count), *random.uniform(0.0, 6.28, (2, count))
    small, assembly = random.choice([-1, 1], count) * np.sqrt(1 - margin), int(random.choice([-1, 1]))
    if kind == "four-bar":
        crank, rocker = 0.5 * coupler, coupler * proportion
        distance = np.sqrt(coupler**2 + rocker**2 - 2 * coupler * rocker * small)
        pivot = crank * np.exp(1j * angle) + distance * np.exp(1j * turn)
        numbers = {"crank": crank, "coupler": coupler, "rocker": rocker, "x": pivot.real, "y": pivot.imag}
    else:
        crank = coupler * proportion
        offset = crank * np.sin(angle - turn) + small * coupler
        numbers = {"crank": crank, "coupler": coupler, "offset": offset, "ux": np.cos(turn), "uy": np.sin(turn)}
    if kind == "slider driving a slider":
        B = np.exp(1j * turn) * (crank * np.cos(angle - turn) + assembly * coupler * np.sqrt(margin) + 1j * offset)
        second = coupler * random.uniform(0.5, 2.0, count)
        numbers["coupler2"] = second
        numbers["offset2"] = (B / np.exp(1j * (np.pi / 2 - turn))).imag - small * second
    columns = {name: values[:, None] for name, values in numbers.items()}
    return Family(columns, angle[:, None], assembly, np.sqrt(margin))


@pytest.fixture
def flint():
    """python-flint at 200 bits, and back to what it was."""
    flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    before = flint.ctx.prec
    flint.ctx.prec = 200
    yield flint
    flint.ctx.prec = before


FAMILIES = [(kind, share) for kind in ("slider", "four-bar") for share in (0.01, 0.3, 1.0, 3.0, 100.0)]
FAMILIES += [("slider driving a slider", share) for share in (0.3, 1.0)]


@pytest.mark.parametrize(("kind", "proportion"), FAMILIES)
def test_true_changes_and_errors_stay_below_the_condition(flint, kind, proportion):
    """By 200 bits, each length changed by 1e-25 of itself; squares of sine or cosine from 0.3 down to 1e-11."""
    random, worst = np.random.default_rng(5), 0.0
    for margin in 10.0 ** -np.arange(0.5, 11.0):
        condition, changes, errors = family(kind, proportion, margin, random).magnified(flint)
        closed = np.isfinite(condition) & np.isfinite(changes)
        assert closed.sum() > 8
        assert np.all(changes[closed] < 30 * condition[closed])
        assert np.all(errors[closed] < 30 * condition[closed])
        worst = max(worst, np.max(changes[closed] / condition[closed]))
    assert worst > 0.3


@pytest.mark.parametrize("kind", ["slider", "four-bar"])
@pytest.mark.parametrize("proportion", [1e2, 1e4])
def test_crank_or_rocker_much_longer_than_the_coupler_magnifies_the_more(flint, kind, proportion):
    """Condition does not know: a rounding of the long one is a large change of the short. Such a slider closes over a
    short part of the turn only.
    """
    random = np.random.default_rng(6)
    for margin in 10.0 ** -np.arange(0.5, 7.0):
        condition, changes, errors = family(kind, proportion, margin, random).magnified(flint)
        assert np.all(changes < 6 * proportion * condition)
        assert np.all(errors < 10 * proportion * condition)
