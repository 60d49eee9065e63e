"""The smallest model of a scene that keeps a quantity within a tolerance.

`needs` runs every combination of simplifications, counts the operations at each crank angle, and names the cheapest
combination within the tolerance. Errors may cancel. So a simplification with too large an error is still tried in
combinations, unless there are too many models.

`simplifications` makes each simplified solution, such as "no spring".
"""

import itertools
import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..engines.program import program_of
from ..errors import NotGivenError, ParameterError
from ..mechanics.quantities import components, label_of
from ..numbers import checks
from ..sizing.sections import rigidity_of
from ..solution.solution import Solution
from .simplifications import ingredients

MAX_MODELS = 2_000
"""Largest number of combinations that `needs` runs: a minute of work."""
PROGRESS_DELAY = 10.0
"""Time until a progress bar appears, s."""


@dataclass(frozen=True, eq=False)
class Model:
    """A scene with some of its parts left out or simplified.

    Attributes
    ----------
    simplifications : tuple of str
        Names of the simplifications; empty for the full scene.
    error : float
        Largest change of the quantity over the crank angles, relative to its largest value in the full scene.
    operations : int
        Arithmetic operations for the quantity at each crank angle.
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
    """The models that a quantity needs; `needs` returns it.

    Attributes
    ----------
    quantity : str
    within : float
        Allowed change of the quantity, relative to its largest value.
    full : Model
    alone : tuple of Model
        Models with a single simplification.
    ladder : tuple of Model
        Models from the full scene down: each is the cheapest combination with at most its error.
    smallest : Model
        The cheapest combination within the tolerance, and of equally cheap ones the most simplified. Combinations with
        the simplifications in `left_out` were not run.
    tried : int
        Number of combinations run.
    left_out : dict of str to str
        Simplifications that were not tried in combinations, with the reason.
    rigidity : dict of str to Sized
        By link with a bar, and "shaft": natural frequency, rad/s, its `order`, and deflection relative to the length or
        in rad. `departure` is the relative error of a rigid part; ``.table()`` has formulas.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> found = ks.needs(ks.Scene(saw, 33.5).solve(90), "balancing_torque", within=0.05, progress=False)
    >>> found.smallest.name
    'two-mass coupler'
    """

    quantity: str
    within: float
    full: Model
    alone: tuple[Model, ...]
    ladder: tuple[Model, ...]
    smallest: Model
    tried: int
    left_out: dict[str, str] = field(default_factory=dict)
    rigidity: dict[str, Any] = field(default_factory=dict)

    def __str__(self):
        saved = 1 - self.smallest.operations / self.full.operations
        return (
            f"{self.label} within {self.within:.3g}: {self.smallest.name}, {self.smallest.operations} of "
            f"{self.full.operations} operations ({saved:.0%} saved), error {self.smallest.error:.2g}; "
            f"{self.tried} models run" + "".join(f"; {name} left out: {why}" for name, why in self.left_out.items())
        ) + "".join(
            f"; rigid {name}: error {found.departure:.2g}, its frequency {found.order:.3g} times that of the crank"
            for name, found in self.rigidity.items()
        )

    @property
    def label(self):
        """Label of the quantity in tables and charts."""
        return label_of(self.full.solution, self.quantity)

    __repr__ = __str__

    def frame(self):
        """Each single simplification: change of the quantity, saved operations and time, a pandas DataFrame."""
        return _frame((self.full, *self.alone), self.quantity, self.full)

    def ladder_frame(self):
        """The models of `ladder`, a pandas DataFrame."""
        return _frame(self.ladder, self.quantity, self.full)


def needs(scene, quantity, within=0.01, *, variant=None, progress=True, bars=None, shaft=None) -> Needs:
    """Find the cheapest model within a tolerance: run every combination of simplifications.

    Simplifications omit gravity, springs, process forces, and friction of pins, guides, slots or rollers. They set a
    constant crank speed, a guide through O, mass centres on the links, massless links, or no inertia of links with two
    joints. They replace a coupler by two masses at its joints, and kinematics by Fourier series of one or two
    harmonics.

    Links of one kind, such as coupler and coupler2, are simplified together, and so are joints with one kind of
    friction. Above 2000 combinations, the simplifications with the largest single errors are left out; a cheaper model
    with cancelling errors would then be missed. Simplifications that the scene does not allow are also left out.
    Examples are two masses for a coupler whose mass centre is beyond its joints, or harmonics that move a slider beyond
    the table of its load. `Needs.left_out` lists both with the reason.

    Parameters
    ----------
    scene : Solution or Case
        A solution of a single design, at the relevant crank angles.
    quantity : str
        "balancing_torque", a joint (its reaction, as a vector), "slider_acceleration" ...
    within : float
        Allowed change relative to the quantity's largest value.
    variant : str, optional
        Variant of a case; by default its reference.
    progress : bool
        Whether a progress bar appears after ten seconds.
    bars : mapping of link to Bar, optional
        Sections of straight links; `Needs.rigidity` compares them with rigid links.
    shaft : mapping, optional
        Shaft between drive and crank: "length", m, "polar_moment", m4, "shear_modulus", Pa; compared in the same way.

    Returns
    -------
    Needs
        `.smallest`, with its `.solution`; `.left_out`, `.frame()`, `.ladder_frame()`, ``ks.plots.model_ladder(needs)``.

    Raises
    ------
    ParameterError
        The solution is a batch, the quantity zero throughout, or the tolerance not positive. A bar is invalid for
        `Solution.sections`, or has no `second_moment` or `youngs_modulus`; the crank of a bar or shaft is at rest.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.needs(ks.load_case("sawframe_2r63"), "O", within=0.05).smallest.name
    'no gravity, two-mass coupler'
    """
    from tqdm import tqdm

    known = isinstance(scene, Solution) or hasattr(scene, "variants")
    within = checks.single_numbers(
        "needs",
        None if known else f"scene must be a Solution or a Case, got {scene!r}",
        checks.quantity(quantity),
        "variant is for a case; a solution has one variant" if variant and isinstance(scene, Solution) else None,
        within=(within, "1", {"low": 0.0, "strict": True}),
    )["within"]
    solution = scene if isinstance(scene, Solution) else scene.solve(variant or scene.reference)
    if len(solution.shape) != 1:
        raise ParameterError(f"needs takes a single design over its crank angles, got shape {solution.shape}")
    rigidity = rigidity_of(solution, bars, shaft)
    runs = _ModelRunner(solution, quantity)
    parts = ingredients(solution.mechanism).values()
    alone = {choice: made for choices in parts for choice in choices if (made := runs.of((choice,)))}
    options = _choices_by_ingredient(parts, alone, runs.left_out)
    combinations = (tuple(filter(None, picked)) for picked in itertools.product(*options))
    total, hidden = math.prod(map(len, options)), not progress
    bar = tqdm(combinations, total=total, unit=" models", delay=PROGRESS_DELAY, leave=False, disable=hidden)
    models = [made for choices in bar if (made := runs.of(choices))]
    allowed = [made for made in models if made.error <= within]
    smallest = min(allowed, key=lambda made: (made.operations, -len(made.simplifications), made.error))
    ladder: list[Model] = []
    for made in sorted(models, key=lambda made: (made.error, made.operations, len(made.simplifications))):
        if not ladder or made.operations < ladder[-1].operations:
            ladder.append(made)
    each, tried = tuple(alone.values()), len(models)
    return Needs(quantity, within, models[0], each, tuple(ladder), smallest, tried, runs.left_out, rigidity)


class _ModelRunner:
    """Runs simpler models of a solution; `left_out` are simplifications that it does not allow, with the reason."""

    def __init__(self, solution, quantity):
        self._solution, self._quantity = solution, quantity
        self._exact = np.array(components(solution, quantity))
        self._largest = np.linalg.norm(self._exact, axis=0).max()
        if not self._largest > 0:
            raise ParameterError(
                f"needs: {quantity} is {self._largest} in this scene, so relative errors are undefined"
            )
        self.left_out: dict[str, str] = {}

    def of(self, choices):
        """The model with some simplifications; None if the scene does not allow them or one has no effect."""
        simplified = self._solution
        for choice in choices:
            try:
                simplified = choice.simplify(simplified)
            except NotGivenError as why:
                if len(choices) == 1:
                    self.left_out[choice.name] = str(why)
                return None
            if simplified is None:
                return None
        names = tuple(choice.name for choice in choices)
        try:
            with np.errstate(all="ignore"):
                off = np.array(components(simplified, self._quantity)) - self._exact
                change = np.linalg.norm(off, axis=0).max() / self._largest
        except ParameterError as why:  # a load has no value there, such as a table over travel
            self.left_out[" with ".join(names)] = str(why)
            return None
        error = float(change) if math.isfinite(change) else math.inf
        program, _ = program_of(simplified.dynamics, (self._quantity,))
        return Model(names, error, program.recording.operations, simplified)


def _choices_by_ingredient(parts, alone, left_out):
    """By ingredient: None and its simplifications, without those that change most if there are too many models."""
    kept = set(alone)

    def options():
        return [(None, *(item for item in choices if item in kept)) for choices in parts]

    while math.prod(map(len, options())) > MAX_MODELS:
        worst = max(kept, key=lambda choice: alone[choice].error)
        kept.remove(worst)
        left_out[worst.name] = f"its error is {alone[worst].error:.2g}, and there are more than {MAX_MODELS} models"
    return options()


def _frame(models, quantity, full):
    import pandas as pd

    from .methods.method import seconds

    times = seconds(*(lambda made=made: components(replace(made.solution), quantity) for made in models))
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
