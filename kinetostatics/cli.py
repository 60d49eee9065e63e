"""The command line: ``kinetostatics run | compare | plot | precision CASE``, ``kinetostatics stability``."""

import argparse
import os
import sys

from .errors import CaseError, KinetostaticsError


def main(arguments=None):
    """Run the command line; returns the exit status: 0, or 2 for input that cannot be used."""
    options = _parser().parse_args(arguments)
    try:
        options.command(options)
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (KinetostaticsError, OSError) as error:
        print(f"kinetostatics: {error}", file=sys.stderr)
        return 2
    return 0


def _parser():
    parser = argparse.ArgumentParser(
        prog="kinetostatics", description="Forces and drive torque of planar slider mechanisms, from a case file."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    run = _command(commands, "run", _run, "extremes of every force, with the power check")
    run.add_argument("--variant", metavar="NAME", help="only this variant")
    run.add_argument("--angles", type=_count, default=720, metavar="N", help="crank angles over the turn (720)")
    run.add_argument("--csv", metavar="FILE", help="write all results, a row for each crank angle")

    compare = _command(commands, "compare", _compare, "dynamic coefficients against the reference variant")
    compare.add_argument("--variant", metavar="NAME", help="only this variant against the reference")

    plot = _command(commands, "plot", _plot, "draw the figures of the case")
    plot.add_argument("--out", required=True, metavar="DIR", help="folder for the figures")
    plot.add_argument("--format", choices=("png", "svg"), default="png", help="file format (png)")
    plot.add_argument("--only", metavar="FIGURE", help="draw this figure only")

    precision = _command(
        commands, "precision", _precision, "every method's time and error against a certified reference"
    )
    precision.add_argument("--out", required=True, metavar="DIR", help="folder for the CSV and the chart")
    precision.add_argument("--variant", action="append", metavar="NAME", help="only these (one of each kind)")
    precision.add_argument("--quantity", action="append", metavar="NAME", help="of these (balancing_torque)")
    precision.add_argument("--angles", type=_count, default=360, metavar="N", help="crank angles over the turn (360)")

    stability = _command(
        commands, "stability", _stability, "every method's error near the places where it hurts", False
    )
    stability.add_argument("--out", required=True, metavar="DIR", help="folder for the CSVs and the chart")
    return parser


def _command(commands, name, function, text, of_case=True):
    command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    if of_case:
        command.add_argument("case", metavar="CASE", help="a TOML file, or the name of a shipped case: sawframe_2r63")
    command.set_defaults(command=function)
    return command


def _count(text):
    count = int(text)
    if count < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, got {count}")
    return count


def _run(options):
    import pandas as pd

    from .case import load_case
    from .files import written_whole
    from .tables import extremes_frame

    case = load_case(options.case)
    names = [options.variant] if options.variant else list(case.variants)
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
        with written_whole(options.csv) as temporary:
            table.to_csv(temporary, index=False)
        print(f"\nwrote {options.csv}: {len(table)} rows")


def _compare(options):
    from .case import load_case

    case = load_case(options.case)
    names = [options.variant] if options.variant else [name for name in case.variants if name != case.reference]
    if not names:
        raise CaseError(case.path, [f"has one variant only, {case.reference}: nothing to compare; use run"])
    tables = {name: case.comparison_table(name) for name in names}
    special = [
        ("counterweights and shaking force", case.balancing_table(), case.published.balancing),
        ("swing and transmission", case.linkage_table(), case.published.linkage),
    ]
    print(case.title)
    for heading, table, published in special:
        if table is not None:
            print(f"\n{heading}; published figures in brackets\n")
            _print(_with_published(table, published))
    for name, table in tables.items():
        print(f"\n{case.reference} / {name}\n")
        _print(table)


def _plot(options):
    from .case import load_case
    from .figures import draw_case

    for path in draw_case(load_case(options.case), options.out, options.format, options.only):
        print(path)


def _precision(options):
    import pandas as pd

    from . import precision
    from .case import load_case

    case = load_case(options.case)
    quantities = options.quantity or [precision.QUANTITY]
    paths = precision.case_study(
        case, options.out, variants=options.variant, quantities=quantities, angles=options.angles, progress=_tell
    )
    print(f"{case.title}\n\nno other method is both faster and nearer than these:\n")
    table = pd.read_csv(paths[0])
    fronts = [precision.front(part) for _, part in table.groupby(["variant", "quantity"], sort=False)]
    shown = ["variant", "quantity", "method", "setting", "value", "time [ns/angle]", "error"]
    _print(pd.concat(fronts)[shown].set_index("variant").fillna(""))
    print(*paths, sep="\n")


def _stability(options):
    import pandas as pd

    from . import stability

    paths = stability.write(options.out, progress=_tell)
    _print(pd.read_csv(paths[1]).drop(columns=["machine", "versions"]).set_index("place"))
    print(*paths, sep="\n")


def _tell(text):
    print(text, file=sys.stderr)


def _print(table):
    from tabulate import tabulate

    cells = table.reset_index().map(_cell)
    print(tabulate(cells, headers="keys", showindex=False, disable_numparse=True, colalign=_alignment(table)))


def _with_published(table, published):
    """Cells as text, the published figure behind ours in brackets."""
    cells = table.map(_cell).astype(object)
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
