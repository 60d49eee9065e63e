"""Methods under study: other ways to the same results, to measure the library's own against them.

May import the rooms above `studies`; no calculation of the library calls them.
"""

from . import engines, papers
from .global_system import constraints, newton
from .kane import equations
from .method import Method

METHODS = (
    *engines.METHODS,
    *papers.METHODS,
    *equations.METHODS,
    *newton.NEWTON_METHODS,
    *constraints.METHODS,
    *newton.INTEGRATION_METHODS,
    papers.AS_PRINTED,
)
"""All methods, in the order of charts."""

__all__ = ["METHODS", "Method"]
