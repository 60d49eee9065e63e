"""Command ``sweep``, outputs of many designs, and ``run --uncertain``, the uncertainty of the largest values."""

import itertools
from collections import Counter
from pathlib import Path

from ..errors import ParameterError
from ..numbers import checks, files, spreads
from ..numbers.formatting import parse_heading, round_bound_up, round_uncertainty_up
from ..numbers.output_units import shown_units
from ..numbers.units import factor, to_si
from ..solution.tables import format_with_uncertainty, largest_with_uncertainty
from . import output
from .output import print_folded, print_table, require_writable, variant_words, write_table

OUTPUTS = ("mean_absolute balancing_torque", "largest O")
"""Default outputs of a sweep."""
FRICTION_OUTPUT = "mean friction_loss"
"""Further default output for a variant with friction."""
TABLE_ENDINGS = (".csv", ".parquet")
FIGURE_ENDINGS = (".png", ".svg", ".pdf")


def sweep(options):
    from ..cycle.reductions import parsed
    from ..sweeps import designs, sweeps

    case = output.read_case(options)
    folder = options.out if options.out and not Path(options.out).suffix else None
    require_writable(case, "--out", None if folder else options.out, TABLE_ENDINGS)
    require_writable(case, "--plot", options.plot, FIGURE_ENDINGS)
    checks.require("--out", files.folder_write_problem(folder) if folder else None)
    pairs = list(_pairs(options.vary, "cannot read", 'path=spread, "spring.stiffness=600..900 kN/m:40"'))
    twice = [path for path, count in Counter(path for path, _ in pairs).items() if count > 1]
    if twice:
        raise ParameterError(f"--vary: {', '.join(twice)} is given more than once; give each parameter one spread")
    spreads = dict(pairs)
    table = designs.latin_hypercube(spreads, options.sample) if options.sample else designs.grid(spreads)
    names = case.names_of(options.variant, options.reference)
    varied = case.variant(names[0])
    usual = (*OUTPUTS, FRICTION_OUTPUT) if varied.friction else OUTPUTS
    wanted = [parsed(text, case.sizing).of(varied) for text in options.output or usual]
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
        progress=output.shows_progress(options),
    )
    written: dict[str | Path, str] = {}
    if options.out and folder is None:
        written[options.out] = f"\n{write_table(found, options.out)}"
    if options.plot:
        from ..views.charts import sweep_page

        path = sweep_page(found, list(table.columns), outputs, options.plot, _labels(wanted, varied))
        written[path] = str(path)
    reasons = found[sweeps.FAILED]

    def results():
        sides = dict(zip(("variant", "reference"), names, strict=True))
        return {**sides, "failed": int((reasons != "").sum()), "designs": found, "files": list(written)}

    def words():
        print_folded(f"{case.title}: {_arguments(case, names, wanted, options)}\n")
        _print_sweep(found, wanted, varied)
        print(*written.values(), sep="\n", end="\n" * bool(written))

    output.deliver(options, results, words, lambda: found, case)
    checks.require("sweep", None if (reasons == "").any() else f"all {len(found)} designs failed: {reasons.iloc[0]}")


def _labels(wanted, varied):
    """Labels of outputs on axes, with the names of quantities in other figures."""
    which = {True: ", reference / design", False: ""}
    return {
        item.column: f"{item.label(varied)}{which[item.ratio]} [{parse_heading(item.column)[1]}]" for item in wanted
    }


def _arguments(case, names, wanted, options):
    """Words on the varied variant and the reference of ratios."""
    (varied, reference), besides = names, options.reference or case.reference
    why = "the reference" if varied == besides else f"the first besides the reference {besides}"
    against = f"; ratios refer to {reference}" if any(item.ratio for item in wanted) else ""
    return variant_words(varied, options, why) + against


def _print_sweep(found, wanted, varied):
    """Spread of the outputs, the best designs by the first, and why others failed."""
    from ..sweeps.sweeps import FAILED

    failed, outputs, first = found[found[FAILED] != ""], [item.column for item in wanted], wanted[0]
    print_folded(f"{len(found)} designs, {len(failed)} failed\n")
    print_table(found[outputs].describe().drop("count").rename_axis("over the designs"))
    words = "largest first: above 1 is in favour of the design" if first.ratio else "smallest first"
    print_folded(f"\nbest five by {first.label(varied)}, {words}\n")
    best = found.dropna(subset=[first.column]).sort_values(first.column, ascending=not first.ratio).head(5)
    print_table(best.drop(columns=FAILED).rename_axis("design"))
    for reason, count in failed[FAILED].value_counts().head(3).items():
        print_folded(f"\n{count} failed: {reason}")


def _pairs(texts, problem, form):
    """Pairs of options as path=text; `problem` begins the error, `form` is the correct form."""
    for text in texts:
        path, equals, told = text.partition("=")
        if not equals:
            raise ParameterError(f"{problem} {text!r}; write {form}")
        yield path.strip(), told.strip()


OF_THE_CASE = "tolerances"
"""Means all [tolerances] of the case file."""
OPTION = "--uncertain"


def standard_uncertainties(case, names, texts):
    """Standard uncertainties in SI by variant and path."""
    units = {name: case.variant(name).scene.units for name in names}
    of_case = OF_THE_CASE in texts
    form = f'path=size, "crank_length=0.01 mm", or "{OF_THE_CASE}" for those of the case file'
    pairs = list(_pairs((text for text in texts if text != OF_THE_CASE), f"{OPTION}: cannot read", form))
    told, counts = dict(pairs), Counter(path for path, _ in pairs)
    problems = [
        f"{case.path} has no [tolerances]" if of_case and not case.tolerances else None,
        *(f"{path} is given more than once" for path in told if counts[path] > 1),
        *(checks.choice("parameter", path, tuple(dict.fromkeys(itertools.chain(*units.values())))) for path in told),
    ]
    tolerances = case.tolerances if of_case else {}
    found: dict[str, dict[str, float]] = {name: {} for name in names}
    for name, known in units.items():
        for path in filter((tolerances | told).__contains__, known):
            try:
                if path in told:
                    found[name][path] = to_si(told[path], known[path])
                    if found[name][path] < 0.0:
                        raise ValueError(f"must not be negative, got {told[path]!r}")
                else:
                    spread = spreads.parse_spread(tolerances[path])
                    found[name][path] = spread.deviation * factor(spread.unit, known[path])
            except ValueError as error:
                problems.append(f"{path} {error}")
    checks.require(OPTION, *dict.fromkeys(problems))
    return found


def print_uncertainty(solution, given):
    """Print the largest values of a solution with their uncertainty."""
    if not given:
        print_folded("\nthis variant has none of the uncertain numbers")
        return
    table = shown_units().table(largest_with_uncertainty(solution, given))
    rounding = table["rounding"].fillna(0.0)
    both = zip(table["largest"], table["tolerance"] + rounding, strict=True)
    columns = {"tolerance": "from tolerances", "rounding": "from rounding"}
    bounds = {
        "tolerance": list(map(round_uncertainty_up, table["tolerance"])),
        "rounding": list(map(round_bound_up, table["rounding"])),
    }
    shown = table.assign(largest=[format_with_uncertainty(*pair) for pair in both], **bounds)
    print()
    two_digits = (0.1 * table[["share [%]"]]).reindex(columns=table.columns)
    print_table(shown.rename(columns=columns), two_digits)
    print_folded(
        f"\nlargest values and their accuracy: standard uncertainty from {', '.join(sorted(given))}, independent and "
        "of first order, plus the proven bound on rounding, rounded up to two digits"
    )
