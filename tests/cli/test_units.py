"""The option --units of run, compare, drive, plot and report."""

import json

import pytest

from kinetostatics.cli import main
from support.commands import printed_by
from support.every import every

UNITS = ["--units", "force=kN, length=mm,torque=kN m,power=kW,angular speed=rpm"]


@every(
    ("text", "message"),
    [
        ("forc=kN", "did you mean 'force'?"),
        ("force=mm", '"mm" does not measure the same as "N"'),
        ("kN", 'must be "force=kN,length=mm"'),
        ("force", 'must be "force=kN,length=mm"'),
        ("force=kN, force=N", "must name each dimension once"),
    ],
)
def test_a_wrong_unit_ends_the_command_with_one_sentence(text, message, capsys):
    with pytest.raises(SystemExit):
        main(["run", "yoke_pump", "--units", text])
    told = capsys.readouterr().err
    assert "error: argument --units: " in told
    assert message in told


@pytest.mark.slow
@every("command", ["run", "compare", "drive"])
def test_results_are_those_in_si_by_their_factors(command, capsys):
    """In JSON every number with a unit; the words have the units too."""
    case = "sawframe_2r63" if command == "drive" else "yoke_pump"
    plain, chosen = (json.loads(printed_by([command, case, "--json", *units], capsys)) for units in ([], UNITS))
    found = list(_pairs(plain, chosen))
    assert {unit for unit, _, _ in found} & {"N m", "W", "N"}
    factors = {
        "N": ("kN", 1e-3),
        "N m": ("kN m", 1e-3),
        "W": ("kW", 1e-3),
        "m": ("mm", 1e3),
        "rad/s": ("rpm", 9.5492965855),
    }
    for unit, before, after in found:
        shown, factor = factors.get(unit, (unit, 1.0))
        assert after["unit"] == shown
        numbers = {
            key for key, value in before.items() if isinstance(value, float) and "[" not in key and key != "ratio"
        }
        for key in numbers:
            assert after[key] == pytest.approx(factor * before[key], rel=1e-9)
    words = printed_by([command, case, *UNITS], capsys)
    assert "kN m" in words
    assert " W" not in words
    if command == "run":
        drive, of_drive = (variants["variants"]["pumping"]["drive"] for variants in (plain, chosen))
        assert of_drive["mean_power [kW]"] == pytest.approx(1e-3 * drive["mean_power [W]"])


def _pairs(one, other):
    """Dicts with a unit in one result, with those of the other, by their places."""
    if isinstance(one, dict):
        if isinstance(one.get("unit"), str):
            yield one["unit"], one, other
        for key, value in one.items():
            if "[" not in key:
                yield from _pairs(value, other[key])


@pytest.mark.slow
def test_tables_and_pages_have_the_units(tmp_path, capsys):
    pytest.importorskip("jinja2")
    table, page = tmp_path / "x.csv", tmp_path / "x.html"
    printed_by(["run", "yoke_pump", *UNITS, "--csv", table], capsys)
    heads = table.read_text().splitlines()[0]
    assert "[kN]" in heads
    assert "[mm]" in heads
    assert "[N]" not in heads
    printed_by(["plot", "yoke_pump", *UNITS, "--out", tmp_path, "--only", "torque", "--format", "svg"], capsys)
    assert "balancing torque [kN m]" in next(tmp_path.glob("*torque.svg")).read_text()
    printed_by(["report", "yoke_pump", *UNITS, "--out", page], capsys)
    text = page.read_text(encoding="utf-8")
    assert "largest reaction O [kN]" in text
    assert "--units" in text
