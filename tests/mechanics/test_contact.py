"""Contact of cams, and energies."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.cycle.extremes import extremes_frame
from kinetostatics.mechanics.dynamics import Dynamics
from support.cam_contacts import CAM, LOADS, STEEL, contact, rolled, solved
from support.every import every
from support.machines import ANGLES

COMPLIANCE = 2.0 * (1.0 - 0.3**2) / 210e9
ROLLER = ks.Roller(0.015, 0.02, *STEEL)


def by_radii(force, width, one, other):
    """Largest pressure of two cylinders, by the half width b = sqrt(4 F R / (pi w E*)) and p0 = 2 F / (pi b w)."""
    relative = 1.0 / (1.0 / one + 1.0 / other)
    half = np.sqrt(4.0 * np.abs(force) * relative * COMPLIANCE / (np.pi * width))
    return 2.0 * np.abs(force) / (np.pi * half * width)


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow)])
def test_pressure_is_that_of_the_contact_report(engine):
    """Sides change at 25 rad/s; at 33.5 the ring carries the roller all the way."""
    if engine == "compiled":
        pytest.importorskip("numba")
    for speed in (25.0, 33.5, 60.0):
        found = solved(speed, machine=rolled(), engine=engine)
        assert_allclose(found.contact_pressure, contact(solved(speed)).pressure, rtol=1e-13)
        pitch = CAM.curvature_radius(ANGLES)
        surface = np.where(found.cam_force > 0, -(pitch + 0.05), pitch - 0.05)
        assert_allclose(found.contact_pressure, by_radii(found.cam_force, 0.06, 0.05, surface), rtol=1e-10)


def disk_radius(follower, angle):
    """Radius of a follower's cam under its roller, by differences of the roller centre in the axes of the cam."""
    steps, width = np.array([-2, -1, 1, 2]) * 1e-3, np.array([1, -8, 8, -1]) / 12e-3
    place = [follower.disk.curve(angle + step)[0] for step in steps]
    first = np.tensordot(width, place, 1)
    again = [follower.disk.curve(angle + step)[1] for step in steps]
    second = np.tensordot(width, again, 1)
    return np.abs(first) ** 3 / -(np.conj(first) * second).imag - follower.roller.radius


FOLLOWERS = [
    (
        ks.RollerFollower(ks.laws.cosine(0.01, 0.08), ks.Guide.at(0.3, 0.012), roller=ROLLER),
        ks.Spring(5e4, -0.05, on="follower"),
    ),
    (ks.SwingingFollower(ks.laws.cosine(0.1, 0.5), 0.1, (0.12, 0.03), roller=ROLLER), ks.Torque(60.0, on="arm")),
    (ks.SwingingFollower(ks.laws.cosine(0.1, 0.5), 0.1, (0.12, 0.03), -1, roller=ROLLER), ks.Torque(-60.0, on="arm")),
    (ks.FlatFollower(ks.laws.cosine(0.01, 0.05), face=ks.Face(0.02, *STEEL)), ks.Spring(5e4, -0.05, on="follower")),
]


@every("follower, load", FOLLOWERS)
def test_followers_press_by_roller_and_disk_radii(follower, load):
    scene = ks.Scene(ks.Mechanism("cam drive", ks.Crank(None), (follower,)), 20.0, loads=[load])
    found = scene.solve(90)
    force = found.scalar("contact_force")
    assert force.min() > 100.0
    if isinstance(follower, ks.FlatFollower):
        expected = by_radii(force, 0.02, np.inf, 0.05 + 0 * found.crank_angle)
    else:
        expected = by_radii(force, 0.02, 0.015, disk_radius(follower, found.crank_angle))
    assert_allclose(found.contact_pressure, expected, rtol=1e-9)
    assert ks.check(follower).ok


def held(follower, force):
    """The machine at rest under a force along the guide of the follower."""
    load = ks.Force(force, at="R", direction=follower.guide.guide_angle)
    return ks.solve(ks.Mechanism("cam drive", ks.Crank(None), (follower,)), ANGLES, crank_speed=0.0, loads=[load])


def test_pulled_follower_leans_on_the_outer_flank():
    follower = FOLLOWERS[0][0]
    pressed, pulled = held(follower, -4e3), held(follower, 4e3)
    assert np.all(pressed.scalar("contact_force") > 0)
    flank = -(disk_radius(follower, ANGLES) + 2 * ROLLER.radius)
    assert_allclose(pulled.contact_pressure, by_radii(pulled.scalar("contact_force"), 0.02, 0.015, flank), rtol=1e-9)
    assert np.all(pulled.contact_pressure < pressed.contact_pressure)


def test_pulled_face_has_no_pressure():
    follower = FOLLOWERS[-1][0]
    assert np.isfinite(held(follower, -4e3).contact_pressure).all()
    assert np.isnan(held(follower, 4e3).contact_pressure).all()


def test_derivatives_equal_complete_differences():
    scene = ks.Scene(rolled((0.05, 0.06, 210e9, 0.3, 110e9, 0.25)), 33.5, loads=LOADS)
    program = ks.compile(scene, "contact_pressure", engine="numpy")
    angle = np.array([0.3, 1.9, 4.0])
    slopes = program.derivatives(angle)["contact_pressure"]
    assert {"roller.radius", "roller.cam_youngs_modulus", "cam.amplitude", "spring.stiffness"} <= slopes.keys()
    for path, value in program.parameters.items():
        steps = abs(value) * 1e-4 * np.array([-2, -1, 1, 2])
        beside = [program(angle, {path: value + step})["contact_pressure"] for step in steps]
        difference = np.array([1, -8, 8, -1]) / 12 @ np.array(beside) / (abs(value) * 1e-4)
        assert_allclose(slopes[path], difference, rtol=1e-7, atol=1e-6 * np.abs(beside).max() / abs(value))


def test_undercutting_roller_is_refused():
    loads, kind = LOADS, {"machine": rolled((0.298, 0.06, *STEEL))}
    assert ANGLES.size == solved(33.5, loads, **kind).contact_pressure.size  # the ring carries it, of whatever radius
    with pytest.raises(
        ks.ParameterError, match=r"radius 0\.298 m, undercuts .* bends with a radius of 0\.29\d+ m"
    ) as told:
        solved(25.0, loads, **kind)
    shown = solved(25.0, loads, **kind, on_gap="nan")
    cut = np.isnan(shown.contact_pressure)
    assert f"at {cut.sum()} crank angles" in str(told.value)
    assert np.all(shown.cam_force[cut] < 0)
    assert np.all(CAM.curvature_radius(ANGLES)[cut] <= 0.298)
    assert np.isfinite(shown.balancing_torque).all()
    with pytest.raises(ks.ParameterError, match="undercuts"):
        ks.extremes(solved(25.0, loads, **kind, angles=ANGLES[~cut]), "contact_pressure")


@pytest.mark.slow
def test_sweeps_give_true_pressures_or_undercutting():
    scene = ks.Scene(rolled(), 25.0, loads=LOADS)
    table = ks.sweep(
        scene,
        ks.designs.grid({"roller.radius": "50..298 mm:3"}),
        ["largest contact_pressure", "mean contact_pressure"],
        progress=False,
    )
    true = [
        ks.extremes(scene.varied({"roller.radius": r}).solve(12), "contact_pressure").largest for r in (0.05, 0.174)
    ]
    assert_allclose(table["largest contact_pressure [Pa]"][:2], true, rtol=1e-9)
    assert table["failed"][0] == table["failed"][1] == ""
    assert "undercuts the side of its cam" in table["failed"][2]
    assert np.isnan(table["largest contact_pressure [Pa]"][2])


@pytest.mark.slow
def test_tables_and_frames_have_it_in_pascal():
    found = solved(25.0, machine=rolled())
    row = extremes_frame(found).loc["contact pressure"]
    assert row["unit"] == "Pa"
    assert row["smallest"] == 0.0  # where the roller changes sides
    assert row["largest"] == pytest.approx(contact(solved(25.0)).largest_pressure.value, rel=1e-12)
    assert_allclose(found.frame()["contact_pressure [Pa]"], found.contact_pressure)


def test_enclosures_of_any_precision_hold_it():
    arb = pytest.importorskip("flint").arb
    angle = np.array([arb("0.3")], dtype=object)
    scene = ks.Scene(rolled(), 33.5, loads=LOADS)
    state = Dynamics(scene.mechanism, angle, 33.5, 0.0, scene.loads)
    found = state.pressure("contact_pressure")[0]
    plain = scene.solve(np.array([0.3])).contact_pressure[0]
    assert abs(float(found) / plain - 1.0) < 1e-13


# Reduced inertia and energies

AROUND = np.linspace(0.05, 6.2, 23)
LINKS = {"crank": ks.Link(3.0, (0.1, 0.04), 0.2), "coupler": ks.Link(7.0, (0.4, -0.06), 0.9)}
POTENTIALS = (
    ks.Gravity(9.81, -1.2),
    ks.PointSpring(300.0, 0.2, between=("A", (1.0, 1.5))),
    ks.PointSpring(90.0, between=(("coupler", 0.1, 0.05), (1.0, 1.5))),
)


def slider():
    mechanism = ks.crank_slider(0.3, 1.1, guide_offset=0.05, slider=ks.Link(11.0), **LINKS)
    springs = (ks.Spring(2e3, 1.0), ks.Spring(800.0, 1.2, cubic=3e4))
    return ks.Scene(mechanism, 7.0, 3.0, (*POTENTIALS, *springs))


def bar():
    mechanism = ks.four_bar(0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.4), rocker=ks.Link(5.0, (0.3, 0.08), 0.4), **LINKS)
    turned = ks.TorsionSpring(40.0, 1.5, on="rocker", moment=7.0)
    return ks.Scene(mechanism, -4.0, 3.0, (*POTENTIALS, turned))


def cam():
    cosine = ks.cams.CosineLaw(0.3, 2.0)
    mechanism = ks.cam_crank_slider(cosine, cosine.coupler_length, slider=ks.Link(600.0), block=ks.Link(3.0, 0.0, 0.1))
    return ks.Scene(mechanism, 33.0, -5.0, (ks.Gravity(), ks.Spring(6e5, 2.0)))


@pytest.mark.slow
@every("scene", [slider(), bar(), cam()], ids=["slider", "four-bar", "cam"])
@every("engine", ["numpy", "kernels"])
def test_reduced_inertia_makes_up_the_torque(scene, engine):
    s = scene.solve(AROUND)
    s = s.dynamics if engine == "kernels" else s
    whole = s.reduced_inertia * scene.crank_acceleration
    whole = whole + s.reduced_inertia_slope * scene.crank_speed**2 / 2 + s.load_torque
    assert np.abs(whole - s.balancing_torque).max() < 1e-13 * s.largest_torque_term


@every("scene", [slider(), bar(), cam()], ids=["slider", "four-bar", "cam"])
def test_energies_are_integrals_of_torque_and_slope(scene):
    nodes, weights = np.polynomial.legendre.leggauss(40)
    start, end = 0.3, 1.9
    inside = scene.solve((start + end) / 2 + (end - start) / 2 * nodes)
    ends = scene.solve([start, end])
    for whole, slope in (("potential_energy", "load_torque"), ("reduced_inertia", "reduced_inertia_slope")):
        change = np.diff(getattr(ends, whole))[0]
        assert change == pytest.approx((end - start) / 2 * weights @ getattr(inside, slope), rel=1e-12)


def test_kinetic_energy_is_of_mass_centres_and_rates():
    scene = bar()
    s = scene.solve(AROUND)
    found = sum(
        0.5 * link.mass * np.sum(s.velocity(name) ** 2, axis=0) + 0.5 * link.inertia * s.rate(name) ** 2
        for name, link in scene.mechanism.links.items()
    )
    assert s.kinetic_energy == pytest.approx(found, rel=1e-14)


def test_energies_are_outputs_outside_tables():
    scene = slider()
    assert ks.extremes(scene.solve(3), "kinetic_energy").range[1] > 0.0
    program = ks.compile(scene, "kinetic_energy", engine="numpy")
    found = program.derivatives(0.7, by="crank_speed")["kinetic_energy"]["crank_speed"]
    assert found == pytest.approx(2.0 * program(0.7)["kinetic_energy"] / 7.0, rel=1e-14)
    assert not any("energy" in column or "inertia" in column for column in scene.solve(3).frame().columns)


def test_machine_without_mass_has_no_energy():
    s = ks.solve(ks.crank_slider(0.1, 0.4), AROUND, crank_speed=5.0)
    for name in ("reduced_inertia", "reduced_inertia_slope", "kinetic_energy", "potential_energy", "load_torque"):
        assert np.array_equal(getattr(s, name), np.zeros(AROUND.size)), name


@every("speed", [7.0, -7.0])
def test_energy_per_turn_is_what_the_loads_take(speed):
    mechanism = ks.crank_slider(0.3, 1.1, slider=ks.Link(11.0), **LINKS)
    cut = ks.Table([0.7, 1.0, 1.5], [0.0, -200.0, -400.0], over="travel", back=[0.0, 50.0, 0.0])
    loads = (ks.Gravity(), ks.Spring(2e3, 1.0), ks.ProcessForce(cut), ks.Torque(-3.0, on="crank"))
    s = ks.Scene(mechanism, speed, loads=loads).solve(8)
    # the slider runs from 0.8 to 1.4 m and back, the table holds it both ways
    forward = (0.2 * (200 / 3 + 200) + 0.4 * (200 + 360)) / 2
    back = (0.2 * (50 / 3 + 50) + 0.4 * (50 + 10)) / 2
    work = forward + back + np.sign(speed) * 3.0 * 2.0 * np.pi
    assert s.energy_per_turn == pytest.approx(work, rel=1e-11)
