"""Sweeps: rows of cases and functions, engines, memory and progress."""

import io
import os
import subprocess
import sys
import tracemalloc
import warnings

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.numbers.units import base_factor
from kinetostatics.results.reductions import REDUCTIONS
from kinetostatics.sweeps import chunk
from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support.case_files import shipped, written
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
        expected.append([REDUCTIONS["mean_absolute"](torque[None])[0], reaction, compared / own])
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
    monkeypatch.setattr(chunk, "VALUES", 2000)

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
