"""The reference data of docs/data: made anew it is the same, its form is right, and its checker finds wrong results."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks

DATA = Path(__file__).parents[2] / "docs" / "data"
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="the reference data is not beside the tests")
LARGEST = 1_500_000
"""Bytes of all files."""
ANEW = ("machines/yoke-1", "cases/chain_unit-rho-0.1")
"""Folders that are made anew: the quickest of a random machine and of a case."""


def module(name):
    spec = importlib.util.spec_from_file_location(name, DATA / f"{name}.py")
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


@pytest.fixture(scope="module")
def check():
    return module("check")


def test_reference_data_cover_cases_and_kinds(check):
    found = {folder.relative_to(DATA).as_posix() for folder in check.folders()}
    for stem in ("sawframe_2r63-plain", "sawframe_2r63-cam-cosine", "chain_unit-free-start", "toggle_press-coining"):
        assert f"cases/{stem}" in found
    machines = [name for name in found if name.startswith("machines/")]
    assert len(machines) == 20
    assert {name.split("/")[1].rpartition("-")[0] for name in machines} == {
        *("slider", "cam", "four-bar", "six-bar", "coupler-point", "lever", "cylinder", "yoke", "dyad")
    }
    assert sum(path.stat().st_size for path in DATA.rglob("*.*") if path.is_file()) < LARGEST


def test_data_have_17_digits_bounds_and_units(check):
    assert [text for folder in check.folders() for text in check.faults(folder)] == []


@pytest.mark.slow
def test_wrong_results_are_found_whatever_is_wrong(check):
    """Every kind of machine: each number off, missing, in another unit, from the other body."""
    firsts = [folder for folder in check.folders() if folder.parent.name == "machines" and folder.name.endswith("-1")]
    assert len(firsts) == 9
    assert [text for folder in firsts for text in check.proven(folder)] == []
    assert sum(1 for _ in check.wrongs(firsts[0])) > 50


def test_bad_data_is_found_in_the_data_itself(check, tmp_path):
    folder = shutil.copytree(DATA / "machines/slider-1", tmp_path / "slider-1")
    table = (folder / "reactions.csv").read_text(encoding="utf-8").splitlines()
    rows = [row.split(",") for row in table]

    def told(place, text):
        changed = [row if number != 3 else [*row[:place], text, *row[place + 1 :]] for number, row in enumerate(rows)]
        (folder / "reactions.csv").write_text("\n".join(map(",".join, changed)) + "\n", encoding="utf-8")
        return list(check.faults(folder))

    assert told(1, rows[3][1]) == []
    assert "digits of 17" in told(1, rows[3][1][:9])[0]
    assert "is no certified value" in told(2, "0.5")[0]
    assert "no number" in told(1, "nan")[0]
    place = rows[0].index("guide.x [N]")
    assert "is not across the guide" in told(place, rows[3][place].replace("1", "2"))[-1]


@pytest.mark.slow
def test_library_agrees_with_all_reference_data(check):
    """The scenes are made from case.json alone, for slider, lever and yoke: what it tells is enough."""
    for name in ("slider-1", "slider-2", "slider-3", "lever-1", "lever-2", "yoke-1", "yoke-2"):
        folder = DATA / "machines" / name
        told, table = check.case(folder), check.read(folder / "reactions.csv")
        solution = scene_of(told).solve(np.array([float(text) for text in table[check.ANGLE]]))
        results = {check.ANGLE: table[check.ANGLE]}
        for reaction, names in check.columns(told).items():
            vector = reaction in solution.reactions
            parts = solution.reaction(reaction) if vector else [solution.scalar(reaction)]
            results |= {column: [repr(float(x)) for x in part] for column, part in zip(names, parts, strict=True)}
        assert list(check.problems(folder, results, relative=1e-13)) == []


def scene_of(told):
    """A scene from what case.json says."""
    loads = {"Gravity": gravity, "ProcessForce": lambda item: ks.ProcessForce(item["force [N]"], on=item["on"])}
    crank = ks.Crank(told["crank"]["length [m]"], link(told["crank"]["link"]))
    groups = tuple(GROUPS[item["type"]](item) for item in told["groups"])
    return ks.Scene(
        ks.Mechanism(told["name"], crank, groups),
        told["crank_speed [rad/s]"],
        told["crank_acceleration [rad/s**2]"],
        [loads[item["type"]](item) for item in told["loads"]],
    )


def link(item):
    return ks.Link(item["mass [kg]"], tuple(item["centre [m]"]), item["inertia [kg*m**2]"])


def gravity(item):
    return ks.Gravity(item["acceleration [m/s**2]"], item["direction [rad]"])


def guide(item):
    return ks.Guide.at(item["guide_angle [rad]"], item["guide_offset [m]"])


GROUPS = {
    "SliderGroup": lambda item: ks.SliderGroup(
        item["coupler_length [m]"], guide(item["guide"]), item["assembly"], link(item["coupler"]), link(item["slider"])
    ),
    "LeverGroup": lambda item: ks.LeverGroup(
        tuple(item["pivot [m]"]),
        offset=item["offset [m]"],
        lever=link(item["lever"]),
        block=link(item["block"]),
        assembly=item["assembly"],
    ),
    "YokeGroup": lambda item: ks.YokeGroup(
        guide(item["guide"]), item["slot_angle [rad]"], slider=link(item["slider"]), block=link(item["block"])
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("folder", ANEW)
def test_data_made_anew_is_the_same(folder, check, tmp_path):
    """To the last digit of every value; bounds may differ as the kernels' order of operations does."""
    pytest.importorskip("flint", reason="the data is certified by python-flint")
    module("make").made(tmp_path, folder)
    told, old = (check.case(place / folder) for place in (tmp_path, DATA))
    reached = told.pop("certified")["largest disagreement, relative to the largest value"]
    assert reached["full system with formulas of its own"] < 1e-30
    assert told == {key: item for key, item in old.items() if key != "certified"}
    anew, table = (check.read(place / folder / "reactions.csv") for place in (tmp_path, DATA))
    assert list(anew) == list(table)
    for name, texts in anew.items():
        if " bound [" in name:
            assert np.allclose(np.array(texts, float), np.array(table[name], float), rtol=0.2, atol=1e-25), name
        else:
            assert texts == table[name], name


@pytest.mark.slow
def test_the_checker_runs_without_the_library(tmp_path):
    """As another project would run it: on its own results, in a Python that has no packages."""
    bad = tmp_path / "bad.csv"
    text = (DATA / "machines/yoke-1/reactions.csv").read_text(encoding="utf-8")
    bad.write_text(text.replace("\n0.75,", "\n0.75,9", 1), encoding="utf-8")

    def run(table):
        command = [sys.executable, "-I", "-S", str(DATA / "check.py"), "machines/yoke-1", str(table)]
        return subprocess.run(
            command, capture_output=True, text=True, check=False, env={**os.environ, "PYTHONPATH": ""}
        )

    assert run(DATA / "machines/yoke-1/reactions.csv").stdout == "all is right\n"
    found = run(bad)
    assert found.returncode == 1
    assert found.stdout.startswith("row 2, ")
