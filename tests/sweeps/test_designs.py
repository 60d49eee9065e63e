"""Tables of designs: grids and samples, the texts that spread them, and the columns that name their parameters."""

import re

import numpy as np
import pandas as pd
import pytest
from scipy import stats

import kinetostatics as ks
from kinetostatics.casefile import build
from kinetostatics.casefile.schema import variants
from kinetostatics.numbers.formatting import si_columns
from kinetostatics.sweeps import designs
from support.case_files import shipped
from support.every import every
from support.units import UNITS

SPREADS = {
    "spring.stiffness": "normal 700 kN/m +- 5000 N/m",
    "cam.centre.x": "-30..-10 mm",
    "coupler.inertia": "triangular 18..20..26 kg m^2",
}
COLUMNS = ["spring.stiffness [kN/m]", "cam.centre.x [mm]", "coupler.inertia [kg m^2]"]


def test_grid_runs_the_last_parameter_fastest():
    table = designs.grid({"cam.centre.x": "-30..-10 mm:3", "coupler.inertia": "1e1..+3.E1 kg m^2 : 2"})
    assert list(table.columns) == ["cam.centre.x [mm]", "coupler.inertia [kg m^2]"]
    assert table.to_numpy().tolist() == [[x, i] for x in (-30, -20, -10) for i in (10, 30)]
    assert designs.grid({"slider.mass": "5..7 kg:1"}).to_numpy().tolist() == [[5]]


@pytest.mark.parametrize("kind", [designs.latin_hypercube, designs.sobol, designs.random])
def test_samples_are_reproducible(kind):
    table = kind(SPREADS, 512)
    assert list(table.columns) == COLUMNS
    assert table.shape == (512, 3)
    pd.testing.assert_frame_equal(table, kind(SPREADS, 512, seed=0), check_exact=True)
    assert not np.any(table == kind(SPREADS, 512, seed=1))
    wanted = stats.norm(700, 5), stats.uniform(-30, 20), stats.triang(0.25, 18, 8)
    for column, distribution in zip(COLUMNS, wanted, strict=True):
        assert stats.kstest(table[column], distribution.cdf).statistic < 0.08


def test_latin_hypercube_fills_every_interval():
    table = designs.latin_hypercube({"a": "0..10 m", "b": "-10..0 m"}, 10)
    assert sorted(np.floor(table["a [m]"])) == sorted(np.floor(table["b [m]"] + 10)) == list(range(10))


def test_sample_takes_quantiles():
    uniform = [[0.5, 0.0, 0.25], [stats.norm.cdf(1.0), 1.0, 1.0]]
    table = designs.sample(SPREADS, np.array(uniform))
    assert table.to_numpy() == pytest.approx(np.array([[700, -30, 20], [705, -10, 26]]))
    with pytest.raises(ks.ParameterError, match=r"3 parameters need one column each, got \(2, 2\)"):
        designs.sample(SPREADS, np.zeros((2, 2)))


def test_spaces_words_and_signs_are_read():
    texts = ["uniform -3 .. 1e1 1/s", " normal -3 mm ± 10 um ", "normal 3 kg m^2+-1 kg m^2", "triangular 1..1..2 rad"]
    read = designs.distributions({f"p{place}": text for place, text in enumerate(texts)})
    assert [unit for _, unit in read.values()] == ["1/s", "mm", "kg m^2", "rad"]
    assert [found.mean() for found, _ in read.values()] == pytest.approx([3.5, -3, 3, 4 / 3])
    assert read["p1"][0].std() == pytest.approx(0.01)


WRONG_GRID = {
    "form": "600..900 kN/m",
    "no unit": "1..2:3",
    "none": "1..2 m:0",
    "unit": "1..2 furlogs:3",
    "infinite": "1e999..2 m:3",
}
WRONG_SAMPLE = {
    "grid": "1..2 m:3",
    "falling": "2..1 m",
    "likeliest": "triangular 1..3..2 m",
    "deviation": "normal 3 m +- 0 mm",
    "units": "normal 3 m +- 1 kg",
    "no unit": "normal 3 +- 1 m",
    "unit": "0..1 furlogs",
}


def test_all_unreadable_texts_are_listed():
    with pytest.raises(ks.ParameterError) as caught:
        designs.grid(WRONG_GRID | {"right": "1..2 m:3"})
    message = str(caught.value)
    assert all(f"cannot read {text!r} for {name}: " in message for name, text in WRONG_GRID.items())
    assert "right" not in message
    assert message.count('write "600..900 kN/m:40" for a grid') == 1
    assert 'for unit: unit "furlogs" is not known' in message
    with pytest.raises(ks.ParameterError) as caught:
        designs.random(WRONG_SAMPLE | {"right": "1..2 m"}, 3)
    message = str(caught.value)
    assert all(f"cannot read {text!r} for {name}: " in message for name, text in WRONG_SAMPLE.items())
    for reason in ("the values must rise", "deviation must be greater than 0", '"kg" does not measure the same as "m"'):
        assert reason in message


@pytest.mark.parametrize("kind", [designs.grid, lambda spreads: designs.sobol(spreads, 4)])
def test_no_parameters_are_no_designs(kind):
    with pytest.raises(ks.ParameterError, match="there are no parameters"):
        kind({})


@every("kind", ["grid", "sobol", "latin_hypercube", "random", "sample", "distributions"])
def test_spreads_must_be_a_dict(kind):
    more = () if kind in ("grid", "distributions") else (4,)
    for spreads in (None, 5, "slider.mass", [1, 2], np.array([1.0, 2.0]), KG):
        with pytest.raises(ks.ParameterError, match="spreads must be a dict"):
            getattr(designs, kind)(spreads, *more)


KG, M = (UNITS.Quantity([1.0, 2.0], unit) for unit in ("kg", "m"))


@every("name, given, unit", [
    ("crank_length", KG, "m"), ("crank_length", "1..2 kg:2", "m"), ("coupler_length2", KG, "m"),
    ("slider3.mass", M, "kg"), ("slider.mass", "1..2 m:2", "kg"), ("crank_speed", "1..2 Hz:2", "rad/s"),
    ("spring.stiffness", "1..2 N:2", "N/m"), ("torsion_spring.stiffness", "1..2 N/m:2", "N*m/rad"),
    ("lever.inertia", KG, "kg*m**2"),
])  # fmt: skip
def test_known_parameter_needs_its_dimension(name, given, unit):
    with pytest.raises(ks.ParameterError, match=re.escape(f"parameter '{name} [")) as caught:
        designs.grid({name: given})
    assert f'does not measure the same as "{unit}"' in str(caught.value)
    samples = given if not isinstance(given, str) else given.removesuffix(":2")
    with pytest.raises(ks.ParameterError, match="does not measure the same as"):
        designs.sobol({name: samples}, 4)


@every("name", ["mass", "speed", "reach", "my.mass", "crank_length.x", "length"])
def test_names_of_the_users_own_may_have_any_unit(name):
    assert designs.grid({name: "1..2 kN:2"}).columns.tolist() == [f"{name} [kN]"]


# What may be varied


def known(case, variant):
    return ks.load_case(case).variant(variant).units


@pytest.mark.slow
def test_paths_are_the_variants_numbers_with_units():
    paths = known("sawframe_2r63", "cam-circle")
    wanted = {"spring.stiffness": "N/m", "cam.centre.x": "m", "coupler.centre": "m", "gravity.direction": "rad"}
    assert wanted.items() <= paths.items()
    assert "crank_length" not in paths
    assert {"cam.amplitude", "coupler_length"} <= known("sawframe_2r63", "cam-cosine").keys()
    assert "rocker.centre" in known("chain_unit", "rho-0.5")


def test_what_the_file_fixes_otherwise_is_no_path():
    """Two points fix the guide of the mower, a table a process force."""
    table = shipped("mower_drive").variant("unbalanced").table
    assert not {"guide_angle", "guide_offset"} & build.places_by_path(table).keys()
    for force, there in (
        (variants.ProcessForceTable(force="2 N"), True),
        (variants.ProcessForceTable(table="f.csv"), False),
    ):
        assert (
            "process_force.force" in build.places_by_path(table.model_copy(update={"process_force": force}))
        ) is there


def test_columns_are_read_with_units():
    paths = {"slider.mass": "kg", "cam.centre.x": "m"}
    columns, problems = si_columns(["cam.centre.x [mm]", "slider.mass"], paths)
    assert columns == (("cam.centre.x [mm]", "cam.centre.x", 0.001), ("slider.mass", "slider.mass", 1.0))
    assert not problems
    _, problems = si_columns(["slider.mas [kg]", "cam.centre.x [kg]", "slider.mass [x]", "slider.mass"], paths)
    assert "did you mean 'slider.mass'" in problems[0]
    assert '"kg" does not measure the same as "m"' in problems[1]
    assert 'unit "x" is not known' in problems[2]
    assert problems[3] == "parameter 'slider.mass' has two columns"
    columns, problems = si_columns(["ratio [1]", "speed [rpm]", "size [foo]"])
    assert [name for _, name, _ in columns] == ["ratio", "speed", "size"]
    assert columns[1][2] == pytest.approx(np.pi / 30)
    assert len(problems) == 1
