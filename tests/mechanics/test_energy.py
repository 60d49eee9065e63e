"""Reduced inertia and energies: against the torque, against differences, and where they do not exist."""

import numpy as np
import pytest

import kinetostatics as ks

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


@pytest.mark.parametrize("scene", [slider(), bar(), cam()], ids=["slider", "four-bar", "cam"])
@pytest.mark.parametrize("engine", ["numpy", "kernels"])
def test_reduced_inertia_makes_up_the_torque(scene, engine):
    s = scene.solve(AROUND)
    s = s.dynamics if engine == "kernels" else s
    whole = s.reduced_inertia * scene.crank_acceleration
    whole = whole + s.reduced_inertia_slope * scene.crank_speed**2 / 2 + s.load_torque
    assert np.abs(whole - s.balancing_torque).max() < 1e-13 * s.largest_torque_term


@pytest.mark.parametrize("scene", [slider(), bar(), cam()], ids=["slider", "four-bar", "cam"])
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


@pytest.mark.parametrize("speed", [7.0, -7.0])
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
