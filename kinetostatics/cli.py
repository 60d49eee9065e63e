"""The command line: ``kinetostatics run | compare | plot | precision | sweep CASE``, ``kinetostatics stability``."""

import argparse
import os
import signal
import sys
import threading
from contextlib import contextmanager
from pathlib import Path

from . import __version__
from .errors import CaseError, KinetostaticsError, ParameterError
from .numbers import checks, files

SWEEP_OUTPUTS = ("mean_absolute balancing_torque", "largest O")
"""What a sweep tells unless asked for something else."""
TABLE_ENDINGS = (".csv", ".parquet")
FIGURE_ENDINGS = (".png", ".svg", ".pdf")


DESIGN = 100
"""Bytes that a design takes with its outputs."""


class _Terminated(BaseException):
    """The system asks this process to end."""


def main(arguments=None):
    """Run the command line; returns the exit status.

    0, or 2 for input that cannot be used, 130 if it was interrupted (Ctrl-C), 143 if it was told to end (SIGTERM).
    """
    status, message = 0, ""
    try:
        with _ending_in_order():
            _require_output()
            options = _parser().parse_args(arguments)
            options.command(options)
            sys.stdout.flush()
    except BrokenPipeError:
        pass
    except (KinetostaticsError, OSError) as error:
        status, message = 2, str(error)
    except MemoryError as error:
        status, message = 2, f"there is not enough memory; take fewer crank angles or designs ({error})"
    except KeyboardInterrupt:
        status, message = 130, "interrupted"
    except _Terminated:
        status, message = 143, "terminated"
    if status:
        _tell(f"kinetostatics: {message}")
    _drop_what_cannot_be_written()
    return status


@contextmanager
def _ending_in_order():
    """SIGTERM, like Ctrl-C, ends the block as an error does; only the main thread can see to that."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def terminate(*_):
        raise _Terminated

    before = signal.signal(signal.SIGTERM, terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _require_output():
    """What is printed has somewhere to go, in letters that it has."""
    if sys.stdout is None:
        raise ParameterError("standard output is closed; open it, or send it to /dev/null")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def _drop_what_cannot_be_written():
    """So that the interpreter does not try again when it ends: the pipe is closed, or the disk full."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _parser():
    parser = argparse.ArgumentParser(
        prog="kinetostatics", description="Forces and drive torque of planar slider mechanisms, from a case file."
    )
    parser.add_argument("--version", action="version", version=f"kinetostatics {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    run = _command(commands, "run", _run, "extremes of every force, with the power check")
    run.add_argument("--variant", type=_text, metavar="NAME", help="only this variant")
    run.add_argument("--angles", type=_angles, default=720, metavar="N", help="crank angles over the turn (720)")
    run.add_argument("--csv", type=_text, metavar="FILE", help="write all results, a row for each crank angle")

    compare = _command(commands, "compare", _compare, "dynamic coefficients against the reference variant")
    compare.add_argument("--variant", type=_text, metavar="NAME", help="only this variant against the reference")

    plot = _command(commands, "plot", _plot, "draw the figures of the case")
    plot.add_argument("--out", required=True, type=_text, metavar="DIR", help="folder for the figures")
    plot.add_argument("--format", choices=("png", "svg"), default="png", help="file format (png)")
    plot.add_argument("--only", type=_text, metavar="FIGURE", help="draw this figure only")

    precision = _command(
        commands, "precision", _precision, "every method's time and error against a certified reference"
    )
    precision.add_argument("--out", required=True, type=_text, metavar="DIR", help="folder for the CSV and the chart")
    precision.add_argument(
        "--variant", action="append", type=_text, metavar="NAME", help="only these (one of each kind)"
    )
    precision.add_argument(
        "--quantity", action="append", type=_text, metavar="NAME", help="of these (balancing_torque)"
    )
    precision.add_argument("--angles", type=_angles, default=360, metavar="N", help="crank angles over the turn (360)")

    sweep = _command(commands, "sweep", _sweep, "outputs of many designs, a row for each")
    sweep.add_argument(
        "--vary",
        action="append",
        required=True,
        metavar="PATH=SPREAD",
        help='a parameter and its spread, "spring.stiffness=600..900 kN/m:40"; with --sample also '
        '"spring.stiffness=normal 712 kN/m +- 5 kN/m"',
    )
    sweep.add_argument(
        "--output", action="append", type=_text, metavar="OUTPUT", help='"largest O", "ratio mean_absolute ..."'
    )
    sweep.add_argument("--variant", type=_text, metavar="NAME", help="variant whose parameters vary")
    sweep.add_argument("--reference", type=_text, metavar="NAME", help="variant that ratios refer to")
    sweep.add_argument("--sample", type=_designs, metavar="N", help="N designs of a Latin hypercube in place of a grid")
    sweep.add_argument(
        "--angles", type=_angles, default=360, metavar="N", help="crank angles over the period, 12 at least (360)"
    )
    sweep.add_argument("--workers", type=_count, metavar="N", help="processes (this one, on all its cores)")
    sweep.add_argument(
        "--out", type=_text, metavar="PATH", help="table to write, .csv or .parquet; or a folder to resume from"
    )
    sweep.add_argument("--plot", type=_text, metavar="FILE", help="figure to write, .png or .svg")

    stability = _command(
        commands, "stability", _stability, "every method's error near the places where it hurts", False
    )
    stability.add_argument("--out", required=True, type=_text, metavar="DIR", help="folder for the CSVs and the chart")
    return parser


def _command(commands, name, function, text, of_case=True):
    command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    if of_case:
        command.add_argument(
            "case", type=_text, metavar="CASE", help="a TOML file, or the name of a shipped case: sawframe_2r63"
        )
    command.set_defaults(command=function)
    return command


def _text(text):
    if not text.strip():
        raise argparse.ArgumentTypeError("must not be empty")
    return text


def _count(text, size=None):
    count = int(text) if text.isdecimal() and len(text) < 20 else text
    problem = checks.count("it", count, size=size)
    if problem:
        raise argparse.ArgumentTypeError(problem.removeprefix("it "))
    return count


def _angles(text):
    return _count(text, checks.ANGLE)


def _designs(text):
    return _count(text, DESIGN)


def _run(options):
    import pandas as pd

    from .casefile.case import load_case
    from .results.tables import extremes_frame

    case = load_case(options.case)
    _require_writable(case, "--csv", options.csv, (".csv",))
    names = list(case.variants) if options.variant is None else [options.variant]
    solutions = {name: case.solve(name, options.angles) for name in names}
    print(case.title)
    for name, solution in solutions.items():
        print(f"\n{name}: {solution.mechanism.name}\n")
        _print(extremes_frame(solution))
        print(
            f"\npower balance: the torques by equilibrium and by powers differ by {solution.power_residual:.1e} of the "
            f"largest power that flows ({options.angles} angles)"
        )
    if options.csv:
        frames = [solution.frame().assign(variant=name) for name, solution in solutions.items()]
        table = pd.concat(frames)
        table.insert(0, "variant", table.pop("variant"))
        _write_table(table, options.csv)


def _compare(options):
    from .casefile.case import load_case

    case = load_case(options.case)
    others = [name for name in case.variants if name != case.reference]
    names = others if options.variant is None else [options.variant]
    if not names:
        raise CaseError(case.path, [f"has one variant only, {case.reference}: nothing to compare; use run"])
    for name in names:
        case.variant(name)
    tables = {name: case.comparison_table(name) for name in names}
    special = [
        ("counterweights and shaking force", case.balancing_table(), case.published.balancing),
        ("swing and transmission", case.linkage_table(), case.published.linkage),
    ]
    print(case.title)
    if case.published.note:
        print(f"\n{case.published.note}")
    for heading, table, published in special:
        if table is not None:
            print(f"\n{heading}; published figures in brackets\n")
            _print(_with_published(table, published, case.path))
    for name, table in tables.items():
        print(f"\n{case.reference} / {name}\n")
        _print(table)


def _plot(options):
    from .casefile.case import load_case
    from .views.figures import draw_case

    for path in draw_case(load_case(options.case), options.out, options.format, options.only):
        print(path)


def _precision(options):
    import pandas as pd

    from .casefile.case import load_case
    from .studies import precision
    from .views.charts import precision_page

    case = load_case(options.case)
    quantities = options.quantity or [precision.QUANTITY]
    paths = precision.case_study(
        case,
        options.out,
        variants=options.variant,
        quantities=quantities,
        angles=options.angles,
        progress=_tell,
        page=precision_page,
    )
    print(f"{case.title}\n\nno other method is both faster and nearer than these:\n")
    table = pd.read_csv(paths[0])
    fronts = [precision.front(part) for _, part in table.groupby(["variant", "quantity"], sort=False)]
    shown = ["variant", "quantity", "method", "setting", "value", "time [ns/angle]", "error"]
    _print(pd.concat(fronts)[shown].set_index("variant").astype(object).fillna(""))
    absent = table[table.groupby(["variant", "quantity", "method"])["error"].transform("count") == 0]
    for method, why in dict.fromkeys(zip(absent["method"], absent["not given"], strict=True)):
        print(f"left out: {method}: {why}")
    print(*paths, sep="\n")


def _stability(options):
    import pandas as pd

    from .studies import stability
    from .views.charts import stability_page

    paths = stability.write(options.out, progress=_tell, page=stability_page)
    _print(pd.read_csv(paths[1]).drop(columns=["machine", "versions"]).set_index("place"))
    print(*paths, sep="\n")


def _sweep(options):
    from .casefile.case import load_case
    from .results.reductions import parsed
    from .sweeps import designs
    from .sweeps.sweeps import FAILED, chosen, sweep

    case = load_case(options.case)
    folder = options.out if options.out and not Path(options.out).suffix else None
    _require_writable(case, "--out", None if folder else options.out, TABLE_ENDINGS)
    _require_writable(case, "--plot", options.plot, FIGURE_ENDINGS)
    checks.require("--out", files.unwritable_folder(folder) if folder else None)
    spreads = _spreads(options.vary)
    table = designs.latin_hypercube(spreads, options.sample) if options.sample else designs.grid(spreads)
    varied, _ = chosen(case, options.variant, options.reference)
    wanted = [parsed(text).of(varied) for text in options.output or SWEEP_OUTPUTS]
    outputs = [item.column for item in wanted]
    found = sweep(
        case,
        table,
        wanted,
        variant=options.variant,
        reference=options.reference,
        angles=options.angles,
        workers=options.workers,
        folder=folder,
        progress=sys.stderr is not None and sys.stderr.isatty(),
    )
    failed = found[found[FAILED] != ""]
    print(f"{case.title}: {len(found)} designs, {len(failed)} failed\n")
    _print(found[outputs].describe().drop("count").rename_axis("over the designs"))
    first = wanted[0]
    print(f"\nbest five by {first.label(varied)}, {'largest' if first.ratio else 'smallest'} first\n")
    best = found.dropna(subset=[first.column]).sort_values(first.column, ascending=not first.ratio).head(5)
    _print(best.drop(columns=FAILED).rename_axis("design"))
    for reason, count in failed[FAILED].value_counts().head(3).items():
        print(f"\n{count} failed: {reason}")
    if options.out and folder is None:
        _write_table(found, options.out)
    if options.plot:
        from .views.charts import sweep_page

        print(sweep_page(found, list(table.columns), outputs, options.plot))


def _spreads(texts):
    pairs = [_spread(text) for text in texts]
    paths = [path for path, _ in pairs]
    twice = [path for path in dict.fromkeys(paths) if paths.count(path) > 1]
    if twice:
        raise ParameterError(f"--vary: {', '.join(twice)} is given more than once; give each parameter one spread")
    return dict(pairs)


def _spread(text):
    path, equals, spread = text.partition("=")
    if not equals:
        raise ParameterError(f'cannot read {text!r}; write path=spread, "spring.stiffness=600..900 kN/m:40"')
    return path.strip(), spread.strip()


def _require_writable(case, option, path, endings):
    """The file that an option names, if any, can be written, is of these kinds, and no input of the case."""
    if path is not None:
        checks.require(option, files.unwritable(path, inputs=case.files, endings=endings))


def _write_table(table, path):
    with files.written_whole(path) as temporary:
        if path.lower().endswith(".parquet"):
            table.to_parquet(temporary)
        else:
            table.to_csv(temporary, index=False)
    print(f"\nwrote {path}: {len(table)} rows")


def _tell(text):
    if sys.stderr is not None:
        print(text, file=sys.stderr)


def _print(table):
    from tabulate import tabulate

    cells = table.reset_index().map(_cell)
    print(tabulate(cells, headers="keys", showindex=False, disable_numparse=True, colalign=_alignment(table)))


def _with_published(table, published, path):
    """Cells as text, the published figure behind ours in brackets."""
    cells = table.map(_cell).astype(object)
    problems = [checks.choice("published: row", quantity, tuple(cells.index)) for quantity in published] + [
        checks.choice(f"published: column of {quantity!r}", column, tuple(cells.columns))
        for quantity, entries in published.items()
        for column in entries
    ]
    if any(problems):
        raise CaseError(path, [problem for problem in problems if problem])
    for quantity, entries in published.items():
        for column, printed in entries.items():
            cells.loc[quantity, column] += f" ({printed})"
    return cells


def _alignment(table):
    return ["left", *("left" if name in ("unit", "published") else "right" for name in table.columns)]


def _cell(value):
    if isinstance(value, str):
        return value
    return "" if value != value else f"{value:.6g}"


if __name__ == "__main__":
    sys.exit(main())
