"""Planar vectors by components, and the rule that what is absent costs nothing.

A vector is a pair (x, y) of numbers or arrays. `None` stands for what is absent: a vector or number that is zero and
is left out of sums. All functions are kernels: no branching on values, no writing in place, no array library by name.

A zero that absorbs what it is multiplied by, and is left out of sums: arithmetic finds where there is nothing.
"""

from .arithmetic import NEGLIGIBLE_LENGTH, length_error, offset_from_zero, sqrt


class SymbolicZero:
    """The zero; only `NOTHING` is made of it."""

    __slots__ = ()
    __array_ufunc__ = None  # arrays leave arithmetic with it to it

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
        return "NOTHING"


SYMBOLIC_ZERO = SymbolicZero()


def none_if_zero(value):
    """None for nothing, and for a plain number that is zero; the value else."""
    return None if value is SYMBOLIC_ZERO or (isinstance(value, int | float) and value == 0) else value


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def cross(a, b):
    """Third component of a x b: the moment about the origin of force b acting at a."""
    return a[0] * b[1] - a[1] * b[0]


def length(a):
    return sqrt(dot(a, a))


def length_with_error(a):
    """Length of a vector, never zero, and what rounding took off it; along an axis nothing, and as it is."""
    x, y = map(none_if_zero, a)
    if x is None or y is None:
        return abs(number_or_zero(y if x is None else x)), None
    whole = length((offset_from_zero(x, NEGLIGIBLE_LENGTH), y))
    return whole, length_error(whole, x, y)


def curvature(first, second):
    """Signed curvature of a path from two derivatives of its place, positive where it turns to the left."""
    square = dot(first, first)
    return cross(first, second) / (square * sqrt(square))


def polar_curvature(radius, slope, second):
    """Curvature of a curve from r, r', r'', 1/m, positive where it is convex seen from outside.

    (r^2 + 2 r'^2 - r r'') / (r^2 + r'^2)^(3/2): of its place as seen from the ray, where r turns with it.
    """
    return curvature((slope, radius), (second - radius, 2.0 * slope))


def left(a):
    """Vector a after a quarter turn counter-clockwise."""
    return (-a[1], a[0])


def rotate(a, direction):
    """Vector a turned by the angle of a unit vector; None turns nothing."""
    if direction is None:
        return a
    return (direction[0] * a[0] - direction[1] * a[1], direction[1] * a[0] + direction[0] * a[1])


def rotate_back(a, direction):
    """Components of a along a unit vector and across it, to the left; None: of a as it is."""
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
    """An absent number as zero."""
    return 0.0 if a is None else a


def vector_or_zero(a):
    """An absent vector as zero."""
    return (0.0, 0.0) if a is None else a
