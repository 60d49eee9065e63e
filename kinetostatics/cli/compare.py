"""Command ``compare``: dynamic coefficients of the variants of a case, with published figures."""

from math import isnan, nan

from ..errors import CaseError
from . import machine
from .output import print_columns, print_folded, print_table, require_writable, with_published

RESIDUAL = "power residual"


def compare(options):
    from ..casefile.case import load_case
    from ..results.comparison import Comparison

    case = load_case(options.case)
    require_writable(case, "--csv", options.csv, (".csv",))
    others = [name for name in case.variants if name != case.reference]
    names = others if options.variant is None else [options.variant]
    if not names:
        raise CaseError(case.path, [f"has one variant only, {case.reference}: nothing to compare; use run"])
    for name in names:
        case.variant(name)
    reference = case.solve(case.reference)
    found = {
        name: Comparison(reference, case.solve(name), (case.reference, name))
        for name in machine.progress(options, names, "comparing")
    }
    special = {
        "balancing": ("counterweights and shaking force", case.balancing_table(), case.published.balancing),
        "linkage": ("swing and transmission", case.linkage_table(), case.published.linkage),
    }
    special = {key: item for key, item in special.items() if item[1] is not None}
    if machine.wants_json(options):
        _print_json(case, found, special)
    elif not machine.quiet(options):
        _print_comparison(case, found, special)
    if options.csv:
        import pandas as pd

        machine.write_csv(options, pd.concat([_with_roles(case, *item).reset_index() for item in found.items()]))


def _with_roles(case, name, comparison):
    """Table of a comparison with columns "reference" and "variant" in place of the variants' names."""
    table = case.with_published(comparison.frame())
    table = table.set_axis([*table.columns[:1], "reference", "variant", *table.columns[3:]], axis=1)
    table.insert(1, "variant_name", name)
    table.insert(1, "reference_name", case.reference)
    return table


def _print_json(case, found, special):
    machine.print_json(
        "compare",
        case=machine.case_header(case),
        ratios="reference / variant; above 1 the variant has less",
        variants={
            name: machine.rows_by_name(
                _with_roles(case, name, comparison).drop(columns=["reference_name", "variant_name"])
            )
            for name, comparison in found.items()
        },
        **{key: {"values": table.to_dict(), "published": published} for key, (_, table, published) in special.items()},
    )


def _print_comparison(case, found, special):
    from ..results.comparison import left_out

    tables = {name: {row.label: row for row in comparison.rows} for name, comparison in found.items()}
    published = [case.published_of(list(table)) for table in tables.values()]
    print_folded(case.title)
    if case.published.note:
        print_folded("\n" + " ".join(case.published.note.split()))
    for heading, table, figures in special.values():
        print_folded(f"\n{heading}{'; published figures in brackets' if figures else ''}\n")
        print_table(with_published(table, figures, case.path))
    residual = max(max(table[RESIDUAL].pair) for table in tables.values())
    labels = [label for label in _in_order([list(table) for table in tables.values()]) if label != RESIDUAL]
    first = {label: next(table[label] for table in tables.values() if label in table) for label in labels}
    values = {label: [row.pair[0], *_of_all(tables, label, "pair")] for label, row in first.items()}
    bounds = {label: [row.bounds[0], *_of_all(tables, label, "bounds")] for label, row in first.items()}
    ratios = {label: _of_all(tables, label, "ratio") for label in labels}
    bounds_of_ratios = {label: _of_all(tables, label, "bound_of_ratio") for label in labels}
    more = left_out(values)
    shown = [label for label in labels if label not in more]
    heads = ("quantity", shown), ("unit", [first[label].unit for label in shown])
    columns = _columns([case.reference, *tables], shown, values, bounds)
    if len(tables) == 1:
        (name,) = tables
        print_folded(f"\n{case.reference} / {name}: a ratio above 1 is in favour of {name}, below 1 against it\n")
        columns += _columns(["ratio"], shown, ratios, bounds_of_ratios)
        texts = [("published", [published[0].get(label, "") for label in shown])] if published[0] else []
        print_columns(*heads, *columns, *texts)
    else:
        print_folded(f"\nvalues of {case.reference} and of what it is compared with\n")
        print_columns(*heads, *columns, *_published(shown, case.published.value))
        print_folded(f"\nratios, {case.reference} / each: above 1 is in favour of the variant, below 1 against it\n")
        shown = [label for label in shown if not all(map(isnan, ratios[label]))]
        columns = _columns(tables, shown, ratios, bounds_of_ratios)
        print_columns(("quantity", shown), *columns, *_published(shown, case.published.ratio))
    if more:
        print_folded(f"\n{len(more)} torque extrema between the smallest and the largest are left out; --csv has them")
    print_folded(
        f"\npower balance: the torques by equilibrium and by powers differ by {residual:.1e} of the largest power"
    )


def _of_all(tables, label, name):
    """Attribute of a row in each table, of a pair its second value; NaN for tables without the row."""
    found = [getattr(table[label], name) if label in table else nan for table in tables.values()]
    return [item[1] if isinstance(item, tuple) else item for item in found]


def _columns(headings, shown, values, bounds):
    """Columns to print: heading, values and bounds of the shown rows."""
    return [
        (heading, [values[label][at] for label in shown], [bounds[label][at] for label in shown])
        for at, heading in enumerate(headings)
    ]


def _published(shown, figures):
    """Column of published figures, if there are any."""
    texts = [figures.get(label, "") for label in shown]
    return [("published", texts)] if any(texts) else []


def _in_order(lists):
    """Names of all lists, each after its predecessor in its own list."""
    found: list[str] = []
    for names in lists:
        place = 0
        for name in names:
            if name in found:
                place = found.index(name) + 1
            else:
                found.insert(place, name)
                place += 1
    return found
