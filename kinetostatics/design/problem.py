"""A design problem: curves of a scene over the period, with exact derivatives by the varied numbers, and their outputs.

The chain rule combines derivatives of the recorded program by the scene's numbers and derivatives of these numbers by
varied numbers (`DerivedNumbers`). Ratios divide the reference's output by the design's.
"""

from contextlib import contextmanager
from dataclasses import replace
from functools import cache, lru_cache
from typing import Any

import numpy as np

from ..cycle.kinks import has_kinks
from ..cycle.reductions import SolutionNumber
from ..engines.graph import Graph, Node
from ..engines.program import Program
from ..engines.record import Recording
from ..errors import DesignError, KinetostaticsError, NotGivenError, ParameterError
from ..machine.loads import TURN
from ..mechanics.quantities import of_scene
from ..mechanics.quantities import values as values_of
from ..numbers import checks, paths
from ..numbers.lazy import cached_property
from ..numbers.units import to_si
from ..solution.piecewise_turns import START_ANGLES, PiecewiseTurns, unchecked_turn
from ..solution.program import compile as compiled
from . import measures
from .constraints import table_limits


class DerivedNumbers:
    """Numbers of a scene as functions of varied ones, with exact derivatives.

    A case file derives numbers from others, for example a mass centre at mid-length. The variant is built once with
    recording numbers, which gives the numbers at `paths` of the scene and their derivatives by those at `names`.
    """

    def __init__(self, source, names):
        scene = scene_of(source)
        self.names, graph = tuple(names), Graph()
        nodes = [graph.parameter(place) for place in range(len(self.names))]
        try:
            made = scene_of(source.varied(dict(zip(self.names, nodes, strict=True))))
        except KinetostaticsError:
            raise
        except (TypeError, AttributeError, ValueError) as error:
            raise NotGivenError(
                f"numbers that follow from {', '.join(self.names)} have no derivatives ({error}); vary numbers of the "
                "variant's scene instead, where all others are constant"
            ) from error
        places = paths.places_by_path(scene)
        found = {path: place.value(made) for path, place in places.items()}
        found = {path: value for path, value in found.items() if isinstance(value, Node)}
        self.paths = tuple(found)
        shape = (1,) * len(found)
        recording = Recording(self.paths, tuple(found.values()), shape, (False,) * len(found), tuple(nodes), (), graph)
        self._slopes = Program(recording).by_parameters(tuple(range(len(nodes))))

    def __call__(self, values):
        """Numbers by path, and their derivatives (paths, names, ...), from an array of values (names, ...)."""
        count, shape = len(self.paths), values.shape[1:]
        rows = self._slopes.by_numpy(np.zeros(1), list(values), (), shape or (1,))
        rows = rows if shape else rows[:, 0]
        slopes = rows[count:].reshape(count, len(self.names), *shape)
        numbers = {path: row if shape else float(row) for path, row in zip(self.paths, rows[:count], strict=True)}
        return numbers, slopes


def scene_of(item):
    """The scene of a variant, or the scene itself."""
    return getattr(item, "scene", item)


DIFFERENCE_STEP = 1e-4
"""Step of a central difference over the range of the number that varies."""
BAR_DELAY = 1.0
"""Duration of work, s, after which a bar appears."""


@contextmanager
def progress_bar(problem, begins, progress):
    """Context in which steps of the searches move a bar; it yields where they begin, which numbers them on the bar.

    `progress` is True for the bar, or a function that is called with the numbers of each step instead.
    """
    from tqdm import tqdm

    words = "search {} of " + str(len(begins))
    hidden = not progress or callable(progress)
    with tqdm(desc=words.format(1), unit=" steps", delay=BAR_DELAY, leave=False, disable=hidden) as bar:

        def numbered():
            for number, begin in enumerate(begins, 1):
                bar.set_description_str(words.format(number), refresh=False)
                yield begin

        problem.stepped = progress if callable(progress) else lambda _: bar.update()
        yield numbered()
    problem.stepped = None


SHARED_NUMBERS = ("crank_speed", "crank_acceleration")
"""Numbers shared by reference and design."""
MAX_CACHED_DESIGNS = 8
"""Number of designs with cached curves."""


def cached_by_design(function, count=MAX_CACHED_DESIGNS):
    """The function, whose last argument is the design's values, with its last results kept."""
    cached = lru_cache(count)(lambda design, *others: function(*others, np.frombuffer(design)))
    return lambda *given: cached(given[-1].tobytes(), *given[:-1])


class Problem:
    """Outputs of a scene as functions of the numbers that vary.

    Parameters
    ----------
    source : Scene, or object with `.scene` and `.varied(values)`, such as a case's variant
    vary : mapping of path to (low, high)
        SI numbers, or texts with units.
    quantities : sequence of str
    reference : Scene or similar, optional
        Reference of ratios; it runs at the design's speed, with its other numbers constant.
    angles : int
        Crank angles evenly over the period.
    engine : "numpy" or "compiled"

    Attributes
    ----------
    table_limits : tuple of Constraint
        Limits that keep sliders of varied motion within load tables over travel.
    curves : function
        Curve by quantity of a design; NaN where it cannot be built.
    """

    def __init__(self, source, vary, quantities, reference=None, angles=720, engine="numpy"):
        self.source, self.reference, self.angles, self.engine = source, reference, angles, engine
        self.low, self.high = parse_bounds(source, vary)
        self.names = tuple(vary)
        scene = scene_of(source)
        self.angle = np.linspace(0.0, scene.period, angles, endpoint=False)
        self.turns = turns_of(scene)
        self.derived = DerivedNumbers(source, self.names)
        limits = table_limits(scene)
        positions = tuple(dict.fromkeys(limit.output.quantity for limit in limits))
        self._motion: Any = compiled(scene, positions, self._zeros(scene), "numpy") if positions else None
        is_moved = self._motion is not None and any(map(self._motion.depends_on, self.derived.paths))
        self.table_limits = limits if is_moved else ()
        self.quantities = tuple(dict.fromkeys([*quantities, *(positions if is_moved else ())]))
        self.program = compiled(scene, self.quantities, self._zeros(scene), engine)
        if self.program.unrecorded:
            raise NotGivenError(
                f"design: a search needs derivatives, but {', '.join(self.program.unrecorded)} does more than "
                "arithmetic with sin, cos and sqrt of `arithmetic`; write it with these, or give a ks.Table"
            )
        self.evaluations = 0
        self.stepped: Any = None
        self.curves = cached_by_design(self._computed)
        self._curve_on_pieces = cached_by_design(self._on_pieces, MAX_CACHED_DESIGNS * len(self.quantities))
        self._number = cached_by_design(self._number_and_slopes)
        self.units, self.parts, self.shares = source.units, {"": self}, {"": 1.0}
        self._of_reference = cache(lambda output: true_value(output, scene_of(reference)))
        self._shared = [place for place, name in enumerate(self.names) if name in SHARED_NUMBERS]
        self._compared: Problem | None = None
        if reference is not None and self._shared:
            limits = {self.names[place]: (self.low[place], self.high[place]) for place in self._shared}
            known = of_scene(scene_of(reference))
            ratios = tuple(name for name in self.quantities if name in known)
            self._compared = Problem(reference, limits, ratios, None, angles, engine)

    @property
    def start(self):
        """Values of the source, within the bounds."""
        own, scene = self.source.parameters, scene_of(self.source).parameters
        values = [value if isinstance(value := own[name], float) else scene[name] for name in self.names]
        return np.clip(np.array(values, dtype=float), self.low, self.high)

    def duty(self, name):
        """Problem of a duty: this one, as there are no others."""
        return self

    def numbers(self, values):
        """Numbers of a design by their paths."""
        return dict(zip(self.names, map(float, values), strict=True))

    def scene(self, values):
        """Scene of a design."""
        return scene_of(self.source.varied(self.numbers(values)))

    @cached_property
    def _kinked(self):
        """Quantities with kinks."""
        solution = unchecked_turn(scene_of(self.source), 1)
        return {name for name in self.quantities if has_kinks(solution, name)}

    def curve(self, output, values):
        """Curve of an output's quantity; on pieces between kinks if it has some."""
        if output.quantity not in self._kinked:
            return self.curves(values)[output.quantity]
        return self._curve_on_pieces(without_ratio(output), values)

    def _on_pieces(self, output, values):
        self.evaluations += 1
        try:
            numbers, changes = self.derived(values)
            turns = PiecewiseTurns.of(self.scene(values), (output,), min(self.angles, START_ANGLES * self.turns))
            ((_, pieces, _),) = turns.refined((output,))
            angle = pieces.angle.ravel()
            slopes = self.program.derivatives(angle, self.derived.paths, numbers)[output.quantity]
            found = self._curve(self.program(angle, numbers)[output.quantity], slopes, changes, angle)
        except KinetostaticsError:
            return self.curves(values)[output.quantity]
        shape = pieces.angle.shape
        vector = of_scene(scene_of(self.source))[output.quantity].vector
        return measures.PiecewiseCurve(found.values.reshape(shape), found.slopes.reshape(-1, *shape), pieces, vector)

    def output(self, output, values):
        """Value of an output of a design, or of a function of designs, and its derivatives."""
        if callable(output):
            return output(values)
        if isinstance(output, SolutionNumber):
            return self._number(output, values)
        found, slopes = measures.reduced(output.reduction, self.curve(output, values))
        if not output.ratio:
            return found, slopes
        plain, rises = without_ratio(output), np.zeros(len(self.names))
        if self._compared is None:
            above = self._of_reference(plain)
        else:
            above, rises[self._shared] = self._compared.output(plain, values[self._shared])
        return above / found, (rises - above / found * slopes) / found

    def _number_and_slopes(self, output, values):
        """Number of the solution of a design, and its derivatives by central differences; NaN if there is none."""
        step = np.diag(DIFFERENCE_STEP * (self.high - self.low))
        sides = [np.clip(values + side, self.low, self.high) for side in (step, -step)]
        above, below = (np.array([self._value(output, design) for design in side]) for side in sides)
        return self._value(output, values), (above - below) / np.diagonal(sides[0] - sides[1])

    def _value(self, output, values):
        self.evaluations += 1
        try:
            return compared_value(output, self.scene(values), self.reference and scene_of(self.reference))
        except KinetostaticsError:
            return np.nan

    def _computed(self, values):
        """Curve by quantity of a design; NaN where it cannot be built."""
        self.evaluations += 1
        nothing = np.full(self.angle.size, np.nan)
        empty = measures.Curve(nothing, np.full((len(self.names), self.angle.size), np.nan), self.turns)
        found = dict.fromkeys(self.quantities, empty)
        for program in (self.program, self._motion) if self.table_limits else (self.program,):
            try:  # the motion has values even if a slider leaves its table
                numbers, changes = self.derived(values)
                curves = program(self.angle, numbers)
                slopes = program.derivatives(self.angle, self.derived.paths, numbers)
                return found | {
                    name: self._curve(curves[name], slopes[name], changes, self.angle) for name in program.quantities
                }
            except KinetostaticsError:
                continue
        return found

    def _curve(self, values, slopes, changes, angle):
        """Curve of a quantity, from derivatives by the scene's numbers and of these by the varied ones."""
        shape = values.shape[:-1] + angle.shape
        by_scene = np.array([np.broadcast_to(part, shape) for part in slopes.values()])
        slopes, values = np.tensordot(changes.T, by_scene, 1), np.broadcast_to(values, shape)
        if values.ndim == 2:
            values, slopes = measures.size(values, slopes)
        return measures.Curve(values, slopes, self.turns)

    def _zeros(self, scene):
        own = scene.parameters
        return tuple(path for path in self.derived.paths if isinstance(own[path], float) and own[path] == 0.0)


def without_ratio(output):
    """The output itself, for a ratio to the reference."""
    return replace(output, ratio=False)


def choose_design(source, variant, reference):
    """The variant or scene to vary, and the reference of ratios."""
    if hasattr(source, "variants"):
        name, compared = source.names_of(variant, reference)
        return source.variant(name), source.variant(compared)
    checks.require(
        "design",
        design_problem("source", source, "a Case, as of ks.load_case, or a Scene"),
        None if variant is None else "variant is for cases; a Scene has none",
        None if reference is None else design_problem("reference", reference, "a Scene, like the source"),
    )
    return source, reference


def design_problem(name, item, kinds):
    """Sentence about an object that is not one design, or None."""
    if not hasattr(item, "varied") or not hasattr(item, "units"):
        return f"{name} must be {kinds}, got {checks.shown(item)}"
    several = [path for path, value in scene_of(item).parameters.items() if np.size(value) > 1]
    return f"{name} must be one design, but has several values of {', '.join(several)}" if several else None


def compared_value(output, scene, reference):
    """Value of an output of a scene; a ratio refers to the reference."""
    if isinstance(output, SolutionNumber):
        return output.value(scene, reference)
    found = true_value(output, scene)
    return true_value(output, reference) / found if output.ratio else found


def true_value(output, scene, angles=5760):
    """Value of an output of a scene, exact to rounding if it is smooth; `DesignError` if no pieces resolve it."""
    plain, turns = without_ratio(output), turns_of(scene)
    if has_kinks(unchecked_turn(scene, 1), output.quantity):
        ((found,),), ((rough,),) = PiecewiseTurns.of(scene, (plain,), START_ANGLES * turns).estimated((plain,))
        if rough:
            raise DesignError(
                f"{plain} of {scene.mechanism.name} is not resolved even by the finest pieces of the turn. If a load "
                "jumps, let it rise over a degree, or declare the place by kinks(motion)"
            )
        return float(found)
    values = values_of(scene.solve(angles), output.quantity)
    found, _ = plain.estimated(np.broadcast_to(values, (angles,))[None], turns)
    return float(found[0])


def turns_of(scene):
    """Turns of the crank after which a scene repeats."""
    return round(scene.period / TURN)


def parse_bounds(source, vary):
    """Lowest and highest value of each number that varies; one `ParameterError` for all that cannot."""
    if not hasattr(vary, "items") or not vary:
        raise ParameterError(
            'design: vary must be a dict of path to (low, high), such as {"spring.stiffness": ("600 kN/m", "900 kN/m")}'
            f", got {checks.shown(vary)}"
        )
    known, found, problems = source.units, [], []
    own, scene = source.parameters, scene_of(source).parameters
    for path, given in vary.items():
        problem = checks.choice("parameter", path, tuple(known))
        if problem is None and own[path] is None and path not in scene:
            problem = f"{path} is neither in the source nor in its scene; give it a start value"
        elif problem is None:
            try:
                low, high = given
                pair = [
                    to_si(end, known[path]) if isinstance(end, str) else float(checks.to_plain(end, known[path]))
                    for end in (low, high)
                ]
                problem = None if np.all(np.isfinite(pair)) and pair[0] < pair[1] else "they must be finite and rise"
                found.append(pair)
            except (TypeError, ValueError, checks.DimensionError) as error:
                problem = str(error)
            problem = problem and f"bounds of {path} must be (low, high), got {checks.shown(given)}: {problem}"
        problems.append(problem)
    checks.require("design", *problems)
    low, high = np.array(found).T
    return low, high
