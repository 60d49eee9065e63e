"""A periodic function as Chebyshev polynomials on panels: narrow where the function needs it, with ends at its kinks.

As chebfun does (Battles and Trefethen, SIAM J. Sci. Comput. 25, 2004). Nodes lie inside the panels, so a jump at the
end of a panel belongs to no panel. Where panels would become tiny, bisection locates the kink between the curves that
continue from both sides.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from ..errors import ParameterError

PANEL_DEGREE = 16
INITIAL_PANELS = 16
"""Number of panels at first."""
MAX_HALVINGS = 14
"""Number of halvings of a panel before it counts as having a kink."""
COEFFICIENT_TOLERANCE = 1e-12
"""Largest size of the last coefficients of a resolved panel, relative to the largest value."""
MAX_ROUGH_PANELS = 400
"""Largest number of unresolved panels; a function with more is rough everywhere."""
TAIL_COEFFICIENTS = 3
CONTINUATION_WIDTH = 0.01
"""Width, relative to the period, of the panels that extrapolate a curve to a kink."""
_NODES = np.cos(np.pi * (np.arange(PANEL_DEGREE + 1) + 0.5) / (PANEL_DEGREE + 1))[::-1]
_FIT = np.linalg.inv(chebyshev.chebvander(_NODES, PANEL_DEGREE))


@dataclass(frozen=True, eq=False)
class Panels:
    """Chebyshev coefficients (panels, degree + 1) between `edges`, which rise and span one period."""

    edges: np.ndarray
    coefficients: np.ndarray

    @classmethod
    def of(cls, function, period, breaks=()):
        """Panels of a function of arrays; `breaks` are the known kinks.

        `ParameterError` if it is not smooth between finitely many kinks.
        """
        edges = np.unique([*np.linspace(0.0, period, INITIAL_PANELS + 1), *np.mod(breaks, period)])
        found, rough = _refine(function, edges)
        if rough and len(rough) <= MAX_ROUGH_PANELS:
            kinks = [_find_kink(function, low, high, period) for low, high in rough]
            found, rough = _refine(function, np.unique([*edges, *np.mod(kinks, period)]), 4 * MAX_HALVINGS)
        if rough:
            low, high = rough[0]
            raise ParameterError(
                f"it is not smooth between finitely many kinks: not near {np.degrees(low):.6g} deg, where panels of "
                f"{np.degrees(high - low):.2g} deg do not resolve it"
            )
        starts = sorted(found)
        return cls(np.array([*starts, period]), np.array([found[start] for start in starts]))

    @property
    def period(self):
        return float(self.edges[-1] - self.edges[0])

    def __call__(self, angle):
        """Values at any arguments."""
        return self.at(angle, 0)[0]

    def at(self, angle, order):
        """Tuple of value and derivatives up to an order, at any arguments."""
        angle = self.edges[0] + np.mod(np.asarray(angle, dtype=float) - self.edges[0], self.period)
        place = np.clip(np.searchsorted(self.edges, angle, side="right") - 1, 0, len(self.coefficients) - 1)
        start, width = self.edges[place], np.diff(self.edges)[place]
        t, found = 2.0 * (angle - start) / width - 1.0, []
        coefficients = self.coefficients
        for power in range(order + 1):
            values = chebyshev.chebval(t, np.moveaxis(coefficients[place], -1, 0), tensor=False)
            found.append(values * (2.0 / width) ** power)
            coefficients = chebyshev.chebder(coefficients, axis=1)
        return tuple(found)

    @property
    def mean(self):
        widths = np.diff(self.edges)
        whole = chebyshev.chebint(self.coefficients, lbnd=-1, axis=1).sum(axis=1)
        return float(whole @ widths) / (2.0 * self.period)

    def plus(self, constant):
        """Panels of the function plus a constant."""
        coefficients = self.coefficients.copy()
        coefficients[:, 0] += constant
        return Panels(self.edges, coefficients)

    @property
    def integral(self):
        """Panels of the integral from the first edge, for a function of zero mean."""
        half = np.diff(self.edges)[:, None] / 2.0
        found = chebyshev.chebint(self.coefficients, lbnd=-1, axis=1) * half
        found[1:, 0] += np.cumsum(found.sum(axis=1))[:-1]
        return Panels(self.edges, found)

    @property
    def roots(self):
        """Rising arguments at which the sign changes, also at a jump."""
        found = []
        for start, stop, coefficients in zip(self.edges[:-1], self.edges[1:], self.coefficients, strict=True):
            t = chebyshev.chebroots(chebyshev.chebtrim(coefficients, 1e-14 * np.max(np.abs(self.coefficients))))
            t = np.real(t[(np.abs(np.imag(t)) < 1e-7) & (np.abs(np.real(t)) <= 1.0 + 1e-7)])
            found += [*(start + (np.clip(t, -1.0, 1.0) + 1.0) / 2.0 * (stop - start)), start]
        places = np.unique(found)
        middles = (places + np.append(places[1:], places[0] + self.period)) / 2.0
        signs = np.sign(self(middles))
        return places[signs != np.roll(signs, 1)]


def panel_nodes(low, high):
    """Rising nodes of a panel."""
    return low + (_NODES + 1.0) / 2.0 * (high - low)


def _refine(function, edges, depth=MAX_HALVINGS):
    """Coefficients by the start of each panel, and the intervals that stay rough, neighbours joined."""
    waiting = list(pairwise(edges))
    found: dict[float, np.ndarray] = {}
    size = 0.0
    for level in range(depth + 1):
        low, high = np.array(waiting).T
        values = function(panel_nodes(low[:, None], high[:, None]).ravel()).reshape(len(waiting), -1)
        size = max(size, float(np.max(np.abs(values))))
        coefficients = values @ _FIT.T
        smooth = np.max(np.abs(coefficients[:, -TAIL_COEFFICIENTS:]), axis=1) <= COEFFICIENT_TOLERANCE * size
        found |= dict(zip(low[smooth], coefficients[smooth], strict=True))
        rough = [pair for pair, done in zip(waiting, smooth, strict=True) if not done]
        if not rough or level == depth or len(rough) > MAX_ROUGH_PANELS:
            break
        waiting = [half for a, b in rough for half in ((a, (a + b) / 2), ((a + b) / 2, b))]
    joined: list = []
    for low, high in sorted(rough):
        if joined and joined[-1][1] == low:
            joined[-1][1] = high
        else:
            joined.append([low, high])
    return found, joined


def _find_kink(function, low, high, period):
    """Argument of the kink, by bisection: the value belongs to the curve from the left or the right."""
    width = CONTINUATION_WIDTH * period
    beside = (low - width, low), (high, high + width)
    sides = [chebyshev.Chebyshev(_FIT @ function(np.mod(panel_nodes(*ends), period)), ends) for ends in beside]
    for _ in range(60):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        value = function(np.mod(np.array([middle]), period))[0]
        before, after = (abs(value - side(middle)) for side in sides)
        low, high = (middle, high) if before <= after else (low, middle)
    return high
