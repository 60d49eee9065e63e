"""Forces, torques and losses of planar mechanisms: the force in every joint, the torque that the drive must supply.

Call first
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))  # m, kg, m, kg m2
    >>> scene = ks.Scene(saw, crank_speed=33.5, loads=[ks.Gravity()])  # rad/s
    >>> s = scene.solve(360)  # at 360 crank angles of a turn
    >>> s.balancing_torque.shape, s.reaction("O").shape  # N m; N, x and y
    ((360,), (2, 360))
    >>> print(f"{ks.extremes(s, 'O').largest:.0f} N")  # the peak, between samples
    286596 N

Numbers are in SI units and radians; any number may be a pint quantity. Angles count counter-clockwise from +x; the
first axis of a vector is (x, y). ``help(ks.Solution)`` lists all quantities of `s`: symbols, shapes, units, bodies,
signs.

Then
    crank_slider, cam_crank_slider, four_bar    a mechanism; Link its masses, Gravity, Spring, ProcessForce its loads
    slotted_lever, scotch_yoke                  more of them; Pin, Dyad, LeverGroup ... for your own chains
    Force, Torque, PointForce, PointSpring ...  loads on any link; Table of their values by angle or travel
    PinFriction, GuideFriction ...              friction, joint by joint
    Scene(mechanism, crank_speed, ...)          the machine to solve; .solve(angles), .varied({"slider.mass": 620.0})
    load_case("sawframe_2r63")                  scenes from a file; shipped_cases() lists the files of the package
    extremes, compare                           exact peak values; ratios of torque and force between two designs
    s.error_bound("O"), s.uncertainty("O", ...) accuracy: proven rounding bound (tight=True: closer); tolerances
    drive.steady, drive.flywheel ...            running under a motor; flywheels, starting, coasting
    balancing, Counterweight                    counterweights: full, partial, optimal
    design.optimise, design.torque_free_cam     the best machine within bounds and limits; a cam that needs no torque
    sizing.bearing, sizing.spring_for ...       from forces to parts: bearings, springs, links, play, foundations
    cams, laws, design.contact                  cams, laws of motion, contact pressure of the roller
    linkage, principal_points                   classes of four-bars; the common mass centre
    sweep, tolerances, designs                  one row per design; effect of tolerances
    compile(scene, quantities)                  a program to call with other numbers; its exact derivatives
    plots                                       figures
    report("pumpjack", "pumpjack.html")         one page: the moving mechanism, figures, tables, checks
    needs, precision, stability, papers         necessary loads, precision, critical positions; published formulas
    check(group)                                test of your own group

Each name shows an example: ``help(ks.solve)``. From the shell: ``kinetostatics --help``.

docs/contributors.md lists the folders of this package and their contents.
"""

from .version import __version__ as __version__


def __getattr__(name):
    """A public name, loaded with the libraries that it needs on first use; `__init__.pyi` lists them."""
    from .numbers.lazy import public_name, pyplot

    if name in ("plots", "report"):
        pyplot()  # its error explains a faulty backend
    return public_name(__name__, name, _instead)


def _instead(name):
    """End of the error for a name that is near no public name."""
    machines = "cam_crank_slider, crank_slider, four_bar, scotch_yoke, slotted_lever"
    groups = ", ".join(
        each
        for each in __getattr__("__all__")
        if each.endswith("Group") or each in ("CamRoller", "Dyad", "Pin", "PlanetaryCrank")
    )
    return f"; machines are {machines}, and a Mechanism of {groups}; dir({__name__}) lists all names"


def __dir__():
    return [*__getattr__("__all__"), "__version__"]
