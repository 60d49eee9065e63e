"""Case files: TOML with units as text, to scenes ready to solve; every problem of a file reported at once."""

import re
import typing
import warnings
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from ..design import balancing, linkage
from ..design.balancing_table import balancing_table
from ..drive.motor import Motor
from ..errors import AssemblyError, CaseError, ConditionWarning, HintWarning, KinetostaticsError
from ..mechanics import assembly
from ..mechanics.quantities import of_mechanism
from ..numbers import checks
from ..numbers.lazy import cached_property
from ..results.comparison import Comparison
from ..solution.scene import Scene
from ..solution.solution import Solution
from . import build, parameters, reading, schema
from .designs import Design, designs_of
from .pieces import PartsError
from .reading import shipped_cases
from .spreads import far_off, spread_problems

__all__ = ["Case", "Variant", "load_case", "shipped_cases"]

CAM_FORCE = ("smallest cam force", "largest cam force")
"""Rows of the comparison that variants without a cam lack."""


@dataclass(frozen=True, eq=False)
class Variant:
    """A scene of a case file, what the file says of it, and how it was balanced if it was.

    Of a case it is ``case.variants["plain"]``; the scene is what its file says in numbers, ready to be solved.

    Attributes
    ----------
    scene : Scene
    table : pydantic model
        Its table of the file, checked.
    balanced : Balanced or None
        How the file's counterweights were found.
    folder : Path
        Of the file.
    tabulated : mapping of keys to what was read
        From files beside the case file: cams, tables. They are not read again.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").variants["cam-circle"]
    >>> saw.parameters["slider.mass"], saw.units["slider.mass"]
    (600.0, 'kg')
    >>> heavier = saw.varied({"slider.mass": 620.0})  # its spring balances the slider, so it follows
    >>> round(heavier.loads[1].stiffness / saw.loads[1].stiffness, 6)
    1.033333
    """

    scene: Scene
    table: schema.MechanismVariant = field(repr=False)
    balanced: balancing.Balanced | None = None
    folder: Path = field(default=Path(), repr=False)
    tabulated: typing.Mapping[tuple[str | int, ...], typing.Any] = field(default_factory=dict, repr=False)
    """By the keys that lead there what was read from a file in the folder: cams, tables. It is not read again."""

    @property
    def mechanism(self):
        """Crank and groups."""
        return self.scene.mechanism

    @property
    def friction(self):
        """Friction by joint."""
        return self.scene.friction

    @property
    def crank_speed(self):
        """rad/s."""
        return self.scene.crank_speed

    @property
    def crank_acceleration(self):
        """rad/s2."""
        return self.scene.crank_acceleration

    @property
    def loads(self):
        """Loads, a tuple."""
        return self.scene.loads

    @cached_property
    def motor(self) -> Motor | None:
        """Motor of its drive, None if the file gives none."""
        if self.table.drive is None:
            return None
        return self.tabulated.get(("drive", "motor")) or self.table.drive.motor.motor

    @property
    def flywheel(self):
        """Flywheel of its drive, on the crank, kg m2; 0 if the file gives none."""
        return 0.0 if self.table.drive is None else self.table.drive.flywheel

    @cached_property
    def _places(self):
        return parameters.paths(self.table)

    @property
    def units(self):
        """SI unit by path of every number that the file gives, defaults among them: "slider.mass", "cam.centre.x".

        Those of the drive are left out: solutions of a variant are at its crank speed, whatever drives it.
        """
        return {path: place.unit for path, place in self._places.items()}

    @property
    def parameters(self):
        """What stands in the file by path: a number in SI, or the word for one that is derived, "mid-length"."""
        return {path: parameters.value(self.table, place.steps) for path, place in self._places.items()}

    @property
    def content(self):
        """What a case's variant is made of as bytes, the same in every session: its table, and what files held.

        Without its drive, which no solution depends on.
        """
        return self.table.model_dump_json(exclude={"drive"}).encode() + b"".join(
            _bytes(part) for keys, part in self.tabulated.items() if keys[0] != "drive"
        )

    def varied(self, values) -> "Variant":
        """The variant with other values at some paths of its file, in SI, as if they stood there.

        What the file derives from others follows: a centre at mid-length, a spring that balances the slider, a cosine
        law's coupler, counterweights. To vary a number and keep all others, vary the `scene`.

        Parameters
        ----------
        values : dict of path to float or array (designs, 1)
        """
        known = self._places
        checks.require("parameters", *(checks.choice("parameter", path, tuple(known)) for path in values))
        varied = parameters.with_values(self.table, {known[path].steps: value for path, value in values.items()})
        return _made(varied, self.folder, self.tabulated)

    @property
    def files(self):
        """Files that it is made from besides the case file, a list of paths."""
        return [self.folder / name for _, _, name in parameters.files(self.table)]

    def solve(self, angles=720) -> Solution:
        """Solution at so many crank angles, evenly over the period of the loads from 0, one turn unless they take more.

        The end of the period is left out.
        """
        checks.require("solve", checks.count("angles", angles, size=checks.ANGLE))
        return self.scene.solve(angles)


def _bytes(item):
    """What was read from a file as bytes: arrays, and what is made of them."""
    if is_dataclass(item):
        return b"".join(_bytes(getattr(item, column.name)) for column in fields(item))
    return np.asarray(item).tobytes() if isinstance(item, np.ndarray) else repr(item).encode()


def _made(table, folder, tabulated):
    """Variant of a validated table."""
    scene, balanced = build.built(table, tabulated)
    return Variant(scene, table, balanced, folder, tabulated)


@dataclass(frozen=True, eq=False)
class Case:
    """A case file, read and checked; made by `load_case`.

    Attributes
    ----------
    title, source : str
    path : Path
    reference : str
        Variant the others are compared with.
    variants : mapping of name to Variant
    tolerances : mapping of parameter to text
        How parameters spread, for `tolerances`: "normal 712 kN/m +- 5 kN/m".
    designs : mapping of name to Design
        What the file wants to be found; `.find()` does.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> case = ks.load_case("sawframe_2r63")
    >>> list(case.variants), case.reference
    (['plain', 'cam-circle', 'cam-cosine'], 'plain')
    >>> round(case.compare("plain", "cam-cosine").mean_torque_ratio, 3)
    6.778
    """

    title: str
    source: str
    path: Path
    reference: str
    variants: typing.Mapping[str, Variant]
    published: schema.PublishedTable = field(repr=False)
    tolerances: typing.Mapping[str, str] = field(default_factory=dict)
    designs: typing.Mapping[str, Design] = field(default_factory=dict)

    def __getstate__(self):
        return {**vars(self), "variants": dict(self.variants)}

    def __setstate__(self, state):
        vars(self).update(state, variants=MappingProxyType(state["variants"]))

    @property
    def files(self):
        """All files that it is made from, a list of paths."""
        return [self.path, *(path for variant in self.variants.values() for path in variant.files)]

    def variant(self, name) -> Variant:
        """A variant by name."""
        problem = checks.choice("variant", name, tuple(self.variants))
        if problem:
            raise CaseError(self.path, [problem])
        return self.variants[name]

    def solve(self, name, angles=720) -> Solution:
        """Solution of a variant at so many crank angles, evenly over the period of its loads from 0, end excluded."""
        return self.variant(name).solve(angles)

    def compare(self, reference, balanced) -> Comparison:
        """Dynamic coefficients of one variant against another."""
        return Comparison(self.solve(reference), self.solve(balanced), (reference, balanced))

    def comparison_table(self, balanced, reference=None):
        """Table of dynamic coefficients with the published figures beside ours, as a pandas DataFrame."""
        table = self.compare(reference or self.reference, balanced).frame()
        printed = {
            quantity: f"{text} ({column})"
            for column in ("ratio", "value")
            for quantity, text in getattr(self.published, column).items()
        }
        problems = [self._row_problem(quantity, table.index) for quantity in printed]
        if any(problems):
            raise CaseError(self.path, [f"published: {problem}" for problem in problems if problem])
        return table.assign(published=[printed.get(quantity, "") for quantity in table.index]) if printed else table

    def _row_problem(self, quantity, rows):
        """What is wrong with the row that a published figure belongs to; one that other variants have is right."""
        if quantity in rows or re.fullmatch(r"torque extremum [1-9][0-9]?", quantity):
            return None
        reactions = (
            f"largest {known.label}"
            for variant in self.variants.values()
            for known in of_mechanism(variant.mechanism).values()
            if known.kind == "reaction"
        )
        return checks.choice("row", quantity, tuple(dict.fromkeys([*rows, *reactions, *CAM_FORCE])))

    def balancing_table(self):
        """Table of counterweights and shaking force of the balanced variants, a pandas DataFrame; None without any."""
        found = {
            name: (variant.balanced, variant.solve())
            for name, variant in self.variants.items()
            if variant.balanced is not None
        }
        return balancing_table(self.solve(self.reference), found, self.published.sampling) if found else None

    def linkage_table(self):
        """Table of swing and transmission of the variants, a pandas DataFrame; None unless all are crank-rockers."""
        if not all(linkage.swings(variant.mechanism) for variant in self.variants.values()):
            return None
        return linkage.characteristics({name: self.solve(name) for name in self.variants}, self.reference)


def load_case(path) -> Case:
    """Read a case file.

    Parameters
    ----------
    path : str or path
        A TOML file, or the name of a shipped case ("sawframe_2r63"). A file of that very name, without ending, is meant
        by a path with a folder ("./sawframe_2r63") or a `pathlib.Path`.

    Returns
    -------
    Case
        With all that its file and the tables beside it hold; they are not read again.

    Raises
    ------
    CaseError
        The file is missing, unreadable or wrong; the message lists every problem with its key.

    Warns
    -----
    HintWarning
        A tolerance is hundreds of times above or below its parameter, or a mass centre or an inertia looks like a slip
        of units.
    UserWarning
        A sampled cam is noisy, or a file has the name of the shipped case that is read.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").variants["plain"]
    >>> s = saw.solve(360)
    >>> print(f"{ks.extremes(s, 'O').largest:.0f} N")
    286772 N
    """
    path, raw = reading.read(reading.place(path))
    head, problems = reading.validated(schema.CaseTable, raw, lambda keys: keys)
    variants = {}
    tables = raw.get("variants")
    common = raw.get("common", {})
    for name, own in tables.items() if isinstance(tables, dict) else ():
        if isinstance(own, dict) and isinstance(common, dict):
            variants[name] = _variant(name, own, common, path.parent, problems)
    reference = raw.get("reference")
    if isinstance(reference, str) and variants and reference not in variants:
        problems.append(checks.choice("reference", reference, tuple(variants)))
    if head is not None:
        problems += spread_problems(head.tolerances, variants)
        designs = designs_of(head.design, head.reference, variants, problems)
    if problems:
        raise CaseError(path, dict.fromkeys(problems))
    for doubt in far_off(head.tolerances, variants):
        warnings.warn(f"{path}: {doubt}", HintWarning, stacklevel=2)
    for name, item in variants.items():
        for hint in item.mechanism.hints:
            warnings.warn(f"{path}: variants.{name}: {hint}", HintWarning, stacklevel=2)
    kept = MappingProxyType(variants)
    return Case(head.title, head.source, path, head.reference, kept, head.published, head.tolerances, designs)


def _variant(name, own, common, folder, problems):
    """The variant, or None with what is wrong added to the problems."""
    merged = reading.merged(common, own)

    def place(keys):
        inherited = reading.holds(common, keys) and not reading.holds(own, keys)
        return ("common", *keys) if inherited else ("variants", name, *keys)

    kind = merged.get("mechanism", "chain" if "groups" in merged else None)
    if not isinstance(kind, str) or kind not in schema.VARIANTS:
        path = reading.key_path(place(("mechanism",)))
        problems.append(f"{path} is missing" if kind is None else checks.choice(path, kind, tuple(schema.VARIANTS)))
        meant = checks.nearest(kind, schema.VARIANTS)
        if meant is not None:
            problems += reading.validated(schema.VARIANTS[meant], {**merged, "mechanism": meant}, place)[1]
        return None
    table, found = reading.validated(schema.VARIANTS[kind], merged, place)
    problems += found
    if table is None:
        return None

    def tell(error):
        problems.extend(f"{reading.key_path(place(keys))}: {text}" for keys, text in error.problems)

    try:
        read = build.tabulated(table, folder)
    except PartsError as error:
        tell(error)
        table = build.without(table, [keys for keys, _ in error.problems])
        if table is None:
            return None
        read = build.tabulated(table, folder)
    try:
        variant = _made(table, folder, read)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HintWarning)  # `load_case` gives them, with the file and the variant
            warnings.simplefilter("ignore", ConditionWarning)  # whoever solves it gets them
            build.require_values(table, variant.solve(angles=720))
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
