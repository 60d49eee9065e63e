"""Sweeps: tables, engines, and the texts that ask for outputs."""

import io
import os
import subprocess
import sys
import tracemalloc
import warnings
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cycle.reductions import parsed
from kinetostatics.engines import numba_backend
from kinetostatics.numbers.units import base_factor
from kinetostatics.sweeps import chunk, sweeps
from kinetostatics.sweeps.sweeps import FAILED, _column_problems
from support import factories
from support.case_files import shipped, written
from support.every import every
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, rising, sweep

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
        expected.append([parsed("mean_absolute balancing_torque").reduced(torque[None])[0], reaction, compared / own])
    assert table.iloc[:, 1:4].to_numpy() == pytest.approx(np.array(expected), rel=1e-12)


def test_ratios_are_dynamic_coefficients():
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


def test_swept_variant_defaults_beside_the_reference():
    designs = ks.designs.grid({"slider.mass": "600..600 kg:1"})
    ratio = "ratio mean_absolute balancing_torque"
    assert_equal(sweep(SAW, designs, ratio), sweep(SAW, designs, ratio, variant="cam-circle", reference="plain"))
    assert sweep(SAW, designs, ratio, variant="plain").iloc[0, 1] == 1.0
    with pytest.raises(ks.CaseError, match="did you mean 'cam-circle'"):
        sweep(SAW, designs, ratio, variant="cam-circl")


def test_counterweights_follow_each_design():
    """Balanced one design at a time; full balancing leaves nothing, whatever the masses."""
    designs = ks.designs.grid({"slider.mass": "4..6 kg:3"})
    found = sweep(shipped("mower_drive"), designs, ["largest shaking_force", "ratio rms shaking_force"], variant="full")
    assert found[FAILED].tolist() == [""] * 3
    assert found.iloc[:, 1].max() < 1e-9
    assert np.isinf(found.iloc[:, 2]).all()


# Engines


@pytest.mark.slow
def test_engines_and_threads_give_the_same_table(interpreted, monkeypatch):
    options: dict = {"outputs": [*OUTPUTS, "ratio range balancing_torque"], "variant": "cam-circle", "angles": 12}
    expected = sweep(SAW, rising(30), engine="numpy", **options)
    found = sweep(SAW, rising(30), engine="compiled", **options)
    pd.testing.assert_frame_equal(found, expected, rtol=1e-13)
    monkeypatch.setattr(numba_backend, "core_count", lambda: 2)
    monkeypatch.setattr(chunk, "BLOCK_VALUES", 50)
    monkeypatch.setattr(chunk, "MAX_LOOP_VALUES", 50)
    assert_equal(sweep(SAW, rising(30), engine="compiled", **options), found)


# Memory and progress


@pytest.mark.slow
def test_memory_is_that_of_a_chunk(monkeypatch):
    """Four times the designs take no more, but for the table itself."""
    monkeypatch.setattr(chunk, "BLOCK_VALUES", 2000)

    def peak(count):
        designs = pd.DataFrame({"crank": np.linspace(0.1, 0.5, count)})
        tracemalloc.start()
        try:
            sweep(factories.pump, designs, ["rms O"], engine="numpy", angles=20, chunk=1000)
            return tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()

    peak(1000)
    assert peak(12_000) - peak(3000) < 9000 * 100


@pytest.mark.slow
def test_bar_counts_designs_on_disk(tmp_path, monkeypatch):
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
outputs = ["mean_absolute balancing_torque", "mean O"]
scene = ks.load_case("sawframe_2r63").variant("cam-circle").scene
table = ks.sweep(scene, designs, outputs, progress=False)
print(hashlib.sha256(table.iloc[:, :-1].to_numpy(float).tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_new_and_stored_machine_code_agree(tmp_path):
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


def test_slips_are_hinted_once_at_the_call():
    scene = ks.Scene(ks.crank_slider(50.0, 200.0, slider=ks.Link(1.0)), 1.0)
    designs = pd.DataFrame({"coupler_length": np.linspace(150.0, 200.0, 1000)})
    with pytest.warns(ks.HintWarning) as told:
        found = ks.sweep(scene, designs, ["largest O"], engine="numpy", progress=False)
    assert [warning.filename for warning in told] == [__file__]
    assert "the coupler is 150 m long; are lengths in mm?" in str(told[0].message)
    assert not found[FAILED].any()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ks.HintWarning):
            ks.sweep(scene, designs, ["largest O"], progress=False)


# What a sweep is asked for


def test_all_that_is_wrong_is_told_at_once():
    designs = pd.DataFrame({"slider.mas [kg]": [1.0], "cam.radius [kg]": [1.0], "cam.centre.x [mm]": ["a"]})
    with pytest.raises(ks.ParameterError) as caught:
        sweep(SAW, designs, ["larges O", "harmonic_180 O"], angles=360, chunk=0, engine="fortran")
    for text in (
        "did you mean 'slider.mass'",
        '"kg" does not measure the same as "m"',
        "column 'cam.centre.x [mm]' must contain numbers",
        "did you mean 'largest O'",
        "output 'harmonic_180 O' needs more than 360 crank angles, got 360",
        "chunk must be a whole number of at least 1, got 0",
        "engine is 'fortran', allowed: 'compiled', 'numpy'",
    ):
        assert text in str(caught.value)


WRONG = {
    "a list": (factories.pump, [0.1, 0.2], OUTPUTS, {}, "designs must be a pandas DataFrame, .* got list"),
    "a client": (factories.pump, DESIGNS, OUTPUTS, {"executor": 2}, r"client.get_executor\(\)\), got int"),
    "no designs": (factories.pump, DESIGNS[:0], OUTPUTS, {}, "the table of designs is empty"),
    "no outputs": (factories.pump, DESIGNS, [], {}, "give at least one output"),
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


@every("name", WRONG)
def test_what_cannot_be_done_is_refused(name):
    source, designs, outputs, options, message = WRONG[name]
    with pytest.raises(ks.ParameterError, match=message):
        sweep(source, designs, outputs, **options)


@pytest.mark.parametrize("name", ["rms O [N]", "failed"])
def test_column_named_like_an_output_is_refused(name):
    designs = DESIGNS[["mass"]].assign(**{name: 1.0})
    with pytest.raises(ks.ParameterError, match="of the designs has the name of an output") as caught:
        sweep(factories.pump, designs, ["rms O"])
    assert repr(name) in str(caught.value)


def engines_taken(monkeypatch):
    taken = []
    monkeypatch.setattr(sweeps, "dry_run", lambda *call: taken.append(call[2]))
    return taken


def test_many_crank_angles_are_compiled_unless_told(monkeypatch):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    taken = engines_taken(monkeypatch)
    monkeypatch.setattr(sweeps, "MIN_VALUES_COMPILED", 41 * 200)
    for options in ({}, {"engine": "numpy"}, {"angles": 199}):
        sweep(factories.pump, DESIGNS, OUTPUTS, **{"angles": 200} | options)
    monkeypatch.setitem(sys.modules, "numba", None)
    sweep(factories.pump, DESIGNS, OUTPUTS, angles=200)
    assert taken == [["compiled", "numpy"], ["numpy"], ["numpy"], ["numpy"]]
    with pytest.raises(ks.errors.MissingLibraryError, match="kinetostatics\\[fast\\]"):
        sweep(factories.pump, DESIGNS, OUTPUTS, engine="compiled")


def test_columns_of_quantities_name_their_unit():
    (problem,) = _column_problems(SimpleNamespace(dtypes={"slider.mass": SimpleNamespace(units="kilogram")}), ())
    assert "with the unit kilogram in its heading" in problem


# The trial of a sweep


def test_unknown_sweep_quantities_are_refused(tmp_path):
    for outputs, message in ((["rms cam_forc"], "cam_force"), (["ratio rms cam_force"], "crank-slider: quantity")):
        with pytest.raises(ks.QuantityError, match=message):
            sweep(
                SAW, ks.designs.grid({"slider.mass": "6..7 kg:2"}), outputs, variant="cam-circle", folder=tmp_path / "a"
            )
    assert not (tmp_path / "a").exists()


@dataclass(frozen=True)
class OneSided(ks.SliderGroup):
    """A group that looks at values."""

    def resolve(self, placement, loads, along):
        """The same on either side."""
        found = super().resolve(placement, loads, along)
        return found if placement.joints["A"].position[0].sum() > 0 else found._replace(scalars=dict(found.scalars))


def test_uncompilable_sweeps_use_numpy(interpreted, monkeypatch):
    mechanism = ks.Mechanism("one-sided", ks.Crank(0.1), (OneSided(0.4, slider=ks.Link(1.0)),))
    made = lambda: ks.Scene(mechanism, 10.0)  # noqa: E731
    designs = pd.DataFrame(index=range(2))
    with pytest.raises(ks.errors.NotGivenError, match=r'must not branch on values.*use engine="numpy"'):
        sweep(made, designs, ["rms O"], engine="compiled")
    monkeypatch.setattr(sweeps, "MIN_VALUES_COMPILED", 1)
    assert sweep(made, designs, ["rms O"])[FAILED].tolist() == ["", ""]


@pytest.mark.slow
@every("angles", [12, 13, 36, 48, 100])
def test_few_angles_are_raised_to_enough(angles):
    outputs, designs = ["largest balancing_torque", "mean_absolute A"], pd.DataFrame({"crank_speed": [2.0, 2.5]})
    options = {"variant": "idle"}
    found = sweep(shipped("shaper"), designs, outputs, angles=angles, **options)
    assert_equal(found, sweep(shipped("shaper"), designs, outputs, angles=chunk.MIN_ANGLES_PER_TURN, **options))
