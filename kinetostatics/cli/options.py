"""Options of the command line: its commands with their options, the types of these, and the parser."""

import argparse
import textwrap
from functools import partial
from typing import Any

from ..casefile.starters import STARTERS
from ..errors import ParameterError
from ..numbers import checks
from ..numbers.formatting import normalise
from ..numbers.output_units import output_units
from ..numbers.units import to_si
from ..version import __version__
from .output import STDOUT, width

DESIGN = 100
"""Size of a design with its outputs, bytes."""
MAX_PORT = 65535
"""Largest number of a port."""

WIDTH_NOTE = (
    "Tables are as wide as the terminal, and 80 letters in a pipe or a file; COLUMNS=160 in the environment makes them "
    "wider."
)
EXAMPLES = {
    "list": "kinetostatics list",
    "new": "kinetostatics new press --kind four-bar",
    "run": "kinetostatics run sawframe_2r63 --variant cam-circle --shares O",
    "compare": "kinetostatics compare sawframe_2r63 --csv coefficients.csv",
    "explain": 'kinetostatics explain sawframe_2r63 --angle "39.3 deg" --quantity O',
    "drive": 'kinetostatics drive sawframe_2r63 --start "90 deg"',
    "plot": "kinetostatics plot compressor --out figures --format svg",
    "explore": "kinetostatics explore sawframe_2r63",
    "report": "kinetostatics report compressor --out compressor.html",
    "precision": "kinetostatics precision compressor --out precision",
    "sweep": 'kinetostatics sweep sawframe_2r63 --vary "slider.mass=500..700 kg:5" --output "largest O"',
    "design": "kinetostatics design sawframe_2r63 --out found.toml",
    "stability": "kinetostatics stability --out stability",
}
"""A call of each command."""


def _text(text):
    if not text.strip():
        raise argparse.ArgumentTypeError("must not be empty")
    return text


def _name(text):
    """Name in a case file, in the Unicode form of case files."""
    return normalise(_text(text))


def _count(text, size=None):
    count = int(text) if text.isdecimal() and len(text) < 20 else text
    problem = checks.count("it", count, size=size)
    if problem:
        raise argparse.ArgumentTypeError(problem.removeprefix("it "))
    return count


def _port(text):
    if not (text.isascii() and text.isdecimal() and int(text[:9]) <= MAX_PORT):
        raise argparse.ArgumentTypeError(f"must be a whole number from 0 (a free port) to {MAX_PORT}, got {text!r}")
    return int(text)


def _angle(text):
    try:
        return to_si(text, "rad")
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _units(text):
    pairs = [part.partition("=") for part in text.split(",")]
    try:
        if not all(equals for _, equals, _ in pairs):
            raise ParameterError('must be "force=kN,length=mm"')
        chosen = {name.strip(): unit.strip() for name, _, unit in pairs}
        if len(chosen) < len(pairs):
            raise ParameterError("must name each dimension once")
        return output_units(chosen, "units")
    except ParameterError as error:
        raise argparse.ArgumentTypeError(str(error).removeprefix("units: ")) from None


def _option(name, metavar, words, read=_name, **more):
    """Name and settings of an option, as `add_argument` takes them."""
    return name, {"type": read, "metavar": metavar, "help": words, **more}


def _formats(words):
    return "--format", {"choices": ("png", "svg"), "default": "png", "help": words}


def _csv(table):
    return _option(
        "--csv", "FILE", f"{table}, as CSV to FILE, or without FILE instead of tables", _text, nargs="?", const=STDOUT
    )


_angles, _designs = partial(_count, size=checks.BYTES_PER_ANGLE), partial(_count, size=DESIGN)
CASE = _option("case", "CASE", "a TOML file, or the name of a shipped case: sawframe_2r63", _text)
VARIANT = _option("--variant", "NAME", "only this variant")
UNITS = _option("--units", "LIST", 'units of the output, "force=kN,length=mm"; by default SI and degrees', _units)
JSON = "--json", {"action": "store_true", "help": "results as JSON instead of tables, numbers in full"}
COMMANDS: dict[str, tuple[Any, ...]] = {
    "list": (
        ("commands", "list_cases"),
        "the shipped cases, with title and variants",
        JSON,
        ("--csv", {"action": "store_const", "const": STDOUT, "help": "one row for each case, as CSV"}),
    ),
    "new": (
        ("commands", "new"),
        "write a commented case file to start from",
        _option("name", "NAME", "of the case: NAME.toml is written, never over another file", _text),
        ("--kind", {"choices": STARTERS, "default": STARTERS[0], "help": "mechanism (%(default)s)"}),
    ),
    "run": (
        ("commands", "run"),
        "extremes of every force, with the power check",
        CASE,
        VARIANT,
        _option("--angles", "N", "crank angles over the turn (720)", _angles, default=720),
        _option(
            "--uncertain",
            "PATH=SIZE",
            'also the uncertainty of the largest values: that of a number, "crank_length=0.01 mm", or '
            '"tolerances" for those of the case file; repeat --uncertain for several',
            action="append",
        ),
        _option(
            "--shares",
            "NAME",
            'also the shares of a force or torque, "O": inertia and weight of each link, and each load; repeat '
            "--shares for several",
            action="append",
        ),
        UNITS,
        JSON,
        _csv("all results, a row for each crank angle"),
    ),
    "compare": (
        ("commands", "compare"),
        "dynamic coefficients against the reference variant",
        CASE,
        _option("--variant", "NAME", "only this variant against its reference"),
        UNITS,
        JSON,
        _csv("the coefficients, a row for each"),
    ),
    "explain": (
        ("commands", "explain"),
        "the hand calculation of a quantity at one crank angle",
        CASE,
        _option("--angle", "ANGLE", 'crank angle, "39.3 deg"', _angle, required=True),
        _option(
            "--quantity",
            "NAME",
            'or a joint\'s reaction, "O", its magnitude "|O|" (%(default)s)',
            default="balancing_torque",
        ),
        _option("--variant", "NAME", "of this variant (the reference)"),
        _option("--out", "FILE", "write it, as .html, .tex or .txt", _text),
    ),
    "drive": (
        ("commands", "drive"),
        "speed, power and start-up under the motor of the case",
        CASE,
        VARIANT,
        _option("--start", "ANGLE", 'crank angle to start from, "90 deg" (0 deg)', _angle, default=0.0),
        _option("--out", "DIR", "folder for a CSV over the turn and the figures", _text),
        UNITS,
        JSON,
        _csv("the tables, a row for each quantity"),
    ),
    "plot": (
        ("commands", "plot"),
        "draw the figures of the case",
        CASE,
        _option("--out", "DIR", "folder for the figures", _text, required=True),
        _formats("file format (png)"),
        _option("--only", "FIGURE", "draw this figure only"),
        UNITS,
        JSON,
    ),
    "report": (
        ("commands", "report"),
        "one page with the moving mechanism, figures and tables",
        CASE,
        _option("--out", "FILE", "page to write, .html", _text, required=True),
        _option("--variant", "NAME", "only this variant and the reference"),
        _option("--pdf", "FILE", "also a PDF, printed by an installed browser", _text),
        UNITS,
    ),
    "explore": (
        ("commands", "explore"),
        "a page in the browser: the moving mechanism, its forces as you drag",
        (CASE[0], CASE[1] | {"nargs": "?"}),
        _option("--variant", "NAME", "shown first (the first of the case)"),
        ("--new", {"choices": STARTERS, "help": "in place of a case: a mechanism to begin with, whose groups change"}),
        _option("--folder", "DIR", "the only folder into which the page saves (the one you are in)", _text),
        _option("--port", "N", "port of the page, which this machine alone reaches (a free one)", _port, default=0),
        ("--no-browser", {"action": "store_true", "help": "print the address, open no browser"}),
        UNITS,
    ),
    "precision": (
        ("commands", "precision"),
        "every method's time and error against a certified reference",
        CASE,
        _option("--out", "DIR", "folder for the CSV and the chart", _text, required=True),
        _option("--variant", "NAME", "only these (one of each kind)", action="append"),
        _option("--quantity", "NAME", "of these (balancing_torque)", action="append"),
        _option("--angles", "N", "crank angles over the turn (360)", _angles, default=360),
        JSON,
    ),
    "sweep": (
        ("sweep_commands", "sweep"),
        "outputs of many designs, a row for each",
        CASE,
        _option(
            "--vary",
            "PATH=SPREAD",
            'a parameter and its spread, "spring.stiffness=600..900 kN/m:40"; with --sample also '
            '"spring.stiffness=normal 712 kN/m +- 5 kN/m"',
            action="append",
            required=True,
        ),
        _option("--output", "OUTPUT", '"largest O", "ratio mean_absolute ..."', action="append"),
        _option("--variant", "NAME", "variant with the parameters (the first besides the reference of the case)"),
        _option("--reference", "NAME", "reference of ratios (the variant's reference)"),
        _option("--sample", "N", "N designs of a Latin hypercube instead of a grid", _designs),
        _option("--angles", "N", "crank angles over the period, 12 at least (360)", _angles, default=360),
        _option("--workers", "N", "processes (this one, on all its cores)", _count),
        _option("--out", "PATH", "table to write, .csv or .parquet; or a folder to resume from", _text),
        _option("--plot", "FILE", "figure to write, .png or .svg", _text),
        JSON,
        _csv("the designs, a row for each"),
    ),
    "design": (
        ("design", "design"),
        "find the machines of the [design] tables of the case",
        CASE,
        _option("--design", "NAME", "only these (all)", action="append"),
        _option("--starts", "N", "searches for each (as in the case)", _count),
        _option("--out", "FILE", "case file to write with the results, .toml", _text),
        _option("--plot", "DIR", "folder for the figures", _text),
        _formats("of the figures (png)"),
        JSON,
        _csv("the results, a row for each number"),
    ),
    "stability": (
        ("commands", "stability"),
        "every method's error near critical places",
        _option("--out", "DIR", "folder for the CSVs and the chart", _text, required=True),
        JSON,
    ),
}
"""By name: module and function, which are imported when the command runs, a line of help, and the options."""


def _epilog(example, *notes):
    """End of a help: an example, and notes folded to the width of the terminal."""
    return "\n\n".join([f"example:\n  {example}", *(textwrap.fill(note, width()) for note in notes)])


def parser():
    """The parser; ``options.command`` is module and function of the command, ``options.word`` its name."""
    style = argparse.RawDescriptionHelpFormatter
    main = argparse.ArgumentParser(
        prog="kinetostatics",
        description="Forces and drive torque of planar mechanisms, from a case file.",
        epilog=_epilog(EXAMPLES["run"], WIDTH_NOTE),
        formatter_class=style,
    )
    main.add_argument("--version", action="version", version=f"kinetostatics {__version__}")
    group = main.add_subparsers(required=True, metavar="COMMAND")
    for name, (function, text, *options) in COMMANDS.items():
        formats = " and ".join(option for option, _ in options if option in ("--json", "--csv"))
        epilog = _epilog(EXAMPLES[name], *([f"For other programs: {formats}, numbers in full."] if formats else []))
        words = f"{text[0].upper()}{text[1:]}."
        command = group.add_parser(name, help=text, description=words, epilog=epilog, formatter_class=style)
        command.set_defaults(command=function, word=name)
        for option, settings in options:
            command.add_argument(option, **settings)
    return main
