"""Kinetostatics of planar slider mechanisms: motion, joint forces, drive torque, and what balancing buys.

planar, elementary          vectors by components; sin, cos, sqrt of any array
links, guide, loads         what a mechanism is made of
crank                       the driver
cam_roller, cams            slotted crank, block and roller on a fixed cam
slider_group, rocker_group  coupler and slider on a guide; coupler and rocker
chain, batch, mechanism     how groups hang together; the mechanisms made of them
motion, solution            what it does and what forces that takes
tracing, compiled           the kernels' arithmetic written down, and as a loop by numba
balancing, counterweights   static balancing, the counterweights it takes, and their price
linkage                     swing and class of four-bars
principal_points            common mass centre and shaking force from the link masses
assembly                    where it can be put together
turn                        the period results are reduced over, and where they have no correct digit
extremes, comparison        true extrema; dynamic coefficients
ingredients, rerouted       how much model a quantity needs; motion found in other ways
precision, stability        every method's time against error; where methods fail
methods                     the methods under study and the certified reference
designs, parameters         tables of designs; what a case lets vary
sweeps, chunks, dispatch    a row for each design: the sweep, one chunk, workers and their deaths
reductions, dataset         numbers from values over the turn; results on disk
tolerance                   spreads, quantiles, Sobol indices
case, schema, units         case files and what they may hold; text with units
files                       CSV tables in, results out
quantities, tables          names and units of results; DataFrames
checks, errors, hints       what is refused at the door, how it is said, and what looks like a slip
group_check                 a test of a group of one's own
substitution, timing        other kinds of numbers in place of floats; how long, and on what machine
plots, charts               figures of solutions; charts of studies
drawings, canvas            the mechanism itself; what figures share
figures, cli                figures of a case; command line
"""

from . import cams
from .cam_roller import CamRoller
from .crank import Crank
from .errors import (
    AssemblyError,
    CaseError,
    ConditionWarning,
    HintWarning,
    KinetostaticsError,
    ParameterError,
    QuantityError,
)
from .extremes import extremes
from .guide import Guide
from .links import Link
from .loads import Gravity, ProcessForce, Spring
from .mechanism import Mechanism, cam_crank_slider, crank_slider, four_bar
from .principal_points import principal_points
from .rocker_group import RockerGroup
from .slider_group import SliderGroup
from .solution import Solution, solve

__version__ = "0.1.0"

__all__ = [
    "AssemblyError",
    "CamRoller",
    "CaseError",
    "ConditionWarning",
    "Crank",
    "Gravity",
    "Guide",
    "HintWarning",
    "KinetostaticsError",
    "Link",
    "Mechanism",
    "ParameterError",
    "ProcessForce",
    "QuantityError",
    "RockerGroup",
    "SliderGroup",
    "Solution",
    "Spring",
    "balancing",
    "cam_crank_slider",
    "cams",
    "check",
    "compare",
    "crank_slider",
    "designs",
    "extremes",
    "four_bar",
    "linkage",
    "load_case",
    "needs",
    "plots",
    "precision",
    "principal_points",
    "solve",
    "stability",
    "sweep",
    "tolerances",
]


_LATER = {
    "balancing": None,
    "check": "group_check",
    "compare": "comparison",
    "designs": None,
    "linkage": None,
    "load_case": "case",
    "needs": "ingredients",
    "plots": None,
    "precision": None,
    "stability": None,
    "sweep": "sweeps",
    "tolerances": "tolerance",
}
"""Names loaded, with the libraries they need, only when used: modules, and functions with the module they are in."""


def __getattr__(name):
    import importlib

    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = importlib.import_module(f".{_LATER[name] or name}", __name__)
    return getattr(module, name) if _LATER[name] else module
