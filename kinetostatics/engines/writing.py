"""Source of programs from recorded arithmetic: a loop for numba, a line of arrays, a line of plain numbers."""

from ..numbers.elementary import ROUNDING, SPLIT
from .fusing import fused, parts, still_needed
from .trace import BY_ANGLE, Node, needed
from .vectors import edition

GIVEN, FILLED = "Array(float64, {}, 'C', True)", "Array(float64, {}, 'C')"
"""Arrays of so many axes that a loop reads, which may be locked, and that it writes, as numba names them."""
ARGUMENTS = f"void({', '.join([GIVEN] * 5 + [FILLED]).format(2, 2, 2, 2, 3, 3)})"
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
LOOP_HEADER = f'''"""Written by kinetostatics, edition {{edition}}; may be deleted at any time."""

from math import atan, copysign, cos, inf, nan, sin, sqrt

from kinetostatics.engines.vectors import over_angles
from numba import njit

options = dict(error_model="numpy", nogil=True)


@njit(**options)
def root(square, unit):
    return sqrt(max(square, 0.0)) if square > {-ROUNDING!r} * unit else nan


@njit(**options)
def divisor(root, unit):
    return unit if root < unit else root


'''
LOOP_TYPE = f"""at_angles = over_angles(line)


@njit("{ARGUMENTS}", cache=KEEP, **options)
"""
LOOP_HEAD = """def loop(angle, sine, cosine, parameters, tables, results):
    for design in range(parameters.shape[0]):
        first = design * (angle.shape[0] > 1)
        table = design * (tables.shape[1] > 1)"""
LOOP = "        at_angles(angle, sine, cosine, tables, results, first, table, design, ({}))"

TOTAL = f"""@njit(**options)
def summed(a, b):
    whole = a + b
    part = whole - a
    return whole, (a - (whole - part)) + (b - part)


@njit(**options)
def parted(one, two, three, four, five, six):
    whole, first = summed(one, two)
    whole, second = summed(whole, three)
    whole, third = summed(whole, four)
    whole, fourth = summed(whole, five)
    whole, fifth = summed(whole, six)
    lost, first = summed(first, second)
    lost, second = summed(lost, third)
    lost, third = summed(lost, fourth)
    lost, fourth = summed(lost, fifth)
    whole, fifth = summed(lost, whole)
    return whole, first, second, third, fourth, fifth


@njit(**options)
def total(one, two, three=0.0, four=0.0, five=0.0, six=0.0):
    whole, first, second, third, fourth, fifth = parted(one, two, three, four, five, six)
    return whole + (first + second + third + fourth + fifth)


@njit(**options)
def lost(one, two, three=0.0, four=0.0, five=0.0, six=0.0):
    _, first, second, third, fourth, fifth = parted(one, two, three, four, five, six)
    return abs(first) + abs(second) + abs(third) + abs(fourth) + abs(fifth)


@njit(**options)
def squared(a):
    whole, spread = a * a, {SPLIT!r} * a
    high = spread - (spread - a)
    low = a - high
    return whole, ((high * high - whole) + 2.0 * high * low) + low * low


@njit(**options)
def off_square(length, x, y):
    one, first = squared(x)
    two, second = squared(y)
    three, third = squared(length)
    return one, first, two, second, -three, -third


@njit(**options)
def rest(length, x, y):
    return total(*off_square(length, x, y)) / (2.0 * length)


@njit(**options)
def lost_by_squares(length, x, y):
    return lost(*off_square(length, x, y))


"""
"""What a loop with sums that lose nothing has besides."""

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


def loop(outputs, fuse=True, kind="float64") -> str:
    """Source of a module with ``loop(angle, sine, cosine, parameters, tables, results)``.

    It takes angles (1 or designs, N) with their sines and cosines, parameters (designs, P) and tables (T, 1 or
    designs, N), and fills results (designs, outputs, N), all of a kind of numbers. Sums are fused with products, see
    `fusing`, unless told.
    """
    nodes = needed(outputs)
    sums = fused(nodes) if fuse else {}
    if sums:
        nodes = still_needed(nodes, outputs, sums)
    by_design = [node for node in nodes if node.varies < BY_ANGLE]
    by_angle = [node for node in nodes if _is_computed_by_angle(node)]
    used = {part for node in by_angle for part in parts(node, sums)}
    used.update(part for part in outputs if isinstance(part, Node))
    fixed = "".join(f"{_name(node)}, " for node in by_design if node in used)
    operations = {node.operation for node in by_design}
    lines = [
        "def line(angle, sine, cosine, tables, numbers):",
        f"    {fixed}= numbers" if fixed else "",
        *(f"    {_fused(node, sums[node]) if node in sums else _defined(node)}" for node in by_angle),
        f"    return ({' '.join(f'{_name(part)},' for part in outputs)})\n\n\n",
    ]
    header = LOOP_HEADER.format(edition=edition())
    header += (FUSED if "fma" in operations else "") + ("" if operations.isdisjoint(("total", "rest")) else TOTAL)
    body = [LOOP_HEAD, *(f"        {_defined(node, _BY_DESIGN)}" for node in by_design), LOOP.format(fixed)]
    return header + "\n".join(filter(None, lines)) + LOOP_TYPE.replace("float64", kind) + "\n".join(body) + "\n"


def _fused(node, found):
    one, other, rest = (_name(part) for part in (found.one, found.other, found.rest))
    signs = ["-" if sign < 0 else "" for sign in (found.sign, found.rest_sign)]
    return f"v{node.index} = fma({signs[0]}{one}, {other}, {signs[1]}{rest})"


def line(outputs, argument_names="angle, sine, cosine, parameters, tables") -> str:
    """Source of ``line(angle, sine, cosine, parameters, tables)``, which returns the outputs as they come.

    Of plain numbers; of arrays too, each operation with new memory.
    """
    lines = [f"def line({argument_names}):"]
    lines += [f"    {_defined(node)}" for node in needed(outputs) if node.operation != "angle"]
    lines.append(f"    return ({' '.join(f'{_name(part)},' for part in outputs)})")
    return "\n".join(lines) + "\n"


def buffered_line(outputs) -> tuple[str, int]:
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
            place_of[node] = _expression(node, _PLAIN)
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


_PLAIN = {"angle": "angle", "parameter": "parameters[{}]", "table": "tables[{}]", "sin": "sine", "cos": "cosine"}
"""What inputs, and sine and cosine of the crank angle, are called."""
_BY_DESIGN = {"parameter": "parameters[design, {}]"}
"""The same in the part of a loop that a design fixes."""
_CALLS = {"held": "{}", "sign": "copysign(1.0, {})"}
"""Operations that are no function of the same name."""


def _defined(node, inputs=_PLAIN):
    return f"v{node.index} = {_expression(node, inputs)}"


def _name(part):
    if not isinstance(part, Node):
        return repr(part.item() if hasattr(part, "item") else part)  # a number of NumPy as a plain one
    return "angle" if part.operation == "angle" else f"v{part.index}"


def _expression(node, inputs):
    kind = node.operation
    if kind in ("angle", "parameter", "table"):
        return inputs[kind].format(*node.arguments)
    if is_of_angle(node):
        return inputs[kind]
    names = [_name(part) for part in node.arguments]
    if kind in ("+", "-", "*", "/"):
        return f" {kind} ".join(names) if len(names) == 2 else f"{kind}{names[0]}"
    return _CALLS.get(kind, f"{kind}({', '.join(names)})").format(*names)
