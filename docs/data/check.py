"""Check results against the reference data, with nothing but Python's own library.

``python check.py FOLDER RESULTS.csv`` compares a table of results, headed as reactions.csv is, with a folder of it.
``python check.py`` looks over all folders; ``python check.py --prove`` proves that results made wrong on purpose, one
number at a time, are found.
"""

import argparse
import csv
import json
import math
import sys
from decimal import Decimal
from pathlib import Path

HERE = Path(__file__).resolve().parent
RELATIVE = 1e-9
"""Difference allowed beyond the bound, relative to the largest magnitude of the reaction over the crank angles."""
ANGLE = "crank_angle [rad]"
FEWEST = 17
"""Significant digits of a value that is no shorter number."""


def folders():
    """All folders of the data."""
    return sorted(path.parent for path in HERE.glob("*/*/case.json"))


def read(path):
    """Table of a CSV: texts by heading."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    return {name: [row[place] if place < len(row) else "" for row in rows] for place, name in enumerate(names)}


def case(folder):
    """What a folder says of its machine."""
    return json.loads((Path(folder) / "case.json").read_text(encoding="utf-8"))


def heading(column, unit):
    """Heading of a column."""
    return f"{column} [{unit}]"


def columns(described):
    """Headings of the values of each reaction, by its name."""
    return {
        name: [heading(column, item["unit"]) for column in item["columns"]]
        for name, item in described["reactions"].items()
    }


def bound_of(name):
    """Heading of the bound of a value."""
    column, unit = name.removesuffix("]").rsplit(" [", 1)
    return heading(f"{column} bound", unit)


def scales(described, table):
    """Largest magnitude of each reaction over the crank angles; where it is zero throughout, that of its unit."""
    named, sizes, largest = columns(described), {}, {}
    for name, names in named.items():
        rows = zip(*(table[column] for column in names), strict=True)
        sizes[name] = max(math.hypot(*map(float, row)) for row in rows)
        unit = described["reactions"][name]["unit"]
        largest[unit] = max(largest.get(unit, 0.0), sizes[name])
    return {name: size or largest[described["reactions"][name]["unit"]] for name, size in sizes.items()}


def problems(folder, results, relative=RELATIVE):
    """What is wrong with a table of results, as sentences; empty if it agrees."""
    described, wanted = case(folder), read(Path(folder) / "reactions.csv")
    found = read(results) if isinstance(results, str | Path) else results
    named = columns(described)
    values = [ANGLE, *(name for names in named.values() for name in names)]
    missing = [name for name in values if name not in found]
    extra = [name for name in found if name not in wanted]
    if missing or extra:
        yield from (f"there is no column {name!r}" for name in missing)
        yield from (f"column {name!r} is not known here" for name in extra)
        return
    count = len(wanted[ANGLE])
    if any(len(found[name]) != count for name in values):
        yield f"there must be {count} rows"
        return
    for row in range(count):
        if _number(found[ANGLE][row]) != float(wanted[ANGLE][row]):
            yield f"row {row + 1}: crank angle {found[ANGLE][row]!r} must be {wanted[ANGLE][row]}"
    for name, size in scales(described, wanted).items():
        allowed, names = relative * size, named[name]
        for column in names:
            for row in range(count):
                value, bound = float(wanted[column][row]), float(wanted[bound_of(column)][row])
                got = _number(found[column][row])
                if not abs(got - value) <= allowed + bound:
                    yield f"row {row + 1}, {column}: {found[column][row]!r} must be {value!r} to {allowed + bound:.2g}"


def _number(text):
    """A number, NaN where it is none."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def _finite(text):
    return math.isfinite(_number(text))


def faults(folder):
    """What is wrong with a folder of the data itself, as sentences."""
    described, table = case(folder), read(Path(folder) / "reactions.csv")
    named = columns(described)
    values = [name for names in named.values() for name in names]
    if [ANGLE, *(part for name in values for part in (name, bound_of(name)))] != list(table):
        yield "the headings are not those of case.json"
        return
    for item in described["reactions"].values():
        if not {"acts_on", "from", "unit", "text"} <= item.keys():
            yield f"{item} does not tell what it acts on"
    finite = all(_finite(text) for name in table for text in table[name])
    if not finite:
        yield "there is a value that is no number"
        return
    sizes = scales(described, table)
    for reaction, name in ((reaction, name) for reaction, names in named.items() for name in names):
        for text, bound in zip(table[name], table[bound_of(name)], strict=True):
            if not 0.0 <= float(bound) <= 1e-15 * sizes[reaction]:
                yield f"{name}: {text} +- {bound} is no certified value"
            digits = len(Decimal(text).as_tuple().digits)
            if digits < FEWEST and float(text) != 0.0:
                yield f"{name}: {text} has {digits} digits of {FEWEST}"
    for across, guide in _guides(described):
        x, y = next(pair for key, pair in guide.items() if key.startswith("direction"))
        for row in range(len(table[ANGLE])):
            force = [float(table[name][row]) for name in named[across]]
            if abs(force[0] * x + force[1] * y) > 1e-14 * max(1e-300, math.hypot(*force)):
                yield f"{across}: row {row + 1} is not across the guide, though nothing rubs"


def _guides(described):
    """Name of the reaction, and guide, of each slider."""
    for group in described["groups"]:
        if group.get("guide") and f"guide{group['label']}" in described["reactions"]:
            yield f"guide{group['label']}", group["guide"]


def wrongs(folder):
    """Tables made wrong on purpose, by what was done."""
    described, table = case(folder), read(Path(folder) / "reactions.csv")
    named, count = columns(described), len(table[ANGLE])
    size = scales(described, table)
    for name, names in named.items():
        for place, column in enumerate(names):
            row = (7 * place + len(name)) % count
            off = float(table[column][row]) + 3.0 * RELATIVE * size[name]
            yield f"{column}: off by {3 * RELATIVE:g}", _with(table, column, row, repr(off))
            yield f"{column}: no number", _with(table, column, row, "nan")
            yield f"{column}: empty", _with(table, column, row, "")
            yield f"{column}: left out", {key: texts for key, texts in table.items() if key != column}
            unit = described["reactions"][name]["unit"]
            other = {key.replace(f"{column}", column.replace(f"[{unit}]", f"[k{unit}]")): table[key] for key in table}
            yield f"{column}: in another unit", other
        if any(float(text) for column in names for text in table[column]):
            turned = {
                key: [_negative(text) for text in texts] if key in names else texts for key, texts in table.items()
            }
            yield f"{name}: from the other body", turned
    yield "a row is missing", {key: texts[:-1] for key, texts in table.items()}
    yield "rows in another order", {key: texts[::-1] if key != ANGLE else texts for key, texts in table.items()}
    yield "crank angles in degrees", table | {ANGLE: [repr(math.degrees(float(text))) for text in table[ANGLE]]}
    yield "a column too much", table | {"O.z [N]": ["0"] * count}


def _with(table, column, row, text):
    return table | {column: [text if place == row else own for place, own in enumerate(table[column])]}


def _negative(text):
    return repr(-float(text))


def proven(folder):
    """What of the wrong tables of a folder is not found, and whether the right one is, as sentences."""
    if found := list(problems(folder, Path(folder) / "reactions.csv")):
        yield f"the data itself is refused: {found[0]}"
    for done, table in wrongs(folder):
        if next(iter(problems(folder, table)), None) is None:
            yield f"{done}: not found"


def main():
    """Check what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", help="of the data, such as machines/slider-1")
    parser.add_argument("results", nargs="?", help="table of results, headed as reactions.csv")
    parser.add_argument("--relative", type=float, default=RELATIVE, help=f"difference allowed (default {RELATIVE:g})")
    parser.add_argument("--prove", action="store_true", help="prove that wrong results are found")
    given = parser.parse_args()
    if given.folder and given.results:
        folder = Path(given.folder) if Path(given.folder).is_dir() else HERE / given.folder
        told = list(problems(folder, given.results, given.relative))
    else:
        look = proven if given.prove else faults
        chosen = [HERE / given.folder] if given.folder else folders()
        told = [f"{folder.relative_to(HERE)}: {text}" for folder in chosen for text in look(folder)]
    print("\n".join(told) or "all is right")
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
