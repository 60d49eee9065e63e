"""Kinetostatics: joint reactions, guide, cam and slot forces, balancing torque, and its check by powers."""

import math
import warnings
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np

from . import assembly, checks, hints
from .batch import wider
from .elementary import is_foreign_array, read_only
from .errors import HintWarning, NotGivenError, ParameterError, QuantityError
from .links import load, virtual_work
from .loads import MOST_TURNS, Gravity, ProcessForce, Spring
from .mechanism import Mechanism
from .motion import Motion
from .planar import added, minus, moment, number, plus, product
from .principal_points import principal_points

ANGLE = checks.Number("rad", "crank_angle", table=True)
DRIVE = {"crank_speed": checks.Number("rad/s", table=True), "crank_acceleration": checks.Number("rad/s**2", table=True)}
LOADS = (Gravity, Spring, ProcessForce)
PRECISIONS = (np.dtype(np.float64), np.dtype(np.float32))
UNBALANCED = 1e-6
"""Part of the largest torque that the two ways to it may differ by in a mechanism with groups of the user's own."""
TRIED = 64
"""Crank angles at which such a mechanism is tried before compiled loops take over."""
TURN = 2 * math.pi
WORTH_COMPILING = 1_000_000
"""Crank angles, all designs together, from which a compiled loop is worth its preparation."""


@dataclass(frozen=True, eq=False)
class Solution(Motion):
    """Motion and forces of a mechanism; every result is computed when first asked for, and kept.

    The balancing torque is the torque on the crank that keeps the prescribed motion, counter-clockwise positive.
    """

    loads: tuple = ()

    def check(self):
        """Raise `AssemblyError` where the mechanism does not close; warn where half of the digits are lost."""
        if not self._surely_closes():
            assembly.check(self)

    def _surely_closes(self):
        """Whether that is known without a look at the placement."""
        return False

    def __repr__(self):
        drive = f"crank_speed={self.crank_speed}, crank_acceleration={self.crank_acceleration}"
        loads = ", ".join(type(item).__name__ for item in self.loads) or "no loads"
        return f"<Solution: {self.mechanism.name}, shape {self.shape}, {drive}, {loads}>"

    def at(self, crank_angle):
        """The same mechanism, speed and loads at other crank angles."""
        varying = [
            name
            for name, value in [
                ("crank_speed", self.crank_speed),
                ("crank_acceleration", self.crank_acceleration),
                *((type(item).__name__, getattr(item, "force", None)) for item in self.loads),
            ]
            if np.ndim(value) and np.shape(value)[-1] > 1 and not callable(value)
        ]
        if varying:
            raise ParameterError(
                f"{', '.join(varying)} is a table over the crank angles given, unknown between them; use a constant "
                "(or, for a process force, a function of the motion) to evaluate at other angles"
            )
        return replace(self, crank_angle=_angles(crank_angle))

    @cached_property
    def shape(self):
        """Shape (..., N) of a scalar result: batch axes of designs and loads, then the crank angles."""
        return wider(super().shape, *self.loads)

    @property
    def period(self):
        """Crank angle after which motion and loads repeat, rad: what extremes, means and tables run over."""
        return period_of(self.loads)

    @cached_property
    def sampled(self):
        """The solution over its period as extremes and means look at it (`turn.Turn`), whatever its crank angles."""
        from .turn import Turn

        return Turn.of(self)

    @property
    def reactions(self):
        """Names of the joint reactions."""
        return tuple(self._forces.reactions)

    def reaction(self, joint):
        """Reaction at a joint, (2, ..., N), N.

        "O": ground on crank; "A": on the coupler at A, from crank or block; "B": coupler on slider; "guide": ground
        on slider.
        """
        return self.as_vector(self._look_up("reaction", joint, self._forces.reactions))

    @property
    def scalars(self):
        """Names of the forces and moments that `scalar` gives."""
        return tuple(self._forces.scalars)

    def scalar(self, name):
        """A force or moment by name, (..., N): "guide_force", "guide_moment", "cam_force", "slot_force" ..."""
        found = self._look_up("quantity", name, self._forces.scalars)
        if not hasattr(found, "shape"):  # a constant has the gaps of the others
            found = found + 0.0 * self._forces.scalars["balancing_torque"]
        return self._scalar(found)

    @property
    def guide_force(self):
        """Force of the guide on the slider along the guide's left normal, N."""
        return self.scalar("guide_force")

    @property
    def guide_moment(self):
        """Moment of the guide on the slider about the slider pin, N m."""
        return self.scalar("guide_moment")

    @property
    def cam_force(self):
        """Force of the cam on the roller along the normal, positive toward the inside of the pitch curve, N."""
        return self.scalar("cam_force")

    @property
    def slot_force(self):
        """Force of the slotted crank on the block across the ray, positive with growing crank angle, N."""
        return self.scalar("slot_force")

    @cached_property
    def balancing_torque(self):
        """Torque on the crank that keeps the prescribed motion, from the crank's equilibrium, N m."""
        return self.scalar("balancing_torque")

    @cached_property
    def balancing_torque_by_power(self):
        """The same torque from the balance of powers, without any reaction, N m."""
        total = reduce(plus, self._powers)
        return self._scalar(minus(None, total) if total is not None else 0.0)

    @cached_property
    def power_residual(self):
        """Largest difference of the two torques over the turn, relative to the largest single power that flows."""
        scale = self.largest_torque_term
        difference = self._largest(self.balancing_torque - self.balancing_torque_by_power)
        return np.where(scale > 0, difference / np.where(scale > 0, scale, 1.0), 0.0 * difference)[()]

    @cached_property
    def largest_torque_term(self):
        """Largest torque that one load alone would take, N m: what the balancing torque is a sum of."""
        return reduce(np.maximum, (self._largest(part) for part in self._powers), 0.0)

    @cached_property
    def largest_force_term(self):
        """Largest load on one link, weight, inertia or applied, N: what a reaction is a sum of."""
        forces = [part for wrench in self._link_loads.values() if wrench.force is not None for part in wrench.force]
        return reduce(np.maximum, map(self._largest, [*forces, *self._pushes.values()]), 0.0)

    @cached_property
    def shaking_force(self):
        """Force of the inertia of all moving masses on the frame, (2, ..., N), N."""
        return principal_points(self.mechanism).shaking_force(self)

    @cached_property
    def shaking_moment(self):
        """Moment about O of the inertia of all moving masses on the frame, (..., N), N m."""
        moments = (
            plus(moment(self._link(name).joint.position, wrench.force), wrench.moment)
            for name, wrench in self._inertia.items()
        )
        return self._scalar(reduce(plus, moments))

    def inertia_force(self, link):
        """Inertia force of one link, minus mass times acceleration of its mass centre, (2, ..., N), N."""
        return self.as_vector(self._look_up("link", link, self._inertia).force)

    def condition_of(self, quantity):
        """How many times relative errors are magnified in one quantity, relative to its largest value, (..., N).

        Geometry (`condition`) times cancellation: the largest of the terms that a force or torque is the sum of, over
        its largest value, where spring and inertia nearly balance for instance. 16 - log10 of it are the digits left.
        """
        from .quantities import scale, values

        largest = np.asarray(self._largest(values(self, quantity)))
        terms = np.broadcast_to(scale(self, quantity), largest.shape)
        cancelled = np.divide(terms, largest, out=np.ones(largest.shape), where=largest > 0)
        return self.condition * np.fmax(cancelled, 1.0).reshape(*largest.shape, *[1] * (self.condition.ndim > 0))

    @property
    def pressure_angle(self):
        """Pressure angle of the cam pair, atan(r'/r), (..., N), rad."""
        from .cam_roller import CamRoller

        roller = self.mechanism.group(CamRoller)
        if roller is None:
            raise QuantityError(f"{self.mechanism.name} has no cam, so no pressure angle")
        return self._scalar(roller.cam.pressure_angle(self.crank_angle))

    def frame(self):
        """All results as a pandas DataFrame, one row for each crank angle (and design), units in the column names."""
        from .tables import solution_frame

        return solution_frame(self)

    @cached_property
    def _forces(self):
        with np.errstate(divide="ignore", invalid="ignore"):
            forces = self.mechanism.resolve(self.placement, self._link_loads, self._pushes)
        if not self.mechanism.of_library:
            self._warn_of_lost_power(forces.scalars["balancing_torque"])
        return forces

    def _warn_of_lost_power(self, torque):
        """Warn if a group of the user's own finds forces that do not do the work of the loads."""
        torque = self._scalar(torque)
        if not isinstance(torque, np.ndarray) or torque.dtype != float:
            return
        lost = self._largest(torque - self.balancing_torque_by_power)
        scale = np.maximum(self.largest_torque_term, self._largest(torque))
        if np.any(lost > UNBALANCED * scale):
            warnings.warn(
                f"{self.mechanism.name}: the balancing torque from the forces and that from the balance of powers "
                f"differ by up to {np.nanmax(lost):.3g} N m, beside {np.nanmax(scale):.3g} N m: a group of your own "
                "places its links or resolves its forces wrongly; ks.check(group) says where",
                stacklevel=2,
            )

    @cached_property
    def _gravity(self):
        return reduce(added, (item.vector for item in self.loads if isinstance(item, Gravity)), None)

    @cached_property
    def _inertia(self):
        return self._mass_loads(None)

    @cached_property
    def _link_loads(self):
        return self._mass_loads(self._gravity)

    def _mass_loads(self, gravity):
        links = self.placement.links
        return {
            name: load(links[name], link.body, *self.accelerating, gravity)
            for name, link in self.mechanism.links.items()
        }

    @cached_property
    def _pushes(self):
        pushes: dict[str, Any] = {}
        for item in self.loads:
            if not isinstance(item, Gravity):
                pushes[item.on] = plus(pushes.get(item.on), pushed(item, self))
        return pushes

    @cached_property
    def _closed(self):
        """Whether the mechanism closes at each angle."""
        parts = [part for joint in self.placement.joints.values() for part in joint.position]
        return np.isfinite(reduce(plus, (np.asarray(part, dtype=float) for part in parts)))

    def _largest(self, part):
        """Largest magnitude over the angles at which the mechanism closes; NaN if there is none."""
        size, closed = np.broadcast_arrays(np.abs(np.asarray(number(part), dtype=float)), self._closed)
        if not size.ndim:
            return size if closed else size * np.nan
        return np.where(closed.any(axis=-1), np.max(np.where(closed, size, 0.0), axis=-1), np.nan)

    @cached_property
    def _powers(self):
        """Power of each load divided by the crank speed."""
        links = self.placement.links
        works = [virtual_work(links[name], wrench) for name, wrench in self._link_loads.items()]
        return works + [product(push, self._travel(name).first) for name, push in self._pushes.items()]


def period_of(loads):
    """Crank angle after which all loads repeat, rad: the turns that their periods have in common, one at least."""
    return TURN * math.lcm(*(max(1, round(getattr(item, "period", TURN) / TURN)) for item in loads))


def _period_problem(loads):
    """What is wrong with the period that loads have in common, or None."""
    turns = period_of(loads) / TURN if len(loads) > 1 else 1.0
    each = ", ".join(f"{getattr(item, 'period', TURN) / TURN:.6g}" for item in loads)
    return (
        f"loads that repeat after {each} turns do so together after {turns:.6g} only, {MOST_TURNS} at most"
        if (turns > MOST_TURNS)
        else None
    )


def is_given(item):
    """Whether a load is numbers, checked when it was made, and no code of the user's."""
    return isinstance(item, Gravity | Spring) or (isinstance(item, ProcessForce) and not callable(item.force))


def pushed(item, motion):
    """Force of a load on its slider, N; what a function of the user's returns is checked.

    Raises
    ------
    ParameterError
        It is no array of numbers, one for each crank angle, or not finite where the mechanism closes.
    """
    found = item.push(motion)
    if is_given(item) or (isinstance(found, np.ndarray) and found.dtype == object):
        return found
    owner = f"{type(item).__name__} on {item.on!r}: its function"
    wanted = f"must return its force in N, a number or an array of shape {motion.shape}, one for each crank angle"
    words = None if hasattr(found, "to_numpy") else checks.unfit(found)
    if words:
        raise ParameterError(f"{owner} {wanted}, got {checks.shown(found)}, {words.format(unit='N')}")
    if is_foreign_array(found):
        return found
    array = np.asarray(found)
    if array.dtype == object and array.ndim == 0 and hasattr(found, "__mul__"):  # a recorded number, an enclosure
        return found
    if array.dtype.kind not in "fiu":
        raise ParameterError(f"{owner} {wanted}, got {str(found)[:60]}")
    if not _fits(array.shape, motion.shape):
        raise ParameterError(f"{owner} {wanted}, got shape {array.shape}")
    if not np.isfinite(array).all():
        _require_finite(owner, array, motion)
    return array if array.dtype.kind == "f" else array.astype(float)


def _fits(shape, wanted):
    try:
        return np.broadcast_shapes(shape, wanted) == wanted
    except ValueError:
        return False


def _require_finite(owner, push, motion):
    """Raise an error for a push that is not finite where the mechanism closes."""
    wrong = np.broadcast_to(~np.isfinite(push) & motion._closed, motion.shape)
    if wrong.any():
        angle = np.broadcast_to(motion.crank_angle, motion.shape)[wrong]
        places = ", ".join(f"{place:.6g}" for place in np.degrees(angle[:3]))
        raise ParameterError(
            f"{owner} must return finite forces, got {np.broadcast_to(push, motion.shape)[wrong][0]} at {angle.size} "
            f"crank angles, the first {places} deg",
            wrong.any(axis=-1) if wrong.ndim > 1 else None,
        )


def _angles(crank_angle):
    if type(crank_angle) is np.ndarray and crank_angle.dtype in PRECISIONS:
        return read_only(crank_angle.copy())
    if isinstance(crank_angle, list | tuple) and not crank_angle:
        checks.require("solve", "there are no crank angles")
    angle, problem = ANGLE.taken(crank_angle)
    checks.require("solve", problem)
    return angle if hasattr(angle, "shape") else read_only(np.array(angle))


def _drive(**motion):
    """Crank speed and acceleration as floats or arrays."""
    plain = [DRIVE[name].quick(value) for name, value in motion.items()]
    return checks.examined("solve", DRIVE, motion).values() if checks.UNSURE in plain else plain


def solve(mechanism, crank_angle, *, crank_speed, crank_acceleration=0.0, loads=(), on_gap="raise", engine=None):
    """Motion and forces of a mechanism at prescribed crank motion.

    Parameters
    ----------
    mechanism : Mechanism
        As made by `crank_slider`, `cam_crank_slider` or from a crank and groups of your own.
    crank_angle : array (..., N)
        rad, counter-clockwise from +x; the last axis is the turn, axes before it broadcast with designs.
    crank_speed, crank_acceleration : float or array
        rad/s and rad/s2, counter-clockwise positive.
    loads : sequence
        `Gravity`, `Spring`, `ProcessForce`, or one of them; what is left out costs nothing. Loads of your own, as all
        arrays, are taken as they are now: what is changed of them later is not seen.
    on_gap : "raise" or "nan"
        What to do where the mechanism cannot be assembled: raise `AssemblyError` with the crank-angle intervals, or
        give NaN there and exact values elsewhere (no check, as needed under ``jax.jit``).
    engine : "numpy" or "compiled"
        "compiled" runs the same kernels as one loop made by numba (extra `fast`), for each quantity when it is asked
        for: the first time takes about a second, then machine code is kept on disk. Unless told, it is taken for a
        million crank angles (designs times angles) and more, if numba is installed. Results agree to a few ulp.

    Returns
    -------
    Solution
        Lazy: results are computed when first read, and kept; they cannot be written to.

    Raises
    ------
    AssemblyError
        The mechanism does not close at some of the angles and ``on_gap="raise"``.
    ParameterError
        A value is not finite, or a load acts on a link that is not there.
    MissingLibraryError
        ``engine="compiled"`` without numba.
    NotGivenError
        ``engine="compiled"`` for a group or load of your own that does more than arithmetic.

    Warns
    -----
    ConditionWarning
        Half of the digits are lost at some crank angle: `Solution.condition` exceeds 1e8.
    HintWarning
        Something looks like a slip of units: angles in degrees, a mass centre far outside, hardly any inertia.
    UserWarning
        The crank angles are in single precision; forces of a group of your own lose power (when they are computed).
    """
    if type(mechanism) is not Mechanism:
        checks.require("solve", _no_mechanism(mechanism))
    angle = _angles(crank_angle)
    crank_speed, crank_acceleration = _drive(crank_speed=crank_speed, crank_acceleration=crank_acceleration)
    loads = tuple(loads) if isinstance(loads, list | tuple) else (loads,)
    checks.require(
        "solve",
        None if math.prod(angle.shape) else "there are no crank angles",
        None if _finite(angle) else "crank angles must be finite; found NaN or infinity",
        checks.choice("on_gap", on_gap, ("raise", "nan")),
        None if engine is None else checks.choice("engine", engine, ("numpy", "compiled")),
        *(_load_problem(mechanism, item) for item in loads),
        _period_problem(loads),
    )
    loads = tuple(item if type(item) in LOADS else checks.kept(item) for item in loads)
    shapes = _shapes(
        mechanism, loads, crank_angle=angle, crank_speed=crank_speed, crank_acceleration=crank_acceleration
    )
    checks.require("solve", checks.fitting(**shapes))
    if angle.dtype == "float32":
        warnings.warn(
            "crank angles are in single precision, so are the results: about 7 digits, 8 fewer than in double; under "
            'JAX switch jax.config.update("jax_enable_x64", True) on first',
            stacklevel=2,
        )
    for text in (*mechanism.hints, *hints.of_angles(angle)):
        warnings.warn(f"{mechanism.name}: {text}", HintWarning, stacklevel=2)
    solution = _on_engine(engine, Solution(mechanism, angle, crank_speed, crank_acceleration, loads))
    if on_gap == "raise":
        solution.check()
    return solution


def _on_engine(engine, solution):
    """The solution on the engine asked for, or on the one that suits."""
    plain = isinstance(solution.crank_angle, np.ndarray) and solution.crank_angle.dtype == float
    if engine == "numpy" or (engine is None and not (plain and math.prod(solution.shape) >= WORTH_COMPILING)):
        return solution
    from . import compiled

    if engine == "compiled" and not plain:
        raise ParameterError('solve: engine="compiled" takes crank angles in double precision; use engine="numpy"')
    if engine == "compiled":
        compiled.require()
    try:
        made = compiled.made_of(solution) if engine == "compiled" or compiled.available() else solution
    except NotGivenError:
        if engine == "compiled":
            raise
        return solution
    if not solution.mechanism.of_library:
        _tried(solution)
    return made


def _tried(solution):
    """Compute forces at some angles under gravity, for the warning that compiled loops do not give."""
    angle = np.ravel(solution.crank_angle)[:: solution.crank_angle.size // TRIED + 1]
    Solution(solution.mechanism, angle, 1.0, 1.0, (Gravity(),)).scalar("balancing_torque")


def _no_mechanism(found):
    """What is wrong with what was given for a mechanism, or None."""
    if isinstance(found, Mechanism):
        return None
    itself = not isinstance(found, type) and hasattr(found, "solve")
    remedy = "; it is solved by its own .solve(angles), with its own drive and loads" if itself else ""
    return f"mechanism must be a Mechanism, as made by crank_slider or four_bar, got {checks.shown(found)}{remedy}"


def _finite(angle):
    """Whether all crank angles are finite, as far as they can be looked at."""
    if not isinstance(angle, np.ndarray) or angle.dtype == object:
        return True
    return (angle.ndim == 1 and math.isfinite(angle.dot(angle))) or np.isfinite(angle).all()  # dot costs a quarter


def _shapes(mechanism, loads, **arrays):
    """Shapes that must fit together, by what has them."""
    shapes = {name: value.shape for name, value in arrays.items() if hasattr(value, "shape")}
    if mechanism.batch:
        shapes["mechanism"] = mechanism.batch
    for item in loads:
        found = getattr(getattr(item, "force", None), "shape", ()) or getattr(item, "batch", ())
        if found:
            shapes[f"{type(item).__name__} {len(shapes)}"] = found
    return shapes


def _load_problem(mechanism, item):
    if isinstance(item, Gravity):
        return None
    if isinstance(item, type) or not (hasattr(item, "push") and hasattr(item, "on")):
        return f"loads must be Gravity, Spring or ProcessForce, got {checks.shown(item)}"
    sliders = [name for name in mechanism.links if name.startswith("slider")]
    return checks.choice(f"{type(item).__name__}: on", item.on, sliders)
