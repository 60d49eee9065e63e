"""Tolerances: what spreads of parameters do to outputs, and the shares that each of them has."""

from functools import partial

import numpy as np
import pandas as pd
import pytest
from scipy import stats

import kinetostatics as ks
from support.case_files import written
from support.every import every
from support.units import UNITS

SPREADS = {"mass": "normal 1 kg +- 0.1 kg", "push": "100..300 N"}
OUTPUT = "largest B"
COLUMN = "largest B [N]"
ACCELERATION = 0.1 * (1 + 0.1 / 0.4) * 100.0**2
"""Of the slider at the outer dead centre, m/s2."""
tolerances = partial(ks.tolerances, progress=False, angles=24)


def ram(mass, push=0.0):
    """A slider that is pushed outwards: the largest reaction at its pin is mass times acceleration plus the push."""
    mechanism = ks.crank_slider(0.1, 0.4, slider=ks.Link(mass))
    return ks.Scene(mechanism, 100.0, 0.0, (ks.ProcessForce(push),))


def fragile(mass, push):
    """The same; the push must stay below 290 N."""
    if np.any(push > 290):
        raise ValueError(f"too much: {float(np.max(push)):.0f} N")
    return ram(mass, push)


def test_linear_output_has_the_input_quantiles():
    found = tolerances(ram, [OUTPUT, "ratio largest B"], {"mass": SPREADS["mass"]}, count=4096, reference=ram(1.0))
    quantiles = found.quantiles()
    assert quantiles.index.name == "quantile"
    assert found.outputs == (COLUMN, "ratio largest B [1]")
    expected = ACCELERATION * stats.norm(1.0, 0.1).ppf(quantiles.index)
    assert quantiles[COLUMN].to_numpy() == pytest.approx(expected, abs=0.02 * ACCELERATION * 0.1)
    assert found.quantiles([0.5]).shape == (1, 2)
    assert found.share(OUTPUT, above=ACCELERATION * 1.1) == pytest.approx(stats.norm.sf(1.0), abs=0.003)
    assert found.share(OUTPUT, below=ACCELERATION * 1.1) == pytest.approx(stats.norm.cdf(1.0), abs=0.003)
    assert found.share(OUTPUT, above=ACCELERATION * 0.9, below=ACCELERATION * 1.1) == pytest.approx(0.683, abs=0.005)
    assert found.sensitivity.to_numpy().tolist() == [[1.0, 1.0]] * 2
    assert found.share(OUTPUT, above=UNITS.Quantity(ACCELERATION * 1.1e-3, "kN")) == found.share(
        OUTPUT, above=ACCELERATION * 1.1
    )


def test_sobol_indices_are_variance_shares():
    found = tolerances(ram, [OUTPUT, "mean B"], SPREADS, count=1024)
    assert len(found.table) == 1024
    assert found.sensitivity.index.names == ["output", "parameter"]
    variances = np.array([(ACCELERATION * 0.1) ** 2, 200.0**2 / 12])
    shares = variances / variances.sum()
    indices = found.sensitivity.loc[COLUMN]
    assert indices.index.tolist() == ["mass", "push"]
    assert indices["first order"].to_numpy() == pytest.approx(shares, abs=0.01)
    assert indices["total"].to_numpy() == pytest.approx(shares, abs=0.01)
    assert found.table[COLUMN].var() == pytest.approx(variances.sum(), rel=0.01)


@pytest.mark.slow
def test_the_same_seed_gives_the_same_numbers():
    first, again, other = (tolerances(ram, OUTPUT, SPREADS, count=16, seed=seed) for seed in (3, 3, 4))
    pd.testing.assert_frame_equal(first.table, again.table, check_exact=True)
    pd.testing.assert_frame_equal(first.sensitivity, again.sensitivity, check_exact=True)
    assert not np.any(first.table[COLUMN] == other.table[COLUMN])
    assert not first.sensitivity.equals(other.sensitivity)


@pytest.mark.slow
def test_a_study_goes_on_from_its_folder(tmp_path, monkeypatch):
    """Made of several sweeps, each in a folder of its own."""
    expected = tolerances(ram, OUTPUT, SPREADS, count=16)
    found = tolerances(ram, OUTPUT, SPREADS, count=16, folder=tmp_path)
    pd.testing.assert_frame_equal(found.sensitivity, expected.sensitivity, check_exact=True)
    assert len(list(tmp_path.glob("sweep-*/part-*.parquet"))) == 4
    monkeypatch.setattr("kinetostatics.sweeps.workers.run_chunk", None)
    again = tolerances(ram, OUTPUT, SPREADS, count=16, folder=tmp_path)
    pd.testing.assert_frame_equal(again.sensitivity, expected.sensitivity, check_exact=True)


@every("count", [0, 1, 3, 100, 64.0])
def test_counts_that_are_no_power_of_two_are_refused(count):
    with pytest.raises(ks.ParameterError, match="count must be a power of two"):
        tolerances(ram, OUTPUT, SPREADS, count=count)


@pytest.mark.parametrize(
    ("case", "remedy"),
    [
        (ks.load_case("chain_unit"), '"tolerances" of the case file has none for this variant'),
        (ram, "give spreads, such as"),
        (ks.Scene(ks.crank_slider(0.08, 0.4, slider=ks.Link(25)), 4 * np.pi), "give spreads, such as"),
    ],
)
def test_tolerances_need_spreads(case, remedy):
    with pytest.raises(ks.ParameterError, match="give spreads") as error:
        tolerances(case, OUTPUT)
    assert remedy in str(error.value)


def test_failed_designs_end_the_study():
    with pytest.raises(
        ks.ParameterError, match=r"of 16 designs within the spread cannot be computed.*too much: 29\d N"
    ):
        tolerances(fragile, OUTPUT, SPREADS, count=16)
    with pytest.raises(ks.ParameterError, match="an output is infinite"):
        tolerances(lambda mass, push: ram(0.0 * mass), ["ratio largest B"], SPREADS, count=16, reference=ram(1.0))


def test_failed_single_parameter_designs_end_it():
    """Quantiles of those that are left would be of other machines."""
    with pytest.raises(ks.ParameterError, match=r"1 of 16 designs within the spread cannot be computed.*too much"):
        tolerances(partial(fragile, mass=1.0), OUTPUT, {"push": "100..300 N"}, count=16)
    with pytest.raises(ks.ParameterError, match="8 of 16 designs within the spread cannot be computed"):
        tolerances(ram, OUTPUT, {"mass": "-1..1 kg"}, count=16)


@pytest.mark.slow
def test_workers_give_the_same_study():
    expected = tolerances(ram, OUTPUT, {"mass": SPREADS["mass"]}, count=16)
    found = tolerances(ram, OUTPUT, {"mass": SPREADS["mass"]}, count=16, workers=1)
    pd.testing.assert_frame_equal(found.table, expected.table, check_exact=True)


def test_unreadable_tolerances_are_refused():
    with pytest.raises(ks.ParameterError, match=r"cannot read '1 kg' for mass: .*cannot read 'much' for push"):
        tolerances(ram, OUTPUT, {"mass": "1 kg", "push": "much"}, count=16)
    with pytest.raises(ks.ParameterError, match="did you mean 'largest B'"):
        tolerances(ram, "larges B", SPREADS, count=16)


# Spreads of a case file


def with_spreads(folder, **spreads):
    case = written(folder, "sawframe_2r63", ["plain", "cam-circle"])
    lines = "\n".join(f'"{name}" = "{text}"' for name, text in spreads.items())
    text = case.path.read_text(encoding="utf-8") + f"\n[tolerances]\n{lines}\n"
    case.path.write_text(text, encoding="utf-8")
    return case.path


@pytest.mark.slow
def test_case_spreads_are_the_variants(tmp_path):
    spreads = {"slider.mass": "triangular 588..600..612 kg", "cam.radius": "normal 300 mm +- 0.2 mm"}
    case = ks.load_case(with_spreads(tmp_path, **spreads))
    assert case.tolerances == spreads
    found = tolerances(case, "rms balancing_torque", count=16)
    assert found.sensitivity.index.get_level_values("parameter").tolist() == ["slider.mass", "cam.radius"]
    found = tolerances(case, "rms balancing_torque", count=16, variant="plain")
    assert found.table.columns[0] == "slider.mass [kg]"
    assert found.sensitivity.index.get_level_values("parameter").tolist() == ["slider.mass"]
    found = tolerances(case, "rms balancing_torque", {"crank_speed": "316..324 rpm"}, count=16)
    assert found.spreads == {"crank_speed": "316..324 rpm"}


def test_wrong_spreads_are_reported_with_the_file(tmp_path):
    wrong = {"slider.mas": "1..2 kg", "cam.radius": "3..4 kg", "cam.centre.x": "much", "coupler_length": "1..2 m"}
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(with_spreads(tmp_path, **wrong))
    for problem, text in zip(
        caught.value.problems,
        ("did you mean 'slider.mass'", '"kg" does not measure the same as "m"', "cannot read 'much' for cam.centre.x"),
        strict=True,
    ):
        assert problem.startswith("tolerances: ")
        assert text in problem
    path = with_spreads(tmp_path, **wrong)
    path.write_text(path.read_text(encoding="utf-8").replace('"reference" = "plain"', '"reference" = "plan"'), "utf-8")
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(path)
    assert len(caught.value.problems) == 4


@pytest.mark.slow
def test_shipped_tolerances_are_of_the_circular_cam():
    case = ks.load_case("sawframe_2r63")
    found = tolerances(case, "ratio mean_absolute balancing_torque", count=2)
    assert found.sensitivity.index.get_level_values("parameter").tolist() == list(case.tolerances)
