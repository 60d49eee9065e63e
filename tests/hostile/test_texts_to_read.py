"""Texts with faults: case files, tables, numbers and units; each message names the place."""

import os
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings, strategies

import kinetostatics as ks
from kinetostatics.cli import main
from kinetostatics.numbers.files import read_columns
from kinetostatics.numbers.units import factor, to_si
from kinetostatics.sweeps import designs
from support.case_files import BADLY_WRITTEN
from support.every import every

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
    "number for what is common": (CASE.replace("reference", "common = 3\nreference"), "common must be a table"),
    "list for a name": (CASE.replace('reference = "a"', 'reference = ["a"]'), "reference"),
    "list for a mechanism": (CASE.replace('"crank-slider"', '["crank-slider"]'), "variants.a.mechanism"),
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
    "radians headed deg": (np.radians(range(0, 360, 10)), "", "Are the angles in the unit of their heading?"),
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


# What cannot be read as a file, or is no name of one


def special(folder, kind):
    path = folder / kind
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path)
    elif kind == "sparse":
        with path.open("wb") as file:
            file.truncate(2 * 10**9)
    elif kind == "large":
        path.write_bytes(b"1,2\n" * 3_000_000)
    return {"device": Path("/dev/zero"), "zero": folder / "a\0b", "long": folder / ("x" * 5000)}.get(kind, path)


KINDS = {
    **dict.fromkeys(("pipe", "device"), "cannot be read: it is a pipe or device, not a file"),
    **dict.fromkeys(("sparse", "large"), r"cannot be read: it is larger than (10|0\.3) MB"),
    **dict.fromkeys(("loop", "zero", "long", "missing"), "cannot be read|there is no file"),
    "folder": "cannot be read: it is a folder, not a file",
}


@every("kind", KINDS)
@every("read", [ks.load_case, lambda path: read_columns(path, {"force": "N"})])
def test_a_pipe_device_folder_or_giant_is_no_text(tmp_path_factory, kind, read):
    with pytest.raises(ks.CaseError, match=KINDS[kind]):
        read(special(tmp_path_factory.mktemp("special"), kind))


@every("name", ["a\0b", "x" * 300, "x" * 100_000, "a/" * 3000, "\ud800", "~/saw", "", ".", "\n"])
def test_a_name_that_no_file_can_have_is_no_case(name):
    with pytest.raises(ks.CaseError, match=r"cannot be read|there is no file"):
        ks.load_case(name)


NO_PATHS = [
    None,
    3,
    np.nan,
    True,
    b"saw",
    b"\0",
    [],
    ["sawframe_2r63"],
    {},
    object(),
    np.array(["a"]),
    ks.crank_slider,
    ks.crank_slider(0.1, 0.4),
]


@every("thing", NO_PATHS, ids=range(len(NO_PATHS)))
def test_what_is_neither_path_nor_name_is_no_case(thing):
    with pytest.raises(ks.ParameterError, match=r"^load_case: needs a path or the name of a shipped case, got "):
        ks.load_case(thing)


# Tables of text that are wrong

ANGLES = range(0, 360, 10)
ROWS = [f"{angle}, {1000 + angle % 70}" for angle in ANGLES]
HEADING = "crank_angle [deg], force [N]"
GOOD = "\n".join([HEADING, *ROWS])


def forces(path):
    return read_columns(path, {"crank_angle": "rad", "force": "N"})


def table(folder, content):
    path = folder / "table.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


BAD_TABLES = {
    "empty": ("", "is empty: a heading and rows of numbers are needed"),
    "blank": ("\n\n \n", "is empty"),
    "header only": (HEADING, r"has a heading, 'crank_angle \[deg\], force \[N\]', but no rows"),
    "header and blanks": (HEADING + "\n\n\n", "no rows"),
    "semicolons": (GOOD.replace(",", ";"), "has semicolons between its columns; write commas there"),
    "decimal commas": (GOOD.replace(",", ";").replace("1000", "1000,5"), "semicolons between its columns"),
    "decimal commas between commas": (
        GOOD.replace("1000", "1000,5"),
        "line 2 has 3 fields, but the heading 2; if a comma",
    ),
    "tabs": (GOOD.replace(", ", "\t"), "tabs between its columns"),
    "binary": (bytes(range(256)) * 4, "is not text: it has a zero byte at 0"),
    "zero bytes": (GOOD.replace("1000", "10\x000"), "zero byte"),
    "UTF-16": (GOOD.encode("utf-16"), "UTF-16; save it as UTF-8"),
    "UTF-16 without mark": (GOOD.encode("utf-16-le"), "zero byte"),
    "Latin-1": (GOOD.replace("deg", "°").encode("latin-1"), "is not UTF-8 text"),
    "longer row": (GOOD.replace("10, 1010", "10, 1010, 7"), "line 3 has 3 fields, but the heading 2"),
    "rows longer than the heading": (
        GOOD.replace("\n", ", 1\n").replace(", 1\n", "\n", 1),
        "3 fields, but the heading 2",
    ),
    "shorter row": (GOOD.replace("10, 1010", "10"), "line 3 has 1 fields, but the heading 2"),
    "two units": (
        GOOD.replace("force [N]", "force [N], force [kN]").replace("1000", "100, 0.1"),
        "fields|2 columns are",
    ),
    "the same twice": ("\n".join(f"{row}, {row}" for row in GOOD.split("\n")), "2 columns are 'force'"),
    "no unit": (GOOD.replace(" [N]", ""), r"has no unit; head it for example \"force \[N\]\""),
    "open bracket": (GOOD.replace("[N]", "[N"), "no column 'force'"),
    "other unit": (GOOD.replace("[N]", "[kg]"), "does not measure the same"),
    "unit of a hang": (GOOD.replace("[N]", "[N*10**10**10]"), "is not known"),
    "other name": (GOOD.replace("force", "forces"), "no column 'force'; .* head it 'force \\[N\\]'"),
    "words": (GOOD.replace("1060", "high"), "line 8: not a number: 'high'"),
    "nan": (GOOD.replace("1030", "nan"), "line 5: not a number: 'nan'"),
    "infinite": (GOOD.replace("1030", "1e999"), "line 5: not a number: '1e999'"),
    "missing": (GOOD.replace(", 1030", ","), "line 5: not a number: ''"),
    "underscores": (GOOD.replace("1030", "1_030"), "line 5: not a number: '1_030'"),
    "wide digits": (GOOD.replace("1030", "１０３０"), "line 5: not a number"),
    "hexadecimal": (GOOD.replace("1030", "0x82"), "line 5: not a number"),
    "with a unit": (GOOD.replace("1030", "1030 N"), "line 5: not a number: '1030 N'"),
    "after blank lines": (GOOD.replace("\n10,", "\n\n\n\n10,").replace("1030", "x"), "line 8: not a number: 'x'"),
    "after blank Windows lines": (GOOD.replace("\n", "\r\n\r\n").replace("1030", "x"), "line 9: not a number: 'x'"),
    "a comment after the heading": (
        GOOD.replace("\n10,", "\n# measured\n10,"),
        "line 3 begins with '#'; comments stand",
    ),
    "a comment at the end": (GOOD + "\n# a, b\n", f"line {len(ROWS) + 2} begins with '#'"),
    "comments only": ("# measured\n# on Monday\n", "is empty"),
    "a heading as a comment": ("# " + GOOD, "has no heading after its comments; take the '#' off the line"),
    "words after comments": ("# one\n\n" + GOOD.replace("1060", "high"), "line 10: not a number: 'high'"),
    "open quote": (GOOD.replace("1030", '"1030'), "cannot be read as CSV: line|not a number"),
    "a field without end": (HEADING + "\n" + "1" * 200_000, "cannot be read as CSV: line 2"),
}


@every("name", BAD_TABLES)
def test_a_table_that_is_none_is_refused_with_its_line(tmp_path, name):
    content, message = BAD_TABLES[name]
    with pytest.raises(ks.CaseError, match=message) as caught:
        forces(table(tmp_path, content))
    assert str(caught.value).startswith(f"{tmp_path / 'table.csv'}: ")


@every(
    "content",
    [
        "\ufeff" + GOOD,
        "\ufeff# measured on Monday, in the open\n" + GOOD,
        '# an "open quote, and ; a semicolon\n\n  # and more\u2028\n' + GOOD,
        "# after Windows\r\n" + GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\n\n"),
        GOOD + "\n\n \n",
        GOOD.replace(", ", ","),
        GOOD.replace(HEADING, "crank_angle[deg],force[N]"),
        GOOD.replace(HEADING, '"crank_angle [deg]","force [N]"'),
        "\n".join(f"word, {row}" for row in GOOD.split("\n")),
    ],
)
def test_a_table_written_otherwise_is_read_alike(tmp_path, content):
    angle, force = forces(table(tmp_path, content))
    np.testing.assert_allclose(np.degrees(angle), ANGLES, rtol=1e-15)
    assert force.tolist() == [float(row.split(",")[1]) for row in ROWS]


# Numbers, units and spreads as text that are wrong


@every("unit", ["m", "kN/mm", "kg m^2"])
@every("number", BADLY_WRITTEN)
def test_badly_written_numbers_are_corrected(number, unit):
    with pytest.raises(ValueError, match=r"must be text of a number and a unit") as caught:
        to_si(f"{number} {unit}", unit)
    assert all(f'"{right} {unit}"' in str(caught.value) for right in BADLY_WRITTEN[number])


@every("number", BADLY_WRITTEN)
@every("form", ["0..{} m:3", "{}..9e9 m", "normal 1 m +- {} m", "triangular 0..{}..9e9 m"])
def test_badly_written_spreads_are_corrected(number, form):
    made = designs.grid if ":" in form else designs.distributions
    with pytest.raises(ks.ParameterError, match=r"cannot read") as caught:
        made({"a": form.format(number)})
    assert f'"{form.format(BADLY_WRITTEN[number][0])}"' in str(caught.value)


NO_NUMBER = [
    *("", " ", "m", "nan m", "inf m", "-inf m", "1e3e3 m", "1.2.3 m", "1,2,3 m", "--5 m", "+-5 m", "1/2 m", "½ m"),
    *("'5' m", "$5 m", "5-3 m", "5:3 m", "True", "5.1/s", "1e5,3 m", "e5 m", ". m", "\x00", "1" * 10_000 + " m"),
    *(5, 5.0, None, True, [1, "m"], {"a": 1}, b"5 m", float("nan")),
]


@every("text", NO_NUMBER, ids=lambda text: repr(text)[:20])
def test_what_holds_no_number_is_refused(text):
    with pytest.raises(
        ValueError, match=r'must be text of a number and a unit that converts to m, found .*"1.5 m"|write'
    ):
        to_si(text, "m")


BAD_UNITS = [
    *(
        "m*10**10**10",
        "10**10**10",
        "m^9999999999",
        "m^1e9",
        "m**10**10",
        "m/0",
        "m^0",
        "m^0.5",
        "m**-",
        "m^",
        "^2",
        "m//s",
    ),
    *("2 m", "m 3", "m + m", "m - m", "(m)", "((((m", "m)", "m;", "m,", "m!", "m=m", "m__class__", "__import__", "m.s"),
    *(
        "lambda: m",
        "[m]",
        "{m}",
        "m if m",
        "m\x00",
        "m\nm;",
        "furlog",
        "m" * 10_000,
        "1",
        "1/1",
        "1 m",
        "m²³",
    ),
    *("'m'", '"m"', "m\\", "#m", "m#", "m@m", "m%m", "m~", "~m", "m&m", "m|m", "nan", "inf", "None", "x10", "0"),
]


@every("unit", BAD_UNITS, ids=lambda text: repr(text)[:20])
def test_units_outside_the_grammar_are_refused(unit):
    with pytest.raises(ValueError, match=r"is not known|does not measure the same|must be text of a number"):
        to_si(f"5 {unit}", "m")


@every(
    ("unit", "value"),
    [
        *(("m", 1.0), ("mm", 1e-3), ("km", 1e3), ("in", 0.0254), ("m^1", 1.0), ("m**1", 1.0), ("m^2/m", 1.0)),
        *(("m2/m", 1.0), ("m²/m", 1.0), ("m·m/m", 1.0), ("m * m / m", 1.0), ("mm m^-1 m", 1e-3), ("m per s s", 1.0)),
        *(("\u00b5m", 1e-6), ("\u03bcm", 1e-6), ("metre", 1.0), ("1/m m^2", 1.0)),
    ],
)
def test_a_unit_within_the_grammar_is_read(unit, value):
    assert to_si(f"1 {unit}", "m") == pytest.approx(value, rel=1e-15)


@every("space", ["", " ", "  ", "\t", "\u00a0", "\u2009", "\u202f"])
def test_any_space_may_precede_the_unit(space):
    assert to_si(f"5{space}mm", "m") == 0.005


@pytest.mark.parametrize("unit", ["m*10**10**10", "m/0", "kg)"])
def test_design_columns_use_the_unit_grammar(unit):
    with pytest.raises(ValueError, match=r"is not known"):
        factor(unit, "m")


@every(
    ("spreads", "message"),
    [
        ({"a": "0..1 m:1000000000"}, "1000000000 values are too many"),
        ({"a": "0..1 m:" + "9" * 100}, "values are too many"),
        ({"a": "0..1 m:100000", "b": "0..1 m:100000"}, "too many for one table"),
        ({"a": "0...1 m:3"}, "write two dots"),
        ({"a": "0..1 m:٣"}, "another form"),
        ({"a": "0..1 m:" + "0" * 10_000}, "longer than 200 letters"),
        ({"a": 5}, "must be text"),
        ({"a": None}, "must be text"),
        ({"a": "0..1 m*10**10**10:3"}, "is not known"),
    ],
)
def test_large_or_untyped_grids_are_refused(spreads, message):
    with pytest.raises(ks.ParameterError, match=message):
        designs.grid(spreads)


@every("count", [0, -1, 1.5, True, "8", None, 10**12])
@every("kind", [designs.latin_hypercube, designs.sobol, designs.random])
def test_samples_of_no_or_too_many_designs_are_refused(kind, count):
    with pytest.raises(ks.ParameterError, match=r"count must be|too many for one table"):
        kind({"a": "0..1 m"}, count)


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(strategies.text("0123456789.,eE+-*/^ mkNsg()²\u2009\u2212٣'_", max_size=12))
def test_any_text_is_one_number_or_refused(text):
    """What is accepted is a number as Python writes it, up to the first letter that is no exponent, and a unit."""
    try:
        found = to_si(text, "m")
    except ValueError:
        return
    number, unit = re.fullmatch(r"\s*([-+0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^\W\d].*?)\s*", text).groups()
    assert found == float(number) * factor(unit, "m")


@pytest.mark.slow_start
@every(
    ("vary", "message"),
    [
        (["spring.stiffness=600,5..900 kN/m:4"], 'write "600.5..900 kN/m:4"'),
        (
            ["spring.stiffness=600..900 kN/m:4", "spring.stiffness=1..2 kN/m:2"],
            "spring.stiffness is given more than once",
        ),
        (
            ["spring.stiffness = 1..2 kN/m:2", "spring.stiffness=1..2 kN/m:2"],
            "spring.stiffness is given more than once",
        ),
        (["spring.stiffness [N/m]=600..900 kN/m:4"], "parameter is 'spring.stiffness [N/m] [kN/m]'"),
        (["spring.stiffness=600..900 kN/m*10**10**10:4"], "is not known"),
        (["spring.stiffness=0..1 kN/m:1000000000"], "too many"),
        (["=0..1 kN/m:2"], "parameter is ''"),
    ],
)
def test_wrong_spreads_are_refused_in_one_line(capsys, vary, message):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main(["sweep", "sawframe_2r63", *(f"--vary={text}" for text in vary)]) == 2
    printed = capsys.readouterr().err
    assert message in printed
    assert printed.count("\n") == 1
