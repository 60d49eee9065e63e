"""A mechanism: a crank and the chain of structural groups that hang on it."""

import warnings
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from . import checks, hints
from .batch import Batched
from .cam_roller import CamRoller
from .cams import CosineLaw
from .chain import MEMBERS, Adds, Forces, Once, added_by
from .crank import Crank
from .guide import Guide
from .links import Link, present
from .quantities import RATES, UNITS
from .rocker_group import RockerGroup
from .slider_group import SliderGroup

NAME = checks.Name()


class Chain:
    """Rule of a field that holds groups."""

    rule = checks.Own(MEMBERS, "a group: RockerGroup, SliderGroup, CamRoller or one of your own")

    def quick(self, value):
        if type(value) is tuple and all(type(group) in LIBRARY for group in value):
            return value
        return checks.UNSURE

    def taken(self, value, field=""):
        if not isinstance(value, tuple | list):
            return value, f"{field} must be a tuple of groups, got {checks.shown(value)}"
        found = [self.rule.taken(group, "a group") for group in value]
        found += [NAME.taken(getattr(group, "on", "O"), f"on of {type(group).__name__}") for group in value]
        problem = next((problem for _, problem in found if problem), None)
        return tuple(group for group, _ in found[: len(value)]), problem


REMEDY = "give the second group another pin, pivot_name or label"
LIBRARY = (SliderGroup, RockerGroup, CamRoller)


@dataclass(frozen=True, eq=False)
class Mechanism(Batched):
    """Crank and groups, in the order in which motion flows from one to the next.

    Parameters
    ----------
    name : str
        What messages and figures call it.
    crank : Crank
    groups : tuple
        `CamRoller`, `SliderGroup` ...; each hangs on a joint that the crank or an earlier group has placed.
    """

    name: str
    crank: Crank
    groups: tuple[Any, ...]

    RULES = checks.Rules("mechanism", name=NAME, crank=checks.Made(Crank, "a Crank"), groups=Chain())

    def __post_init__(self):
        self.RULES.admit(self)
        checks.require(self.name, *_name_problems((_named(self.crank), *map(_named, self.groups))))

    @cached_property
    def links(self):
        """Link by name, from the crank outwards."""
        return self._collected("links")

    @cached_property
    def references(self):
        """Reference joint by link, from the crank outwards."""
        return self._collected("references")

    def _collected(self, table):
        return {name: item for part in (self.crank, *self.groups) for name, item in getattr(part, table).items()}

    @property
    def bars(self):
        """Links that keep two joints at a distance, from the crank outwards."""
        return sum((group.bars for group in self.groups), self.crank.bars)

    @cached_property
    def of_library(self):
        """Whether all groups say what they add, as the library's own do."""
        return all(hasattr(group, "adds") for group in self.groups)

    @cached_property
    def hints(self):
        """What looks like a slip of units, as sentences."""
        return hints.of_mechanism(self)

    @cached_property
    def proportion(self):
        """Sum of all lengths over the shortest link or cam radius, the largest of a batch."""
        whole, shortest = 0.0, np.inf
        for part in (self.crank, *self.groups):
            for length in getattr(part, "lengths", [bar.length for bar in part.bars]):
                whole = whole + abs(length)
            for bar in part.bars:
                shortest = _smaller(shortest, bar.length)
            if isinstance(part, CamRoller):
                shortest = _smaller(shortest, part.smallest_radius)
        return float(np.max(whole / shortest))

    def group(self, kind):
        """First group of a kind, or None."""
        return next((group for group in self.groups if isinstance(group, kind)), None)

    def with_link(self, name, link):
        """The same mechanism with other mass properties of one link."""
        if name == "crank":
            return replace(self, crank=replace(self.crank, link=link))
        groups = (
            replace(group, **{name.removesuffix(getattr(group, "label", "")): link}) if name in group.links else group
            for group in self.groups
        )
        return replace(self, groups=tuple(groups))

    def place(self, angle):
        """Joints and links at the crank angles; NaN where the mechanism cannot be assembled."""
        placement = self.crank.place(angle)
        with np.errstate(divide="ignore", invalid="ignore"):
            for group in self.groups:
                group.place(placement)
        return placement

    def resolve(self, placement, loads, pushes):
        """All forces, from the last group inwards, for given link loads and pushes on the sliders."""
        forces = Forces() if self.of_library else Forces(reactions=Once(), scalars=Once())
        for group in reversed(self.groups):
            group.resolve(placement, loads, pushes, forces)
        self.crank.resolve(placement, loads, forces)
        return forces


def crank_slider(
    crank_length,
    coupler_length,
    *,
    guide_angle=0.0,
    guide_offset=0.0,
    guide=None,
    assembly=+1,
    crank=Link(),
    coupler=Link(),
    slider=Link(),
):
    """Plain crank-slider: crank O-A, coupler A-B, slider B on a straight guide.

    Parameters
    ----------
    crank_length, coupler_length : float or array
        m; arrays of shape (designs, 1) make a batch.
    guide_angle : float
        Direction of the guide from +x, rad.
    guide_offset : float or array
        Signed distance of the guide from O along the guide's left normal, m.
    guide : Guide
        In place of the two, as from ``Guide.through(W1, W2)``.
    assembly : +1 or -1
        +1: slider ahead of A along the guide.
    crank, coupler, slider : Link
        Mass properties; a link left out has no mass and costs nothing.

    Returns
    -------
    Mechanism

    Raises
    ------
    ParameterError
        A value no machine can have, or both ways of giving the guide.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> round(float(ks.solve(pump, 0.0, crank_speed=100.0).balancing_torque), 6)
    0.0
    """
    group = SliderGroup(coupler_length, _guide(guide, guide_angle, guide_offset), assembly, coupler, slider)
    return Mechanism("crank-slider", Crank(crank_length, crank), (group,))


def cam_crank_slider(
    cam,
    coupler_length,
    *,
    guide_angle=0.0,
    guide_offset=0.0,
    guide=None,
    assembly=+1,
    crank=Link(),
    block=Link(),
    coupler=Link(),
    slider=Link(),
):
    """Cam-balanced crank-slider: slotted crank, block with a roller on a fixed cam, coupler and slider.

    Parameters
    ----------
    cam : cams.Circle, cams.CosineLaw or cams.Sampled
        Fixed cam, by the pitch curve of the roller centre.
    coupler_length, guide_angle, guide_offset, guide, assembly, crank, coupler, slider
        As for `crank_slider`; the mass centre of the slotted crank lies on it at a constant distance from O.
    block : Link
        Block with roller; reference joint A, along the crank ray.

    Returns
    -------
    Mechanism

    Raises
    ------
    ParameterError
        A value no machine can have, or both ways of giving the guide.
    """
    group = SliderGroup(coupler_length, _guide(guide, guide_angle, guide_offset), assembly, coupler, slider)
    if isinstance(cam, CosineLaw):
        _warn_off_law(cam, group)
    return Mechanism("cam-balanced crank-slider", Crank(None, crank), (CamRoller(cam, block), group))


def four_bar(
    crank_length,
    coupler_length,
    rocker_length,
    *,
    rocker_pivot,
    assembly=+1,
    crank=Link(),
    coupler=Link(),
    rocker=Link(),
):
    """Four-bar: crank O-A, coupler A-B, rocker O2-B.

    Parameters
    ----------
    crank_length, coupler_length, rocker_length : float or array
        m; arrays of shape (designs, 1) make a batch.
    rocker_pivot : (x, y)
        Fixed pivot O2 of the rocker, m.
    assembly : +1 or -1
        +1: B to the left of the direction from A to O2.
    crank, coupler, rocker : Link
        Mass properties; a link left out has no mass and costs nothing.

    Returns
    -------
    Mechanism

    Raises
    ------
    ParameterError
        A value no machine can have.
    """
    group = RockerGroup(coupler_length, rocker_length, rocker_pivot, assembly, coupler, rocker)
    return Mechanism("four-bar", Crank(crank_length, crank), (group,))


def _warn_off_law(cam, group):
    """Warn if the slider will not follow the law that the cam is cut for."""
    angle, length = group.guide.guide_angle, group.coupler_length
    wrong = [
        text
        for text, value, wanted in [
            (f"guide_offset {group.guide.guide_offset} m is not 0", group.guide.guide_offset, 0.0),
            (f"assembly {group.assembly} is not +1", group.assembly, 1.0),
            (f"guide_angle {angle} is not the cam's {cam.guide_angle}", np.cos(angle - cam.guide_angle), 1.0),
            (f"coupler_length {length} m is not the cam's {cam.coupler_length} m", length, cam.coupler_length),
        ]
        if checks.known(value) and checks.known(wanted) and np.any(np.abs(value - wanted) > 1e-9)
    ]
    if wrong:
        warnings.warn(f"the slider will not follow the cosine law of its cam: {'; '.join(wrong)}", stacklevel=3)


class _Named(NamedTuple):
    """What a part is, what it hangs on and what it adds, by names."""

    kind: str
    on: str
    adds: Adds


def _named(part):
    return _Named(type(part).__name__, getattr(part, "on", "O"), added_by(part))


@lru_cache(maxsize=256)
def _name_problems(parts):
    """What is wrong with the names in a chain of parts: unknown ones, and ones that two things would have."""
    points: dict[str, str] = {}
    forces = dict.fromkeys(("closure", *UNITS), "result of every mechanism")
    problems = []

    def add(table, what, kind, names):
        for name in names:
            if name in table:
                problems.append(f"{kind} adds {what} {name!r} a second time, after the {table[name]}; {REMEDY}")
            table[name] = f"{what} of {kind}"

    for kind, on, adds in parts:
        if on not in points and on != "O":
            remedy = "; give the crank a length, or put a CamRoller before it" if on == "A" else ""
            problems.append(f"{kind} hangs on joint {on!r}, which no part before it places{remedy}")
        add(points, "joint", kind, adds.joints)
        add(points, "link", kind, adds.links)
        add(forces, "reaction", kind, adds.reactions)
        rates = {f"{link}{ending}" for link in adds.links for ending in RATES}
        add(forces, "quantity", kind, [name for name in (*adds.scalars, *rates) if name not in UNITS])
    return problems


def _smaller(a, b):
    plain = isinstance(a, float) and isinstance(b, float | int)
    return min(a, b) if plain else np.minimum(a, b)


def _guide(guide, angle, offset):
    if guide is None:
        return Guide.at(angle, offset)
    free = present(angle) is None and present(offset) is None
    checks.require("guide", None if free else "give either guide or guide_angle and guide_offset")
    return guide
