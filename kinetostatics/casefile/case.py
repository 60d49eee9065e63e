"""Case files: TOML with units as text, to mechanisms ready to solve; every problem of a file reported at once."""

import os
import re
import tomllib
import typing
import warnings
from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pydantic

from ..design import balancing, linkage
from ..design.balancing_table import balancing_table
from ..errors import AssemblyError, CaseError, HintWarning, KinetostaticsError, ParameterError
from ..machine import cams
from ..machine.builders import cam_crank_slider, crank_slider, four_bar
from ..machine.guide import Guide
from ..machine.links import Link
from ..machine.loads import TURN, Gravity, ProcessForce, Spring, Tabulated, period_of
from ..machine.mechanism import Mechanism
from ..mechanics import assembly
from ..mechanics.quantities import label
from ..numbers import checks
from ..numbers.files import read_columns, read_text
from ..numbers.units import base_factor, shown
from ..results.comparison import Comparison
from ..solution.scene import solve
from ..solution.solution import Solution
from ..sweeps import designs
from . import parameters, schema

LARGEST_CASE = 300_000
"""Bytes that a case file may have."""
DEEPEST = 20
"""Tables within tables that a case file may have; those that are used have three."""
_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){50}""")
FAR_OFF = 300.0
"""How many times a tolerance may be above or below its parameter before its unit is doubted."""


CAM_FORCE = ("smallest cam force", "largest cam force")
"""Rows of the comparison that variants without a cam lack."""


@dataclass(frozen=True, eq=False)
class Variant:
    """One mechanism of a case with its drive and loads, and how it was balanced if it was."""

    mechanism: Mechanism
    crank_speed: float
    crank_acceleration: float
    loads: tuple
    balanced: balancing.Balanced | None = None
    table: schema.MechanismVariant | None = field(default=None, repr=False)
    folder: Path = field(default=Path(), repr=False)
    tabulated: typing.Mapping[str, typing.Any] = field(default_factory=dict, repr=False)
    """By key of the table what was read from a file in the folder: a cam, a process force. It is not read again."""

    @property
    def content(self):
        """What a case's variant is made of as bytes, the same in every session: its table, and what files held."""
        text = self.table.model_dump_json() if self.table else ""
        arrays = (getattr(part, column.name) for part in self.tabulated.values() for column in fields(part))
        return text.encode() + b"".join(np.asarray(values).tobytes() for values in arrays)

    def varied(self, values) -> "Variant":
        """The variant with other values at some paths of its table (see `parameters.paths`), in SI.

        A value may be an array of designs (designs, 1); what the file derives from others, such as a centre at
        mid-length or a spring that balances the slider, follows.
        """
        known = parameters.paths(self.table)
        checks.require("parameters", *(checks.choice("parameter", path, tuple(known)) for path in values))
        return _built(parameters.with_values(self.table, values), self.folder, self.tabulated)

    @property
    def files(self):
        """Files that it is made from besides the case file, a list of paths."""
        named = (getattr(getattr(self.table, part, None), "table", None) for part in ("cam", "process_force"))
        return [self.folder / name for name in named if name]

    def solve(self, angles=720) -> Solution:
        """Solution at so many crank angles, evenly over the period of the loads from 0, one turn unless they take more.

        The end of the period is left out.
        """
        checks.require("solve", checks.count("angles", angles, size=checks.ANGLE))
        return solve(
            self.mechanism,
            np.linspace(0.0, period_of(self.loads), angles, endpoint=False),
            crank_speed=self.crank_speed,
            crank_acceleration=self.crank_acceleration,
            loads=self.loads,
        )


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
    """

    title: str
    source: str
    path: Path
    reference: str
    variants: typing.Mapping[str, Variant]
    published: schema.PublishedTable = field(repr=False)
    tolerances: typing.Mapping[str, str] = field(default_factory=dict)

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
        reactions = (f"largest {label(joint)}" for name in self.variants for joint in self.solve(name, 1).reactions)
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
        """Table of swing and transmission of the variants, a pandas DataFrame; None unless all are four-bars."""
        if any("rocker" not in variant.mechanism.links for variant in self.variants.values()):
            return None
        return linkage.characteristics({name: self.solve(name) for name in self.variants}, self.reference)


def shipped_cases():
    """Path by name of the cases that come with the library."""
    package = Path(__file__).parents[1]
    folder = next(path for path in (package / "cases", package.parent / "cases") if path.is_dir())
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


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
    """
    path, raw = _read(_place(path))
    head, problems = _validated(schema.CaseTable, raw, lambda keys: keys)
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
        problems += _spread_problems(head.tolerances, variants)
    if problems:
        raise CaseError(path, dict.fromkeys(problems))
    for doubt in _far_off(head.tolerances, variants):
        warnings.warn(f"{path}: {doubt}", HintWarning, stacklevel=2)
    for name, item in variants.items():
        for hint in item.mechanism.hints:
            warnings.warn(f"{path}: variants.{name}: {hint}", HintWarning, stacklevel=2)
    return Case(
        head.title, head.source, path, head.reference, MappingProxyType(variants), head.published, head.tolerances
    )


def _spread_problems(spreads, variants):
    """What is wrong with the tolerances: texts that cannot be read, parameters and units that no variant has."""
    known = {path: unit for item in variants.values() if item for path, unit in parameters.paths(item.table).items()}
    for name, text in spreads.items():
        columns = [name]
        try:
            columns = designs.columns(designs.distributions({name: text}))
        except KinetostaticsError as error:
            yield f"tolerances: {str(error).removeprefix('designs: ')}"
        if all(variants.values()):
            yield from (f"tolerances: {problem}" for problem in parameters.si_columns(columns, known)[1])


def _far_off(spreads, variants):
    """Tolerances whose size is far from that of their parameter in every variant that has it, as a sentence each."""
    for name, text in spreads.items():
        distribution, unit = designs.distributions({name: text})[name]
        size = max(abs(float(distribution.median())), float(distribution.std())) * base_factor(unit)
        nominal = [abs(value) for item in variants.values() if (value := _nominal(item, name))]
        if nominal and all(not 1 / FAR_OFF < size / value < FAR_OFF for value in nominal):
            si = next(paths[name] for item in variants.values() if name in (paths := parameters.paths(item.table)))
            yield (
                f"tolerances: {name} = {text!r} is of the size {size:.6g} {si}, but the parameter of "
                f"{nominal[0]:.6g} {si}; is the unit right?"
            )


def _nominal(variant, path):
    """Value of a parameter; None if the variant has none, or a word for it."""
    if path not in parameters.paths(variant.table):
        return None
    if path == "spring.stiffness":
        return next(float(item.stiffness) for item in variant.loads if isinstance(item, Spring))
    value = parameters.value(variant.table, path)
    return value if isinstance(value, float) else None


def _place(path):
    """Path of the case file that is meant."""
    if not isinstance(path, str | os.PathLike):
        raise ParameterError(f"load_case: takes a path or the name of a shipped case, got {shown(path)}")
    shipped = shipped_cases()
    if not isinstance(path, str) or path not in shipped:
        found = Path(path)
        return shipped[str(found)] if str(found) in shipped and not found.is_file() else found
    if Path(path).is_file():
        warnings.warn(
            f"{path!r} is read as the shipped case of that name, not the file here; write {'./' + path!r} for the file",
            stacklevel=3,
        )
    return shipped[path]


def _read(path):
    """The path and what its file holds."""
    shipped = shipped_cases()
    try:
        missing = not path.exists()
    except (OSError, ValueError):  # no path at all: reading it says why
        missing = False
    if missing:
        names = f"{', '.join(shipped)}{checks.hint(path.stem, shipped)}"
        raise CaseError(path, [f"no such file, and no shipped case of that name ({names})"])
    text = read_text(path, LARGEST_CASE)
    try:
        raw = None if _LONG_KEY.search(text) else tomllib.loads(text)
    except ValueError as error:
        raise CaseError(path, [f"is not TOML: {error}"]) from None
    except RecursionError:
        raw = None
    if raw is None or _deeper(raw, DEEPEST):
        raise CaseError(path, [f"holds tables or lists within each other more than {DEEPEST} deep"])
    return path, raw


def _deeper(table, depth):
    """Whether tables and lists stand within each other more than so deep."""
    level = [table]
    for _ in range(depth):
        level = [
            inner
            for outer in level
            for inner in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(inner, dict | list)
        ]
    return bool(level)


def _variant(name, own, common, folder, problems):
    """The variant, or None with what is wrong added to the problems."""
    merged = _merged(common, own)

    def place(keys):
        inherited = _holds(common, keys) and not _holds(own, keys)
        return ("common", *keys) if inherited else ("variants", name, *keys)

    kind = merged.get("mechanism")
    if not isinstance(kind, str) or kind not in schema.VARIANTS:
        path = _path(place(("mechanism",)))
        problems.append(f"{path} is missing" if kind is None else checks.choice(path, kind, tuple(schema.VARIANTS)))
        return None
    table, found = _validated(schema.VARIANTS[kind], merged, place)
    problems += found
    if table is None:
        return None
    try:
        variant = _built(table, folder, _tabulated(table, folder))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HintWarning)  # `load_case` gives them, with the file and the variant
            variant.solve(angles=720)
        assembly.require_turn(variant.mechanism)
    except CaseError as error:
        problems += [f"variants.{name}: {error.path}: {problem}" for problem in error.problems]
    except AssemblyError as error:
        problems.append(f"variants.{name}: {error.condition}; change the lengths")
    except KinetostaticsError as error:
        problems.append(f"variants.{name}: {error}")
    else:
        return variant
    return None


def _merged(common, own):
    merged = dict(common)
    for key, value in own.items():
        both = isinstance(value, dict) and isinstance(common.get(key), dict)
        merged[key] = _merged(common[key], value) if both else value
    return merged


def _holds(table, keys):
    for key in keys:
        if not isinstance(table, dict) or key not in table:
            return False
        table = table[key]
    return True


def _validated(model, raw, place):
    """The model or None, and a line for each problem; `place` tells where in the file a key stands."""
    try:
        return model.model_validate(raw), []
    except pydantic.ValidationError as error:
        return None, [_sentence(model, item, place) for item in error.errors()]


def _sentence(model, item, place):
    keys = tuple(key for key in item["loc"] if key not in schema.CAM_KINDS)
    path = _path(place(keys))
    if item["type"] == "missing":
        return f"{path} is missing"
    if item["type"] == "extra_forbidden":
        allowed = _allowed(model, item["loc"][:-1])
        return f"{path} is not a key here{checks.hint(keys[-1], allowed)} (allowed: {', '.join(allowed)})"
    if item["type"] in ("union_tag_invalid", "union_tag_not_found"):
        found = f"is {item['ctx']['tag']!r}" if "tag" in item["ctx"] else "is missing"
        return f"{path}.kind {found}; allowed: {', '.join(map(repr, schema.CAM_KINDS))}"
    if item["type"] == "value_error":
        return f"{path} {item['ctx']['error']}"
    return f"{path}: {item['msg'][0].lower()}{item['msg'][1:]}, found {shown(item['input'])}"


def _path(keys):
    text = ""
    for key in keys:
        text += f"[{key + 1}]" if isinstance(key, int) else f".{key}" if text else str(key)
    return text


def _allowed(model, keys):
    """Keys allowed in the table at a path of the model."""
    candidates = [model]
    for key in keys:
        if isinstance(key, int):
            continue
        tagged = [table for table in candidates if key in _tags(table)]
        candidates = tagged or [
            inner
            for table in candidates
            if key in table.model_fields
            for inner in _tables(table.model_fields[key].annotation)
        ]
    return [key for table in candidates for key in table.model_fields]


def _tags(table):
    kind = table.model_fields.get("kind")
    return typing.get_args(kind.annotation) if kind else ()


def _tables(annotation):
    if isinstance(annotation, type) and issubclass(annotation, schema.Table):
        return [annotation]
    return [table for part in typing.get_args(annotation) for table in _tables(part)]


def _tabulated(table, folder):
    """What a validated variant has in files: cam and process force, by their keys."""
    found: dict[str, typing.Any] = {}
    cam, force = getattr(table, "cam", None), getattr(table, "process_force", None)
    if isinstance(cam, schema.SampledTable):
        found["cam"] = _from_csv(folder / cam.table, {"angle": "rad", "radius": "m"}, cams.Sampled)
    if force is not None and force.table is not None:
        found["process_force"] = _from_csv(
            folder / force.table,
            {"crank_angle": "rad", "force": "N"},
            lambda angle, values: Tabulated(angle, values, force.period or TURN),
        )
    return found


def _from_csv(path, wanted, make):
    """What is made of columns of a file."""
    columns = read_columns(path, wanted)
    try:
        return make(*columns)
    except ParameterError as error:
        raise CaseError(path, [str(error)]) from None


def _built(table, folder, tabulated):
    """Mechanism, drive and loads of a validated variant."""
    mechanism = _mechanism(table, tabulated)
    loads = tuple(_loads(table, tabulated))
    balanced = _balanced(mechanism, table.balancing) if table.balancing else None
    if balanced is not None:
        mechanism = balanced.mechanism
    return Variant(mechanism, table.crank_speed, table.crank_acceleration, loads, balanced, table, folder, tabulated)


def _mechanism(table, tabulated):
    if isinstance(table, schema.FourBarVariant | schema.ChainUnitVariant):
        lengths = table.crank_length, table.coupler_length, table.rocker_length
        links = {
            name: _link(getattr(table, name), length)
            for name, length in zip(("crank", "coupler", "rocker"), lengths, strict=True)
        }
        if isinstance(table, schema.ChainUnitVariant):
            return linkage.chain_unit(*lengths, pivot_x=table.pivot_x, assembly=table.assembly, **links)
        return four_bar(*lengths, rocker_pivot=table.rocker_pivot, assembly=table.assembly, **links)
    guide = _guide(table)
    shared = {"guide": guide, "assembly": table.assembly, "slider": _link(table.slider)}
    if isinstance(table, schema.CrankSliderVariant):
        return crank_slider(
            table.crank_length,
            table.coupler_length,
            crank=_link(table.crank, table.crank_length),
            coupler=_link(table.coupler, table.coupler_length),
            **shared,
        )
    cam = tabulated.get("cam") or _cam(table.cam, guide.guide_angle)
    length = _cam_coupler_length(table, cam)
    coupler = _link(table.coupler, length)
    return cam_crank_slider(cam, length, crank=_link(table.crank), block=_link(table.block), coupler=coupler, **shared)


def _guide(table):
    if table.guide_through is None:
        angle, offset = (0.0 if value is None else value for value in (table.guide_angle, table.guide_offset))
        return Guide.at(angle, offset)
    if table.guide_angle is not None or table.guide_offset is not None:
        raise KinetostaticsError("give either guide_through or guide_angle and guide_offset")
    return Guide.through(*table.guide_through)


def _balanced(mechanism, table):
    weights = {
        name: balancing.Counterweight(**dict(getattr(table, name)))
        for name in ("crank", "coupler", "rocker")
        if getattr(table, name) is not None
    }
    if table.method == "optimal":
        return balancing.optimal(mechanism, table.norm, phase=table.phase, weights=table.weights, **weights)
    if "crank" not in weights:
        raise KinetostaticsError(f"{table.method} balancing needs a counterweight on the crank: balancing.crank")
    if table.method == "partial" and set(weights) != {"crank"}:
        raise KinetostaticsError(
            f"balancing: partial balancing takes one counterweight, on the crank, got {', '.join(weights)}"
        )
    if table.method == "full":
        return balancing.full(mechanism, **weights)
    return balancing.partial(mechanism, table.ratio, **weights)


def _link(table, length=None):
    centre = table.centre
    if isinstance(centre, str):
        if length is None:
            raise KinetostaticsError(
                'centre "mid-length" is for links between two joints, not for slider, block or slotted crank; give a '
                "distance there"
            )
        centre = (length / 2, 0.0)
    return Link(table.mass, centre, table.inertia)


def _cam(table, guide_angle):
    if table.kind == "circle":
        return cams.Circle(table.radius, table.centre)
    return cams.CosineLaw(table.amplitude, table.mean, guide_angle)


def _cam_coupler_length(table, cam):
    if table.coupler_length is not None:
        return table.coupler_length
    if not isinstance(cam, cams.CosineLaw):
        raise KinetostaticsError("coupler_length is missing; only a cosine-law cam fixes it by itself")
    return cam.coupler_length


def _loads(table, tabulated):
    if table.gravity is not None:
        yield Gravity(table.gravity.acceleration, table.gravity.direction)
    spring, force = getattr(table, "spring", None), getattr(table, "process_force", None)
    if spring is not None:
        if isinstance(spring.stiffness, str):
            yield Spring.balancing(table.slider.mass, table.crank_speed, spring.free_position)
        else:
            yield Spring(spring.stiffness, spring.free_position)
    if "process_force" in tabulated:
        yield ProcessForce(tabulated["process_force"], period=tabulated["process_force"].period)
    elif force is not None:
        yield ProcessForce(force.force)
