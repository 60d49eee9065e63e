"""What a method under study is: one way to a quantity, to be measured against the library's own."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..errors import NotGivenError

__all__ = ["Method", "NotGivenError"]


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
    """

    name: str
    prepare: Callable[[Any, str, Any], Callable[[], tuple[Any, ...]]]
    setting: str = ""
    settings: tuple[Any, ...] = (None,)
    ours: bool = False
