"""Motion and forces of a scene, each quantity computed by an engine when it is first read.

`Solution` reads top to bottom: checks, crank angles, forces, inertia and energy, friction, condition, explanation, and
last the calls of the engine. Positions, velocities and accelerations are those of `Motion`, proven bounds
and uncertainties those of `Certainty`. SI and radians; shapes (..., N), vectors (2, ..., N).
"""

import math
import warnings
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Any

import numpy as np

from ..cycle.limit_positions import Turn
from ..cycle.load_functions import FUNCTION_STEP
from ..engines.engines import NUMPY
from ..errors import ConditionWarning
from ..machine.group import GROUND
from ..machine.links import Turning
from ..machine.loads import period_of, refusals
from ..mechanics import assembly, energy_contact, jamming
from ..mechanics.dynamics import Dynamics
from ..mechanics.load_values import require_pure
from ..mechanics.motion import Motion, SceneParts
from ..mechanics.quantities import largest_term, of_mechanism, of_scene, resolved_names, values, without_bars
from ..numbers import checks
from ..numbers.arithmetic import read_only
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import construct_unchecked, replace_unchecked
from .certainty import Certainty
from .columns import ByName
from .condition import condition, is_surely_well_conditioned, warn_of_lost_digits
from .crankshaft import CrankshaftResults
from .ground import Ground
from .parameters import (
    crank_angles,
    drive_and_loads_text,
    hint_at_angles,
    require_known_between_angles,
    scene_plausibility_test,
)
from .period_means import PeriodMeans
from .sections import WithSections

MAX_VALUES_TOGETHER = 100_000
"""Values over designs and angles up to which all forces are computed together."""

SHARED_WITH_DYNAMICS = (*SceneParts._fields, "crank_angle", "apart", "loads_are_given", "kind", "shape")
"""Members that a solution shares with its `Dynamics`."""
read_shared = attrgetter(*SHARED_WITH_DYNAMICS)


def _member(name):
    """Member of `Dynamics` with its docstring; a quantity is computed by the engine when first read, and kept."""
    return property(lambda self: self._found(name), doc=getattr(Dynamics, name).__doc__)


def _scalar(name, text):
    """Force or moment that the forces of a mechanism have by a name."""
    return property(lambda self: self._force("quantity", name, False), doc=text)


@dataclass(frozen=True, eq=False)
class Solution(Certainty, WithSections, CrankshaftResults, PeriodMeans, ByName, Motion):
    """Motion and forces of a mechanism at its crank angles; `solve` and `Scene.solve` return it.

    Every result is computed when first read, and cached; arrays are read-only. SI and radians throughout; angles count
    counter-clockwise from +x. Arrays end with the crank angles, N of them; batch axes of designs come before: (..., N).
    A vector has (x, y) as its first axis: (2, ..., N).

    ``s[name]`` gives each result by its name, `quantities` lists all: ``s["guide_force"]``, ``s["O"]``. A group's
    `label` ends the names of its links and forces: "coupler2", "slider2", "guide_force2" of a `SliderGroup`
    with ``label="2"``; its `pin` and `pivot_name` name its joints. `reactions` and `scalars` list all names. Where the
    mechanism does not close, `solve` raises, or with ``on_gap="nan"`` gives NaN for the open group, groups attached to
    it, and forces of groups that carry it.

    Attributes
    ----------
    mechanism : Mechanism
    crank_angle : array (..., N)
        phi, rad.
    crank_speed, crank_acceleration : float or array
        omega, rad/s, and alpha, rad/s2, counter-clockwise positive.
    sense : None, float or array
        Given sense in which a crank at rest is about to turn: +1 counter-clockwise, -1 clockwise.
    loads : tuple
    friction : mapping of joint to friction
    engine, silent
        Engine that computes it; whether it gives no further warnings.
    resolution : float
        Step of crank angles at which load functions without `kinks` are sampled, rad.
    shape, period, crank_sense, closed, closure, gravity
    reactions, scalars, quantities
    slider_position, slider_velocity, slider_acceleration, pressure_angle
    balancing_torque, balancing_torque_by_power, power_residual, load_torque
    mean_torque, mean_power, energy_per_turn
    guide_force, guide_moment, guide_friction, cam_force, slot_force, contact_pressure
    shaking_force, shaking_moment, rocking_moment, ground
    reduced_inertia, reduced_inertia_slope, kinetic_energy, potential_energy
    friction_loss, friction_torque, friction_margin, friction_residual, converged, losses, efficiency
    condition, largest_force_term, largest_torque_term

    Methods
    -------
    reaction(joint, at), scalar(name), pressure(name), pin_load(joint), inertia_force(link), ground_force(place)
    friction_at(joint), friction_loss_at(joint), shaft_torque(group, drive)
    position(point), velocity(point), acceleration(point)
    rate(link), angular_acceleration(link)
    travel(slider), travel_velocity(slider), travel_acceleration(slider), elongation(free_position, slider)
    measure(name), at(crank_angle)
    condition_of(quantity), error_bound(quantity, tight), uncertainty(quantity, inputs)
    explain(quantity, angle, design), shares(quantity), sections(link, bar, at), frame(units)

    Notes
    -----
    A reaction acts on the body named last, and oppositely on the other body:

    - "O": ground on crank.
    - "A": on the coupler (rod, block of a lever or yoke, first link of a dyad), from the link of A: the crank, or the
      block of a cam roller. For a group at another joint, "C": on its coupler, from the link of C.
    - "B", pin of a slider: coupler on slider; pin of a rocker: coupler on rocker; pin of a dyad: dyad1 on dyad2.
    - "O2", a fixed pivot: ground on rocker, on lever, on cylinder, on arm.
    - "guide": ground on slider, or on follower; friction included.

    Your own groups and loads may also use `placement` (joints and links as kinematic coefficients), `spot`,
    `as_vector`, `accelerating`. Inside the library `dynamics`, `sampled`, `sampled_for_forces`, `apart`, `kind`,
    `places`, `PATHS`, `RULES`, `unsolved_at`, `moved_to`, `first_look`, `with_doubt`, `proportion`, `farthest`,
    `loads_are_given`, `is_given` and `check`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
    >>> s.reactions, s.scalars
    (('A', 'B', 'guide', 'O'), ('guide_force', 'guide_moment', 'balancing_torque'))
    >>> print(f"{s.balancing_torque[30] * s.crank_speed / 1e3:.0f} kW from the drive at 30 deg")
    1269 kW from the drive at 30 deg
    >>> back = ks.Scene(saw, -33.5, loads=[ks.Gravity()]).solve(360)  # the other way round: the same forces
    >>> bool(abs(back.balancing_torque - s.balancing_torque).max() < 1e-9)
    True
    """

    engine: Any = NUMPY
    silent: bool = field(default=False, repr=False)
    resolution: float = FUNCTION_STEP

    def __repr__(self):
        return f"<Solution: {self.mechanism.name}, shape {self.shape}, {drive_and_loads_text(self)}>"

    # Checks of a new solution

    def check(self, on_gap="raise"):
        """The solution with its friction solved; `on_gap` as for `solve`.

        Raises where the mechanism does not close, friction jams or a load has no value; warns where half of the digits
        are lost.
        """
        solution = self
        if on_gap != "raise":
            warn_of_lost_digits(self.dynamics, self.dynamics.closure)
        elif not is_surely_well_conditioned(self, self._found("closure")):
            warn_of_lost_digits(self.dynamics, assembly.check(self.dynamics))
        if self.friction.acting:
            checks.require("solve", jamming.problem_at_rest(self))
            solution = jamming.solve_friction(self, jamming.checks_of)
            jamming.check(solution, on_gap)
        if not self.loads_are_given:
            require_pure(solution)
        checks.require("solve", *refusals(solution), *(energy_contact.refusals(solution) if on_gap == "raise" else ()))
        return solution

    @cached_property
    def first_look(self):
        """Sum of all lengths over the shortest, and whether hints are possible; None unless all numbers are plain."""
        _, leaves = self.apart
        test = self.kind.answer(scene_plausibility_test) if leaves.are_plain and not leaves.parts else None
        return test and test(leaves.numbers)

    @property
    def proportion(self):
        """Sum of all lengths over the shortest, the largest of a batch."""
        return self.first_look[0] if self.first_look else self.mechanism.proportion

    closed = _member("closed")

    @property
    def is_given(self):
        """Whether it contains no user code, which may be wrong and is checked when it runs."""
        return self.mechanism.trusted and self.loads_are_given

    # Crank angles

    def at(self, crank_angle):
        """The same mechanism, speed and loads at other crank angles.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
        >>> print(f"{s.at(0.5).balancing_torque:.1f} N m")
        37051.3 N m
        """
        moved = self.unsolved_at(crank_angle)
        hint_at_angles(self.mechanism.name, crank_angle)
        if self.friction.acting:
            moved = jamming.solve_friction(moved, jamming.checks_of)
            margin, residual = jamming.checks_of(moved)
            jamming.warn_if_not_converged(moved, margin, residual, stacklevel=3)
        return moved

    def unsolved_at(self, crank_angle):
        """As `at`, with the present number of passes over friction; other crank angles may need more."""
        require_known_between_angles(self)
        return self.moved_to(crank_angles(crank_angle))

    def moved_to(self, angle):
        """As `unsolved_at` for an array of crank angles, without any check; the structure is not read again."""
        moved = replace_unchecked(self, crank_angle=read_only(angle))
        vars(moved).update(apart=self.apart, kind=self.kind)
        return moved

    @cached_property
    def period(self):
        """Crank angle after which motion and loads repeat, rad: a turn, or more for some loads and change points.

        Extremes, means and tables cover one period.
        """
        return period_of(self.loads, self.mechanism.turns)

    @cached_property
    def sampled(self):
        """The solution over one period, a `Turn`, for extremes and means."""
        return Turn.of(self)

    @cached_property
    def sampled_for_forces(self):
        """As `sampled`, with passed change points treated as limit positions, where reactions grow."""
        return Turn.of(replace(self, silent=True), forces=True) if self.mechanism.passes else self.sampled

    # Forces and moments

    @property
    def reactions(self):
        """Names of the joint reactions."""
        return tuple(name for name, output in self.mechanism.outputs.items() if output.vector)

    def reaction(self, joint, at=None):
        """Reaction at a joint, (2, ..., N), N; infinite at a passed change point, with a ConditionWarning.

        "O": ground on crank; "A": on the coupler at A, from crank or block; "B": coupler on slider; "guide": ground
        on slider. `at` "left" or "right": the part of "O" in one of the main bearings (``Crank(bearings=)``).

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
        >>> print(f"{s.reaction('guide')[1, 90]:.0f} N")  # upward, by the ground on the slider at 90 deg
        702 N
        """
        return self._force("reaction", joint, True) if at is None else self._at_bearing(joint, at)

    @property
    def scalars(self):
        """Names of the forces and moments that `scalar` gives."""
        return tuple(name for name, output in self.mechanism.outputs.items() if not output.vector)

    def scalar(self, name):
        """A force or moment by name, (..., N), N or N m.

        "balancing_torque", "guide_force", "guide_moment", "cam_force", "slot_force", "slot_moment", "cylinder_force",
        "cylinder_moment", "contact_force" ...
        """
        return self._force("quantity", name, False)

    balancing_torque = _scalar(
        "balancing_torque",
        """Torque M of the drive on the crank for the prescribed motion, counter-clockwise positive, N m.

        Its power is M omega for both senses of rotation. With omega > 0 the drive pushes where M > 0 and brakes
        where M < 0; with omega < 0 it pushes where M < 0 and brakes where M > 0.
        M = J alpha + J' omega^2 / 2 + load torque, with the reduced inertia J.
        """,
    )
    balancing_torque_by_power = _member("balancing_torque_by_power")

    @cached_property
    def power_residual(self):
        """Largest difference of the two torques over the turn, relative to the largest of one load or of friction."""
        scale = self.largest_torque_term
        if self.friction.acting:
            scale = np.maximum(scale, self.dynamics.largest(self.friction_torque))
        difference = self.dynamics.largest(self.balancing_torque - self.balancing_torque_by_power)
        return np.where(scale > 0, difference / np.where(scale > 0, scale, 1.0), 0.0 * difference)[()]

    largest_torque_term = _member("largest_torque_term")
    largest_force_term = _member("largest_force_term")
    guide_force = _scalar("guide_force", "Force of the guide on the slider along the guide's left normal, (..., N), N.")
    guide_moment = _scalar("guide_moment", "Moment of the guide on the slider about the slider pin, (..., N), N m.")
    cam_force = _scalar(
        "cam_force",
        """Force of the cam on the roller along the normal, (..., N), N.

        Positive toward the inside of the pitch curve, as a ring around it pushes; negative outward, as a disk does.
        """,
    )
    slot_force = _scalar(
        "slot_force",
        """Force of a slot on its block, (..., N), N.

        Of a slotted crank across the ray, positive with growing crank angle; of a lever, and on the block of a yoke's
        slider, along the left normal of the slot.
        """,
    )

    def pin_load(self, joint):
        """Force on a pin by all rods on it together, (2, ..., N), N; on the link that owns the joint."""
        owner = self._look_up("joint", joint, self.mechanism.joints).link
        total = np.zeros((2, *self.shape))
        for name, pair in self.mechanism.pairs.items():
            if isinstance(pair, Turning) and pair.joint == joint:
                total = total + (1.0 if pair.link == owner else -1.0) * self.reaction(name)
        return total

    def pressure(self, name="contact_pressure"):
        """Largest Hertz pressure of a line contact by name, (..., N), Pa; NaN without contact.

        A cam with a `Roller` and a follower with a `Face` have one; for a second follower the name ends with its label.
        """
        checks.require("pressure", checks.quantity(name))
        known = of_scene(self)
        return self._found(name) if name in known and known[name].kind == "contact" else self.dynamics.pressure(name)

    contact_pressure = property(pressure)

    @property
    def pressure_angle(self):
        """Pressure angle of the cam pair, atan(r'/r), (..., N), rad, positive where r grows with the crank angle."""
        return self.measure("pressure_angle")

    # Inertia and energy

    def inertia_force(self, link):
        """Inertia force of one link, minus mass times acceleration of its mass centre, (2, ..., N), N.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
        >>> print(f"{s.inertia_force('slider')[0, 0]:.0f} N")  # outward at the outer dead centre
        232306 N
        """
        return self.dynamics.inertia_force(link)

    shaking_force = _member("shaking_force")
    shaking_moment = _member("shaking_moment")
    reduced_inertia = _member("reduced_inertia")
    reduced_inertia_slope = _member("reduced_inertia_slope")
    kinetic_energy = _member("kinetic_energy")
    potential_energy = _member("potential_energy")
    load_torque = _member("load_torque")

    @property
    def ground(self):
        """Forces and couples of the machine on the frame, by place, a `Ground`."""
        return Ground(self)

    def ground_force(self, place=None):
        """Force of the machine on the frame at a place of `ground` by name, (2, ..., N), N; None: the sum of all."""
        if not self.mechanism.trusted:
            self.ground  # noqa: B018  warns if a group of the user's own pushes the frame elsewhere
        name = GROUND if place is None else f"{GROUND} {place}"
        return self._found(name) if name in of_scene(self) else self.dynamics.ground_force(place)

    # Friction

    def friction_at(self, joint):
        """Friction at a joint on the link that moves there: moment of a pin, N m, else the force along the pair, N."""
        return self._at_joint(joint, "_friction")

    def friction_loss_at(self, joint):
        """Power lost by friction at a joint, named as in `friction`, (..., N), W; 0 without friction there."""
        return self._at_joint(joint, "_friction_loss")

    @property
    def guide_friction(self):
        """Friction of the guide on the slider along the guide, N, against its velocity; 0 without friction."""
        return self.friction_at("guide") if "guide" in self.mechanism.pairs else self._scalar(None)

    friction_loss = _member("friction_loss")
    friction_torque = _member("friction_torque")
    friction_margin = _member("friction_margin")
    friction_residual = _member("friction_residual")

    def shares(self, quantity):
        """Shares of inertia and weight of each link, and of each load, in a force or moment, a `Shares` table.

        The share of a source is its value at the crank angle of the largest total, for a vector its projection on
        the total. Shares add up to the peak. The table also has peak and root mean square of each single source. With
        friction a row is the effect of leaving out its source, or the friction of a joint. For one design.

        Parameters
        ----------
        quantity : str
            A reaction ("O"), a force or moment ("balancing_torque", "cam_force"), "shaking_force", "load_torque" ...

        Raises
        ------
        QuantityError
            The quantity is unknown or not linear in masses and loads; the message lists the linear ones.
        ParameterError
            The solution is a batch of designs or does not close all round, or the quantity is 0 or grows without bound.
        JammingError
            Friction jams, or jams without one of the sources.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> shares = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360).shares("O")
        >>> print(f"{shares['inertia of slider'].value:.0f} N of {shares.total.value:.0f} N")
        232305 N of 286596 N
        """
        from .shares import shares

        return shares(self, quantity)

    @property
    def converged(self):
        """Whether friction and reactions agree to rounding, (..., N) of bool; without friction: whether it closes."""
        if not self.friction.acting:
            return np.broadcast_to(self.closed, self.shape)
        return jamming.converged(*jamming.checks_of(self))

    # Condition, explanation and table

    @cached_property
    def condition(self):
        """Magnification of relative errors of lengths, including rounding, in rates and forces, (..., N).

        It is a bound: the sum of ``|p dq/dp|`` over all lengths and the crank angle p, over the largest term of q. The
        worst of rates, reactions and torque counts (`solution.condition`). Below 1e3 no digit is lost. It is infinite
        at a limit position, toggle or change point, NaN where the mechanism does not close. A result has about 16 -
        log10(condition) correct digits of its largest term, or more.

        Where change points are passed ("open", "crossed") it covers only motion and torque, which are finite there;
        `condition_of` gives it for a reaction.

        Derivatives are exact, those of the recorded program. Where a group of the user's own does more than arithmetic,
        so that it cannot be recorded, they are differences, with a `ConditionWarning`.
        """
        return read_only(condition(self.dynamics).reshape(self.shape))

    @cached_property
    def _condition_with_reactions(self):
        """As `condition`, with reactions also where change points are passed, (..., N)."""
        return read_only(condition(self.dynamics, reactions=True).reshape(self.shape))

    def condition_of(self, quantity):
        """Magnification of relative errors in one quantity, relative to its largest value, (..., N).

        For a vector it is that of the magnitude: "O" as "|O|".

        Geometry (`condition`) times cancellation: the largest of the terms that a force or torque is the sum of, over
        its largest value, where spring and inertia nearly balance for instance. 16 - log10 of it are the digits left.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
        >>> bool(s.condition_of("O").max() < 1e3)  # 13 digits and more
        True
        """
        quantity = quantity if callable(quantity) else without_bars(self, quantity)
        largest = np.asarray(self.dynamics.largest(values(replace(self, silent=True), quantity)))
        terms = np.broadcast_to(largest_term(self, quantity), largest.shape)
        cancelled = np.divide(terms, largest, out=np.ones(largest.shape), where=largest > 0)
        found = self.condition
        if not callable(quantity) and self.mechanism.grows(quantity):
            found = self._condition_with_reactions
        return found * np.fmax(cancelled, 1.0).reshape(*largest.shape, *[1] * (found.ndim > 0))

    def explain(self, quantity, angle, design=None):
        """The hand calculation of a quantity at one crank angle: formula, numbers with units, result, link by link.

        The steps are the kernels' own arithmetic. Friction, which needs iteration, is shown by the law that it
        satisfies.

        Parameters
        ----------
        quantity : str
            Any quantity of the solution: "balancing_torque", a joint (its reaction), "slider_acceleration" ...;
            ``"|O|"`` for the magnitude of a vector.
        angle : float
            Crank angle, rad; any angle, not only solved ones.
        design : int or tuple of int, optional
            One of several designs.

        Returns
        -------
        Explanation
            ``print`` it, or show it in a notebook; `.text`, `.latex`, `.html`, and `.steps` as data.

        Raises
        ------
        QuantityError
            The quantity is unknown; the message lists the known ones.
        AssemblyError
            The mechanism does not close at that crank angle.
        ParameterError
            Several designs and no `design`, several crank angles, or an angle between those of a table.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
        >>> shown = ks.solve(pump, 0.0, crank_speed=100.0).explain("slider_velocity", 0.7)
        >>> print(shown.steps[-1].formula, "=", shown.steps[-1].numbers, "=", shown.steps[-1].shown)
        omega*s_slider' = 100*(-0.0384514) = -3.84514
        """
        from .hand_calculation import explain

        return explain(self, quantity, angle, design)

    def frame(self, units=None):
        """All results, one row for each crank angle (and design), a pandas DataFrame in `units` as of `in_units`."""
        from .tables import solution_frame

        return solution_frame(self, units)

    # Calls of the engine

    @cached_property
    def dynamics(self):
        """The scene at its crank angles, as input of engines and kernels."""
        shared = dict(zip(SHARED_WITH_DYNAMICS, read_shared(self), strict=True))
        return construct_unchecked(Dynamics, **shared, placement_method=getattr(self.engine, "placement_method", None))

    placement = property(lambda self: self.dynamics.placement, doc=Dynamics.placement.__doc__)

    @cached_property
    def _values(self):
        return {}

    def _force(self, kind, name, vector):
        """A force by name, without a second look-up of the name."""
        known = self._values.get(name) if isinstance(name, str) and name != "closure" else None
        if known is None or (getattr(known, "ndim", 0) > len(self.shape)) != vector:
            self._look_up(kind, name, dict.fromkeys(self.reactions if vector else self.scalars))
            known = self._found(name)
        if self.mechanism.passes:
            self._warn_of_growth(name, known)
        return known

    def _warn_of_growth(self, name, found):
        """Warn once where a force grows without bound at a passed change point."""
        if not self.silent and self.mechanism.grows(name):
            is_plain = isinstance(found, np.ndarray) and found.dtype == float
            text = assembly.unbounded_force_problem(self, name, found) if is_plain else None
            if text:
                object.__setattr__(self, "silent", True)
                warnings.warn(text, ConditionWarning, stacklevel=4)

    def _at_joint(self, joint, ending):
        """A quantity of friction at a joint; 0 without friction there."""
        self._look_up("joint with friction", joint, self.mechanism.pairs)
        return self._found(joint + ending) if joint in self.friction else self._scalar(None)

    def _found(self, name):
        """A quantity of the scene by name, or "closure", by the engine; another member of `dynamics` as it is."""
        if name not in self._values:
            if name != "closure" and name not in of_mechanism(self.mechanism) and name not in of_scene(self):
                return getattr(self.dynamics, name)
            if not self.mechanism.trusted and name in self.mechanism.outputs:
                self.dynamics.resolved  # noqa: B018  warns if forces of a group of the user's own lose power
            of_all = self.is_given if name == "closure" else name in resolved_names(self)
            together = of_all and math.prod(self.shape) <= MAX_VALUES_TOGETHER
            self._values.update(self.engine.values(self.dynamics, None if together else (name,)))
        return self._values[name]
