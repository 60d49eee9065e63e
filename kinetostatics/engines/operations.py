"""What recorded operations do to plain numbers, to arrays with new memory, and to arrays with memory given."""

import math

import numpy as np

from ..numbers.elementary import ROUNDING, lost, off_square, rest, total


def _plain_root(square, unit):
    if square > 0.0:
        return math.sqrt(square)
    return 0.0 if square > -ROUNDING * unit else math.nan


def _plain_divisor(root, unit):
    return unit if root < unit else root


def _root(square, unit):
    return np.where(square > -ROUNDING * unit, np.sqrt(np.maximum(square, 0.0)), np.nan)


def _root_of(square, unit, out):
    np.maximum(square, 0.0, out=out)
    np.sqrt(out, out)
    np.copyto(out, np.nan, where=np.less_equal(square, -ROUNDING * unit))


def _plain_total(*terms):
    try:
        return math.fsum(terms)
    except (OverflowError, ValueError):
        return total(*terms)


def _plain_rest(length, x, y):
    return _plain_total(*off_square(length, x, y)) / (2.0 * length)


def _lost_by_squares(length, x, y):
    return lost(*off_square(length, x, y))


def _scalar_total(*terms):
    return np.float64(_plain_total(*terms))


def _scalar_lost(*terms):
    return np.float64(lost(*map(float, terms)))


def _total_of(*terms_and_out):
    *terms, out = terms_and_out
    np.copyto(out, total(*terms))


def compile_line(source, scope):
    """Function `line` of a source, with what a scope holds as its operations."""
    scope = dict(scope)
    exec(source, scope)
    return scope["line"]


def _sqrt(square):
    return math.sqrt(square) if square >= 0.0 else math.nan


PLAIN = {
    "sin": lambda angle: float(np.sin(angle)),
    "cos": lambda angle: float(np.cos(angle)),
    "atan": lambda slope: float(np.arctan(slope)),
    "sqrt": _sqrt,
    "abs": abs,
    "copysign": math.copysign,
    "root": _plain_root,
    "divisor": _plain_divisor,
    "fma": lambda one, other, more: one * other + more,
    "total": _plain_total,
    "lost": lost,
    "lost_by_squares": _lost_by_squares,
    "rest": _plain_rest,
    "nan": math.nan,
    "inf": math.inf,
}
BY_DESIGN = {
    "sin": np.sin,
    "cos": np.cos,
    "atan": np.arctan,
    "sqrt": np.sqrt,
    "abs": abs,
    "copysign": np.copysign,
    "root": _root,
    "divisor": np.maximum,
    "fma": lambda one, other, more: one * other + more,
    "total": total,
    "lost": lost,
    "lost_by_squares": _lost_by_squares,
    "rest": rest,
    "nan": math.nan,
    "inf": math.inf,
}
SCALARS = BY_DESIGN | {
    "root": lambda square, unit: np.float64(_plain_root(square, unit)),
    "divisor": lambda root, unit: np.float64(_plain_divisor(root, unit)),
    "total": _scalar_total,
    "lost": _scalar_lost,
    "lost_by_squares": lambda length, x, y: _scalar_lost(*off_square(length, x, y)),
    "rest": lambda length, x, y: _scalar_total(*off_square(length, x, y)) / (2.0 * length),
}
"""On plain numbers of NumPy, which tell what is too small for a double: no sum is."""
ARRAYS = {
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "negative": np.negative,
    "positive": np.positive,
    "sin_of": np.sin,
    "cos_of": np.cos,
    "sqrt_of": np.sqrt,
    "arctan": np.arctan,
    "absolute": np.absolute,
    "sign_of": lambda value, out: np.copysign(1.0, value, out),
    "root_of": _root_of,
    "total_of": _total_of,
    "maximum": lambda one, other, out: np.maximum(one, other, out=out),
}
