"""Inputs of a solution: its crank angles, its drive and loads, and every number of its scene by path.

Paths are those of case files: "crank_length", "slider.mass". A number that is zero, or part of a direction along an
axis, is absent from the recorded program unless it is kept. Implausible numbers give hints at wrong units.
"""

import math
import warnings
from dataclasses import replace
from typing import ClassVar, NamedTuple

import numpy as np

from ..engines.program import plausibility_test
from ..errors import HintWarning, ParameterError
from ..machine import plausibility
from ..machine.loads import value_of
from ..machine.mechanism import Mechanism
from ..mechanics.motion import SceneParts
from ..numbers import checks, paths
from ..numbers.arithmetic import read_only
from ..numbers.checks import PlausibleRange, plausible_range_of
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import (
    Axis,
    KeptZero,
    LeafIndex,
    construct_unchecked,
    map_numbers,
    replace_unchecked,
    unflatten,
)

DRIVE = checks.Rules(
    "drive", crank_speed=checks.Number("rad/s", table=True), crank_acceleration=checks.Number("rad/s**2", table=True)
)
SENSE = checks.Optional(checks.Number("1", table=True))
ANGLE_RULE = checks.Number("rad", "crank_angle", table=True)
PLAIN_TYPES = int, float, list, tuple
FLOAT_TYPES = (np.dtype(np.float64), np.dtype(np.float32))
BYTES_PER_VALUE = 8
MAX_ANGLES = checks.MAX_TABLE_MEMORY // BYTES_PER_VALUE
"""Crank angles that fit into memory."""


# Crank angles


def crank_angles(given, owner="solve"):
    """Crank angles as an array: a read-only copy of plain ones; an array of another library as it is."""
    if type(given) is np.ndarray and given.dtype in FLOAT_TYPES and given.size <= MAX_ANGLES:
        return read_only(given.copy())
    if ANGLE_RULE.quick(given) is not checks.UNDECIDED:
        return read_only(np.array(float(given)))
    if isinstance(given, list | tuple) and not given:
        checks.require(owner, "there are no crank angles")
    if isinstance(given, np.ndarray) and given.size:
        checks.require(owner, checks.count("the number of crank angles", given.size, size=BYTES_PER_VALUE))
    angle, problem = ANGLE_RULE.check(given)
    checks.require(owner, problem)
    return angle if hasattr(angle, "shape") else read_only(np.array(angle))


def hint_at_angles(owner, given):
    """Warn the caller's caller if valid crank angles look like degrees, or like a count of angles."""
    if type(given) is float and abs(given) < plausibility.TWO_TURNS:
        return
    for text in plausibility.angle_hints(np.asarray(given) if isinstance(given, PLAIN_TYPES) else given, given):
        warnings.warn(HintWarning(owner, text), stacklevel=3)


def angle_problem(angle):
    """Sentence if there are no crank angles, or one is not finite; else None. Foreign arrays are not evaluated."""
    if not (angle.size if isinstance(angle, np.ndarray) else math.prod(angle.shape)):
        return "there are no crank angles"
    if not isinstance(angle, np.ndarray) or angle.dtype == object:
        return None
    finite = (angle.ndim < 2 and math.isfinite(angle.dot(angle))) or np.isfinite(angle).all()  # dot costs a quarter
    return None if finite else "crank angles must be finite; found NaN or infinity"


# Drive and loads of a scene or solution


def tables_over_angles(item):
    """Names of the drive and loads that have one value for each given crank angle and none between."""
    drive = ("crank_speed", item.crank_speed), ("crank_acceleration", item.crank_acceleration)
    loads = ((type(load).__name__, value_of(load)) for load in item.loads)
    return [
        name for name, value in (*drive, *loads) if np.ndim(value) and np.shape(value)[-1] > 1 and not callable(value)
    ]


def require_known_between_angles(item):
    """Refuse drives and loads that are tables over the given crank angles."""
    varying = tables_over_angles(item)
    if varying:
        raise ParameterError(
            f"{', '.join(varying)} is a table over the given crank angles, without values between them. Use a constant "
            "(or, for a load, a Table or a function of the motion) to evaluate at other angles"
        )


def drive_and_loads_text(item):
    """Drive and loads in one line, for reprs."""

    def shown(value):
        return checks.shown(value) if np.ndim(value) == 0 else f"<array of shape {np.shape(value)}>"

    loads = ", ".join(type(load).__name__ for load in item.loads) or "no loads"
    drive = f"crank_speed={shown(item.crank_speed)}, crank_acceleration={shown(item.crank_acceleration)}"
    friction = f", friction at {', '.join(item.friction)}" if item.friction else ""
    sense = "" if item.sense is None else f", sense={shown(item.sense)}"
    return f"{drive}{sense}, {loads}{friction}"


def of_design(solution, place, index=None):
    """The solution of one design of a batch, by its index `place`, unchecked.

    Drive and loads that are tables over the crank angles get their values at the angle with this `index`, if given.
    """
    batch = solution.shape[:-1]

    def number(leaf):
        if not np.ndim(leaf):
            return float(leaf)
        if np.shape(leaf)[-1] == 1:
            return float(np.broadcast_to(leaf, (*batch, 1))[place][0])
        fits = index is not None and np.shape(leaf)[-1] == solution.shape[-1]
        return float(np.broadcast_to(leaf, solution.shape)[place][index]) if fits else leaf

    return replace(solution, **{name: map_numbers(getattr(solution, name), number) for name in SceneParts._fields})


# Numbers by path


class Parameters:
    """Numbers of a mechanism, its drive and its loads, named as in case files."""

    PATHS: ClassVar = {"mechanism": "", "loads": "", "friction": ""}
    RULES = checks.Rules(
        "scene",
        mechanism=checks.InstanceOf(Mechanism, "a Mechanism"),
        **DRIVE.rules,
        loads=checks.HasMembers((), "loads"),
        friction=checks.HasMembers((), "friction"),
        sense=SENSE,
    )

    @cached_property
    def places(self):
        """Place of each number by path, with its unit and rule."""
        return paths.places_by_path(self)


def path_problem(scene, path, known=None):
    """Sentence on an unknown path, else None; `known` are by default all paths of the scene."""
    problem = checks.choice("parameter", path, tuple(scene.places if known is None else known))
    is_other = problem and isinstance(path, str) and path not in scene.places
    place = paths.places_by_path(scene, absent=True).get(path) if is_other else None
    if place is None:
        return problem
    within = place.steps[:-1]
    others = [name for name, other in scene.places.items() if other.steps[: len(within)] == within]
    instead = getattr(place._replace(steps=within).value(scene), "instead", "")
    beside = f"; its neighbours are {', '.join(others)}" if others else ""
    return f"parameter {path} has no number here{instead}{beside}"


def leaf_by_path(places, state):
    """Number of the leaf of a `Dynamics` by path; zeros are absent."""
    numbered = state.kind.numbered
    found = {path: place.value(numbered) for path, place in places.items()}
    return {path: number for path, number in found.items() if isinstance(number, LeafIndex)}


def keep_numbers(scene, places, wanted):
    """The scene with the wanted numbers kept in its programs, even if zero or part of an axis; unchecked."""
    kept = {}
    for path in wanted:
        place = places[path]
        value, owner = place.value(scene), place._replace(steps=place.steps[:-1]).value(scene)
        if isinstance(owner, Axis) or is_zero(value):
            kept[place.steps] = KeptZero(0.0) if is_zero(value) else value
    return paths.with_values(scene, kept, replace_unchecked) if kept else scene


def is_zero(value):
    """Whether a value is the plain number zero, which is absent from a program unless it is kept."""
    return isinstance(value, int | float) and value == 0


def has_joint_rule(item, steps):
    """Whether a number belongs to a part whose rules check several of its numbers together."""
    for step in steps:
        rules = getattr(item, "RULES", None)
        if rules is not None and rules.also is not None:
            return True
        item = item[step] if isinstance(step, int) else getattr(item, step)
    return False


def paths_without_derivative(places, mechanism):
    """Paths of the sense, and of lengths that decide which change points are passed."""
    return passage_paths(places, mechanism, [group for group in mechanism.groups if group.passes]) | {"sense"}


def require_derivatives(owner, mechanism, paths, without):
    """Refuse paths that have no derivative, see `paths_without_derivative`."""
    checks.require(
        owner,
        *(
            f"there is no derivative by {path}: "
            + (
                "it is either +1 or -1; solve with each"
                if path == "sense"
                else f"{mechanism.name} passes change points, and with any other length it would be of another kind"
            )
            for path in paths
            if path in without
        ),
    )


def passage_paths(places, mechanism, groups):
    """Paths that decide which change points some groups pass: pins of the crank, own lengths and guides.

    For a group on a rocker also all lengths before it, which determine the rocker's motion.
    """
    numbers = [number for number, group in enumerate(mechanism.groups) if group in groups]
    pins = {group.on for group in groups}
    numbers += range(max((number for number in numbers if mechanism.groups[number].carrier), default=0))
    numbers += [number for number, group in enumerate(mechanism.groups) if pins.intersection(group.throws)]
    owners = [("mechanism", "groups", number) for number in numbers] + [("mechanism", "crank")] * bool(numbers)
    links = {"link"}.union(*(group.own_names.values() for group in groups))
    return {
        path
        for path, place in places.items()
        if any(place.steps[: len(owner)] == owner for owner in owners) and not links & set(place.steps)
    }


# Hints at slips of units


class PlausibleNumber(NamedTuple):
    """A number of a structure of scenes with a plausible range, by its place among the leaves.

    `is_in_extent`: whether it counts among the lengths of the mechanism together.
    """

    path: str
    leaf: int
    usual: PlausibleRange
    is_in_extent: bool


def scene_plausibility_test(kind):
    """Fast test of a structure, see `plausibility_test`; it compares all lengths of the mechanism."""
    numbers = (item for item in kind.answer(plausible_numbers) if not item.is_in_extent)
    return plausibility_test(kind, [(item.leaf, item.usual) for item in numbers])


def plausible_numbers(kind):
    """Each `PlausibleNumber` of a structure."""
    ones = construct_unchecked(
        Parameters, **unflatten(kind.structure, lambda: 1.0, lambda: None, lambda: None)._asdict()
    )
    numbered, found = construct_unchecked(Parameters, **kind.numbered._asdict()), []
    for path, place in paths.places_by_path(ones).items():
        leaf, usual = place.value(numbered), plausible_range_of(place.rule)
        if isinstance(leaf, LeafIndex) and usual:
            is_length = place.rule.usual is None and usual.unit == "m"  # positions along the shaft have their own
            found.append(PlausibleNumber(path, leaf, usual, is_length and place.steps[0] == "mechanism"))
    return found


def plausibility_hints(solution):
    """Sentences on numbers of a solution's scene that look like mistakes."""
    values = solution.apart[1].numbers
    numbers = [(path, values[leaf], usual) for path, leaf, usual, _ in solution.kind.answer(plausible_numbers)]
    mechanism = solution.mechanism
    return (
        *plausibility.scene_hints(mechanism, solution.crank_speed, numbers),
        *plausibility.load_hints(mechanism, solution.loads),
        *plausibility.table_hints(solution),
        *plausibility.spring_hints(mechanism, solution.loads, solution.crank_speed),
    )
