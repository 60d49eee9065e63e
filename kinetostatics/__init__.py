"""Kinetostatics of planar slider mechanisms: motion, joint forces, drive torque, and what balancing buys.

Call first
    crank_slider, cam_crank_slider, four_bar    a mechanism; Link its masses, Gravity, Spring, ProcessForce its loads
    slotted_lever, scotch_yoke                  more of them; Pin, Dyad, LeverGroup ... for chains of one's own
    Force, Torque, PointForce, PointSpring ...  loads on any link; Table of their values by angle or travel
    solve(mechanism, angles, crank_speed=...)   its Solution: motion, every reaction, the torque of the drive
    Scene(mechanism, crank_speed, ...)          all that together; .solve(angles), .varied({"slider.mass": 620.0})
    load_case("sawframe_2r63")                  the same from a file; shipped cases by name
    extremes, compare                           true peaks; how many times better than a reference
    compile(scene, quantities)                  a program to call with other numbers; its exact derivatives
    sweep, tolerances, designs                  a row for each of many designs; what spreads of parameters do
    balancing, linkage, needs                   counterweights; classes of four-bars; how much model a quantity needs
    design.optimise, design.torque_free_cam     the best machine within bounds and limits; a cam that needs no torque
    laws, cams, design                          laws of motion; cams that make them; contact of the roller, lift-off ...
    plots, precision, stability, check          figures; every method's time and error; a test of a group of one's own

Rooms, in the order in which they build on each other
    numbers     elementary functions, planar vectors, leaves of parameter trees, checks, units, files
    machine     what it is: links, guide, cams, crank, groups, loads, the mechanism made of them
    mechanics   what it does: motion, forces, assembly, principal points, quantities with their units
    engines     how fast, how sure: kernels recorded once a structure, NumPy lines, compiled loops, derivatives
    results     extremes, means, reductions, comparison, tables
    solution    what users hold: scene, solution, solve, compile
    drive       motors, periodic running, flywheels, starting and coasting
    design      counterweights, four-bar classes, contact of cams, optimisation under limits, torque-free cams
    sweeps      designs, sweep, workers, datasets, tolerances
    studies     needs, precision, stability, the methods under study
    casefile    case files: schema, reading, building
    views       plots, charts, drawings
"""

from importlib import import_module
from typing import TYPE_CHECKING

from .errors import (
    AssemblyError,
    CaseError,
    ConditionWarning,
    DesignError,
    DriveError,
    HintWarning,
    JammingError,
    KinetostaticsError,
    ParameterError,
    QuantityError,
)

if TYPE_CHECKING:
    from . import design, drive
    from .casefile.case import load_case
    from .design import balancing, linkage
    from .machine import cams, laws
    from .machine.builders import cam_crank_slider, crank_slider, four_bar, scotch_yoke, slotted_lever
    from .machine.cam_roller import CamRoller
    from .machine.crank import Crank
    from .machine.cylinder_group import CylinderGroup
    from .machine.dyad import Dyad
    from .machine.flat_follower import FlatFollower
    from .machine.friction import GuideFriction, PinFriction, RollerFriction, SlotFriction
    from .machine.guide import Guide
    from .machine.lever_group import LeverGroup
    from .machine.links import Link
    from .machine.loads import (
        Force,
        Gravity,
        PointDamper,
        PointForce,
        PointSpring,
        ProcessForce,
        Spring,
        Table,
        Torque,
        TorsionDamper,
        TorsionSpring,
    )
    from .machine.mechanism import Mechanism
    from .machine.pin import Pin
    from .machine.rocker_group import RockerGroup
    from .machine.roller_follower import RollerFollower
    from .machine.slider_group import SliderGroup
    from .machine.swinging_follower import SwingingFollower
    from .machine.yoke_group import YokeGroup
    from .mechanics.principal_points import principal_points
    from .results.comparison import compare
    from .results.extremes import extremes
    from .solution.compile import compile  # noqa: A004 - the contract's name
    from .solution.group_check import check
    from .solution.scene import Scene, solve
    from .solution.solution import Solution
    from .studies import precision, stability
    from .studies.needs import needs
    from .sweeps import designs
    from .sweeps.sweeps import sweep
    from .sweeps.tolerance import tolerances
    from .views import plots

__version__ = "0.2.0"

__all__ = [
    "AssemblyError",
    "CamRoller",
    "CaseError",
    "ConditionWarning",
    "Crank",
    "CylinderGroup",
    "DesignError",
    "DriveError",
    "Dyad",
    "FlatFollower",
    "Force",
    "Gravity",
    "Guide",
    "GuideFriction",
    "HintWarning",
    "JammingError",
    "KinetostaticsError",
    "LeverGroup",
    "Link",
    "Mechanism",
    "ParameterError",
    "Pin",
    "PinFriction",
    "PointDamper",
    "PointForce",
    "PointSpring",
    "ProcessForce",
    "QuantityError",
    "RockerGroup",
    "RollerFollower",
    "RollerFriction",
    "Scene",
    "SliderGroup",
    "SlotFriction",
    "Solution",
    "Spring",
    "SwingingFollower",
    "Table",
    "Torque",
    "TorsionDamper",
    "TorsionSpring",
    "YokeGroup",
    "balancing",
    "cam_crank_slider",
    "cams",
    "check",
    "compare",
    "compile",
    "crank_slider",
    "design",
    "designs",
    "drive",
    "extremes",
    "four_bar",
    "laws",
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


_WHERE = {
    "machine": ["cams", "laws"],
    "machine.builders": ["cam_crank_slider", "crank_slider", "four_bar", "scotch_yoke", "slotted_lever"],
    "machine.cam_roller": ["CamRoller"],
    "machine.crank": ["Crank"],
    "machine.cylinder_group": ["CylinderGroup"],
    "machine.dyad": ["Dyad"],
    "machine.flat_follower": ["FlatFollower"],
    "machine.friction": ["GuideFriction", "PinFriction", "RollerFriction", "SlotFriction"],
    "machine.guide": ["Guide"],
    "machine.lever_group": ["LeverGroup"],
    "machine.links": ["Link"],
    "machine.loads": [
        "Force",
        "Gravity",
        "PointDamper",
        "PointForce",
        "PointSpring",
        "ProcessForce",
        "Spring",
        "Table",
        "Torque",
        "TorsionDamper",
        "TorsionSpring",
    ],
    "machine.mechanism": ["Mechanism"],
    "machine.rocker_group": ["RockerGroup"],
    "machine.roller_follower": ["RollerFollower"],
    "machine.pin": ["Pin"],
    "machine.slider_group": ["SliderGroup"],
    "machine.swinging_follower": ["SwingingFollower"],
    "machine.yoke_group": ["YokeGroup"],
    "mechanics.principal_points": ["principal_points"],
    "results.comparison": ["compare"],
    "results.extremes": ["extremes"],
    "solution.compile": ["compile"],
    "solution.group_check": ["check"],
    "solution.scene": ["Scene", "solve"],
    "solution.solution": ["Solution"],
    "": ["design", "drive"],
    "design": ["balancing", "linkage"],
    "sweeps": ["designs"],
    "sweeps.sweeps": ["sweep"],
    "sweeps.tolerance": ["tolerances"],
    "studies": ["precision", "stability"],
    "studies.needs": ["needs"],
    "casefile.case": ["load_case"],
    "views": ["plots"],
}
"""Names by where they are: loaded, with the libraries they need, when first used."""


def __getattr__(name):
    place = next((place for place, names in _WHERE.items() if name in names), None)
    if place is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    path = f"{__name__}.{place}".rstrip(".")
    found = (getattr(import_module(path), name, None) if place else None) or import_module(f"{path}.{name}")
    globals()[name] = found
    return found


def __dir__():
    return sorted({*globals(), *__all__})
