"""The command ``drive``: speed, power, energy and start-up under the motor of a case."""

from pathlib import Path
from typing import Any

from ..errors import CaseError, DriveError
from ..numbers import checks, files
from . import machine
from .output import of_variants, print_table, require_writable, say, write_table


def drive(options):
    from ..casefile.case import load_case
    from ..drive.savings import energy_table, mistaken_speed, summary
    from ..drive.steady import steady
    from ..drive.transient import start

    case = load_case(options.case)
    checks.require("--out", files.unwritable_folder(options.out) if options.out else None)
    require_writable(case, "--csv", options.csv, (".csv",))
    names = list(case.variants) if options.variant is None else [options.variant]
    driven = {name: variant for name in names if (variant := case.variant(name)).motor is not None}
    if not driven:
        raise CaseError(case.path, [f"has no drive for {', '.join(names)}; give one as [common.drive]"])
    runs: dict[str, Any] = {}
    starts: dict[str, Any] = {}
    reasons: dict[str, str] = {}
    for name in machine.progress(options, driven, "running"):
        variant = driven[name]
        system = variant.scene, variant.motor, variant.flywheel
        try:
            runs[name], starts[name] = steady(*system), None
            starts[name] = start(*system, from_angle=options.start)
        except DriveError as error:
            reasons[name] = str(error)
    for name, run in runs.items():
        if doubt := mistaken_speed(run, driven[name].scene):
            reasons[name] = f"{doubt}\n{reasons[name]}" if name in reasons else doubt
    if not runs:
        raise DriveError("\n".join(f"{name}: {reason}" for name, reason in reasons.items()))
    tables = {"running": summary(runs, starts), "energy_per_turn": energy_table(runs)}
    paths = _written(case, runs, options.out) if options.out else []
    if machine.wants_json(options):
        found = {key: machine.rows(table) for key, table in tables.items()}
        machine.print_json("drive", case=machine.of_case(case), **found, reasons=reasons, files=paths)
    elif not machine.quiet(options):
        _print(case, tables, reasons, paths)
    if options.csv:
        machine.give_csv(options, _as_rows(tables))


def _print(case, tables, reasons, paths):
    say(f"{case.title}\n\nin periodic running under the motor of the case\n")
    print_table(tables["running"].rename_axis("over the period"))
    print("\nwhere the energy of a turn goes\n")
    print_table(tables["energy_per_turn"].rename_axis("energy per turn"))
    for name, reason in reasons.items():
        say(f"\n{name}: {reason}")
    if paths:
        print("", *(f"wrote {path}" for path in paths), sep="\n")


def _as_rows(tables):
    """Both tables as one, a row for each quantity, the table that it is of in the first column."""
    import pandas as pd

    rows = [table.rename_axis("quantity").reset_index().assign(table=name) for name, table in tables.items()]
    whole = pd.concat(rows)
    whole.insert(0, "table", whole.pop("table"))
    return whole


def _written(case, runs, folder):
    """Results over the turn as CSV, and the figures; returns the paths."""
    from ..views.figures import draw_drive

    path = Path(folder) / f"{case.path.stem}_drive.csv"
    write_table(of_variants({name: run.frame() for name, run in runs.items()}), str(path))
    return [path, *draw_drive(case, runs, folder)]
