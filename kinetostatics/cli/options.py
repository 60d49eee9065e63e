"""Options of the command line: the parser, its commands, and the types of their arguments."""

import argparse

from ..numbers import checks
from ..numbers.formatting import normalise
from ..numbers.units import to_si
from ..version import __version__
from . import commands
from .output import STDOUT

DESIGN = 100
"""Size of a design with its outputs, bytes."""

EPILOG = (
    "Tables are as wide as the terminal, and 80 letters in a pipe or a file; COLUMNS=160 in the environment makes them "
    "wider. For other programs: --json, and --csv where there is a table, write numbers in full and nothing else."
)
"""End of the help of every command."""


def parser():
    """The parser; ``options.command`` is the function of the command."""
    main = argparse.ArgumentParser(
        prog="kinetostatics",
        description="Forces and drive torque of planar mechanisms, from a case file.",
        epilog=EPILOG,
    )
    main.add_argument("--version", action="version", version=f"kinetostatics {__version__}")
    group = main.add_subparsers(required=True, metavar="COMMAND")

    for add in COMMANDS:
        add(group)
    return main


def _list(group):
    command = _command(group, "list", commands.list_cases, "the shipped cases, with title and variants", False)
    _for_machines(command, "one row for each case", file=False)


def _new(group):
    command = _command(group, "new", commands.new, "write a commented case file to start from", False)
    command.add_argument(
        "name", type=_text, metavar="NAME", help="of the case: NAME.toml is written, never over another"
    )
    command.add_argument(
        "--kind", choices=commands.STARTERS, default=commands.STARTERS[0], help="mechanism (%(default)s)"
    )


def _run(group):
    command = _command(group, "run", commands.run, "extremes of every force, with the power check")
    command.add_argument("--variant", type=_name, metavar="NAME", help="only this variant")
    command.add_argument("--angles", type=_angles, default=720, metavar="N", help="crank angles over the turn (720)")
    command.add_argument(
        "--uncertain",
        action="append",
        type=_name,
        metavar="PATH=SIZE",
        help='also how sure the largest values are: standard uncertainty of a number, "crank_length=0.01 mm", or '
        '"tolerances" for those of the case file; several, each with --uncertain before it',
    )
    _for_machines(command, "all results, a row for each crank angle")


def _compare(group):
    command = _command(group, "compare", commands.compare, "dynamic coefficients against the reference variant")
    command.add_argument("--variant", type=_name, metavar="NAME", help="only this variant against the reference")
    _for_machines(command, "the coefficients, a row for each")


def _explain(group):
    command = _command(group, "explain", commands.explain, "the hand calculation of a quantity at one crank angle")
    command.add_argument("--angle", type=_angle, required=True, metavar="ANGLE", help='crank angle, "39.3 deg"')
    command.add_argument(
        "--quantity",
        type=_name,
        default="balancing_torque",
        metavar="NAME",
        help='or a joint\'s reaction, "O", its magnitude "|O|" (%(default)s)',
    )
    command.add_argument("--variant", type=_name, metavar="NAME", help="of this variant (the reference)")
    command.add_argument("--out", type=_text, metavar="FILE", help="write it, as .html, .tex or .txt")


def _drive(group):
    command = _command(group, "drive", commands.drive, "speed, power and start-up under the motor of the case")
    command.add_argument("--variant", type=_name, metavar="NAME", help="only this variant")
    command.add_argument(
        "--start", type=_angle, default=0.0, metavar="ANGLE", help='crank angle to start from, "90 deg" (0 deg)'
    )
    command.add_argument("--out", type=_text, metavar="DIR", help="folder for a CSV over the turn and the figures")
    _for_machines(command, "the tables, a row for each quantity")


def _plot(group):
    command = _command(group, "plot", commands.plot, "draw the figures of the case")
    command.add_argument("--out", required=True, type=_text, metavar="DIR", help="folder for the figures")
    command.add_argument("--format", choices=("png", "svg"), default="png", help="file format (png)")
    command.add_argument("--only", type=_name, metavar="FIGURE", help="draw this figure only")
    _for_machines(command)


def _report(group):
    command = _command(group, "report", commands.report, "one page with the moving mechanism, figures and tables")
    command.add_argument("--out", required=True, type=_text, metavar="FILE", help="page to write, .html")
    command.add_argument("--variant", type=_name, metavar="NAME", help="only this variant beside the reference")
    command.add_argument("--pdf", type=_text, metavar="FILE", help="print it to a PDF too, by a browser that is there")


def _precision(group):
    command = _command(
        group, "precision", commands.precision, "every method's time and error against a certified reference"
    )
    command.add_argument("--out", required=True, type=_text, metavar="DIR", help="folder for the CSV and the chart")
    command.add_argument("--variant", action="append", type=_name, metavar="NAME", help="only these (one of each kind)")
    command.add_argument("--quantity", action="append", type=_name, metavar="NAME", help="of these (balancing_torque)")
    command.add_argument("--angles", type=_angles, default=360, metavar="N", help="crank angles over the turn (360)")
    _for_machines(command)


def _sweep(group):
    command = _command(group, "sweep", commands.sweep, "outputs of many designs, a row for each")
    command.add_argument(
        "--vary",
        action="append",
        required=True,
        type=_name,
        metavar="PATH=SPREAD",
        help='a parameter and its spread, "spring.stiffness=600..900 kN/m:40"; with --sample also '
        '"spring.stiffness=normal 712 kN/m +- 5 kN/m"',
    )
    command.add_argument(
        "--output", action="append", type=_name, metavar="OUTPUT", help='"largest O", "ratio mean_absolute ..."'
    )
    command.add_argument(
        "--variant",
        type=_name,
        metavar="NAME",
        help="whose parameters vary (the first besides the reference, which is what ratios refer to)",
    )
    command.add_argument("--reference", type=_name, metavar="NAME", help="what ratios refer to (the reference)")
    command.add_argument(
        "--sample", type=_designs, metavar="N", help="N designs of a Latin hypercube in place of a grid"
    )
    command.add_argument(
        "--angles", type=_angles, default=360, metavar="N", help="crank angles over the period, 12 at least (360)"
    )
    command.add_argument("--workers", type=_count, metavar="N", help="processes (this one, on all its cores)")
    command.add_argument(
        "--out", type=_text, metavar="PATH", help="table to write, .csv or .parquet; or a folder to resume from"
    )
    command.add_argument("--plot", type=_text, metavar="FILE", help="figure to write, .png or .svg")
    _for_machines(command, "the designs, a row for each")


def _design(group):
    command = _command(
        group, "design", commands.design, "find the machines that the case asks for: its [design] tables"
    )
    command.add_argument("--design", action="append", type=_name, metavar="NAME", help="only these (all)")
    command.add_argument("--starts", type=_count, metavar="N", help="searches for each (as the case says)")
    command.add_argument("--out", type=_text, metavar="FILE", help="case file to write with what is found, .toml")
    command.add_argument("--plot", type=_text, metavar="DIR", help="folder for the figures")
    command.add_argument("--format", choices=("png", "svg"), default="png", help="of the figures (png)")
    _for_machines(command, "what was found, a row for each number")


def _stability(group):
    command = _command(
        group, "stability", commands.stability, "every method's error near the places where it hurts", False
    )
    command.add_argument("--out", required=True, type=_text, metavar="DIR", help="folder for the CSVs and the chart")
    _for_machines(command)


COMMANDS = (_list, _new, _run, _compare, _explain, _drive, _plot, _report, _precision, _sweep, _design, _stability)


def _command(group, name, function, text, of_case=True):
    command = group.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.", epilog=EPILOG)
    if of_case:
        command.add_argument(
            "case", type=_text, metavar="CASE", help="a TOML file, or the name of a shipped case: sawframe_2r63"
        )
    command.set_defaults(command=function)
    return command


def _for_machines(command, table=None, file=True):
    """Add the options ``--json`` and, with a table, ``--csv``."""
    command.add_argument("--json", action="store_true", help="results as JSON in place of tables, numbers in full")
    if table is not None:
        text = f"{table}, as CSV to FILE{', or in place of tables without one' if file else ''}"
        if file:
            command.add_argument("--csv", nargs="?", const=STDOUT, type=_text, metavar="FILE", help=text)
        else:
            command.add_argument("--csv", action="store_const", const=STDOUT, help=f"{table}, as CSV")


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


def _angles(text):
    return _count(text, checks.BYTES_PER_ANGLE)


def _angle(text):
    try:
        return to_si(text, "rad")
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _designs(text):
    return _count(text, DESIGN)
