"""Tables as the command line prints and writes them."""

import sys

from ..errors import CaseError
from ..numbers import checks, files


def write_table(table, path):
    with files.written_whole(path) as temporary:
        if path.lower().endswith(".parquet"):
            table.to_parquet(temporary)
        else:
            table.to_csv(temporary, index=False)
    print(f"\nwrote {path}: {len(table)} rows")


def tell(text):
    if sys.stderr is not None:
        print(text, file=sys.stderr)


def print_table(table):
    from tabulate import tabulate

    cells = table.reset_index().map(_cell)
    print(tabulate(cells, headers="keys", showindex=False, disable_numparse=True, colalign=_alignment(table)))


def with_published(table, published, path):
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
    return "" if value != value else f"{value + 0.0:.6g}"  # a zero has no sign
