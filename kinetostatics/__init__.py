"""Forces, torques and losses of planar mechanisms: what runs through each joint, what the drive must give.

Call first
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))  # m, kg, m, kg m2
    >>> scene = ks.Scene(saw, crank_speed=33.5, loads=[ks.Gravity()])  # rad/s
    >>> s = scene.solve(360)  # at 360 crank angles of a turn
    >>> s.balancing_torque.shape, s.reaction("O").shape  # N m; N, x and y
    ((360,), (2, 360))
    >>> print(f"{ks.extremes(s, 'O').largest:.0f} N")  # the peak, between samples
    286596 N

SI units and radians throughout, and quantities of pint are converted to them; angles count counter-clockwise from +x;
vectors have (x, y) as their first axis.
``help(ks.Solution)`` lists all that `s` gives: symbols, shapes, units, bodies and signs.

Then
    crank_slider, cam_crank_slider, four_bar    a mechanism; Link its masses, Gravity, Spring, ProcessForce its loads
    slotted_lever, scotch_yoke                  more of them; Pin, Dyad, LeverGroup ... for chains of one's own
    Force, Torque, PointForce, PointSpring ...  loads on any link; Table of their values by angle or travel
    PinFriction, GuideFriction ...              what rubs, by joint
    Scene(mechanism, crank_speed, ...)          all that together; .solve(angles), .varied({"slider.mass": 620.0})
    load_case("sawframe_2r63")                  the same from a file; shipped_cases() lists those that are here
    extremes, compare                           true peaks; how many times better than a reference
    s.error_bound("O"), s.uncertainty("O", ...) how sure values are: rounding, proven (tight=True: nearer); tolerances
    drive.steady, drive.flywheel ...            running under a motor; flywheels, starting, coasting
    balancing, Counterweight                    counterweights: full, partial, optimal
    design.optimise, design.torque_free_cam     the best machine within bounds and limits; a cam that needs no torque
    cams, laws, design.contact                  cams, the laws of motion that they make; pressure of the roller
    linkage, principal_points                   classes of four-bars; the common mass centre
    sweep, tolerances, designs                  a row for each of many designs; what spreads of parameters do
    compile(scene, quantities)                  a program to call with other numbers; its exact derivatives
    plots                                       figures
    report("pumpjack", "pumpjack.html")         one page: the mechanism turns by hand, figures, tables, checks
    needs, precision, stability, papers         how much model, how exact, where it hurts; others' formulas
    check(group)                                test a group of one's own

Each name shows an example: ``help(ks.solve)``. From the shell: ``kinetostatics --help``.

Rooms, in the order in which they build on each other
    numbers     elementary functions, planar vectors, leaves of parameter trees, checks, units, files
    machine     what it is: links, guide, cams, crank, groups, loads, the mechanism made of them
    mechanics   what it does: motion, forces, assembly, principal points, quantities with their units
    engines     how fast, how sure: kernels recorded once a structure, run by NumPy, numba or JAX; derivatives, bounds
    results     extremes, means, reductions, comparison, tables
    solution    what users hold: scene, solution, solve, compile, explanations, uncertainty
    drive       motors, periodic running, flywheels, starting and coasting
    design      counterweights, four-bar classes, contact of cams, optimisation under limits, torque-free cams
    sweeps      designs, sweep, workers, datasets, tolerances
    studies     needs, precision, stability, the methods under study
    casefile    case files: schema, reading, building
    views       plots, charts, drawings, reports
    cli         the command line
"""

from importlib import import_module
from typing import TYPE_CHECKING

from .errors import (
    AssemblyError,
    CacheWarning,
    CaseError,
    ConditionWarning,
    DesignError,
    DriveError,
    FileError,
    HintWarning,
    JammingError,
    KinetostaticsError,
    MissingLibraryError,
    NotGivenError,
    ParameterError,
    QuantityError,
)
from .version import __version__ as __version__

if TYPE_CHECKING:
    from . import design, drive
    from .casefile.case import Case, load_case
    from .casefile.reading import shipped_cases
    from .casefile.variant import Variant
    from .design import balancing, linkage
    from .design.counterweights import Counterweight
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
    from .machine.roller import Face, Roller
    from .machine.roller_follower import RollerFollower
    from .machine.slider_group import SliderGroup
    from .machine.swinging_follower import SwingingFollower
    from .machine.yoke_group import YokeGroup
    from .mechanics.principal_points import PrincipalPoints, principal_points
    from .results.comparison import Comparison, compare
    from .results.extremes import Extremes, extremes
    from .results.losses import Losses
    from .solution.certainty import Uncertainty
    from .solution.compile import compile  # noqa: A004 - the contract's name
    from .solution.explanation import Explanation
    from .solution.group_check import check
    from .solution.program import Program
    from .solution.scene import Scene, solve
    from .solution.solution import Solution
    from .studies import precision, stability
    from .studies.methods import papers
    from .studies.needs import Needs, needs
    from .studies.simplifications import two_mass_coupler
    from .sweeps import designs
    from .sweeps.sweeps import sweep
    from .sweeps.tolerance import Tolerances, tolerances
    from .views import plots
    from .views.report.making import report

__all__ = [
    "AssemblyError",
    "CacheWarning",
    "CamRoller",
    "Case",
    "CaseError",
    "Comparison",
    "ConditionWarning",
    "Counterweight",
    "Crank",
    "CylinderGroup",
    "DesignError",
    "DriveError",
    "Dyad",
    "Explanation",
    "Extremes",
    "Face",
    "FileError",
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
    "Losses",
    "Mechanism",
    "MissingLibraryError",
    "Needs",
    "NotGivenError",
    "ParameterError",
    "Pin",
    "PinFriction",
    "PointDamper",
    "PointForce",
    "PointSpring",
    "PrincipalPoints",
    "ProcessForce",
    "Program",
    "QuantityError",
    "RockerGroup",
    "Roller",
    "RollerFollower",
    "RollerFriction",
    "Scene",
    "SliderGroup",
    "SlotFriction",
    "Solution",
    "Spring",
    "SwingingFollower",
    "Table",
    "Tolerances",
    "Torque",
    "TorsionDamper",
    "TorsionSpring",
    "Uncertainty",
    "Variant",
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
    "papers",
    "plots",
    "precision",
    "principal_points",
    "report",
    "scotch_yoke",
    "shipped_cases",
    "slotted_lever",
    "solve",
    "stability",
    "sweep",
    "tolerances",
    "two_mass_coupler",
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
    "machine.roller": ["Face", "Roller"],
    "machine.roller_follower": ["RollerFollower"],
    "machine.pin": ["Pin"],
    "machine.slider_group": ["SliderGroup"],
    "machine.swinging_follower": ["SwingingFollower"],
    "machine.yoke_group": ["YokeGroup"],
    "mechanics.principal_points": ["PrincipalPoints", "principal_points"],
    "results.comparison": ["Comparison", "compare"],
    "results.extremes": ["Extremes", "extremes"],
    "results.losses": ["Losses"],
    "solution.certainty": ["Uncertainty"],
    "solution.compile": ["compile"],
    "solution.explanation": ["Explanation"],
    "solution.group_check": ["check"],
    "solution.program": ["Program"],
    "solution.scene": ["Scene", "solve"],
    "solution.solution": ["Solution"],
    "": ["design", "drive"],
    "design": ["balancing", "linkage"],
    "design.counterweights": ["Counterweight"],
    "sweeps": ["designs"],
    "sweeps.sweeps": ["sweep"],
    "sweeps.tolerance": ["Tolerances", "tolerances"],
    "studies": ["precision", "stability"],
    "studies.methods": ["papers"],
    "studies.needs": ["Needs", "needs"],
    "studies.simplifications": ["two_mass_coupler"],
    "casefile.case": ["Case", "load_case"],
    "casefile.reading": ["shipped_cases"],
    "casefile.variant": ["Variant"],
    "views": ["plots"],
    "views.report.making": ["report"],
}
"""Names by where they are: loaded, with the libraries they need, when first used."""


def __getattr__(name):
    place = next((place for place, names in _WHERE.items() if name in names), None)
    if place is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{_instead(name)}")
    if place.startswith("views"):
        from .numbers.lazy import pyplot

        pyplot()  # an error that says what is wrong with its backend, before views load it
    path = f"{__name__}.{place}".rstrip(".")
    found = (getattr(import_module(path), name, None) if place else None) or import_module(f"{path}.{name}")
    globals()[name] = found
    return found


def _instead(name):
    """What to write for a name that is not there: the nearest one, else the machines that there are."""
    if name.startswith("_"):  # Python itself asks for these
        return ""
    from .numbers.checks import hint

    machines = ", ".join(_WHERE["machine.builders"])
    groups = ", ".join(each for each in __all__ if each.endswith("Group") or each in ("CamRoller", "Dyad", "Pin"))
    there = f"; machines are {machines}, and a Mechanism of {groups}; dir({__name__}) lists all names"
    return hint(name, __all__) or there


def __dir__():
    return [*__all__, "__version__"]
