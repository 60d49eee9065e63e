"""The command ``compare``: dynamic coefficients of the variants of a case, published figures beside ours."""

from ..errors import CaseError
from . import machine
from .printed import print_table, require_writable, say, with_published

RESIDUAL = "power residual"


def compare(options):
    import pandas as pd

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
    tables = {name: case.with_published(comparison.frame()) for name, comparison in found.items()}
    special = {
        "balancing": ("counterweights and shaking force", case.balancing_table(), case.published.balancing),
        "linkage": ("swing and transmission", case.linkage_table(), case.published.linkage),
    }
    special = {key: item for key, item in special.items() if item[1] is not None}
    if machine.wants_json(options):
        _print_json(case, tables, special)
    elif not machine.quiet(options):
        _print(case, tables, {name: comparison.error_bounds() for name, comparison in found.items()}, special)
    if options.csv:
        rows = [_with_roles(case, name, table).reset_index() for name, table in tables.items()]
        machine.give_csv(options, pd.concat(rows))


def _with_roles(case, name, table):
    """Columns of a comparison by what they are, in place of the names of the variants."""
    table = table.set_axis([*table.columns[:1], "reference", "variant", *table.columns[3:]], axis=1)
    table.insert(1, "variant_name", name)
    table.insert(1, "reference_name", case.reference)
    return table


def _print_json(case, tables, special):
    machine.print_json(
        "compare",
        case=machine.of_case(case),
        ratios="reference / variant; above 1 the variant has less",
        variants={
            name: machine.rows(_with_roles(case, name, table).drop(columns=["reference_name", "variant_name"]))
            for name, table in tables.items()
        },
        **{key: {"values": table.to_dict(), "published": published} for key, (_, table, published) in special.items()},
    )


def _print(case, tables, bounds, special):
    from ..results.comparison import left_out

    say(case.title)
    if case.published.note:
        say("\n" + " ".join(case.published.note.split()))
    for heading, table, published in special.values():
        say(f"\n{heading}{'; published figures in brackets' if published else ''}\n")
        print_table(with_published(table, published, case.path))
    if len(tables) == 1:
        ((name, table),) = tables.items()
        say(f"\n{case.reference} / {name}: a ratio above 1 is in favour of {name}, below 1 against it\n")
        more = left_out(table, [case.reference, name])
        _print_known(table.drop(index=[RESIDUAL, *more]), bounds[name])
    else:
        say(f"\nvalues of {case.reference} and of what it is compared with\n")
        values, ratios = _values(case, tables), _ratios(case, tables)
        more = left_out(values, [case.reference, *tables])
        _print_known(values.drop(index=more), _values(case, bounds))
        say(f"\nratios, {case.reference} / each: above 1 is in favour of the variant, below 1 against it\n")
        _print_known(ratios.drop(index=more, errors="ignore"), _ratios(case, bounds))
    if more:
        say(f"\n{len(more)} torque extrema between the smallest and the largest are left out; --csv has them")
    residual = max(float(table.loc[RESIDUAL, list(table.columns[1:3])].max()) for table in tables.values())
    say(f"\npower balance: the torques by equilibrium and by powers differ by {residual:.1e} of the largest power")


def _print_known(table, bounds):
    """A table with the digits that bounds on its numbers leave, which some rows and columns have not."""
    print_table(table, bounds.reindex(index=table.index, columns=table.columns))


def _values(case, tables):
    """Values of the reference and all variants side by side; rows that only some have among the others."""
    import pandas as pd

    both = [table.drop(index=RESIDUAL) for table in tables.values()]
    rows = _in_order([list(table.index) for table in both])
    shared = pd.concat([table.iloc[:, :2] for table in both])
    shared = shared[~shared.index.duplicated()].loc[rows]
    others = {name: table.iloc[:, 2].reindex(rows) for name, table in zip(tables, both, strict=True)}
    return _with_published_column(shared.assign(**others), case.published.value)


def _ratios(case, tables):
    """Ratios to all variants side by side, of what has any."""
    import pandas as pd

    rows = _in_order([list(table.index) for table in tables.values()])
    found = pd.DataFrame({name: table["ratio"].reindex(rows) for name, table in tables.items()}).dropna(how="all")
    return _with_published_column(found.rename_axis("quantity"), case.published.ratio)


def _in_order(lists):
    """Names of all lists, each behind what stands before it in its own."""
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


def _with_published_column(table, published):
    texts = [published.get(row, "") for row in table.index]
    return table.assign(published=texts) if any(texts) else table
