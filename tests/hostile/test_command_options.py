"""Options and names that cannot be are refused in a line, before any work."""

import pytest

from kinetostatics.cli import main
from support.commands import VARY, refused
from support.every import every

SHORT = {
    "empty case": (["run", ""], "argument CASE: must not be empty"),
    "empty variant": (["run", "saw", "--variant", ""], "argument --variant: must not be empty"),
    "empty csv": (["run", "saw", "--csv", " "], "argument --csv: must not be empty"),
    "empty folder": (["plot", "saw", "--out", ""], "argument --out: must not be empty"),
    "empty figure": (["plot", "saw", "--out", "x", "--only", ""], "argument --only: must not be empty"),
    "empty quantity": (["precision", "saw", "--out", "x", "--quantity", ""], "must not be empty"),
    "empty output": (["sweep", "saw", *VARY, "--output", ""], "argument --output: must not be empty"),
    "empty reference": (["sweep", "saw", *VARY, "--reference", ""], "must not be empty"),
    "empty plot": (["sweep", "saw", *VARY, "--plot", ""], "argument --plot: must not be empty"),
    "no command": ([], "the following arguments are required: COMMAND"),
    "unknown command": (["runn"], "invalid choice: 'runn' (choose from"),
    "unknown option": (["run", "saw", "--angels", "3"], "unrecognized arguments: --angels"),
    "nothing to vary": (["sweep", "saw"], "the following arguments are required: --vary"),
    "other format": (["plot", "saw", "--out", "x", "--format", "bmp"], "invalid choice: 'bmp'"),
    **{
        f"{option} {text!r}": ([command, "saw", *rest, option, text], f"argument {option}: must be ")
        for command, option, rest in (
            ("run", "--angles", []),
            ("sweep", "--angles", VARY),
            ("sweep", "--sample", VARY),
            ("precision", "--angles", ["--out", "x"]),
        )
        for text in ("0", "-1", "1.5", "1e3", "many", "", "nan", "1000000000", "9" * 5000, "1_000", "²")
    },
    **{
        f"--workers {text!r}": (["sweep", "saw", *VARY, "--workers", text], "argument --workers: must be ")
        for text in ("0", "-1", "two", "1.0")
    },
}


@every("name", SHORT)
def test_options_that_cannot_be_are_refused_in_a_line(name, capsys):
    arguments, message = SHORT[name]
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    captured = capsys.readouterr()
    assert caught.value.code == 2
    assert captured.out == ""
    assert message in captured.err.splitlines()[-1]


def test_too_many_angles_name_their_memory(capsys):
    with pytest.raises(SystemExit):
        main(["run", "saw", "--angles", "1000000000"])
    assert "must be at most 10000000, as 1000000000 would take 1000 GB of memory" in capsys.readouterr().err


UNKNOWN = {
    "case": (["run", "no such"], "no such file, and no shipped case of that name"),
    "variant": (["run", "{case}", "--variant", "plan"], "did you mean 'plain'?"),
    "variant to compare": (["compare", "{case}", "--variant", "x"], "variant is 'x', allowed: 'plain', 'cam'"),
    "figure": (["plot", "{case}", "--out", "x", "--only", "torqe"], "did you mean 'torque'?"),
    "variant of precision": (["precision", "{case}", "--out", "x", "--variant", "x"], "variant is 'x'"),
    "variant of a sweep": (["sweep", "{case}", *VARY, "--variant", "x"], "variant is 'x'"),
    "reference of a sweep": (["sweep", "{case}", *VARY, "--reference", "x"], "variant is 'x'"),
    "reduction": (["sweep", "{case}", *VARY, "--output", "larges O"], "did you mean 'largest O'?"),
    "output": (["sweep", "{case}", *VARY, "--output", "O"], "must be a reduction and a quantity"),
    "parameter": (["sweep", "{case}", "--vary", "slider.mas=1..2 kg:2"], "did you mean 'slider.mass'?"),
    "unit": (["sweep", "{case}", "--vary", "slider.mass=1..2 zork:2"], "zork"),
    "spread": (["sweep", "{case}", "--vary", "slider.mass"], "write path=spread"),
    "too many workers": (["sweep", "{case}", *VARY, "--workers", "100000"], "whole number of processes from 1 to"),
}


@pytest.mark.parametrize("name", UNKNOWN)
def test_unknown_names_are_refused_first(saw, idle, name, capsys):
    arguments, message = UNKNOWN[name]
    assert message in refused([text.format(case=saw) for text in arguments], capsys)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["precision", "{case}", "--variant", "plain", "--quantity", "forc"], "quantity is 'forc', allowed: "),
        (["sweep", "{case}", *VARY, "--output", "largest forc"], "quantity is 'forc', allowed: "),
    ],
)
def test_unknown_quantities_write_nothing(saw, arguments, message, capsys):
    out = saw.parent / "out"
    assert message in refused([*(text.format(case=saw) for text in arguments), "--out", out], capsys)
    assert not out.exists()


def test_memory_that_runs_out_is_told_in_a_line(saw, monkeypatch, capsys):
    def solve(*_):
        raise MemoryError("Unable to allocate 8 GiB")

    monkeypatch.setattr("kinetostatics.casefile.case.Case.solve", solve)
    assert "there is not enough memory; take fewer" in refused(["run", saw], capsys)
