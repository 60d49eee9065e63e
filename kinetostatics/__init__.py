"""Kinetostatics of planar slider mechanisms: motion, joint forces, drive torque, and what balancing buys.

Call first
    crank_slider, cam_crank_slider, four_bar    a mechanism; Link its masses, Gravity, Spring, ProcessForce its loads
    solve(mechanism, angles, crank_speed=...)   its Solution: motion, every reaction, the torque of the drive
    Scene(mechanism, crank_speed, ...)          all that together; .solve(angles), .varied({"slider.mass": 620.0})
    load_case("sawframe_2r63")                  the same from a file; shipped cases by name
    extremes, compare                           true peaks; how many times better than a reference
    compile(scene, quantities)                  a program to call with other numbers; its exact derivatives
    sweep, tolerances, designs                  a row for each of many designs; what spreads of parameters do
    balancing, linkage, needs                   counterweights; classes of four-bars; how much model a quantity needs
    plots, precision, stability, check          figures; every method's time and error; a test of a group of one's own

Rooms, in the order in which they build on each other
    numbers     elementary functions, planar vectors, leaves of parameter trees, checks, units, files
    machine     what it is: links, guide, cams, crank, groups, loads, the mechanism made of them
    mechanics   what it does: motion, forces, assembly, principal points, quantities with their units
    engines     how fast, how sure: kernels recorded once a structure, NumPy lines, compiled loops, derivatives
    results     extremes, means, reductions, comparison, tables
    solution    what users hold: scene, solution, solve, compile
    drive       motors, periodic running, flywheels, starting and coasting
    design      static balancing, four-bar classes
    sweeps      designs, sweep, workers, datasets, tolerances
    studies     needs, precision, stability, the methods under study
    casefile    case files: schema, reading, building
    views       plots, charts, drawings
"""

from .errors import (
    AssemblyError,
    CaseError,
    ConditionWarning,
    DriveError,
    HintWarning,
    KinetostaticsError,
    ParameterError,
    QuantityError,
)
from .machine import cams
from .machine.builders import cam_crank_slider, crank_slider, four_bar, scotch_yoke, slotted_lever
from .machine.cam_roller import CamRoller
from .machine.crank import Crank
from .machine.cylinder_group import CylinderGroup
from .machine.dyad import Dyad
from .machine.guide import Guide
from .machine.lever_group import LeverGroup
from .machine.links import Link
from .machine.loads import Force, Gravity, PointDamper, PointForce, PointSpring, ProcessForce, Spring, Torque
from .machine.mechanism import Mechanism
from .machine.pin import Pin
from .machine.rocker_group import RockerGroup
from .machine.slider_group import SliderGroup
from .machine.yoke_group import YokeGroup
from .mechanics.principal_points import principal_points
from .results.extremes import extremes
from .solution.compile import compile  # noqa: A004 - the contract's name
from .solution.scene import Scene, solve
from .solution.solution import Solution

__version__ = "0.1.0"

__all__ = [
    "AssemblyError",
    "CamRoller",
    "CaseError",
    "ConditionWarning",
    "Crank",
    "CylinderGroup",
    "DriveError",
    "Dyad",
    "Force",
    "Gravity",
    "Guide",
    "HintWarning",
    "KinetostaticsError",
    "LeverGroup",
    "Link",
    "Mechanism",
    "ParameterError",
    "Pin",
    "PointDamper",
    "PointForce",
    "PointSpring",
    "ProcessForce",
    "QuantityError",
    "RockerGroup",
    "Scene",
    "SliderGroup",
    "Solution",
    "Spring",
    "Torque",
    "YokeGroup",
    "balancing",
    "cam_crank_slider",
    "cams",
    "check",
    "compare",
    "compile",
    "crank_slider",
    "designs",
    "drive",
    "extremes",
    "four_bar",
    "linkage",
    "load_case",
    "needs",
    "plots",
    "precision",
    "principal_points",
    "scotch_yoke",
    "slotted_lever",
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
    "drive": "drive:",
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
