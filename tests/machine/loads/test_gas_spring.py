"""Gas springs: polytropic law, energy, limits, refusals, and what every engine and case file makes of them."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import components
from support.every import every
from support.retold import largest_error
from support.scenes import six_bar

TURN = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
SEALED = {"area": 2e-3, "volume": 5e-4, "pressure": 4e5, "at": 0.3}
QUANTITIES = ("balancing_torque", "O", "potential_energy")
NUMBERS = ("area", "volume", "pressure", "at", "exponent", "ambient")


def gas(**changes):
    return ks.GasSpring(**SEALED | changes)


def pump(load, angles=TURN, **options):
    links = {"crank": ks.Link(2.0, (0.03, 0.01), 0.02), "coupler": ks.Link(1.0, (0.1, 0.01), 0.01)}
    machine = ks.crank_slider(0.1, 0.35, guide_offset=0.03, guide_angle=0.4, slider=ks.Link(4.0), **links)
    given = {"crank_speed": 30.0, "crank_acceleration": 50.0} | options
    return ks.solve(machine, angles, loads=[load, ks.Gravity()], **given)


def far(found, expected):
    return np.max(np.abs(np.asarray(found) - expected)) / np.max(np.abs(expected))


def room(spring, s):
    return spring.volume + spring.side * spring.area * (s.travel() - spring.at)


# The law of the gas


@every("side", [1, -1])
@every("exponent", [1.0, 1.3, 1.4, 5.0 / 3.0, 3.0])
def test_force_follows_the_polytropic_law(side, exponent):
    spring = gas(side=side, exponent=exponent)
    s = pump(spring)
    pressure = 4e5 * (5e-4 / room(spring, s)) ** exponent
    assert far(spring.pressure_at(s), pressure) < 2e-15
    assert far(spring.push(s), side * (pressure - 101325.0) * 2e-3) < 4e-15
    assert np.max(s.power_residual) < 1e-14


@every("side", [1, -1])
def test_the_gas_pushes_to_its_side_and_yields_from_there(side):
    """Above the ambient pressure; and the less, the farther the slider has gone that way."""
    spring = gas(side=side)
    s = pump(spring)
    assert np.all(side * spring.push(s) > 0.0)
    order = np.argsort(side * s.travel())
    assert np.all(np.diff(side * spring.push(s)[order]) < 0.0)


@every("side", [1, -1])
@every("exponent", [1.3, 1.4, 3.0])
@every("ambient", [0.0, 101325.0])
def test_energy_is_that_of_the_closed_formula(side, exponent, ambient):
    spring = gas(side=side, exponent=exponent, ambient=ambient)
    s = pump(spring)
    volume, excess = room(spring, s), exponent - 1.0
    energy = 4e5 * 5e-4 / excess * ((5e-4 / volume) ** excess - 1.0) + ambient * (volume - 5e-4)
    weightless = replace(s, loads=(spring,))
    assert far(weightless.potential_energy, energy) < 1e-14


def test_energy_at_constant_temperature_is_no_limit():
    """A logarithm at n = 1 exactly, and smooth about it."""
    energies = {
        n: replace(pump(gas(exponent=n)), loads=(gas(exponent=n),)).potential_energy for n in (1.0, 1.0 + 1e-12)
    }
    volume = room(gas(), pump(gas()))
    closed = 4e5 * 5e-4 * np.log(5e-4 / volume) + 101325.0 * (volume - 5e-4)
    assert far(energies[1.0], closed) < 1e-14
    assert far(energies[1.0 + 1e-12], closed) < 1e-11


@every("compression", [0.2, 0.6, 1.0, 30.0, 1e4])
@every("exponent", [1.0, 1.3, 5.0 / 3.0, 3.0])
def test_energy_is_exact_for_strong_compression(compression, exponent):
    """At a volume V0 / compression, against the closed formula in 40 digits."""
    mp = pytest.importorskip("mpmath")
    here = float(pump(gas(), [0.3]).travel()[0])
    spring = gas(at=here - 5e-4 * (1.0 / compression - 1.0) / 2e-3, exponent=exponent, ambient=0.0)
    s = pump(spring, [0.3])
    volume = float(room(spring, s)[0])
    with mp.workdps(40):
        excess, ratio = mp.mpf(exponent) - 1, mp.mpf(5e-4) / mp.mpf(volume)
        closed = mp.log(ratio) if excess == 0 else (ratio**excess - 1) / excess
        closed = float(200.0 * closed)
    found = float(replace(s, loads=(spring,)).potential_energy[0])
    assert found == pytest.approx(closed, rel=1e-12, abs=1e-12)


def test_force_is_the_slope_of_its_energy():
    spring = gas(side=-1)
    program = ks.compile(ks.Scene.of(pump(spring)), ("potential_energy",), engine="numpy")
    slope = program.derivatives(TURN, "gas_spring.at")["potential_energy"]["gas_spring.at"]
    assert far(slope, spring.push(pump(spring))) < 1e-13  # moving `at` ahead moves the slider back


def test_energy_is_conserved_as_the_machine_coasts():
    scene = replace(ks.Scene.of(pump(gas(side=-1))), crank_acceleration=0.0)
    run = ks.drive.coast(scene, flywheel=0.5, from_speed=40.0, until=1.0)
    at = ks.solve(scene.mechanism, run.crank_angle, crank_speed=run.speed, loads=scene.loads)
    energy = at.kinetic_energy + 0.5 * 0.5 * run.speed**2 + at.potential_energy
    assert np.ptp(energy) < 1e-8 * np.ptp(at.potential_energy)


def test_a_soft_gas_spring_is_a_linear_spring():
    """Rate n p0 A^2 / V0 where the volume hardly changes."""
    spring = gas(volume=5.0, at=0.35, pressure=4e5)
    linear = ks.Spring(1.3 * 4e5 * 2e-3**2 / 5.0, 0.35)
    found = spring.push(pump(spring)) - (4e5 - 101325.0) * 2e-3
    assert far(found, linear.push(pump(linear))) < 1e-3


@every("law", ["units", "mirror"])
def test_scaled_lengths_scale_forces(law):
    """Twice the lengths at the same pressures and four times the forces; and the other side of a turned guide."""
    spring = gas()
    s = pump(spring)
    if law == "units":
        machine = ks.crank_slider(0.2, 0.7, guide_offset=0.06, guide_angle=0.4)
        larger = gas(area=8e-3, volume=4e-3, at=0.6)
        found = larger.push(ks.solve(machine, TURN, crank_speed=1.0, loads=larger))
        assert far(found, 4.0 * spring.push(s)) < 1e-14
    else:
        machine = ks.crank_slider(0.1, 0.35, guide_offset=-0.03, guide_angle=0.4 + np.pi, assembly=-1)
        other = gas(at=-0.3, side=-1)
        found = other.push(ks.solve(machine, TURN, crank_speed=1.0, loads=other))
        assert far(found, -spring.push(s)) < 1e-13


# Engines, derivatives, certainty


@pytest.mark.slow
def test_the_compiled_engine_agrees():
    pytest.importorskip("numba")
    s = pump(gas())
    compiled = pump(gas(), engine="compiled")
    for name in QUANTITIES:
        one, other = (np.array(components(item, name)) for item in (s, compiled))
        assert far(other, one) < 1e-14


@pytest.mark.slow
def test_jax_agrees():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        found = pump(gas(), jax.numpy.asarray(TURN))
        assert far(np.asarray(found.balancing_torque), pump(gas()).balancing_torque) < 1e-13


def test_derivatives_by_every_number_equal_differences():
    program = ks.compile(ks.Scene.of(pump(gas(side=-1))), QUANTITIES, engine="numpy")
    paths = [f"gas_spring.{name}" for name in NUMBERS]
    exact = program.derivatives(TURN, paths)
    for path in paths:
        value = program.parameters[path]
        above, below = (program(TURN, {path: value * (1.0 + sign * 1e-5)}) for sign in (1, -1))
        for name in QUANTITIES:
            slope = (above[name] - below[name]) / (2e-5 * value)
            assert far(exact[name][path], slope) < 1e-6, (path, name)


def test_a_batch_of_designs_is_each_of_them():
    volumes = np.array([[4e-4], [5e-4], [9e-4]])
    together = pump(gas(volume=volumes))
    assert together.balancing_torque.shape == (3, TURN.size)
    for row, volume in zip(together.potential_energy, volumes[:, 0], strict=True):
        assert far(row, pump(gas(volume=float(volume))).potential_energy) < 1e-14


@every("tight", [False, True])
def test_bounds_hold(tight):
    pytest.importorskip("flint")
    from kinetostatics.studies.methods.high_precision.enclosures import enclosure

    s = pump(gas(side=-1), TURN[::4])
    for name in ("balancing_torque", "potential_energy"):
        bound, (exact,) = s.error_bound(name, tight=tight), enclosure(s, name).exact
        for value, most, truth in zip(
            s.scalar(name) if name in s.scalars else getattr(s, name), bound, exact, strict=True
        ):
            assert abs(truth - float(value)) <= most < 1e-12 * np.max(np.abs(getattr(s, name)))


@every("quantity", ["balancing_torque", "potential_energy"])
def test_the_hand_calculation_shows_the_gas(quantity):
    told = pump(gas(), [0.7]).explain(quantity, 0.7)
    assert largest_error(told) < 2e-15
    if quantity == "balancing_torque":
        units = {step.words: step.unit for step in told.steps}
        assert units["volume of the gas"] == "m3"
        assert units["logarithm of the compression V0/V"] == "1"
        assert units["absolute pressure of the gas"] == "Pa"


@pytest.mark.slow
def test_kanes_equations_agree():
    pytest.importorskip("sympy")
    from kinetostatics.studies.methods.kane.equations import evaluation

    s = pump(gas(), TURN[::8])
    run = evaluation(s, ("balancing_torque",))
    assert far(run()[0], s.balancing_torque) < 1e-12


# Refusals and hints

BAD = {
    "area": ({"area": 0.0}, "area must be greater than 0, got 0.0"),
    "volume": ({"volume": -1e-3}, "volume must be greater than 0"),
    "pressure": ({"pressure": 0}, "pressure must be greater than 0"),
    "no pressure": ({"pressure": "high"}, "pressure must be a number"),
    "exponent below": ({"exponent": 0.9}, "exponent must be at least 1, got 0.9"),
    "exponent above": ({"exponent": 3.1}, "exponent must be at most 3, got 3.1"),
    "exponents": ({"exponent": np.array([[1.3], [7.0]])}, "exponent must be at most 3"),
    "ambient": ({"ambient": -1.0}, "ambient must be at least 0"),
    "side": ({"side": 0}, r"side must be \+1 or -1, got 0"),
    "side as a word": ({"side": "left"}, r"side must be \+1 or -1, got 'left'"),
    "nan": ({"at": float("nan")}, "at must be finite"),
    "slider": ({"on": 3}, "on must be"),
}


@every("what", BAD)
def test_what_is_no_gas_spring_is_refused(what):
    changes, words = BAD[what]
    with pytest.raises(ks.ParameterError, match=f"gas spring: {words}"):
        gas(**changes)


def test_a_slider_that_is_not_there_is_named():
    with pytest.raises(ks.ParameterError, match="GasSpring: on is 'slider', allowed: 'slider2'"):
        ks.solve(six_bar(), TURN, crank_speed=1.0, loads=gas())


def test_no_volume_is_refused_with_crank_angles():
    words = (
        r"GasSpring on 'slider': no volume is left at \d+ crank angles, the first .* deg. Its 5e-05 m3 at 0.3 m end "
    )
    words += r"at 0.325 m, but the slider goes on by up to 0.123\d* m. Give more volume"
    with pytest.raises(ks.ParameterError, match=words):
        pump(gas(volume=5e-5, side=-1))
    program = ks.compile(ks.Scene.of(pump(gas(side=-1))), ("balancing_torque",), engine="numpy")
    with pytest.raises(ks.ParameterError, match="no volume is left"):
        program(TURN, {"gas_spring.volume": 5e-5})
    designs = np.array([[5e-4], [5e-5], [4e-5]])
    with pytest.raises(ks.ParameterError) as one:
        pump(gas(volume=4e-5, side=-1))
    with pytest.raises(ks.ParameterError) as several:
        pump(gas(volume=designs, side=-1))
    counted = re.compile(r"no volume is left at \d+ crank angles, the first .* deg")  # of both designs together
    assert counted.findall(str(several.value)) == counted.findall(str(one.value)) != []


@every(
    "changes, words",
    [
        ({}, []),
        ({"pressure": 8e4}, ["its pressure of 80000 Pa is absolute and below the ambient 101325 Pa, so the gas pulls"]),
        ({"pressure": 4.0}, ["gas_spring.pressure is 4 Pa; is it in bar? That makes 400000 Pa"]),
        ({"pressure": 4e4, "ambient": 0.0}, []),
        ({"pressure": 4e5, "ambient": 1.0}, ["gas_spring.ambient is 1 Pa; is it in bar?"]),
        (
            {"area": 2000.0, "volume": 500.0},
            ["is it in mm2? That makes 0.002 m2", "is it in litres? That makes 0.5 m3"],
        ),
    ],
)
def test_hints_at_gauge_pressures_and_units(changes, words):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        pump(gas(**changes), [0.3])
    texts = [str(item.message) for item in found if issubclass(item.category, ks.HintWarning)]
    assert len(texts) == len(words)
    assert all(word in text for word, text in zip(words, texts, strict=True))


# Case files and drawings


CASE = """
title = "press"
reference = "sealed"
[common]
mechanism = "crank-slider"
crank_speed = "300 rpm"
crank_length = "0.1 m"
coupler_length = "0.35 m"
slider.mass = "4 kg"
[[common.loads]]
kind = "gas spring"
area = "20 cm^2"
volume = "0.5 l"
pressure = "4 bar"
at = "300 mm"
{more}
[variants.sealed]
"""


def written(tmp_path, more=""):
    path = tmp_path / "press.toml"
    path.write_text(CASE.format(more=more))
    return ks.load_case(path)


def test_case_files_hold_gas_springs(tmp_path):
    (spring,) = written(tmp_path).variants["sealed"].loads
    assert vars(spring) == vars(gas()) | {name: pytest.approx(SEALED[name], rel=1e-15) for name in SEALED}
    (spring,) = (
        written(tmp_path, 'side = -1\nexponent = 1.4\nambient = "1 bar"\non = "slider"').variants["sealed"].loads
    )
    assert (spring.side, spring.exponent, spring.ambient) == (-1, 1.4, 1e5)


@every(
    "more, words",
    [
        ("side = 2", "side must be 1 or -1"),
        ("exponent = 0.5", "exponent"),
        ("exponent = 4", "exponent must be at most 3"),
        ('ambient = "1 m"', "ambient"),
        ('on = "slyder"', "did you mean 'slider'"),
        ('mass = "3 kg"', "mass"),
    ],
)
def test_case_files_name_what_is_wrong_with_a_gas_spring(tmp_path, more, words):
    with pytest.raises(ks.CaseError, match=words):
        written(tmp_path, more)


def test_designs_vary_the_gas(tmp_path):
    case = written(tmp_path)
    grid = ks.designs.grid({"gas_spring.volume": "0.5..1 l:2"})
    swept = ks.sweep(case, grid, ["largest balancing_torque"], progress=False)
    single = [
        ks.extremes(case.variants["sealed"].varied({"gas_spring.volume": volume}).scene.solve(360), "balancing_torque")
        for volume in (5e-4, 1e-3)
    ]
    assert swept["largest balancing_torque [N m]"].to_numpy() == pytest.approx(
        [one.range[1] for one in single], rel=1e-5
    )


@pytest.mark.slow
def test_searches_stay_where_the_gas_has_room():
    """The best volume of those that a search may try, some of them used up in the turn."""
    scene = ks.Scene(ks.crank_slider(0.1, 0.35, slider=ks.Link(4.0)), 30.0, loads=gas(at=0.35, side=-1))
    vary = {"gas_spring.volume": (1e-4, 2e-3), "gas_spring.pressure": (2e5, 2e6)}
    found = ks.design.optimise(scene, vary, minimise="mean_absolute balancing_torque")
    before, after = (np.mean(np.abs(item.solve(720).balancing_torque)) for item in (scene, found.scene))
    assert found.values["gas_spring.volume"] > 2e-4
    assert after < 0.4 * before


@every("side", [1, -1])
def test_a_gas_spring_is_drawn_where_its_gas_is(side):
    from kinetostatics.views.strokes import load_strokes

    s = pump(gas(side=side))
    strokes = load_strokes(replace(s, loads=(gas(side=side),)), np.array([30.0]))
    assert {stroke.kind for stroke in strokes} == {"damper"}
    along = np.array(s.mechanism.guides["slider"].direction)
    reach = [along @ stroke.points[..., 0] for stroke in strokes]
    place = float(along @ pump(gas(), [np.radians(30.0)]).position("B")[:, 0])
    assert side * (place - np.nanmean(np.concatenate(reach))) > 0.0
