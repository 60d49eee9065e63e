"""Methods under study: other ways to the library's results, kept to be measured against it.

method      what a method is
engines     the library's own path: NumPy, compiled, JAX, by powers, in double and in single precision
joints      other ways to the motion: differences, spectra, harmonic series; two-mass coupler
papers      the published studies' own formulas, and the one with a wrong sign as printed
newton      Newton iteration on the loop equations, and all forces from one system
integration constrained multibody integration at constant speed
structures  what groups declare of a mechanism, from which newton, integration, kane and independent are made
kane        SymPy's Kane method, lambdified: loops in kane_motion, curves in kane_cams, forces in kane_equations
applied     loads besides weight, for equations made without them
enclosures  the library's kernels on arb numbers
independent other formulas by mpmath
certified   both in agreement: what all are measured against
running     periodic running under a motor: stepping, shooting, fixed steps, collocation
motion      published motions over time: reduced inertia and constraint equations
exact_running   periodic running at many digits, what those are measured against

Nothing in the library's numeric path calls them; where they fail is counted by the tests.
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
