"""Resolution of load functions without declared kinks: what it finds, where it is stated, and what it misses."""

import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cycle.extremes import extremes_frame
from support.every import quick

STEP = 0.05
"""Default resolution, degrees."""
SWEEP = 1e-8
"""Error of sweeps, relative to the largest value."""
NOISE = np.random.default_rng(1).normal(size=3600)
PUMP = ks.crank_slider(0.3, 1.1, slider=ks.Link(10.0))


def pulse(middle, width, force=-1e6):
    """A rectangle over the crank angle, degrees, a force on the slider."""

    def function(q):
        angle = np.degrees(np.mod(q.crank_angle, 2.0 * np.pi))
        return np.where(abs(angle - middle) < 0.5 * width, force, 0.0)

    return function


def declared(function, jumps):
    """The same function with its jumps, rad."""

    def known(q):
        return function(q)

    known.kinks = lambda motion: (np.empty(0), jumps)
    return known


def ends(middle, width):
    """Crank angles of the ends of a pulse, rad."""
    return np.radians([middle - 0.5 * width, middle + 0.5 * width])


def scene(function, **more):
    return ks.Scene(PUMP, 30.0, loads=ks.ProcessForce(function), **more)


def sweep(source, output):
    """Table of two designs, the scene itself and one with a slightly heavier slider."""
    mass = source.parameters["slider.mass"]
    return ks.sweep(source, pd.DataFrame({"slider.mass": [mass, 1.01 * mass]}), [output], progress=False)


def swept(source, output):
    """Output of the scene itself, by a sweep."""
    return sweep(source, output).iloc[0, 1]


@pytest.fixture(autouse=True)
def _no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error", ks.HintWarning)
        yield


@pytest.mark.slow
@pytest.mark.parametrize("seed", quick([0, 3, 2, 4], 2))
def test_pulses_wider_than_the_resolution_are_found_everywhere(seed):
    rng = np.random.default_rng(seed)
    middle, width = rng.uniform(10.0, 350.0), STEP * rng.uniform(1.001, 1.2) if seed < 3 else rng.uniform(0.2, 20.0)
    plain = scene(pulse(middle, width))
    known = scene(declared(pulse(middle, width), ends(middle, width)))
    low, high = ends(middle, width)
    largest = np.abs(plain.solve(np.linspace(low + 1e-10, high - 1e-10, 20001)).balancing_torque).max()
    for item in (plain, known):
        assert abs(ks.extremes(item.solve(1), "balancing_torque").largest) == pytest.approx(largest, rel=1e-7)
    found = abs(ks.extremes(known.solve(1), "balancing_torque").largest)
    assert abs(ks.extremes(plain.solve(1), "balancing_torque").largest) == pytest.approx(found, rel=1e-9)
    assert swept(plain, "largest_absolute balancing_torque") == pytest.approx(found, rel=SWEEP)
    energy = ks.drive.flywheel(known, 0.02).energy
    assert ks.drive.flywheel(plain, 0.02).energy == pytest.approx(energy, rel=1e-9)
    assert len(plain.check_resolution(np.radians(0.01))) == 0


@pytest.mark.slow
@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_jumps_with_the_sense_of_the_stroke_are_found_by_sweeps(offset):
    machine = ks.crank_slider(0.3, 1.1, slider=ks.Link(0.2), guide_offset=offset)

    def opposing(q):
        return -50.0 * np.sign(q.slider_velocity) + 3.0 * np.cos(q.crank_angle)

    radius, rod = 0.3, 1.1  # the crank lies along the rod at the dead centres
    outer, inner = np.arcsin(offset / (rod + radius)), np.pi + np.arcsin(offset / (rod - radius))
    for name in ("B", "O", "balancing_torque"):
        sides = np.ravel(np.add.outer([outer, inner], [-1e-9, 1e-9]))
        found = [
            ks.Scene(machine, 10.0, loads=ks.ProcessForce(force))
            for force in (opposing, declared(opposing, np.array([outer, inner])))
        ]
        exact = np.abs(ks.extremes(found[1].solve(1), name).value).max()
        beside = found[0].solve(np.concatenate([sides, np.linspace(0.0, 2.0 * np.pi, 7200)]))
        values = beside.balancing_torque if name == "balancing_torque" else np.hypot(*beside.reaction(name))
        assert np.abs(values).max() == pytest.approx(exact, rel=1e-6)
        for one in found:
            assert swept(one, f"largest_absolute {name}") == pytest.approx(exact, rel=SWEEP)
        assert np.abs(ks.extremes(found[0].solve(1), name).value).max() == pytest.approx(exact, rel=1e-9)


NARROW = scene(pulse(100.512, 0.02))
"""A pulse between two samples, and between those midway."""
MIDWAY = scene(pulse(100.525, 0.02))
"""A pulse midway between two samples."""


@pytest.mark.slow
def test_resolution_is_stated_wherever_such_a_function_acts():
    sentence = "every 0.05 deg of the crank; narrower features may be missed"
    solution = NARROW.solve(1)
    found = ks.extremes(solution, "balancing_torque")
    assert found.range[1] == pytest.approx(523.8, abs=0.1)  # the pulse is missed
    assert sentence in found.note
    assert found.note in repr(found)
    assert sentence in ks.extremes(solution, lambda at: at.balancing_torque).note
    assert ks.extremes(solution, "slider_velocity").note == ""
    assert sentence in extremes_frame(solution).attrs["resolution"]
    assert sentence in sweep(NARROW, "largest O").attrs["resolution"]
    assert sentence in ks.compare(scene(0.0).solve(1), solution).frame().attrs["resolution"]
    assert sentence in ks.drive.flywheel(NARROW, 0.02).note
    running = ks.drive.steady(NARROW, ks.drive.Motor.linear(500.0, 35.0), flywheel=20.0)
    assert sentence in repr(running)
    assert sentence in repr(solution.losses)
    assert sentence in solution.losses.frame().attrs["resolution"]
    cam = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.02, slider=ks.Link(600.0))
    driven = ks.Scene(cam, 10.0, loads=NARROW.loads).solve(4)
    assert sentence in repr(ks.design.contact(driven, 0.05, 0.04, 210e9, 0.3))
    assert sentence in repr(ks.drive.coast(NARROW, flywheel=5.0, from_speed=30.0, until=0.05))


@pytest.mark.parametrize(
    "load",
    [declared(pulse(100.512, 0.02), ends(100.512, 0.02)), ks.Table([0.0, 2.0, 2.0 * np.pi], [0.0, -5.0, 0.0]), -20.0],
)
def test_nothing_is_stated_of_known_loads(load):
    known = scene(load)
    found = ks.extremes(known.solve(1), "balancing_torque")
    assert found.note == ""
    assert "sampled" not in repr(found)
    assert "resolution" not in sweep(known, "largest O").attrs
    assert ks.drive.flywheel(known, 0.02).note == ""
    assert len(known.check_resolution(np.radians(0.01))) == 0


def test_reports_of_searches_state_the_resolution_and_warn():
    smooth = scene(lambda q: -50.0 * np.cos(q.crank_angle))
    found = ks.design.optimise(smooth, {"slider.mass": (9.0, 11.0)}, minimise="largest O", angles=90)
    assert "every 0.05 deg" in found.report().attrs["resolution"]
    found = replace(found, scene=MIDWAY)
    with pytest.warns(ks.HintWarning, match="at 100.525 deg"):
        found.report()


@pytest.mark.slow
def test_finer_look_warns_with_crank_angle_and_remedy():
    text = r"-1e\+06 N at 100.525 deg; declare its `kinks`, give a ks.Table, or a finer `resolution`"
    for act in (
        lambda: ks.extremes(MIDWAY.solve(1), "O"),
        lambda: swept(MIDWAY, "largest O"),
        lambda: ks.drive.flywheel(MIDWAY, 0.02),
        lambda: ks.drive.coast(MIDWAY, flywheel=5.0, from_speed=30.0, until=0.05),
    ):
        with pytest.warns(ks.HintWarning, match=text):
            act()
    solution = MIDWAY.solve(1)
    with pytest.warns(ks.HintWarning, match=text):
        ks.extremes(solution, "O")
    ks.extremes(solution, "balancing_torque")  # once for a solution


@pytest.mark.parametrize(
    "function",
    [
        lambda q: 2.0,
        lambda q: np.sin(40.0 * q.crank_angle),
        lambda q: -3e5 * np.exp(-(((np.degrees(np.mod(q.crank_angle, 2.0 * np.pi)) - 70.0) / 0.2) ** 2)),
        lambda q: -50.0 * np.sign(q.slider_velocity),
        lambda q: -50.0 * np.maximum(q.slider_velocity, 0.0),
        lambda q: np.interp(q.crank_angle, np.arange(3600) * np.pi / 1800, NOISE, period=2.0 * np.pi),
        pulse(30.0, 0.2),
    ],
)
def test_nothing_is_missed_of_what_the_samples_show(function):
    ks.extremes(scene(function).solve(1), "O")
    found = scene(function).check_resolution(np.radians(0.005))
    assert len(found) == 0
    assert repr(found) == "<ResolutionCheck every 0.005 deg: no features narrower than 0.05 deg>"


@pytest.mark.parametrize("force", [pytest.param(-1e6, marks=pytest.mark.slow), 2e3])
def test_check_finds_what_is_narrower(force):
    middles = 40.012, 100.513, 222.02

    def combs(q):
        return 100.0 * np.sin(q.crank_angle) + sum(pulse(middle, 0.02, force)(q) for middle in middles)

    (found,) = scene(combs).check_resolution(np.radians(0.005)).missed
    assert (found.load, found.unit) == ("ProcessForce on 'slider'", "N")
    np.testing.assert_allclose(np.degrees(found.angle), middles, atol=0.0125)
    np.testing.assert_allclose(found.size, force, rtol=1e-6)
    fine = scene(combs, resolution=np.radians(0.01))
    assert len(fine.check_resolution(np.radians(0.005))) == 0
    known = scene(declared(combs, np.concatenate([ends(middle, 0.02) for middle in middles])))
    exact = ks.extremes(known.solve(1), "B").range[1]
    assert ks.extremes(fine.solve(1), "B").range[1] == pytest.approx(exact, rel=1e-9)
    assert swept(fine, "largest B") == pytest.approx(exact, rel=SWEEP)
    energy = ks.drive.flywheel(known, 0.02).energy
    assert ks.drive.flywheel(fine, 0.02).energy == pytest.approx(energy, rel=1e-9)


def test_check_looks_at_every_design():
    middle = np.array([[40.012], [100.513]])
    machine = ks.crank_slider(0.3, 1.1, slider=ks.Link(np.array([[10.0], [11.0]])))
    (found,) = (
        ks.Scene(machine, 30.0, loads=ks.ProcessForce(pulse(middle, 0.02))).check_resolution(np.radians(0.005)).missed
    )
    np.testing.assert_allclose(np.degrees(found.angle), middle.ravel(), atol=0.0125)


def test_scene_and_solutions_carry_the_resolution():
    fine = scene(lambda q: 1.0, resolution=1e-4)
    solution = ks.solve(PUMP, 0.0, crank_speed=30.0, loads=fine.loads, resolution=1e-4)
    for item in (solution, solution.at(1.0), ks.Scene.of(solution), fine.varied({"slider.mass": 2.0}), fine.solve(3)):
        assert item.resolution == 1e-4
    assert "resolution" not in fine.parameters
    assert fine.solve(3).kind is scene(fine.loads[0].value_now).solve(3).kind  # the same compiled programs


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.05, r"between 1e-05 and 0.004363 rad \(0.25 deg\), got 0.05 rad \(2.865 deg\); for degrees give np.radians"),
        (0.0, "got 0 rad"),
        (1e-6, "got 1e-06 rad"),
        (np.inf, "must be finite"),
        ("0.05 deg", "must be a number"),
        ([1e-4, 1e-3], "must be one number"),
        (None, "must be a number"),
    ],
)
def test_impossible_resolutions_are_refused(value, text):
    with pytest.raises(ks.ParameterError, match=text):
        ks.Scene(PUMP, 30.0, resolution=value)
    with pytest.raises(ks.ParameterError, match=text):
        ks.solve(PUMP, 0.0, crank_speed=30.0, resolution=value)


def test_check_refuses_a_coarser_step():
    assert NARROW.check_resolution().step == NARROW.resolution
    with pytest.raises(ks.ParameterError, match=r"step must lie between 1e-05 and 0.0008727 rad \(0.05 deg\), got 0.1"):
        NARROW.check_resolution(0.1)


def test_check_refuses_functions_that_are_not_pure():
    numbers = iter(range(10**6))
    with pytest.raises(ks.ParameterError, match="must be pure"):
        scene(lambda q: float(next(numbers))).check_resolution()
