"""What the Python API says to values no machine can have, and where a mechanism does not close."""

import numpy as np
import pytest

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
            "joint or link is 'b', allowed: 'O', 'A', 'B', 'crank', 'coupler', 'slider'; did you mean 'B'",
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
def test_unknown_names_list_valid_and_nearest(ask, message):
    with pytest.raises(ks.QuantityError, match=message):
        ask(solve(crank_slider()))


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


def test_constant_of_a_batch_has_its_shape():
    batch = solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(1.0)), np.array([0.0, 1.0, 2.0]))
    assert batch.guide_moment.shape == batch.balancing_torque.shape == (2, 3)
