"""Case: a checked case file, its variants and designs; `load_case` reports all faults of a file at once."""

import re
import typing
import warnings
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..cycle.comparison import Comparison
from ..design import linkage
from ..design.counterweights import balancing_table
from ..errors import AssemblyError, ConditionWarning, HintWarning, KinetostaticsError
from ..mechanics import assembly
from ..mechanics.quantities import of_mechanism
from ..numbers import checks
from ..solution import parameters
from ..solution.solution import Solution
from . import build, reading
from .build import PartsError
from .designs import Design, doubtful_tolerances, read_designs, tolerance_problems
from .reading import shipped_cases
from .schema.tables import key_path, validate
from .schema.variants import VARIANTS, CaseTable, PublishedTable
from .variant import NamedItems, Variant, make_variant

__all__ = ["Case", "Variant", "load_case", "shipped_cases"]

EXTREMUM = r"torque extremum [1-9][0-9]?"
"""Row of an extremum between the smallest and the largest torque."""
CAM_FORCE = ("smallest cam force", "largest cam force")
"""Rows of the comparison for variants with a cam only."""


@dataclass(frozen=True, eq=False)
class Case:
    """A case file, read and checked; `load_case` returns it.

    Attributes
    ----------
    title, source : str
    path : Path
    reference : str
        Reference of all variants that do not name their own: `reference_of`.
    variants : mapping of name to Variant
    tolerances : mapping of parameter to text
        Distributions of parameters, for `tolerances`: "normal 712 kN/m +- 5 kN/m".
    designs : mapping of name to Design
        Searches that the file describes; `.find()` runs one.
    sizing : mapping of name to Part
        Parts to be sized, from [sizing.NAME]; `sizing_table()` shows their numbers.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> case = ks.load_case("sawframe_2r63")
    >>> list(case.variants)[:3], case.reference
    (['plain', 'cam-circle', 'cam-cosine'], 'plain')
    >>> round(float(case.compare("plain", "cam-cosine").mean_torque_ratio), 3)
    6.778
    """

    title: str
    source: str
    path: Path
    reference: str
    variants: typing.Mapping[str, Variant]
    published: PublishedTable = field(repr=False)
    tolerances: typing.Mapping[str, str] = field(default_factory=dict)
    designs: typing.Mapping[str, Design] = field(default_factory=dict)
    sizing: typing.Mapping[str, typing.Any] = field(default_factory=dict)

    @property
    def files(self):
        """Paths of the case file and all files it reads, a list."""
        return [self.path, *(path for variant in self.variants.values() for path in variant.files)]

    def variant(self, name) -> Variant:
        """A variant by name."""
        return self.variants[name]

    def reference_of(self, name):
        """Name of the variant that this one is compared with: its own `reference`, or that of the case.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> case = ks.load_case("sawframe_2r63")
        >>> case.reference_of("cam-circle"), case.reference_of("upright-circle")
        ('plain', 'upright-plain')
        """
        return self.variant(name).table.reference or self.reference

    @property
    def comparisons(self):
        """Names of the variants by their reference, a dict of lists; the case's reference comes first.

        A reference without compared variants has an empty list.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> ks.load_case("sawframe_2r63").comparisons["upright-plain"]
        ['upright-circle', 'upright-cosine', 'upright-optimal']
        """
        found: dict[str, list[str]] = {self.reference: []}
        for name in self.variants:
            compared = found.setdefault(self.reference_of(name), [])
            if name != self.reference_of(name):
                compared.append(name)
        return found

    def names_of(self, variant=None, reference=None):
        """Names of the variant that varies (by default the first besides the reference) and of its reference.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> case = ks.load_case("sawframe_2r63")
        >>> case.names_of(), case.names_of("upright-cosine")
        (('cam-circle', 'plain'), ('upright-cosine', 'upright-plain'))
        """
        against = reference or self.reference
        variant = variant or next((name for name in self.variants if name != against), against)
        return variant, reference or self.reference_of(variant)

    def solve(self, name, angles=720) -> Solution:
        """Solution of a variant at a number of even crank angles over the period of its loads, end excluded.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> ks.load_case("sawframe_2r63").solve("plain", 36).balancing_torque.shape
        (36,)
        """
        return self.variant(name).solve(angles)

    def compare(self, reference, balanced) -> Comparison:
        """Dynamic coefficients of one variant against another."""
        return Comparison(self.solve(reference), self.solve(balanced), (reference, balanced))

    def comparison_table(self, balanced, reference=None):
        """Table of dynamic coefficients with a column of published figures, a pandas DataFrame.

        By default the variant is compared with its own reference.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> table = ks.load_case("sawframe_2r63").comparison_table("cam-cosine")
        >>> table.loc["mean |balancing torque|", "published"]
        '6.77 (ratio)'
        """
        own = self.reference_of(balanced)
        reference = own if reference is None else reference
        table = self.compare(reference, balanced).frame()
        return self.with_published(table) if own == reference == self.reference else table

    def with_published(self, table):
        """A table of `Comparison.frame` with a last column of published figures, if there are any.

        They belong to variants compared with the case's reference.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> case = ks.load_case("sawframe_2r63")
        >>> list(case.with_published(case.compare("plain", "cam-cosine").frame()))
        ['unit', 'plain', 'cam-cosine', 'ratio', 'published']
        """
        printed = self.published_of(table.index)
        return table.assign(published=[printed.get(quantity, "") for quantity in table.index]) if printed else table

    def published_of(self, rows):
        """Published figures by row, each with its kind in brackets; `CaseError` for an unknown row."""
        printed = {
            quantity: f"{text} ({column})"
            for column in ("ratio", "value")
            for quantity, text in getattr(self.published, column).items()
        }
        unknown = [name for name in printed if name not in rows and not re.fullmatch(EXTREMUM, name)]
        if unknown:  # rows of any variant are valid
            mechanisms = [variant.mechanism for variant in self.variants.values()]
            known = [item for made in mechanisms for item in of_mechanism(made).values() if item.kind == "reaction"]
            allowed = tuple(dict.fromkeys([*rows, *(f"largest {item.label}" for item in known), *CAM_FORCE]))
            reading.require(self.path, *(checks.choice("published: row", name, allowed) for name in unknown))
        return printed

    def balancing_table(self):
        """Table of counterweights and shaking force of the balanced variants, a pandas DataFrame, or None."""
        found = {
            name: (variant.balanced, variant.solve())
            for name, variant in self.variants.items()
            if variant.balanced is not None
        }
        return balancing_table(self.solve(self.reference), found, self.published.sampling) if found else None

    def sizing_table(self, names=None):
        """Numbers of the parts in SI, a column for each variant; a pandas DataFrame, None without parts.

        The index is part and number. ``attrs["notes"]`` lists for each part points to check, and the reason why it has
        no numbers for a variant; these cells are NaN.

        Parameters
        ----------
        names : sequence of str, optional
            Variants; by default all.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> ks.load_case("pumpjack").sizing_table() is None
        True
        """
        names = list(self.variants) if names is None else names
        return sizing_table(self.sizing, {name: self.solve(name) for name in names}) if self.sizing else None

    def linkage_table(self):
        """Table of swing and transmission of the variants, a pandas DataFrame; None unless all are crank-rockers."""
        if not all(linkage.has_swinging_rocker(variant.mechanism) for variant in self.variants.values()):
            return None
        return linkage.characteristics({name: self.solve(name) for name in self.variants}, self.reference)


def load_case(path) -> Case:
    """Read a case file.

    Parameters
    ----------
    path : str or path
        A TOML file, or the name of a shipped case ("sawframe_2r63"). Write a path with a folder ("./sawframe_2r63") or
        a `pathlib.Path` for a file of that name without ending.

    Returns
    -------
    Case
        The case with the contents of all its files, which are not read again.

    Raises
    ------
    CaseError
        The file is missing, unreadable or wrong; the message lists all faults with their keys.

    Warns
    -----
    HintWarning
        A tolerance is hundreds of times above or below its parameter, or a mass centre or an inertia has probably the
        wrong unit.
    UserWarning
        A sampled cam is noisy, or a file has the same name as the shipped case that is read.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").variants["plain"]
    >>> s = saw.solve(360)
    >>> print(f"{ks.extremes(s, 'O').largest:.0f} N")
    286772 N
    """
    path, raw = reading.read_toml(reading.find_case(path))
    head, problems = validate(CaseTable, raw, lambda keys: keys)
    variants = {}
    tables = raw.get("variants")
    common = raw.get("common", {})
    for name, own in tables.items() if isinstance(tables, dict) else ():
        if isinstance(own, dict) and isinstance(common, dict):
            variants[name] = _read_variant(name, own, common, path.parent, problems)
    reference = raw.get("reference")
    if isinstance(reference, str) and variants and reference not in variants:
        problems.append(checks.choice("reference", reference, tuple(variants)))
    for name, item in variants.items():
        if item is not None and item.table.reference is not None:
            place = key_path(_place(("reference",), name, tables[name], common))
            problems.append(checks.choice(place, item.table.reference, tuple(variants)))
    sizing = _read_parts(head.sizing, variants, problems) if head and head.sizing else {}
    variants = {name: item and replace(item, sizing=sizing) for name, item in variants.items()}
    if head is not None:
        problems += tolerance_problems(head.tolerances, variants)
        designs = read_designs(head.design, head.reference, variants, problems)
    reading.require(path, *dict.fromkeys(problems))
    for doubt in doubtful_tolerances(head.tolerances, variants):
        warnings.warn(HintWarning(path, doubt), stacklevel=2)
    found: dict[str, list[str]] = {}
    for name, item in variants.items():
        for hint in parameters.plausibility_hints(item.scene.unsolved(np.zeros(1))):
            found.setdefault(hint, []).append(f"variants.{name}")
    for hint, places in found.items():
        warnings.warn(HintWarning(path, ", ".join(places), hint), stacklevel=2)
    kept, wanted = NamedItems("variant", path, variants), NamedItems("design", path, designs)
    head_of_case = head.title, head.source, path, head.reference, kept, head.published, head.tolerances, wanted
    return Case(*head_of_case, NamedItems("part", path, sizing))


def _read_parts(tables, variants, problems):
    """Parts by name of the tables in the file; appends their faults to `problems`."""
    from ..sizing.bearings import rollers_of
    from ..sizing.parts import read_part

    mechanisms = [item.mechanism for item in variants.values() if item]
    joints = {name for made in mechanisms for name in (*made.joints, *made.pairs, *rollers_of(made))}
    known = {"link": {name for made in mechanisms for name in made.links}, "joint": joints}
    found: dict[str, typing.Any] = {}
    for name, raw in tables.items():
        part, wrong = read_part(name, raw)
        found |= {} if part is None else {name: part}
        for key, names in known.items():
            if key in raw and mechanisms:
                wrong.append(checks.choice(f".{key}", raw[key], sorted(names)))
        problems += [f"sizing.{name}{problem}" for problem in wrong if problem]
    return found


def sizing_table(parts, solutions):
    """Table of `Case.sizing_table` of parts and solutions by name."""
    import pandas as pd

    found: dict[tuple[str, str, str], float] = {}
    units: dict[tuple[str, str], str] = {}
    notes: dict[str, list[str]] = {key: [] for key in parts}
    for name, solution in solutions.items():
        for key, part in parts.items():
            units |= {(key, number): row.unit for number, row in part.rows.items()}
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", HintWarning)  # the notes say the same
                    sized = part.of(solution)
            except KinetostaticsError as error:
                notes[key].append(f"{name}: {error}")
            else:
                notes[key] += [f"{name}: {note}" for note in sized.notes]
                found |= {(key, number, name): float(getattr(sized, number)) for number in part.rows}
    index = pd.MultiIndex.from_tuples(list(units), names=["part", "number"])
    columns = {name: [found.get((*row, name), np.nan) for row in units] for name in solutions}
    table = pd.DataFrame({"unit": list(units.values()), **columns}, index=index)
    table.attrs["notes"] = notes
    return table


def _place(keys, name, own, common):
    """Keys from the top of the file to those of a variant: its own, or [common]."""
    inherited = reading.has_keys(common, keys) and not reading.has_keys(own, keys)
    return ("common", *keys) if inherited else ("variants", name, *keys)


def _read_variant(name, own, common, folder, problems):
    """The variant, or None; appends its faults to `problems`."""
    merged = reading.inherit(common, own)

    def place(keys):
        return _place(keys, name, own, common)

    kind = merged.get("mechanism", "chain" if "groups" in merged else None)
    if not isinstance(kind, str) or kind not in VARIANTS:
        path, meant = key_path(place(("mechanism",))), checks.nearest(kind, VARIANTS)
        problems.append(f"{path} is missing" if kind is None else checks.choice(path, kind, tuple(VARIANTS)))
        if meant is not None:  # faults of its other keys
            problems += validate(VARIANTS[meant], {**merged, "mechanism": meant}, place)[1]
        return None
    table, found = validate(VARIANTS[kind], merged, place)
    problems += found
    if table is None:
        return None

    def tell(error):
        problems.extend(f"{key_path(place(keys))}: {text}" for keys, text in error.problems)

    try:
        read = build.read_files(table, folder)
    except PartsError as error:
        tell(error)
        table = build.without_unreadable(table, [keys for keys, _ in error.problems])
        if table is None:
            return None
        read = build.read_files(table, folder)
    try:
        variant = make_variant(table, folder.absolute(), read)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HintWarning)  # `load_case` gives them, with the file and the variant
            warnings.simplefilter("ignore", ConditionWarning)  # the user gets them when solving
            build.require_table_range(table, variant.solve(angles=720))
        assembly.require_turn(variant.mechanism)
    except PartsError as error:
        tell(error)
    except AssemblyError as error:
        problems.append(f"variants.{name}: {error.condition}; change the lengths")
    except KinetostaticsError as error:
        problems.append(f"variants.{name}: {error}")
    else:
        return variant
    return None
