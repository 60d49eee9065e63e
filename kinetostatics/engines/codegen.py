"""Source of programs from recorded arithmetic: a loop for numba, a line of arrays, a line of plain numbers.

What recorded operations do to plain numbers, to arrays with new memory, and to arrays with memory given.
"""

import math
from itertools import pairwise

import numpy as np

from ..numbers.elementary import ROUNDING, SPLIT, lost, off_square, rest, total
from .graph import BY_ANGLE, Node, needed
from .simplify import drop_unused, fused_sums

GIVEN, FILLED = "Array(float64, {}, 'C', True)", "Array(float64, {}, 'C')"
"""Arrays of so many axes that a loop reads, which may be locked, and that it writes, as numba names them."""
ARGUMENTS = f"void({', '.join([GIVEN] * 5 + [FILLED]).format(2, 2, 2, 2, 3, 1)})"
"""What a loop takes: crank angles, their sines and cosines, parameters, tables, results."""
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

from math import atan, copysign, cos, inf, nan, sin, sqrt

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
"""Start of a loop's module. No two arrays of a loop share memory: LLVM need not check that before it uses vectors."""
LOOP = f"""@njit("{ARGUMENTS}", cache=KEEP, pipeline_class=SeparateArrays, error_model="numpy", nogil=True, _nrt=False)
def loop(angles, sines, cosines, parameters, tables, results):
    count = uint64(angles.shape[1]) & uint64({2**40 - 1})
    for design in range(parameters.shape[0]):
        first = design * (angles.shape[0] > 1)
        table = design * (tables.shape[1] > 1)
        start = uint64(design) * uint64({{rows}}) * count"""
"""Start of a loop. A count below 2^40 shows LLVM that no two rows of the results overlap, however many they are."""
TWO_SUM = """@njit(error_model="numpy")
def two_sum(a, b):
    whole = a + b
    part = whole - a
    return whole, (a - (whole - part)) + (b - part)


"""
"""What compensated sums need."""
SQUARES = f"""@njit(error_model="numpy")
def squared(a):
    whole, spread = a * a, {SPLIT!r} * a
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
"""What the rounding of a vector's length needs."""

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
"""What a loop with fused products and sums has before all else; two operations where the processor has not the one."""


def loop_source(outputs, fuse=True, kind="float64") -> str:
    """Source of a module with ``loop(angles, sines, cosines, parameters, tables, results)``.

    It takes angles (1 or designs, N) with their sines and cosines, parameters (designs, P) and tables (T, 1 or
    designs, N), and fills results (designs, outputs, N), all of a kind of numbers. Sums are fused with products, see
    `fusing`, unless told.
    """
    nodes = needed(outputs)
    sums = fused_sums(nodes) if fuse else {}
    if sums:
        nodes = drop_unused(nodes, outputs, sums)
    of_loop = [node for node in nodes if _is_computed_by_angle(node)]
    lines = [LOOP.format(rows=len(outputs))]
    lines += [f"        {_defined(node, _IN_LOOP)}" for node in nodes if node.varies < BY_ANGLE]
    lines += ["        for i in range(count):", "            angle = angles[first, i]"]
    lines += [
        f"            {_fused(node, sums[node]) if node in sums else _defined(node, _IN_LOOP)}" for node in of_loop
    ]
    lines += [
        f"            results[start + uint64({row}) * count + i] = {_name(part)}" for row, part in enumerate(outputs)
    ]
    fma = FUSED if sums or any(node.operation == "fma" for node in nodes) else ""
    header = LOOP_HEADER.format(threshold=-ROUNDING) + _helpers(nodes) + fma
    return (header + "\n".join(lines) + "\n").replace("float64", kind)


def _helpers(nodes):
    """Source of the compensated sums that nodes call."""
    calls = {(node.operation, len(node.arguments)) for node in nodes if node.operation in ("total", "lost")}
    squares = any(node.operation in ("rest", "lost_by_squares") for node in nodes)
    calls |= {("total", 6), ("lost", 6)} if squares else set()
    return (TWO_SUM if calls else "") + "".join(_sum_of(*call) for call in sorted(calls)) + (SQUARES if squares else "")


def _sum_of(name, count):
    """Source of a `total` of so many terms, or of what it has `lost`: see `elementary.total`."""
    terms = [f"t{k}" for k in range(count)]
    steps = [f"    {there}, {here} = two_sum({here}, {there})" for here, there in pairwise(terms)]
    found = (
        f"t{count - 1} + ({' + '.join(terms[:-1])})"
        if name == "total"
        else " + ".join(f"abs({term})" for term in terms[:-1])
    )
    lines = [
        '@njit(error_model="numpy")',
        f"def {name}{count}({', '.join(terms)}):",
        *steps,
        *steps,
        f"    return {found}",
    ]
    return "\n".join(lines) + "\n\n\n"


def _fused(node, found):
    one, other, rest = (_name(part) for part in (found.one, found.other, found.rest))
    signs = ["-" if sign < 0 else "" for sign in (found.sign, found.rest_sign)]
    return f"v{node.index} = fma({signs[0]}{one}, {other}, {signs[1]}{rest})"


def line_source(outputs, argument_names="angle, sine, cosine, parameters, tables") -> str:
    """Source of ``line(angle, sine, cosine, parameters, tables)``, which returns the outputs as they come.

    Of plain numbers; of arrays too, each operation with new memory.
    """
    lines = [f"def line({argument_names}):"]
    lines += [f"    {_defined(node)}" for node in needed(outputs) if node.operation != "angle"]
    lines.append(f"    return ({' '.join(f'{_name(part)},' for part in outputs)})")
    return "\n".join(lines) + "\n"


def buffered_source(outputs) -> tuple[str, int]:
    """Source of ``line(angle, sine, cosine, parameters, tables, buffers, results)`` on arrays, and how many buffers.

    Each operation writes into a buffer whose value is needed no more, or into its row of the results.
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
            source.append(f"    multiply({', '.join([*factors, target])}); add({target}, {more}, {target})")
        else:
            source.append(f"    {_OPERATIONS[node.operation, len(names)]}({', '.join([*names, target])})")
    source += [f"    r{place}[...] = {place_of.get(part) or _name(part)}" for place, part in copies]
    heads = ["def line(angle, sine, cosine, parameters, tables, buffers, results):"]
    heads += [f"    {', '.join(f'b{k}' for k in range(count))}, = buffers"] if count else []
    heads += [f"    {', '.join(f'r{k}' for k in range(len(outputs)))}, = results"] if outputs else []
    return "\n".join(heads + source) + "\n", count


_OPERATIONS = {
    ("+", 2): "add",
    ("-", 2): "subtract",
    ("*", 2): "multiply",
    ("/", 2): "divide",
    ("-", 1): "negative",
    ("sin", 1): "sin_of",
    ("cos", 1): "cos_of",
    ("sqrt", 1): "sqrt_of",
    ("atan", 1): "arctan",
    ("abs", 1): "absolute",
    ("sign", 1): "sign_of",
    ("held", 1): "positive",
    ("root", 2): "root_of",
    ("divisor", 2): "maximum",
    **{("total", count): "total_of" for count in range(2, 7)},
}
"""By operation and number of arguments: the array function that takes its result's place as last argument."""
_IN_PLACE = ("+", "-", "*", "/", "abs", "sqrt", "divisor")


def _is_computed_by_angle(node):
    return node.varies == BY_ANGLE and node.operation != "angle"


def _is_given(node):
    """Whether a node's value is handed in."""
    return node.operation in ("angle", "table") or is_of_angle(node)


def is_of_angle(node):
    """Whether a node is the sine or cosine of the crank angle."""
    return node.operation in ("sin", "cos") and node.arguments[0].operation == "angle"


_IN_LINE = {
    "parameter": "parameters[{}]",
    "table": "tables[{}]",
    "sin": "sine",
    "cos": "cosine",
    "held": "{}",
    "sign": "copysign(1.0, {})",
}
"""Inputs, and operations that are no function of the same name, in a line."""
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
"""Inputs, and operations that are no function of the same name, in a compiled loop."""


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
