"""What users hold: motion and forces of a scene, each quantity computed by an engine when it is first read.

`Solution` reads top to bottom: checks, crank angles, forces, inertia and energy, friction, condition, explanation, and
last how a quantity is asked of the engine. Positions, velocities and accelerations are those of `Motion`, proven bounds
and uncertainties those of `Certainty`. SI and radians; shapes (..., N), vectors (2, ..., N).
"""

import math
import warnings
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..cycle.turn import Turn
from ..engines.engines import NUMPY
from ..errors import ConditionWarning, ParameterError
from ..machine.links import Turning
from ..machine.loads import period_of, refusals
from ..mechanics import assembly, energy_contact, jamming
from ..mechanics.dynamics import Dynamics
from ..mechanics.load_values import require_pure
from ..mechanics.motion import Motion
from ..mechanics.quantities import largest_term, of_scene, resolved_names, values, without_bars
from ..numbers import checks
from ..numbers.arithmetic import read_only
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import construct_unchecked
from . import contents
from .certainty import Certainty
from .condition import condition, is_surely_well_conditioned, warn_of_lost_digits
from .parameters import (
    crank_angles,
    drive_and_loads_text,
    hint_at_angles,
    scene_plausibility_test,
    tables_over_angles,
)

MAX_VALUES_TOGETHER = 100_000
"""Values over designs and angles up to which all forces are computed together."""


@dataclass(frozen=True, eq=False)
class Solution(Certainty, Motion):
    """Motion and forces of a mechanism; every result is computed when first read, and kept."""

    __doc__ = contents.__doc__

    engine: Any = NUMPY
    silent: bool = field(default=False, repr=False)

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
        """Sum of all lengths over the shortest, and whether hints may be due; None unless all numbers are plain."""
        _, leaves = self.apart
        test = self.kind.answer(scene_plausibility_test) if leaves.are_plain and not leaves.parts else None
        return test and test(leaves.numbers)

    @property
    def proportion(self):
        """Sum of all lengths over the shortest, the largest of a batch."""
        return self.first_look[0] if self.first_look else self.mechanism.proportion

    @property
    def closed(self):
        """Whether the mechanism closes, (..., N) of bool."""
        return self.dynamics.closed

    @property
    def is_given(self):
        """Whether it contains no code of the user's, which may be wrong and is checked when it runs."""
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
        varying = tables_over_angles(self)
        if varying:
            raise ParameterError(
                f"{', '.join(varying)} is a table over the crank angles given, unknown between them; use a constant "
                "(or, for a load, a Table or a function of the motion) to evaluate at other angles"
            )
        angle = crank_angles(crank_angle)
        hint_at_angles(self.mechanism.name, crank_angle)
        return replace(self, crank_angle=angle)

    @property
    def period(self):
        """Crank angle after which motion and loads repeat, rad; extremes, means and tables cover one period."""
        return period_of(self.loads, self.mechanism.turns)

    @cached_property
    def sampled(self):
        """The solution over one period, a `Turn`, from which extremes and means are found."""
        return Turn.of(self)

    @cached_property
    def sampled_for_forces(self):
        """The same with passed change points treated as limit positions: reactions grow there."""
        return Turn.of(replace(self, silent=True), forces=True) if self.mechanism.passes else self.sampled

    # Forces and moments

    @property
    def reactions(self):
        """Names of the joint reactions."""
        return tuple(name for name, output in self.mechanism.outputs.items() if output.vector)

    def reaction(self, joint):
        """Reaction at a joint, (2, ..., N), N; infinite at a change point that is passed, with a ConditionWarning.

        "O": ground on crank; "A": on the coupler at A, from crank or block; "B": coupler on slider; "guide": ground
        on slider.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360)
        >>> print(f"{s.reaction('guide')[1, 90]:.0f} N")  # upward, by the ground on the slider at 90 deg
        702 N
        """
        found = self._force("reaction", joint, True)
        if self.mechanism.passes:
            self._warn_of_growth(joint, found)
        return found

    @property
    def scalars(self):
        """Names of the forces and moments that `scalar` gives."""
        return tuple(name for name, output in self.mechanism.outputs.items() if not output.vector)

    def scalar(self, name):
        """A force or moment by name, (..., N): "guide_force", "guide_moment", "cam_force", "slot_force" ..."""
        found = self._force("quantity", name, False)
        if self.mechanism.passes:
            self._warn_of_growth(name, found)
        return found

    @property
    def balancing_torque(self):
        """Torque on the crank that the drive must give, counter-clockwise positive, N m; times omega its power, W."""
        return self.scalar("balancing_torque")

    @property
    def balancing_torque_by_power(self):
        """The same torque from the balance of powers, without any reaction, N m."""
        return self._found("balancing_torque_by_power")

    @cached_property
    def power_residual(self):
        """Largest difference of the two torques over the turn, relative to the largest of one load or of friction."""
        scale = self.largest_torque_term
        if self.friction.acting:
            scale = np.maximum(scale, self.dynamics.largest(self.friction_torque))
        difference = self.dynamics.largest(self.balancing_torque - self.balancing_torque_by_power)
        return np.where(scale > 0, difference / np.where(scale > 0, scale, 1.0), 0.0 * difference)[()]

    @property
    def largest_torque_term(self):
        """Largest torque that one load alone would take, N m; the balancing torque is a sum of such terms."""
        return self.dynamics.largest_torque_term

    @property
    def largest_force_term(self):
        """Largest load on one link, weight, inertia or applied, N; a reaction is a sum of such terms."""
        return self.dynamics.largest_force_term

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

    def pin_load(self, joint):
        """Force on a pin by all rods on it together, (2, ..., N), N; on the link that owns the joint."""
        owner = self._look_up("joint", joint, self.mechanism.joints).link
        total = np.zeros((2, *self.shape))
        for name, pair in self.mechanism.pairs.items():
            if isinstance(pair, Turning) and pair.joint == joint:
                total = total + (1.0 if pair.link == owner else -1.0) * self.reaction(name)
        return total

    def pressure(self, name="contact_pressure"):
        """Largest Hertz pressure of a line contact by name, (..., N), Pa; NaN where there is no such contact.

        A cam with a `Roller` and a follower with a `Face` have one; for a second follower the name ends with its label.
        """
        checks.require("pressure", checks.quantity(name))
        known = of_scene(self)
        return self._found(name) if name in known and known[name].kind == "contact" else self.dynamics.pressure(name)

    @property
    def contact_pressure(self):
        """Largest Hertz pressure between cam and roller, Pa, of a cam that has a `Roller`."""
        return self.pressure()

    @property
    def pressure_angle(self):
        """Pressure angle of the cam pair, atan(r'/r), (..., N), rad."""
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

    @property
    def shaking_force(self):
        """Force of the inertia of all moving masses on the frame, (2, ..., N), N."""
        return self._found("shaking_force")

    @property
    def shaking_moment(self):
        """Moment about O of the inertia of all moving masses on the frame, (..., N), N m."""
        return self._found("shaking_moment")

    @property
    def reduced_inertia(self):
        """Equivalent inertia of all links at the crank, (..., N), kg m2: twice the energy over the speed squared."""
        return self._found("reduced_inertia")

    @property
    def reduced_inertia_slope(self):
        """Derivative of the reduced inertia by the crank angle, (..., N), kg m2."""
        return self._found("reduced_inertia_slope")

    @property
    def kinetic_energy(self):
        """Kinetic energy of all links, (..., N), J."""
        return self._found("kinetic_energy")

    @property
    def potential_energy(self):
        """Potential energy of weight and springs, (..., N), J; weight has none at the height of O.

        Loads without potential, as process forces and dampers, count nothing.
        """
        return self._found("potential_energy")

    @property
    def load_torque(self):
        """Torque on the crank that balances weight and loads at their speed, without any inertia, (..., N), N m.

        With reduced inertia J the balancing torque is J alpha + J' omega^2 / 2 + load torque.
        """
        return self._found("load_torque")

    @cached_property
    def energy_per_turn(self):
        """Work of the balancing torque in a turn of the crank, J; of one design."""
        from ..cycle.means import energy_per_turn

        return energy_per_turn(self)

    # Friction

    def friction_at(self, joint):
        """Friction at a joint on the link that moves there: moment of a pin, N m, else the force along the pair, N."""
        self._look_up("joint that rubs", joint, self.mechanism.pairs)
        return self._of_friction(f"{joint}_friction")

    def friction_loss_at(self, joint):
        """Power lost by friction at a joint, named as in `friction`, (..., N), W; 0 without friction there."""
        self._look_up("joint that rubs", joint, self.mechanism.pairs)
        return self._of_friction(f"{joint}_friction_loss")

    @property
    def guide_friction(self):
        """Friction of the guide on the slider along the guide, N; 0 without friction."""
        return self._of_friction("guide_friction")

    @property
    def friction_loss(self):
        """Power lost by friction at all joints, (..., N), W, not negative."""
        return self._of_friction("friction_loss")

    @property
    def friction_torque(self):
        """Torque on the crank that friction takes, its loss over the crank speed, (..., N), N m."""
        return self._of_friction("friction_torque")

    @cached_property
    def losses(self):
        """Mean powers over the period, lost by joint and taken by loads, a `cycle.losses.Losses`; of one design."""
        from ..cycle.losses import losses

        return losses(self)

    @property
    def efficiency(self):
        """Mechanical efficiency over the period: work taken by loads over work taken by loads and lost at joints."""
        return self.losses.efficiency

    @property
    def friction_margin(self):
        """How far friction is from jamming: 1 without friction; where it is positive there is one state of forces.

        Of a single guide or pin with friction it is ``1 - |kappa|``, exactly: where it is 0 or less there is no state,
        or there are two. Of several joints of a group it is a bound, whatever their loads and senses of motion: where
        it is 0 or less there may still be one state; none is looked for, and friction is NaN.
        """
        return self._of_friction("friction_margin") if self.friction else self._scalar(1.0)

    @property
    def friction_residual(self):
        """How much forces would change by one more pass over friction, relative to the largest of a group."""
        return self._of_friction("friction_residual")

    @property
    def converged(self):
        """Whether friction and reactions agree to rounding, (..., N) of bool; without friction: whether it closes."""
        if not self.friction.acting:
            return np.broadcast_to(self.closed, self.shape)
        return jamming.converged(*jamming.checks_of(self))

    # Condition, explanation and table

    @cached_property
    def condition(self):
        """How many times relative errors of lengths, rounding among them, are magnified in rates and forces, (..., N).

        A bound of the true magnification: the sum over all lengths and the crank angle p of ``|p dq/dp|``, over the
        largest term of q, worst of rates, reactions and torque (`solution.condition`). Below 1e3 where nothing is lost,
        infinite at a limit position, toggle or change point, NaN where the mechanism does not close; a result has about
        16 - log10(condition) correct digits of its largest term, or more.

        Where change points are passed ("open", "crossed") it covers motion and torque alone, which are ordinary there;
        `condition_of` gives it for a reaction.

        Derivatives are exact, those of the recorded program. Where a group of the user's own does more than arithmetic,
        so that it cannot be recorded, they are differences, and a `ConditionWarning` says so.
        """
        return read_only(condition(self.dynamics).reshape(self.shape))

    @cached_property
    def _condition_with_reactions(self):
        """The same with reactions also where change points are passed, (..., N)."""
        return read_only(condition(self.dynamics, reactions=True).reshape(self.shape))

    def condition_of(self, quantity):
        """How many times relative errors are magnified in one quantity, relative to its largest value, (..., N).

        Of a vector it is that of the magnitude: "O" as "|O|".

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

        The steps are the kernels' own arithmetic. Friction, which is found by iteration, is shown by the law that it
        satisfies.

        Parameters
        ----------
        quantity : str
            Any that the solution has: "balancing_torque", a joint (its reaction), "slider_acceleration" ...;
            ``"|O|"`` for the magnitude of a vector.
        angle : float
            Crank angle, rad; it need not be one of those solved.
        design : int or tuple of int, optional
            Which one of several designs.

        Returns
        -------
        Explanation
            ``print`` it, or show it in a notebook; `.text`, `.latex`, `.html`, and `.steps` as data.

        Raises
        ------
        QuantityError
            There is no such quantity; the message lists those there are.
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

    def frame(self):
        """All results as a pandas DataFrame, one row for each crank angle (and design), units in the column names."""
        from .frame import solution_frame

        return solution_frame(self)

    # How a quantity is asked of the engine

    @cached_property
    def dynamics(self):
        """The scene at its crank angles, as engines take it and kernels compute it."""
        return construct_unchecked(
            Dynamics,
            mechanism=self.mechanism,
            crank_angle=self.crank_angle,
            crank_speed=self.crank_speed,
            crank_acceleration=self.crank_acceleration,
            loads=self.loads,
            friction=self.friction,
            sense=self.sense,
            apart=self.apart,
            loads_are_given=self.loads_are_given,
            kind=self.kind,
            shape=self.shape,
            way=getattr(self.engine, "way", None),
        )

    @property
    def placement(self):
        """Joints and links by name, as kinematic coefficients."""
        return self.dynamics.placement

    @cached_property
    def _values(self):
        return {}

    def _force(self, kind, name, vector):
        """A force by name; all are computed together if they are not too many."""
        if isinstance(name, str) and name in self._values:
            return self._values[name]
        self._look_up(kind, name, dict.fromkeys(self.reactions if vector else self.scalars))
        return self._found(name)

    def _of_friction(self, name):
        """A quantity of friction by name; 0 without friction there."""
        return self._found(name) if name in of_scene(self) else self._scalar(None)

    def _found(self, name):
        """Any quantity by its name in the table of quantities, or "closure"."""
        if name not in self._values:
            if not self.mechanism.trusted and name in self.mechanism.outputs:
                self.dynamics.resolved  # noqa: B018  warns if forces of a group of the user's own lose power
            of_all = self.is_given if name == "closure" else name in resolved_names(self)
            together = of_all and math.prod(self.shape) <= MAX_VALUES_TOGETHER
            self._values.update(self.engine.values(self.dynamics, None if together else (name,)))
        return self._values[name]

    def _warn_of_growth(self, name, values):
        """Say once that forces grow without bound at a change point that is passed."""
        if self.silent or not self.mechanism.grows(name):
            return
        if not isinstance(values, np.ndarray) or values.dtype != float:
            return
        text = assembly.unbounded_force_problem(self, name, values)
        if text:
            object.__setattr__(self, "silent", True)
            warnings.warn(text, ConditionWarning, stacklevel=3)
