"""Values that are no number of a design, and what the error says of each."""

import datetime as dt
from fractions import Fraction

import numpy as np


class Quantity:
    """A quantity as pint's are."""

    units, magnitude, shape = "gram", 300.0, ()


class Labelled:
    """A column as pandas' are."""

    shape = (72, 2)

    def to_numpy(self):
        """All numbers."""
        return np.ones(self.shape)


BAD = {
    "NaN": (float("nan"), "finite"),
    "infinity": (np.inf, "finite"),
    "NaN in NumPy": (np.float64("nan"), "finite"),
    "NaN in a batch": (np.array([[1.0], [np.nan]]), "finite"),
    "text": ("2,1", "a text; write a plain number in SI units"),
    "bytes": (b"2.1", "a text"),
    "array of texts": (np.array([["0.3"]]), "of <U3"),
    "truth": (True, "a truth value"),
    "truth in NumPy": (np.True_, "a truth value"),
    "truths": (np.array([[True]]), "of bool"),
    "complex": (1.0 + 1e-30j, "a complex number"),
    "complex batch": (np.array([[1.0 + 0j], [2.0]]), "of complex128"),
    "0-d complex": (np.array(1j), "a complex number"),
    "datetime": (dt.datetime(2026, 1, 1), "a time"),
    "timedelta": (dt.timedelta(1), "a time"),
    "NumPy's datetime": (np.datetime64("2026-01-01"), "no number"),
    "0-d datetime": (np.array("2026-01-01", dtype="M8[D]"), "no number"),
    "dictionary": ({"value": 2.0}, "no number"),
    "set": ({2.0}, "no number"),
    "object": (object(), "no number"),
    "class": (float, "no number"),
    "quantity": (Quantity(), "a quantity with its unit; give the plain number in SI units, as by .to("),
    "objects that are none": (np.array([[1.0], [None]]), "with no number"),
    "text in objects": (np.array([[1.0], ["2"]], dtype=object), "with a text"),
    "labelled table": (Labelled(), "a labelled table; give its numbers"),
    "masked": (np.ma.array([[1.0], [2.0]], mask=[[0], [1]]), "a masked array"),
    "huge integer": (10**400, "too large"),
    "huge fraction": (Fraction(10**400, 3), "too large"),
    "huge integer in a batch": (np.array([[1], [10**400]]), "too large"),
    "1e200": (1e200, "to be computed in double precision"),
    "nothing in a batch": (np.empty((0, 1)), "which is empty"),
    "one value for each angle": (np.ones((1, 72)), "its last axis would be the crank angle"),
    "row": (np.ones(72), "its last axis would be the crank angle"),
    "square": (np.ones((2, 2)), "its last axis would be the crank angle"),
    "list": ([1.0, 2.0, 3.0], "got [1.0, 2.0, 3.0]"),
    "ragged list": ([[1.0, 2.0], [3.0]], "got [[1.0, 2.0], [3.0]]"),
}
