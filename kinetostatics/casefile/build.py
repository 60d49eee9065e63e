"""Scene of a validated variant: mechanism, loads, friction, counterweights, and the files next to the case file.

`places_by_path` returns the numbers that designs may vary, by paths as in scenes: "spring.stiffness", "slider2.mass".
`collect` builds many parts and reports the faults of all.
"""

import typing
from dataclasses import MISSING, fields
from functools import partial
from typing import Any, NamedTuple

from ..design import balancing, linkage
from ..errors import CaseError, KinetostaticsError, ParameterError
from ..machine.builders import cam_crank_slider, crank_slider, four_bar, scotch_yoke, slotted_lever
from ..machine.cams import cams
from ..machine.cams.roller import Face, Roller
from ..machine.crank import Crank, Rotor
from ..machine.friction import friction_kind
from ..machine.guide import Guide
from ..machine.links import Link
from ..machine.loads import TURN, Gravity, ProcessForce, Spring, Table, loads_with_mass, value_of
from ..machine.mechanism import Mechanism
from ..numbers import paths as tree
from ..numbers.checks import choice
from ..numbers.files import read_columns
from ..numbers.parameter_tree import replace_unchecked
from ..solution.scene import Scene
from .schema import drives, laws, parts, tables, variants

COMPONENTS = {"x": 0, "y": 1, "along": 0, "across": 1}
"""Index by name of a component of a pair."""
GUIDE_KEYS = ("guide_angle", "guide_offset")
"""Keys replaced by two points of the guide."""


PLANE_KEYS = ("plane", "couple_unbalance", "bearings")
"""Keys of positions along the crankshaft: they vary only if given, as in scenes."""


class NumberPlace(NamedTuple):
    """Place of a number in a validated table: fields and item indices from the outermost, and its SI unit."""

    steps: tuple[str | int, ...]
    unit: str


def places_by_path(table, prefix="", label="") -> dict[str, NumberPlace]:
    """Place by path of all numbers that can vary in a validated table; a label is appended to the first name."""
    names = getattr(parts.MADE_OF.get(type(table)), "PATHS", {})
    found: dict[str, NumberPlace] = {}
    fixed = _file_of(table) is not None or isinstance(table, laws.LawTable)
    for name, field in () if fixed else type(table).model_fields.items():
        if name in GUIDE_KEYS and getattr(table, "guide_through", None):
            continue
        value = getattr(table, name)
        if value is None and name in PLANE_KEYS:
            continue
        if isinstance(value, tuple) and value and isinstance(value[0], tables.Table):
            inner = _places_in_list(table, value)
        elif isinstance(value, dict):
            inner = {
                path: place._replace(steps=(key, *place.steps))
                for key, part in value.items()
                for path, place in places_by_path(part, f"{prefix}{name}.{key}.").items()
                if getattr(part, str(place.steps[0])) is not None
            }
        else:
            path, meant = f"{prefix}{names.get(name, name)}{label}", unit_or_rule(field)
            if isinstance(value, tables.Table):
                inner = places_by_path(value, f"{path}.")
            elif hasattr(meant, "numbers"):
                inner = {f"{path}.{part}": NumberPlace(steps, rule.unit) for part, steps, rule in meant.numbers(value)}
            elif meant is not None and isinstance(value, tuple):
                names_of_pair = ("along", "across") if name == "centre" and hasattr(table, "mass") else ("x", "y")
                inner = {f"{path}.{part}": NumberPlace((COMPONENTS[part],), meant) for part in names_of_pair}
            else:
                inner = {} if meant is None else {path: NumberPlace((), meant)}
        found |= {path: place._replace(steps=(name, *place.steps)) for path, place in inner.items()}
    return found


def _places_in_list(table, items):
    """Places in groups or loads; the second and later loads of a kind get their number appended."""
    found: dict[str, NumberPlace] = {}
    counts: dict[str, int] = {}
    for number, part in enumerate(items):
        named = getattr(parts.MADE_OF[type(part)], "PATH", "")
        counts[named] = counts.get(named, int(bool(named and getattr(table, named, None)))) + 1
        again = str(counts[named]) if counts[named] > 1 else ""
        label = getattr(part, "label", getattr(part, "name", ""))
        inner = places_by_path(part, f"{named}{again}.") if named else places_by_path(part, "", label)
        found |= {path: place._replace(steps=(number, *place.steps)) for path, place in inner.items()}
    return found


def _file_of(table):
    """Name of the file with the numbers of a table, or None."""
    found = (getattr(table, key, None) for key in ("file", "table"))
    return next((name for name in found if name is not None), None)


def unit_or_rule(field):
    """SI unit of a field, or the rule of its numbers, from its annotation; None for other fields."""
    candidates = [field.metadata, *(getattr(part, "__metadata__", ()) for part in typing.get_args(field.annotation))]
    found = (item for metadata in candidates for item in metadata if isinstance(item, str) or hasattr(item, "numbers"))
    return next(found, None)


def value_at(table, steps):
    """Value in a validated table: a number in SI, or a word instead."""
    for step in steps:
        table = table[step] if isinstance(step, int) or isinstance(table, dict) else getattr(table, step)
    return table


def with_values(table, values: dict):
    """Copy of a validated table with values by steps, unchecked: numbers or arrays of designs."""
    return tree.with_values(table, values, lambda part, **fields: part.model_copy(update=fields))


def named_files(table, keys=()):
    """Keys, table and file name of each table whose numbers are in a file."""
    if isinstance(table, tuple):
        for number, part in enumerate(table):
            yield from named_files(part, (*keys, number))
    elif isinstance(table, tables.Table):
        if (name := _file_of(table)) is not None:
            yield keys, table, name
        for name in type(table).model_fields:
            yield from named_files(getattr(table, name), (*keys, name))


class PartsError(KinetostaticsError, ValueError):
    """Faults of parts of a variant, pairs of keys and sentence."""

    def __init__(self, problems):
        self.problems = tuple(problems)
        super().__init__("; ".join(text for _, text in self.problems))


def collect(makers):
    """Results of functions by their keys; one `PartsError` lists all their faults."""
    found, problems = {}, []
    for keys, make in makers:
        try:
            found[keys] = make()
        except CaseError as error:
            problems += [(keys, f"{error.path}: {problem}") for problem in error.problems]
        except KinetostaticsError as error:
            problems.append((keys, str(error)))
    if problems:
        raise PartsError(problems)
    return found


def build_link(table, length=None):
    """Link of its table; `length` is the distance of its two joints, m, for a centre at mid-length."""
    centre = table.centre
    if isinstance(centre, str):
        if length is None:
            raise KinetostaticsError(
                'centre "mid-length" needs a link between two joints, not slider, block or slotted crank; give a '
                "distance there"
            )
        centre = (length / 2, 0.0)
    given = {name: value for name in PLANE_KEYS if (value := getattr(table, name, None)) is not None}
    return (Rotor if given else Link)(table.mass, centre, table.inertia, **given)


def build_guide(table):
    """Guide of a table with keys of a guide."""
    if table.guide_through is None:
        angle, offset = (0.0 if value is None else value for value in (table.guide_angle, table.guide_offset))
        return Guide.at(angle, offset)
    if table.guide_angle is not None or table.guide_offset is not None:
        raise KinetostaticsError("give either guide_through or guide_angle and guide_offset")
    return Guide.through(*table.guide_through)


def build_cam(table, read, guide_angle):
    """Cam of its table; `read` is the sampled cam of a file."""
    if isinstance(table, tables.SampledTable):
        return read
    if isinstance(table, tables.CosineLawTable):
        return cams.CosineLaw(table.amplitude, table.mean, guide_angle)
    if isinstance(table, tables.HarmonicTable):
        return cams.Harmonic(table.cosine, table.sine, guide_angle)
    return cams.Circle(table.radius, table.centre)


def _friction_pair(table, joint, mechanism):
    problem = choice("joint", joint, tuple(mechanism.pairs))
    if problem:
        raise KinetostaticsError(problem)
    kind = friction_kind(mechanism.pairs[joint])
    given = {name: value for name in type(table).model_fields if (value := getattr(table, name)) is not None}
    allowed = [field.name for field in fields(kind)]
    lacking = [field.name for field in fields(kind) if field.default is MISSING and field.name not in given]
    strange = [name for name in given if name not in allowed]
    if lacking or strange:
        words = [f"lacks {', '.join(lacking)}"] * bool(lacking) + [f"has {', '.join(strange)}"] * bool(strange)
        raise KinetostaticsError(f"{' and '.join(words)}, but friction at {joint!r} needs {', '.join(allowed)}")
    return kind(**given)


def _chain(table, tabulated):
    """Mechanism of a variant with a list of groups."""
    crank = Crank(table.crank_length, build_link(table.crank, table.crank_length), table.bearings)
    # direction of a cam with a law: the first guide with a slider at A
    ahead = (part for part in table.groups if getattr(part, "on", "") == "A" and hasattr(part, "guide_angle"))
    angle = next(map(build_guide, ahead), Guide()).guide_angle
    groups = collect(
        (("groups", number), partial(_group, part, tabulated.get(("groups", number, "cam")), angle))
        for number, part in enumerate(table.groups)
    )
    return Mechanism(table.name, crank, tuple(groups.values()))


def _group(table, cam, guide_angle):
    """Group of its table; centres at mid-length follow from the lengths of its bars."""
    kind = parts.MADE_OF[type(table)]
    values = {name: getattr(table, name) for name in type(table).model_fields if name in kind.RULES.rules}
    links = {name: part for name, part in values.items() if isinstance(part, tables.LinkTable)}
    if "guide" in kind.RULES.rules:
        values["guide"] = build_guide(table)
    if "cam" in values:
        is_law = isinstance(table.cam, laws.LawTable)
        values["cam"] = cam or (table.cam.law(kind.LAW[1]) if is_law else build_cam(table.cam, cam, guide_angle))
    for name, body in (("roller", Roller), ("face", Face)):
        if values.get(name):
            values[name] = body(**dict(values[name]))
    middles = {
        name: part.model_copy(update={"centre": (0.0, 0.0)})
        for name, part in links.items()
        if isinstance(part.centre, str)
    }
    group = kind(**values | {name: build_link(middles.get(name, part)) for name, part in links.items()})
    lengths = {group.own_names[bar.link]: bar.length for bar in group.bars}
    return replace_unchecked(group, **{name: build_link(links[name], lengths.get(name)) for name in middles})


def _load(table, number, tabulated, mechanism, crank_speed):
    kind = parts.MADE_OF[type(table)]
    names = [name for name in type(table).model_fields if name != "kind"]
    values = {name: tabulated.get(("loads", number, name), getattr(table, name)) for name in names}
    if kind is Spring and isinstance(values["stiffness"], str):
        slider = mechanism.links.get(table.on)
        if slider is None:
            return kind(**values | {"stiffness": 0.0})
        balanced = Spring.balancing(slider.mass, crank_speed, table.free_position, spring_mass=table.mass)
        values["stiffness"] = balanced.stiffness
    return kind(**values)


def read_files(table, folder):
    """Cams, motors and values of loads in the files of a validated variant, by keys."""
    return collect((keys, partial(_read, folder / name, part, table, keys)) for keys, part, name in named_files(table))


def without_unreadable(table, wrong):
    """A validated variant without the unreadable files at these keys; None if it needs one of them."""
    values: dict[Any, Any] = {keys: 0.0 for keys in wrong if isinstance(value_at(table, keys), tables.ValuesTable)}
    values |= {keys: None for keys in wrong if isinstance(value_at(table, keys), variants.ProcessForceTable)}
    values |= {keys[:1]: None for keys in wrong if isinstance(value_at(table, keys), drives.TorqueTable)}
    return None if len(values) < len(set(wrong)) else with_values(table, values)


def _read(path, part, table, keys):
    """Cam, motor or values of a load in the file of a part."""
    if isinstance(part, drives.TorqueTable):
        columns = read_columns(path, {"speed": "rad/s", "torque": "N m"})
        try:
            return part.of(*columns)
        except ParameterError as error:
            raise CaseError(path, [str(error)]) from None
    if isinstance(part, tables.SampledTable | laws.LawTable):
        if isinstance(part, laws.LawTable):
            unit = parts.MADE_OF[type(value_at(table, keys[:-1]))].LAW[1]
            columns, make = {"angle": "rad", "position": unit}, part.law(unit)
        else:
            columns, make = {"angle": "rad", "radius": "m"}, partial(cams.Sampled, noise=part.noise)
        try:
            return make(*read_columns(path, columns))
        except ParameterError as error:
            raise CaseError(path, [str(error)]) from None
    period = part.period or TURN
    if isinstance(part, tables.ValuesTable):
        unit = unit_or_rule(type(value_at(table, keys[:-1])).model_fields[keys[-1]])
        return Table.from_csv(path, unit, part.area, period, part.slider, part.over, part.zero, part.sense)
    return Table.from_csv(path, period=period)


def build_scene(table, tabulated):
    """Scene of a validated variant with the contents of its files, and its balancing or None."""
    mechanism = _mechanism(table, tabulated)
    balanced = _balance(mechanism, table.balancing) if table.balancing else None
    mechanism = mechanism if balanced is None else balanced.mechanism
    own = tuple(_own_loads(table, tabulated))
    listed = collect(
        (("loads", number), partial(_load, part, number, tabulated, mechanism, table.crank_speed))
        for number, part in enumerate(table.loads)
    )
    wrong = [(keys, text) for keys, load in listed.items() for text in load.problems(mechanism) if text]
    if wrong:
        raise PartsError(wrong)
    rubbing = collect(
        (("friction", joint), partial(_friction_pair, part, joint, mechanism)) for joint, part in table.friction.items()
    )
    loads = own + tuple(listed.values())
    if balanced is not None and loads_with_mass(loads):
        raise KinetostaticsError(
            "balancing finds counterweights for links only, but a spring or shaft has mass; leave it out, or find "
            "the counterweights as a design that minimises the shaking force"
        )
    friction = {joint: pair for (_, joint), pair in rubbing.items()}
    return Scene(mechanism, table.crank_speed, table.crank_acceleration, loads, friction, sense=table.sense), balanced


def require_table_range(table, solution):
    """Raise `PartsError` if the slider leaves the range of a table over travel."""
    own = len(solution.loads) - len(table.loads)
    read = [(number - own, value_of(item)) for number, item in enumerate(solution.loads)]
    collect(
        (("loads", number) if number >= 0 else ("process_force",), partial(value, solution))
        for number, value in read
        if isinstance(value, Table)
    )


def _mechanism(table, tabulated):
    """Mechanism of a variant: its links, and the lengths and places for its builder."""
    if isinstance(table, variants.ChainVariant):
        return _chain(table, tabulated)
    shared: dict[str, Any] = {name: getattr(table, name) for name in ("assembly",) if hasattr(table, name)}
    if isinstance(table, variants.GuideVariant):
        shared["guide"] = build_guide(table)
    if isinstance(table, variants.CamVariant):
        cam = build_cam(table.cam, tabulated.get(("cam",)), shared["guide"].guide_angle)
        if table.coupler_length is None:
            if not isinstance(cam, cams.CosineLaw):
                raise KinetostaticsError("coupler_length is missing; only a cosine-law cam determines it")
            table = table.model_copy(update={"coupler_length": cam.coupler_length})
        shared["roller"] = table.roller and Roller(**dict(table.roller))
    for name, part in table:
        if isinstance(part, tables.LinkTable):
            shared[name] = build_link(part, getattr(table, f"{name}_length", None))
    match table:
        case variants.CamVariant():
            return cam_crank_slider(cam, table.coupler_length, **shared)
        case variants.CrankSliderVariant():
            return crank_slider(table.crank_length, table.coupler_length, **shared)
        case variants.ScotchYokeVariant():
            return scotch_yoke(table.crank_length, slot_angle=table.slot_angle, **shared)
        case variants.SlottedLeverVariant():
            line = {"pivot": table.lever_pivot, "offset": table.slot_offset}
            return slotted_lever(table.crank_length, **line, **shared)
    lengths = table.crank_length, table.coupler_length, table.rocker_length
    if isinstance(table, variants.ChainUnitVariant):
        return linkage.chain_unit(*lengths, pivot_x=table.pivot_x, **shared)
    return four_bar(*lengths, rocker_pivot=table.rocker_pivot, **shared)


def _balance(mechanism, table):
    weights = {
        name: balancing.Counterweight(**dict(getattr(table, name)))
        for name in ("crank", "coupler", "rocker")
        if getattr(table, name) is not None
    }
    if table.method == "optimal":
        given = {name: getattr(table, name) for name in ("norm", "phase", "weights", "about")}
        return balancing.optimal(mechanism, **given, **weights)
    if "crank" not in weights:
        raise KinetostaticsError(f"{table.method} balancing needs a counterweight on the crank: balancing.crank")
    if table.method == "partial" and set(weights) != {"crank"}:
        raise KinetostaticsError(
            f"balancing: partial balancing needs one counterweight, on the crank, got {', '.join(weights)}"
        )
    if table.method == "full":
        return balancing.full(mechanism, **weights)
    return balancing.partial(mechanism, table.ratio, **weights)


def _own_loads(table, tabulated):
    """Gravity, spring and process force, which have their own tables."""
    if table.gravity is not None:
        yield Gravity(**dict(table.gravity))
    spring, force = getattr(table, "spring", None), getattr(table, "process_force", None)
    if spring is not None:
        stiffness = spring.stiffness
        if isinstance(stiffness, str):
            try:
                stiffness = Spring.balancing(
                    table.slider.mass, table.crank_speed, spring.free_position, spring_mass=spring.mass
                ).stiffness
            except ParameterError as error:
                raise ParameterError(f"spring.stiffness: {error}") from None
        yield Spring(stiffness, spring.free_position, cubic=spring.cubic, mass=spring.mass)
    if force is not None:
        read = tabulated.get(("process_force",)) or tabulated.get(("process_force", "force"))
        yield ProcessForce(force.force if read is None else read, reaction=force.reaction)
