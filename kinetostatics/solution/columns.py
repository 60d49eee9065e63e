"""Quantities of a solution by name, ``s["O"]``, and the columns of its table: one list for both."""

from operator import methodcaller
from typing import Any, NamedTuple

import numpy as np

from ..mechanics.quantities import of_scene, values, without_bars

ORDER = ("rate", "reaction", "force", "friction", "contact", "whole", "slider", "motion")
"""Order of kinds of quantities in the table, after the positions of joints; energies are left out."""


class Columns(NamedTuple):
    """Columns of a quantity: one, or two of a vector.

    `headings` have the unit: "reaction_O_x [N]". `names`, for ``s[...]``, lack it if nothing else could be meant, which
    of "O_x" is a reaction. ``read(solution)`` gives values, (..., N), of a vector (2, ..., N).
    """

    headings: tuple[str, ...]
    names: tuple[str, ...]
    read: Any

    def values(self, solution):
        """Values of each column."""
        found = self.read(solution)
        return tuple(found) if len(self.headings) == 2 else (found,)


def _columns(name, unit, read, vector, *, bare):
    names = tuple(f"{name}{ending}" for ending in (("_x", "_y") if vector else ("",)))
    headings = tuple(f"{name} [{unit}]" for name in names)
    return Columns(headings, names if bare else headings, read)


def columns_of(solution):
    """`Columns` of the table of a solution, in order."""
    found = [_columns("crank_angle", "deg", lambda s: np.degrees(s.crank_angle), False, bare=False)]
    for joint in solution.placement.joints:
        found.append(_columns(joint, "m", methodcaller("position", joint), True, bare=False))
    quantities = ((name, item) for name, item in of_scene(solution).items() if item.kind in ORDER)
    for name, quantity in sorted(quantities, key=lambda pair: ORDER.index(pair[1].kind)):
        if quantity.kind != "rate" or solution.placement.links[quantity.owner].ratio is not None:
            name = f"reaction_{name}" if quantity.kind == "reaction" else name
            found.append(_columns(name, quantity.unit, quantity.read, quantity.vector, bare=True))
    return found


class ByName:
    """Access to all quantities of a solution by name."""

    _look_up: Any
    __iter__ = None  # not by number

    @property
    def quantities(self):
        """All names that ``s[name]`` takes, a tuple: quantities, then the columns of `frame` that are none."""
        names = (name for columns in columns_of(self) for name in columns.names)
        return tuple(dict.fromkeys((*of_scene(self), *names)))

    def __getitem__(self, name):
        """A quantity, or a column of `frame`, by name, (..., N); a vector is (2, ..., N), ``"|O|"`` its magnitude.

        SI, as by the attribute or method for it: ``s["guide_force"]`` is ``s.guide_force``, ``s["O"]`` the reaction
        ``s.reaction("O")``, ``s["ground cam"]`` the force ``s.ground_force("cam")``. A column has its heading, with
        the unit: ``s["B_x [m]"]``.

        Raises
        ------
        QuantityError
            The quantity is unknown; the message lists all and suggests the nearest. It is a `KeyError` too.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
        >>> s["guide_force"].shape, s["O"].shape
        ((360,), (2, 360))
        >>> print(f"{s['|O|'].max():.0f} N, slider at {s['slider_position'][0]:.2f} m")
        286596 N, slider at 2.30 m
        >>> "shaking_force" in s.quantities
        True
        """
        if isinstance(name, str):
            known = of_scene(self)
            if name in known:
                return known[name].read(self)
            if name.strip("|") in known:
                return values(self, without_bars(self, name))
            for columns in columns_of(self):
                for place, both in enumerate(zip(columns.headings, columns.names, strict=True)):
                    if name in both:
                        return columns.values(self)[place]
        return self._look_up("quantity", name, dict.fromkeys(self.quantities))  # raises

    def _ipython_key_completions_(self):
        return list(self.quantities)
