"""The numbers of a scene by path, and what they are to a program: absent where zero, judged together with others."""

from typing import ClassVar

from ..machine.mechanism import Mechanism
from ..numbers import checks, paths
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import Axis, KeptZero, LeafIndex, replace_unchecked

DRIVE = checks.Rules(
    "drive", crank_speed=checks.Number("rad/s", table=True), crank_acceleration=checks.Number("rad/s**2", table=True)
)
SENSE = checks.Optional(checks.Number("1", table=True))


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
        """Where each number stands, by path, with its unit and rule."""
        return paths.places_by_path(self)


def path_problem(scene, path, known=None):
    """What is wrong with a path that is none of the known ones of a scene, all unless told; or None."""
    problem = checks.choice("parameter", path, tuple(scene.places if known is None else known))
    is_other = problem and isinstance(path, str) and path not in scene.places
    place = paths.places_by_path(scene, absent=True).get(path) if is_other else None
    if place is None:
        return problem
    within = place.steps[:-1]
    others = [name for name, other in scene.places.items() if other.steps[: len(within)] == within]
    told = getattr(place._replace(steps=within).value(scene), "instead", "")
    beside = f"; beside it stand {', '.join(others)}" if others else ""
    return f"parameter {path} has no number here{told}{beside}"


def leaf_by_path(places, state):
    """Which leaf of a `Dynamics` each number is, by path; of what is zero, and so absent, none."""
    numbered = state.kind.numbered
    found = {path: place.value(numbered) for path, place in places.items()}
    return {path: number for path, number in found.items() if isinstance(number, LeafIndex)}


def keep_numbers(scene, places, wanted):
    """The scene with the wanted numbers that are zero or of an axis, and so absent from programs, kept as numbers."""
    for path in wanted:
        place = places[path]
        owner = place._replace(steps=place.steps[:-1])
        if isinstance(owner.value(scene), Axis) or is_zero(place.value(scene)):
            scene = _keep_number(scene, place.steps)
    return scene


def is_zero(value):
    """Whether a value is the one number zero, which is absent from a program unless it is kept."""
    return isinstance(value, int | float) and value == 0


def _keep_number(item, steps):
    """Copy of a tree in which a number, though it is zero or of an axis, is kept as one; nothing is checked."""
    if not steps:
        return KeptZero(0.0) if item == 0 else item
    step, *rest = steps
    if isinstance(step, int):
        return tuple(_keep_number(part, rest) if place == step else part for place, part in enumerate(item))
    return replace_unchecked(item, **{step: _keep_number(getattr(item, step), rest)})


def has_joint_rule(item, steps):
    """Whether a number stands in a part that has rules for several of its numbers together."""
    for step in steps:
        rules = getattr(item, "RULES", None)
        if rules is not None and rules.also is not None:
            return True
        item = item[step] if isinstance(step, int) else getattr(item, step)
    return False


def paths_without_derivative(places, mechanism):
    """Paths by which there is no derivative: the sense, and lengths of which any other makes another kind."""
    return passage_paths(places, mechanism, [group for group in mechanism.groups if group.passes]) | {"sense"}


def require_derivatives(owner, mechanism, paths, fixed):
    """Refuse to derive by a length that decides which change points are passed, and by the sense of rotation."""
    checks.require(
        owner,
        *(
            f"there is no derivative by {path}: "
            + (
                "it is +1 or -1 and nothing between; solve with each"
                if path == "sense"
                else f"{mechanism.name} passes change points, and with any other length it would be of another kind"
            )
            for path in paths
            if path in fixed
        ),
    )


def passage_paths(places, mechanism, groups):
    """Paths of what decides which change points some groups pass: pins of the crank, their own lengths and lines."""
    numbers = [number for number, group in enumerate(mechanism.groups) if group in groups]
    pins = {group.on for group in groups}
    numbers += [number for number, group in enumerate(mechanism.groups) if pins.intersection(group.throws)]
    owners = [("mechanism", "groups", number) for number in numbers] + [("mechanism", "crank")] * bool(numbers)
    links = {"link"}.union(*(group.own_names.values() for group in groups))
    return {
        path
        for path, place in places.items()
        if any(place.steps[: len(owner)] == owner for owner in owners) and not links & set(place.steps)
    }
