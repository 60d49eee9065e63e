"""Case files of wrong text, and the tables of force that belong to them: one clear error each, with its key."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.sweeps import designs
from support.case_files import BADLY_WRITTEN
from support.every import every


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    designs.distributions({"a": "0..1 m"})
    ks.load_case("sawframe_2r63")


CASE = """
title = "test"
reference = "a"
[variants.a]
mechanism = "crank-slider"
crank_speed = "320 rpm"
crank_length = "300 mm"
coupler_length = "2 m"
slider = { mass = "10 kg" }
"""


def case_file(folder, text):
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


@every("number", BADLY_WRITTEN)
def test_badly_written_number_suggests_the_right_one(tmp_path, number):
    path = case_file(tmp_path, CASE.replace('"2 m"', f'"{number} m"'))
    with pytest.raises(ks.CaseError, match=r"variants.a.coupler_length must be text") as caught:
        ks.load_case(path)
    assert f'write "{BADLY_WRITTEN[number][0]} m"' in str(caught.value)


BAD_CASES = {
    "deep lists": ("x = " + "[" * 10_000 + "]" * 10_000, "more than 20 deep"),
    "deep tables": ("x = " + "{a = " * 10_000 + "1" + "}" * 10_000, "more than 20 deep"),
    "deep keys": (".".join("a" * 10_000) + " = 1", "more than 20 deep"),
    "deep heading": (f"{CASE}\n[{'.'.join('a' * 1000)}]", "more than 20 deep"),
    "deep within": (CASE + "\n[common]\n" + ".".join("b" * 50) + " = 1", "more than 20 deep"),
    "giant whole number": (f"{CASE}\nassembly = {'9' * 5000}", "is not TOML"),
    "zero byte": (CASE.replace("test", "te\0st"), "zero byte"),
    "control": (CASE.replace("test", "te\x01st"), "is not TOML"),
    "the same key twice": (CASE + 'crank_speed = "1 rpm"', "is not TOML"),
    "empty": ("", "title is missing"),
    "number for a table": ("variants = 5", "variants"),
    "unit of a hang": (CASE.replace('"2 m"', '"2 m*10**10**10"'), 'coupler_length unit "m.10..10..10" is not known'),
    "unit over zero": (CASE.replace('"2 m"', '"2 m/0"'), 'coupler_length unit "m/0" is not known'),
    "assembly true": (CASE + "assembly = true", "assembly"),
    "number": (CASE.replace('"2 m"', "2.0"), "must be text"),
    "date": (CASE.replace('"2 m"', "2020-01-01"), "must be text"),
    "words for a switch": (CASE + 'balancing = {method = "optimal", phase = "no", crank = {arm = "1 m"}}', "phase"),
    "weights that are no numbers": (CASE + 'balancing = {method = "optimal", weights = [nan, inf]}', "weights"),
    "a negative weight": (CASE + 'balancing = {method = "optimal", weights = [-1, 0]}', "weights"),
    "no sampling": (CASE + '[published]\nsampling = "0 deg"', "published.sampling must be a step"),
    "backward sampling": (CASE + '[published]\nsampling = "-1 deg"', "published.sampling must be a step"),
    "endless sampling": (CASE + '[published]\nsampling = "1e-9 deg"', "published.sampling must be a step"),
    "ratio without end": (CASE + 'balancing = {method = "partial", ratio = inf, crank = {arm = "1 m"}}', "ratio"),
    "long text": (CASE.replace('"2 m"', '"' + "2" * 100_000 + ' m"'), "must be text"),
    "pipe beside it": (CASE + 'process_force = { table = "/dev/zero" }', "a pipe or device, not a file"),
    "the folder as a table": (CASE + 'process_force = { table = "" }', "it is a folder"),
    "period of a constant force": (
        CASE + 'process_force = { force = "1 N", period = "720 deg" }',
        "period, but no table",
    ),
    "period of no turns": (CASE + 'process_force = { table = "f.csv", period = "0 deg" }', "whole number of turns"),
    "period of half turns": (CASE + 'process_force = { table = "f.csv", period = "540 deg" }', "whole number of turns"),
    "period without unit": (CASE + 'process_force = { table = "f.csv", period = "2" }', "has no unit"),
}


@every("name", BAD_CASES)
def test_impossible_case_file_names_its_key(tmp_path, name):
    text, message = BAD_CASES[name]
    with pytest.raises(ks.CaseError, match=message) as caught:
        ks.load_case(case_file(tmp_path, text))
    assert len(str(caught.value)) < 1500


# Tables of force: angles in degrees, what the case says of the period, what is answered

NOT_A_TURN = {
    "two turns": (range(0, 720, 10), "", 'give period = "720 deg"'),
    "two turns with their end": (range(0, 721, 10), "", 'give period = "720 deg"'),
    "three turns as two": (range(0, 1080, 10), "720 deg", 'give period = "1080 deg"'),
    "half a turn": (range(0, 181, 10), "", "rows are missing: they end at 180 deg, 180 deg before"),
    "a turn as two": (range(0, 360, 10), "720 deg", "rows are missing: they end at 350 deg"),
    "a hole": ([*range(0, 90, 10), *range(270, 360, 10)], "", "rows are missing between 80 deg and 270 deg"),
    "one row": ([0], "", "at least 3 rows are needed, got 1"),
    "two rows": ([0, 180], "", "at least 3 rows are needed, got 2"),
    "unequal ends": (range(0, 361, 10), "", "must end as it began"),
    "the same angle twice": ([0, 90, 90, 180, 270], "", "angles must rise, but 90 deg follows 90 deg"),
    "to and fro": ([0, 90, 180, 90, 270], "", "angles must rise, but 90 deg follows 180 deg"),
    "degrees headed rad": (np.degrees(range(0, 360, 10)), "", "are they degrees under a heading of rad?"),
    "radians headed deg": (np.radians(range(0, 360, 10)), "", "are the angles in the unit of their heading?"),
}


@every("name", NOT_A_TURN)
def test_force_table_must_cover_its_period(tmp_path, name):
    angles, period, message = NOT_A_TURN[name]
    rows = (f"{angle}, {1 + place}" for place, angle in enumerate(angles))
    (tmp_path / "force.csv").write_text("\n".join(["crank_angle [deg], force [N]", *rows]))
    told = f', period = "{period}"' if period else ""
    path = case_file(tmp_path, CASE + f'process_force = {{ table = "force.csv"{told} }}')
    with pytest.raises(ks.CaseError, match=r"force.csv: table: ") as caught:
        ks.load_case(path)
    assert message in str(caught.value)


@every("period", [0, -1, 1.0, np.pi, 3 * np.pi, -2 * np.pi, np.nan, np.inf, True, "720 deg", [1]])
def test_a_period_that_is_not_whole_turns_is_refused(period):
    with pytest.raises(ks.ParameterError, match=r"period must be 2 pi or a whole multiple of it"):
        ks.ProcessForce(1.0, period=period)
