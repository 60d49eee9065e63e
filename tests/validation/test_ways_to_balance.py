"""The ways to balance the log frame saw: torque, support reaction and frame force of each, and what finds them."""

import numpy as np
import pytest

import kinetostatics as ks

CASE = ks.load_case("sawframe_2r63_ways")
WAYS = {  # k_d, largest O [kN] and frame force [kN], by independent scripts (spectral derivatives, own Newton-Euler)
    "plain": "1.000 287 287",
    "counterweight": "1.00 143 134.8",
    "pin-springs": "4.73 34 287",
    "slider-springs": "5.40 85 287",
    "tuned-springs": "9.98 47 287",
    "circle": "6.08 22 252",
    "cam": "411 0.75 253",
    "twin": "0.50 1.5 0.0",
    "upright-circle": "6.116 21 252",
    "upright-tuned-springs": "10.05 47 287",
    "upright-cam": "52.9e3 0.0026 253",
}
FOUND = {  # by this library's searches: k_d, frame force [kN]
    "tuned-gas-springs": (31.13, 287),
    "upright-tuned-gas-springs": (31.44, 287),
    "cam-counterweight": (89.5, 118),
    "upright-cam-counterweight": (5.279e4, 118),
}


def figures(name):
    """Gain against the plain saw of the same layout, largest O and largest frame force, kN."""
    turn = CASE.solve(name)
    gain = ks.compare(CASE.solve(CASE.reference_of(name)), turn).mean_torque_ratio
    return float(gain), *(ks.extremes(turn, quantity).largest / 1e3 for quantity in ("O", "shaking_force"))


@pytest.mark.parametrize("name", WAYS)
def test_gain_support_and_frame(name):
    for found, text in zip(figures(name), WAYS[name].split(), strict=True):
        number, _, power = text.partition("e")
        half_a_digit = 0.5 * 10.0 ** (int(power or 0) - len(number.partition(".")[2]))
        assert found == pytest.approx(float(text), abs=1.001 * half_a_digit)


@pytest.mark.parametrize("name", FOUND)
def test_found_ways(name):
    gain, _, frame = figures(name)
    assert gain == pytest.approx(FOUND[name][0], rel=5e-4)
    assert frame == pytest.approx(FOUND[name][1], rel=2e-3)


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_longer_springs_at_the_pin():
    scene = CASE.variants["pin-springs"].scene
    springs = [ks.PointSpring(c, 50.0, between=("A", at)) for c, at in ((842e3, (50.0, 0.0)), (52e3, (0.0, 50.0)))]
    turn = ks.Scene(scene.mechanism, scene.crank_speed, loads=[ks.Gravity(), *springs]).solve(720)
    assert ks.compare(CASE.solve("plain"), turn).mean_torque_ratio == pytest.approx(4.70, abs=0.005)
    assert ks.extremes(turn, "O").largest == pytest.approx(34.2e3, abs=50.0)


def test_counterweight_has_the_least_frame_force():
    scene = CASE.variants["counterweight"].scene
    found = ks.design.optimise(scene, {"crank.mass": (0.0, 900.0)}, "largest shaking_force")
    assert found.values["crank.mass"] == pytest.approx(451.0, abs=1.0)


def test_pins_of_twins_carry_what_one_saw_carries():
    twin = CASE.solve("twin")
    assert [round(ks.extremes(twin, joint).largest / 1e3, 1) for joint in ("A", "C2")] == [286.8, 286.8]
    moments = [ks.extremes(turn, "shaking_moment").range[1] for turn in (twin, CASE.solve("plain"))]
    assert moments[0] == pytest.approx(2 * moments[1], rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tuned-springs", "upright-tuned-springs", "tuned-gas-springs", "upright-cam"])
def test_searches_find_what_the_file_holds(name):
    found, kept = CASE.designs[name].find().scene, CASE.variants[name].scene
    mean = [np.abs(scene.solve(720).balancing_torque).mean() for scene in (found, kept)]
    assert mean[0] <= mean[1] * (1 + 1e-6)
    assert mean[0] == pytest.approx(mean[1], rel=1e-4)
