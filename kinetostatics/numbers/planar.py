"""Plane vectors (x, y) of numbers or arrays; None is an absent vector or number, a zero left out of sums.

All functions are kernels: no branches on values, no writing in place, no array library by name. `SYMBOLIC_ZERO` is the
zero of plain arithmetic that absorbs factors and drops out of sums.
"""

from .arithmetic import NEGLIGIBLE_LENGTH, length_error, offset_from_zero, sqrt


class SymbolicZero:
    """A zero that absorbs its factors and drops out of sums; `SYMBOLIC_ZERO` is its only object."""

    __slots__ = ()
    __array_ufunc__ = None  # so arrays leave operations to this class

    def __add__(self, other):
        return other

    __radd__ = __rsub__ = __add__

    def __sub__(self, other):
        return -other

    def __mul__(self, other):
        return self

    __rmul__ = __truediv__ = __mul__

    def __neg__(self):
        return self

    __pos__ = __abs__ = __neg__

    def __float__(self):
        return 0.0

    def __repr__(self):
        return "SYMBOLIC_ZERO"


SYMBOLIC_ZERO = SymbolicZero()


def none_if_zero(value):
    """None for the symbolic zero and a plain zero, else the value."""
    return None if value is SYMBOLIC_ZERO or (isinstance(value, int | float) and value == 0) else value


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def cross(a, b):
    """Third component of a x b: the moment about the origin of force b acting at a."""
    return a[0] * b[1] - a[1] * b[0]


def length(a):
    return sqrt(dot(a, a))


def length_with_error(a):
    """Length of a vector and its rounding error; along an axis the length is exact and the error None.

    Elsewhere a negligible offset keeps the length from 0.
    """
    x, y = map(none_if_zero, a)
    if x is None or y is None:
        return abs(number_or_zero(y if x is None else x)), None
    whole = length((offset_from_zero(x, NEGLIGIBLE_LENGTH), y))
    return whole, length_error(whole, x, y)


def curvature(first, second):
    """Signed curvature of a path, 1/m, from two derivatives of its point; positive where it turns left."""
    square = dot(first, first)
    return cross(first, second) / (square * sqrt(square))


def polar_curvature(radius, slope, second):
    """Curvature of a curve in polar coordinates, 1/m, from r, r', r''; positive where it is convex seen from outside.

    (r^2 + 2 r'^2 - r r'') / (r^2 + r'^2)^(3/2), with derivatives in the axes of the ray.
    """
    return curvature((slope, radius), (second - radius, 2.0 * slope))


def left(a):
    """Vector a after a quarter turn counter-clockwise."""
    return (-a[1], a[0])


def rotate(a, direction):
    """Vector a rotated by the angle of a unit vector; unchanged for None."""
    if direction is None:
        return a
    return (direction[0] * a[0] - direction[1] * a[1], direction[1] * a[0] + direction[0] * a[1])


def rotate_back(a, direction):
    """Components of a along a unit vector and to its left; unchanged for None."""
    if direction is None:
        return a
    return (dot(direction, a), cross(direction, a))


def scale_vector(factor, a):
    """Vector times number, absent if either is."""
    if factor is None or a is None:
        return None
    return (factor * a[0], factor * a[1])


def plus(a, b):
    """Sum of two numbers, either of which may be absent."""
    if a is None:
        return b
    if b is None:
        return a
    return a + b


def minus(a, b):
    """Difference of two numbers, either or both of which may be absent."""
    if b is None:
        return a
    if a is None:
        return -b
    return a - b


def add_vectors(a, b):
    """Sum of two vectors, either of which may be absent."""
    if a is None:
        return b
    if b is None:
        return a
    return (a[0] + b[0], a[1] + b[1])


def subtract_vectors(a, b):
    """Difference of two vectors, either of which may be absent."""
    if b is None:
        return a
    if a is None:
        return (-b[0], -b[1])
    return (a[0] - b[0], a[1] - b[1])


def product(a, b):
    """Product of two numbers, absent if either is."""
    if a is None or b is None:
        return None
    return a * b


def quotient(a, b):
    """Quotient of two numbers, absent if the first is."""
    if a is None:
        return None
    return a / b


def moment(arm, force):
    """Moment of a force at the end of an arm, absent if either is."""
    if arm is None or force is None:
        return None
    return cross(arm, force)


def work(force, displacement):
    """Work of a force on a displacement, absent if either is."""
    if force is None or displacement is None:
        return None
    return dot(force, displacement)


def number_or_zero(a):
    """The number, 0.0 for None."""
    return 0.0 if a is None else a


def vector_or_zero(a):
    """The vector, (0.0, 0.0) for None."""
    return (0.0, 0.0) if a is None else a
