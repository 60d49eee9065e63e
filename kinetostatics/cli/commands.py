"""Commands list, new, run, explain, drive, plot, report, precision and stability; the others have modules of their own.

A command imports its libraries when it runs, so that the others start fast.
"""

import os
import shlex
import sys
from pathlib import Path
from typing import Any

from ..errors import CaseError, DriveError
from ..numbers import checks, files
from . import machine
from .output import (
    print_columns,
    print_error,
    print_folded,
    print_table,
    require_writable,
    stack_variants,
    variant_words,
    write_table,
)

EXPLANATIONS = {".html": "page", ".tex": "latex", ".txt": "text"}
"""Attribute of an explanation to write, by the ending of its file."""

CHECK_QUANTITY = "balancing_torque_by_power"
"""Quantity that the table omits, for the power balance states it."""
STARTERS = ("crank-slider", "four-bar", "chain")
"""Mechanisms of the case files to start from."""


def list_cases(options):
    from ..casefile.reading import read_toml, shipped_cases

    raw = {name: (read_toml(path)[1], path) for name, path in shipped_cases().items()}
    cases = [
        {"name": name, "title": case["title"], "variants": list(case["variants"]), "path": str(path)}
        for name, (case, path) in raw.items()
    ]
    if machine.wants_json(options):
        machine.print_json("list", cases=cases)
    elif machine.wants_csv(options):
        import pandas as pd

        machine.print_csv(pd.DataFrame(cases).assign(variants=[" ".join(case["variants"]) for case in cases]))
    else:
        breadth = max(map(len, raw)) + 2
        for case in cases:
            print_folded(f"{case['name']:{breadth}}{case['title']} ({', '.join(case['variants'])})", breadth)


def new(options):
    from ..casefile.starters import starter

    path = Path(options.name)
    if path.suffix.lower() != ".toml":
        path = Path(f"{options.name}.toml")
        checks.require("new", _other_ending(Path(options.name), path))
    checks.require("new", f"{path} is there already; give another name" if os.path.lexists(path) else None)
    checks.require("new", files.write_problem(path))
    with files.write_atomically(path) as temporary:
        Path(temporary).write_text(starter(options.kind, path.stem), encoding="utf-8")
    name = f'"{path}"' if " " in str(path) else path
    print(f"wrote {path}; kinetostatics run {name}")


def _other_ending(given, path):
    """Fault of a name with the ending of another kind of file; digits after a point are no ending: press 2.5."""
    kind = given.suffix
    if not kind[1:2].isalpha():
        return None
    return f"{given} ends in {kind}, a case file in .toml: write {given.with_suffix('.toml')}, or {path} if you mean it"


def run(options):
    from ..casefile.case import load_case
    from . import sweep_commands

    case = load_case(options.case)
    require_writable(case, "--csv", options.csv, (".csv",))
    names = list(case.variants) if options.variant is None else [options.variant]
    given = sweep_commands.standard_uncertainties(case, names, options.uncertain or ())
    solutions = {name: case.solve(name, options.angles) for name in machine.progress(options, names, "solving")}
    if machine.wants_json(options):
        found = {name: _run_results(solution, given[name]) for name, solution in solutions.items()}
        machine.print_json("run", case=machine.case_header(case), angles=options.angles, variants=found)
    elif not machine.quiet(options):
        _print_extremes(case, solutions, given, options)
    if options.csv:
        table = stack_variants({name: solution.frame() for name, solution in solutions.items()})
        machine.write_csv(options, table)


def _run_results(solution, given):
    """Results of ``run`` for a variant, by the names of quantities in Python."""
    from ..results.extremes import SHOWN, extremes_by_name
    from ..results.losses import lose
    from ..solution.uncertainty_table import largest_with_uncertainty

    found = {
        name: {"label": row.quantity.label, "unit": row.quantity.unit, **dict(zip(SHOWN, row.ends, strict=True))}
        for name, row in extremes_by_name(solution).items()
    }
    told = {"mechanism": solution.mechanism.name, "power_residual": solution.power_residual, "extremes": found}
    if lose(solution):
        lost = solution.losses
        powers = {"taken [W]": lost.taken, "lost [W]": lost.total, "efficiency": lost.efficiency}
        told["losses"] = powers | {"at": machine.rows_by_name(lost.frame())}
    if given:
        told["uncertainty"] = {
            "inputs": given,
            "largest": machine.rows_by_name(largest_with_uncertainty(solution, given)),
        }
    return told


def _print_extremes(case, solutions, given, options):
    from ..results.extremes import SHOWN, extremes_by_name
    from ..results.losses import lose
    from . import sweep_commands

    print_folded(case.title)
    for name, solution in solutions.items():
        print(f"\n{name}: {solution.mechanism.name}\n")
        found = extremes_by_name(solution)
        del found[CHECK_QUANTITY]
        rows = found.values()
        heads = ("quantity", [row.quantity.label for row in rows]), ("unit", [row.quantity.unit for row in rows])
        ends, errors = (
            list(zip(*parts, strict=True)) for parts in zip(*((row.ends, row.errors) for row in rows), strict=True)
        )
        names = [name.removeprefix("smallest ").removeprefix("largest ") for name in SHOWN]
        print_columns(*heads, *zip(names, ends, errors, strict=True))
        print_folded(
            f"\npower balance: the torques by equilibrium and by powers differ by {solution.power_residual:.1e} of the "
            f"largest power that flows ({options.angles} angles)"
        )
        if lose(solution):
            print("\npower lost by friction, exact means over the turn\n")
            print_table(solution.losses.frame())
            print_folded(f"\n{solution.losses}")
        if options.uncertain:
            sweep_commands.print_uncertainty(solution, given[name])


def explain(options):
    from ..casefile.case import load_case

    case = load_case(options.case)
    require_writable(case, "--out", options.out, tuple(EXPLANATIONS))
    name = case.reference if options.variant is None else options.variant
    told = case.variant(name).scene.solve(options.angle).explain(options.quantity, options.angle)
    print_folded(f"{case.title}: {variant_words(name, options, 'the reference')}\n")
    print(told)
    if options.out:
        written = getattr(told, EXPLANATIONS[Path(options.out).suffix.lower()])
        with files.write_atomically(options.out) as temporary:
            Path(temporary).write_text(f"{written}\n", encoding="utf-8")
        print(f"\nwrote {options.out}")


def plot(options):
    from ..casefile.case import load_case
    from ..views.figures import draw_case

    def progress(names):
        return machine.progress(options, names, "drawing")

    paths = draw_case(load_case(options.case), options.out, options.format, options.only, progress)
    if machine.wants_json(options):
        machine.print_json("plot", files=paths)
    machine.announce(options, *paths)


def precision(options):
    import pandas as pd

    from ..casefile.case import load_case
    from ..studies import precision as study
    from ..views.charts import precision_page

    case = load_case(options.case)
    quantities = options.quantity or [study.QUANTITY]
    paths = study.case_study(
        case,
        options.out,
        variants=options.variant,
        quantities=quantities,
        angles=options.angles,
        progress=print_error,
        page=precision_page,
    )
    table = pd.read_csv(paths[0])
    groups = table.groupby(["variant", "quantity"], sort=False)
    fronts = {names: study.front(part) for names, part in groups}
    if machine.wants_json(options):
        machine.print_json("precision", case=machine.case_header(case), best=pd.concat(fronts.values()), files=paths)
        return
    print_folded(f"{case.title}\n\nno other method is both faster and nearer than these; errors by the largest value:")
    for (variant, _), front in fronts.items():
        print_folded(f"\n{variant}: {front['label'].iloc[0]}\n")
        shown = front.set_index("method")[["setting", "value", "time [ns/angle]", "error"]]
        print_table(shown.astype(object).fillna(""))
    absent = table[table.groupby(["variant", "quantity", "method"])["error"].transform("count") == 0]
    if len(absent):
        print_folded("\nwhat does not apply:\n")
        reasons = absent[["method", "variant", "not given"]].drop_duplicates(["method", "not given"])
        print_table(reasons.rename(columns={"not given": "does not apply"}).set_index("method"))
    print(*paths, sep="\n")


def stability(options):
    import pandas as pd

    from ..studies import stability as study
    from ..views.charts import stability_page

    paths = study.write(options.out, progress=print_error, page=stability_page)
    table = pd.read_csv(paths[1])
    if machine.wants_json(options):
        machine.print_json("stability", places=table, files=paths)
        return
    print_folded(
        f"at how many of the {table['place'].nunique()} places each method does what, several things at some:\n"
    )
    print_table(_counts(table))
    near = table[table["method"].str.startswith("ours") & ~table["does"].isin(["exact", "does not give it"])]
    if len(near):
        print_folded("\nwhere ours is not exact:\n")
        print_table(near.set_index("place")[["method", "worst error", "condition there"]])
    print_folded("\nmethod by method at each place:")
    print(*paths, sep="\n")


def _counts(table):
    """Number of places by method and outcome, good outcomes first."""
    counts = table["does"].str.get_dummies(", ").groupby(table["method"], sort=False).sum()
    good = [text for text in ("exact", "as near as the condition allows") if text in counts]
    return counts[[*good, *counts.columns.drop(good)]]


def compare(options):
    from .compare import compare

    compare(options)


def sweep(options):
    from .sweep_commands import sweep_command

    sweep_command(options)


def design(options):
    from .design import design

    design(options)


def report(options):
    from ..views.report.report import report as write

    variant = ["--variant", options.variant] if options.variant else []
    pdf = ["--pdf", options.pdf] if options.pdf else []
    command = shlex.join(["kinetostatics", "report", options.case, "--out", options.out, *variant, *pdf])
    bar = sys.stderr is not None and sys.stderr.isatty()
    path = write(options.case, options.out, variant=options.variant, pdf=options.pdf, command=command, progress=bar)
    print(f"wrote {path}; open it in a browser")
    if options.pdf:
        print(f"wrote {options.pdf}")


def drive(options):
    from ..casefile.case import load_case
    from ..drive.savings import energy_table, running_table, speed_hint
    from ..drive.steady_running import steady
    from ..drive.transient import start

    case = load_case(options.case)
    checks.require("--out", files.folder_write_problem(options.out) if options.out else None)
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
        if doubt := speed_hint(run, driven[name].scene):
            reasons[name] = f"{doubt}\n{reasons[name]}" if name in reasons else doubt
    if not runs:
        raise DriveError("\n".join(f"{name}: {reason}" for name, reason in reasons.items()))
    tables = {"running": running_table(runs, starts), "energy_per_turn": energy_table(runs)}
    paths = _write_results(case, runs, options.out) if options.out else []
    if machine.wants_json(options):
        found = {key: machine.rows_by_name(table) for key, table in tables.items()}
        machine.print_json("drive", case=machine.case_header(case), **found, reasons=reasons, files=paths)
    elif not machine.quiet(options):
        _print_drive(case, tables, reasons, paths)
    if options.csv:
        machine.write_csv(options, _drive_rows(tables))


def _print_drive(case, tables, reasons, paths):
    print_folded(f"{case.title}\n\nin periodic running under the motor of the case\n")
    print_table(tables["running"].rename_axis("over the period"))
    print("\nwhere the energy of a turn goes\n")
    print_table(tables["energy_per_turn"].rename_axis("energy per turn"))
    for name, reason in reasons.items():
        print_folded(f"\n{name}: {reason}")
    if paths:
        print("", *(f"wrote {path}" for path in paths), sep="\n")


def _drive_rows(tables):
    """Both tables as one, a row for each quantity, with the name of the table in the first column."""
    import pandas as pd

    rows = [table.rename_axis("quantity").reset_index().assign(table=name) for name, table in tables.items()]
    whole = pd.concat(rows)
    whole.insert(0, "table", whole.pop("table"))
    return whole


def _write_results(case, runs, folder):
    """Write results over the turn as CSV, and the figures; returns the paths."""
    from ..views.figures import draw_drive

    path = Path(folder) / f"{case.path.stem}_drive.csv"
    write_table(stack_variants({name: run.frame() for name, run in runs.items()}), str(path))
    return [path, *draw_drive(case, runs, folder)]
