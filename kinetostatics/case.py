"""Case files: TOML with units as text, to mechanisms ready to solve; every problem of a file reported at once."""

import tomllib
import typing
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pydantic

from . import assembly, balancing, cams, checks, designs, linkage, parameters, schema
from .comparison import Comparison
from .errors import AssemblyError, CaseError, KinetostaticsError
from .files import read_columns
from .guide import Guide
from .links import Link
from .loads import Gravity, ProcessForce, Spring
from .mechanism import Mechanism, cam_crank_slider, crank_slider, four_bar
from .solution import Solution, period_of, solve
from .tables import balancing_table


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

    def varied(self, values) -> "Variant":
        """The variant with other values at some paths of its table (see `parameters.paths`), in SI.

        A value may be an array of designs (designs, 1); what the file derives from others, such as a centre at
        mid-length or a spring that balances the slider, follows.
        """
        known = parameters.paths(self.table)
        checks.require("parameters", *(checks.choice("parameter", path, tuple(known)) for path in values))
        return _built(parameters.with_values(self.table, values), self.folder)

    def solve(self, angles=720) -> Solution:
        """Solution at so many crank angles, evenly over the period of the loads from 0, one turn unless they take more.

        The end of the period is left out.
        """
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
        return table.assign(published=[printed.get(quantity, "") for quantity in table.index]) if printed else table

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
    package = Path(__file__).parent
    folder = next(path for path in (package / "cases", package.parent / "cases") if path.is_dir())
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_case(path) -> Case:
    """Read a case file.

    Parameters
    ----------
    path : str or path
        A TOML file, or the name of a shipped case ("sawframe_2r63").

    Returns
    -------
    Case

    Raises
    ------
    CaseError
        The file is missing, unreadable or wrong; the message lists every problem with its key.
    """
    path, raw = _read(path)
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


def _read(path):
    shipped = shipped_cases()
    found = Path(path)
    if not found.is_file() and str(path) in shipped:
        found = shipped[str(path)]
    try:
        return found, tomllib.loads(found.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        problem = (
            f"no such file, and no shipped case of that name ({', '.join(shipped)}){checks.hint(found.stem, shipped)}"
        )
    except OSError as error:
        problem = f"cannot be read: {error.strerror}"
    except UnicodeDecodeError as error:
        problem = f"is not UTF-8 text: {error.reason} at byte {error.start}"
    except tomllib.TOMLDecodeError as error:
        problem = f"is not TOML: {error}"
    raise CaseError(path, [problem])


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
        variant = _built(table, folder)
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
    return f"{path}: {item['msg'][0].lower()}{item['msg'][1:]}, found {item['input']!r}"


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


def _built(table, folder):
    """Mechanism, drive and loads of a validated variant."""
    mechanism = _mechanism(table, folder)
    loads = tuple(_loads(table, folder))
    balanced = _balanced(mechanism, table.balancing) if table.balancing else None
    if balanced is not None:
        mechanism = balanced.mechanism
    return Variant(mechanism, table.crank_speed, table.crank_acceleration, loads, balanced, table, folder)


def _mechanism(table, folder):
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
    cam = _cam(table.cam, guide.guide_angle, folder)
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


def _cam(table, guide_angle, folder):
    if table.kind == "circle":
        return cams.Circle(table.radius, table.centre)
    if table.kind == "cosine-law":
        return cams.CosineLaw(table.amplitude, table.mean, guide_angle)
    return cams.Sampled.from_csv(folder / table.table)


def _cam_coupler_length(table, cam):
    if table.coupler_length is not None:
        return table.coupler_length
    if not isinstance(cam, cams.CosineLaw):
        raise KinetostaticsError("coupler_length is missing; only a cosine-law cam fixes it by itself")
    return cam.coupler_length


def _loads(table, folder):
    if table.gravity is not None:
        yield Gravity(table.gravity.acceleration, table.gravity.direction)
    spring, force = getattr(table, "spring", None), getattr(table, "process_force", None)
    if spring is not None:
        if isinstance(spring.stiffness, str):
            yield Spring.balancing(table.slider.mass, table.crank_speed, spring.free_position)
        else:
            yield Spring(spring.stiffness, spring.free_position)
    if force is not None:
        yield ProcessForce(force.force if force.table is None else _tabulated_force(folder / force.table))


def _tabulated_force(path):
    """Function of the motion that interpolates a table of force by crank angle, periodic and linear."""
    angle, force = read_columns(path, {"crank_angle": "rad", "force": "N"})
    return lambda motion: np.interp(motion.crank_angle, angle, force, period=2 * np.pi)
