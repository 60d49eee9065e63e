"""Reductions of values over the crank angle, and outputs as they are written."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.reductions import REDUCTIONS, parsed
from kinetostatics.mechanics import quantities


def wave(order=3):
    """Values of two designs at 48 crank angles, and a function of them at any."""
    amplitude = np.array([[2.0], [5.0]])

    def at(angle):
        return amplitude * np.cos(order * angle - 1.0) + np.sin(angle) - amplitude

    turn = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    return at(turn), at


def test_reductions_are_what_plain_numpy_says():
    values, _ = wave()
    expected = {
        "mean": values.sum(axis=1) / 48,
        "rms": np.sqrt((values**2).sum(axis=1) / 48),
        "harmonic_0": np.abs(values.sum(axis=1)) / 48,
        "harmonic_1": [1.0, 1.0],
        "harmonic_2": [0.0, 0.0],
        "harmonic_3": [2.0, 5.0],
        "harmonic_7": 2 * np.abs(np.fft.rfft(values)[:, 7]) / 48,
    }
    for name, wanted in expected.items():
        assert parsed(f"{name} O").reduced(values) == pytest.approx(np.array(wanted), abs=1e-14), name


def test_extremes_are_found_between_the_samples():
    values, at = wave(order=2)
    fine = np.linspace(0, 2 * np.pi, 200_001)
    many = at(fine)
    found = {name: parsed(f"{name} O").reduced(values) for name in REDUCTIONS}
    assert found["largest"] == pytest.approx(many.max(axis=1), abs=1e-6)
    assert found["smallest"] == pytest.approx(many.min(axis=1), abs=1e-6)
    assert found["range"] == pytest.approx(np.ptp(many, axis=1), abs=1e-6)
    assert found["largest_absolute"] == pytest.approx(np.abs(many).max(axis=1), abs=1e-6)
    assert found["mean_absolute"] == pytest.approx(np.abs(many[:, :-1]).mean(axis=1), rel=2e-4)
    assert found["largest_at"] == pytest.approx(fine[many.argmax(axis=1)], abs=1e-4)
    assert found["smallest_at"] == pytest.approx(fine[many.argmin(axis=1)], abs=1e-4)


@pytest.mark.parametrize(("case", "name"), [("sawframe_2r63", "cam-circle"), ("chain_unit", "rho-0.5")])
def test_extremes_are_right_to_a_millionth(case, name):
    s = ks.load_case(case).solve(name, 360)
    for quantity in (*s.reactions, "balancing_torque", "shaking_force"):
        low, high = ks.extremes(s, quantity).range
        samples = quantities.values(s, quantity)[None]
        size = max(abs(low), abs(high))
        assert parsed("largest O").reduced(samples)[0] == pytest.approx(high, abs=1e-6 * size), quantity
        assert parsed("smallest O").reduced(samples)[0] == pytest.approx(low, abs=1e-6 * size), quantity


TURN = np.linspace(0, 2 * np.pi, 360, endpoint=False)
JUMPS = {
    "step": (np.where(TURN < 1, 0.0, 10.0), 10.0),
    "step up, then falling": (np.where(TURN < 1, -5.0, 10 - 0.1 * TURN), 10 - 0.1 * TURN[58]),
    "step beside a smooth peak": (np.where(TURN > 0.56, 0.0, 10 + np.sin(3 * TURN)), 11.0),
    "constant": (np.full(360, 7357.5), 7357.5),
    "corner": (-np.abs(np.sin(TURN - 0.3)), 0.0),
}


@pytest.mark.parametrize("name", JUMPS)
def test_nothing_is_made_up_beside_jumps_and_corners(name):
    """To half of the digits: a corner at zero is found from squares."""
    values, highest = JUMPS[name]
    pairs = ((1, "largest O"), (-1, "smallest O"))
    found = [sign * parsed(output).reduced(sign * values[None])[0] for sign, output in pairs]
    assert found == pytest.approx([highest, highest], abs=np.sqrt(np.finfo(float).eps))


def test_what_is_no_number_stays_none():
    values = np.vstack([TURN, np.where(np.arange(360) == 9, np.nan, TURN)])
    for name in (*REDUCTIONS, "harmonic_2"):
        assert np.isnan(parsed(f"{name} O").reduced(values)).tolist() == [False, True], name


def test_outputs_are_read_with_any_name_of_a_quantity():
    output = parsed("  ratio  mean_absolute   pan moment ")
    assert (output.ratio, output.reduction, output.quantity) == (True, "mean_absolute", "pan moment")
    assert str(output) == "ratio mean_absolute pan moment"
    assert parsed(output) is output
    assert parsed("largest_at balancing_torque").column == "largest_at balancing_torque [rad]"
    assert parsed("ratio rms O").column == "ratio rms O [1]"
    for text in ("largest", "larges O", "harmonic_x O", "ratio", "", "O largest"):
        with pytest.raises(ks.ParameterError, match=r"must be a reduction and a quantity.*harmonic_1"):
            parsed(text)
    with pytest.raises(ks.ParameterError, match="did you mean 'largest O'"):
        parsed("larges O")


def test_swing_is_the_range_of_the_integral():
    """Against the integral in closed form on a fine grid; the mean does not count, and over two turns it doubles."""
    fine = np.linspace(0, 2 * np.pi, 400_001)
    integral = 3.0 * np.sin(fine) + 0.5 * np.sin(4 * fine + 0.3) - 0.2 * np.cos(7 * fine)
    for count in (96, 97):
        angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
        values = 3.0 * np.cos(angle) + 2.0 * np.cos(4 * angle + 0.3) + 1.4 * np.sin(7 * angle)
        output = parsed("swing balancing_torque")
        for mean in (0.0, -40.0):
            found, rough = output.estimated((values + mean)[None])
            assert found[0] == pytest.approx(np.ptp(integral), rel=2e-7)
            assert not rough[0]
        assert output.estimated(values[None], 2)[0][0] == pytest.approx(2 * found[0], rel=1e-12)


def test_swing_is_exact_at_samples_and_near_jumps():
    """5 over a quarter of the turn, else 0: the energy above the mean is 15/4 times pi/2."""
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    values = np.where((angle > 1.0) & (angle < 1.0 + np.pi / 2), 5.0, 0.0)
    found, rough = parsed("swing balancing_torque").estimated(values[None])
    assert found[0] == pytest.approx(15 / 4 * np.pi / 2, rel=2e-3)
    assert not rough[0]
    assert parsed("swing balancing_torque").estimated(np.cos(20 * angle[::15] + 0.2)[None])[1][0]  # 48 samples
    assert np.isnan(parsed("swing O").reduced(np.full((1, 36), np.nan))[0])


def test_swing_is_an_energy_of_torques():
    scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), 10.0)
    assert parsed("swing balancing_torque").of(scene).column == "swing balancing_torque [J]"
    assert parsed("ratio swing balancing_torque").of(scene).column == "ratio swing balancing_torque [1]"
    for name in ("O", "slider_position"):
        with pytest.raises(ks.ParameterError, match=r"swing is the energy that a torque exchanges.* is in (N|m)$"):
            parsed(f"swing {name}").of(scene)
