"""A mechanism: a crank and the chain of structural groups attached to it.

Motion flows along the chain, forces flow back. The constructor checks the names: a part is attached only to joints of
earlier parts, and no two parts have the same name.
"""

import math
from dataclasses import dataclass, fields, replace
from functools import reduce
from operator import attrgetter
from typing import Any, ClassVar

import numpy as np

from ..numbers import checks
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import replace_unchecked
from ..numbers.paths import Batched
from ..numbers.planar import minus, subtract_vectors
from . import plausibility
from .crank import Crank
from .friction import friction_kind
from .group import (
    BEARINGS,
    CRANK,
    EMPTY,
    FRAME,
    GROUND,
    MEMBERS,
    RATES,
    RESERVED,
    SHAFT_TORQUE,
    TRAVELS,
    Group,
    Resolved,
)
from .groups import carriers
from .kinematic_state import margin, place
from .links import Meshing, Sliding, Turning, Wrench, present
from .loads.points import wrench_at
from .planes import plane_problems, planes_by_link

NAME, NOTHING = checks.Name(), Wrench(None, None)


class GroupsRule:
    """Rule of a field that holds groups."""

    rule = checks.HasMembers(
        MEMBERS, "a group: RockerGroup, SliderGroup, CamRoller or one of your own, derived from Group"
    )

    def quick(self, value):
        if type(value) is tuple and all(isinstance(group, Group) and group.trusted for group in value):
            return value
        return checks.UNDECIDED

    def check(self, value, field=""):
        if not isinstance(value, tuple | list):
            return value, f"{field} must be a tuple of groups, got {checks.shown(value)}"
        found = [self.rule.check(group, "a group") for group in value]
        problems = [problem for _, problem in found]
        problems += [NAME.check(name, f"on of {type(group).__name__}")[1] for group in value for name in _on(group)]
        strange = (type(group).__name__ for group in value if not isinstance(group, Group))
        problems += [f"{name} is not derived from {Group.__module__}.{Group.__name__}" for name in strange]
        return tuple(group for group, _ in found), next(filter(None, problems), None)


def _on(group):
    """Names in the field `on` of a group."""
    found = getattr(group, "on", "O")
    return found if type(found) is tuple else (found,)


NAME_REMEDY = "give the second group another pin, pivot_name or label"
MARK = 0xE000
"""First of the unused characters that replace the texts of a part."""


def _spelled(part, table):
    """Names and entries in a table of a part; of the library's own parts with repetitions, which a dict drops."""
    if not part.trusted:
        return list(getattr(part, table).items())
    texts = {field.name: text for field in fields(part) if type(text := getattr(part, field.name)) is str}
    marks = {name: chr(MARK + place) for place, name in enumerate(texts)}
    back = str.maketrans({marks[name]: text for name, text in texts.items()})
    marked = getattr(replace_unchecked(part, **marks), table)
    return [(spelled.translate(back), entry) for spelled, entry in marked.items()]


def name_problems(parts):
    """Problems of the names in a chain of parts: unknown or repeated names."""
    points: dict[str, str] = {}
    joints: set[str] = set()
    links = [FRAME]
    forces = dict.fromkeys(("closure", *RESERVED), "result of every mechanism")
    problems = []
    repeated = []

    def add(table, what, kind, names):
        for name in names:
            if name in table:
                repeated.append(f"{kind} adds {what} {name!r} a second time, after the {table[name]}")
            table[name] = f"{what} of {kind}"

    for part in parts:
        kind = type(part).__name__
        for name in (name for name in part.hangs_on if name not in joints):
            problem = f"{kind} is attached to joint {name!r}, which no part before it places"
            if name in links:
                problem = f"{kind} is attached to {name!r}, which is a link; put a Pin on that link, and name its joint"
            elif name == "A":
                problem += "; give the crank a length, or put a CamRoller before it"
            problems.append(problem)
        links += part.links
        for name, point in part.joints.items():
            if point.link not in links:
                found = checks.choice(f"{kind}: link that carries joint {name!r}", point.link, links)
                problems.append(f"{found}; a part that adds a link must come before the parts fixed to it")
        joints.update(part.joints)
        own = [link for link in part.links if link not in points]
        add(points, "joint", kind, [name for name, _ in _spelled(part, "joints")])
        add(points, "link", kind, part.links)
        outputs = _spelled(part, "outputs")
        for vector, what in ((True, "reaction"), (False, "quantity")):
            add(forces, what, kind, [name for name, output in outputs if output.vector == vector])
        endings = [*RATES, *(ending for link in part.guides for ending in TRAVELS)]
        add(forces, "quantity", kind, [f"{link}{ending}" for link in own for ending in endings])
        add(forces, "quantity", kind, [*part.motions, *part.contacts])
    return [*problems, *repeated, *([NAME_REMEDY] if repeated else [])]


def _table(name, doc):
    """Cached property: the entries of all parts in a table, from the crank outwards."""

    def collect(mechanism):
        found = getattr(mechanism.crank, name)
        for group in mechanism.groups:
            if more := getattr(group, name):
                found = found | more if isinstance(more, dict) else found + more
        return {} if found is EMPTY else found  # EMPTY cannot be pickled

    found = cached_property(collect)
    found.__doc__ = doc
    return found


_VALID_NAMES: set = set()
"""Texts of names in chains of the library's own groups that passed `name_problems`."""


@dataclass(frozen=True, eq=False)
class Mechanism(Batched):
    """Crank and groups, in the order in which motion flows from one to the next.

    Parameters
    ----------
    name : str
        Name of the mechanism in messages and figures.
    crank : Crank
    groups : tuple
        `CamRoller`, `SliderGroup`, `Pin` ...; each is attached to a joint, or fixed to a link, of the crank or an
        earlier group.

    Raises
    ------
    ParameterError
        A group is attached to an unknown joint, or a name appears twice; the message lists all problems.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pistons = ks.SliderGroup(0.2), ks.SliderGroup(0.2, guide=ks.Guide.at(1.5708), pin="C", label="2")
    >>> list(ks.Mechanism("V twin", ks.Crank(0.05), pistons).links)
    ['crank', 'coupler', 'slider', 'coupler2', 'slider2']
    """

    name: str
    crank: Crank
    groups: tuple[Any, ...]

    PATHS: ClassVar = {"crank": "", "groups": ""}
    RULES = checks.Rules("mechanism", name=NAME, crank=checks.InstanceOf(Crank, "a Crank"), groups=GroupsRule())

    def __post_init__(self):
        self.RULES.admit(self)
        throws = self.throws
        groups = [group.on_crank(throws) for group in self.groups]
        vars(self)["groups"] = tuple([group.beside(groups, throws) for group in groups])
        if len(groups) > 1 and any(group.plane is not None for group in groups):
            checks.require(self.name, *plane_problems(self))
        names = tuple([(part.__class__, *part.names) for part in self.parts]) if self.trusted else None
        if names is None or names not in _VALID_NAMES:
            checks.require(self.name, *name_problems(self.parts))
            if names is not None:
                _VALID_NAMES.add(names)

    @property
    def parts(self):
        """Crank and groups."""
        return (self.crank, *self.groups)

    @cached_property
    def trusted(self):
        """Whether crank and groups are the library's own, whose forces are proven to balance."""
        return all(part.trusted for part in self.parts)

    throws = _table("throws", "Pins of the crank by joint, each a `Throw`.")

    @cached_property
    def turns(self):
        """Turns of the crank after which the motion repeats: 1, or 2 for a branch through one change point a turn."""
        return math.lcm(*(group.turns for group in self.groups))

    @property
    def passages(self):
        """Passage of each group through its change points: "" without any, None if it keeps to its side."""
        return tuple(group.passage if group.through else None for group in self.groups)

    @cached_property
    def passes(self):
        """Whether it passes change points: motion is smooth there, but forces grow without bound."""
        return any(group.passes for group in self.groups)

    @cached_property
    def has_unbounded_reactions(self):
        """Whether forces may far exceed the balancing torque; the torque then follows from the power balance."""
        return any(group.passes or group.is_close for group in self.groups)

    @cached_property
    def planes(self):
        """Position along the crankshaft by link, m."""
        return planes_by_link(self)

    @property
    def has_planes(self):
        """Whether a part has a plane, so that a rocking moment and torques of the shaft exist."""
        return any(part.plane is not None for part in (self.crank.link, *self.groups))

    @property
    def on_shaft(self):
        """First link of each group on the crank or a pin of it."""
        joints = {name for name, point in self.joints.items() if name == "O" or point.link == CRANK}
        groups = (group for group in self.groups if group.links and not joints.isdisjoint(group.hangs_on))
        return tuple(next(iter(group.links)) for group in groups)

    @property
    def led_by_ground(self):
        """Groups driven by a cam on the frame."""
        return tuple(group for group in self.groups if any(led.body == FRAME for led in group.led))

    def grows(self, name):
        """Whether a force, of a group that passes change points or at O, grows without bound at change points.

        The opposite forces on the frame also grow, and their sum loses its digits.
        """
        parts = [group for group in self.groups if group.passes]
        if not parts or name == "balancing_torque":
            return False
        rockers = {group.carrier for group in parts}
        parts += [self.crank] * ("" in rockers)
        name = "O" if name in BEARINGS else name.removeprefix(f"{GROUND} ")
        if name == GROUND or name.startswith(SHAFT_TORQUE):
            return True
        pair = self.pairs.get(name)
        at_pivot = isinstance(pair, Turning) and pair.link in rockers and pair.against == FRAME
        return at_pivot or any(name in part.outputs for part in parts)

    @cached_property
    def change_points(self):
        """Crank angles in [0, 2 pi) of the change points that it passes, rad."""
        found = {angle for group in self.groups for angle in group.change_points(self.throws)}
        for group in filter(attrgetter("carrier"), self.groups):
            found |= set(carriers.change_points(self, group, found))
        return tuple(sorted(found))

    links = _table("links", "Link by name, from the crank outwards.")
    references = _table("references", "Reference joint by link, from the crank outwards.")
    joints = _table("joints", "Joints by name, each as a `Point` of a link.")

    @cached_property
    def outputs(self):
        """Reactions and other forces by name, each as an `Output`, in the order of `resolve`."""
        return {name: output for part in (*reversed(self.groups), self.crank) for name, output in part.outputs.items()}

    @cached_property
    def pairs(self):
        """Pairs of links by reaction; a pin turns by default against the link that carries it."""
        found = {name: pair for part in self.parts for name, pair in part.pairs.items()}
        whole: dict[str, str] = {}  # link to which each link of a rigid triangle belongs
        for group in self.groups:
            carriers = {self.joints[name].link for name in group.hangs_on} if group.is_rigid_triangle else ()
            owners = {whole.get(carrier, carrier) for carrier in carriers}
            if len(owners) == 1:
                whole |= dict.fromkeys(group.links, *owners)
        for name, pair in found.items():
            if isinstance(pair, Turning):
                against = pair.against or self.joints[pair.joint].link
                still = whole.get(pair.link, pair.link) == whole.get(against, against)
                found[name] = pair._replace(against=pair.link if still else against)
        return found

    @property
    def friction_kinds(self):
        """Kind of friction that each joint may have, by its name in `friction`: `PinFriction`, `GuideFriction` ..."""
        return {name: friction_kind(pair) for name, pair in self.pairs.items() if not isinstance(pair, Meshing)}

    guides = _table("guides", "Guide by slider.")

    @cached_property
    def slider(self):
        """Default slider: the only one, or the only one without a label; else None."""
        bare = [name for name in self.guides if name == self.own_names[name]]
        found = bare if len(bare) == 1 else list(self.guides)
        return found[0] if len(found) == 1 else None

    own_names = _table("own_names", "Name of each link without the label of its group.")
    curves = _table("curves", "Title in drawings of the curve that a joint runs on, by joint.")

    slots = _table("slots", "Links in which a joint slides, each as a `Slot`.")
    sign_forces = _table("sign_forces", "Forces whose change of sign puts a kink into others, by name.")
    rollers = _table("rollers", "Radii of rollers by the joints that are their centres, m; None if it is not known.")
    bars = _table("bars", "Links that keep two joints at a distance, from the crank outwards.")

    @cached_property
    def hints(self):
        """Sentences on values that look like values in other units."""
        return plausibility.mechanism_hints(self)

    @cached_property
    def extent(self):
        """Sum of all lengths, including the coordinates of mass centres, m."""
        found = [abs(length) for part in self.parts for length in part.lengths if present(length) is not None]
        return sum(found[1:], found[0]) if found else 0.0

    @cached_property
    def proportion(self):
        """Sum of all lengths over the shortest link or cam radius, the largest of a batch."""
        shortest = reduce(np.minimum, (reach for part in self.parts for reach in part.reaches), math.inf)
        return float(np.max(np.asarray(self.extent / shortest, dtype=float)))

    @property
    def couplers(self):
        """Bars from a joint of one link to a joint of another."""
        return tuple(bar for bar in self.bars if all(self.joints[end].link != bar.link for end in (bar.start, bar.end)))

    def with_link(self, name, link):
        """The same mechanism with other mass properties of one link."""
        if name in self.crank.links:
            return replace(self, crank=replace(self.crank, link=link))
        groups = (group.with_link(name, link) if name in group.links else group for group in self.groups)
        return replace(self, groups=tuple(groups))

    def place(self, angle):
        """Joints and links at the crank angles; NaN where the mechanism cannot be assembled."""
        placement = self.crank.place(angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            for group in self.groups:
                place(group, placement)
        return placement

    def margins(self, placement, shape):
        """Closure margin of each group at the crank angles, for results of a shape."""
        return [margin(group, placement, shape) for group in self.groups]

    def resolve(self, placement, loads, along, of_part=None):
        """All forces, from the last group inwards, for given loads on links and forces along guides; a `Resolved`.

        ``of_part(part, placement, loads, along)`` may resolve each part in another way, as with friction.
        """
        loads, found = dict(loads), Resolved({}, {}, {})
        for part in (*reversed(self.groups), self.crank):
            resolved = of_part(part, placement, loads, along) if of_part else part.resolve(placement, loads, along)
            if not part.trusted:
                checks.require(self.name, *output_problems(part, resolved))
            found.reactions.update(resolved.reactions)
            found.scalars.update(resolved.scalars)
            for name, demand in resolved.demands.items():
                link, wrench = name, demand
                if name not in self.links:
                    link, wrench = wrench_at(placement, self.joints[name], *demand)
                if link == CRANK:
                    group = next(iter(part.links), CRANK)
                    found.demands[group] = found.demands.get(group, NOTHING).plus(wrench)
                if link != FRAME:
                    own = loads[link]
                    loads[link] = Wrench(subtract_vectors(own.force, wrench.force), minus(own.moment, wrench.moment))
        return found


def output_problems(part, resolved):
    """Yield undeclared results of a group, and declared results that are missing."""
    kind = type(part).__name__
    if not isinstance(resolved, Resolved):
        yield f"{kind}: its resolve must return a Resolved(reactions, scalars, demands), got {checks.shown(resolved)}"
        return
    couples = {pair.couple for pair in part.pairs.values() if isinstance(pair, Sliding)}  # friction reads them
    for vector, found in ((True, resolved.reactions), (False, resolved.scalars)):
        declared = {name for name, output in part.outputs.items() if output.vector == vector}
        what = "reaction" if vector else "quantity"
        undeclared = found.keys() - declared - couples
        yield from (f"{kind} resolves {what} {name!r}, which its outputs do not declare" for name in undeclared)
        yield from (f"{kind} declares {what} {name!r}, but does not resolve it" for name in declared - found.keys())
