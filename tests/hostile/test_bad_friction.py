"""Wrong friction is refused in words, whatever it is."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

PUMP = ks.crank_slider(0.1, 0.3, slider=ks.Link(2.0))
CAM = ks.cam_crank_slider(ks.cams.Circle(0.1, (0.01, 0.0)), 0.4, slider=ks.Link(2.0))
ANGLES = np.linspace(0.0, 6.0, 5)
PIN = ks.PinFriction(0.1, 0.02)

WRONG = [
    ({"X": PIN}, "joint is 'X', allowed: 'O', 'A', 'B', 'guide'"),
    ({"gude": ks.GuideFriction(0.1)}, "did you mean 'guide'"),
    ({"slot": ks.SlotFriction(0.1)}, "joint is 'slot', allowed"),
    ({"cam": ks.RollerFriction(0.1, 0.1, 0.2)}, "joint is 'cam', allowed"),
    ({"guide": PIN}, "takes a GuideFriction"),
    ({"guide": ks.SlotFriction(0.1)}, "takes a GuideFriction"),
    ({"O": ks.GuideFriction(0.1)}, "takes a PinFriction"),
    ({"O": 0.1}, "takes a PinFriction, got 0.1"),
    ({"O": None}, "takes a PinFriction, got None"),
    ({"O": ks.PinFriction}, "takes a PinFriction"),
    ({3: PIN}, "joint is 3, allowed"),
    ({None: PIN}, "joint is None, allowed"),
    ({("O",): PIN}, "joint is ('O',), allowed"),
    (0.1, "must be a dict of joint to friction"),
    (0, "must be a dict of joint to friction"),
    ((), "must be a dict of joint to friction"),
    ([PIN], "must be a dict of joint to friction"),
    ("O", "must be a dict of joint to friction"),
    (PIN, "must be a dict of joint to friction"),
]
NUMBERS = [
    (lambda value: ks.PinFriction(value, 0.1), "mu"),
    (lambda value: ks.GuideFriction(value), "mu"),
    (lambda value: ks.SlotFriction(value, 0.1), "mu"),
    (lambda value: ks.RollerFriction(value, 0.01, 0.02), "mu"),
    (lambda value: ks.PinFriction(0.1, value), "radius"),
    (lambda value: ks.GuideFriction(0.1, value), "half_length"),
    (lambda value: ks.RollerFriction(0.1, value, 0.2), "pin_radius"),
    (lambda value: ks.RollerFriction(0.1, 0.01, value), "roller_radius"),
]


@every(("friction", "words"), WRONG)
@every("door", ["solve", "scene"])
def test_friction_that_no_joint_has_is_refused(friction, words, door):
    through = {"solve": lambda: ks.solve(PUMP, ANGLES, crank_speed=1.0, friction=friction)}
    through["scene"] = lambda: ks.Scene(PUMP, 1.0, friction=friction)
    with pytest.raises(ks.ParameterError) as caught:
        through[door]()
    assert words in str(caught.value)


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(ks.ParameterError) as caught:
        ks.solve(CAM, ANGLES, crank_speed=1.0, friction={"slot": PIN, "cam": PIN, "Q": PIN})
    assert all(words in str(caught.value) for words in ("SlotFriction", "RollerFriction", "'Q'"))


@every(("make", "name"), NUMBERS)
@every("value", [-0.1, np.nan, np.inf, -np.inf, "0.1", [0.1], 1e200, 1j, object()])
def test_impossible_coefficients_are_refused(make, name, value):
    with pytest.raises(ks.ParameterError, match=name):
        make(value)


@pytest.mark.parametrize(("make", "name"), NUMBERS[4:])
def test_sizes_must_not_be_zero(make, name):
    with pytest.raises(ks.ParameterError, match=name):
        make(0.0)


def test_a_roller_that_would_not_turn_is_refused():
    with pytest.raises(ks.ParameterError, match="the roller would not turn"):
        ks.RollerFriction(0.5, 0.1, 0.04)


@pytest.mark.parametrize("speed", [0.0, 0, np.array([1.0, 0.0, 2.0, 3.0, 4.0])])
def test_resting_machine_without_sense_is_refused(speed):
    with pytest.raises(ks.ParameterError, match="crank_speed and crank_acceleration are both 0"):
        ks.solve(PUMP, ANGLES, crank_speed=speed, friction={"O": PIN})


def test_unknown_paths_and_joints_are_refused():
    scene = ks.Scene(PUMP, 1.0, friction={"O": PIN})
    with pytest.raises(ks.ParameterError, match=r"friction\.O\.mu"):
        scene.varied({"friction.O.my": 0.1})
    with pytest.raises(ks.ParameterError, match="mu must be at least 0"):
        scene.varied({"friction.O.mu": -0.1})
    with pytest.raises(ks.QuantityError, match="joint that rubs"):
        scene.solve(4).friction_loss_at("Z")
    with pytest.raises(ks.QuantityError, match="joint"):
        scene.solve(4).pin_load("Z")


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@every("mu", [1e-300, 1e-12, 0.999, 5.0, 1e6, 1e140])
@every("name", ["O", "A", "B", "guide"])
def test_any_coefficient_solves_or_jams(mu, name):
    friction = ks.GuideFriction(mu) if name == "guide" else ks.PinFriction(mu, 0.01)
    try:
        s = ks.solve(PUMP, ANGLES, crank_speed=3.0, loads=ks.Gravity(), friction={name: friction})
    except ks.JammingError:
        return
    assert np.isfinite(s.balancing_torque).all()
    assert (s.friction_loss >= 0.0).all()


def test_an_idle_machine_without_masses_rubs_nowhere():
    s = ks.solve(
        ks.crank_slider(0.1, 0.3), ANGLES, crank_speed=3.0, friction={"A": PIN, "guide": ks.GuideFriction(0.1)}
    )
    assert (s.friction_loss < 1e-100).all()
    assert (np.abs(s.balancing_torque) < 1e-100).all()
    assert s.converged.all()
