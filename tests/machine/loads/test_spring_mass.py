"""Springs with mass against a heavier slider, beads on a line, waves in closed form, and the figures of the saw."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import surge
from kinetostatics.mechanics.quantities import components
from support import followers
from support.every import every
from support.retold import largest_error
from support.scenes import six_bar

TURN = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
HEAVY = {"crank": ks.Link(2.0, (0.03, 0.01), 0.02), "coupler": ks.Link(1.0, (0.1, 0.01), 0.01)}
pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")


def pump(mass=0.0, slider=4.0, more=(), speed=30.0, acceleration=50.0, **spring):
    machine = ks.crank_slider(
        0.1, 0.35, guide_offset=0.03, guide_angle=0.4, slider=ks.Link(slider, (0.02, 0.03)), **HEAVY
    )
    loads = [ks.Spring(500.0, 0.35, mass=mass, **spring), *more]
    return ks.solve(machine, TURN, crank_speed=speed, crank_acceleration=acceleration, loads=loads)


def saw(case, mass, count=720):
    """The study's machine with its stiffness."""
    scene = case.variants["cam-circle"].scene
    *others, spring = scene.loads
    return replace(scene, loads=(*others, replace(spring, mass=mass))).solve(count)


def read(solution, name):
    return np.array(components(solution, name))


def far(found, expected):
    return np.max(np.abs(found - expected)) / np.max(np.abs(expected))


# The saw of the study


@pytest.fixture(scope="module")
def case():
    return ks.load_case("sawframe_2r63")


@pytest.mark.slow
@every(
    "mass, ratio, cam, frame, feet",
    [
        (0.0, 6.08, 49.9, 252.1, 202.1),
        (100.0, 4.73, 60.9, 268.6, 207.7),
        (300.0, 3.28, 83.0, 301.6, 218.8),
        (600.0, 2.24, 116.0, 351.1, 235.4),
    ],
)
def test_springs_of_the_saw_with_mass(case, mass, ratio, cam, frame, feet):
    """Ratio of mean torques to the plain saw; cam force, force on the frame and on the feet of the springs, kN."""
    plain, s = case.solve("plain"), saw(case, mass, 3600)
    means = [np.mean(np.abs(item.balancing_torque)) for item in (plain, s)]
    assert means[0] / means[1] == pytest.approx(ratio, abs=0.005)
    largest = [ks.extremes(s, name).largest / 1e3 for name in ("cam_force", "shaking_force")]
    found = [*largest, ks.extremes(s, "ground spring").largest / 1e3]
    assert found == pytest.approx([cam, frame, feet], abs=0.06)


@pytest.mark.slow
def test_heavy_springs_load_the_frame_more_than_the_plain_saw(case):
    plain = ks.extremes(case.solve("plain"), "shaking_force").largest
    assert plain == pytest.approx(286.8e3, abs=60.0)
    frame = [ks.extremes(saw(case, mass), "shaking_force").largest for mass in (209.0, 211.0)]
    assert frame[0] < plain < frame[1]


# Laws


@pytest.mark.slow
@every("spring", [{}, {"cubic": 2e4}])
@every("gravity", [0.0, 9.81])
def test_a_third_of_the_mass_moves_with_the_slider(spring, gravity):
    """As a point mass at its pin, whose weight is that of half the spring."""
    weight = ks.Gravity(gravity, -1.2)
    more = [weight, ks.Force(0.5 * gravity, at="B", direction=-1.2)]  # a half of 3 kg less a third
    s, own = pump(3.0, more=[weight], **spring), pump(more=more, **spring)
    joined = own.mechanism.links["slider"].joined(1.0, (0.0, 0.0))
    heavier = replace(own, mechanism=own.mechanism.with_link("slider", joined))
    for name in ("balancing_torque", "balancing_torque_by_power", "guide_force", "guide_moment", "O", "A", "B"):
        assert far(read(s, name), read(heavier, name)) < 1e-13, name
    for name in ("kinetic_energy", "reduced_inertia", "reduced_inertia_slope", "load_torque"):
        assert far(read(s, name), read(heavier, name)) < 1e-13, name
    assert np.max(s.power_residual) < 1e-14


def test_half_of_the_mass_shakes_the_frame():
    s, own = pump(3.0), pump()
    (joined,) = (own.mechanism.links["slider"].joined(1.5, (0.0, 0.0)),)
    heavier = replace(own, mechanism=own.mechanism.with_link("slider", joined))
    assert far(s.shaking_force, heavier.shaking_force) < 1e-14
    assert far(s.shaking_moment, heavier.shaking_moment) < 1e-13
    points = ks.principal_points(s.mechanism, s.loads)
    assert points.mass == 2.0 + 1.0 + 4.0 + 1.5
    assert far(points.shaking_force(s), heavier.shaking_force) < 1e-14
    assert ks.principal_points(s.mechanism).mass == 7.0
    assert ks.principal_points(s.mechanism, s.loads[0]).mass == 8.5
    with pytest.raises(ks.ParameterError, match="principal_points: loads must be loads, as of a scene, got <Solution"):
        ks.principal_points(s.mechanism, s)
    for name in ("slider2", "coupler"):
        with pytest.raises(ks.ParameterError, match=f"principal_points: Spring: on is '{name}', allowed: 'slider'"):
            ks.principal_points(ks.crank_slider(0.1, 0.3), ks.Spring(1e3, 0.2, name, mass=0.1))


@every("gravity", [0.0, 9.81])
def test_the_spring_pushes_as_beads_on_a_line(gravity):
    """Newton's law for each of 1000 beads between springs in a row; the tension's mean is the elastic force."""
    count, mass = 1000, 3.0
    weight = ks.Gravity(gravity, -1.2)
    s = pump(mass, more=[weight])
    spring = s.loads[0]
    u = np.array(s.mechanism.guides["slider"].direction)
    along = float(u @ np.array(weight.vector))
    share = (np.arange(count) + 0.5) / count
    gain = mass / count * (share[:, None] * s.travel_acceleration() - along)  # by which the tension rises past a bead
    tension = np.concatenate([np.zeros((1, TURN.size)), np.cumsum(gain, axis=0)])
    tension += -spring.push(s) - (tension[0] / 2 + tension[1:-1].sum(axis=0) + tension[-1] / 2) / count
    assert far(u @ s.ground["spring"].force, tension[0]) < 1e-6
    on_slider = s.dynamics.spring_loads[0][1].force
    assert far(u @ np.array(np.broadcast_arrays(*on_slider, TURN)[:2]) + spring.push(s), -tension[-1]) < 1e-6


def test_frame_carries_inertia_and_all_weights():
    """Bearing at O, guide and feet together, with gravity at any angle."""
    s = pump(3.0, more=[ks.Gravity(9.81, -0.9)])
    weights = 9.81 * (2.0 + 1.0 + 4.0 + 3.0) * np.array([[np.cos(-0.9)], [np.sin(-0.9)]])
    assert far(s.ground.resultant, s.shaking_force + weights) < 1e-14


def test_masses_of_two_springs_add_up():
    both = pump(1.0, more=[ks.Spring(200.0, 0.3, mass=2.0), ks.Gravity()])
    alone = pump(3.0, more=[ks.Spring(200.0, 0.3), ks.Gravity()])
    for name in ("balancing_torque", "O", "shaking_force", "shaking_moment", "potential_energy"):
        assert far(read(both, name), read(alone, name)) < 1e-13, name


def test_a_spring_on_a_slider_without_mass():
    light, heavy = pump(3.0, slider=0.0), pump(0.0, slider=1.0)
    point = replace(heavy.mechanism.links["slider"], centre=(0.0, 0.0))
    heavy = replace(heavy, mechanism=heavy.mechanism.with_link("slider", point))
    assert far(light.balancing_torque, heavy.balancing_torque) < 1e-13


@pytest.mark.slow
def test_springs_on_other_sliders_and_followers():
    spring = ks.Spring(300.0, 0.4, "slider2", mass=2.0)
    s = ks.solve(six_bar(), TURN, crank_speed=9.0, crank_acceleration=-4.0, loads=[ks.Gravity(), spring])
    still = ks.solve(six_bar(), TURN, crank_speed=9.0, crank_acceleration=-4.0, loads=[ks.Gravity()])
    assert np.max(s.power_residual) < 1e-13
    u = np.array(s.mechanism.guides["slider2"].direction)
    change = -1.0 * s.travel_acceleration("slider2") * u[:, None]
    assert far(s.shaking_force - still.shaking_force, change) < 1e-12
    for kind in ("roller, offset", "flat"):
        scene = followers.scene(followers.KINDS[kind]())
        (on,) = scene.mechanism.guides
        loads = [replace(item, mass=0.7) if isinstance(item, ks.Spring) else item for item in scene.loads]
        s = replace(scene, loads=loads).solve(followers.ANGLES)
        assert np.max(s.power_residual) < 1e-13
        first = s.placement.travels[on].first
        gain = s.reduced_inertia - scene.solve(followers.ANGLES).reduced_inertia
        assert far(gain, 0.7 / 3.0 * first**2) < 1e-9


def test_energy_is_conserved_as_the_machine_coasts():
    scene = ks.Scene.of(pump(3.0, more=[ks.Gravity()], acceleration=0.0))
    run = ks.drive.coast(scene, flywheel=0.05, from_speed=12.0, until=1.0)
    at = ks.solve(scene.mechanism, run.crank_angle, crank_speed=run.speed, loads=scene.loads)
    energy = at.kinetic_energy + 0.5 * 0.05 * run.speed**2 + at.potential_energy
    assert np.ptp(energy) < 1e-8 * np.ptp(at.kinetic_energy)


def assert_engine_knows_the_mass(engine):
    """Values, derivatives, bounds and a batch."""
    s = pump(3.0, more=[ks.Gravity()])
    scene, names = ks.Scene.of(s), ("balancing_torque", "shaking_force", "kinetic_energy", "potential_energy")
    program = ks.compile(scene, names, engine=engine)
    found, slopes = program(TURN), program.derivatives(TURN, "spring.mass")
    above, below = (program(TURN, {"spring.mass": mass}) for mass in (3.5, 2.5))
    for name in names:
        assert far(found[name], read(s, name)) < 1e-13
        assert far(slopes[name]["spring.mass"], above[name] - below[name]) < 1e-12  # all are linear in it
        assert np.all(s.error_bound(name) < 1e-12 * np.max(np.abs(read(s, name))))
    batch = program(TURN, {"spring.mass": np.array([[0.0], [3.0]])})["shaking_force"]
    assert far(batch[:, 1], s.shaking_force) < 1e-13
    assert far(batch[:, 0], pump(more=[ks.Gravity()]).shaking_force) < 1e-13


@pytest.mark.slow
def test_derivatives_and_bounds_know_the_mass():
    assert_engine_knows_the_mass("numpy")


@pytest.mark.slow
def test_the_compiled_engine_knows_the_mass():
    pytest.importorskip("numba")
    assert_engine_knows_the_mass("compiled")


@pytest.mark.slow
def test_its_steps_are_explained():
    machine = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))
    s = ks.solve(machine, 0.7, crank_speed=9.0, loads=[ks.Gravity(), ks.Spring(1e3, 0.2, mass=0.3)])
    for name in (
        "balancing_torque",
        "balancing_torque_by_power",
        "shaking_force",
        "kinetic_energy",
        "potential_energy",
    ):
        told = s.explain(name, 0.7)
        assert "m_spring" in told.text
        assert largest_error(told) < 2e-15
    assert "Inertia and weight of the springs on the slider" in s.explain("balancing_torque_by_power", 0.7).text


def test_independent_methods_refuse_what_they_do_not_know():
    from kinetostatics.studies.methods.structures import require_massless

    with pytest.raises(ks.NotGivenError, match="no independent formula for a spring with mass, got 3"):
        require_massless(pump(3.0).loads[0])


# Waves


def chain(count, stiffness, mass, frequency):
    """Force at the moving end of so many masses in a row, over its amplitude."""
    k, m = stiffness * count, mass / count
    matrix = np.diag(np.full(count - 1, 2.0 * k - m * frequency**2)) - k * (
        np.eye(count - 1, k=1) + np.eye(count - 1, k=-1)
    )
    right = np.zeros(count - 1)
    right[-1] = k
    return k * (1.0 - np.linalg.solve(matrix, right)[-1]) - 0.5 * m * frequency**2


@pytest.mark.slow
@every("ratio", [20.0, 5.0, 2.66, 1.3])
def test_the_stiffness_of_the_end_is_that_of_a_chain_of_masses(ratio):
    stiffness, mass = 700.0, 3.0
    frequency = surge.surge_frequency(stiffness, mass) / ratio
    assert surge.end_stiffness(stiffness, mass, frequency) == pytest.approx(
        chain(200, stiffness, mass, frequency), rel=4e-4
    )


def test_the_third_is_a_tenth_off_at_the_surge_ratio_of_the_sized_springs():
    """Opposed springs of 600 MPa, 2.66 times the crank speed: 10 % of the stiffness that the slider needs."""
    z = np.pi / 2.66
    exact = surge.end_stiffness(1.0, 1.0, z)
    assert (1.0 - z * z / 3.0) / exact - 1.0 == pytest.approx(0.10, abs=0.01)


@every("mass", [1e-9, 30.0, 600.0, 3e4, 1e12])
def test_balanced_slider_meets_the_end_of_its_spring(mass):
    """m3 omega^2 = c z cot z has a root below a quarter wave for every mass."""
    spring = ks.Spring.balancing(600.0, 33.5, 2.0, spring_mass=mass)
    z = 33.5 * np.sqrt(mass / spring.stiffness)
    assert 0.0 < z < np.pi / 2
    assert spring.stiffness * z / np.tan(z) == pytest.approx(600.0 * 33.5**2, rel=1e-9 + 4e-16 * mass)
    assert spring.mass == mass


def test_balanced_springs_of_many_designs():
    masses = np.array([[0.0], [300.0], [600.0]])
    found = ks.Spring.balancing(600.0, 33.5, 2.0, spring_mass=masses).stiffness
    one_by_one = [ks.Spring.balancing(600.0, 33.5, 2.0, spring_mass=float(mass)).stiffness for mass in masses[:, 0]]
    assert found[:, 0] == pytest.approx(one_by_one, rel=1e-14)
    assert one_by_one[0] == 600.0 * 33.5 * 33.5


def hints(mass, length=20.0, speed=10.0, stiffness=400.0, **spring):
    machine = ks.crank_slider(0.1, length, slider=ks.Link(4.0))
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        ks.solve(machine, 0.3, crank_speed=speed, loads=ks.Spring(stiffness, length, mass=mass, **spring))
    return [str(item.message) for item in found if "surge" in str(item.message)]


def test_a_hint_names_the_surge_ratio_below_five():
    """400 N/m on a nearly harmonic slider at 10 rad/s: the ratio is 5 at 400 (pi / 50)^2 = 1.579 kg."""
    assert hints(1.57) == []
    (text,) = hints(1.59)
    assert "its surge ratio is 4.98, below 5. With 1.59 kg it swings between its ends at 49.83 rad/s" in text
    assert "harmonic 1 of the slider, the highest that counts, drives it at 10 rad/s" in text
    assert "by 0.36 %" in text
    assert hints(1.59, speed=-9.0) == hints(0.0) == hints(1.59, speed=0.0) == []


@every(
    "stiffness, mass, speed, words",
    [
        ([0.0, 400.0], [0.0, 1.0], 10.0, None),  # the first has no mass to swing
        ([4.0, 400.0], [1.0, 1.0], [0.1, 10.0], None),  # each at its own speed
        ([4.0, 400.0], [0.1, 1.0], 10.0, "ratio is 1.99, .*With 0.1 kg it swings between its ends at 19.87 rad/s"),
        ([400.0, 400.0], [1.0, 1.0], [10.0, 20.0], "ratio is 3.14, .*drives it at 20 rad/s"),
    ],
)
def test_a_hint_takes_each_design_by_itself(stiffness, mass, speed, words):
    stiffness, mass, speed = (np.array(part)[..., None] if np.ndim(part) else part for part in (stiffness, mass, speed))
    found = hints(mass, speed=speed, stiffness=stiffness)
    assert len(found) == (words is not None)
    assert not words or re.search(words, found[0])


def test_a_short_coupler_drives_the_second_harmonic():
    """An acceleration of r / l at twice the frequency matters from 5 % on."""
    (text,) = hints(0.4, length=0.3)
    assert "harmonic 2" in text
    assert hints(0.4, length=20.0) == []


def test_stiffening_springs_swing_faster():
    assert hints(1.59, cubic=1e4) == []


@pytest.mark.slow
def test_surge_takes_the_mass_of_the_spring():
    s = pump(3.0)
    by_default, given = ks.design.spring_surge(s), ks.design.spring_surge(pump(), 3.0)
    assert by_default.natural_frequency == given.natural_frequency
    assert given.natural_frequency == pytest.approx(np.pi * np.sqrt(500.0 / 3.0), rel=1e-14)
    with pytest.raises(ks.ParameterError, match="spring_mass must be given, kg, since no Spring of the solution has"):
        ks.design.spring_surge(pump())


def test_searches_for_cams_keep_the_mass(case):
    from kinetostatics.design.cam_start import Options, starting_machine

    heavy = ks.Scene.of(saw(case, 300.0, 12))
    (spring,) = (item for item in starting_machine(heavy, Options()).machine.scene.loads if isinstance(item, ks.Spring))
    assert spring.mass == 300.0
    expected = ks.Spring.balancing(600.0, heavy.crank_speed, 2.0, spring_mass=300.0).stiffness
    assert spring.stiffness == pytest.approx(expected, rel=1e-14)


# Case files


SAW = """
title = "saw"
reference = "plain"
[common]
mechanism = "crank-slider"
crank_speed = "320 rpm"
crank_length = "0.3 m"
coupler_length = "2 m"
slider.mass = "600 kg"
spring = {{ stiffness = "balance the slider", free_position = "2 m", mass = "{mass}" }}
[variants.plain]
{more}
"""


def written(tmp_path, mass, more=""):
    path = tmp_path / "saw.toml"
    path.write_text(SAW.format(mass=mass, more=more))
    return ks.load_case(path)


def test_case_files_give_springs_a_mass(tmp_path):
    variant = written(tmp_path, "300 kg").variants["plain"]
    (spring,) = variant.loads
    assert spring.mass == 300.0
    speed = 320 * np.pi / 30
    assert spring.stiffness == ks.Spring.balancing(600.0, speed, 2.0, spring_mass=300.0).stiffness
    heavier = variant.varied({"spring.mass": 500.0}).loads[0]
    assert (heavier.mass, heavier.stiffness > spring.stiffness) == (500.0, True)
    listed = '[[variants.plain.loads]]\nkind = "spring"\nstiffness = "2 kN/m"\nfree_position = "2 m"\nmass = "7 kg"'
    assert written(tmp_path, "0 kg", listed).variants["plain"].loads[1].mass == 7.0


@every("mass, words", [("-1 kg", "spring.mass"), ("3 m", "spring.mass"), ("heavy", "spring.mass")])
def test_case_files_refuse_masses_that_are_none(tmp_path, mass, words):
    with pytest.raises(ks.CaseError, match=words):
        written(tmp_path, mass)


def test_counterweights_of_the_links_alone_are_refused(tmp_path):
    more = '[variants.plain.balancing]\nmethod = "partial"\nratio = 0.5\ncrank = { arm = "-0.3 m" }'
    written(tmp_path, "0 kg", more)
    with pytest.raises(ks.CaseError, match="counterweights for links only, but a spring or shaft has mass"):
        written(tmp_path, "300 kg", more).solve("plain")


def test_designs_vary_the_mass(case):
    frame = ks.sweep(
        case,
        ks.designs.grid({"spring.mass": "0..300 kg:4"}),
        ["largest shaking_force"],
        variant="cam-circle",
        progress=False,
    )
    assert frame["largest shaking_force [N]"].to_numpy()[[0, 1, 3]] == pytest.approx(
        [252.1e3, 268.6e3, 301.6e3], abs=60
    )
