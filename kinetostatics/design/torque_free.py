"""Torque-free cams: the cam-balanced crank-slider with constant energy over the turn.

At constant crank speed no torque is needed if the sum of kinetic energy and potential energy (weight, springs) is
constant. The search varies harmonics of the cam, the coupler's length, and rate and free position of the spring, with
fixed ends of the stroke. First it minimises the sum of squares of the torque (Levenberg-Marquardt, from the cosine
law's cam), then the goal under limits.

If weight acts along the guide, as in an upright machine, a symmetric cam can be torque-free. If weight acts across the
guide, the coupler's weight on A has a torque that is even in the crank angle from the guide. All other torque of a
symmetric machine is odd, so a symmetric cam cannot balance the even one. Sine terms, a torsion spring on the coupler,
or a counterweight on the crank with an offset guide can; `weight_options` compares them.
"""

import warnings
from dataclasses import replace
from typing import Any

import numpy as np

from ..cycle.extremes import extrema
from ..cycle.reductions import Output
from ..errors import DesignError, HintWarning
from ..machine.loads import Gravity
from ..mechanics.quantities import of_scene
from ..numbers import checks
from ..numbers.planar import cross
from .cam_start import OPTION_RULES, Options, crank_slider_links, starting_machine
from .constraints import parse_output
from .optimisation import best_design, parse_task, search_problems
from .problem import Problem, choose_design, scene_of, true_value
from .result import Found

TORQUE, POSITION = "balancing_torque", "slider_position"
LEAST_SQUARES_PASSES = ((2.0, 1.0), (2e3, 0.0))
"""By pass: weights of the error of the stroke's ends and of the cam's waviness, both relative to half the stroke. The
first pass keeps the cam smooth, the second keeps the ends."""
MAX_LEAST_SQUARES_STEPS = 100


def least_squares(problem, start, values):
    """Values of the design with the least squares of torque and of errors of the stroke's ends.

    Only numbers of the cam, the coupler and the linear spring change, with a counterweight also the guide offset.
    """
    for weight, smooth in LEAST_SQUARES_PASSES:
        values = _least_squares_pass(problem, start, values, weight, smooth)
    return np.clip(values, problem.low, problem.high)


def _least_squares_pass(problem, start, values, weight, smooth):
    """Values of the design after a pass with these weights; see `LEAST_SQUARES_PASSES`."""
    from scipy import optimize

    columns = [place for place, name in enumerate(problem.names) if name in start.first]
    waves = smooth * np.array([waviness(problem.names[place]) for place in columns]) / start.half
    reach, unit = (problem.high - problem.low)[columns], start.unit * np.sqrt(problem.angles)

    def placed(steps):
        found = values.copy()
        found[columns] += reach * steps
        return found

    def residuals(steps):
        curves = problem.curves(placed(steps))
        (torque, *_), (place, *_) = curves[TORQUE], curves[POSITION]
        missed = (np.array([place.min(), place.max()]) - start.ends) / start.half
        found = [torque / unit, weight * missed, waves * placed(steps)[columns]]
        return np.nan_to_num(np.concatenate(found), nan=1e3)

    def slopes(steps):
        curves = problem.curves(placed(steps))
        place, rises, _ = curves[POSITION]
        extreme = rises[:, [place.argmin(), place.argmax()]]
        rows = np.hstack([curves[TORQUE].slopes / unit, weight * extreme / start.half])
        return np.nan_to_num(np.vstack([rows[columns].T, np.diag(waves)]) * reach)

    ends: Any = {"xtol": 1e-12, "ftol": 1e-12, "max_nfev": MAX_LEAST_SQUARES_STEPS}
    found = optimize.least_squares(residuals, np.zeros(len(columns)), slopes, method="lm", x_scale=1.0, **ends)
    return placed(found.x)


def waviness(name):
    """Square of the order of a cam harmonic from the second on; 0 for other numbers."""
    kind, _, order = name.rpartition(".")
    return float(order) ** 2 if kind in ("cam.cosine", "cam.sine") and int(order) > 1 else 0.0


MIN_ANGLES, ANGLES_PER_HARMONIC = 360, 32
"""Fewest crank angles, and crank angles per harmonic of the cam."""
BOUND_MARGIN = 1.05
"""Ratio of a limit to `ratio_bound` above which the search is refused; above 1, for the bound varies with the cam."""
REPORTED_OUTPUTS = (
    "ratio mean_absolute balancing_torque",
    "mean_absolute balancing_torque",
    "largest_absolute balancing_torque",
    "largest O",
    "largest_absolute cam_force",
    "largest_absolute guide_force",
    "largest_absolute guide_moment",
    "largest_absolute pressure_angle",
    "largest slider_position",
    "smallest slider_position",
    "smallest cam_radius",
)
"""Outputs that a report shows."""


def torque_free_cam(
    source,
    cosine=8,
    sine=0,
    *,
    minimise=None,
    maximise=None,
    limits=(),
    ends=None,
    gravity=True,
    guide_offset=None,
    coupler_spring=None,
    counterweight=None,
    cubic=None,
    vary=None,
    shaft_radius=None,
    robust=None,
    variant=None,
    reference=None,
    starts=1,
    seed=0,
    engine="numpy",
    progress=False,
) -> Found:
    """Cam-balanced crank-slider with the least torque, or the best in another output.

    Parameters
    ----------
    source : Case, Scene or variant
        A crank-slider, plain or with a cam, or a case (by default its first variant besides the reference). Unless
        varied, masses, speed and loads except springs stay; friction and crank acceleration are left out with a hint.
    cosine, sine : int
        Harmonics of the cam.
    minimise, maximise : str, optional
        Output to minimise or maximise, as for `optimise`; default: minimise the mean magnitude of the torque.
        "rms balancing_torque" gives the least squares.
    limits : sequence of str
        As for `optimise`; "smallest cam_radius >= 40 mm" keeps the roller centre off the shaft.
    ends : (low, high), optional
        Extreme positions of the slider, m; by default those of the source.
    gravity : bool
        Whether weight acts.
    guide_offset : float, optional
        m; by default that of the source.
    coupler_spring : float, optional
        Free angle, rad, of a torsion spring between coupler and slider that carries the coupler's weight; the search
        finds its rate. The slider and the guide take its couple.
    counterweight : float, optional
        Mass on the crank, kg; the search finds its place and a guide offset.
    cubic : (low, high), optional
        Bounds of the spring's cubic term, N/m3; without it the spring is linear.
    vary : dict of path to (low, high), optional
        Bounds of further parameters, or other bounds of those that vary anyway.
    shaft_radius : float, optional
        Radius of the shaft at O for the report, m; by default that of the source's friction at O.
    robust, variant, reference, starts, seed, engine, progress
        As for `optimise`. Further starts are circles about O with random harmonics of up to a tenth of their radius.

    Returns
    -------
    Found
        Its report warns if the cam cuts into the shaft. Its `bound` is the largest ratio of the reference's mean
        torque to that of a symmetric cam under weight.

    Raises
    ------
    DesignError
        The coupler cannot make the stroke, no cam keeps the limits, or the machine has no masses.
    ParameterError
        The source is not a crank-slider, or a value is impossible.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found = ks.design.torque_free_cam(ks.load_case("sawframe_2r63"), cosine=4, gravity=False)
    >>> print(f"{found.report().loc['ratio mean_absolute balancing_torque [1]', 'after']:.3g}")
    5.25e+04
    """
    source, reference = choose_design(source, variant, reference)
    wrong = None if vary is None or hasattr(vary, "items") else f"vary must be a dict, got {checks.shown(vary)}"
    asked = {"cosine": cosine, "sine": sine, "ends": ends, "gravity": gravity, "guide_offset": guide_offset}
    asked |= {"coupler_spring": coupler_spring, "counterweight": counterweight, "cubic": cubic}
    options = Options.checked(*search_problems(starts, seed), wrong, **asked, shaft_radius=shaft_radius)
    given = _without_friction(scene_of(source), gravity)
    compared = None if reference is None else _without_friction(scene_of(reference), gravity)
    start = starting_machine(given, options)
    minimise = f"mean_absolute {TORQUE}" if minimise is maximise is None else minimise
    angles = max(MIN_ANGLES, ANGLES_PER_HARMONIC * max(cosine, sine))
    low, high = start.ends
    kept = f"smallest {POSITION} = {low!r} m", f"largest {POSITION} = {high!r} m"
    task = parse_task(start.scene, minimise, maximise, limits, compared, angles, kept)
    parts = ", ".join(str(item) for item in task.outputs if not isinstance(item, Output))
    checks.require("torque-free cam", f"{parts}: numbers of parts are for ks.design.optimise" if parts else None)
    quantities = (TORQUE, POSITION, *(item.quantity for item in task.outputs if isinstance(item, Output)))
    problem = Problem(start.machine, start.vary | dict(vary or {}), quantities, compared, angles, engine)
    _require_possible(problem, start)
    generator = np.random.default_rng(seed)
    begins = [problem.start, *(start.random(problem.names, problem.start, generator) for _ in range(starts - 1))]
    begins = [least_squares(problem, start, values) for values in begins]
    _require_within_bound(start, problem, task.limits, compared, begins[0])
    usual = [text for text in REPORTED_OUTPUTS if text.split()[-1] in of_scene(start.scene)]
    usual = usual if compared is not None else usual[1:]
    reported = (*task.outputs, *(parse_output(text, start.scene) for text in usual))
    try:
        found = best_design(problem, task, begins, reported, robust, progress)
    except DesignError as error:  # name other ways to balance weight if torque is limited
        nearest = begins[0] if error.values is None else np.array(list(error.values.values()))
        torque = any(isinstance(limit.output, Output) and limit.output.quantity == TORQUE for limit in task.limits)
        advice = _advice(start, problem, compared, nearest) if torque else ""
        raise DesignError(f"{error}{advice}", error.values) from None
    friction = scene_of(source).friction.get("O")
    shaft = getattr(friction, "radius", None) if shaft_radius is None else options.shaft_radius
    return replace(found, before=given, bound=ratio_bound(start, found.scene, compared), shaft_radius=shaft)


def ratio_bound(start, scene, reference):
    """Largest ratio of mean torques of a symmetric cam, which cannot balance the torque of the coupler's weight on A.

    In a turn A rises and falls by twice its largest height h, so the mean magnitude of this torque is 4 W h / (2 pi).
    """
    if reference is None or not start.weight:
        return np.inf
    guide = scene.mechanism.guides[scene.mechanism.slider]
    height = abs(extrema(scene.solve(1), lambda at: cross(guide.direction, at.position("A"))).largest)
    plain = true_value(parse_output(f"mean_absolute {TORQUE}", reference), reference)
    return float(plain * 2 * np.pi / (4 * abs(start.weight) * height))


def _without_friction(scene, gravity):
    """The scene at constant speed without friction, with weight only if `gravity`; a hint names the omissions."""
    left = [f"friction at {', '.join(scene.friction.acting)}"] if scene.friction.acting else []
    if np.any(scene.crank_acceleration):
        left.append("the crank acceleration")
    if left:
        text = (
            f"leaves out {' and '.join(left)} of {scene.mechanism.name}: it searches, and compares, at constant speed "
            "without friction; add them to the resulting scene"
        )
        warnings.warn(HintWarning("torque_free_cam", text), stacklevel=3)
    loads = tuple(item for item in scene.loads if gravity or not isinstance(item, Gravity))
    return replace(scene, loads=loads, friction=None, crank_acceleration=0.0)


def _require_possible(problem, start):
    """Refuse a stroke that no coupler length within the bounds can make."""
    place = problem.names.index("coupler_length")
    shortest, longest = problem.low[place], problem.high[place]
    low, high = start.ends
    if not (shortest < high and longest > low):
        raise DesignError(
            f"torque-free cam: a coupler of {shortest:.6g} to {longest:.6g} m cannot make the stroke from {low:.6g} m "
            f"to {high:.6g} m. Its length must lie between these ends, or A would pass O"
        )


def _require_within_bound(start, problem, limits, reference, values):
    """Refuse a ratio of mean torques beyond the bound of a symmetric cam under weight."""
    advice = _advice(start, problem, reference, values)
    if not advice:
        return
    greatest = ratio_bound(start, problem.scene(values), reference)
    for limit in limits:
        of_mean = str(limit.output) == f"ratio mean_absolute {TORQUE}"
        if of_mean and limit.relation != "<=" and limit.value > BOUND_MARGIN * greatest:
            raise DesignError(f"torque-free cam: {limit} cannot be kept{advice}", problem.numbers(values))


def _advice(start, problem, reference, values):
    """End of a message that names other ways to balance weight; empty if one is used or no bound exists."""
    limit = ratio_bound(start, problem.scene(values), reference)
    helped = any(name.startswith(("cam.sine", "torsion_spring", "crank.")) for name in problem.names)
    if helped or not np.isfinite(limit):
        return ""
    return (
        f"; under weight a symmetric cam reaches a ratio of mean torques of about {limit:.3g} at most, within some per "
        "cent. Give sine terms, coupler_spring or counterweight"
    )


LEAST_SQUARES_GOAL = f"rms {TORQUE}"
QUARTER_TURN = np.pi / 2


def weight_options(source, cosine=8, *, variant=None, reference=None, counterweight=None, **options):
    """Table of torque-free cams under weight, a row for each way to balance the weight.

    Parameters
    ----------
    source, variant, reference, options
        As for `torque_free_cam`.
    cosine : int
        Number of cosine harmonics, and of sine terms if there are any.
    counterweight : float, optional
        Mass on the crank, kg; by default that of the coupler.

    Returns
    -------
    pandas.DataFrame
        Rows "symmetric", "sine terms", "coupler spring" and "counterweight" (with sine terms), with the outputs of
        their reports. The slider and the guide take the couple of the coupler spring, O the centrifugal force of the
        counterweight. "bound" is that of the symmetric cam.

    Raises
    ------
    ParameterError
        The source is neither a case nor a scene, or not a crank-slider.
    DesignError
        The machine has no masses.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> table = ks.design.weight_options(ks.load_case("sawframe_2r63"), cosine=2)
    >>> print(table["ratio mean_absolute balancing_torque [1]"].round().to_string())
    symmetric         160.0
    sine terms        235.0
    coupler spring    463.0
    counterweight     462.0
    """
    import pandas as pd

    wrong = [
        f"{name} is one of the ways compared, so it cannot be given"
        for name in ("sine", "coupler_spring")
        if name in options
    ]
    asked = {} if counterweight is None else {"counterweight": (counterweight, *OPTION_RULES["counterweight"])}
    mass = checks.single_numbers("weight_options", *wrong, **asked).get("counterweight")
    given, compared = choose_design(source, variant, reference)
    scene = scene_of(given)
    group, _ = crank_slider_links(scene)
    across = sum(float(cross(group.guide.direction, load.vector)) for load in scene.loads if isinstance(load, Gravity))
    ways = {
        "symmetric": {},
        "sine terms": {"sine": cosine},
        "coupler spring": {"coupler_spring": float(np.copysign(QUARTER_TURN, across))},
        "counterweight": {"counterweight": group.coupler.mass if mass is None else mass, "sine": cosine},
    }
    rows = {}
    for name, way in ways.items():
        found = torque_free_cam(given, cosine, reference=compared, **({"minimise": LEAST_SQUARES_GOAL} | options | way))
        rows[name] = found.report()["after"].to_dict() | {"bound": found.bound if name == "symmetric" else np.inf}
    return pd.DataFrame.from_dict(rows, orient="index")
