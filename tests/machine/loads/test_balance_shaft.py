"""Balance shafts: forces on frame and crank by a Newton-Euler system with gears, energies, periods, refusals."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design import case_text
from kinetostatics.mechanics.free_body import free_body
from kinetostatics.mechanics.quantities import components
from support.case_files import case_file, problems
from support.every import every

RATIOS = 1, -1, 2, -2, Fraction(1, 2), -1.5
SHAFT = ks.BalanceShaft(0.06, -2, 0.7, (0.2, -0.1), 0.03, mass=4.0)
GRAVITY = ks.Gravity(9.81, -1.2)
LINKS = {"crank": ks.Link(2.0, (0.03, 0.01), 0.02), "coupler": ks.Link(1.0, (0.1, 0.01), 0.01), "slider": ks.Link(4.0)}


def pump(*shafts, speed=30.0, acceleration=50.0, **changes):
    machine = ks.crank_slider(0.1, 0.35, guide_offset=0.03, guide_angle=0.4, **LINKS | changes)
    return ks.Scene(machine, speed, acceleration, (GRAVITY, *shafts))


def far(found, expected):
    return np.max(np.abs(np.asarray(found) - expected)) / max(1e-9, np.max(np.abs(expected)))


# Independent check: every body by Newton and Euler, the gear as a constraint between the turning of shaft and crank


def newton_euler(scene, angle):
    """Torque, and force and moment about O on the frame, by a linear system of all bodies at one crank angle."""
    speed, alpha = scene.crank_speed, scene.crank_acceleration
    places, h = {}, 1e-2

    def bodies(phi):
        """Mass centre and angle of each body, by its own geometry."""
        u, along = np.exp(1j * phi), np.exp(0.4j)
        pin = 0.1 * u
        seen = pin / along
        end = (seen.real + np.sqrt(0.35**2 - (0.03 - seen.imag) ** 2) + 0.03j) * along
        rod = (end - pin) / 0.35
        found = {"crank": (0.03 + 0.01j) * u, "coupler": pin + (0.1 + 0.01j) * rod, "slider": end}
        angles = {"crank": phi, "coupler": np.angle(rod), "slider": 0.4}
        for number, item in enumerate(scene.loads[1:]):
            turned = float(item.ratio) * phi + item.phase
            found[number] = complex(*item.at) + item.unbalance / item.mass * np.exp(1j * turned)
            angles[number] = turned
        return found, angles, pin, end

    steps = np.array([-3, -2, -1, 0, 1, 2, 3])
    first = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60.0 / h
    second = np.array([2, -27, 270, -490, 270, -27, 2]) / 180.0 / h**2
    near = [bodies(angle + h * k) for k in steps]
    for name in near[0][0]:
        for part in (0, 1):
            values = np.array([item[part][name] for item in near])
            places[name, part] = speed**2 * (second @ values) + alpha * (first @ values)
    centres, _, pin, end = bodies(angle)
    shafts = scene.loads[1:]
    own = {name: (link.mass, link.inertia) for name, link in LINKS.items()}
    own |= {k: (item.mass, item.inertia - item.unbalance**2 / item.mass) for k, item in enumerate(shafts)}
    rows, names = {name: 3 * k for k, name in enumerate(own)}, {}
    matrix, right = np.zeros((3 * len(own), 7 + 1 + 3 * len(shafts) + 1)), np.zeros(3 * len(own))

    def push(column, body, force, point):
        row, lever = rows[body], point - centres[body]
        matrix[row : row + 3, column] += force.real, force.imag, (np.conj(lever) * force).imag

    def joint(column, body, other, point):
        names[column] = point
        for k, force in enumerate((1.0, 1.0j)):
            push(column + k, body, complex(force), point)
            if other is not None:
                push(column + k, other, -complex(force), point)

    joint(0, "crank", None, 0.0)
    joint(2, "coupler", "crank", pin)
    joint(4, "slider", "coupler", end)
    push(6, "slider", 1j * np.exp(0.4j), end)
    matrix[rows["slider"] + 2, 7] = 1.0
    matrix[rows["crank"] + 2, 8] = 1.0
    for k, item in enumerate(shafts):
        joint(9 + 3 * k, k, None, complex(*item.at))
        matrix[rows[k] + 2, 11 + 3 * k] = 1.0
        matrix[rows["crank"] + 2, 11 + 3 * k] = -float(item.ratio)
    weight = complex(*GRAVITY.vector)
    for name, (mass, inertia) in own.items():
        force = mass * (places[name, 0] - weight)
        right[rows[name] : rows[name] + 3] = force.real, force.imag, inertia * places[name, 1].real
    found = np.linalg.solve(matrix, right)
    force, moment = -(found[0] + 1j * found[1]) - found[6] * 1j * np.exp(0.4j), -found[7] - found[8]
    moment -= found[6] * (np.conj(end) * 1j * np.exp(0.4j)).imag
    for k, item in enumerate(shafts):
        bearing = found[9 + 3 * k] + 1j * found[10 + 3 * k]
        force -= bearing
        moment -= (np.conj(complex(*item.at)) * bearing).imag + (1.0 - float(item.ratio)) * found[11 + 3 * k]
    return found[8], force, moment


@pytest.mark.slow
@every("speed, acceleration", [(30.0, 50.0), (-30.0, 50.0), (0.0, -40.0)])
@every("ratio", RATIOS)
def test_torque_and_frame_by_newton_and_euler(ratio, speed, acceleration):
    other = ks.BalanceShaft(0.01, 3, inertia=0.01, mass=1.0)
    scene = pump(replace(SHAFT, ratio=ratio), other, speed=speed, acceleration=acceleration)
    for angle in (0.3, 2.1, 5.0):
        torque, force, moment = newton_euler(scene, angle)
        s = scene.solve(angle)
        assert s.balancing_torque == pytest.approx(torque, abs=1e-9 * s.largest_torque_term)
        assert complex(*s.ground.resultant) == pytest.approx(force, abs=1e-9 * s.largest_force_term)
        assert s.ground.moment() == pytest.approx(moment, abs=1e-9 * s.largest_force_term)


# Laws


@pytest.mark.slow
@every("ratio", RATIOS)
def test_power_frame_and_energy_balance(ratio):
    s = pump(replace(SHAFT, ratio=ratio)).solve(24)
    assert np.max(s.power_residual) < 1e-14
    weights = sum(link.mass for link in LINKS.values()) + SHAFT.mass
    expected = s.shaking_force + weights * np.reshape(GRAVITY.vector, (2, 1))
    assert far(s.ground.resultant, expected) < 1e-13
    still = pump(replace(SHAFT, ratio=ratio), acceleration=0.0)
    phi, h = s.crank_angle, 1e-4
    energy = [still.solve(phi + k * h) for k in (-2, -1, 1, 2)]
    total = np.array([item.kinetic_energy + item.potential_energy for item in energy])
    assert far(np.array([1, -8, 8, -1]) / (12 * h) @ total, still.solve(phi).balancing_torque) < 1e-9


def test_ratio_1_is_a_counterweight_on_the_crank():
    shaft = ks.BalanceShaft(0.2, 1, 0.5, inertia=0.2 * 0.25, mass=0.8)
    place = 0.25 * np.exp(0.5j)
    plain, loaded = pump(crank=LINKS["crank"].joined(0.8, (place.real, place.imag))), pump(shaft)
    one, two = plain.solve(48), loaded.solve(48)
    for name in ("balancing_torque", "shaking_force", "shaking_moment", "kinetic_energy", "potential_energy"):
        assert far(getattr(two, name), getattr(one, name)) < 1e-13
    assert far(two.reaction("O") - two.ground["balance_shaft"].force, one.reaction("O")) < 1e-13


def test_place_on_the_frame():
    shaft = ks.BalanceShaft(0.06, -2, at=(0.2, -0.1), inertia=0.03, mass=4.0)
    found = pump(shaft, acceleration=0.0).solve(np.array([0.0])).ground["balance_shaft"]
    assert found.point[:, 0] == pytest.approx([0.2, -0.1])
    assert found.force[:, 0] == pytest.approx(np.array([0.06 * 4 * 900.0, 0.0]) + 4.0 * np.array(GRAVITY.vector))
    assert found.couple[0] == pytest.approx(3.0 * 0.06 * GRAVITY.vector[1])


@pytest.mark.slow
@every("ratio, turns", [(2, 1), (Fraction(1, 2), 2), (-1.5, 2), ("2/3", 3), (1 / 7, 7), (np.float64(0.25), 4)])
def test_the_period_grows_to_the_denominator(ratio, turns):
    scene = pump(replace(SHAFT, ratio=ratio))
    assert scene.period == pytest.approx(2 * np.pi * turns)
    largest = ks.extremes(scene.solve(90), "shaking_force").largest
    dense = scene.solve(7200 * turns)
    assert largest == pytest.approx(np.hypot(*dense.shaking_force).max(), rel=1e-5)
    assert ks.Scene(scene.mechanism, 1.0, loads=[SHAFT]).period == pytest.approx(2 * np.pi)


@pytest.mark.slow
def test_free_body_of_the_crank_and_shares():
    s = pump(SHAFT).solve(np.linspace(0.0, 6.0, 5))
    actions = free_body(s.dynamics, "crank")
    total = sum(item.couple + item.point[0] * item.force[1] - item.point[1] * item.force[0] for item in actions)
    assert np.max(np.abs(total)) < 1e-12 * s.largest_torque_term
    assert {"inertia of BalanceShaft", "BalanceShaft"} <= {a.name for a in actions}
    for quantity in ("balancing_torque", "shaking_force"):
        shares = pump(SHAFT).solve(36).shares(quantity)
        assert abs(shares.rest) < 1e-12 * shares.total.value
        assert abs(shares["BalanceShaft"].peak) > 0.1


def test_rocking_moment_by_planes():
    engine = ks.Mechanism("pump", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(1.0), plane=0.0),))
    s = ks.Scene(engine, 100.0, loads=replace(SHAFT, plane=0.3)).solve(7)
    x, y = s.ground["balance_shaft"].force
    assert far(s.rocking_moment, np.array([-0.3 * y, 0.3 * x])) < 1e-14


def test_inertia_of_a_coasting_machine():
    """The reduced inertia counts the square of the ratio, and a steady torque slows it evenly."""
    shaft = ks.BalanceShaft(0.0, -2, inertia=0.05)
    scene = ks.Scene(
        ks.crank_slider(0.1, 0.35, crank=ks.Link(0.0, 0.0, 0.1)), 10.0, loads=[shaft, ks.Torque(-3.0, on="crank")]
    )
    assert scene.solve(1).reduced_inertia[0] == pytest.approx(0.1 + 4 * 0.05)
    run = ks.drive.coast(scene, from_speed=10.0, until=0.5)
    assert run.speed[-1] == pytest.approx(10.0 - 3.0 / 0.3 * 0.5, rel=1e-12)


# Every engine, and derivatives

QUANTITIES = ("balancing_torque", "shaking_force", "shaking_moment", "ground balance_shaft", "reduced_inertia")
PATHS = [f"balance_shaft.{name}" for name in ("unbalance", "phase", "at.x", "at.y", "inertia", "mass", "plane")]


SHAFTS = SHAFT, ks.BalanceShaft(0.01, Fraction(1, 3), at=(0.1, 0.0))


@pytest.mark.slow
def test_the_compiled_engine_agrees_to_rounding():
    pytest.importorskip("numba")
    scene = pump(*SHAFTS)
    one, two = scene.solve(12), scene.solve(12, engine="compiled")
    for name in QUANTITIES:
        assert far(np.array(components(two, name)), np.array(components(one, name))) < 1e-14


@every("name", QUANTITIES)
def test_error_bounds_hold(name):
    pytest.importorskip("flint")
    from kinetostatics.studies.methods.high_precision.enclosures import enclosure

    s = pump(*SHAFTS).solve(6)
    bound = np.broadcast_to(s.error_bound(name), np.shape(components(s, name)))
    for value, middle, most in zip(components(s, name), enclosure(s, name).middle, bound, strict=True):
        assert np.all(np.abs(value - middle) <= most)
        assert np.all(most < 1e-11 * max(1.0, np.max(np.abs(value))))


def test_derivatives_equal_differences():
    program = ks.compile(pump(*SHAFTS), QUANTITIES, engine="numpy", parameters=PATHS)
    angles = np.array([0.3, 2.0])
    exact = program.derivatives(angles, PATHS)
    for path in PATHS:
        above, below = (program(angles, {path: program.parameters[path] + step}) for step in (1e-4, -1e-4))
        for name in QUANTITIES:
            slope = (above[name] - below[name]) / 2e-4
            assert np.max(np.abs(exact[name][path] - slope)) < 1e-7 * max(1.0, np.max(np.abs(above[name])))


@pytest.mark.slow
def test_sweeps_and_steady_running():
    scene = pump(SHAFT, acceleration=0.0)
    designs = ks.designs.grid({"balance_shaft.unbalance": "0..0.06 kg m:3", "balance_shaft.phase": "0..40 deg:2"})
    table = ks.sweep(scene, designs, ["largest shaking_force"], progress=False)
    for row in table.itertuples(index=False):
        unbalance, phase, largest = row[:3]
        alone = pump(replace(SHAFT, unbalance=unbalance, phase=np.radians(phase)), acceleration=0.0).solve(60)
        assert largest == pytest.approx(ks.extremes(alone, "shaking_force").largest, rel=1e-9)
    motor = ks.drive.Motor.kloss(750.0, 29.0, synchronous_speed=31.0, overload=2.5)
    run = ks.drive.steady(pump(SHAFT, ks.BalanceShaft(0.02, 0.5), acceleration=0.0), motor, 0.5)
    assert run.crank_angle[-1] > 4.0 * np.pi - 0.2
    s = run.solution
    assert np.max(np.abs(s.balancing_torque + 0.5 * run.acceleration - run.motor_torque)) < 1e-9 * s.largest_torque_term


# Case files

CASE = """
title = "pump"
reference = "bare"
[common]
mechanism = "crank-slider"
crank_length = "50 mm"
coupler_length = "200 mm"
crank_speed = "900 rpm"
slider = { mass = "1 kg" }
[variants.bare]
[variants.shafts]
[[variants.shafts.loads]]
kind = "balance shaft"
unbalance = "25 kg mm"
at = ["0 mm", "80 mm"]
phase = "180 deg"
[[variants.shafts.loads]]
kind = "balance shaft"
unbalance = "1 kg mm"
ratio = "1/2"
inertia = "0.001 kg m^2"
mass = "0.5 kg"
"""


def test_case_files(tmp_path):
    case = ks.load_case(case_file(tmp_path, CASE))
    first, second = case.variants["shafts"].scene.loads
    assert (first.unbalance, first.ratio, first.phase, first.at) == (0.025, -1.0, np.pi, (0.0, 0.08))
    assert (second.ratio, second.inertia, second.mass) == (0.5, 0.001, 0.5)
    scene = case.variants["shafts"].scene.varied({"crank.mass": 3.0})
    third = ks.Scene(scene.mechanism, scene.crank_speed, loads=(*scene.loads, ks.BalanceShaft(0.1, "-7/3", 0.4)))
    again = ks.load_case(case_text.write_case(tmp_path / "again.toml", "Again", {"one": third})).variant("one").scene
    np.testing.assert_array_equal(again.solve(9).balancing_torque, third.solve(9).balancing_torque)
    (text,) = problems(tmp_path, CASE.replace('"1/2"', "0.123456"))
    assert "denominator of at most 24" in text


# Refusals

BAD_RATIOS = {
    "0": (0, "must not be 0"),
    "irrational": (np.sqrt(2.0), "denominator of at most 24"),
    "large": (1e9, "at most 100"),
    "beyond all floats": (10**400, "at most 100"),
    "imprecise": (np.float32(1 / 3), "denominator of at most 24"),
    "not a number": (np.nan, "must be a number"),
    "infinite": (-np.inf, "must be a number"),
    "text": ("twice", "must be a number"),
    "truth": (True, "must be a number"),
    "array": (np.array([[1.0], [2.0]]), "must be a number"),
    "none": (None, "must be a number"),
    "by zero": ("1/0", "must be a number"),
}


@every("name", BAD_RATIOS)
def test_ratios_that_no_gear_has(name):
    value, words = BAD_RATIOS[name]
    with pytest.raises(ks.ParameterError, match=f"ratio .*{words}"):
        ks.BalanceShaft(0.1, value)


@every("value", (np.float32(-0.5), np.int64(-2)))
def test_ratios_by_numpy(value):
    assert ks.BalanceShaft(0.1, value).ratio == float(value)


@pytest.mark.slow
def test_pulled_by_nothing_it_does_nothing():
    one, two = (pump(*shafts).solve(5) for shafts in ((), (ks.BalanceShaft(0.0, 3),)))
    assert np.array_equal(one.balancing_torque, two.balancing_torque)
    assert np.array_equal(one.shaking_force, two.shaking_force)
