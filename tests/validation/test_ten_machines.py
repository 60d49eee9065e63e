"""Ten machines, modelled by the recipes of the pages, against virtual work and Newton's law written out by hand.

The numbers of each machine stand here once more. Nothing of the package computes what is expected: coordinates follow
from circles and lines, derivatives by the crank angle from complex steps.
"""

import re
import warnings
from functools import cache
from math import pi, radians
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import kinetostatics as ks
from support.every import every
from support.pages import CELL, DOCS, needed, text_of

pytestmark = needed
RPM = pi / 30
TEN = "machines/ten_machines.md"
RECIPES = {
    "engine": ("machines/loads.md", "Gas pressure and indicator diagrams"),
    "press": ("machines/loads.md", "Process force on a slider"),
    "shaper": ("machines/shaper.md", None),
    "pumpjack": (TEN, "Pumpjack"),
    "sewing machine": (TEN, "Sewing machine: needle bar and take-up lever"),
    "wiper": (TEN, "Wiper"),
    "V-twin": (TEN, "V-twin with articulated rod"),
    "baler": (TEN, "Baler with friction and start-up"),
    "valve train": (TEN, "Valve train"),
    "jigsaw": (TEN, "Jigsaw with a torque-free cam"),
}
"""Page and section of each recipe."""


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory):
    """Recipes write their files there."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("recipes"))
        yield


@cache
def names(machine):
    """Names that the cells of a recipe make."""
    page, section = RECIPES[machine]
    text = text_of(DOCS / page)
    if section is not None:
        first, *sections = re.split(r"^## ", text, flags=re.MULTILINE)
        chosen = [part for part in sections if part.partition("\n")[0] == section]
        if page != TEN:  # the page's machine and speed
            first += next(part for part in sections if "```{code-cell}" in part)
        text = "\n".join([first, *chosen])
        assert len(chosen) == 1
    found: dict = {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _, code in CELL.findall(text):
            exec(compile(re.sub(r"^ks\.plots\..*$", "", code, flags=re.MULTILINE), machine, "exec"), found)
    return found


# By hand


def slope(function, angle, step=1e-30):
    """Derivative of an analytic function of real angles, or of the coordinates of a point, to rounding."""
    return np.imag(np.array(function(angle + 1j * step))) / step


def torque(speed, angle, *, masses=(), inertias=(), forces=(), couples=()):
    """Torque of the drive at constant speed by virtual work.

    Pairs of a mass and its point, an inertia and its angle, a force (x, y) and its point, a couple and its angle;
    points and angles are functions of the crank angle, points give x and y.
    """

    def inertia(at):  # reduced to the crank
        parts = [mass * np.sum(slope(point, at) ** 2, axis=0) for mass, point in masses]
        return sum(parts) + sum(value * slope(turn, at) ** 2 for value, turn in inertias)

    step = 2.0**-12
    found = 0.0 * angle
    if masses or inertias:
        pairs = [(inertia(angle + k * step) - inertia(angle - k * step)) / (2 * k * step) for k in (1, 2)]
        found = found + 0.5 * speed**2 * (4 * pairs[0] - pairs[1]) / 3
    for force, point in forces:
        found = found - sum(part * rate for part, rate in zip(force, slope(point, angle), strict=True))
    return found - sum(couple * slope(turn, angle) for couple, turn in couples)


def on_crank(along, across=0.0):
    return lambda p: (along * np.cos(p) - across * np.sin(p), along * np.sin(p) + across * np.cos(p))


def met(first, r1, second, r2, side):
    """Point at the distances r1 and r2 from two points, left of the line from the first to the second if side is 1."""

    def point(p):
        (x1, y1), (x2, y2) = first(p), second(p)
        dx, dy = x2 - x1, y2 - y1
        square = dx * dx + dy * dy
        a = (r1 * r1 - r2 * r2 + square) / (2 * square)
        h = side * np.sqrt(r1 * r1 / square - a * a)
        return x1 + a * dx - h * dy, y1 + a * dy + h * dx

    return point


def on_line(start, length, direction, offset=0.0):
    """Pin at a distance from a point, ahead on the line in a direction, at an offset to its left."""
    c, s = np.cos(direction), np.sin(direction)

    def point(p):
        x, y = start(p)
        along, across = c * x + s * y, c * y - s * x
        along = along + np.sqrt(length**2 - (offset - across) ** 2)
        return c * along - s * offset, s * along + c * offset

    return point


def beside(start, end, length, along, across=0.0):
    """Place on the link from a point to another."""

    def point(p):
        (x, y), (ex, ey) = start(p), end(p)
        c, s = (ex - x) / length, (ey - y) / length
        return x + along * c - across * s, y + along * s + across * c

    return point


def turned(start, end):
    """Angle of a link from a point to another."""

    def angle(p):
        (x, y), (ex, ey) = start(p), end(p)
        dx, dy = ex - x, ey - y
        step = dx.real * dy.imag - dy.real * dx.imag  # of complex steps, of which arctan2 takes none
        return np.arctan2(dy.real, dx.real) + 1j * step / (dx.real**2 + dy.real**2)

    return angle


def fixed(x, y):
    return lambda p: (x + 0 * p, y + 0 * p)


def close(found, expected, tolerance=1e-9):
    assert_allclose(found, expected, rtol=0, atol=tolerance * np.abs(expected).max())


# Machines


@pytest.mark.slow
def test_engine_with_a_diagram_from_top_dead_centre_by_virtual_work():
    s, (degrees, bar) = names("engine")["s"], np.loadtxt("diagram.csv", delimiter=",", skiprows=1).T
    crank = on_crank(0.045)
    piston = on_line(crank, 0.150, pi / 2)

    def gas(after_tdc):
        return -1e5 * 50e-4 * np.interp(np.degrees(after_tdc) % 720, [*degrees, 720], [*bar, bar[0]])

    expected = torque(
        -3000 * RPM,
        s.crank_angle,
        masses=[(0.6, beside(crank, piston, 0.150, 0.045)), (0.5, piston)],
        inertias=[(0.002, turned(crank, piston))],
        forces=[((0, gas(pi / 2 - s.crank_angle)), piston)],  # it turns clockwise
    )
    close(s.balancing_torque, expected, 1e-7)
    fine = np.linspace(0, 4 * pi, 144_001)
    work = -np.trapezoid(gas(fine[:-1].tolist() + [0.0]), piston(pi / 2 - fine)[1])
    assert s.energy_per_turn == pytest.approx(work / 2, rel=1e-7)


def test_press_by_force_times_way():
    s = names("press")["s"]
    ram = on_line(on_crank(0.1), 0.45, -pi / 2)
    x = s.slider_position
    force = np.interp(x, [0.35, 0.53, 0.5301, 0.55], [0, 0, -200e3, -200e3]) * (s.slider_velocity > 0)
    close(s.balancing_torque, torque(2 * pi, s.crank_angle, forces=[((0, -force), ram)]))
    assert s.energy_per_turn == pytest.approx(200e3 * (0.02 - 0.0001 / 2), rel=1e-12)


def test_shaper_by_virtual_work():
    s = names("shaper")["s"]
    pin, pivot = on_crank(0.12), fixed(0.0, -0.24)

    def lever(p):
        return np.sqrt(0.12**2 + 0.24**2 + 2 * 0.12 * 0.24 * np.sin(p))

    def place(along):
        def point(p):
            (x, y), (ox, oy), length = pin(p), pivot(p), lever(p)
            return ox + along * (x - ox) / length, oy + along * (y - oy) / length

        return point

    end = place(0.45)
    ram = on_line(end, 0.25, pi, -0.18)
    turning, rod = turned(pivot, pin), beside(end, ram, 0.25, 0.125)
    bodies = [(25, place(0.23)), (2, pin), (6, rod), (120, ram)]
    travel = -ram(s.crank_angle)[0]
    cut = np.interp(travel, [0.0, 0.048, 0.05, 0.446, 0.448, 0.6], [0, 0, -4e3, -4e3, 0, 0])
    force = cut * (s.travel_velocity() > 0)
    weights = [((0, -9.81 * mass), point) for mass, point in bodies]
    expected = torque(
        40 * RPM,
        s.crank_angle,
        masses=bodies,
        inertias=[(0.5, turning), (0.03125, turned(end, ram))],
        forces=[*weights, ((-force, 0), ram)],
    )
    close(s.travel(), travel)
    close(s.balancing_torque, expected, 1e-7)
    assert s.energy_per_turn == pytest.approx(4e3 * (0.396 + 0.002), rel=1e-9)  # area of the table
    # the slow way: the lever's ends stand where the crank is square to it, at 30 degrees
    ends = ks.extremes(s, lambda motion: np.unwrap(np.arctan2(*(motion.position("C") - [[0.0], [-0.24]]))))
    assert sorted(np.degrees(ends.angle)) == pytest.approx([210.0, 330.0])


def test_pumpjack_by_virtual_work():
    s = names("pumpjack")["s"]
    pivot = fixed(-2.45, 3.10)
    tail = met(on_crank(0.95), 3.10, pivot, 2.45, -1)
    beam = turned(pivot, tail)
    pull = 2.80 * np.where(-slope(beam, s.crank_angle) < 0, 70e3, 40e3)
    bodies = [(4800, on_crank(1.2)), (2500, beside(pivot, tail, 2.45, -0.3))]
    expected = torque(
        -10 * RPM,
        s.crank_angle,
        masses=bodies,
        inertias=[(8000, beam)],
        forces=[((0, -9.81 * mass), point) for mass, point in bodies],
        couples=[(pull, beam)],
    )
    inside = np.abs(slope(beam, s.crank_angle)) > 1e-3  # the pull jumps where the beam turns back
    close(s.balancing_torque[inside], expected[inside], 1e-7)
    reach, behind = np.hypot(2.45, 3.10), 2.45
    ends = [np.arccos((behind**2 + reach**2 - (3.10 + way) ** 2) / (2 * behind * reach)) for way in (0.95, -0.95)]
    assert abs(s.energy_per_turn) == pytest.approx(30e3 * 2.80 * (ends[0] - ends[1]), rel=1e-12)


def test_needle_bar_and_take_up_lever_by_virtual_work():
    s = names("sewing machine")["s"]
    crank = on_crank(0.015)
    needle = on_line(crank, 0.040, -pi / 2)
    other = on_crank(0.012, 0.012)
    joint = met(other, 0.030, fixed(-0.020, 0.030), 0.032, -1)
    eye = beside(other, joint, 0.030, 0.050, -0.030)
    angle = s.crank_angle
    close(s.position("E"), eye(angle))
    down = -needle(angle)[1]
    cloth = np.interp(down, [0.024, 0.045, 0.0452, 0.056], [0, 0, -20, -20]) * (s.slider_velocity > 0)
    expected = torque(
        4000 * RPM,
        angle,
        masses=[(0.015, beside(crank, needle, 0.040, 0.020)), (0.060, needle)],
        inertias=[(3e-6, turned(crank, needle))],
        forces=[((0, -1.5), eye), ((0, -cloth), needle)],
    )
    close(s.balancing_torque, expected, 1e-7)
    assert s.energy_per_turn == pytest.approx(20 * (0.055 - 0.0451), rel=1e-9)  # thread and inertia give theirs back


def test_wiper_by_its_swing():
    s = names("wiper")["s"]
    ends = [np.arccos((0.06**2 + 0.3**2 - (0.3 + way) ** 2) / (2 * 0.06 * 0.3)) for way in (0.04, -0.04)]
    assert s.energy_per_turn == pytest.approx(2 * 3.0 * (ends[0] - ends[1]), rel=1e-12)
    pivot = fixed(0.3, 0.0)
    tail = met(on_crank(0.04), 0.3, pivot, 0.06, 1)
    arm = turned(pivot, tail)
    drag = -3.0 * np.sign(slope(arm, s.crank_angle))
    expected = torque(
        45 * RPM,
        s.crank_angle,
        masses=[(0.8, beside(pivot, tail, 0.06, 0.2))],
        inertias=[(0.03, arm)],
        couples=[(drag, arm)],
    )
    close(s.balancing_torque, expected, 1e-7)


def test_articulated_rod_by_its_pistons():
    s = names("V-twin")["s"]
    crank, first, second = on_crank(0.040), radians(60), radians(120)
    piston = on_line(crank, 0.150, first)
    pin = beside(crank, piston, 0.150, 0.020, 0.030)
    other = on_line(pin, 0.120, second)
    close(s.position("D"), other(s.crank_angle))
    expected = torque(3000 * RPM, s.crank_angle, masses=[(0.5, piston), (0.5, other)])
    close(s.balancing_torque, expected, 1e-7)
    assert np.ptp(ks.extremes(s, lambda motion: motion.travel("slider1")).range) == pytest.approx(0.080, rel=1e-12)


def rod_and_torque(angle, force, way, *, r=0.35, rod=0.9, mu=0.2, pin=0.02 * 0.040):
    """Force along the rod and torque of the drive for a force on a massless crank-slider's plunger, with friction."""
    psi = np.arcsin(-r / rod * np.sin(angle))
    for side in (1.0, -1.0):  # of the guide that carries
        along = -force / (np.cos(psi) - mu * way * side * np.sin(psi))
        if np.all(along * np.sin(psi) * side >= 0):
            break
    return along, along * r * np.sin(psi - angle) + pin * np.abs(along)


@pytest.mark.slow
def test_baler_by_newton():
    found = names("baler")
    s = found["s"]
    way = np.sign(s.slider_velocity)
    hay = np.interp(s.slider_position, [0.5, 0.88, 1.3], [0, 0, -60e3]) * (way > 0)
    force = hay - 150 * s.slider_acceleration
    expected = [rod_and_torque(*row)[1] for row in zip(s.crank_angle, force, way, strict=True)]
    inside = np.abs(np.sin(s.crank_angle)) > 1e-9  # friction jumps at the dead centres
    close(s.balancing_torque[inside], np.array(expected)[inside], 1e-12)
    work = 60e3 * (1.25 - 0.88) ** 2 / 2 / 0.42
    assert s.energy_per_turn - s.losses.total * 2 * pi / (90 * RPM) == pytest.approx(work, rel=1e-9)


@pytest.mark.slow
def test_baler_starts_as_newton_says():
    """Kloss's torque less plunger and friction, integrated; slip s: 2 M_b / (s / s_b + s_b / s)."""
    start = names("baler")["start"]
    gear, synchronous, rated = 1460 / 90, 1500 * RPM, 1460 * RPM
    slip = (synchronous - rated) / synchronous
    breakdown = slip * (2.5 + np.sqrt(2.5**2 - 1))

    def motor(speed):
        here = (synchronous - gear * speed) / synchronous
        return gear * 2 * 2.5 * 22e3 / rated / (here / breakdown + breakdown / here)

    crank = on_crank(0.35)
    plunger = on_line(crank, 0.9, 0.0)

    def rate(_, state, step=1e-5):
        angle, speed = state
        first = slope(plunger, angle)[0]
        second = (slope(plunger, angle + step)[0] - slope(plunger, angle - step)[0]) / (2 * step)

        def left(acceleration):
            force = -150 * (second * speed**2 + first * acceleration)
            return motor(speed) - 400 * acceleration - rod_and_torque(angle, force, np.sign(first * speed) or 1.0)[1]

        low, high = 0.0, 60.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if left(middle) > 0 else (low, middle)
        return speed, low

    found = solve_ivp(rate, (0, start.time[-1]), (radians(200), 0.0), rtol=1e-7, atol=1e-9)
    assert found.y[:, -1] == pytest.approx([start.crank_angle[-1], start.speed[-1]], rel=1e-4)


@pytest.mark.slow
def test_valve_train_by_newton_and_hertz():
    found = names("valve train")
    s, angle = found["s"], found["s"].crank_angle
    up, part = radians(80), np.degrees(angle)
    x = np.select([part < 80, part < 160], [angle / up, (2 * up - angle) / up], 0.0)
    lift = 0.007 * (10 * x**3 - 15 * x**4 + 6 * x**5)
    rate = 0.007 / up * (30 * x**2 - 60 * x**3 + 30 * x**4) * np.where(part < 80, 1, -1)
    bend = 0.007 / up**2 * (60 * x - 180 * x**2 + 120 * x**3)
    speed = 1500 * RPM
    force = 0.150 * bend * speed**2 + 30e3 * (lift + 0.010)
    close(s.scalar("contact_force"), force)
    close(s.balancing_torque, force * rate)
    modulus, radius = 210e9 / (2 * (1 - 0.3**2)), 0.025 + lift + bend
    close(s.contact_pressure, np.sqrt(force * modulus / (pi * 0.012 * radius)))
    made = np.loadtxt("cam.csv", delimiter=",", comments="#", skiprows=5)[:, 2:4].T  # mm, in axes of the crank
    face = np.array([np.sin(angle), np.cos(angle)])  # the tappet goes up, the cam turns below it
    close((face.T @ made).max(axis=1), 1e3 * (0.025 + lift), 1e-5)  # the face touches it
    fine = np.linspace(0, 1, 20001)
    bend = 0.007 / up**2 * (60 * fine - 180 * fine**2 + 120 * fine**3)
    lift = 0.007 * (10 * fine**3 - 15 * fine**4 + 6 * fine**5)
    off = np.sqrt(np.min(30e3 * (lift + 0.010)[bend < 0] / (-0.150 * bend[bend < 0])))
    assert found["contact"].lift_off_speed == pytest.approx(off, rel=1e-6)
    force, radius = 0.150 * bend * speed**2 + 30e3 * (lift + 0.010), 0.025 + lift + bend
    pressure = np.sqrt(force * modulus / (pi * 0.012 * radius)).max()
    assert found["contact"].largest_pressure.value == pytest.approx(pressure, rel=1e-7)


@pytest.mark.slow
def test_jigsaw_by_its_energy():
    found = names("jigsaw")
    s, values = found["s"], found["found"].values
    rate, free, rod = values["spring.stiffness"], values["spring.free_position"], values["coupler_length"]
    harmonics = [values[f"cam.cosine.{n}"] for n in range(5)]

    def carrier(p):
        r = sum(part * np.cos(n * p) for n, part in enumerate(harmonics))
        return r * np.cos(p) + np.sqrt(rod**2 - (r * np.sin(p)) ** 2)

    speed, angle = 2800 * RPM, s.crank_angle
    close(s.slider_position, carrier(angle))
    velocity = speed * slope(carrier, angle)
    energy = 0.5 * 0.25 * velocity**2 + 0.5 * rate * (carrier(angle) - free) ** 2
    assert np.ptp(energy) < 1e-4 * energy.mean()  # it stays in carrier and spring
    assert rate == pytest.approx(0.25 * speed**2, rel=1e-3)  # so the carrier swings by itself
    assert np.ptp(ks.extremes(s, "slider_position").range) == pytest.approx(0.026, rel=1e-6)
    assert np.abs(s.balancing_torque).max() < 1e-3
    case = ks.load_case("jigsaw.toml")
    scene = next(variant.scene for name, variant in case.variants.items() if name != case.reference)
    close(scene.solve(720).slider_position, carrier(angle))


# The same by case file

CLOTH = "travel [mm], force [N], force_back [N]\n24, 0, 0\n45, 0, 0\n45.2, -20, 0\n56, -20, 0\n"
HAY = "travel [mm], force [kN], force_back [kN]\n500, 0, 0\n880, 0, 0\n1300, -60, 0\n"
PUNCH = "travel [mm], force [kN], force_back [kN]\n350, 0, 0\n530, 0, 0\n530.1, -200, 0\n550, -200, 0\n"
CASES = {
    "engine": """
mechanism = "crank-slider"
crank_speed = "-3000 rpm"
crank_length = "45 mm"
coupler_length = "150 mm"
guide_angle = "90 deg"
coupler = { mass = "0.6 kg", centre = "45 mm", inertia = "0.002 kg m^2" }
slider = { mass = "0.5 kg" }
[[common.loads]]
kind = "process force"
force = { file = "diagram.csv", area = "-50 cm^2", period = "720 deg", zero = "TDC", sense = -1 }
""",
    "press": """
mechanism = "crank-slider"
crank_speed = "60 rpm"
crank_length = "100 mm"
coupler_length = "450 mm"
guide_angle = "-90 deg"
loads = [{ kind = "process force", force = { file = "punch.csv" } }]
""",
    "pumpjack": """
mechanism = "four-bar"
crank_speed = "-10 rpm"
crank_length = "950 mm"
coupler_length = "3.1 m"
rocker_length = "2.45 m"
rocker_pivot = ["-2.45 m", "3.1 m"]
assembly = -1
crank = { mass = "4.8 t", centre = "1.2 m", inertia = "1000 kg m^2" }
rocker = { mass = "2.5 t", centre = "-0.3 m", inertia = "8000 kg m^2" }
gravity = {}
loads = [                                           # 55 kN at 2.8 m, and 15 kN against the motion
  { kind = "torque", on = "rocker", value = "154 kN m" },
  { kind = "torque", on = "rocker", value = "42 kN m", opposing = true },
]
""",
    "sewing machine": """
mechanism = "chain"
crank_speed = "4000 rpm"
crank_length = "15 mm"
loads = [
  { kind = "force", at = "E", value = "1.5 N", direction = "-90 deg" },
  { kind = "process force", force = { file = "cloth.csv" } },
]
[[common.groups]]
kind = "slider"
coupler_length = "40 mm"
guide_angle = "-90 deg"
coupler = { mass = "15 g", centre = "20 mm", inertia = "0.03 kg cm^2" }
slider = { mass = "60 g" }
[[common.groups]]
kind = "pin"
on = "crank"
at = ["12 mm", "12 mm"]
name = "C"
[[common.groups]]
kind = "rocker"
on = "C"
pin = "D"
label = "2"
coupler_length = "30 mm"
rocker_length = "32 mm"
pivot = ["-20 mm", "30 mm"]
assembly = -1
[[common.groups]]
kind = "pin"
on = "coupler2"
at = ["50 mm", "-30 mm"]
name = "E"
""",
    "wiper": """
mechanism = "four-bar"
crank_speed = "45 rpm"
crank_length = "40 mm"
coupler_length = "300 mm"
rocker_length = "60 mm"
rocker_pivot = ["300 mm", "0 mm"]
rocker = { mass = "0.8 kg", centre = "200 mm", inertia = "0.03 kg m^2" }
loads = [{ kind = "torque", on = "rocker", value = "3 N m", opposing = true }]
""",
    "V-twin": """
mechanism = "chain"
crank_speed = "3000 rpm"
crank_length = "40 mm"
[[common.groups]]
kind = "slider"
coupler_length = "150 mm"
guide_angle = "60 deg"
pin = "B"
label = "1"
slider = { mass = "500 g" }
[[common.groups]]
kind = "pin"
on = "coupler1"
at = ["20 mm", "30 mm"]
name = "E"
[[common.groups]]
kind = "slider"
coupler_length = "120 mm"
guide_angle = "120 deg"
on = "E"
pin = "D"
label = "2"
slider = { mass = "500 g" }
""",
    "baler": """
mechanism = "crank-slider"
crank_speed = "90 rpm"
crank_length = "350 mm"
coupler_length = "900 mm"
slider = { mass = "150 kg" }
friction = { guide = { mu = 0.2 }, O = { mu = 0.02, radius = "40 mm" } }
loads = [{ kind = "process force", force = { file = "hay.csv" } }]
[common.drive]
flywheel = "400 kg m^2"
[common.drive.motor]
kind = "kloss"
power = "22 kW"
speed = "1460 rpm"
synchronous_speed = "1500 rpm"
overload = 2.5
transmission = 16.222222222222221
""",
    "valve train": """
mechanism = "chain"
crank_speed = "1500 rpm"
loads = [{ kind = "spring", on = "follower", stiffness = "30 N/mm", free_position = "15 mm" }]
[[common.groups]]
kind = "flat follower"
guide_angle = "90 deg"
follower = { mass = "150 g" }
face = { width = "12 mm", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }
cam.kind = "joined"
cam.segments = [
  { kind = "polynomial", start = "25 mm", end = "32 mm", angle = "80 deg" },
  { kind = "polynomial", start = "32 mm", end = "25 mm", angle = "80 deg" },
  { kind = "dwell", position = "25 mm", angle = "200 deg" },
]
""",
}


@pytest.mark.slow
@every("machine", CASES)
def test_case_files_give_the_same(machine, tmp_path):
    found = names(machine)
    diagram = Path("diagram.csv").read_text() if machine == "engine" else ""
    for name, rows in {"cloth": CLOTH, "hay": HAY, "punch": PUNCH, "diagram": diagram}.items():
        (tmp_path / f"{name}.csv").write_text(rows)
    path = tmp_path / "machine.toml"
    path.write_text(f'title = "{machine}"\nreference = "it"\n[variants.it]\n[common]\n{CASES[machine]}')
    variant = ks.load_case(path).variants["it"]
    close(variant.scene.solve(720).balancing_torque, found["s"].balancing_torque)
    if machine == "baler":
        run = ks.drive.steady(variant.scene, variant.motor, flywheel=variant.flywheel)
        assert run.energy_per_turn == pytest.approx(found["run"].energy_per_turn, rel=1e-9)
    if machine == "valve train":
        close(variant.scene.solve(720).contact_pressure, found["s"].contact_pressure)


def test_recipes_are_short():
    for section in text_of(DOCS / TEN).split("\n## ")[1:]:
        code = CELL.findall(section)[0][1]
        assert len([line for line in code.splitlines() if line.strip()]) <= 26
