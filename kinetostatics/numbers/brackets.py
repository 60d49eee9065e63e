"""Zeros and minima of functions within brackets, many at once, by the methods of Chandrupatla.

They return the same bits as `find_root` and `find_minimum` of scipy.optimize.elementwise, as a test proves.
Importing scipy.optimize takes 0.4 s, longer than solving a case, and its loop needs four times as long.
"""

import numpy as np

EPSILON, TINY = np.finfo(float).eps, np.finfo(float).tiny
MAX_ROOT_STEPS, MAX_MINIMUM_STEPS = 2000, 100
"""Largest numbers of iterations; 10 are usual for a zero and 30 for a minimum."""
GOLDEN_SECTION = 2.0 - (0.5 + 0.5 * 5.0**0.5)
"""Fraction of the larger interval at which golden section evaluates."""


def find_roots(function, low, high, tolerance=4 * TINY):
    """Zero of a function in each bracket; NaN where its values at both ends have one sign.

    ``function(x, places)`` takes arguments (K,) and the places of their brackets. `tolerance` is the width of a narrow
    bracket. T. R. Chandrupatla: A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function
    without using derivatives. Advances in Engineering Software 28 (1997), 145-149.
    """
    shape, a, b = np.shape(low), *(np.ravel(end).astype(float) for end in (low, high))
    found, place = np.full(a.size, np.nan), np.arange(a.size)
    at_a, at_b = function(a, place), function(b, place)
    c, at_c = np.full((2, a.size), np.nan)
    for _ in range(MAX_ROOT_STEPS):
        nearer = np.abs(at_a) < np.abs(at_b)
        best, size = np.where(nearer, a, b), np.abs(np.where(nearer, at_a, at_b))
        width, narrow = np.abs(b - a), 4.0 * EPSILON * np.abs(best) + tolerance
        exact = size <= TINY
        lost = ~exact & (np.sign(at_a) == np.sign(at_b)) | ~np.isfinite(width) | np.isnan(at_a) & np.isnan(at_b)
        found[place] = np.where(lost, np.nan, best)
        on = ~(exact | lost | (width < narrow))
        if not on.any():
            break
        a, b, c, at_a, at_b, at_c, width, narrow, place = (
            row[on] for row in (a, b, c, at_a, at_b, at_c, width, narrow, place)
        )
        edge = 0.5 * narrow / width
        x = a + np.clip(_interpolated(a, b, c, at_a, at_b, at_c), edge, 1.0 - edge) * (b - a)
        at_x = function(x, place)
        same = np.sign(at_x) == np.sign(at_a)
        c, at_c, b, at_b = np.where(same, (a, at_a, b, at_b), (b, at_b, a, at_a))
        a, at_a = x, at_x
    return found.reshape(shape)


def _interpolated(a, b, c, at_a, at_b, at_c):
    """Fraction from a to b of the next argument: inverse quadratic interpolation where safe, else bisection."""
    with np.errstate(all="ignore"):
        place, height = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        safe = (1.0 - np.sqrt(1.0 - place) < height) & (height < np.sqrt(place))
        quadratic = at_a / (at_a - at_b) * at_c / (at_c - at_b)
        quadratic -= (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_b - at_c)
    return np.where(safe, quadratic, 0.5)


def find_minima(function, brackets, relative=EPSILON**0.5, tiny=TINY):
    """Argument of the least value of a function in each bracket; NaN where its middle value is not the least.

    `brackets` (3, K) are arguments in rising order; the function is as for `find_roots`. A bracket is narrow at the
    width `relative` times the argument, plus `tiny`; `tiny` also limits the difference of the values. T. R.
    Chandrupatla: An efficient quadratic fit-sectioning algorithm for minimization without derivatives. Computer Methods
    in Applied Mechanics and Engineering 152 (1998), 211-217.
    """
    x = np.array(brackets, dtype=float)
    found, place = np.full(x.shape[1], np.nan), np.arange(x.shape[1])
    value, before = np.array([function(row, place) for row in x]), x[2]
    for _ in range(MAX_MINIMUM_STEPS + 1):
        lost = (value[1] > value[0]) | (value[1] > value[2]) | ~np.isfinite(x.sum(axis=0) + value.sum(axis=0))
        found[place] = np.where(lost, np.nan, x[1])
        swapped = np.abs(x[2] - x[1]) < np.abs(x[1] - x[0])
        x, value = (np.where(swapped, rows[::-1], rows) for rows in (x, value))
        narrow = np.abs(x[1]) * relative + tiny
        level = value[0] - 2.0 * value[1] + value[2] <= 2.0 * (np.abs(value[1]) * tiny + tiny)
        on = ~(lost | level | (np.abs(x[2] - x[1]) <= 2.0 * narrow))
        if not on.any():
            break
        x, value, before, narrow, place = (row[..., on] for row in (x, value, before, narrow, place))
        vertex, new = _sectioned(x, value, before, narrow)
        before = vertex
        at_new = function(new, place)
        beyond = np.sign(new - x[1]) == np.sign(x[2] - x[1])  # between the middle and the farther end
        lower = at_new <= value[1]
        parts = []
        for old, fresh in ((x, new), (value, at_new)):
            first = np.where(beyond, np.where(lower, old[1], old[0]), np.where(lower, old[0], fresh))
            last = np.where(beyond, np.where(lower, old[2], fresh), np.where(lower, old[1], old[2]))
            parts.append(np.array([first, np.where(lower, fresh, old[1]), last]))
        x, value = parts
    return found


def _sectioned(x, value, before, narrow):
    """Vertex of the parabola through three points, and the next place: that if it has converged, else golden section.

    `before` is the vertex of the iteration before.
    """
    first, larger = x[1] - x[0], x[2] - x[1]
    with np.errstate(all="ignore"):
        left, right = first * (value[2] - value[1]), larger * (value[0] - value[1])
        vertex = 0.5 * (left / (left + right) * (x[0] - x[2]) + x[1] + x[2])
        settled = np.abs(vertex - before) < 0.5 * np.abs(first)
        aside = np.where(np.abs(vertex - x[1]) <= narrow, x[1] + np.sign(larger) * narrow, vertex)
    return vertex, np.where(settled, aside, x[1] + GOLDEN_SECTION * larger)
