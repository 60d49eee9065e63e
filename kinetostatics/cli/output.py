"""Output of commands: tables and text as wide as the terminal, or numbers in full by ``--json`` and ``--csv``.

With these, standard output contains nothing else. NaN (no value) is null in JSON and empty in CSV; infinity is the text
"Infinity" in JSON.
"""

import json
import math
import shutil
import sys
import textwrap
from collections.abc import Mapping
from pathlib import Path

from ..numbers import checks, files
from ..numbers.formatting import angle, number, parse_heading
from ..numbers.output_units import shown_units
from ..version import __version__

STDOUT = "-"
"""File name for standard output."""
MIN_WIDTH = 40
"""Smallest width of lines, also on narrower terminals."""
GAP = 2
"""Blanks between columns."""
WORD_COLUMNS = ("unit", "published", "limit")
"""Headings of columns whose words may look like numbers."""
MIN_FOLDED_WIDTH = 24
"""Smallest width of a folded column of words."""


def read_case(options):
    """The case of a command; an error if a file of ``--csv`` cannot be written."""
    from ..casefile.case import load_case

    case = load_case(options.case)
    require_writable(case, "--csv", options.csv, (".csv",))
    return case


def require_writable(case, option, path, endings):
    """Refuse a file of an option that cannot be written, has another ending, or is an input of the case."""
    if path not in (None, STDOUT):
        checks.require(option, files.write_problem(path, inputs=case.files, endings=endings))


def write_table(table, path):
    """Write a pandas DataFrame to a file; returns a line to print."""
    with files.write_atomically(path) as temporary:
        if path.lower().endswith(".parquet"):
            table.to_parquet(temporary)
        else:
            table.to_csv(temporary, index=False)
    return f"wrote {path}: {len(table)} rows"


def print_error(text):
    if sys.stderr is not None:
        print(text, file=sys.stderr)


def variant_words(name, options, why):
    """Words on the variant of a command, with the reason for the default."""
    return f"variant {name}" if options.variant else f"variant {name}, {why} (another by --variant)"


def width():
    """Width of a line in letters: of the terminal or by COLUMNS; 80 in a pipe or file."""
    return max(shutil.get_terminal_size((80, 24)).columns, MIN_WIDTH)


def print_folded(text, indent=0):
    """Print paragraphs, one per line, folded to the width with a hanging indent."""
    for line in text.split("\n"):
        print(
            textwrap.fill(line, width(), subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)
        )


def print_table(table, bounds=None):
    """Print a pandas DataFrame; if too wide, with folded headings and words, else in parts one below the other.

    Each part repeats the first columns. `bounds` is a table of the bounds on the errors of the numbers.
    """
    table = shown_units().table(table)
    index = table.index.to_frame(index=False, name=table.index.name or "index")
    columns = [(name, index.iloc[:, at]) for at, name in enumerate(index)]
    for at, name in enumerate(table):
        columns.append((name, table.iloc[:, at], *([] if bounds is None else [bounds.iloc[:, at]])))
    print_columns(*columns)


def print_columns(*columns):
    """Print a table, as `print_table` does, from columns (heading, values[, bounds on their errors])."""
    from tabulate import tabulate

    texts = []
    for heading, values, *bounds in columns:
        errors = bounds[0] if bounds else [0.0] * len(values)
        texts.append((str(heading), [cell_text(*pair, str(heading)) for pair in zip(values, errors, strict=True)]))
    for place, part in enumerate(_parts(texts, width())):
        rules = ["-" * _widest([heading, *cells]) for heading, cells in part]
        rows = [[heading for heading, _ in part], rules, *zip(*(cells for _, cells in part), strict=True)]
        alignment = ["left" if at == 0 or _of_words(column) else "right" for at, column in enumerate(part)]
        whole = tabulate(rows, tablefmt="plain", disable_numparse=True, colalign=alignment)
        print(("\n" if place else "") + whole)


def cell_text(value, bound=0.0, heading=""):
    """A value as text."""
    return (
        angle(value)
        if parse_heading(heading)[1] == "deg"
        else number(value, bound=0.0 if isinstance(bound, str) else bound)
    )


def _parts(columns, room):
    """Columns (heading, cells) in parts that fit into a line."""
    if _breadth(columns) <= room:
        return [columns]
    for hyphens in (False, True):
        narrow = [(_fold(heading, _widest(cells), hyphens), cells) for heading, cells in columns]
        folded = _fold_words(narrow, room)
        if _breadth(folded) <= room:
            return [folded]
    columns = [(_fold(heading, _widest(cells)), cells) for heading, cells in columns]
    kept = 2 if len(columns) > 2 and columns[1][0] == "unit" else 1
    first, rest = _fold_words(columns[:kept], int(0.45 * room)), _fold_words(columns[kept:], room // 2)
    for count in range(2, len(rest)):
        size = -(-len(rest) // count)
        parts = [[*first, *rest[start : start + size]] for start in range(0, len(rest), size)]
        if max(map(_breadth, parts)) <= room:
            return parts
    return [[*first, column] for column in rest]


def _fold_words(columns, room):
    """Columns with words folded, the widest first, until all fit."""
    columns = list(columns)
    words = [at for at, column in enumerate(columns) if _of_words(column)]
    for at in sorted(words, key=lambda at: -_widest(columns[at][1])):
        texts = [columns[at][0], *columns[at][1]]
        over = _breadth(columns) - room
        if over > 0:
            least = MIN_FOLDED_WIDTH if at == 0 else MIN_FOLDED_WIDTH // 2
            heading, *cells = (_fold(text, max(_widest(texts) - over, least)) for text in texts)
            columns[at] = heading, cells
    return columns


def _breadth(columns):
    return sum(_widest([heading, *cells]) for heading, cells in columns) + GAP * (len(columns) - 1)


def _widest(texts):
    return max((len(line) for text in texts for line in text.split("\n")), default=0)


def _fold(text, room, hyphens=False):
    """Text folded to a width; long words stay whole, or break at hyphens with `hyphens`."""
    return "\n".join(textwrap.wrap(text, max(room, 1), break_long_words=False, break_on_hyphens=hyphens))


def _of_words(column):
    """Whether cells are words: by the heading, or without any number."""
    heading, cells = column
    return heading in WORD_COLUMNS or not any(cell.lstrip("-")[:1].isdecimal() for cell in cells)


def stacked(frames, column):
    """Tables by name as one, with the name in the first column."""
    import pandas as pd

    table = pd.concat([frame.assign(**{column: name}) for name, frame in frames.items()])
    return table[[column, *table.columns.drop(column)]]


def wants_json(options):
    return getattr(options, "json", False)


def wants_csv(options):
    return getattr(options, "csv", None) == STDOUT


def quiet(options):
    """Whether standard output carries JSON or CSV."""
    return wants_json(options) or wants_csv(options)


def announce(options, *lines):
    """Print lines for people."""
    if not quiet(options):
        print(*lines, sep="\n")


def deliver(options, results, words=None, table=None, case=None):
    """Print results according to the options: as one JSON object, as text, or as CSV; functions return each."""
    if wants_json(options):
        of_case = {} if case is None else {"title": case.title, "path": case.path, "reference": case.reference}
        head = {"command": options.word, "version": __version__} | ({"case": of_case} if of_case else {})
        print(json.dumps(_jsonable(head | results()), indent=1, allow_nan=False))
    elif words is not None and not wants_csv(options):
        words()
    if wants_csv(options):
        sys.stdout.write(table().to_csv(index=False))
    elif getattr(options, "csv", None):
        announce(options, "", write_table(table(), options.csv))


def rows_by_name(table):
    """Rows of a pandas DataFrame as dicts, by its index, in the units of the output."""
    table = shown_units().table(table)
    return {str(name): row for name, row in zip(table.index, table.to_dict("records"), strict=True)}


def shows_progress(options):
    """Whether to show progress: standard error is a terminal."""
    return not quiet(options) and sys.stderr is not None and sys.stderr.isatty()


def progress(options, names, label):
    """Yield the names, with a progress bar on a terminal."""
    if not shows_progress(options):
        yield from names
        return
    from tqdm import tqdm

    bar = tqdm(list(names), desc=label, leave=False)
    for name in bar:
        bar.set_postfix_str(str(name))
        yield name


def _jsonable(item):
    """The item with values of JSON types."""
    if isinstance(item, Mapping):
        return {str(key): _jsonable(value) for key, value in item.items()}
    if hasattr(item, "columns"):  # a pandas DataFrame
        return [_jsonable(row) for row in item.to_dict("records")]
    if isinstance(item, list | tuple | set):
        return [_jsonable(value) for value in item]
    if hasattr(item, "tolist"):
        return _jsonable(item.tolist())
    if isinstance(item, float):
        return item if math.isfinite(item) else None if math.isnan(item) else f"{'-' if item < 0 else ''}Infinity"
    return str(item) if isinstance(item, Path) else item
