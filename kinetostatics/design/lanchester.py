"""Balance shafts that cancel harmonics of the shaking force (Lanchester): `balancing.shafts`.

At constant crank speed omega the shaking force, as a complex number, is a Fourier series of the crank angle phi

    F = omega^2 sum of c_m exp(i m phi),    m = 0, 1, -1, 2, -2 ...

Its harmonic n, c_n exp(i n phi) + c_-n exp(-i n phi), runs on an ellipse: the sum of a circle forward and one backward.
A shaft of the ratio m gives U m^2 omega^2 exp(i (m phi + p)) and cancels the term m if U exp(i p) = -c_m / m^2. So two
shafts cancel a harmonic exactly for any mechanism; the shaft of ratio 1 may be a counterweight on the crank.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..cycle.means import closed_turn, means
from ..errors import ParameterError
from ..machine.group import CRANK
from ..machine.loads import TURN, BalanceShaft, loads_with_mass
from ..machine.loads.balance_shaft import RATIO_TOLERANCE, RatioRule
from ..mechanics.principal_points import principal_points
from ..numbers import checks
from ..solution.scene import Scene, scene_problem
from ..solution.solution import Solution
from .counterweights import Balanced, Counterweight, counterweight_on_either_side

ZERO = 1e-12
"""Terms of the series that count as zero, relative to the mass of the links times the lengths."""
OTHER_HARMONICS = tuple(range(1, 7))
"""Harmonics of the table besides the cancelled ones."""
RATIO, OWNER = RatioRule(), "balance shafts"


@dataclass(frozen=True, eq=False)
class WithShafts:
    """A machine with balance shafts; `balancing.shafts` returns it.

    Attributes
    ----------
    bare, scene : Scene
        Before, and with shafts and counterweight.
    shafts : tuple of BalanceShaft
    balanced : Balanced or None
        Crank with the counterweight that replaces the shaft of ratio 1.
    harmonics : tuple of float
        Cancelled harmonics.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0)
    >>> found = ks.balancing.shafts(pump, (1,), crank=ks.Counterweight(arm=0.05))
    >>> found, round(found.balanced.added_mass, 6)
    (<WithShafts: crank-slider, shafts of -1>, 0.5)
    """

    bare: Scene
    scene: Scene
    shafts: tuple[BalanceShaft, ...]
    balanced: Balanced | None
    harmonics: tuple[float, ...]

    def __repr__(self):
        ratios = ", ".join(f"{shaft.ratio:+g}" for shaft in self.shafts)
        return f"<WithShafts: {self.bare.mechanism.name}, shafts of {ratios or 'none'}>"

    def table(self):
        """Largest of each harmonic of the shaking force before and after, N, at constant speed, a pandas DataFrame."""
        import pandas as pd

        orders = sorted({*self.harmonics, *OTHER_HARMONICS})
        square = float(np.max(np.square(self.bare.crank_speed)))
        columns = {}
        for title, scene in (("before [N]", self.bare), ("after [N]", self.scene)):
            terms = force_series(scene, (*orders, *(-n for n in orders)))
            columns[title] = square * np.abs(terms).reshape(2, -1).sum(axis=0)
        return pd.DataFrame(columns, pd.Index([f"{n:g}" for n in orders], name="harmonic"))


def force_series(scene, orders):
    """Terms of the series of the shaking force over crank speed squared by their orders, complex, kg m."""
    masses = Scene(scene.mechanism, 1.0, loads=loads_with_mass(scene.loads))
    turn = closed_turn(masses.unsolved(np.zeros(1)), OWNER)
    turns = round(turn.period / TURN)
    absent = sorted({abs(n) for n in orders if abs(n * turns - round(n * turns)) > RATIO_TOLERANCE})
    words = f"has no harmonics {absent}: it repeats after {turns} turn{'s' * (turns > 1)} of the crank"
    checks.require(OWNER, f"the shaking force {words}" if absent else None)

    def parts(angle):
        x, y = turn.at.moved_to(turn.clear(angle)).shaking_force
        terms = (x + 1j * y) * np.exp(-1j * np.outer(orders, angle))
        return np.concatenate([terms.real, terms.imag])

    real, imaginary = means(parts, turn, 0.0)[0].reshape(2, -1)
    return real + 1j * imaginary


def shafts(scene, harmonics=(1, 2), *, at=(0.0, 0.0), crank=None):
    """Balance shafts that cancel harmonics of the shaking force at constant crank speed, two for each.

    Parameters
    ----------
    scene : Scene or Solution
        Its links, springs and existing shafts count.
    harmonics : sequence of numbers
        Orders per turn of the crank: 1, 2, 4; fractions if the motion repeats after several turns.
    at : (x, y) or dict of ratio to (x, y)
        Axes of the shafts, m; O for shafts that the dict lacks. A force off O has a moment.
    crank : Counterweight, optional
        A counterweight on the crank that replaces the shaft of ratio 1: its mass or arm, and limits.

    Returns
    -------
    WithShafts
        `scene`, `shafts`, and a `table` of the harmonics. A zero term needs no shaft.

    Raises
    ------
    ParameterError
        Neither a scene nor a solution, a batch of designs, or one that does not close all round. A harmonic that is not
        positive, given twice, or a fraction that the motion does not have; a counterweight beyond its limits.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, crank=ks.Link(2.0, 0.02), slider=ks.Link(1.0)), 100.0)
    >>> found = ks.balancing.shafts(pump)
    >>> [(shaft.ratio, round(shaft.unbalance, 6)) for shaft in found.shafts]  # kg m
    [(1.0, 0.065), (-1.0, 0.025), (2.0, 0.001588), (-2.0, 0.001588)]
    >>> found.table()["after [N]"].loc[["1", "2", "4"]].round(3).abs().to_dict()
    {'1': 0.0, '2': 0.0, '4': 2.049}
    """
    scene = Scene.of(scene) if isinstance(scene, Solution) else scene
    strange = None if crank is None or isinstance(crank, Counterweight) else "crank must be a Counterweight"
    checks.require(OWNER, scene_problem(scene), strange)
    orders = _orders(harmonics)
    ratios = [sign * n for n in orders for sign in (1.0, -1.0)]
    places = at if isinstance(at, dict) else dict.fromkeys(ratios, at)
    others = [n for n in places if n not in ratios]
    checks.require(OWNER, f"at has ratios that no shaft has: {others}" if others else None)
    least = ZERO * principal_points(scene.mechanism).mass * scene.mechanism.extent
    found, balanced = [], None
    for n, term in zip(ratios, force_series(scene, ratios), strict=True):
        needed = -term / (n * n)
        if abs(term) <= least:
            continue
        if n == 1.0 and crank is not None:
            unbalance = needed.real, needed.imag
            balanced = counterweight_on_either_side(scene.mechanism, CRANK, unbalance, crank)
        else:
            found.append(BalanceShaft(abs(needed), n, float(np.angle(needed)), places.get(n, (0.0, 0.0))))
    made = scene.mechanism if balanced is None else balanced.mechanism
    new = replace(scene, mechanism=made, loads=(*scene.loads, *found))
    return WithShafts(scene, new, tuple(found), balanced, orders)


def _orders(harmonics) -> tuple[float, ...]:
    """Harmonics as numbers, checked."""
    given = harmonics.tolist() if isinstance(harmonics, np.ndarray) else harmonics
    if not isinstance(given, tuple | list | range) or not given:
        raise ParameterError(f"{OWNER}: harmonics must be a sequence such as (1, 2), got {checks.shown(harmonics)}")
    found = [RATIO.check(n, "harmonics") for n in given]
    checks.require(OWNER, *(problem for _, problem in found))
    orders = tuple(n for n, _ in found)
    alone = min(orders) > 0.0 and len(set(orders)) == len(orders)
    checks.require(OWNER, None if alone else f"harmonics must be positive, each once, got {checks.shown(orders)}")
    return orders
