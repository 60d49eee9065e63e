"""The hand calculation behind a quantity at one crank angle, step by step: formula, numbers, result.

Made by `explaining` from the kernels' own arithmetic.
"""

from dataclasses import dataclass
from math import degrees, hypot
from typing import Any, NamedTuple

import numpy as np

from ..explain import pages
from ..explain.formats import in_digits
from ..numbers.lazy import cached_property


class Step(NamedTuple):
    """A step of a hand calculation.

    Attributes
    ----------
    title : str
        What it belongs to: a link, a load, the forces on a part.
    words : str
        What the number is; what is given is called by its path.
    symbol : str
    formula, numbers : str
        In symbols of steps before, and with their values; "" of what is given.
    value : float
    unit : str
    shown : str
        The value as it is shown: to 6 digits, 0 where it is rounding.
    latex, mathml : tuple of str
        Symbol, formula, numbers and value with its unit.
    """

    title: str
    words: str
    symbol: str
    formula: str
    numbers: str
    value: float
    unit: str
    shown: str
    latex: tuple[str, ...]
    mathml: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Explanation:
    """A hand calculation; made by `Solution.explain`, shown by ``print``, as a page in notebooks.

    Attributes
    ----------
    mechanism, quantity, label : str
        Names, of the quantity also in words.
    angle : float
        Crank angle, rad.
    steps : tuple of Step
    results : tuple of Step
        Those of them that give the quantity, of a vector its components.
    value : float or array (2,)
        The quantity as the solution gives it, but for the last rounding.
    unit : str

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0).solve(4)
    >>> told = s.explain("balancing_torque", 0.5)
    >>> round(float(told.value), 6), told.unit
    (14.875291, 'N m')
    """

    mechanism: str
    quantity: str
    label: str
    angle: float
    steps: tuple[Step, ...]
    results: tuple[Step, ...]
    value: Any
    unit: str

    @property
    def title(self):
        """Mechanism, quantity and crank angle."""
        angle = f"{in_digits(self.angle)} rad = {in_digits(degrees(self.angle))} deg"
        return f"{self.mechanism}: {self.label} at crank angle {angle}"

    @property
    def conclusion(self):
        """The quantity and its value, of a vector the magnitude too."""
        values = [step.shown for step in self.results] or [in_digits(float(part)) for part in np.ravel(self.value)]
        unit = "" if self.unit == "1" else f" {self.unit}"
        if np.ndim(self.value):
            size = in_digits(hypot(*self.value))
            return f"{self.quantity} = ({', '.join(values)}){unit}, magnitude {size}{unit}"
        angle = f" = {in_digits(degrees(self.value))} deg" if self.unit == "rad" else ""
        return f"{self.quantity} = {values[-1]}{unit}{angle}"

    @cached_property
    def text(self):
        """The calculation in lines of 80 characters."""
        return pages.text(self)

    @cached_property
    def latex(self):
        """The calculation for a LaTeX document with amsmath."""
        return pages.latex(self)

    @cached_property
    def html(self):
        """The calculation as a piece of HTML, formulas as MathML; it asks for nothing from elsewhere."""
        return pages.html(self)

    @property
    def page(self):
        """The same as a whole page of HTML."""
        return pages.page(self)

    def __str__(self):
        return self.text

    def __repr__(self):
        return f"<Explanation: {self.title}, {len(self.steps)} steps; print it>"

    def _repr_html_(self):
        return self.html

    def _repr_latex_(self):
        return self.latex
