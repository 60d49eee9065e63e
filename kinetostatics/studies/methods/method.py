"""What a method under study is: one way to a quantity, to be measured against the library's own."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import NotGivenError
from ...machine.groups.change_points import SIDES

__all__ = ["Method", "NotGivenError", "on_a_side", "require_frictionless", "require_moving", "require_one_design"]


def on_a_side(mechanism):
    """The mechanism with sides in place of the words "open" and "crossed", which formulas of one side do not know."""
    if mechanism.passes:
        raise NotGivenError(f"{mechanism.name} passes change points, but the formulas keep to one side of them")
    groups = tuple(
        replace(group, assembly=SIDES[group.assembly]) if group.through else group for group in mechanism.groups
    )
    return replace(mechanism, groups=groups)


@dataclass(frozen=True)
class Method:
    """One way to the quantities of a solution.

    Attributes
    ----------
    name : str
        What charts and tables call it.
    prepare : function
        ``prepare(solution, quantity, setting)`` does whatever is done once for a mechanism and returns a function
        without arguments that computes the quantity at the solution's crank angles, as a tuple of its components (see
        `quantities.components`). It raises `NotGivenError` for what the method cannot give.
    setting : str
        What can be set, with its unit; empty if nothing.
    settings : tuple
        Values of the setting, from coarse to fine.
    ours : bool
        Whether it is the library's own path.
    bound : function, optional
        ``bound(solution, quantity)``: what the method itself proves its error to be at most, (N,). Without, it does not
        know how wrong it is.
    precision : "double" or "single"
        Of the library's own path.
    device : function, optional
        ``device()``: what computes, as "gpu: NVIDIA H100"; without, the processor, "cpu".

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> ours = ks.precision.METHODS[0]
    >>> (torque,) = ours.prepare(s, "balancing_torque", None)()
    >>> ours.name, torque.shape
    ('ours, NumPy', (8,))
    """

    name: str
    prepare: Callable[[Any, str, Any], Callable[[], tuple[Any, ...]]]
    setting: str = ""
    settings: tuple[Any, ...] = (None,)
    ours: bool = False
    bound: Callable[[Any, str], Any] | None = None
    precision: str = "double"
    device: Callable[[], str] | None = None


def require_frictionless(solution):
    """Raise `NotGivenError` for friction, whose forces depend on the reactions that they change."""
    if solution.friction:
        raise NotGivenError(f"its equations know no friction, but there is some in {', '.join(solution.friction)}")


def require_moving(solution):
    """Raise `NotGivenError` for friction where the crank rests, which has no sense then."""
    if solution.friction and not np.all(solution.crank_speed):
        raise NotGivenError("friction of a crank at rest has no sense")


def require_one_design(solution):
    """Raise `NotGivenError` for a batch of designs, and for crank angles that are no row."""
    if solution.shape != np.shape(solution.crank_angle) or len(solution.shape) != 1:
        raise NotGivenError(f"one mechanism at crank angles (N,) is needed, not a batch of shape {solution.shape}")
