"""The result of a search: the better machine, its active limits, and the price of each limit and bound."""

import warnings
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..cycle.load_functions import with_resolution
from ..errors import HintWarning
from ..mechanics.quantities import of_scene
from ..numbers import checks
from . import measures
from .constraints import MEAN, Constraint, parse_output
from .duties import Duty, mean_value
from .problem import compared_value
from .robust import quantile
from .search import excess_over, is_peak

DISTANCE_TOLERANCE = 1e-9
"""Relative distance to the shaft that counts as rounding."""
CAM_RADIUS = "cam_radius"
"""Quantity of a mechanism with a cam that leads A: distance of the roller centre from O."""
RESERVED_NAMES = ("reference", "before")
"""Names of the other variants in the case file."""
ACTIVE_TOLERANCE = 1e-6
"""Distance to an active limit or bound, relative to its size or range."""


@dataclass(frozen=True, eq=False)
class Found:
    """The result of a search; `optimise` and `torque_free_cam` return it.

    Attributes
    ----------
    scene : Scene, or with duties a dict of scenes by name
    values : dict of path to float
        Varied numbers, SI.
    before : Scene or dict
        The source of the search.
    reference : Scene, dict or None
        Reference of ratios.
    limits : tuple of Constraint
    goal : str
        The goal as text.
    active : tuple of str
        Active limits and bounds.
    prices : dict of str to float
        Gain of the goal if an active limit or bound is relaxed by one unit.
    evaluations : int
        Number of evaluations of all derivatives, by all starts.
    starts : list of float
        The goal of each start; infinite, or a ratio of 0, if its limits are not kept.
    bound : float
        Largest ratio of mean torques of a symmetric cam under weight; infinite without this limit.
    spread : (Output, Spread, float) or None
        For a robust design: output, spread, and sign (-1: maximised) of its quantile.
    shaft_radius : float or None
        Radius of the shaft at O, m, if known.
    shares : dict of str to float
        Shares of the time, by duty; empty without duties.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> spring = ks.Spring(600e3, free_position=2.0)
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5, loads=[spring])
    >>> found = ks.design.optimise(
    ...     saw, {"spring.stiffness": (500e3, 900e3)}, minimise="rms balancing_torque", angles=90
    ... )
    >>> print(f"{found.values['spring.stiffness'] / 1e3:.0f} kN/m")
    687 kN/m
    >>> found.scene.solve(4).shape, found.active
    ((4,), ())
    """

    scene: Any
    values: dict[str, float]
    before: Any
    reference: Any
    limits: tuple[Constraint, ...]
    goal: str
    outputs: tuple = field(repr=False)
    active: tuple[str, ...] = ()
    prices: dict[str, float] = field(default_factory=dict)
    evaluations: int = 0
    starts: list[float] = field(default_factory=list)
    bound: float = np.inf
    spread: tuple | None = field(default=None, repr=False)
    shaft_radius: float | None = None
    shares: dict[str, float] = field(default_factory=dict)

    def __repr__(self):
        numbers = f"{len(self.values)} numbers of {self._first.mechanism.name} varied"
        binds = f"{', '.join(self.active)} binds" if self.active else "nothing binds"
        return f"<Found: {self.goal}; {numbers}, {binds}; {self.evaluations} evaluations>"

    @property
    def _first(self):
        """The scene, or that of the first duty; all duties have the same mechanism."""
        return next(iter(self.duties().values())).source

    def duties(self, before=False):
        """Duties by name after the search, or before; a search without duties has one duty, named ""."""
        scenes = self.before if before else self.scene
        if not self.shares:
            return {"": Duty(scenes, self.reference, 1.0)}
        compared = self.reference or {}
        return {name: Duty(scenes[name], compared.get(name), share) for name, share in self.shares.items()}

    def duty(self, name):
        """The result for a single duty, for plots of one machine.

        Raises
        ------
        ParameterError
            The duty is unknown.
        """
        checks.require("found", checks.choice("duty", name, tuple(self.shares)))
        after, before = self.duties()[name], self.duties(before=True)[name]
        limits = tuple(replace(limit, duty="") for limit in self.limits if limit.duty == name)
        scenes = {"scene": after.source, "before": before.source, "reference": after.reference}
        return replace(self, **scenes, limits=limits, active=(), prices={}, spread=None, shares={})

    def report(self):
        """Outputs before and after, with their limits and prices, a pandas DataFrame.

        With duties the goal has rows for the mean and each duty, other outputs rows for limited duties; `duty` has all.

        Warns
        -----
        HintWarning
            The cam cuts into the shaft, if the shaft's radius is known; or load functions without `kinks` change
            between their samples.
        """
        import pandas as pd

        mechanism = self._first.mechanism
        if self.shaft_radius is not None and CAM_RADIUS in of_scene(self.scene):
            nearest = compared_value(parse_output(f"smallest {CAM_RADIUS}", self.scene), self.scene, None)
            hint = shaft_hint(nearest, mechanism.rollers.get("A"), self.shaft_radius)
            if hint:
                warnings.warn(HintWarning(mechanism.name, hint), stacklevel=2)
        duties, before = self.duties(), self.duties(before=True)
        scenes = [duty.source for duty in duties.values()]
        for text in dict.fromkeys(text for scene in scenes for text in scene.check_resolution().hints):
            warnings.warn(HintWarning(mechanism.name, text), stacklevel=2)
        limits: dict[str, list[Constraint]] = {}
        for limit in self.limits:
            limits.setdefault(limit.place, []).append(limit)
        rows = {}
        if self.spread is not None:
            output, spread, sign = self.spread
            values = [quantile(item, output, spread, sign) for item in (before, duties)]
            alone = {"limit": "", "binds": False, "price": np.nan}
            pair = dict(zip(("before", "after"), values, strict=True))
            rows[f"{spread.quantile:g} quantile of {output.column}"] = pair | alone
        for output in self.outputs:
            own_rows = {MEAN: list(duties)} if self.shares else {}
            own_rows |= {name: [name] for name in duties}
            for name, of in own_rows.items():
                if self.shares and output is not self.outputs[0] and f"{name}: {output}" not in limits:
                    continue  # neither goal nor limited in this duty
                own = limits.get(f"{name}: {output}" if name else str(output), [])
                share = 1.0 if name == MEAN else duties[name].share
                found = [mean_value(output, {key: items[key] for key in of}) / share for items in (before, duties)]
                rows[f"{name}: {output.column}" if name else output.column] = {
                    "before": found[0],
                    "after": found[1],
                    "limit": ", ".join(f"{limit.relation} {limit.value:.9g}" for limit in own),
                    "binds": any(str(limit) in self.active for limit in own),
                    "price": next((self.prices[str(limit)] for limit in own if str(limit) in self.prices), np.nan),
                }
        return with_resolution(pd.DataFrame.from_dict(rows, orient="index").rename_axis("output"), *scenes)

    def numbers(self):
        """Varied numbers, before and after, with the prices of their bounds, a pandas DataFrame.

        Before is NaN if the source lacks the number, for example one of another cam.
        """
        import pandas as pd

        own, units = next(iter(self.duties(before=True).values())).source.parameters, self._first.units
        rows = {
            f"{path} [{units[path]}]": {
                "before": own.get(path, np.nan),
                "after": value,
                "price": self.prices.get(path, np.nan),
            }
            for path, value in self.values.items()
        }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("number")

    def case(self, path, name="optimal", title=None):
        """Write a case file, ready to run: the design, the source, and the reference of ratios.

        Parameters
        ----------
        path : str or path
        name : str
            Name of the design's variant.
        title : str, optional

        Returns
        -------
        pathlib.Path
        """
        from .case_text import write_case

        known = isinstance(name, str) and name not in RESERVED_NAMES
        checks.require(
            "case file",
            None if isinstance(path, str | Path) else f"path must be the name of a file, got {checks.shown(path)}",
            None if known else f"name must be a text, not one of {RESERVED_NAMES}, got {name!r}",
            None if title is None or isinstance(title, str) else f"title must be a text, got {checks.shown(title)}",
        )
        scenes = named_scenes("reference", self.reference or {})
        scenes |= named_scenes("before", self.before) | named_scenes(name, self.scene)
        return write_case(path, title or f"Design for the {self.goal}", scenes)


def named_scenes(name, scenes):
    """Scenes by the names of their variants; the name of a duty is appended."""
    return {f"{name}-{duty}": scene for duty, scene in scenes.items()} if isinstance(scenes, dict) else {name: scenes}


def shaft_hint(nearest, roller_radius, shaft_radius):
    """Sentence if the roller centre is too near O for the shaft, or None; lengths in m."""
    reach = shaft_radius + (roller_radius or 0.0)
    if nearest >= reach * (1.0 - DISTANCE_TOLERANCE):
        return None
    roller = f" with a roller of {roller_radius * 1e3:.4g} mm" if roller_radius else ""
    return (
        f"the cam cuts into the shaft: the roller centre is at {nearest * 1e3:.4g} mm from O, the shaft's radius is "
        f"{shaft_radius * 1e3:.4g} mm{roller}; require at least {reach * 1e3:.4g} mm"
    )


def active_prices(problem, goal, limits, values):
    """Active limits and bounds, and their prices: gain of the goal if one is relaxed by one unit.

    The derivatives of the goal are the sum of those of the active limits times their prices (Kuhn and Tucker).
    """
    from scipy.optimize import lsq_linear

    output, sign = goal
    first, others = sign * problem.output(output, values)[1], np.empty((values.size, 0))
    if is_peak(output, sign):  # for each duty, a column for each equal peak, less the highest one
        first = np.zeros(values.size)
        for name, part in problem.parts.items():
            heights, slopes = measures.bounded(output.reduction, part.curve(output, values))
            order, share = np.argsort(-heights), problem.shares[name]
            slopes = share * slopes[:, order[heights[order] >= heights.max() - ACTIVE_TOLERANCE * abs(heights.max())]]
            first, others = first + slopes[:, 0], np.hstack([others, slopes[:, 1:] - slopes[:, :1]])
    reach = problem.high - problem.low
    names, columns, free = [], [], []
    for limit in limits:
        excess, changes = excess_over(problem, limit, values)
        for place in np.flatnonzero(np.abs(excess) <= ACTIVE_TOLERANCE * limit.scale):
            names.append(str(limit))
            columns.append(changes[:, place])
            free.append(limit.relation == "=")
    for number, name in enumerate(problem.names):
        for end, side in ((problem.low, -1.0), (problem.high, 1.0)):
            if abs(values[number] - end[number]) <= ACTIVE_TOLERANCE * reach[number]:
                names.append(name)
                columns.append(side * np.eye(values.size)[number])
                free.append(False)
    if not names:
        return (), {}
    matrix = np.array(columns).T * reach[:, None]
    weight = np.linalg.norm(matrix, axis=0)
    weight[weight == 0] = 1.0
    first, others = first * reach, others * reach[:, None]
    shares = others.shape[1]  # of the goal's further competing peaks
    low = np.concatenate([np.where(free, -np.inf, 0.0), np.zeros(shares)])
    solved = lsq_linear(np.hstack([matrix / weight, others]), -first, (low, np.full(low.size, np.inf)))
    found: dict[str, float] = {}
    for name, price in zip(names, solved.x[: len(names)] / weight, strict=True):
        found[name] = found.get(name, 0.0) + float(price)
    return tuple(found), found
