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
    numbers     arithmetic, planar vectors, parameter trees, checks, units, files
    machine     what it is: links, guide, cams, crank, groups, loads, the mechanism made of them
    mechanics   what it does: motion, forces, assembly, principal points, quantities with their units
    engines     how fast, how sure: kernels recorded once a structure, run by NumPy, numba or JAX; derivatives, bounds
    results     extremes, means, reductions, comparison, tables
    explain     hand calculations: recorded steps with names, symbols, units
    solution    what users hold: scene, solution, solve, compile, explanations, uncertainty
    drive       motors, periodic running, flywheels, starting and coasting
    design      counterweights, four-bar classes, contact of cams, optimisation under limits, torque-free cams
    sweeps      designs, sweep, workers, datasets, tolerances
    studies     needs, precision, stability, the methods under study
    casefile    case files: schema, reading, building
    views       plots, charts, drawings, reports
    cli         the command line
"""

from .version import __version__ as __version__


def __getattr__(name):
    """A public name, loaded with the libraries that it needs when first used; `__init__.pyi` lists them."""
    from .numbers.lazy import public_name, pyplot

    if name in ("plots", "report"):
        pyplot()  # its error says what is wrong with the backend
    return public_name(__name__, name, _instead)


def _instead(name):
    """Which names there are in place of one that is not near any."""
    machines = "cam_crank_slider, crank_slider, four_bar, scotch_yoke, slotted_lever"
    groups = ", ".join(
        each for each in __getattr__("__all__") if each.endswith("Group") or each in ("CamRoller", "Dyad", "Pin")
    )
    return f"; machines are {machines}, and a Mechanism of {groups}; dir({__name__}) lists all names"


def __dir__():
    return [*__getattr__("__all__"), "__version__"]
