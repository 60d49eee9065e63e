"""What a scene is made of, and how much of it a quantity needs: the smallest model within a tolerance.

An ingredient can be left out or put more simply. `needs` tries every combination by running it, counts the operations
each one takes at a crank angle, and names the cheapest that keeps the quantity.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ..engines import programs
from ..engines.engines import Kernels
from ..engines.series import harmonic_series
from ..errors import NotGivenError, ParameterError
from ..machine.links import Link
from ..machine.loads import Gravity, ProcessForce, Spring
from ..machine.rocker_group import RockerGroup
from ..machine.slider_group import SliderGroup
from ..mechanics.quantities import components, label
from ..numbers import checks
from ..solution.solution import Solution

MOST_MODELS = 20_000
"""Combinations that `needs` is ready to run."""


@dataclass(frozen=True)
class Choice:
    """One simplification: what it is called, and how it is made; None where it changes nothing.

    Where it cannot be made it raises `NotGivenError`, which says why.
    """

    name: str
    simplified: Callable[[Solution], Solution | None]


def two_mass_coupler(mechanism):
    """The mechanism with each coupler replaced by two point masses at its joints; None if no coupler has mass.

    Total mass and the place of the mass centre along the link are kept; the moment of inertia becomes
    m s (l - s), whatever it was (Biezeno and Grammel, *Technische Dynamik*).

    Raises
    ------
    NotGivenError
        A mass centre lies beyond a joint, so that the mass at the other would be negative.
    """
    made = mechanism
    for group in mechanism.groups:
        if not isinstance(group, SliderGroup | RockerGroup):
            continue
        name, output = group.links
        coupler = group.links[name]
        if _is_zero(coupler.mass):
            continue
        outer = coupler.mass * coupler.centre[0] / group.coupler_length
        if np.any(outer < 0) or np.any(outer > coupler.mass):
            raise NotGivenError(
                f"the mass centre of the {name}, {coupler.centre[0]} m along its {group.coupler_length} m, lies beyond "
                "its joints, so one of two masses there would be negative"
            )
        carrier, place = _carrier(mechanism, group.on)
        far = (group.rocker_length, 0.0) if isinstance(group, RockerGroup) else (0.0, 0.0)
        for link, mass, at in ((carrier, coupler.mass - outer, place), (output, outer, far)):
            made = made.with_link(link, made.links[link].joined(mass, at))
        made = made.with_link(name, Link())
    return None if made is mechanism else made


def _carrier(mechanism, joint):
    """Link that carries a joint, and where on it the joint lies."""
    held = {bar.end: (bar.link, (bar.length, 0.0)) for bar in mechanism.bars}
    return held.get(joint) or ("block", (0.0, 0.0))


def _is_zero(value):
    return isinstance(value, int | float) and value == 0


# Simplifications of a scene, each a function of the solution; None if there is nothing to simplify


def _without_load(kind):
    def simplified(solution):
        kept = tuple(item for item in solution.loads if not isinstance(item, kind))
        return replace(solution, loads=kept) if len(kept) < len(solution.loads) else None

    return simplified


def _at_constant_speed(solution):
    return None if _is_zero(solution.crank_acceleration) else replace(solution, crank_acceleration=0.0)


def _with_links(changed):
    """Simplification that changes every link by ``changed(name, link)``."""

    def simplified(solution):
        mechanism = solution.mechanism
        for name, link in solution.mechanism.links.items():
            new = changed(name, link)
            if new is not None:
                mechanism = mechanism.with_link(name, new)
        return None if mechanism is solution.mechanism else replace(solution, mechanism=mechanism)

    return simplified


def _massless(kind):
    def changed(name, link):
        absent = _is_zero(link.mass) and _is_zero(link.inertia)
        return None if absent or not name.startswith(kind) else Link()

    return _with_links(changed)


def _without_inertia(kind):
    return _with_links(
        lambda name, link: replace(link, inertia=0.0) if name.startswith(kind) and not _is_zero(link.inertia) else None
    )


def _centred(name, link):
    return None if _is_zero(link.centre[1]) else replace(link, centre=(link.centre[0], 0.0))


def _as_two_masses(solution):
    mechanism = two_mass_coupler(solution.mechanism)
    return None if mechanism is None else replace(solution, mechanism=mechanism)


def _guide_through_crank_centre(solution):
    mechanism = solution.mechanism
    groups = tuple(
        replace(group, guide=replace(group.guide, guide_offset=0.0)) if isinstance(group, SliderGroup) else group
        for group in mechanism.groups
    )
    offset = [group.guide.guide_offset for group in mechanism.groups if isinstance(group, SliderGroup)]
    return None if all(map(_is_zero, offset)) else replace(solution, mechanism=replace(mechanism, groups=groups))


def _up_to_harmonic(order):
    return lambda solution: replace(solution, engine=Kernels(harmonic_series(solution, order)))


INGREDIENTS = {
    "gravity": (Choice("no gravity", _without_load(Gravity)),),
    "spring": (Choice("no spring", _without_load(Spring)),),
    "process force": (Choice("no process force", _without_load(ProcessForce)),),
    "crank acceleration": (Choice("constant crank speed", _at_constant_speed),),
    "guide offset": (Choice("guide through O", _guide_through_crank_centre),),
    "mass-centre offsets": (Choice("mass centres on the links", _with_links(_centred)),),
    "crank": (Choice("massless crank", _massless("crank")),),
    "block": (Choice("massless block", _massless("block")),),
    "rocker": (
        Choice("no rocker inertia", _without_inertia("rocker")),
        Choice("massless rocker", _massless("rocker")),
    ),
    "slider": (Choice("massless slider", _massless("slider")),),
    "coupler": (
        Choice("no coupler inertia", _without_inertia("coupler")),
        Choice("two-mass coupler", _as_two_masses),
        Choice("massless coupler", _massless("coupler")),
    ),
    "kinematics": (
        Choice("two harmonics", _up_to_harmonic(2)),
        Choice("one harmonic", _up_to_harmonic(1)),
    ),
}
"""By ingredient: how it can be simplified, from the least to the most; applied in this order.

Other links come before the coupler, which shares its mass out to them, and kinematics come last.
"""


@dataclass(frozen=True, eq=False)
class Model:
    """A scene with some of it left out or simplified.

    Attributes
    ----------
    simplifications : tuple of str
        What was done; empty for the full scene.
    error : float
        Largest change of the quantity over the crank angles, relative to its largest value in the full scene.
    operations : int
        Arithmetic operations at each crank angle that the quantity takes.
    solution : Solution
        The model itself, ready to use.
    """

    simplifications: tuple[str, ...]
    error: float
    operations: int
    solution: Solution

    @property
    def name(self):
        return ", ".join(self.simplifications) or "full scene"


@dataclass(frozen=True, eq=False)
class Needs:
    """How much of a scene a quantity needs; made by `needs`.

    Attributes
    ----------
    quantity : str
    within : float
        Change of the quantity that is allowed, relative to its largest value.
    full : Model
    alone : tuple of Model
        Each simplification by itself.
    ladder : tuple of Model
        From the full scene down, each the cheapest of all combinations with so small an error.
    smallest : Model
        The cheapest of all combinations within the tolerance; of equally cheap ones, that with the least in it.
    tried : int
        Number of combinations run.
    left_out : dict of str to str
        Simplifications that were not tried in combinations, by name, and why not.
    """

    quantity: str
    within: float
    full: Model
    alone: tuple[Model, ...]
    ladder: tuple[Model, ...]
    smallest: Model
    tried: int
    left_out: dict[str, str] = field(default_factory=dict)

    def __str__(self):
        saved = 1 - self.smallest.operations / self.full.operations
        return (
            f"{label(self.quantity)} within {self.within:.3g}: {self.smallest.name}, {self.smallest.operations} of "
            f"{self.full.operations} operations ({saved:.0%} saved), error {self.smallest.error:.2g}; "
            f"{self.tried} models run{self._omissions()}"
        )

    def _omissions(self):
        return "".join(f"; {name} left out: {why}" for name, why in self.left_out.items())

    __repr__ = __str__

    def frame(self):
        """Each simplification alone: change of the quantity, and operations and time it saves, a pandas DataFrame."""
        return _frame((self.full, *self.alone), self.quantity, self.full)

    def ladder_frame(self):
        """The rungs from the full scene to the least, a pandas DataFrame."""
        return _frame(self.ladder, self.quantity, self.full)


def needs(scene, quantity, within=0.01, *, variant=None) -> Needs:
    """How much model a quantity needs: every combination of simplifications run, the cheapest one named.

    Left out or put more simply: gravity, springs, process forces, crank acceleration, guide offset, mass-centre offsets
    across the links, masses of crank, block, coupler, slider and rocker, inertia of coupler and rocker about their
    centres, the coupler as two masses at its joints, and kinematics as Fourier series of one or two harmonics. Where
    that makes more than `MOST_MODELS` combinations, the simplifications that alone change most are left out; so are
    those that the scene does not allow, such as two masses for a coupler whose mass centre lies beyond its joints. The
    result tells them by name, with the reason.

    Parameters
    ----------
    scene : Solution or Case
        A solution of a single design, over the crank angles that matter.
    quantity : str
        "balancing_torque", a joint (its reaction, as a vector), "slider_acceleration" ...
    within : float
        Allowed change relative to the quantity's largest value.
    variant : str, optional
        Of a case; its reference unless told.

    Returns
    -------
    Needs
        `.smallest`, with its `.solution`; `.left_out`, `.frame()`, `.ladder_frame()`, ``ks.plots.model_ladder(needs)``.

    Raises
    ------
    ParameterError
        The solution is a batch, the quantity zero throughout, or the tolerance not positive.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.needs(ks.load_case("sawframe_2r63"), "O", within=0.05).smallest.name
    'no gravity, two-mass coupler'
    """
    known = isinstance(scene, Solution) or hasattr(scene, "variants")
    checks.require(
        "needs",
        checks.positive("within", within),
        None if known else f"scene must be a Solution or a Case, got {scene!r}",
        checks.quantity(quantity),
        "variant is for a case, a solution is of one" if variant and isinstance(scene, Solution) else None,
    )
    solution = scene if isinstance(scene, Solution) else scene.solve(variant or scene.reference)
    if len(solution.shape) != 1:
        raise ParameterError(f"needs looks at one design over its crank angles, but this has shape {solution.shape}")
    exact = np.array(components(solution, quantity))
    largest = np.linalg.norm(exact, axis=0).max()
    if not largest > 0:
        raise ParameterError(f"needs: {quantity} is {largest} in this scene; there is nothing to compare with")

    left_out: dict[str, str] = {}

    def model(choices):
        simplified = solution
        for choice in choices:
            try:
                made = choice.simplified(simplified)
            except NotGivenError as why:
                left_out[choice.name] = str(why)
                return None
            if made is None:
                return None
            simplified = made
        with np.errstate(all="ignore"):
            change = np.linalg.norm(np.array(components(simplified, quantity)) - exact, axis=0).max() / largest
        error = float(change) if math.isfinite(change) else math.inf
        names = tuple(choice.name for choice in choices)
        return Model(names, error, programs.of(simplified.dynamics, (quantity,))[0].recording.operations, simplified)

    alone = {choice: made for choices in INGREDIENTS.values() for choice in choices if (made := model((choice,)))}
    options = _options(alone, left_out)
    combinations = (tuple(filter(None, picked)) for picked in itertools.product(*options))
    models = [made for choices in combinations if (made := model(choices))]
    ladder = _front(models)
    allowed = [made for made in models if made.error <= within]
    smallest = min(allowed, key=lambda made: (made.operations, -len(made.simplifications), made.error))
    return Needs(quantity, within, models[0], tuple(alone.values()), tuple(ladder), smallest, len(models), left_out)


def _options(alone, left_out):
    """By ingredient: None and its simplifications; those that change most are left out if there are too many models."""
    kept = set(alone)

    def options():
        return [(None, *(item for item in choices if item in kept)) for choices in INGREDIENTS.values()]

    while math.prod(map(len, options())) > MOST_MODELS:
        worst = max(kept, key=lambda choice: alone[choice].error)
        kept.remove(worst)
        left_out[worst.name] = (
            f"alone it changes {alone[worst].error:.2g}, and there are more than {MOST_MODELS} models"
        )
    return options()


def _front(models):
    """Models that no other beats in both error and operations, from the full scene down."""
    front: list[Model] = []
    for made in sorted(models, key=lambda made: (made.error, made.operations, len(made.simplifications))):
        if not front or made.operations < front[-1].operations:
            front.append(made)
    return front


def _frame(models, quantity, full):
    import pandas as pd

    from .timing import seconds

    times = seconds(*(partial(_afresh, made.solution, quantity) for made in models))
    rows = [
        {
            "model": made.name,
            "change": made.error,
            "operations": made.operations,
            "operations saved": full.operations - made.operations,
            "time [ns/angle]": 1e9 * time / made.solution.crank_angle.size,
        }
        for made, time in zip(models, times, strict=True)
    ]
    return pd.DataFrame(rows).set_index("model")


def _afresh(solution, quantity):
    return components(replace(solution), quantity)
