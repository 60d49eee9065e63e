"""Sweeps: reductions, rows of cases and functions, designs that fail, workers that die, folders that resume."""

import io
import logging
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.engines import compiled
from kinetostatics.mechanics import quantities
from kinetostatics.numbers.units import base_factor
from kinetostatics.results.reductions import REDUCTIONS, parsed
from kinetostatics.sweeps import chunks, dataset, sweeps, together
from kinetostatics.sweeps import workers as dispatch
from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support.case_files import written
from support.factories import DESIGNS, OUTPUTS

SAW = ks.load_case("sawframe_2r63")
sweep = partial(ks.sweep, progress=False)


def assert_equal(found, expected):
    pd.testing.assert_frame_equal(found, expected, check_exact=True)


# Reductions


def wave(order=3):
    """Values of two designs at 48 crank angles, and a function of them at any."""
    amplitude = np.array([[2.0], [5.0]])

    def at(angle):
        return amplitude * np.cos(order * angle - 1.0) + np.sin(angle) - amplitude

    turn = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    return at(turn), at


def test_reductions_are_what_plain_numpy_says():
    values, _ = wave()
    expected = {
        "mean": values.sum(axis=1) / 48,
        "rms": np.sqrt((values**2).sum(axis=1) / 48),
        "harmonic_0": np.abs(values.sum(axis=1)) / 48,
        "harmonic_1": [1.0, 1.0],
        "harmonic_2": [0.0, 0.0],
        "harmonic_3": [2.0, 5.0],
        "harmonic_7": 2 * np.abs(np.fft.rfft(values)[:, 7]) / 48,
    }
    for name, wanted in expected.items():
        assert parsed(f"{name} O").reduced(values) == pytest.approx(np.array(wanted), abs=1e-14), name


def test_extremes_are_found_between_the_samples():
    values, at = wave(order=2)
    fine = np.linspace(0, 2 * np.pi, 200_001)
    many = at(fine)
    found = {name: REDUCTIONS[name](values) for name in REDUCTIONS}
    assert found["largest"] == pytest.approx(many.max(axis=1), abs=1e-6)
    assert found["smallest"] == pytest.approx(many.min(axis=1), abs=1e-6)
    assert found["range"] == pytest.approx(np.ptp(many, axis=1), abs=1e-6)
    assert found["largest_absolute"] == pytest.approx(np.abs(many).max(axis=1), abs=1e-6)
    assert found["mean_absolute"] == pytest.approx(np.abs(many[:, :-1]).mean(axis=1), rel=2e-4)
    assert found["largest_at"] == pytest.approx(fine[many.argmax(axis=1)], abs=1e-4)
    assert found["smallest_at"] == pytest.approx(fine[many.argmin(axis=1)], abs=1e-4)


@pytest.mark.parametrize(("case", "name"), [("sawframe_2r63", "cam-circle"), ("chain_unit", "rho-0.5")])
def test_extremes_are_those_of_the_mechanism_to_a_millionth(case, name):
    s = ks.load_case(case).solve(name, 360)
    for quantity in (*s.reactions, "balancing_torque", "shaking_force"):
        low, high = ks.extremes(s, quantity).range
        samples = quantities.values(s, quantity)[None]
        size = max(abs(low), abs(high))
        assert REDUCTIONS["largest"](samples)[0] == pytest.approx(high, abs=1e-6 * size), quantity
        assert REDUCTIONS["smallest"](samples)[0] == pytest.approx(low, abs=1e-6 * size), quantity


TURN = np.linspace(0, 2 * np.pi, 360, endpoint=False)
JUMPS = {
    "step": (np.where(TURN < 1, 0.0, 10.0), 10.0),
    "step up, then falling": (np.where(TURN < 1, -5.0, 10 - 0.1 * TURN), 10 - 0.1 * TURN[58]),
    "step beside a smooth peak": (np.where(TURN > 0.56, 0.0, 10 + np.sin(3 * TURN)), 11.0),
    "constant": (np.full(360, 7357.5), 7357.5),
    "corner": (-np.abs(np.sin(TURN - 0.3)), 0.0),
}


@pytest.mark.parametrize("name", JUMPS)
def test_nothing_is_made_up_beside_jumps_and_corners(name):
    """To half of the digits: a corner at zero is found from squares."""
    values, highest = JUMPS[name]
    found = [sign * REDUCTIONS[kind](sign * values[None])[0] for sign, kind in ((1, "largest"), (-1, "smallest"))]
    assert found == pytest.approx([highest, highest], abs=np.sqrt(np.finfo(float).eps))


@pytest.mark.parametrize("count", [1, 2, 8, 9])
def test_extremes_of_few_samples_are_at_least_the_largest(count):
    values = np.cos(2 * np.pi * np.arange(count) / count + 0.1)[None]
    assert values.max() <= REDUCTIONS["largest"](values)[0] <= 1.0 + 1e-12


def test_what_is_no_number_stays_none():
    values = np.vstack([TURN, np.where(np.arange(360) == 9, np.nan, TURN)])
    for name in (*REDUCTIONS, "harmonic_2"):
        assert np.isnan(parsed(f"{name} O").reduced(values)).tolist() == [False, True], name


def test_outputs_are_read_with_any_name_of_a_quantity():
    output = parsed("  ratio  mean_absolute   pan moment ")
    assert (output.ratio, output.reduction, output.quantity) == (True, "mean_absolute", "pan moment")
    assert str(output) == "ratio mean_absolute pan moment"
    assert parsed(output) is output
    assert parsed("largest_at balancing_torque").column == "largest_at balancing_torque [rad]"
    assert parsed("ratio rms O").column == "ratio rms O [1]"
    for text in ("largest", "larges O", "harmonic_x O", "ratio", "", "O largest"):
        with pytest.raises(ks.ParameterError, match=r"must be a reduction and a quantity.*harmonic_1"):
            parsed(text)
    with pytest.raises(ks.ParameterError, match="did you mean 'largest'"):
        parsed("larges O")


# Rows of a case


ROWS = [
    ("sawframe_2r63", "plain", "cam-circle", "spring.stiffness", "kN/m", [600.0, 700.0]),
    ("sawframe_2r63", "plain", "cam-circle", "cam.centre.x", "mm", [-30.0, -15.0]),
    ("sawframe_2r63", "plain", "cam-circle", "cam.radius", "m", [0.29, 0.31]),
    ("sawframe_2r63", "plain", "cam-circle", "slider.mass", "t", [0.5, 0.7]),
    ("sawframe_2r63", "plain", "cam-circle", "coupler_length", "m", [1.8, 2.2]),
    ("sawframe_2r63", "plain", "cam-circle", "crank_speed", "rpm", [100.0, 400.0]),
    ("sawframe_2r63", "plain", "cam-cosine", "cam.mean", "m", [1.5, 2.5]),
    ("sawframe_2r63", "plain", "plain", "guide_offset", "mm", [-20.0, 0.0]),
    ("chain_unit", "rho-0.1", "rho-0.5", "crank_length", "mm", [100.0, 160.0]),
    ("mower_drive", "unbalanced", "partial-3", "balancing.crank.arm", "mm", [-30.0, -50.0]),
]


@pytest.mark.parametrize(("case", "reference", "name", "path", "unit", "values"), ROWS)
def test_rows_equal_case_files_with_these_values(tmp_path, case, reference, name, path, unit, values):
    """What the file derives from them follows: centres, springs that balance the slider, the cosine law's coupler."""
    outputs = ["mean_absolute balancing_torque", "rms O", "ratio rms shaking_force"]
    chosen = written(tmp_path, case, [reference, name])
    table = sweep(chosen, pd.DataFrame({f"{path} [{unit}]": values}), outputs, variant=name, angles=360)
    assert table[FAILED].tolist() == ["", ""]
    expected = []
    for value in values:
        single = written(tmp_path, case, [reference, name], path, f"{value!r} {unit}").solve(name, 360)
        base = chosen.variant(reference)
        if path in base.units:
            base = base.varied({path: value * base_factor(unit)})
        force, torque = (np.hypot(*s.shaking_force) for s in (single, base.solve(360))), single.balancing_torque
        own, compared = (np.sqrt((size**2).mean()) for size in force)
        reaction = np.sqrt((single.reaction("O") ** 2).sum(axis=0).mean())
        expected.append([REDUCTIONS["mean_absolute"](torque[None])[0], reaction, compared / own])
    assert table.iloc[:, 1:4].to_numpy() == pytest.approx(np.array(expected), rel=1e-12)


def test_ratios_are_dynamic_coefficients_to_sampling_error():
    """Of 360 angles the mean of an absolute value, which has corners, is right to some 1e-5."""
    found = sweep(SAW, pd.DataFrame(index=[0]), ["ratio mean_absolute balancing_torque"], variant="cam-cosine")
    exact = SAW.compare("plain", "cam-cosine").mean_torque_ratio
    assert found.iloc[0, 0] == pytest.approx(exact, rel=2e-4)
    found = sweep(SAW, pd.DataFrame(index=[0]), ["ratio largest O"], variant="cam-cosine")
    assert found.iloc[0, 0] == pytest.approx(SAW.compare("plain", "cam-cosine").peak_reaction_ratio("O"), rel=1e-6)


def test_the_table_keeps_the_designs_and_names_units():
    designs = pd.DataFrame({"slider.mass [t]": [0.5, 0.6], "crank_speed": [30, 33]}, index=["light", "heavy"])
    found = sweep(SAW, designs, ["largest O", "smallest_at balancing_torque", "range slider_velocity"], variant="plain")
    assert found.index.tolist() == ["light", "heavy"]
    assert found.columns.tolist() == [
        "slider.mass [t]",
        "crank_speed",
        "largest O [N]",
        "smallest_at balancing_torque [rad]",
        "range slider_velocity [m/s]",
        "failed",
    ]
    assert_equal(found[designs.columns], designs)


def test_variants_are_the_first_beside_the_reference_and_the_reference_unless_told():
    designs = ks.designs.grid({"slider.mass": "600..600 kg:1"})
    ratio = "ratio mean_absolute balancing_torque"
    assert_equal(sweep(SAW, designs, ratio), sweep(SAW, designs, ratio, variant="cam-circle", reference="plain"))
    assert sweep(SAW, designs, ratio, variant="plain").iloc[0, 1] == 1.0
    with pytest.raises(ks.CaseError, match="did you mean 'cam-circle'"):
        sweep(SAW, designs, ratio, variant="cam-circl")


def test_counterweights_follow_each_design():
    """Balanced one design at a time; full balancing leaves nothing, whatever the masses."""
    designs = ks.designs.grid({"slider.mass": "4..6 kg:3"})
    found = sweep(
        ks.load_case("mower_drive"), designs, ["largest shaking_force", "ratio rms shaking_force"], variant="full"
    )
    assert found[FAILED].tolist() == [""] * 3
    assert found.iloc[:, 1].max() < 1e-9
    assert np.isinf(found.iloc[:, 2]).all()


# What is asked for wrongly


def test_all_that_is_wrong_is_told_at_once():
    designs = pd.DataFrame({"slider.mas [kg]": [1.0], "cam.radius [kg]": [1.0], "cam.centre.x [mm]": ["a"]})
    with pytest.raises(ks.ParameterError) as caught:
        sweep(SAW, designs, ["larges O", "harmonic_180 O"], angles=360, chunk=0, engine="fortran")
    for text in (
        "did you mean 'slider.mass'",
        '"kg" does not measure the same as "m"',
        "column 'cam.centre.x [mm]' must hold numbers",
        "did you mean 'largest'",
        "output 'harmonic_180 O' takes more than 360 crank angles, got 360",
        "chunk must be a whole number of at least 1, got 0",
        "engine is 'fortran', allowed: 'compiled', 'numpy'",
    ):
        assert text in str(caught.value)


WRONG = {
    "a list": (factories.pump, [0.1, 0.2], OUTPUTS, {}, "designs must be a pandas DataFrame, .* got list"),
    "a client": (factories.pump, DESIGNS, OUTPUTS, {"executor": 2}, r"client.get_executor\(\)\), got int"),
    "no designs": (factories.pump, DESIGNS[:0], OUTPUTS, {}, "there are no designs"),
    "no outputs": (factories.pump, DESIGNS, [], {}, "no outputs are asked for"),
    "half an angle": (factories.pump, DESIGNS, OUTPUTS, {"angles": 1.5}, "angles must be a whole number"),
    "no reference": (factories.pump, DESIGNS, ["ratio rms O"], {}, "ratios need a reference: a Scene"),
    "other parameters": (factories.pump, DESIGNS.assign(arm=1), OUTPUTS, {}, "unexpected keyword argument 'arm'"),
    "missing parameters": (factories.pump, DESIGNS[["mass"]], OUTPUTS, {}, "missing a required argument: 'crank'"),
    "unknown unit": (
        factories.pump,
        DESIGNS.rename(columns={"mass": "mass [x]"}),
        OUTPUTS,
        {},
        'unit "x" is not known',
    ),
    "no variant": (
        lambda crank, mass: 3,
        DESIGNS,
        OUTPUTS,
        {},
        "must return a kinetostatics.Scene, got 3",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_done_is_refused(name):
    source, designs, outputs, options, message = WRONG[name]
    with pytest.raises(ks.ParameterError, match=message):
        sweep(source, designs, outputs, **options)


@pytest.mark.parametrize("name", ["rms O [N]", "failed"])
def test_a_column_of_the_designs_named_like_an_output_is_refused(name):
    designs = DESIGNS[["mass"]].assign(**{name: 1.0})
    with pytest.raises(ks.ParameterError, match="of the designs has the name of an output") as caught:
        sweep(factories.pump, designs, ["rms O"])
    assert repr(name) in str(caught.value)


def test_unknown_quantities_of_design_and_reference_are_refused(tmp_path):
    for outputs, message in ((["rms cam_forc"], "cam_force"), (["ratio rms cam_force"], "crank-slider: quantity")):
        with pytest.raises(ks.QuantityError, match=message):
            sweep(
                SAW, ks.designs.grid({"slider.mass": "6..7 kg:2"}), outputs, variant="cam-circle", folder=tmp_path / "a"
            )
    assert not (tmp_path / "a").exists()


# Engines


def rising(count=200):
    """Designs of the sawframe of which every tenth cannot be."""
    designs = ks.designs.latin_hypercube({"coupler_length": "0.5..2.5 m", "slider.mass": "100..900 kg"}, count)
    designs.loc[::10, "slider.mass [kg]"] *= -1
    return designs


def test_engines_and_threads_give_the_same_table(interpreted, monkeypatch):
    options: dict = {"outputs": [*OUTPUTS, "ratio range balancing_torque"], "variant": "cam-circle", "angles": 12}
    expected = sweep(SAW, rising(30), engine="numpy", **options)
    found = sweep(SAW, rising(30), engine="compiled", **options)
    pd.testing.assert_frame_equal(found, expected, rtol=1e-13)
    monkeypatch.setattr(compiled, "cores", lambda: 2)
    monkeypatch.setattr(together, "VALUES", 50)
    assert_equal(sweep(SAW, rising(30), engine="compiled", **options), found)


def test_tables_beforehand_are_cut_into_blocks_like_designs(interpreted, monkeypatch):
    """What NumPy computes beforehand has its rows for each design too."""
    monkeypatch.setattr(together, "VALUES", 50)

    def made(crank, mass):
        push = ks.ProcessForce(lambda motion: np.where(motion.slider_velocity > 0, -50.0, 20.0))
        return ks.Scene(factories.pump(crank, mass).mechanism, 100.0, 0.0, (push,))

    pd.testing.assert_frame_equal(
        sweep(made, DESIGNS, OUTPUTS, angles=12, engine="compiled"),
        sweep(made, DESIGNS, OUTPUTS, angles=12, engine="numpy"),
        rtol=1e-13,
    )


def engines_taken(monkeypatch):
    taken = []
    monkeypatch.setattr(sweeps, "tried", lambda *call: taken.append(call[2]))
    return taken


def test_many_crank_angles_are_compiled_unless_told(monkeypatch):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    taken = engines_taken(monkeypatch)
    monkeypatch.setattr(sweeps, "WORTH_COMPILING", 41 * 12)
    for options in ({}, {"engine": "numpy"}, {"angles": 11}):
        sweep(factories.pump, DESIGNS, OUTPUTS, **{"angles": 12} | options)
    monkeypatch.setattr(compiled, "available", lambda: False)
    sweep(factories.pump, DESIGNS, OUTPUTS, angles=12)
    assert taken == [["compiled", "numpy"], ["numpy"], ["numpy"], ["numpy"]]
    with pytest.raises(ks.errors.MissingLibraryError, match="kinetostatics\\[fast\\]"):
        sweep(factories.pump, DESIGNS, OUTPUTS, engine="compiled")


@dataclass(frozen=True)
class OneSided(ks.SliderGroup):
    """A group that looks at values."""

    def resolve(self, placement, loads, along):
        """The same on either side."""
        found = super().resolve(placement, loads, along)
        return found if placement.joints["A"].position[0].sum() > 0 else found._replace(scalars=dict(found.scalars))


def test_what_cannot_be_compiled_is_left_to_numpy_unless_told(interpreted, monkeypatch):
    mechanism = ks.Mechanism("one-sided", ks.Crank(0.1), (OneSided(0.4, slider=ks.Link(1.0)),))
    made = lambda: ks.Scene(mechanism, 10.0)  # noqa: E731
    designs = pd.DataFrame(index=range(2))
    with pytest.raises(ks.errors.NotGivenError, match=r'must not branch on values.*use engine="numpy"'):
        sweep(made, designs, ["rms O"], engine="compiled")
    monkeypatch.setattr(sweeps, "WORTH_COMPILING", 1)
    assert sweep(made, designs, ["rms O"])[FAILED].tolist() == ["", ""]


# Designs that fail


def test_failing_rows_keep_their_reasons_and_others_their_numbers():
    designs = pd.DataFrame(
        {
            "coupler_length [m]": [2.0, -1.0, 0.25, 2.0, 2.0, 2.0, 0.31],
            "slider.mass [kg]": [600.0, 600.0, 600.0, -5.0, np.nan, 600.0, 600.0],
            "crank_speed": [33.0, 33.0, 33.0, 33.0, 33.0, np.nan, 33.0],
        }
    )
    found = sweep(SAW, designs, OUTPUTS, variant="plain", angles=36)
    assert found[FAILED].tolist() == [
        "",
        "slider group: coupler length must be greater than 0, got -1.0",
        "crank-slider cannot be assembled at 14 of 36 crank angles; change the lengths",
        "Link: mass must be at least 0, got -5.0",
        "Link: mass must be finite, got nan",
        "scene: crank_speed must be finite, got nan",
        "",
    ]
    assert np.isnan(found.iloc[:, 3:5]).all(axis=1).tolist() == [False, True, True, True, True, True, False]
    good = sweep(SAW, designs.iloc[[0, 6]], OUTPUTS, variant="plain", angles=36)
    assert_equal(found.iloc[[0, 6]], good)


def test_reasons_of_cams_tell_the_numbers_of_their_row():
    designs = pd.DataFrame({"cam.mean [m]": [2.0, 0.2, 0.1], "cam.amplitude [m]": [0.3, 0.3, 0.15]})
    found = sweep(SAW, designs, OUTPUTS, variant="cam-cosine", angles=36)[FAILED].tolist()
    assert found[0] == ""
    assert "got mean 0.2 m and amplitude 0.3 m" in found[1]
    assert "got mean 0.1 m and amplitude 0.15 m" in found[2]
    found = sweep(SAW, pd.DataFrame({"cam.centre.x": [0.0, 0.4]}), OUTPUTS, variant="cam-circle", angles=36)[FAILED]
    assert found[0] == ""
    assert "its centre is 0.4 m from O and its radius 0.3 m" in found[1]


def test_a_failing_reference_is_told_apart():
    reference = ks.Scene(ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0)), 1.0, 0.0, ())
    found = sweep(factories.pump, DESIGNS[:2].assign(mass=[-1, 1]), ["rms O", "ratio rms O"], reference=reference)
    assert found[FAILED][0] == "Link: mass must be at least 0, got -1.0"
    assert found[FAILED][1].startswith("reference: crank-slider cannot be assembled at 134 of 360")
    assert found.iloc[:, 2:4].isna().all(axis=None)


def test_a_ratio_of_nothing_to_nothing_is_told():
    found = sweep(factories.pump, DESIGNS[:2].assign(mass=[0, 1]), ["ratio rms B"], reference=factories.pump(0.1, 0.0))
    assert found[FAILED].tolist() == ["ratio rms B is no number, such as 0 / 0", ""]
    assert found.iloc[1, 2] == 0.0


def test_errors_of_a_function_stay_with_their_rows():
    designs = DESIGNS.assign(mass=DESIGNS["mass"].to_numpy()[::-1])
    found = sweep(factories.picky, designs, OUTPUTS, angles=36)
    wrong = (designs["crank [mm]"] < 300) & (designs["mass"] > 5)
    assert (found[FAILED] != "").tolist() == wrong.tolist()
    assert found[FAILED][3] == "a crank of 0.13 m does not carry 8.4 kg"
    assert_equal(found[~wrong], sweep(factories.pump, designs[~wrong], OUTPUTS, angles=36))


def test_a_function_of_plain_numbers_is_called_for_each_design():
    found = sweep(factories.by_plain_numbers, DESIGNS, OUTPUTS, angles=36)
    pd.testing.assert_frame_equal(found, sweep(factories.pump, DESIGNS, OUTPUTS, angles=36), rtol=1e-14)


def test_a_batch_of_another_shape_is_refused():
    made = lambda crank, mass: factories.pump(np.full((3, 1), 0.1), 1.0)  # noqa: E731
    found = sweep(made, DESIGNS[:2], OUTPUTS, angles=36)
    assert found[FAILED].str.contains("arrays must have the shape (designs, 1)", regex=False).all()


def test_when_all_designs_fail_all_say_why():
    found = sweep(factories.pump, DESIGNS.assign(mass=-1.0), OUTPUTS, angles=36)
    assert found[FAILED].eq("Link: mass must be at least 0, got -1.0").all()
    assert found.iloc[:, 2:4].isna().all(axis=None)


def test_the_hundredth_design_impossible_among_many():
    designs = ks.designs.random({"coupler_length": "1.8..2.2 m", "slider.mass": "500..700 kg"}, 5000)
    designs.loc[::100, "slider.mass [kg]"] = -1.0
    designs.loc[1::100, "coupler_length [m]"] = 0.2
    found = sweep(SAW, designs, OUTPUTS, variant="plain", angles=12)
    assert found[FAILED].ne("").sum() == 100
    assert found.loc[::100, FAILED].str.startswith("Link: mass").all()
    assert found.loc[1::100, FAILED].str.startswith("crank-slider cannot be assembled").all()


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
def test_it_does_not_matter_which_designs_come_together(interpreted, engine):
    outputs = ["harmonic_2 O", "mean O", "rms O", "largest_at O", "smallest balancing_torque"]
    options = {"variant": "cam-circle", "angles": 12, "engine": engine}
    found = [sweep(SAW, rising(60), outputs, chunk=chunk, **options) for chunk in (1, 7, 10_000)]
    assert_equal(found[0], found[2])
    assert_equal(found[1], found[2])


# Executors


@pytest.fixture(scope="module")
def expected():
    """What a sweep of pumps gives here."""
    return sweep(factories.pump, DESIGNS, OUTPUTS)


@pytest.fixture(scope="module")
def cluster():
    """Executor of two Dask workers, each a process, which gives a task up after one death."""
    distributed = pytest.importorskip("distributed", reason="dask is not installed (extra: distributed)")
    dask = pytest.importorskip("dask")
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=logging.CRITICAL
        ) as local,
        distributed.Client(local) as client,
    ):
        yield client.get_executor()


@pytest.fixture
def tidy():
    """No process is left behind."""
    before = set(multiprocessing.active_children())
    yield
    assert set(multiprocessing.active_children()) <= before


@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_local_executors_give_the_same_table(expected, kind):
    with kind(2) as executor:
        assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor, chunk=7), expected)
        assert_equal(sweep(SAW, rising(20), OUTPUTS, executor=executor, chunk=7), sweep(SAW, rising(20), OUTPUTS))


def test_dask_gives_the_same_table(cluster, expected):
    assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, executor=cluster, chunk=7), expected)
    made = lambda crank, mass: factories.pump(crank, mass)  # noqa: E731
    assert_equal(sweep(made, DESIGNS, OUTPUTS, executor=cluster, chunk=7), expected)


def test_each_worker_computes_on_one_core(monkeypatch):
    taken = []
    monkeypatch.setattr(compiled, "cores", lambda: 5)
    monkeypatch.setattr(sweeps, "computed", lambda job, *rest: taken.append(job.threads) or (_ for _ in ()))
    with ThreadPoolExecutor(2) as executor, pytest.raises(KeyError):
        sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor)
    with pytest.raises(KeyError):
        sweep(factories.pump, DESIGNS, OUTPUTS)
    assert taken == [1, 5]


def test_a_function_that_cannot_travel_is_refused():
    with (
        ProcessPoolExecutor(1) as executor,
        pytest.raises(ks.ParameterError, match="define the function at the top of a module"),
    ):
        sweep(lambda crank, mass: factories.pump(crank, mass), DESIGNS, OUTPUTS, executor=executor)


def test_workers_give_the_same_table_of_any_function(tidy, expected):
    made = lambda crank, mass: factories.pump(crank, mass)  # noqa: E731
    assert_equal(sweep(made, DESIGNS, OUTPUTS, workers=2, chunk=7), expected)


def test_a_worker_that_dies_costs_nothing(tidy, tmp_path, expected):
    marker = tmp_path / "died"
    function = factories.deadly_once(0.3, marker)
    assert_equal(sweep(function, DESIGNS, OUTPUTS, workers=2, chunk=7), expected)
    assert marker.exists()


def test_a_worker_of_dask_that_dies_costs_nothing(cluster, tmp_path, expected):
    marker = tmp_path / "died"
    assert_equal(
        sweep(factories.deadly_once(0.3, marker), DESIGNS, OUTPUTS, executor=cluster, chunk=7, folder=tmp_path / "out"),
        expected,
    )
    assert marker.exists()


def test_cases_go_to_workers(tidy):
    assert_equal(sweep(SAW, rising(20), OUTPUTS, workers=1, chunk=7), sweep(SAW, rising(20), OUTPUTS))


def assert_only_one_lost(found, expected, row):
    assert found[FAILED][row] == "the worker died with this design"
    assert found.loc[row].iloc[2:4].isna().all()
    assert_equal(found.drop(row), expected.drop(row))


@pytest.fixture
def impatient(monkeypatch):
    """Chunks are run once before the designs that kill their worker are looked for: each death costs a second."""
    monkeypatch.setattr(dispatch, "ATTEMPTS", 1)


@pytest.mark.parametrize("row", [19, 21])
def test_only_a_design_that_kills_its_worker_is_given_up(tidy, impatient, expected, row):
    """Also if it is the first, on which the sweep is tried."""
    function = factories.deadly(DESIGNS["crank [mm]"][row] * 0.001)
    found = sweep(function, DESIGNS[19:23], OUTPUTS, workers=1, chunk=2)
    assert_only_one_lost(found, expected[19:23], row)


def test_only_a_design_that_kills_its_worker_is_given_up_by_dask(cluster, expected):
    found = sweep(factories.deadly(0.3), DESIGNS[18:22], OUTPUTS, executor=cluster, chunk=2)
    assert_only_one_lost(found, expected[18:22], 20)


def test_workers_that_die_of_themselves_end_the_sweep(tidy, impatient):
    with pytest.raises(ks.KinetostaticsError, match="die before they compute anything"):
        sweep(factories.Poison(), DESIGNS, OUTPUTS, workers=1, chunk=50)


@pytest.mark.parametrize("death", ["when it starts", "when it computes"])
def test_an_executor_that_breaks_ends_the_sweep_and_names_workers(tidy, death):
    """Whoever made it may make it anew; nobody else does."""
    broken = (
        ThreadPoolExecutor(1, initializer=factories.pump)
        if death == "when it starts"
        else ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("fork"))
    )
    with broken as executor, pytest.raises(ks.KinetostaticsError, match=r"the executor broke.*give workers=n"):
        sweep(factories.deadly(0.3), DESIGNS, OUTPUTS, executor=executor, chunk=7)


def test_only_public_names_of_executors_are_used():
    """Any executor will do: this one has nothing but what the standard promises."""

    class Bare(Executor):
        def submit(self, function, /, *arguments, **options):
            made: Future = Future()
            made.set_result(function(*arguments, **options))
            return made

    assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, executor=Bare()), sweep(factories.pump, DESIGNS, OUTPUTS))


COUNTS = [0, -1, True, 2.0, "2", int, 10**6, float("nan"), [2]]


@pytest.mark.parametrize("count", COUNTS)
def test_a_number_of_workers_that_cannot_be_is_refused(count):
    with pytest.raises(ks.ParameterError, match="workers must be a whole number of processes from 1 to"):
        sweep(factories.pump, DESIGNS, OUTPUTS, workers=count)


def test_workers_and_an_executor_together_are_refused():
    with ThreadPoolExecutor(1) as executor, pytest.raises(ks.ParameterError, match="workers or an executor, not both"):
        sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor, workers=1)


def test_what_cannot_travel_to_workers_is_refused():
    lock = threading.Lock()
    with pytest.raises(ks.ParameterError, match=r"cannot go to other processes.*give it no open files or locks"):
        sweep(lambda crank, mass: factories.pump(crank, mass) if lock else None, DESIGNS, OUTPUTS, workers=1)


WATCHED = """
import sys; sys.path.insert(0, sys.argv[1])
from support import factories; import kinetostatics as ks
ks.sweep(factories.slow, factories.DESIGNS, factories.OUTPUTS, chunk=1, workers=2, progress=False)
"""


def test_workers_end_with_their_parent_however_it_ends(tmp_path, monkeypatch):
    """Here by a signal that nobody can answer; each worker writes down its process when it computes."""
    monkeypatch.setenv("KINETOSTATICS_TEST_NOTES", str(tmp_path))
    parent = subprocess.Popen(
        [sys.executable, "-c", WATCHED, str(Path(__file__).parents[1])],
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    processes = waited(lambda: [int(path.name) for path in tmp_path.iterdir()], lambda found: len(found) == 2)
    parent.kill()
    assert parent.wait() == -signal.SIGKILL
    assert waited(lambda: list(filter(alive, processes)), lambda found: not found) == []


def waited(look, enough, seconds=60):
    """What a look tells as soon as it is enough, or at last."""
    end = time.monotonic() + seconds
    while not enough(found := look()) and time.monotonic() < end:
        time.sleep(0.05)
    return found


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_errors_of_the_library_end_the_sweep(monkeypatch):
    monkeypatch.setattr(chunks, "run_chunk", None)
    with ThreadPoolExecutor(1) as executor:
        for error in (ks.errors.MissingLibraryError("no numba here"), OSError("disk full")):
            monkeypatch.setattr(together, "run", partial(raising, error))
            with pytest.raises(type(error), match=str(error)):
                sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor)


def raising(error, *call):
    raise error


# Folders


def counted(calls):
    """A function that counts how often it is called, whose text tells no counts."""

    def made(crank, mass):
        calls.append(np.size(crank))
        return factories.pump(crank, mass)

    return made


@pytest.mark.parametrize("folder", [5, 2.5, ["here"], b"here", True])
def test_a_folder_that_is_no_path_is_refused(folder):
    with pytest.raises(ks.ParameterError, match="sweep: folder must be a path, got"):
        sweep(factories.pump, DESIGNS, OUTPUTS, folder=folder)


def test_a_folder_holds_a_dataset_that_pandas_reads(tmp_path, expected):
    folder = tmp_path / "new" / "sweep"
    assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=folder), expected)
    assert_equal(pd.read_parquet(folder), expected)
    assert len(list(folder.glob("part-*.parquet"))) == 6
    named = DESIGNS.set_index(pd.Index([f"design {row}" for row in range(41)], name="name"))
    found = sweep(factories.pump, named, OUTPUTS, chunk=7, folder=tmp_path / "named")
    assert_equal(found, expected.set_index(named.index))
    assert_equal(pd.read_parquet(tmp_path / "named"), found)


def test_rows_may_share_a_name(tmp_path, expected):
    twice = DESIGNS.set_index(pd.Index([0] * 41))
    found = sweep(factories.pump, twice, OUTPUTS, chunk=7)
    assert_equal(found.reset_index(drop=True), expected)
    assert_equal(sweep(factories.pump, twice, OUTPUTS, chunk=7, folder=tmp_path), found)


def test_a_finished_folder_is_read_and_not_computed_again(tmp_path):
    calls: list[int] = []
    first = sweep(counted(calls), DESIGNS, OUTPUTS, chunk=7, folder=tmp_path)
    calls.clear()
    assert_equal(sweep(counted(calls), DESIGNS, OUTPUTS, chunk=7, folder=tmp_path), first)
    assert calls == [1]  # the trial before a sweep


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit])
def test_an_interrupted_sweep_goes_on_where_it_stopped(tmp_path, expected, monkeypatch, error):
    calls: list[int] = []
    function, run = counted(calls), chunks.run_chunk

    def interrupted(job, frame):
        if 30 in frame.index:
            raise error
        return run(job, frame)

    monkeypatch.setattr(dispatch, "run_chunk", interrupted)
    with pytest.raises(error):
        sweep(function, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path)
    assert len(list(tmp_path.glob("part-*"))) == 4
    (tmp_path / ".part-000004-half.parquet").write_bytes(b"PAR1 half written")
    monkeypatch.undo()
    calls.clear()
    assert_equal(sweep(function, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path), expected)
    assert sum(calls) == 1 + 7 + 6
    assert_equal(pd.read_parquet(tmp_path), expected)


def test_a_killed_process_leaves_a_folder_that_goes_on(tmp_path, expected):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from support import factories as f; import kinetostatics as ks;"
        " ks.sweep(f.deadly_once(0.3, sys.argv[2]), f.DESIGNS, f.OUTPUTS, chunk=7, folder=sys.argv[3], progress=False)"
    )
    marker, folder = tmp_path / "died", tmp_path / "sweep"
    here = str(Path(__file__).parents[1])
    killed = subprocess.run([sys.executable, "-c", code, here, str(marker), str(folder)], check=False)
    assert killed.returncode == -signal.SIGKILL
    assert len(list(folder.glob("part-*"))) == 2
    function = factories.deadly_once(0.3, marker)
    assert_equal(sweep(function, DESIGNS, OUTPUTS, chunk=7, folder=folder), expected)


def test_a_sweep_through_workers_that_is_stopped_goes_on(tmp_path, expected, monkeypatch):
    """By an error while results come in."""
    put = dataset.Dataset._put

    def full(self, number, rows):
        if number == 3:
            raise OSError("disk full")
        put(self, number, rows)

    monkeypatch.setattr(dataset.Dataset, "_put", full)
    with ThreadPoolExecutor(2) as executor:
        with pytest.raises(OSError, match="disk full"):
            sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path, executor=executor)
        monkeypatch.setattr(dataset.Dataset, "_put", put)
        assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path, executor=executor), expected)


OTHERS = {
    "function": {"source": factories.picky},
    "designs": {"designs": DESIGNS + 1},
    "columns, designs": {"designs": DESIGNS.rename(columns={"mass": "mass [g]"})},
    "outputs": {"outputs": ["rms O"]},
    "angles": {"angles": 180},
    "chunk": {"chunk": 8},
    "reference": {"outputs": ["ratio rms O"], "reference": factories.pump(0.2)},
}


@pytest.mark.parametrize("name", OTHERS)
def test_another_sweep_in_the_folder_is_refused(tmp_path, name):
    options = {"source": factories.pump, "designs": DESIGNS, "outputs": OUTPUTS, "chunk": 7, "folder": tmp_path}
    if name == "reference":
        options |= {"outputs": ["ratio rms O"], "reference": factories.pump(0.1)}
    sweep(**options)
    with pytest.raises(ks.ParameterError, match=f"another sweep, which differs in .*{name.split(', ')[0]}"):
        sweep(**options | OTHERS[name])


def test_cases_are_told_apart_by_their_variants_and_files(tmp_path):
    """Not by comments, other variants or how the same variant is named."""
    designs, options = pd.DataFrame({"crank_speed": [30, 33]}), {"chunk": 1, "folder": tmp_path / "sweep", "angles": 12}
    case = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"])
    sweep(case, designs, OUTPUTS, variant="cam-circle", **options)
    sweep(SAW, designs, OUTPUTS, **options)
    changed = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"], "cam.radius", "0.31 m")
    with pytest.raises(ks.ParameterError, match="another sweep, which differs in variant;"):
        sweep(changed, designs, OUTPUTS, **options)


def test_a_case_that_was_loaded_is_swept_as_it_was(tmp_path):
    """Whatever becomes of its file, and with the file that it names."""
    case = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"])
    designs = pd.DataFrame({"crank_speed": [30.0]})
    before = sweep(case, designs, OUTPUTS)
    changed = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"], "cam.radius", "0.31 m")
    assert_equal(sweep(case, designs, OUTPUTS), before)
    assert not sweep(changed, designs, OUTPUTS).equals(before)


def test_files_that_a_case_names_are_part_of_it(tmp_path):
    designs, options = pd.DataFrame({"crank_speed": [30.0, 33.0]}), {"angles": 12, "folder": tmp_path / "sweep"}
    cam = {"kind": "sampled", "table": "cam.csv"}
    for radius in (0.3, 0.31):
        rows = (f"{angle}, {radius + 0.02 * np.cos(np.radians(angle))}" for angle in range(0, 360, 5))
        (tmp_path / "cam.csv").write_text("\n".join(["angle [deg], radius [m]", *rows]), encoding="utf-8")
        case = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"], "cam", cam)
        if radius == 0.3:
            assert sweep(case, designs, OUTPUTS, **options)[FAILED].eq("").all()
    with pytest.raises(ks.ParameterError, match="differs in variant;"):
        sweep(case, designs, OUTPUTS, **options)


# Memory and progress


def test_memory_is_that_of_a_chunk(monkeypatch):
    """Four times the designs take no more, but for the table itself."""
    monkeypatch.setattr(together, "VALUES", 2000)

    def peak(count):
        designs = pd.DataFrame({"crank": np.linspace(0.1, 0.5, count)})
        tracemalloc.start()
        try:
            sweep(factories.pump, designs, ["rms O"], angles=20, chunk=1000)
            return tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()

    peak(1000)
    assert peak(12_000) - peak(3000) < 9000 * 100


def test_the_bar_counts_every_design_also_those_on_disk(tmp_path, monkeypatch):
    shown = io.StringIO()
    monkeypatch.setattr(sys, "stderr", shown)
    sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path)
    assert shown.getvalue() == ""
    for number in (1, 5):
        (tmp_path / f"part-00000{number}.parquet").unlink()
    for options in ({"folder": tmp_path}, {}):
        ks.sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, **options)
        last = shown.getvalue().split("\r")[-1]
        assert "100%" in last
        assert "41/41" in last
        assert "designs" in last


FROM_SCRATCH = """
import hashlib
import kinetostatics as ks

around = {"spring.stiffness": "650..850 kN/m", "cam.centre.x": "-30..-10 mm", "coupler_length": "2010..2030 mm"}
designs = ks.designs.latin_hypercube(around, 1000)
outputs = ["ratio mean_absolute balancing_torque", "mean O"]
table = ks.sweep(ks.load_case("sawframe_2r63"), designs, outputs, variant="cam-circle", progress=False)
print(hashlib.sha256(table.iloc[:, :-1].to_numpy(float).tobytes()).hexdigest())
"""


def test_machine_code_just_made_and_taken_from_disk_gives_the_same_bits(tmp_path):
    pytest.importorskip("numba")
    environment = {**os.environ, "KINETOSTATICS_CACHE": str(tmp_path)}
    found = [
        subprocess.run(
            [sys.executable, "-c", FROM_SCRATCH], env=environment, capture_output=True, text=True, check=True
        )
        for _ in range(2)
    ]
    assert found[0].stdout == found[1].stdout
    assert len(found[0].stdout.strip()) == 64
