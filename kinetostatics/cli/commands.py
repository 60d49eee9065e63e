"""The commands except sweep and design, which have their own modules.

A command imports its libraries when it runs, so the other commands start fast.
"""

import os
import shlex
import sys
from math import isnan
from pathlib import Path

from ..errors import CaseError, DriveError, ParameterError
from ..numbers import checks, files
from ..numbers.output_units import shown_units
from . import output
from .output import print_columns, print_error, print_folded, print_table, require_writable, variant_words, write_table

EXPLANATIONS = {".html": "page", ".tex": "latex", ".txt": "text"}
"""Attribute of an explanation to write, by the ending of its file."""

CHECK_QUANTITY = "balancing_torque_by_power"
"""Quantity that the table omits, because the power balance shows it."""


def list_cases(options):
    from ..casefile.reading import read_toml, shipped_cases

    raw = {name: (read_toml(path)[1], path) for name, path in shipped_cases().items()}
    cases = [
        {"name": name, "title": case["title"], "variants": list(case["variants"]), "path": str(path)}
        for name, (case, path) in raw.items()
    ]

    def words():
        breadth = max(map(len, raw)) + 2
        for case in cases:
            print_folded(f"{case['name']:{breadth}}{case['title']} ({', '.join(case['variants'])})", breadth)

    def table():
        import pandas as pd

        return pd.DataFrame(cases).assign(variants=[" ".join(case["variants"]) for case in cases])

    output.deliver(options, lambda: {"cases": cases}, words, table)


def new(options):
    from ..casefile.starters import starter

    path = Path(options.name)
    if path.suffix.lower() != ".toml":
        path = Path(f"{options.name}.toml")
        kind = Path(options.name).suffix
        if kind[1:2].isalpha():  # digits after a point are no ending: press 2.5
            raise ParameterError(
                f"new: {options.name} ends in {kind}, a case file in .toml: write "
                f"{Path(options.name).with_suffix('.toml')}, or {path} if this is the name"
            )
    there = f"{path} exists already; give another name" if os.path.lexists(path) else None
    checks.require("new", there or files.write_problem(path))
    with files.write_atomically(path) as temporary:
        Path(temporary).write_text(starter(options.kind, path.stem), encoding="utf-8")
    name = f'"{path}"' if " " in str(path) else path
    print(f"wrote {path}; kinetostatics run {name}")


def run(options):
    from . import sweep_commands

    case = output.read_case(options)
    names = list(case.variants) if options.variant is None else [options.variant]
    given = sweep_commands.standard_uncertainties(case, names, options.uncertain or ())
    solutions = {name: case.solve(name, options.angles) for name in output.progress(options, names, "solving")}
    shares = {name: [s.shares(quantity) for quantity in options.shares or ()] for name, s in solutions.items()}
    output.deliver(
        options,
        lambda: {
            "angles": options.angles,
            "variants": {name: _extremes(solution, given[name], shares[name]) for name, solution in solutions.items()},
            **_parts(case, solutions),
        },
        lambda: _print_extremes(case, solutions, given, shares, options),
        lambda: output.stacked(
            {name: solution.frame(shown_units()) for name, solution in solutions.items()}, "variant"
        ),
        case,
    )


def _extremes(solution, given, shares):
    """Results of a variant for ``--json``."""
    from ..cycle.extremes import SHOWN, extremes_by_name
    from ..cycle.losses import lose
    from ..solution.tables import largest_with_uncertainty

    found = {"mechanism": solution.mechanism.name, "power_residual": solution.power_residual}
    means = {"mean_torque [N m]": solution.mean_torque, "mean_power [W]": solution.mean_power}
    found["drive"] = shown_units().numbers(means | {"energy_per_turn [J]": solution.energy_per_turn})
    rows = {name: row.in_units(shown_units()) for name, row in extremes_by_name(solution).items()}
    found["extremes"] = {
        name: {"label": row.quantity.label, "unit": row.quantity.unit, **dict(zip(SHOWN, row.ends, strict=True))}
        for name, row in rows.items()
    }
    if lose(solution):
        lost = solution.losses
        powers = {"taken [W]": lost.taken, "lost [W]": lost.total, "efficiency": lost.efficiency}
        found["losses"] = shown_units().numbers(powers) | {"at": output.rows_by_name(lost.frame())}
    if given:
        largest = output.rows_by_name(largest_with_uncertainty(solution, given))
        found["uncertainty"] = {"inputs": given, "largest": largest}
    if shares:
        found["shares"] = {one.quantity: output.rows_by_name(one.frame()) for one in shares}
    return found


def _parts(case, solutions):
    """Results of the parts of the case for ``--json``: by variant, part and number; empty without parts."""
    from ..casefile.case import sizing_table

    if not case.sizing:
        return {}
    found = shown_units().table(sizing_table(case.sizing, solutions))
    sizes = {
        name: {
            part: {number: {"value": value, "unit": found.loc[(part, number), "unit"]} for number, value in own.items()}
            for part, own in ((part, found.loc[part][name]) for part in case.sizing)
        }
        for name in solutions
    }
    return {"sizing": sizes, "sizing_notes": found.attrs["notes"]}


def _print_extremes(case, solutions, given, shares, options):
    from ..casefile.case import sizing_table
    from ..cycle.extremes import SHOWN, extremes_by_name
    from ..cycle.losses import lose
    from . import sweep_commands

    print_folded(case.title)
    for name, solution in solutions.items():
        print(f"\n{name}: {solution.mechanism.name}\n")
        found = extremes_by_name(solution)
        del found[CHECK_QUANTITY]
        rows = [row.in_units(shown_units()) for row in found.values()]
        heads = ("quantity", [row.quantity.label for row in rows]), ("unit", [row.quantity.unit for row in rows])
        ends, errors = (
            list(zip(*parts, strict=True)) for parts in zip(*((row.ends, row.errors) for row in rows), strict=True)
        )
        names = [name.removeprefix("smallest ").removeprefix("largest ") for name in SHOWN]
        print_columns(*heads, *zip(names, ends, errors, strict=True))
        drive = (solution.mean_torque, "N m"), (solution.mean_power, "W"), (solution.energy_per_turn, "J")
        torque, power, energy = (shown_units().text(*each) for each in drive)
        print_folded(f"\ndrive, exact means over the period: torque {torque}, power {power}; energy per turn {energy}")
        print_folded(
            f"\npower balance: the torques by equilibrium and by powers differ by {solution.power_residual:.1e} of the "
            f"largest power that flows ({options.angles} angles)"
        )
        if lose(solution):
            print("\npower lost by friction, exact means over the turn\n")
            print_table(solution.losses.frame())
            print_folded(f"\n{solution.losses}")
        for found in shares[name]:
            print(f"\nwho causes the peak: {found.label}\n")
            print_table(found.frame())
            if found.note:
                print_folded(f"\n{found.note}")
        if options.uncertain:
            sweep_commands.print_uncertainty(solution, given[name])
    if case.sizing:
        sizes = sizing_table(case.sizing, solutions)
        for name, part in case.sizing.items():
            print(f"\n{name}: {part.kind}\n")
            print_table(sizes.loc[name])
            for note in sizes.attrs["notes"][name]:
                print_folded(f"\n{note}", indent=2)


def explain(options):
    from ..casefile.case import load_case

    case = load_case(options.case)
    require_writable(case, "--out", options.out, tuple(EXPLANATIONS))
    name = case.reference if options.variant is None else options.variant
    told = case.variant(name).scene.solve(options.angle).explain(options.quantity, options.angle)
    if options.out:
        written = getattr(told, EXPLANATIONS[Path(options.out).suffix.lower()])
        with files.write_atomically(options.out) as temporary:
            Path(temporary).write_text(f"{written}\n", encoding="utf-8")
        print(options.out)
    else:
        print_folded(f"{case.title}: {variant_words(name, options, 'the reference')}\n")
        print(told)


def plot(options):
    from ..casefile.case import load_case
    from ..views.figures import draw_case

    def progress(names):
        return output.progress(options, names, "drawing")

    paths = draw_case(load_case(options.case), options.out, options.format, options.only, progress)
    output.deliver(options, lambda: {"files": paths}, lambda: print(*paths, sep="\n"))


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
    output.deliver(
        options,
        lambda: {"best": pd.concat(fronts.values()), "files": paths},
        lambda: _print_precision(case, table, fronts, paths),
        case=case,
    )


def _print_precision(case, table, fronts, paths):
    print_folded(f"{case.title}\n\nno other method is both faster and more accurate; errors over the largest value:")
    for (variant, _), front in fronts.items():
        print_folded(f"\n{variant}: {front['label'].iloc[0]}\n")
        shown = front.set_index("method")[["setting", "value", "time [ns/angle]", "error"]]
        print_table(shown.astype(object).fillna(""))
    absent = table[table.groupby(["variant", "quantity", "method"])["error"].transform("count") == 0]
    if len(absent):
        print_folded("\nmethods that do not apply:\n")
        reasons = absent[["method", "variant", "not given"]].drop_duplicates(["method", "not given"])
        print_table(reasons.rename(columns={"not given": "does not apply"}).set_index("method"))
    print(*paths, sep="\n")


def stability(options):
    import pandas as pd

    from ..studies import stability as study
    from ..views.charts import stability_page

    paths = study.write(options.out, progress=print_error, page=stability_page)
    table = pd.read_csv(paths[1])
    output.deliver(options, lambda: {"places": table, "files": paths}, lambda: _print_stability(table, paths))


def _print_stability(table, paths):
    print_folded(f"number of the {table['place'].nunique()} places with each behaviour (several are possible):\n")
    counts = table["does"].str.get_dummies(", ").groupby(table["method"], sort=False).sum()
    good = [text for text in ("exact", "as near as the condition allows") if text in counts]
    print_table(counts[[*good, *counts.columns.drop(good)]])
    near = table[table["method"].str.startswith("ours") & ~table["does"].isin(["exact", "does not give it"])]
    if len(near):
        print_folded("\nplaces where our method is not exact:\n")
        print_table(near.set_index("place")[["method", "worst error", "condition there"]])
    print_folded("\nmethod by method at each place:")
    print(*paths, sep="\n")


def report(options):
    from ..views.report.report import report as write

    variant = ["--variant", options.variant] if options.variant else []
    pdf = ["--pdf", options.pdf] if options.pdf else []
    units = ",".join(f"{name}={unit}" for name, unit in shown_units().chosen.items())
    given = [*variant, *pdf, *(["--units", units] if units else [])]
    command = shlex.join(["kinetostatics", "report", options.case, "--out", options.out, *given])
    bar = sys.stderr is not None and sys.stderr.isatty()
    path = write(options.case, options.out, variant=options.variant, pdf=options.pdf, command=command, progress=bar)
    print(f"wrote {path}; open it in a browser")
    if options.pdf:
        print(f"wrote {options.pdf}")


def explore(options):
    from ..views.explore.server import serve

    if (options.case is None) == (options.new is None):
        raise ParameterError("explore: give a case, or --new with a mechanism to begin with")
    checks.require("--folder", files.folder_write_problem(options.folder) if options.folder else None)
    subject = options.case
    if options.new:
        from ..views.explore.groups import template

        subject = template(options.new)
    serve(
        subject,
        options.variant,
        options.folder or ".",
        options.port,
        browser=not options.no_browser,
        tell=lambda address: print(f"{address}\nCtrl-C ends the page", flush=True),
    )


def drive(options):
    from ..casefile.variant import run_under_motors
    from ..drive.savings import energy_table, running_table

    case = output.read_case(options)
    checks.require("--out", files.folder_write_problem(options.out) if options.out else None)
    names = list(case.variants) if options.variant is None else [options.variant]
    driven = {name: variant for name in names if (variant := case.variant(name)).motor is not None}
    if not driven:
        raise CaseError(case.path, [f"has no drive for {', '.join(names)}; give one as [common.drive]"])
    runs, starts, told = run_under_motors(
        driven, options.start, lambda names: output.progress(options, names, "running")
    )
    reasons = {name: "\n".join(texts) for name, texts in told.items()}
    if not runs:
        raise DriveError("\n".join(f"{name}: {reason}" for name, reason in reasons.items()))
    tables = {"running": running_table(runs, starts), "energy_per_turn": energy_table(runs)}
    tables = {name: shown_units().table(table) for name, table in tables.items()}
    paths = []
    if options.out:
        from ..views.figures import draw_drive

        path = Path(options.out) / f"{case.path.stem}_drive.csv"
        write_table(
            output.stacked({name: run.frame(shown_units()) for name, run in runs.items()}, "variant"), str(path)
        )
        paths = [path, *draw_drive(case, runs, options.out)]

    def words():
        print_folded(f"{case.title}\n\nin periodic running under the motor of the case\n")
        print_table(tables["running"].rename_axis("over the period"))
        print("\nenergy balance of a turn\n")
        print_table(tables["energy_per_turn"].rename_axis("energy per turn"))
        for name, reason in reasons.items():
            print_folded(f"\n{name}: {reason}")
        if paths:
            print("", *(f"wrote {path}" for path in paths), sep="\n")

    def table():
        indexed = {name: table.rename_axis("quantity").reset_index() for name, table in tables.items()}
        return output.stacked(indexed, "table")

    found = {key: output.rows_by_name(table) for key, table in tables.items()}
    output.deliver(options, lambda: {**found, "reasons": reasons, "files": paths}, words, table, case)


RESIDUAL = "power residual"


def compare(options):
    from ..cycle.comparison import Comparison
    from ..views.report.tables import special_tables

    case = output.read_case(options)
    one = options.variant
    groups = case.comparisons if one is None else {case.reference_of(one): [one]}
    groups = {reference: names for reference, names in groups.items() if names}
    if not groups:
        raise CaseError(case.path, [f"has one variant only, {case.reference}: nothing to compare; use run"])
    references = {name: reference for reference, names in groups.items() for name in names}
    solved = {reference: case.solve(reference) for reference in groups}
    found = {
        name: Comparison(solved[references[name]], case.solve(name), (references[name], name))
        for name in output.progress(options, references, "comparing")
    }
    special = special_tables(case)

    def results():
        tables = {key: {"values": table.to_dict(), "published": told} for key, (_, table, told) in special.items()}
        rows = {name: _with_roles(case, item).to_dict("index") for name, item in found.items()}
        told = {"ratios": "reference / variant; above 1 the variant has less", "references": references}
        return {**told, "variants": rows, **tables}

    def table():
        rows = {name: _with_roles(case, item).reset_index() for name, item in found.items()}
        whole = output.stacked(rows, "variant_name")
        whole = whole.assign(reference_name=whole["variant_name"].map(references))
        first = ["quantity", "unit", "reference_name"]
        return whole[[*first, *whole.columns.drop(first)]]

    output.deliver(options, results, lambda: _print_comparison(case, found, special), table, case)


def _with_roles(case, comparison):
    """Table of a comparison with columns "reference" and "variant" instead of the variants' names."""
    of_study = comparison.names[0] == case.reference
    table = shown_units().table(comparison.frame(), case.published.value if of_study else ())
    table = case.with_published(table) if of_study else table
    return table.set_axis([*table.columns[:1], "reference", "variant", *table.columns[3:]], axis=1)


def _print_comparison(case, found, special):
    from ..views.report.tables import with_published

    print_folded(case.title)
    if case.published.note:
        print_folded("\n" + " ".join(case.published.note.split()))
    for heading, table, figures in special.values():
        print_folded(f"\n{heading[0].lower()}{heading[1:]}{'; published figures in brackets' if figures else ''}\n")
        print_table(with_published(table.map(output.cell_text), figures, case.path))
    groups: dict[str, dict] = {}
    for name, comparison in found.items():
        groups.setdefault(comparison.names[0], {})[name] = comparison
    residual = max(_print_group(case, reference, group) for reference, group in groups.items())
    print_folded(
        f"\npower balance: the torques by equilibrium and by powers differ by {residual:.1e} of the largest power"
    )


def _print_group(case, reference, found):
    """Print comparisons with one reference; returns the largest power residual."""
    from ..views.report.tables import merged_rows

    of_study = reference == case.reference
    of_values, of_ratios = (case.published.value, case.published.ratio) if of_study else ({}, {})
    rows, omitted = merged_rows(found.values(), of_values)
    published = case.published_of([row.label for row in rows]) if of_study else {}
    residual = max(next(row.numbers for row in rows if row.label == RESIDUAL))
    rows = [row for row in rows if row.label != RESIDUAL]
    columns = [("quantity", [row.label for row in rows]), ("unit", [row.unit for row in rows])]
    columns += _columns([reference, *found], [row.numbers for row in rows], [row.bounds for row in rows])
    ratios = [row for row in rows if len(found) == 1 or not all(map(isnan, row.ratios))]
    columns_of_ratios = _columns(
        found if len(found) > 1 else ["ratio"], [row.ratios for row in ratios], [row.bounds_of_ratios for row in ratios]
    )
    if len(found) == 1:
        (name,) = found
        print_folded(f"\n{reference} / {name}: a ratio above 1 is in favour of {name}, below 1 against it\n")
        print_columns(*columns, *columns_of_ratios, *_published(rows, published))
    else:
        print_folded(f"\nvalues of {reference} and of the variants compared with it\n")
        print_columns(*columns, *_published(rows, of_values))
        print_folded(f"\nratios, {reference} / each: above 1 is in favour of the variant, below 1 against it\n")
        labels = [row.label for row in ratios]
        print_columns(("quantity", labels), *columns_of_ratios, *_published(ratios, of_ratios))
    if omitted:
        print_folded(f"\n{omitted} torque extrema between the smallest and the largest are left out; --csv has them")
    return residual


def _columns(headings, values, bounds):
    """Columns to print, with their headings, from rows of values and bounds."""
    return list(zip(headings, zip(*values, strict=True), zip(*bounds, strict=True), strict=True))


def _published(rows, figures):
    """Column of published figures, if there are any."""
    texts = [figures.get(row.label, "") for row in rows]
    return [("published", texts)] if any(texts) else []
