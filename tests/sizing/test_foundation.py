"""Block with a machine on springs: published numbers, integration in time, a simulation of two-way coupling, laws."""

import math
import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import kinetostatics as ks
from support.case_files import shipped
from support.every import every
from support.units import UNITS

TURN = 2.0 * np.pi
PUMP = {"mass": 75.0, "stiffness": 220e3, "damping": 0.02}
"""Block of a published example."""


def pump(speed=24.0 * np.pi, slider=1.5, **drive):
    return ks.solve(ks.crank_slider(0.05, 0.16, slider=ks.Link(slider)), 0.0, crank_speed=speed, **drive)


def rich(speed=20.0):
    """Machine with mass everywhere, an inclined guide with an offset, and weights."""
    links = {
        "crank": ks.Link(3.0, (0.1, 0.04), 0.2),
        "coupler": ks.Link(7.0, (0.4, -0.06), 0.9),
        "slider": ks.Link(11.0, (-0.05, 0.08), 0.3),
    }
    machine = ks.crank_slider(0.3, 0.8, guide_angle=0.4, guide_offset=0.07, **links)
    return ks.solve(machine, 0.0, crank_speed=speed, loads=ks.Gravity())


def curves(block, angle, derivative=0):
    """Displacement of the centre or its rates, (3, N)."""
    rate = (1j * block.order * block.crank_speed) ** derivative
    return np.real((rate * block.displacement) @ np.exp(1j * np.outer(block.order, angle)))


# Published numbers


@pytest.mark.slow
def test_block_of_80_kg():
    """1.8 kg of 80 kg moves by a 40 mm crank, with a coupler so long that the motion is harmonic."""
    machine = ks.crank_slider(0.04, 4000.0, slider=ks.Link(1.8))
    with pytest.warns(ks.HintWarning, match="4000 m long"):
        s = ks.solve(machine, 0.0, crank_speed=3000 * TURN / 60)
    first = ks.sizing.mount(s, mass=80.0, stiffness=877e3, damping=0.25).harmonics().loc[1.0]
    assert first["displacement"] * 1e3 == pytest.approx(0.9951, abs=5e-5)
    assert first["lag [deg]"] == pytest.approx(169.4, abs=0.05)
    assert first["force"] == pytest.approx(1.8 * 0.04 * s.crank_speed**2, rel=1e-6)


def test_pump_of_75_kg():
    block = ks.sizing.mount(pump(), **PUMP)
    assert (block.harmonics()["displacement"].iloc[:2] * 1e3).round(4).tolist() == [2.0624, 0.0920]
    assert round(block.travel_x * 1e3, 3) == 4.125


@pytest.mark.slow
@every("variant, v_rms, ground", [("plain", 235.2, 92.7), ("cam-circle", 235.3, 90.2)])
def test_saw_on_30_t_gains_nothing(variant, v_rms, ground):
    s = shipped("sawframe_2r63").solve(variant, 8)
    block = ks.sizing.mount(s, mass=30e3, stiffness=30e3 * (0.5 * s.crank_speed) ** 2, damping=0.1)
    assert round(block.v_rms * 1e3, 1) == v_rms
    assert round(block.ground_x / 1e3, 1) == ground
    assert block.tuning == pytest.approx(0.5, rel=1e-14)
    assert ks.sizing.block_for(s, v_rms=7.1e-3).mass > 990e3


# Independent computations


@pytest.mark.slow
def test_steady_state_of_integration_in_time():
    """All three directions: the block from rest, under the force and moment at even crank angles."""
    s, centre, masses = rich(), (0.1, -0.3), np.array([4000.0, 4000.0, 900.0])
    springs, ratios = np.array([2e5, 4e5, 6e4]), np.array([0.3, 0.25, 0.4])
    block = ks.sizing.mount(s, mass=4000.0, inertia=900.0, centre=centre, stiffness=list(springs), damping=list(ratios))
    angle = np.linspace(0.0, TURN, 361)
    ground = s.at(angle[:-1]).ground
    wrench = np.stack([*ground.resultant, ground.moment(centre)])
    wrench -= wrench.mean(axis=1, keepdims=True)
    force = CubicSpline(angle / 20.0, np.column_stack([wrench, wrench[:, 0]]), axis=1, bc_type="periodic")
    dampers = 2.0 * ratios * np.sqrt(springs * masses)

    def rates(time, state):
        return np.concatenate([state[3:], (force(time) - springs * state[:3] - dampers * state[3:]) / masses])

    end = 24 * TURN / 20.0
    last = solve_ivp(rates, (0.0, end), np.zeros(6), "DOP853", rtol=1e-9, atol=1e-12, dense_output=True).sol
    state = last(end - TURN / 20.0 + angle / 20.0)
    for derivative, own in enumerate((state[:3], state[3:])):
        size = np.abs(own).max(axis=1, keepdims=True)
        assert np.all(np.abs(curves(block, angle, derivative) - own) < 3e-6 * size)
    load = springs[:, None] * state[:3] + dampers[:, None] * state[3:]
    assert np.allclose([block.ground_x, block.ground_y, block.ground_turn], np.abs(load).max(axis=1), rtol=1e-4)
    at_o = state[3:5] + np.outer([centre[1], -centre[0]], state[5])
    rms = np.sqrt(np.mean(np.concatenate([state[3:5], at_o])[:, :-1] ** 2, axis=1))
    assert block.v_rms == pytest.approx(rms.max(), rel=1e-5)
    assert block.v_rms_turn == pytest.approx(np.sqrt(np.mean(state[5, :-1] ** 2)), rel=1e-5)


OFFSET = 0.2
"""Height of the guide above the centre of mass, m."""


def ride(phi, speed):
    """Place of the slider along its guide, its first and second derivative in time."""
    r, length = 0.05, 0.16
    root = np.sqrt(length**2 - (r * np.sin(phi)) ** 2)
    first = -(r**2) * np.sin(phi) * np.cos(phi) / root
    second = -((r**2) * np.cos(2 * phi) + first**2) / root
    return r * np.cos(phi) + root, speed * (first - r * np.sin(phi)), speed**2 * (second - r * np.cos(phi))


def rms_of_two_bodies(masses, slider, springs, dampers, speed):
    """Rms velocities (x, y, turn) of a block and a slider that rides on it, by equations of large motion."""
    places = ride(np.arange(360) / 360 * TURN, speed)[0]
    mean, rest = places.mean(), masses[0] - slider
    below = np.array([0.0, -slider * OFFSET / rest])
    inertia = masses[2] - rest * below @ below - slider * (places.var() + OFFSET**2)

    def rates(time, state):
        place, rate, bend = ride(speed * time, speed)
        (turn_x, turn_y), spin = (np.cos(state[2]), np.sin(state[2])), state[5]
        axes = np.array([[turn_x, -turn_y], [turn_y, turn_x]])
        matrix, push = np.diag([0.0, 0.0, inertia]), -springs * state[:3] - dampers * state[3:]
        for mass, at, v, a in ((rest, below, 0.0, 0.0), (slider, np.array([place - mean, OFFSET]), rate, bend)):
            jacobian = np.column_stack([np.eye(2), axes @ (-at[1], at[0])])
            matrix = matrix + mass * jacobian.T @ jacobian
            push = push - mass * jacobian.T @ (axes @ (np.array([a, 2.0 * spin * v]) - spin**2 * at))
        return np.concatenate([state[3:], np.linalg.solve(matrix, push)])

    period = TURN / speed
    run = solve_ivp(rates, (0.0, 20 * period), np.zeros(6), "DOP853", rtol=1e-8, atol=1e-11, dense_output=True).sol
    return np.std(run(19 * period + np.arange(120) / 120 * period)[3:], axis=1)


@pytest.mark.slow
def test_error_of_one_way_coupling_falls_with_the_share_of_the_moving_mass():
    """Against two bodies that act on each other: four times the block, a quarter of the error."""
    errors, s = [], pump()
    centre = ride(np.arange(360) / 360 * TURN, 1.0)[0].mean(), -OFFSET
    for mass in (75.0, 300.0):
        masses = np.array([mass, mass, 0.05 * mass])
        springs = masses * (0.5 * s.crank_speed) ** 2
        block = ks.sizing.mount(s, mass=mass, inertia=masses[2], centre=centre, stiffness=list(springs), damping=0.3)
        found = rms_of_two_bodies(masses, 1.5, springs, 0.6 * np.sqrt(springs * masses), s.crank_speed)
        errors.append(np.abs(np.array([block.v_rms_x, block.v_rms_turn]) / found[[0, 2]] - 1.0))
    assert np.all(errors[0] < 5e-4)
    assert np.all(errors[1] < 0.3 * errors[0])


# Laws


@pytest.mark.slow
def test_square_wave_has_the_known_harmonics_and_a_note():
    """Every odd harmonic is 4 F / (pi n); of a jump the last harmonics of the velocity count."""
    square = ks.ProcessForce(lambda q: 100.0 * np.sign(np.sin(q.crank_angle)))
    s = ks.solve(ks.crank_slider(0.05, 0.16), 0.0, crank_speed=75.4, loads=square)
    with pytest.warns(ks.HintWarning, match="the force on the frame jumps: harmonics above 256"):
        block = ks.sizing.mount(s, mass=75.0, stiffness=75.0, damping=0.0)
    assert np.allclose(
        np.abs(block.force[0]), np.where(block.order % 2 == 1, 400.0 / (np.pi * block.order), 0.0), atol=1e-9
    )
    ramp = 100.0 / 75.0 * np.pi / 75.4 / 2.0  # triangular velocity of a mass without springs
    assert block.v_peak == pytest.approx(ramp, rel=3e-3)
    assert block.v_rms == pytest.approx(ramp / math.sqrt(3.0), rel=1e-3)


@pytest.mark.slow
def test_both_senses_of_rotation_shake_alike():
    way, back = (ks.sizing.mount(pump(speed), **PUMP) for speed in (75.4, -75.4))
    assert back.numbers == pytest.approx(way.numbers, rel=1e-12, nan_ok=True)
    assert np.allclose(back.harmonics()["lag [deg]"], way.harmonics()["lag [deg]"], atol=1e-9, equal_nan=True)


@pytest.mark.slow
def test_velocity_follows_the_scale_of_masses_and_speeds():
    """Twice all masses and springs: the same motion, twice the load. Twice the speed and sqrt(K): the same travel."""
    one = ks.sizing.mount(pump(), **PUMP)
    heavy = ks.sizing.mount(pump(slider=3.0), mass=150.0, stiffness=440e3, damping=0.02)
    fast = ks.sizing.mount(pump(48.0 * np.pi), mass=75.0, stiffness=880e3, damping=0.02)
    assert (heavy.v_rms, heavy.ground_x) == pytest.approx((one.v_rms, 2.0 * one.ground_x), rel=1e-12)
    assert (fast.travel_x, fast.ground_x) == pytest.approx((one.travel_x, 4.0 * one.ground_x), rel=1e-12)


@pytest.mark.slow
def test_a_machine_turned_by_a_right_angle_shakes_the_block_upward():
    lying = ks.sizing.mount(pump(), mass=75.0, stiffness=[220e3, 220e3], damping=0.02)
    machine = ks.crank_slider(0.05, 0.16, guide_angle=np.pi / 2, slider=ks.Link(1.5))
    s = ks.solve(machine, 0.0, crank_speed=24.0 * np.pi)
    upright = ks.sizing.mount(s, mass=75.0, stiffness=[220e3, 220e3], damping=0.02)
    for name in ("v_rms", "v_peak", "travel", "ground", "transmissibility"):
        assert upright.numbers[f"{name}_y"] == pytest.approx(lying.numbers[f"{name}_x"], rel=1e-12)
    assert upright.v_rms == pytest.approx(lying.v_rms, rel=1e-12)


@pytest.mark.slow
def test_quantities_with_units_are_converted():
    plain = ks.sizing.mount(rich(), mass=4e3, inertia=900.0, stiffness=[5e4, 9e4, 4e3], damping=0.3, centre=(0.1, -0.3))
    stiffness = [UNITS("50 N/mm"), UNITS("90 kN/m"), UNITS("4 kN m/rad")]
    given = {"mass": UNITS("4 t"), "inertia": UNITS("900 kg m^2"), "centre": UNITS.Quantity((100, -300), "mm")}
    assert ks.sizing.mount(rich(), stiffness=stiffness, damping=0.3, **given).numbers == pytest.approx(plain.numbers)


@pytest.mark.slow
def test_held_directions_pass_their_load_on():
    s = rich()
    block = ks.sizing.mount(s, mass=900.0, stiffness=5e4, damping=0.1)
    assert (block.v_rms_y, block.v_rms_turn) == (0.0, 0.0)
    assert (block.transmissibility_y, block.transmissibility_turn) == (1.0, 1.0)
    force = s.at(np.linspace(0.0, TURN, 3600)).ground.resultant[1]
    assert block.ground_y == pytest.approx(np.abs(force - force[:-1].mean()).max(), rel=1e-6)


@pytest.mark.slow
def test_stiff_springs_pass_the_load_of_a_fixed_frame_and_soft_ones_none():
    stiff = ks.sizing.mount(rich(), mass=900.0, stiffness=[9e12, 9e12], damping=0.0)
    soft = ks.sizing.mount(rich(), mass=900.0, stiffness=[9e-3, 9e-3], damping=0.0)
    assert (stiff.transmissibility_x, stiff.transmissibility_y) == pytest.approx((1.0, 1.0), rel=1e-5)
    assert max(soft.transmissibility_x, soft.transmissibility_y) < 1e-6


@pytest.mark.slow
def test_a_load_over_two_turns_has_half_orders():
    load = ks.ProcessForce(lambda q: 50.0 * np.sin(0.5 * q.crank_angle), period=2 * TURN)
    s = ks.solve(ks.crank_slider(0.05, 0.16), 0.0, crank_speed=75.4, loads=load)
    block = ks.sizing.mount(s, **PUMP)
    assert block.order.tolist() == [0.5]
    assert abs(block.force[0, 0]) == pytest.approx(50.0, rel=1e-12)


@pytest.mark.slow
def test_block_for_keeps_the_velocity():
    s = rich()
    block = ks.sizing.block_for(s, v_rms=2e-3, tuning=0.4, damping=0.05)
    spring = block.mass * (0.4 * 20.0) ** 2
    again = ks.sizing.mount(s, mass=block.mass, stiffness=[spring, spring], damping=0.05)
    assert (block.v_rms, again.v_rms) == pytest.approx((2e-3, 2e-3), rel=1e-12)


# What is doubtful or refused


def test_a_light_block_is_noted():
    """On very soft springs the accelerations are as the masses."""
    with pytest.warns(ks.HintWarning, match=r"mount: the block's acceleration is 18.8 % of the machine's; reactions"):
        block = ks.sizing.mount(pump(), mass=8.0, stiffness=1e-3, damping=0.0)
    assert block.coupling == pytest.approx(1.5 / 8.0, rel=1e-6)


REFUSED = [
    ({"mass": 0.0}, "mass must be greater than 0"),
    ({"mass": math.nan}, "mass must be finite"),
    ({"mass": 1.5}, "greater than that of the moving links, 1.5 kg, which it includes, got 1.5"),
    ({"mass": np.array([[75.0], [80.0]])}, "mass must be one number"),
    ({"stiffness": -1.0}, "stiffness x must be greater than 0"),
    ({"stiffness": [1e5, 0.0]}, "stiffness y must be greater than 0"),
    ({"stiffness": [1e5] * 4}, "stiffness must be a number or a list of up to three"),
    ({"stiffness": []}, "stiffness must be a number or a list of up to three"),
    ({"stiffness": None}, "stiffness x must be a number"),
    ({"damping": -0.1}, "damping x must be at least 0"),
    ({"stiffness": [1e5, 1e5], "damping": [0.1]}, "a list of 2 numbers like stiffness"),
    ({"stiffness": [1e5] * 3}, "inertia and a third stiffness, for rotation, must be given together"),
    ({"inertia": 3.0}, "inertia and a third stiffness, for rotation, must be given together"),
    ({"stiffness": [1e5] * 3, "inertia": -1.0}, "inertia must be greater than 0"),
    ({"centre": (0.0, math.nan)}, "centre y must be finite"),
    ({"mass": -1.0, "damping": math.nan}, "mass must be .*; damping x must be"),
    ({"stiffness": 75.0 * (2 * 24 * np.pi) ** 2, "damping": 0.0}, "harmonic 2 of the crank meets .* of 24 Hz without"),
]


@pytest.mark.slow
@every("wrong, message", REFUSED)
def test_wrong_numbers_are_refused(wrong, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.mount(pump(), **{**PUMP, **wrong})


def touching(coupler, offset):
    """The coupler is square to the guide at a crank angle: the slider's velocity jumps there, between finite forces."""
    machine = ks.crank_slider(0.05, coupler, guide_offset=offset, slider=ks.Link(1.5))
    with warnings.catch_warnings(action="ignore"):
        return ks.solve(machine, 0.3, crank_speed=75.4)


MACHINES = [
    (lambda: "pump", "solution must be a Solution"),
    (lambda: pump(0.0, sense=1), "constant crank speed other than 0"),
    (lambda: pump(crank_acceleration=1.0), "constant crank speed other than 0, without acceleration"),
    (lambda: pump(np.array([[70.0], [80.0]])), "works on one design at a time"),
    (lambda: ks.solve(ks.crank_slider(0.05, 0.04), 0.0, crank_speed=75.4), "does not close for crank angles 53.1"),
    (lambda: touching(0.06, 0.01), "B changes its velocity at once at 270 deg, a shock on the frame"),
    (lambda: touching(0.05, 0.0), "B changes its velocity at once at 90 deg, a shock on the frame"),
]


@every("machine, message", MACHINES)
def test_machines_without_periodic_vibration_are_refused(machine, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.mount(machine(), **PUMP)
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.block_for(machine(), v_rms=1e-3)


@pytest.mark.slow
@every(
    "wrong, message",
    [
        ({"v_rms": 0.0, "tuning": -1.0}, "v_rms must be greater than 0.*; tuning must be greater than 0"),
        ({"tuning": 1.0, "damping": 0.0}, "harmonic 1 of the crank meets the natural frequency of 12 Hz"),
        ({"v_rms": 10.0}, r"no block is needed: 0\.\d+ kg suffice for v_rms, and the moving links already have 1.5 kg"),
    ],
)
def test_block_for_refuses(wrong, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.block_for(pump(), **({"v_rms": 1e-3} | wrong))


def test_a_yoke_has_one_harmonic_and_no_resonance_with_others():
    """Its force is harmonic, so springs without damping may be tuned to the second."""
    yoke = ks.scotch_yoke(0.05, slider=ks.Link(2.0))
    s = ks.solve(yoke, 0.0, crank_speed=10.0)
    block = ks.sizing.mount(s, mass=50.0, stiffness=50.0 * 20.0**2, damping=0.0)
    assert block.order.tolist() == [1.0]
    assert block.displacement[0, 0] == pytest.approx(2.0 * 0.05 * 100.0 / (50.0 * (400.0 - 100.0)), rel=1e-12)


@pytest.mark.slow
def test_a_machine_without_mass_does_not_shake():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        block = ks.sizing.mount(pump(slider=0.0), **PUMP)
    assert (block.v_rms, block.ground_x, block.coupling) == (0.0, 0.0, 0.0)
    assert math.isnan(block.transmissibility_x)


def test_harmonics_and_numbers_by_name():
    block = ks.sizing.mount(pump(), **PUMP)
    assert block.table().loc["ground_x"].iloc[:2].tolist() == [block.ground_x, "N"]
    with pytest.raises(ks.ParameterError, match="way is 'z', allowed: 'x', 'y', 'turn'"):
        block.harmonics("z")
    with pytest.raises(AttributeError, match="has no attribute 'v_max'"):
        _ = block.v_max


@pytest.mark.slow
def test_figure_has_a_row_for_each_moving_direction():
    figure = ks.plots.mount(ks.sizing.mount(rich(), mass=900.0, stiffness=[5e4, 9e4], damping=0.1))
    assert [ax.get_ylabel() for ax in figure.axes][::2] == ["velocity, x [mm/s]", "velocity, y [mm/s]"]
    with pytest.raises(ks.ParameterError, match="result must be a Mount"):
        ks.plots.mount(3)
