"""Source code from recorded arithmetic: a compiled loop for numba, array operations for NumPy, plain Python numbers.

`line_source`, `buffered_source` and `loop_source` write it; `PLAIN`, `BY_DESIGN` and `ARRAYS` are the
functions of its operations.
"""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ..numbers.arithmetic import (
    SPLITTER,
    SQUARE_TOLERANCE,
    compensated_sum,
    length_error,
    square_difference_terms,
    sum_corrections,
)
from .graph import BY_ANGLE, Node, is_of_angle, needed
from .simplify import drop_unused, fused_sums

MAX_EXPONENT = math.log(np.finfo(float).max)
"""Largest exponent with a finite exponential."""
GIVEN, FILLED = "Array(float64, {}, 'C', True)", "Array(float64, {}, 'C')"
"""Numba types of arrays with {} axes: read by a loop (possibly read-only), and written by it."""
ARGUMENTS = f"void({', '.join([GIVEN] * 5 + [FILLED]).format(2, 2, 2, 2, 3, 1)})"
"""Signature of a loop: crank angles, their sines and cosines, parameters, tables, results."""
TURN = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import cos, sin

from numba import njit


@njit("void({", ".join([GIVEN, FILLED, FILLED]).format(1, 1, 1)})", nogil=True, cache=KEEP)
def shared(angle, sine, cosine):
    for i in range(angle.size):
        cosine[i] = cos(angle[i])
        sine[i] = sin(angle[i])
'''
"""Module that computes sines and cosines of crank angles."""
LOOP_HEADER = '''"""Written by kinetostatics; may be deleted at any time."""

from math import atan, copysign, cos, exp, inf, log, nan, sin, sqrt

from numba import njit
from numba.core.compiler import Compiler
from numpy import float64 as number
from numpy import uint64

zero, one, no_number, threshold = number(0.0), number(1.0), number(nan), number({threshold!r})


class SeparateArrays(Compiler):
    def define_pipelines(self):
        self.state.flags.noalias = True
        return super().define_pipelines()


'''
"""Start of a loop's module. `noalias`: no two arrays share memory, so vectors need no check at run time."""
LOOP = f"""@njit("{ARGUMENTS}", cache=KEEP, pipeline_class=SeparateArrays, error_model="numpy", nogil=True, _nrt=False)
def loop(angles, sines, cosines, parameters, tables, results):
    count = uint64(angles.shape[1]) & uint64({2**40 - 1})
    for design in range(parameters.shape[0]):
        first = design * (angles.shape[0] > 1)
        table = design * (tables.shape[1] > 1)
        start = uint64(design) * uint64({{rows}}) * count"""
"""Start of a loop. The count below 2^40 lets LLVM prove that rows of the results do not overlap, as vectors need."""
TWO_SUM = """@njit(error_model="numpy")
def two_sum(a, b):
    whole = a + b
    part = whole - a
    return whole, (a - (whole - part)) + (b - part)


"""
"""Helper of compensated sums."""
SQUARES = f"""@njit(error_model="numpy")
def squared(a):
    whole, spread = a * a, {SPLITTER!r} * a
    high = spread - (spread - a)
    low = a - high
    return whole, ((high * high - whole) + 2.0 * high * low) + low * low


@njit(error_model="numpy")
def off_square(length, x, y):
    one, first = squared(x)
    two, second = squared(y)
    three, third = squared(length)
    return one, first, two, second, -three, -third


@njit(error_model="numpy")
def rest(length, x, y):
    return total6(*off_square(length, x, y)) / (2.0 * length)


@njit(error_model="numpy")
def lost_by_squares(length, x, y):
    return lost6(*off_square(length, x, y))


"""
"""Helpers for the rounding error of a vector's length."""

FUSED = """from numba import types
from numba.extending import intrinsic


@intrinsic
def fma(typing, one, other, more):
    def written(context, builder, signature, arguments):
        from llvmlite.ir import FunctionType

        kind = arguments[0].type
        function = builder.module.declare_intrinsic("llvm.fmuladd", [kind], FunctionType(kind, [kind] * 3))
        return builder.call(function, arguments)

    return types.float64(types.float64, types.float64, types.float64), written


"""
"""Fused multiply-add; two operations where the processor has none."""


def loop_source(outputs, fuse=True, kind="float64") -> str:
    """Source of a module with ``loop(angles, sines, cosines, parameters, tables, results)``.

    It reads angles (1 or designs, N) with their sines and cosines, parameters (designs, P) and tables (T, 1 or
    designs, N). It fills results, a flat array of (designs, outputs, N). All arrays have one `kind`, "float64" or
    "float32". `fuse` allows fused multiply-adds, see `simplify`.
    """
    nodes = needed(outputs)
    sums = fused_sums(nodes) if fuse else {}
    if sums:
        nodes = drop_unused(nodes, outputs, sums)
    of_loop = [node for node in nodes if _is_computed_by_angle(node)]
    lines = [LOOP.format(rows=len(outputs))]
    lines += [f"        {_defined(node, _IN_LOOP)}" for node in nodes if node.varies < BY_ANGLE]
    lines += ["        for i in range(count):", "            angle = angles[first, i]"]
    for node in of_loop:
        text = _defined(node, _IN_LOOP)
        if found := sums.get(node):
            signs = ["-" if sign < 0 else "" for sign in (found.sign, found.rest_sign)]
            one, other, rest = map(_name, (found.one, found.other, found.rest))
            text = f"v{node.index} = fma({signs[0]}{one}, {other}, {signs[1]}{rest})"
        lines.append(f"            {text}")
    lines += [
        f"            results[start + uint64({row}) * count + i] = {_name(part)}" for row, part in enumerate(outputs)
    ]
    operations = {node.operation for node in nodes}
    calls = {(node.operation, len(node.arguments)) for node in nodes if node.operation in ("total", "lost")}
    if squares := not operations.isdisjoint(("rest", "lost_by_squares")):
        calls |= {("total", 6), ("lost", 6)}
    helpers = [TWO_SUM * bool(calls), *(_sum_of(*call) for call in sorted(calls)), SQUARES * squares]
    helpers.append(FUSED * bool(sums or "fma" in operations))
    header = LOOP_HEADER.format(threshold=-SQUARE_TOLERANCE) + "".join(helpers)
    return (header + "\n".join(lines) + "\n").replace("float64", kind)


def _sum_of(name, count):
    """Source of `total` or `lost` of `count` terms, see `arithmetic.compensated_sum`."""
    terms = [f"t{k}" for k in range(count)]
    steps = [f"    {there}, {here} = two_sum({here}, {there})" for here, there in pairwise(terms)]
    total, lost = f"t{count - 1} + ({' + '.join(terms[:-1])})", " + ".join(f"abs({term})" for term in terms[:-1])
    head = '@njit(error_model="numpy")', f"def {name}{count}({', '.join(terms)}):"
    return "\n".join([*head, *steps, *steps, f"    return {total if name == 'total' else lost}"]) + "\n\n\n"


def line_source(outputs, argument_names="angle, sine, cosine, parameters, tables") -> str:
    """Source of ``line(angle, sine, cosine, parameters, tables)``, which returns a tuple of outputs.

    For plain numbers, and for arrays with new memory for each operation.
    """
    lines = [f"def line({argument_names}):"]
    lines += [f"    {_defined(node)}" for node in needed(outputs) if node.operation != "angle"]
    lines.append(f"    return ({' '.join(f'{_name(part)},' for part in outputs)})")
    return "\n".join(lines) + "\n"


def buffered_source(outputs) -> tuple[str, int]:
    """Source of ``line(angle, sine, cosine, parameters, tables, buffers, results)`` on arrays; count of buffers.

    Each operation writes into a free buffer, or into its row of the results.
    """
    nodes = needed(outputs)
    rows: dict[Node, int] = {}
    copies = []
    for place, part in enumerate(outputs):
        if isinstance(part, Node) and part not in rows and _is_computed_by_angle(part) and not _is_given(part):
            rows[part] = place
        else:
            copies.append((place, part))
    last = {argument: node for node in nodes for argument in node.arguments if isinstance(argument, Node)}
    source = [f"    {_defined(node)}" for node in nodes if node.varies < BY_ANGLE]
    free: list[str] = []
    place_of: dict[Node, str] = {}
    count = 0
    for node in nodes:
        if not _is_computed_by_angle(node):
            continue
        if _is_given(node):
            place_of[node] = _expression(node, _IN_LINE)
            continue
        names = [place_of.get(part) or _name(part) for part in node.arguments]
        spent = {part for part in node.arguments if isinstance(part, Node) and last[part] is node and part not in rows}
        released = [place_of[part] for part in spent if place_of.get(part, "").startswith("b")]
        if node in rows:
            target = f"r{rows[node]}"
        elif node.operation in _IN_PLACE and released:
            target = released.pop()
        elif free:
            target = free.pop()
        else:
            target, count = f"b{count}", count + 1
        free += released
        place_of[node] = target
        if node.operation == "fma":
            *factors, more = names
            source.append(f"    multiply2({', '.join([*factors, target])}); add2({target}, {more}, {target})")
        else:
            source.append(f"    {_array_function(node.operation, len(names))}({', '.join([*names, target])})")
    source += [f"    r{place}[...] = {place_of.get(part) or _name(part)}" for place, part in copies]
    heads = ["def line(angle, sine, cosine, parameters, tables, buffers, results):"]
    heads += [f"    {', '.join(f'b{k}' for k in range(count))}, = buffers"] if count else []
    heads += [f"    {', '.join(f'r{k}' for k in range(len(outputs)))}, = results"] if outputs else []
    return "\n".join(heads + source) + "\n", count


def _array_function(operation, count):
    """Name of the array function of an operation with `count` arguments."""
    return f"{_WORDS.get(operation, operation)}{count}"


_WORDS = {"+": "add", "-": "subtract", "*": "multiply", "/": "divide"}
_IN_PLACE = ("+", "-", "*", "/", "abs", "sqrt", "exp", "log", "divisor")


def _is_computed_by_angle(node):
    return node.varies == BY_ANGLE and node.operation != "angle"


def _is_given(node):
    """Whether the caller passes a node's value."""
    return node.operation in ("angle", "table") or is_of_angle(node)


_IN_LINE = {
    "parameter": "parameters[{}]",
    "table": "tables[{}]",
    "sin": "sine",
    "cos": "cosine",
    "held": "{}",
    "sign": "copysign(1.0, {})",
    **{f"if {sign}": f"{{2}} if {{0}} {sign} {{1}} else {{3}}" for sign in ("<", "<=", "==", ">=")},
}
"""Text of inputs, and of operations other than functions of the same name, in a line."""
_IN_LOOP = {
    "parameter": "parameters[design, {}]",
    "table": "tables[{}, table, i]",
    "sin": "sines[first, i]",
    "cos": "cosines[first, i]",
    "held": "{}",
    "sign": "copysign(one, {})",
    "divisor": "max({}, {})",
    "total": "total{count}({all})",
    "lost": "lost{count}({all})",
    "root": "sqrt(max(zero, {0})) if {0} > threshold * {1} else no_number",
}
"""Text of operations in a compiled loop."""


def _defined(node, words=_IN_LINE):
    return f"v{node.index} = {_expression(node, words)}"


def _name(part):
    if not isinstance(part, Node):
        return repr(part.item() if hasattr(part, "item") else part)  # a number of NumPy as a plain one
    return "angle" if part.operation == "angle" else f"v{part.index}"


def _expression(node, words):
    kind = node.operation
    if is_of_angle(node):
        return words[kind]
    names = [_name(part) for part in node.arguments]
    if kind in ("+", "-", "*", "/"):
        return f" {kind} ".join(names) if len(names) == 2 else f"{kind}{names[0]}"
    form = words[kind] if kind in words and kind not in ("sin", "cos") else f"{kind}({{all}})"
    return form.format(*names, all=", ".join(names), count=len(names))


def _plain_root(square, unit):
    if square > 0.0:
        return math.sqrt(square)
    return 0.0 if square > -SQUARE_TOLERANCE * unit else math.nan


def _plain_log(value):
    if value > 0.0:
        return float(np.log(value))
    return -math.inf if value == 0.0 else math.nan


def _root_of(square, unit, out):
    np.maximum(square, 0.0, out=out)
    np.sqrt(out, out)
    np.copyto(out, np.nan, where=np.less_equal(square, -SQUARE_TOLERANCE * unit))


def _total_of(*terms_and_out):
    *terms, out = terms_and_out
    np.copyto(out, compensated_sum(*terms))


def _plain_total(*terms):
    try:
        return math.fsum(terms)
    except (OverflowError, ValueError):
        return compensated_sum(*terms)


def compile_line(source, scope):
    """Function `line` of a source or its code, with its operations from a scope."""
    scope = dict(scope)
    exec(source, scope)
    return scope["line"]


PLAIN = {
    "sin": lambda angle: float(np.sin(angle)),
    "cos": lambda angle: float(np.cos(angle)),
    "atan": lambda slope: float(np.arctan(slope)),
    "sqrt": lambda square: math.sqrt(square) if square >= 0.0 else math.nan,
    "exp": lambda exponent: math.inf if exponent > MAX_EXPONENT else float(np.exp(exponent)),
    "log": _plain_log,
    "abs": abs,
    "copysign": math.copysign,
    "root": _plain_root,
    "divisor": lambda root, unit: unit if root < unit else root,
    "fma": lambda one, other, more: one * other + more,
    "total": _plain_total,
    "lost": sum_corrections,
    "lost_by_squares": lambda length, x, y: sum_corrections(*square_difference_terms(length, x, y)),
    "rest": lambda length, x, y: _plain_total(*square_difference_terms(length, x, y)) / (2.0 * length),
    "nan": math.nan,
    "inf": math.inf,
}


def array_functions(xp) -> dict[str, Callable]:
    """Functions of arrays of a library, NumPy or JAX, by operation."""
    return {
        **{name: getattr(xp, name) for name in ("sin", "cos", "sqrt", "exp", "log", "copysign")},
        "atan": xp.arctan,
        "root": lambda square, unit: xp.where(
            square > -SQUARE_TOLERANCE * unit, xp.sqrt(xp.maximum(square, 0.0)), xp.nan
        ),
        "divisor": xp.maximum,
        "total": compensated_sum,
        "rest": length_error,
    }


BY_DESIGN = PLAIN | array_functions(np)
INTO_ARRAYS: dict[tuple[str, int], Callable] = {
    ("+", 2): np.add,
    ("-", 2): np.subtract,
    ("*", 2): np.multiply,
    ("/", 2): np.divide,
    ("-", 1): np.negative,
    ("sin", 1): np.sin,
    ("cos", 1): np.cos,
    ("sqrt", 1): np.sqrt,
    ("atan", 1): np.arctan,
    ("exp", 1): np.exp,
    ("log", 1): np.log,
    ("abs", 1): np.absolute,
    ("sign", 1): lambda value, out: np.copysign(1.0, value, out),
    ("held", 1): np.positive,
    ("root", 2): _root_of,
    ("divisor", 2): lambda one, other, out: np.maximum(one, other, out=out),
    **dict.fromkeys([("total", count) for count in range(2, 7)], _total_of),
}
"""Array function of each operation and number of arguments; its last argument receives the result."""
ARRAYS = {_array_function(*operation): function for operation, function in INTO_ARRAYS.items()}
