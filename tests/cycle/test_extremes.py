"""Extremes: where they must lie, that all are found, their table, and what is refused."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import brentq

import kinetostatics as ks
from kinetostatics.cycle.extremes import extremes_by_name, extremes_frame, frames
from kinetostatics.cycle.limit_positions import Turn
from kinetostatics.errors import NotGivenError
from support import sweeping as spikes
from support.every import every
from support.machines import ANGLES, KINDS, Machine, largest


def turn_distance(found, expected):
    """Distance of angles around the turn."""
    return np.abs(np.angle(np.exp(1j * (np.asarray(found) - np.asarray(expected)))))


@pytest.mark.slow
@every("guide_angle", [0.0, 0.3, np.pi, -2.2])
@every("offset", [0.0, 0.13, -0.4])
@every("assembly", [1, -1])
def test_slider_turns_back_at_dead_centres(guide_angle, offset, assembly):
    """At sine = offset / (l + r), stretched, and offset / (l - r), folded, of the angle of the line to the guide.

    Centred: at 0 and 180 degrees exactly. The place of an extremum is fixed by its slope, to 1e-12.
    """
    r, length = 0.3, 1.1
    mechanism = ks.crank_slider(r, length, guide_angle=guide_angle, guide_offset=offset, assembly=assembly)
    s = ks.solve(mechanism, 0.0, crank_speed=3.0)
    found = ks.extremes(s, "slider_position")
    stretched, folded = np.arcsin(offset / (length + r)), np.pi + np.arcsin(offset / (length - r))
    places = np.array([stretched, folded]) if assembly == 1 else np.pi - np.array([stretched, folded])
    positions = assembly * np.sqrt([(length + r) ** 2 - offset**2, (length - r) ** 2 - offset**2])
    assert len(found) == 2
    order = np.argsort(turn_distance(found.angle, guide_angle + places[0]))
    assert np.max(turn_distance(found.angle[order], guide_angle + places)) < 1e-12
    assert_allclose(found.value[order], positions, rtol=1e-15)
    assert largest(s.at(found.angle).slider_velocity) < 1e-12 * largest(s.at(ANGLES).slider_velocity)


@pytest.mark.parametrize("kind", KINDS)
def test_speed_is_extreme_at_zero_acceleration(kind):
    machine = Machine(kind)
    s = machine.solve(0.0, loads=(), crank_acceleration=0.0)
    found = ks.extremes(s, "slider_velocity")
    assert len(found) == 2
    for angle, value in zip(found.angle, found.value, strict=True):
        root = brentq(lambda a: s.at(a).slider_acceleration, angle - 0.01, angle + 0.01, xtol=1e-15)
        assert angle == pytest.approx(root, abs=1e-12)
        assert value == pytest.approx(float(s.at(root).slider_velocity), rel=1e-15)


@pytest.mark.parametrize("order", [1, 2, 5, 12])
def test_all_extremes_of_a_harmonic_are_found(order):
    s = Machine("plain").solve()
    found = ks.extremes(s, lambda s: 3.0 + 0.5 * np.cos(order * s.crank_angle - 0.4))
    places = (0.4 + np.pi * np.arange(2 * order)) / order
    assert_allclose(found.angle, places, rtol=0, atol=1e-12)
    assert_allclose(found.value, 3.0 + 0.5 * np.cos(np.pi * np.arange(2 * order)), rtol=1e-15)


def test_mixed_harmonic_extremes_equal_slope_roots():
    """Slope of cos + 0.8 sin 2 + 1.5 cos 3 as a polynomial in exp(i angle)."""
    s = Machine("plain").solve()
    found = ks.extremes(
        s, lambda s: np.cos(s.crank_angle) + 0.8 * np.sin(2 * s.crank_angle) + 1.5 * np.cos(3 * s.crank_angle)
    )
    roots = np.roots([2.25j, 0.8, 0.5j, 0.0, -0.5j, 0.8, -2.25j])
    places = np.sort(np.mod(np.angle(roots[np.abs(np.abs(roots) - 1) < 1e-9]), 2 * np.pi))
    assert len(places) == 6
    assert_allclose(found.angle, places, rtol=0, atol=1e-12)
    assert found.largest == found.value[np.argmax(np.abs(found.value))]


@every("rounding", [-1e-15, 0.0, 1e-15])
def test_peaks_of_equal_size_have_one_sign(rounding):
    found = ks.extremes(ks.solve(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 0.0, crank_speed=33.5), "O")
    equal = replace(found, value=np.array([-2.0, 2.0 * (1.0 + rounding)]))
    assert equal.largest == equal.value[1]
    assert replace(found, value=np.array([-2.0, 1.9])).largest == -2.0


def test_extremes_are_in_order_of_angle_and_alternate():
    found = ks.extremes(Machine("circle").solve(0.0), "O")
    assert np.all(np.diff(found.angle) > 0)
    assert np.all((found.angle >= 0) & (found.angle < 2 * np.pi))
    assert np.all(np.diff(found.value)[:-1] * np.diff(found.value)[1:] < 0)


@pytest.mark.slow
@every("lengths", [(0.1, 0.4, 0.4, 0.1), (0.1, 0.4, 0.1, 0.4)])
def test_reactions_without_bound_are_maxima(lengths):
    """At the change points that a deltoid and a parallelogram pass."""
    crank, coupler, rocker, ground = lengths
    links = {"coupler": ks.Link(3.0, 0.2, 0.05), "rocker": ks.Link(2.0, 0.1, 0.05)}
    mechanism = ks.four_bar(crank, coupler, rocker, rocker_pivot=(ground, 0.0), assembly="open", **links)
    with pytest.warns(ks.ConditionWarning, match="grows without bound"):
        found = ks.extremes(ks.Scene(mechanism, 20.0, loads=[ks.Gravity()]).solve(8), "A")
    assert np.isinf(found.value).sum() == 2
    assert_array_equal(found.maximum, [True, False] * 3)


def test_extremes_ignore_the_solved_angles():
    few, many = (ks.extremes(Machine("plain").solve(angle), "balancing_torque") for angle in (0.0, ANGLES))
    assert_array_equal(few.angle, many.angle)
    assert_array_equal(few.value, many.value)


@pytest.mark.parametrize(
    "quantity", ["guide_moment", "shaking_force", "O", lambda s: np.full(s.crank_angle.shape, 2.5)]
)
def test_a_constant_has_no_extremes(quantity):
    s = ks.solve(ks.crank_slider(0.3, 1.1, crank=ks.Link(3.0, 0.2)), 0.0, crank_speed=5.0)
    assert len(ks.extremes(s, quantity)) == 0


@pytest.mark.slow
def test_position_extremes_are_limits_and_dead_centres():
    """Crank 1 m, coupler 0.8 m: it closes where the sine is at most 0.8, with the slider under A at the ends."""
    s = ks.solve(ks.crank_slider(1.0, 0.8), 0.0, crank_speed=1.0)
    found = ks.extremes(s, "slider_position")
    end = np.arcsin(0.8)
    assert_allclose(found.value, [1.8, 0.6, -0.6, -0.2, -0.6, 0.6], rtol=1e-13)
    assert_allclose(found.angle, [0, end, np.pi - end, np.pi, np.pi + end, 2 * np.pi - end], rtol=0, atol=1e-12)
    assert found.maximum.tolist() == [True, False, False, True, False, False]


def test_extremes_refuse_a_batch_of_designs():
    s = ks.solve(ks.crank_slider(np.array([[0.2], [0.3]]), 1.1), ANGLES, crank_speed=1.0)
    with pytest.raises(ks.ParameterError, match=r"one design at a time.*slider_position.*\(2, 1440\)"):
        ks.extremes(s, "slider_position")


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("crank_speed", {"crank_speed": np.ones(ANGLES.size)}),
        ("crank_acceleration", {"crank_acceleration": np.ones(ANGLES.size)}),
        ("ProcessForce", {"loads": [ks.ProcessForce(np.ones(ANGLES.size))]}),
    ],
)
def test_extremes_refuse_tables_over_the_crank_angles(name, change):
    s = Machine("plain").solve(**change)
    with pytest.raises(ks.ParameterError, match=f"{name} is a table over the given crank angles"):
        ks.extremes(s, "balancing_torque")


def test_compared_torque_extrema_are_of_one_kind():
    """By the cosine law the torque is (stiffness - mass speed^2) amplitude^2 sin cos up to sign: exactly reversed here.

    The maximum of one stands where the other has its minimum, but is compared with the maximum.
    """
    cam, speed = ks.cams.CosineLaw(0.3, 2.0), 5.0
    mechanism = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(4.0))
    solutions = [
        ks.solve(mechanism, 0.0, crank_speed=speed, loads=ks.Spring(stiffness, 2.0)) for stiffness in (0.0, 300.0)
    ]
    assert_allclose(ks.compare(*solutions).torque_extremum_ratios, 4 * [0.5], rtol=1e-14)


def test_extremes_name_the_quantities_there_are():
    with pytest.raises(ks.QuantityError, match=r"'balancing_torqe', allowed: .*did you mean 'balancing_torque'"):
        ks.extremes(Machine("plain").solve(), "balancing_torqe")
    with pytest.raises(ks.QuantityError, match="'cam_force'"):
        ks.extremes(Machine("plain").solve(), "cam_force")


SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def loaded(force):
    return ks.solve(SAW, [0.0], crank_speed=33.5, loads=[ks.ProcessForce(force)])


def test_torque_extrema_are_matched_by_kind():
    """A cut on the way back adds extrema to the second; each ratio is still of two maxima or two minima."""
    compared = ks.compare(loaded(0.0), loaded(lambda m: 6e4 * np.sin(5 * m.crank_angle)))
    reference, matched = compared.torque_extremes
    other = ks.extremes(compared.balanced, "balancing_torque")
    assert len(other) != len(reference)
    for value, maximum in zip(matched, reference.maximum, strict=True):
        assert maximum == other.maximum[np.flatnonzero(other.value == value)[0]]


@pytest.mark.slow
def test_mean_torque_closes_in_on_the_jumps_of_a_load():
    """Against the same integral parted at the jumps, each piece smooth."""
    solution = loaded(lambda m: np.where(np.abs(np.mod(m.crank_angle, 2 * np.pi) - 1.25) < 0.75, -3e4, 0.0))
    nodes, weights = np.polynomial.legendre.leggauss(8)
    edges = np.sort(np.concatenate([np.linspace(0, 2 * np.pi, 2001), [0.5, 2.0]]))
    half = np.diff(edges)[:, None] / 2
    inner = edges[:-1, None] + half * (1 + nodes)
    torque = np.abs(solution.at(inner.ravel()).balancing_torque).reshape(inner.shape)
    expected = np.sum(half * weights * torque) / (2 * np.pi)
    assert ks.compare(solution, solution).mean_torques[0] == pytest.approx(expected, rel=1e-7)


def test_extremes_have_proven_bounds_at_their_angles():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    s = ks.solve(saw, 8, crank_speed=33.5, loads=[ks.Gravity()])
    for quantity in ("balancing_torque", "O"):
        found = ks.extremes(s, quantity)
        assert found.error_bound.shape == found.value.shape
        assert np.all(found.error_bound > 0)
        assert np.all(found.error_bound < 1e-14 * np.max(np.abs(found.value)))
    with pytest.raises(NotGivenError, match="is your own function"):
        ks.extremes(s, lambda s: s.guide_force).error_bound  # noqa: B018


def test_constant_quantity_has_no_extremes():
    s = ks.solve(ks.crank_slider(0.3, 2.0, crank=ks.Link(5.0)), 8, crank_speed=33.5, loads=[ks.Gravity()])
    for quantity in ("shaking_force", "balancing_torque"):
        assert ks.extremes(s, quantity).error_bound.shape == (0,)


# In print


def test_extremes_are_printed_with_known_digits():
    found = ks.extremes(ks.load_case("sawframe_2r63").solve("cam-circle"), "O")
    lines = repr(found).splitlines()
    assert lines[0] == "8 extremes of O"
    assert lines[1].split() == ["51.543504", "deg", "22285.3", "N"]
    assert lines[2].split() == ["93.042671", "deg", "0", "N"]
    assert 0.0 < found.value[1] < 1e-10


def test_missing_extremes_print_the_value():
    s = ks.solve(ks.crank_slider(0.3, 2.0), 0.0, crank_speed=1.0)
    assert repr(ks.extremes(s, "guide_moment")) == "no extremes of guide_moment: 0 N m all over the period"
    assert repr(ks.extremes(s, "crank_rate")) == "no extremes of crank_rate: 1 rad/s all over the period"


def test_function_extremes_have_six_digits():
    pump = ks.solve(ks.crank_slider(0.3, 2.0), 0.0, crank_speed=1.0)
    first, line, _ = repr(ks.extremes(pump, lambda s: s.slider_position)).splitlines()
    assert first == "2 extremes of a function of the solution"
    assert line.split()[-1] in ("2.3", "1.7")


@pytest.mark.slow
def test_extremes_say_where_nothing_closes():
    open_press = ks.Mechanism(
        "press",
        ks.Crank(0.1),
        (
            ks.RockerGroup(0.3, 0.25, (0.35, 0.0)),
            ks.SliderGroup(0.08, ks.Guide.at(0.0, 0.3), on="B", pin="C", label="2"),
        ),
    )
    s = ks.solve(open_press, np.linspace(0, 6, 50), crank_speed=3.0, on_gap="nan")
    told = repr(ks.extremes(s, "slider2_position"))
    assert "it does not close for crank angles" in told
    (interval,) = re.findall(r"([\d.]+) \.\. ([\d.]+) deg", told.splitlines()[0]) or [(None, None)]
    assert [float(end) for end in interval] == pytest.approx(np.degrees(s.sampled.gaps[0]), rel=1e-5)
    never = ks.solve(ks.crank_slider(0.3, 0.1, guide_offset=0.9, slider=ks.Link(2)), 0.1, crank_speed=6.0, on_gap="nan")
    with pytest.warns(ks.ConditionWarning, match="O has no value: it does not close for crank angles 0 .. 360 deg"):
        ks.extremes(never, "O")


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.5, 1.5])
def test_extreme_before_a_jump_at_0_keeps_its_side(speed):
    """The slider turns back there, and its friction with it: the torque is least as the turn ends."""
    pump = ks.crank_slider(0.05, 0.2, guide_angle=np.pi, slider=ks.Link(2.0))
    friction = {"guide": ks.GuideFriction(0.2), "B": ks.PinFriction(0.3, 0.02), "A": ks.PinFriction(0.2, 0.03)}
    s = ks.Scene(pump, speed, loads=[ks.Gravity()], friction=friction).solve(36)
    before, after = s.at(np.array([-1e-9, 1e-9])).balancing_torque
    found = ks.extremes(s, "balancing_torque")
    assert before < after - 1e-4
    assert before < s.balancing_torque.min() - 1e-4
    assert found.range[0] == pytest.approx(before, rel=1e-7)
    assert found.angle[np.argmin(found.value)] == pytest.approx(2 * np.pi, abs=1e-9)


# The turn that results are reduced over


PUMP = ks.crank_slider(0.1, 0.4)


def solved(mechanism=PUMP, *loads):
    return ks.solve(mechanism, np.zeros(1), crank_speed=1.0, loads=loads, on_gap="nan")


def test_table_kinks_are_edges():
    table = ks.Table([0.2, 0.4, 0.4000001, 0.4000003, 0.6], [0.0, 0.0, 1.0, 0.0, 0.0], over="travel")
    turn = Turn.of(solved(PUMP, ks.ProcessForce(table)))
    assert turn.kinks.size == 8
    assert np.isin(turn.kinks, turn.pieces.edges).all()


@pytest.mark.slow
@every("seed", [2, 6, 16])
def test_no_extremum_hides_between_close_kinks(seed):
    scene = spikes.spiky(seed)
    for name in ("balancing_torque", "O"):
        low, high = spikes.ends(scene, name)
        found, size = ks.extremes(scene.solve(13), name).range, max(abs(low), abs(high))
        assert high - 1e-9 * size <= found[1] < high + 1e-7 * size
        assert low - 2e-3 * size < found[0] <= low + 1e-9 * size  # few angles stand where a reaction is least


def test_all_parts_find_a_narrow_pulse_of_a_function():
    """-1 MN over 0.6 deg, without kinks declared: extremes, a sweep and the flywheel see the same pulse."""

    def pulse(motion):
        inside = np.abs(np.mod(motion.crank_angle, 2 * np.pi) - np.radians(100.5)) < np.radians(0.3)
        return np.where(inside, -1e6, 0.0)

    def scene(mass):
        return ks.Scene(ks.crank_slider(0.3, 1.1, slider=ks.Link(mass)), 30.0, 0.0, (ks.ProcessForce(pulse),))

    torque, rod = (ks.extremes(scene(10.0).solve(0.0), name) for name in ("balancing_torque", "B"))
    assert torque.largest == pytest.approx(-280_790.2, abs=0.1)
    outputs = ["largest_absolute balancing_torque", "largest B"]
    row = ks.sweep(scene, pd.DataFrame({"mass": [10.0]}), outputs, progress=False).iloc[0]
    assert row["failed"] == ""
    assert row.iloc[1:3].tolist() == pytest.approx([-torque.largest, rod.largest], rel=1e-9)
    ends = np.radians([100.2, 100.8])
    work = 1e6 * np.ptp(scene(10.0).solve(ends).slider_position)
    assert ks.drive.flywheel(scene(10.0), 0.02).energy == pytest.approx(work, rel=0.05)


@pytest.mark.slow
def test_a_narrow_pulse_of_a_function_of_the_solution_is_found():
    """0.5 deg wide, of a quantity that is constant elsewhere; the function may return a list."""
    solution = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 0.0, crank_speed=10.0)
    for place in np.linspace(0.1, 6.1, 12):
        found = ks.extremes(solution, lambda at, place=place: list(1.0 * (abs(at.crank_angle - place) < 0.0044)))
        assert found.value.tolist() in ([1.0, 0.0], [0.0, 1.0])


def test_a_step_within_rounding_of_crank_angles_adds_no_extrema():
    """Two rows 1e-9 rad apart: on the flank values are rounded as crank angles are."""
    step = ks.Table([0.0, 2.0, 2 * np.pi - 1e-9, 2 * np.pi], [-247.6, 234.3, 234.3, -247.6])
    yoke = ks.scotch_yoke(0.1, slider=ks.Link(5.0), block=ks.Link(20.0, 0.02, 0.05), crank=ks.Link(2.0, 0.03, 0.01))
    solution = ks.solve(yoke, 0.0, crank_speed=2.0, loads=[ks.Gravity(), ks.ProcessForce(step)])
    for name in ("balancing_torque", "O", "A"):
        found = ks.extremes(solution, name)
        assert np.all(found.maximum != np.roll(found.maximum, 1))
        assert len(found) < 10


def test_extrema_near_limit_positions_are_found_in_each_turn():
    """A lever whose block nearly meets its pivot, under a torque of two turns with many rows on the crank."""
    rows = np.linspace(0.0, 4 * np.pi, 51)
    torque = ks.Table(rows, 1e-3 * np.cos(7.0 * rows), period=4 * np.pi)
    lever = ks.slotted_lever(
        2.12e-4,
        pivot=(0.0, -2.3327e-4),
        crank=ks.Link(2.7, 1.5e-6, 3.4e-8),
        lever=ks.Link(2.6, 1.5e-5, 1.4e-7),
        block=ks.Link(1.9, 4e-5, 2.5e-8),
    )
    solution = ks.solve(lever, 0.0, crank_speed=-50.0, loads=[ks.Torque(torque, on="crank")])
    for name in ("O", "A", "O2"):
        found = ks.extremes(solution, name)
        assert found.maximum.tolist() == [False, True] * 4
        assert_allclose(found.angle[4:] - found.angle[:4], 2 * np.pi, atol=1e-8)


# Where sampled values turn


def test_extremes_at_jumps_are_those_of_samples():
    ramp = ks.extremes(loaded(lambda motion: -3e4 * np.mod(motion.crank_angle / (2 * np.pi), 1.0)), "B")
    assert np.all(np.isfinite(ramp.value))
    assert ramp.range[1] == pytest.approx(600 * 33.5**2 * 0.3 * 1.15, rel=1e-12)
    step = ks.extremes(loaded(lambda motion: np.where(np.mod(motion.crank_angle, 2 * np.pi) < np.pi, -3e4, 0.0)), "B")
    assert np.all(np.isfinite(step.angle))
    assert np.all(np.isfinite(step.value))


def test_rounding_of_terms_that_cancel_is_no_extremum():
    law = ks.cams.CosineLaw(0.3, 2.0)
    balanced = ks.solve(
        ks.cam_crank_slider(law, law.coupler_length, slider=ks.Link(600)),
        [0.0],
        crank_speed=33.5,
        loads=[ks.Spring.balancing(600, 33.5, 2.0)],
    )
    assert len(ks.extremes(balanced, "balancing_torque")) == 0
    assert np.all(np.isnan(ks.compare(loaded(0.0), balanced).torque_extremum_ratios))


@pytest.mark.parametrize(
    "wave", [lambda s: 1 + 1e-12 * np.cos(s.crank_angle), lambda s: np.round(10 * np.cos(s.crank_angle))]
)
def test_ripples_and_treads_are_no_extrema(wave):
    assert list(ks.extremes(loaded(0.0), wave).maximum) in ([True, False], [False, True])


# The table of true extremes


YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0))


def test_extremes_stand_beside_their_crank_angles():
    table = extremes_frame(ks.solve(YOKE, np.zeros(1), crank_speed=10.0))
    row = table.loc["slider acceleration"]
    assert row["unit"] == "m/s2"
    assert row[["smallest", "smallest at [deg]", "largest", "largest at [deg]"]].tolist() == pytest.approx(
        [-10.0, 0.0, 10.0, 180.0], abs=1e-6
    )


def test_what_is_rounding_stands_as_zero():
    table = extremes_frame(ks.solve(YOKE, np.zeros(1), crank_speed=10.0))
    assert (table.loc["guide force", ["smallest", "largest"]] == 0.0).all()


@pytest.mark.slow
def test_value_and_bound_tables_have_equal_shape():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    solution = ks.solve(saw, 0.0, crank_speed=33.5)
    values, bounds = frames(extremes_by_name(solution))
    assert values.equals(extremes_frame(solution))
    assert (values.index.equals(bounds.index), list(values)) == (True, list(bounds))
    assert bounds["largest at [deg]"].isna().all()
    largest = ks.extremes(solution, "balancing_torque").error_bound.max()
    assert bounds.loc["balancing torque", "largest"] == pytest.approx(largest, rel=1e-12, abs=0.0)
    proven = bounds["largest"].notna()
    assert proven.sum() > 10
    assert (bounds["largest"][proven] < 1e-11 * values["largest"][proven].abs() + 1e-9).all()


def test_forces_that_are_constant_beside_change_points_are_known():
    toggle = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(mass=1.0))
    turn = ks.Scene(toggle, 10.0, loads=ks.Gravity()).solve(8)
    assert [ks.extremes(turn, joint).constant for joint in ("A", "O2")] == [0.0, 9.81]
