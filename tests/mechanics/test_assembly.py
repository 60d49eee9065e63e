"""Assembly of groups and gaps of the crank angle."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import kinetostatics as ks
from kinetostatics.engines.engines import KERNELS
from kinetostatics.mechanics.quantities import of_scene
from support.every import every

TURN = 2 * np.pi * np.arange(72) / 72


def solve(mechanism, angle=TURN, **changes):
    return ks.solve(mechanism, angle, **{"crank_speed": 1.0} | changes)


# Assembly


def gaps(mechanism, angle=TURN):
    with pytest.raises(ks.AssemblyError) as caught:
        solve(mechanism, angle)
    return caught.value


def test_assembly_error_names_condition_and_intervals():
    """Crank 1 m, coupler 0.8 m, guide through O: no closure where |sin| > 0.8."""
    error = gaps(ks.crank_slider(1.0, 0.8))
    limit = np.arcsin(0.8)
    assert_allclose(error.intervals, [(limit, np.pi - limit), (np.pi + limit, 2 * np.pi - limit)], rtol=1e-15)
    assert str(error) == (
        "crank-slider cannot be assembled at 30 of 72 crank angles: the distance from A to the guide, up to 1 m here, "
        "must not exceed the coupler length, 0.8 m. It does not close for crank angles 53.1301 .. 126.87 deg, "
        '233.13 .. 306.87 deg. Change the lengths, or pass on_gap="nan" to get NaN there and the rest exact'
    )


@pytest.mark.slow
@every("guides", [(0.0, 0.5), (0.0, np.pi / 2), (0.0, 0.3, 0.6), (0.0, 0.7, 1.4, 2.1)])
@every("coupler", [0.05, 0.8])
def test_gaps_of_several_groups_are_refused(guides, coupler):
    """Two negative margins have a positive product: none may vouch for the other."""
    rows = [
        ks.SliderGroup(coupler, guide=ks.Guide(angle), pin=f"B{row}", label=str(row))
        for row, angle in enumerate(guides)
    ]
    found = ks.Mechanism("star", ks.Crank(1.0), rows)
    assert gaps(found).intervals == gaps(ks.crank_slider(1.0, coupler)).intervals
    with pytest.raises(ks.AssemblyError):
        ks.Scene(found, 10.0).solve(360)


def test_round_cam_has_the_gaps_of_the_plain_crank():
    error = gaps(ks.cam_crank_slider(ks.cams.Circle(1.0), 0.8))
    assert_allclose(error.intervals, gaps(ks.crank_slider(1.0, 0.8)).intervals, rtol=1e-15)
    assert str(error).startswith("cam-balanced crank-slider cannot be assembled")


@every("guide_angle", [0.0, 0.4, -2.9])
@every("offset", [0.3, -0.25])
def test_intervals_of_an_offset_guide(guide_angle, offset):
    """Guide at e: no closure where |e - r sin| > l: here one interval, on the side away from the guide."""
    r, length = 1.0, 0.8
    error = gaps(ks.crank_slider(r, length, guide_angle=guide_angle, guide_offset=offset))
    limit = np.arcsin((length - abs(offset)) / r)
    middle = guide_angle - np.sign(offset) * np.pi / 2
    ((start, end),) = error.intervals
    assert 0 <= start < 2 * np.pi
    assert start < end
    assert np.exp(1j * start) == pytest.approx(np.exp(1j * (middle - np.pi / 2 + limit)), abs=4e-15)
    assert end - start == pytest.approx(np.pi - 2 * limit, abs=4e-15)


def test_interval_through_zero_ends_beyond_a_turn():
    """Guide upright: no closure where |cos| > 0.8."""
    limit = np.arccos(0.8)
    error = gaps(ks.crank_slider(1.0, 0.8, guide_angle=np.pi / 2))
    expected = [(np.pi - limit, np.pi + limit), (2 * np.pi - limit, 2 * np.pi + limit)]
    assert_allclose(error.intervals, expected, rtol=0, atol=4e-15)
    assert "143.13 .. 216.87 deg, 323.13 .. 396.87 deg" in str(error)


def test_a_narrow_gap_is_found_at_its_angle():
    """Coupler a billionth shorter than the crank: gaps of 5 thousandths of a degree, square to the guide, both told."""
    middle, half = 0.4 + np.pi / 2, np.arccos(1.0 - 1e-9)
    mechanism = ks.crank_slider(1.0, 1.0 - 1e-9, guide_angle=0.4)
    first, second = gaps(mechanism, np.array([0.3, middle])).intervals
    assert_allclose(first, [middle - half, middle + half], rtol=0, atol=1e-11)
    assert_allclose(np.array(second) - np.pi, [middle - half, middle + half], rtol=0, atol=1e-11)


def test_never_closing_mechanism_is_one_gap():
    error = gaps(ks.crank_slider(1.0, 0.5, guide_offset=3.0))
    assert error.intervals == ((0.0, 2 * np.pi),)


def test_angles_outside_the_gap_are_solved():
    angle = np.array([0.0, 0.9, 2.3, 4.0])
    assert_allclose(
        solve(ks.crank_slider(1.0, 0.8), angle).slider_position,
        np.cos(angle) + np.sqrt(0.64 - np.sin(angle) ** 2),
        rtol=1e-14,
    )


LINKS = {"crank": ks.Link(3.0, 0.4, 0.2), "coupler": ks.Link(7.0, (0.4, 0.1), 0.9), "slider": ks.Link(11.0, (0.1, 0.2))}


def test_nan_stands_exactly_in_the_gap():
    mechanism = ks.crank_slider(1.0, 0.8, guide_offset=0.05, **LINKS)
    angle = np.linspace(-1.0, 6.0, 211)
    closed = np.abs(0.05 - np.sin(angle)) < 0.8
    loads = [ks.Gravity(), ks.Spring(300.0, 0.7)]
    s = solve(mechanism, angle, on_gap="nan", loads=loads)
    alone = solve(mechanism, angle[closed], loads=loads)
    for ask in (
        lambda s: s.balancing_torque,
        lambda s: s.balancing_torque_by_power,
        lambda s: s.guide_force,
        lambda s: s.guide_moment,
        lambda s: s.shaking_moment,
        lambda s: s.slider_position,
        lambda s: s.rate("coupler"),
        lambda s: s.angular_acceleration("coupler"),
        *(lambda s, joint=joint: s.reaction(joint) for joint in ("O", "A", "B", "guide")),
        lambda s: s.shaking_force,
        lambda s: s.position("B"),
        lambda s: s.velocity("coupler"),
        lambda s: s.acceleration("slider"),
    ):
        values = np.atleast_2d(ask(s))
        assert_array_equal(np.isnan(values), np.broadcast_to(~closed, values.shape))
        expected = np.atleast_2d(ask(alone))
        assert_allclose(values[:, closed], expected, rtol=1e-15, atol=1e-15 * np.max(np.abs(expected)))
    assert s.power_residual < 1e-14


def test_batch_names_its_first_impossible_design():
    lengths = np.array([[1.5], [0.8], [2.0], [0.5]])
    error = gaps(ks.crank_slider(1.0, lengths))
    limit = np.arcsin(0.8)
    assert "first in design 1" in str(error)
    assert "coupler length, 0.5 to 2 m" in str(error)
    assert_allclose(error.intervals, [(limit, np.pi - limit), (np.pi + limit, 2 * np.pi - limit)], rtol=1e-15)


def test_batch_has_nan_in_impossible_designs_only():
    lengths = np.array([[1.5], [0.8], [2.0]])
    s = solve(ks.crank_slider(1.0, lengths, **LINKS), on_gap="nan")
    assert_array_equal(np.isnan(s.balancing_torque), np.abs(np.sin(TURN)) > lengths)
    for i in (0, 2):
        single = solve(ks.crank_slider(1.0, lengths[i, 0], **LINKS))
        assert_allclose(s.balancing_torque[i], single.balancing_torque, rtol=1e-14, atol=1e-12)


class Limacon(ks.cams.Cam):
    """Pitch curve 0.1 + 0.2 cos, which does not go around O."""

    def polar(self, angle, ray):
        """Radius and its derivatives."""
        return 0.1 + 0.2 * ray[0], -0.2 * ray[1], -0.2 * ray[0]


def test_negative_pitch_radius_is_refused():
    error = gaps(ks.cam_crank_slider(Limacon(), 2.0))
    assert_allclose(error.intervals, [(2 * np.pi / 3, 4 * np.pi / 3)], rtol=1e-15)
    assert "pitch curve must go around O, but its radius falls to -0.1 m" in str(error)


@every("margin, digits", [(1e-6, 6), (1e-9, 2), (1e-12, 0)])
def test_angle_near_a_limit_position_is_warned_of(margin, digits):
    """Coupler longer than the crank by a hair: cos is sqrt(2 margin) at 90 degrees, and reactions lose it thrice."""
    mechanism = ks.crank_slider(1.0, 1.0 + margin, slider=ks.Link(1.0))
    with pytest.warns(ks.ConditionWarning, match=f"at crank angle 90 deg .* about {digits} correct") as caught:
        solve(mechanism, np.array([0.3, np.pi / 2]))
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_no_warning_while_half_the_digits_are_left():
    solve(ks.crank_slider(1.0, 1.0 + 1e-4, slider=ks.Link(1.0)), np.array([np.pi / 2]))


@every("tilt", [-2.9, 0.7, 1.3])
def test_rounding_at_a_limit_position_is_no_gap(tilt):
    """Crank as long as the coupler: across the guide both lie in one line, where sine is 1 but for rounding."""
    mechanism = ks.crank_slider(0.3, 0.3, guide_angle=tilt, slider=ks.Link(1.0))
    with pytest.warns(ks.ConditionWarning, match="near a limit position"):
        solve(mechanism, np.array([tilt + np.pi / 2]))


def test_power_residual_without_closure_is_nan():
    never = solve(ks.crank_slider(0.1, 0.2, guide_offset=1.0), np.array([0.0, 1.0]), on_gap="nan")
    assert np.isnan(never.power_residual)


# Where a group cannot be assembled nothing has a value that hangs on it or carries its forces; all else has one

BODY, NONE = ks.Link(1.0, 0.02, 0.004), ks.Link()
AROUND = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)


def short_slider(on, body, **options):
    return ks.SliderGroup(on=on, pin="C", label="2", coupler=body, slider=body, **options)


def vee(inner, outer):
    """Two cylinders on one crank, of which the second has too short a rod."""
    second = short_slider("A", outer, coupler_length=0.04, guide=ks.Guide.at(np.pi / 2))
    return ks.SliderGroup(0.2, coupler=inner, slider=inner), second


def yoke(inner, outer):
    """A yoke, which always closes and has no root, beside the same cylinder."""
    second = short_slider("A", outer, coupler_length=0.04, guide=ks.Guide.at(np.pi / 2))
    return ks.YokeGroup(slider=inner, block=inner), second


def on_the_rocker(inner, outer):
    """A four-bar whose rocker carries a slider with too short a rod."""
    four_bar = ks.RockerGroup(0.2, 0.15, (0.2, 0.0), coupler=inner, rocker=inner)
    slider = short_slider("D", outer, coupler_length=0.12, guide=ks.Guide.at(0.0, 0.2))
    return four_bar, ks.Pin("rocker", (0.1, 0.02), "D"), slider


def on_the_lever(inner, outer):
    """A lever that its block leaves, and a slider on it with a rod that is always long enough."""
    lever = ks.LeverGroup((0.0, -0.08), offset=0.04, lever=inner, block=inner)
    return lever, ks.Pin("lever", (0.2, 0.0), "D"), short_slider("D", outer, coupler_length=1.0)


def lever(inner, outer):
    """A lever alone, none of whose joints moves."""
    return (ks.LeverGroup((0.0, -0.08), offset=0.04, lever=inner, block=inner),)


RATES = ("_rate", "_angular_acceleration")
TRAVELS = ("_position", "_velocity", "_acceleration")
SLIDER = [*(f"slider{end}" for end in (*RATES, *TRAVELS)), *(f"coupler{end}" for end in RATES)]
GUIDED = ["A", "guide", "guide_force", "guide_moment"]
STAYING = {
    vee: {*SLIDER, *GUIDED, "B"},
    yoke: {*SLIDER[:5], *GUIDED, "slot_force", "slot_moment", *(f"block{end}" for end in RATES)},
    on_the_rocker: {f"{link}{end}" for link in ("coupler", "rocker") for end in RATES},
    on_the_lever: set(),
    lever: set(),
}
"""What still has a value where the machine cannot be assembled, by machine."""


def made(machine, inner=BODY, outer=BODY, loads=()):
    return ks.Scene(ks.Mechanism(machine.__name__, ks.Crank(0.05, BODY), machine(inner, outer)), 7.0, 3.0, loads)


def computed(scene, angles):
    """Values of every quantity by each way there is, by what it is called, and what of each way is asked."""
    names = tuple(of_scene(scene))
    s, single = (scene.solve(given, on_gap="nan") for given in (angles, angles.astype(np.float32)))
    yield "solution", {name: of_scene(s)[name].read(s) for name in names}
    yield "kernels", KERNELS.values(s.dynamics, names)
    yield "kernels in single precision", {name: of_scene(single)[name].read(single) for name in names}
    program = ks.compile(scene, names, engine="numpy")
    yield "program", program(angles)
    yield "bounds", program.error_bound(angles)
    yield "program in single precision", ks.compile(scene, names, engine="numpy", precision="single")(angles)


@pytest.mark.slow
@every("machine", STAYING, ids=lambda machine: machine.__name__)
@every("inner, outer, loads", [(BODY, BODY, (ks.Gravity(),)), (BODY, NONE, ())])
@pytest.mark.filterwarnings("ignore:crank angles are in single precision")
def test_dependents_of_a_gap_have_no_value(machine, inner, outer, loads):
    scene = made(machine, inner, outer, loads)
    s = scene.solve(AROUND, on_gap="nan")
    open_ = np.any([margin < 0.0 for margin in s.closure], axis=0)
    assert 0 < open_.sum() < AROUND.size
    np.testing.assert_array_equal(s.closed, ~open_)
    for way, found in computed(scene, AROUND):
        for name, values in found.items():
            finite = np.isfinite(values).reshape(-1, AROUND.size).all(axis=0)
            assert finite[~open_].all(), (way, name)
            assert (finite[open_] == (name in STAYING[machine])).all(), (way, name)


@pytest.mark.slow
def test_a_compiled_loop_has_the_gaps_of_numpy(numba):
    scene = made(yoke, NONE, NONE)
    names = tuple(of_scene(scene))
    found, expected = (ks.compile(scene, names, engine=engine)(AROUND) for engine in ("compiled", "numpy"))
    for name in names:
        np.testing.assert_array_equal(np.isnan(found[name]), np.isnan(expected[name]), name)


def test_groups_beside_a_gap_keep_their_values():
    inner, outer = vee(BODY, BODY)
    both, alone = (
        ks.Scene(ks.Mechanism("engine", ks.Crank(0.05, BODY), groups), 7.0, 3.0, ks.Gravity()).solve(
            AROUND, on_gap="nan"
        )
        for groups in ((inner, outer), (inner,))
    )
    for name in STAYING[vee]:
        np.testing.assert_array_equal(of_scene(both)[name].read(both), of_scene(alone)[name].read(alone))


@pytest.mark.slow
@every("machine", [vee, on_the_rocker], ids=lambda machine: machine.__name__)
def test_friction_has_the_gaps_of_its_forces(machine):
    """Of the first group a cylinder's joint stays beside the other's gap, a rocker's that carries it does not."""
    pin = ks.PinFriction(0.1, 0.01)
    s = replace(made(machine), friction={"O": pin, "A": pin, "C": pin}).solve(AROUND, on_gap="nan")
    for name, stays in (("A", machine is vee), ("C", False), ("O", False)):
        for found in (s.friction_at(name), s.friction_loss_at(name)):
            np.testing.assert_array_equal(np.isfinite(found), s.closed | stays)
    np.testing.assert_array_equal(np.isfinite(s.friction_loss), s.closed)


@pytest.mark.slow
def test_jax_derivatives_are_finite_outside_gaps(double):
    """Beside a gap nothing of it comes into what is differentiated."""
    mechanism = made(vee, outer=NONE).mechanism
    closed = ks.solve(mechanism, AROUND, crank_speed=7.0, on_gap="nan").closed

    def torques(speed):
        s = ks.solve(mechanism, double.numpy.asarray(AROUND), crank_speed=speed, on_gap="nan")
        return s.balancing_torque_by_power

    slope, values = np.asarray(double.jacfwd(torques)(7.0)), np.asarray(torques(7.0))
    np.testing.assert_allclose(slope[closed], 2.0 / 7.0 * values[closed], rtol=0.0, atol=1e-16)
    assert np.isnan(values[~closed]).all()
