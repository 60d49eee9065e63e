"""What each command does with its options."""

import os
import sys
from pathlib import Path
from typing import Any

from ..errors import CaseError, DriveError, ParameterError
from ..numbers import checks, files
from .printed import print_table, tell, with_published, write_table

SWEEP_OUTPUTS = ("mean_absolute balancing_torque", "largest O")
"""What a sweep tells unless asked for something else."""
LOST = "mean friction_loss"
"""What it tells besides of a variant with friction."""
TABLE_ENDINGS = (".csv", ".parquet")
EXPLANATIONS = {".html": "page", ".tex": "latex", ".txt": "text"}
"""What is written of an explanation, by the ending of its file."""
FIGURE_ENDINGS = (".png", ".svg", ".pdf")


STARTERS = ("crank-slider", "four-bar", "chain")
"""Mechanisms of the case files to start from."""


def list_cases(options):
    from ..casefile.reading import read, shipped_cases

    cases = shipped_cases()
    width = max(map(len, cases))
    for name, path in cases.items():
        _, raw = read(path)
        print(f"{name:{width}}  {raw['title']} ({', '.join(raw['variants'])})")


def new(options):
    from ..casefile.starters import starter

    path = Path(options.name if options.name.lower().endswith(".toml") else f"{options.name}.toml")
    checks.require("new", f"{path} is there already; give another name" if os.path.lexists(path) else None)
    checks.require("new", files.unwritable(path))
    with files.written_whole(path) as temporary:
        Path(temporary).write_text(starter(options.kind, path.stem), encoding="utf-8")
    name = f'"{path}"' if " " in str(path) else path
    print(f"wrote {path}; kinetostatics run {name}")


def run(options):
    import pandas as pd

    from ..casefile.case import load_case
    from ..results.losses import lose
    from ..results.tables import extremes_frame

    case = load_case(options.case)
    _require_writable(case, "--csv", options.csv, (".csv",))
    names = list(case.variants) if options.variant is None else [options.variant]
    solutions = {name: case.solve(name, options.angles) for name in names}
    print(case.title)
    for name, solution in solutions.items():
        print(f"\n{name}: {solution.mechanism.name}\n")
        print_table(extremes_frame(solution))
        print(
            f"\npower balance: the torques by equilibrium and by powers differ by {solution.power_residual:.1e} of the "
            f"largest power that flows ({options.angles} angles)"
        )
        if lose(solution):
            print("\npower lost by friction, exact means over the turn\n")
            print_table(solution.losses.frame())
            print(f"\n{solution.losses}")
    if options.csv:
        frames = [solution.frame().assign(variant=name) for name, solution in solutions.items()]
        table = pd.concat(frames)
        table.insert(0, "variant", table.pop("variant"))
        write_table(table, options.csv)


def compare(options):
    from ..casefile.case import load_case

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
            print_table(with_published(table, published, case.path))
    for name, table in tables.items():
        print(f"\n{case.reference} / {name}\n")
        print_table(table)


def explain(options):
    from ..casefile.case import load_case

    case = load_case(options.case)
    _require_writable(case, "--out", options.out, tuple(EXPLANATIONS))
    variant = case.variant(case.reference if options.variant is None else options.variant)
    told = variant.scene.solve(options.angle).explain(options.quantity, options.angle)
    print(told)
    if options.out:
        written = getattr(told, EXPLANATIONS[Path(options.out).suffix.lower()])
        with files.written_whole(options.out) as temporary:
            Path(temporary).write_text(f"{written}\n", encoding="utf-8")
        print(f"\nwrote {options.out}")


def plot(options):
    from ..casefile.case import load_case
    from ..views.figures import draw_case

    for path in draw_case(load_case(options.case), options.out, options.format, options.only):
        print(path)


def report(options):
    from .reporting import report

    report(options)


def drive(options):
    from ..casefile.case import load_case
    from ..drive.periodic import steady
    from ..drive.summary import energy_table, summary
    from ..drive.transient import start

    case = load_case(options.case)
    checks.require("--out", files.unwritable_folder(options.out) if options.out else None)
    names = list(case.variants) if options.variant is None else [options.variant]
    driven = {name: variant for name in names if (variant := case.variant(name)).motor is not None}
    if not driven:
        raise CaseError(case.path, [f"has no drive for {', '.join(names)}; give one as [common.drive]"])
    runs: dict[str, Any] = {}
    starts: dict[str, Any] = {}
    reasons = []
    for name, variant in driven.items():
        machine = variant.scene, variant.motor, variant.flywheel
        try:
            runs[name], starts[name] = steady(*machine), None
            starts[name] = start(*machine, from_angle=options.start)
        except DriveError as error:
            reasons.append(f"{name}: {error}")
    if not runs:
        raise DriveError("\n".join(reasons))
    print(f"{case.title}\n\nin periodic running under the motor of the case\n")
    print_table(summary(runs, starts).rename_axis("over the period"))
    print("\nwhere the energy of a turn goes\n")
    print_table(energy_table(runs).rename_axis("energy per turn"))
    for reason in reasons:
        print(f"\n{reason}")
    if options.out:
        _write_runs(case, runs, options.out)


def _write_runs(case, runs, folder):
    import pandas as pd

    from ..views.figures import draw_drive

    table = pd.concat([run.frame().assign(variant=name) for name, run in runs.items()])
    table.insert(0, "variant", table.pop("variant"))
    write_table(table, str(Path(folder) / f"{case.path.stem}_drive.csv"))
    print(*draw_drive(case, runs, folder), sep="\n")


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
        progress=tell,
        page=precision_page,
    )
    print(f"{case.title}\n\nno other method is both faster and nearer than these:\n")
    table = pd.read_csv(paths[0])
    fronts = [study.front(part) for _, part in table.groupby(["variant", "quantity"], sort=False)]
    shown = ["variant", "quantity", "method", "setting", "value", "time [ns/angle]", "error"]
    print_table(pd.concat(fronts)[shown].set_index("variant").astype(object).fillna(""))
    absent = table[table.groupby(["variant", "quantity", "method"])["error"].transform("count") == 0]
    for method, why in dict.fromkeys(zip(absent["method"], absent["not given"], strict=True)):
        print(f"left out: {method}: {why}")
    print(*paths, sep="\n")


def stability(options):
    import pandas as pd

    from ..studies import stability as study
    from ..views.charts import stability_page

    paths = study.write(options.out, progress=tell, page=stability_page)
    print_table(pd.read_csv(paths[1]).drop(columns=["machine", "versions"]).set_index("place"))
    print(*paths, sep="\n")


def design(options):
    from .designing import design

    design(options)


def sweep(options):
    from ..casefile.case import load_case
    from ..results.reductions import parsed
    from ..sweeps import designs, sweeps

    case = load_case(options.case)
    folder = options.out if options.out and not Path(options.out).suffix else None
    _require_writable(case, "--out", None if folder else options.out, TABLE_ENDINGS)
    _require_writable(case, "--plot", options.plot, FIGURE_ENDINGS)
    checks.require("--out", files.unwritable_folder(folder) if folder else None)
    spreads = _spreads(options.vary)
    table = designs.latin_hypercube(spreads, options.sample) if options.sample else designs.grid(spreads)
    varied, _ = sweeps.chosen(case, options.variant, options.reference)
    usual = (*SWEEP_OUTPUTS, LOST) if varied.friction else SWEEP_OUTPUTS
    wanted = [parsed(text).of(varied) for text in options.output or usual]
    outputs = [item.column for item in wanted]
    found = sweeps.sweep(
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
    failed = found[found[sweeps.FAILED] != ""]
    print(f"{case.title}: {len(found)} designs, {len(failed)} failed\n")
    print_table(found[outputs].describe().drop("count").rename_axis("over the designs"))
    first = wanted[0]
    print(f"\nbest five by {first.label(varied)}, {'largest' if first.ratio else 'smallest'} first\n")
    best = found.dropna(subset=[first.column]).sort_values(first.column, ascending=not first.ratio).head(5)
    print_table(best.drop(columns=sweeps.FAILED).rename_axis("design"))
    for reason, count in failed[sweeps.FAILED].value_counts().head(3).items():
        print(f"\n{count} failed: {reason}")
    if options.out and folder is None:
        write_table(found, options.out)
    if options.plot:
        from ..views.charts import sweep_page

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
