"""Command ``design``: run the searches of a case, print and write their results."""

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np

from ..casefile.case import load_case
from ..casefile.designs import write_found
from ..casefile.reading import require
from ..design import case_text
from ..design.pareto_front import Front
from ..design.robust import over_spread
from ..errors import CaseError, DesignError
from ..numbers import checks, files
from . import output
from .output import print_error, print_folded, print_table, require_writable

SPREAD_SAMPLES = 2048
"""Number of machines sampled from a spread for the final quantile."""
SAME_END_TOLERANCE = 1e-4
"""Largest relative difference of equal results of searches."""


def design(options):
    case = load_case(options.case)
    if not case.designs:
        raise CaseError(case.path, ["has no [design.NAME] table; add one with a kind, varied numbers and limits"])
    names = list(dict.fromkeys(options.design)) if options.design else list(case.designs)
    require(case.path, *(checks.choice("design", name, tuple(case.designs)) for name in names))
    _require_writable(case, names, options)
    if not output.quiet(options):
        print_folded(case.title)
    found = {}
    for name in names:
        print_error(f"searching for {name}")
        try:
            found[name] = case.designs[name].find(starts=options.starts, progress=output.shows_progress(options))
        except DesignError as error:
            raise DesignError(f"{name}: {error}", error.values) from None
        if not output.quiet(options):
            _print_design(case.designs[name], found[name])
            sys.stdout.flush()
    written = []
    if options.plot:
        from ..views.figures import draw_designs

        written += draw_designs(case, found, options.plot, options.format)
        output.announce(options, "", *written)
    if options.out:
        written.append(write_found(options.out, case, found))
        output.announce(options, "", f"wrote {written[-1]}: {', '.join(found)}")
    output.deliver(
        options,
        lambda: {"found": {name: _as_json(case.designs[name], item) for name, item in found.items()}, "files": written},
        table=lambda: output.stacked(dict(_tables(found)), "design"),
        case=case,
    )


def _tables(found):
    """Tables of results by the name of their design, with the kind of each row."""
    for name, item in found.items():
        front = isinstance(item, Front)
        tables: dict[str, Any] = {"front": item.table} if front else {"output": item.report(), "number": item.numbers()}
        indexed = {kind: table.rename_axis("name").reset_index() for kind, table in tables.items()}
        yield name, output.stacked(indexed, "kind")


def _as_json(item, found):
    """Result of a design for ``--json``."""
    if isinstance(found, Front):
        return {"outputs": found.outputs, "source": item.source, "before": found.before, "front": found.table}
    return {
        "goal": str(found.goal),
        "source": item.source,
        "reference": item.reference,
        "shares": found.shares,
        "outputs": output.rows_by_name(found.report()),
        "numbers": output.rows_by_name(found.numbers()),
        "evaluations": found.evaluations,
        "ends_of_searches": found.starts,
        "bound": found.bound,
        "power_residual": _power_residual(found),
    }


def _power_residual(found):
    """Largest imbalance of powers over the duties of a result."""
    return max(duty.source.solve(720).power_residual for duty in found.duties().values())


def _require_writable(case, names, options):
    """Refuse unusable output files before the long searches."""
    require_writable(case, "--csv", options.csv, (".csv",))
    if options.plot:
        checks.require("--plot", files.folder_write_problem(options.plot))
    if options.out:
        there = f"{options.out} exists already; give another name" if os.path.lexists(options.out) else None
        checks.require("--out", there or files.write_problem(options.out, inputs=case.files, endings=(".toml",)))
        items = [case.designs[name] for name in names]
        pairs = [pair for item in items for pair in item.sources.items()]
        scenes = {name: case.variant(name).scene for source, other in pairs for name in (other, source)}
        made = [pair for item in items for pair in item.variants_of(item.name).items()]
        case_text.tables(Path(options.out), scenes | {name: scenes[source] for name, source in made})


def _print_design(item, found):
    if isinstance(found, Front):
        print_folded(f"\n{item.name}: front of {' and '.join(found.outputs)}, from {', '.join(item.sources)}\n")
        table: Any = found.table
        print_table(table.set_axis(range(1, len(table) + 1)).rename_axis("design"))
        return
    references = ", ".join(dict.fromkeys(item.sources.values()))
    ratios = f"ratios: {references} / design, above 1 in favour of the design"
    print_folded(f"\n{item.name}: {found.goal}, from {', '.join(item.sources)}; {ratios}\n")
    report = found.report()
    gain = "gain per unit"
    binds = report["binds"].map({True: "yes", False: ""})
    print_table(report.assign(binds=binds).rename(columns={"price": gain}))
    print()
    print_table(found.numbers().rename(columns={"price": gain}))
    lines = [f"{found.evaluations} evaluations of all derivatives"]
    if len(found.starts) > 1:
        best = min(found.starts)
        same = sum(np.isfinite(end) and abs(end - best) <= SAME_END_TOLERANCE * abs(best) for end in found.starts)
        lines[0] += f"; {same} of {len(found.starts)} searches gave this result"
    if found.prices:
        lines.append("gain: improvement of the goal if the active limit is relaxed by one unit")
    if np.isfinite(found.bound):
        lines.append(f"under weight the ratio of mean torques of a symmetric cam is at most about {found.bound:.3g}")
    lines.append(f"power balance of the result: {_power_residual(found):.1e} of the largest power")
    if item.spread is not None:  # over more machines than in the search
        goal = item.table.minimise or item.table.maximise
        duties = {name: (found.scene[name], share) for name, share in found.shares.items()} or found.scene
        values = over_spread(duties, goal, item.spread, reference=found.reference, samples=SPREAD_SAMPLES)
        value, share = np.quantile(values, item.spread.quantile), f"{item.spread.quantile:g}"
        lines.append(f"quantile {share} of {goal} over the spread, {SPREAD_SAMPLES} machines: {value:.6g}")
    print_folded("\n" + "\n".join(lines))
