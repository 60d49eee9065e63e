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

from .errors import (
    AssemblyError,
    CaseError,
    ConditionWarning,
    HintWarning,
    KinetostaticsError,
    ParameterError,
    QuantityError,
)
from .machine import cams
from .machine.builders import cam_crank_slider, crank_slider, four_bar
from .machine.cam_roller import CamRoller
from .machine.crank import Crank
from .machine.guide import Guide
from .machine.links import Link
from .machine.loads import Gravity, ProcessForce, Spring
from .machine.mechanism import Mechanism
from .machine.rocker_group import RockerGroup
from .machine.slider_group import SliderGroup
from .mechanics.principal_points import principal_points
from .results.extremes import extremes
from .solution.scene import Scene, solve
from .solution.solution import Solution

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
    "Scene",
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
    "balancing": "design.balancing:",
    "check": "solution.group_check:check",
    "compare": "results.comparison:compare",
    "designs": "sweeps.designs:",
    "linkage": "design.linkage:",
    "load_case": "casefile.case:load_case",
    "needs": "studies.needs:needs",
    "plots": "views.plots:",
    "precision": "studies.precision:",
    "stability": "studies.stability:",
    "sweep": "sweeps.sweeps:sweep",
    "tolerances": "sweeps.tolerance:tolerances",
}
"""Names loaded, with the libraries they need, only when used: where each is, "module:function" or "module:"."""


def __getattr__(name):
    import importlib

    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    path, _, attribute = _LATER[name].partition(":")
    module = importlib.import_module(f".{path}", __name__)
    return getattr(module, attribute) if attribute else module
