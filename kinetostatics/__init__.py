"""Kinetostatics of planar slider mechanisms: motion, joint forces, drive torque, and what balancing buys.

    planar, elementary          vectors by components; sin, cos, sqrt of any array
    links, guide, loads         what a mechanism is made of
    crank                       the driver
    cam_roller, cams            slotted crank, block and roller on a fixed cam
    slider_group                coupler and slider on a guide
    chain, mechanism            how groups hang together; the mechanisms made of them
    motion, solution            what it does and what forces that takes
    assembly                    where it can be put together
    extremes, comparison        true extrema; dynamic coefficients
    cases, units, tables        case files, units, tables
    plots, cli                  figures; command line
"""

from . import cams
from .crank import Crank
from .cam_roller import CamRoller
from .comparison import compare
from .errors import AssemblyError, CaseError, ConditionWarning, KinetostaticsError, ParameterError, QuantityError
from .extremes import extremes
from .guide import Guide
from .links import Link
from .loads import Gravity, ProcessForce, Spring
from .mechanism import Mechanism, cam_crank_slider, crank_slider
from .slider_group import SliderGroup
from .solution import Solution, solve
