"""Loops of compiled reductions: bit masks of comparisons, functions of table columns, and sums of rows.

Plain loops, written so that LLVM uses vector (SIMD) instructions.
"""

import inspect
import math
import sys
from functools import cache
from hashlib import sha256
from typing import Any

from ..version import __version__
from . import codegen
from .codegen import compile_line, line_source
from .graph import Graph

COLUMNS = 8
"""Number of table columns in one instruction."""


@cache
def edition(*others) -> str:
    """Hash of the source of this module and others, for programs compiled with it.

    Numba looks for changes in the program that it compiles only, not in the modules that it calls.
    """
    modules = sys.modules[__name__], codegen, *others
    try:
        text = "".join(map(inspect.getsource, modules))
    except OSError:
        text = __version__
    return sha256(text.encode()).hexdigest()[:8]


def _compiled(function, **options) -> Any:
    """The function compiled by numba; it allocates no memory, so no reference is counted."""
    import numba

    njit: Any = numba.njit
    return njit(error_model="numpy", _nrt=False, **options)(function)


def rising(here, after):
    """Whether the second of two numbers is higher, or one of them is NaN."""
    return not after <= here


def falling(here, after):
    """Whether the second of two numbers is lower, or one of them is NaN."""
    return not after >= here


def negative(here, after):
    """Whether the first of two numbers is negative."""
    return here < 0.0


def bits_of_steps(condition, other=None):
    """For numba: ``bits(results, design, row, words)`` sets bit k of `words` where a condition holds for step k.

    Step k goes from value k in a row of results (designs, rows, N) to the next, from the last to the first. `words` has
    a row of uint64 for each condition; bits beyond N are 0.
    """
    from numba import uint64

    both = other is not None
    condition, other = _compiled(condition), _compiled(other or condition)

    @_compiled
    def marked(here, after, i, one, two):
        one |= uint64(condition(here, after)) << uint64(i)
        return one, two | uint64(other(here, after)) << uint64(i) if both else two

    @_compiled
    def bits(results, design, row, words):
        values, last = results[design, row], results.shape[2] - 1
        for k in range(words.shape[1]):
            start, one, two = 64 * k, uint64(0), uint64(0)
            if start + 64 <= last:  # a loop of known length becomes vector instructions
                for i in range(64):
                    one, two = marked(values[start + i], values[start + i + 1], i, one, two)
            else:
                for i in range(last + 1 - start):
                    one, two = marked(values[start + i], values[start + i + 1 if start + i < last else 0], i, one, two)
            words[0, k] = one
            if both:
                words[1, k] = two

    return bits


def over_columns(function, rows):
    """For numba: ``over(table, count)`` replaces the first rows of a table by a function of all, in `count` columns.

    ``function(parts, chosen, sqrt)`` returns fewer rows than the table has.
    """
    graph = Graph()
    parts = [graph.parameter(row) for row in range(rows)]
    found = function(parts, lambda sign, *parts: graph.node(f"if {sign}", *parts), lambda part: part.sqrt())
    line, width = _compiled(compile_line(line_source(found, "parameters"), {"sqrt": math.sqrt})), len(found)

    @_compiled
    def over(table, count):
        for k in range(count):
            top = line(table[:, k])
            for row in range(width):
                table[row, k] = top[row]

    return over


def summing(term):
    """For numba: ``sums(results, design, row)``: sums of a term over the values at even and at odd places of a row.

    Results have the shape (designs, rows, N). Additions are in the order of the processor's vectors.
    """
    size = term if inspect.isbuiltin(term) else _compiled(term)

    def sums(results, design, row):
        values, even, odd = results[design, row], 0.0, 0.0
        for k in range(values.size // 2):
            even += size(values[2 * k])
            odd += size(values[2 * k + 1])
        return even + size(values[-1]) if values.size % 2 else even, odd

    return _compiled(sums, fastmath={"reassoc"})


def lowest_bit():
    """For numba: ``place(word)``, the number of the lowest bit set in a uint64."""
    from numba.cpython.unsafe.numbers import trailing_zeros

    return trailing_zeros
