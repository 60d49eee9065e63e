"""What the Python API says to values no machine can have, and where a mechanism does not close."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import kinetostatics as ks
from support.every import every

TURN = 2 * np.pi * np.arange(72) / 72
EVEN = 2 * np.pi * np.arange(40) / 40
ROUND = np.full(40, 0.3)


def crank_slider(**changes):
    return ks.crank_slider(**{"crank_length": 0.3, "coupler_length": 1.1} | changes)


def solve(mechanism, angle=TURN, **changes):
    return ks.solve(mechanism, angle, **{"crank_speed": 1.0} | changes)


# Values


@every(
    ("values", "message"),
    [
        ({"mass": -1.0}, "Link: mass must be at least 0, got -1.0"),
        ({"mass": float("nan")}, "Link: mass must be finite, got nan"),
        ({"mass": np.array([[2.0], [-3.0]])}, "Link: mass must be at least 0, got a smallest value of -3"),
        ({"mass": "heavy"}, r"Link: mass must be a number or an array of shape \(designs, 1\), got 'heavy'"),
        ({"mass": 1e200}, r"Link: mass must lie between 0 and 1e\+150 to be computed in double precision, got 1e\+200"),
        ({"inertia": -2.0}, "Link: inertia must be at least 0, got -2.0"),
        ({"inertia": np.inf}, "Link: inertia must be finite, got inf"),
        ({"centre": (1.0, 2.0, 3.0)}, r"Link: centre must be \(along, across\) or a number, got \(1.0, 2.0, 3.0\)"),
        ({"centre": (0.0, np.nan)}, "Link: centre across must be finite, got nan"),
    ],
)
def test_link_refuses(values, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.Link(**values)


def test_message_lists_every_fault_at_once():
    with pytest.raises(ks.ParameterError, match=r"mass .* -1.0; centre along .* inf; inertia .* -3.0"):
        ks.Link(-1.0, (np.inf, 0.0), -3.0)


@every(
    ("changes", "message"),
    [
        ({"crank_length": 0.0}, "crank length must be greater than 0, got 0.0"),
        ({"crank_length": -0.3}, "crank length must be greater than 0, got -0.3"),
        ({"coupler_length": -1.0}, "coupler length must be greater than 0, got -1.0"),
        ({"coupler_length": np.array([[1.0], [np.nan]])}, "coupler length must be finite"),
        ({"assembly": 0}, r"assembly must be \+1 or -1, got 0"),
        ({"assembly": 2}, r"assembly must be \+1 or -1, got 2"),
        ({"assembly": "+1"}, r"assembly must be \+1 or -1, got '\+1'"),
        ({"guide_angle": np.inf}, "guide_angle must be finite, got inf"),
        ({"guide_offset": np.nan}, "guide_offset must be finite, got nan"),
        ({"guide": ks.Guide.at(0.1), "guide_angle": 0.2}, "give either guide or guide_angle and guide_offset"),
        ({"guide": ks.Guide.at(0.1), "guide_offset": 0.1}, "give either guide or guide_angle and guide_offset"),
    ],
)
def test_crank_slider_refuses(changes, message):
    with pytest.raises(ks.ParameterError, match=message):
        crank_slider(**changes)


def test_cam_crank_slider_refuses_a_guide_given_twice():
    with pytest.raises(ks.ParameterError, match="either guide or guide_angle"):
        ks.cam_crank_slider(ks.cams.Circle(0.3), 2.0, guide=ks.Guide.at(0.1), guide_angle=0.1)


@pytest.mark.parametrize(
    ("W1", "W2", "message"),
    [
        ((1.0, 2.0), (1.0, 2.0), r"W1 and W2 coincide at \(1.0, 2.0\)"),
        ((1.0, 2.0), (1.0,), r"W2 must be a pair \(x, y\), got \(1.0,\)"),
        (3.0, (1.0, 2.0), r"W1 must be a pair \(x, y\), got 3.0"),
        ((1.0, 2.0), (0.0, np.nan), "W2 y must be finite, got nan"),
    ],
)
def test_guide_through_refuses(W1, W2, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.Guide.through(W1, W2)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ks.Spring(-1.0, 0.0), "spring: stiffness must be at least 0, got -1.0"),
        (lambda: ks.Spring(1.0, np.nan), "spring: free_position must be finite, got nan"),
        (lambda: ks.Gravity(-9.81), "gravity: acceleration must be at least 0, got -9.81"),
        (lambda: ks.Gravity(9.81, np.inf), "gravity: direction must be finite, got inf"),
        (lambda: ks.ProcessForce(np.array([1.0, np.nan])), "process force: force must be finite"),
    ],
)
def test_loads_refuse(make, message):
    with pytest.raises(ks.ParameterError, match=message):
        make()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"crank_speed": np.nan}, "crank_speed must be finite, got nan"),
        ({"crank_acceleration": np.inf}, "crank_acceleration must be finite, got inf"),
        ({"on_gap": "skip"}, "on_gap is 'skip', allowed: 'raise', 'nan'"),
        (
            {"loads": [ks.Spring(1.0, 0.0, on="slidr")]},
            "Spring: on is 'slidr', allowed: 'slider'; did you mean 'slider'",
        ),
        ({"loads": ks.ProcessForce(1.0, on="coupler")}, "ProcessForce: on is 'coupler', allowed: 'slider'"),
        ({"loads": [9.81]}, "loads must be Gravity, Spring"),
    ],
)
def test_solve_refuses(changes, message):
    with pytest.raises(ks.ParameterError, match=message):
        solve(crank_slider(), **changes)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_solve_refuses_crank_angles_that_are_not_finite(bad):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # numpy's own, on the sine of infinity
        with pytest.raises(ks.ParameterError, match="crank angles must be finite"):
            solve(crank_slider(), np.array([0.0, bad]))


def test_all_errors_are_one_family_and_value_errors():
    assert issubclass(ks.ParameterError, ks.KinetostaticsError)
    assert issubclass(ks.ParameterError, ValueError)
    assert issubclass(ks.AssemblyError, ks.KinetostaticsError)
    assert issubclass(ks.QuantityError, AttributeError)


def test_single_precision_angles_are_warned_of():
    with pytest.warns(UserWarning, match="crank angles are in single precision") as caught:
        ks.solve(crank_slider(), TURN.astype(np.float32), crank_speed=1.0)
    assert caught[0].filename == __file__


# Names


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda s: s.reaction("guid"), "crank-slider: reaction is 'guid', allowed: .*'guide'.*; did you mean 'guide'?"),
        (
            lambda s: s.position("b"),
            "crank-slider: joint or link is 'b', allowed: 'O', 'A', 'B', 'crank', 'coupler', 'slider'$",
        ),
        (
            lambda s: s.rate("couplr"),
            "crank-slider: link is 'couplr', allowed: 'crank', 'coupler', 'slider'; did you mean 'coupler'",
        ),
        (lambda s: s.inertia_force("block"), "crank-slider: link is 'block', allowed: 'crank', 'coupler', 'slider'"),
        (lambda s: s.scalar("guide_farce"), "'guide_farce', allowed: .*'guide_force'.*did you mean 'guide_force'"),
        (lambda s: s.cam_force, "'cam_force', allowed: "),
        (lambda s: s.slot_force, "'slot_force', allowed: "),
        (lambda s: s.pressure_angle, "crank-slider: quantity is 'pressure_angle', allowed: 'balancing_torque'"),
    ],
)
def test_unknown_names_are_answered_with_the_valid_ones_and_the_nearest(ask, message):
    with pytest.raises(ks.QuantityError, match=message):
        ask(solve(crank_slider()))


def test_every_reaction_is_in_the_list_of_valid_ones():
    s = solve(crank_slider())
    with pytest.raises(ks.QuantityError) as caught:
        s.reaction("C")
    assert all(repr(name) in str(caught.value) for name in ("O", "A", "B", "guide"))


# Cams


@every(
    ("make", "message"),
    [
        (lambda: ks.cams.Circle(-0.3), "circle cam: radius must be greater than 0, got -0.3"),
        (lambda: ks.cams.Circle(0.3, 5.0), r"circle cam: centre must be a pair \(x, y\), got 5.0"),
        (lambda: ks.cams.Circle(0.3, (0.0, 0.4)), "O must lie inside .* 0.4 m from O and its radius 0.3 m"),
        (lambda: ks.cams.Circle(0.3, (-0.3, 0.0)), "O must lie inside the pitch circle"),
        (lambda: ks.cams.CosineLaw(-0.3, 2.0), "amplitude must be greater than 0, got -0.3"),
        (lambda: ks.cams.CosineLaw(0.3, 2.0, np.nan), "guide_angle must be finite, got nan"),
        (lambda: ks.cams.CosineLaw(0.3, 0.3), "mean must exceed the amplitude.* got mean 0.3 m and amplitude 0.3 m"),
        (lambda: ks.cams.CosineLaw(0.3, 0.2), "mean must exceed the amplitude"),
        (lambda: ks.cams.Sampled(EVEN[:7], ROUND[:7]), "at least 8 points are needed, got 7"),
        (lambda: ks.cams.Sampled(EVEN, ROUND[:-1]), "angle and radius must be 1-D, of one length"),
        (lambda: ks.cams.Sampled(EVEN.reshape(4, 10), ROUND.reshape(4, 10)), "1-D, of one length"),
        (lambda: ks.cams.Sampled(EVEN[::-1], ROUND), "angles must rise, but row 2 .5.96903 rad. follows 6.12611"),
        (lambda: ks.cams.Sampled(np.sort(np.append(EVEN[1:], EVEN[3])), ROUND), "angles must rise"),
        (lambda: ks.cams.Sampled(np.linspace(0, 2 * np.pi, 40), ROUND), "within one turn, end excluded"),
        (lambda: ks.cams.Sampled(np.degrees(EVEN), ROUND), "within one turn, end excluded"),
        (lambda: ks.cams.Sampled(EVEN, ROUND - 0.3), "radius must be greater than 0"),
        (lambda: ks.cams.Sampled(EVEN, np.where(EVEN > 3, np.nan, ROUND)), "radius must be finite"),
        (lambda: ks.cams.Sampled(np.where(EVEN > 3, np.nan, EVEN), ROUND), "angle must be finite"),
    ],
)
def test_cams_refuse(make, message):
    with pytest.raises(ks.ParameterError, match=message):
        make()


def test_a_class_of_cam_must_say_its_radius():
    with pytest.raises(TypeError, match=r"Flat must define polar\(angle, ray\)"):
        type("Flat", (ks.cams.Cam,), {})().radius(0.0)


# Assembly


def gaps(mechanism, angle=TURN):
    with pytest.raises(ks.AssemblyError) as caught:
        solve(mechanism, angle)
    return caught.value


def test_assembly_error_names_mechanism_condition_numbers_and_intervals():
    """Crank 1 m, coupler 0.8 m, guide through O: no closure where |sin| > 0.8."""
    error = gaps(ks.crank_slider(1.0, 0.8))
    limit = np.arcsin(0.8)
    assert_allclose(error.intervals, [(limit, np.pi - limit), (np.pi + limit, 2 * np.pi - limit)], rtol=1e-15)
    assert str(error) == (
        "crank-slider cannot be assembled at 30 of 72 crank angles: the distance from A to the guide, up to 1 m here, "
        "must not exceed the coupler length, 0.8 m. It does not close for crank angles 53.1301 .. 126.87 deg, "
        '233.13 .. 306.87 deg. Change the lengths, or pass on_gap="nan" to get NaN there and the rest exact'
    )


def test_a_cam_mechanism_with_a_round_cam_has_the_gaps_of_the_plain_one():
    error = gaps(ks.cam_crank_slider(ks.cams.Circle(1.0), 0.8))
    assert_allclose(error.intervals, gaps(ks.crank_slider(1.0, 0.8)).intervals, rtol=1e-15)
    assert str(error).startswith("cam-balanced crank-slider cannot be assembled")


@pytest.mark.parametrize("guide_angle", [0.0, 0.4, -2.9])
@pytest.mark.parametrize("offset", [0.3, -0.25])
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


def test_interval_that_runs_through_zero_ends_beyond_a_turn():
    """Guide upright: no closure where |cos| > 0.8."""
    limit = np.arccos(0.8)
    error = gaps(ks.crank_slider(1.0, 0.8, guide_angle=np.pi / 2))
    expected = [(np.pi - limit, np.pi + limit), (2 * np.pi - limit, 2 * np.pi + limit)]
    assert_allclose(error.intervals, expected, rtol=0, atol=4e-15)
    assert "143.13 .. 216.87 deg, 323.13 .. 396.87 deg" in str(error)


def test_a_gap_narrower_than_any_grid_is_found_at_the_angle_that_falls_into_it():
    """Coupler a billionth shorter than the crank: gaps of 5 thousandths of a degree, square to the guide, both told."""
    middle, half = 0.4 + np.pi / 2, np.arccos(1.0 - 1e-9)
    mechanism = ks.crank_slider(1.0, 1.0 - 1e-9, guide_angle=0.4)
    first, second = gaps(mechanism, np.array([0.3, middle])).intervals
    assert_allclose(first, [middle - half, middle + half], rtol=0, atol=1e-11)
    assert_allclose(np.array(second) - np.pi, [middle - half, middle + half], rtol=0, atol=1e-11)


def test_a_mechanism_that_never_closes_has_the_whole_turn_as_its_gap():
    error = gaps(ks.crank_slider(1.0, 0.5, guide_offset=3.0))
    assert error.intervals == ((0.0, 2 * np.pi),)


def test_angles_outside_the_gap_are_solved_though_the_mechanism_has_one():
    angle = np.array([0.0, 0.9, 2.3, 4.0])
    assert_allclose(
        solve(ks.crank_slider(1.0, 0.8), angle).slider_position,
        np.cos(angle) + np.sqrt(0.64 - np.sin(angle) ** 2),
        rtol=1e-14,
    )


LINKS = {
    "crank": ks.Link(3.0, 0.4, 0.2),
    "coupler": ks.Link(7.0, (0.4, 0.1), 0.9),
    "slider": ks.Link(11.0, (0.1, 0.2)),
}


def test_nan_exactly_in_the_gap_and_the_rest_as_if_there_were_none():
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


def test_a_batch_names_its_first_impossible_design_and_its_gap():
    lengths = np.array([[1.5], [0.8], [2.0], [0.5]])
    error = gaps(ks.crank_slider(1.0, lengths))
    limit = np.arcsin(0.8)
    assert "first in design 1" in str(error)
    assert "coupler length, 0.5 to 2 m" in str(error)
    assert_allclose(error.intervals, [(limit, np.pi - limit), (np.pi + limit, 2 * np.pi - limit)], rtol=1e-15)


def test_a_batch_has_nan_only_in_the_gaps_of_its_impossible_design():
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


def test_a_pitch_curve_that_does_not_go_around_the_pivot_is_refused_where_its_radius_is_negative():
    error = gaps(ks.cam_crank_slider(Limacon(), 2.0))
    assert_allclose(error.intervals, [(2 * np.pi / 3, 4 * np.pi / 3)], rtol=1e-15)
    assert "pitch curve must go around O, but its radius falls to -0.1 m" in str(error)


@pytest.mark.parametrize(("margin", "digits"), [(1e-6, 6), (1e-9, 2), (1e-12, 0)])
def test_a_crank_angle_near_a_limit_position_is_warned_of_with_a_number(margin, digits):
    """Coupler longer than the crank by a hair: cos is sqrt(2 margin) at 90 degrees, and reactions lose it thrice."""
    mechanism = ks.crank_slider(1.0, 1.0 + margin, slider=ks.Link(1.0))
    with pytest.warns(ks.ConditionWarning, match=f"at crank angle 90 deg .* about {digits} correct") as caught:
        solve(mechanism, np.array([0.3, np.pi / 2]))
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_no_warning_while_half_the_digits_are_left():
    solve(ks.crank_slider(1.0, 1.0 + 1e-4, slider=ks.Link(1.0)), np.array([np.pi / 2]))


@pytest.mark.parametrize("tilt", [-2.9, 0.7, 1.3])
def test_rounding_at_the_limit_position_itself_is_no_gap(tilt):
    """Crank as long as the coupler: across the guide both lie in one line, where sine is 1 but for rounding."""
    mechanism = ks.crank_slider(0.3, 0.3, guide_angle=tilt, slider=ks.Link(1.0))
    with pytest.warns(ks.ConditionWarning, match="near a limit position"):
        solve(mechanism, np.array([tilt + np.pi / 2]))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda m: solve(m, []), "no crank angles"),
        (lambda m: solve(m, ["a"]), "crank_angle must be a number"),
        (lambda m: solve(m, [0.0, 1.0, 2.0], crank_speed=[1.0, 2.0]), "do not fit together"),
        (lambda m: solve(m, [0.0], loads=None), "loads must be"),
        (lambda m: ks.crank_slider(1.0, 2.0, guide=0.3), "guide must be made by Guide.at"),
        (lambda m: ks.crank_slider(1.0, 2.0, coupler=3.0), "coupler must be a Link"),
        (lambda m: ks.cam_crank_slider(0.3, 2.0), "cam must be one of"),
        (lambda m: ks.cams.Sampled(np.linspace(0, 1, 10), np.ones(10)), "leaves a gap"),
    ],
)
def test_wrong_kinds_and_shapes_are_refused_at_the_door(call, words):
    with pytest.raises(ks.ParameterError, match=words):
        call(ks.crank_slider(0.3, 2.0))


def test_a_constant_of_a_batch_has_the_shape_of_the_batch():
    batch = solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(1.0)), np.array([0.0, 1.0, 2.0]))
    assert batch.guide_moment.shape == batch.balancing_torque.shape == (2, 3)


def test_power_residual_of_a_mechanism_that_never_closes_is_nan():
    never = solve(ks.crank_slider(0.1, 0.2, guide_offset=1.0), np.array([0.0, 1.0]), on_gap="nan")
    assert np.isnan(never.power_residual)
