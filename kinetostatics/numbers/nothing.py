"""A zero that absorbs what it is multiplied by, and is left out of sums: arithmetic finds where there is nothing."""


class Nothing:
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


NOTHING = Nothing()


def absent(value):
    """None for nothing, and for a plain number that is zero; the value else."""
    return None if value is NOTHING or (isinstance(value, int | float) and value == 0) else value
