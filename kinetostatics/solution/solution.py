"""What users hold: motion and forces of a scene, each computed by an engine when first asked for."""

import math
import warnings
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..engines.engines import NUMPY
from ..errors import ConditionWarning, ParameterError
from ..machine.links import Turning
from ..machine.loads import period_of
from ..mechanics import assembly
from ..mechanics.dynamics import Dynamics
from ..mechanics.motion import Motion
from ..mechanics.quantities import largest_term, resolved_names, values, without_bars
from ..numbers.arithmetic import read_only
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import construct_unchecked
from ..results.turn import Turn
from . import contents, slips
from .angles import crank_angles, hint_at_angles
from .certainty import Certainty
from .condition import condition, is_surely_well_conditioned, warn_of_lost_digits
from .contacts import Contacts
from .drive_and_loads import drive_and_loads_text, tables_over_angles
from .energies import Energies
from .explained import Explained

MAX_VALUES_TOGETHER = 100_000
"""Values over designs and angles up to which all forces are computed together."""


@dataclass(frozen=True, eq=False)
class Solution(Certainty, Energies, Contacts, Explained, Motion):
    """Motion and forces of a mechanism; every result is computed when first asked for, and kept.

    The balancing torque is the torque on the crank that keeps the prescribed motion, counter-clockwise positive.
    """

    __doc__ = contents.__doc__

    engine: Any = NUMPY
    silent: bool = field(default=False, repr=False)

    @cached_property
    def first_look(self):
        """Sum of all lengths over the shortest, and whether hints may be due; None unless all numbers are plain."""
        _, leaves = self.apart
        look = self.kind.answer(slips.scene_plausibility_test) if leaves.are_plain and not leaves.parts else None
        return look and look(leaves.numbers)

    @property
    def proportion(self):
        return self.first_look[0] if self.first_look else self.mechanism.proportion

    def check(self):
        """Raise `AssemblyError` where the mechanism does not close; warn where half of the digits are lost."""
        if not is_surely_well_conditioned(self, self._found("closure")):
            warn_of_lost_digits(self.dynamics, assembly.check(self.dynamics))

    def warn(self):
        """Warn where half of the digits are lost; where the mechanism does not close there are none."""
        warn_of_lost_digits(self.dynamics, self.dynamics.closure)

    def __repr__(self):
        return f"<Solution: {self.mechanism.name}, shape {self.shape}, {drive_and_loads_text(self)}>"

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
        """Crank angle after which motion and loads repeat, rad: what extremes, means and tables run over."""
        return period_of(self.loads, self.mechanism.turns)

    @cached_property
    def sampled(self):
        """The solution over its period as extremes and means look at it (`turn.Turn`), whatever its crank angles."""
        return Turn.of(self)

    @cached_property
    def sampled_for_forces(self):
        """The same with change points that are passed as limit positions: reactions grow there."""
        return Turn.of(replace(self, silent=True), forces=True) if self.mechanism.passes else self.sampled

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
    def guide_force(self):
        """Force of the guide on the slider along the guide's left normal, N."""
        return self.scalar("guide_force")

    @property
    def guide_moment(self):
        """Moment of the guide on the slider about the slider pin, N m."""
        return self.scalar("guide_moment")

    def pin_load(self, joint):
        """Force on a pin by all rods on it together, (2, ..., N), N; on the link that owns the joint."""
        owner = self._look_up("joint", joint, self.mechanism.joints).link
        total = np.zeros((2, *self.shape))
        for name, pair in self.mechanism.pairs.items():
            if isinstance(pair, Turning) and pair.joint == joint:
                total = total + (1.0 if pair.link == owner else -1.0) * self.reaction(name)
        return total

    @property
    def cam_force(self):
        """Force of the cam on the roller along the normal, positive toward the inside of the pitch curve, N."""
        return self.scalar("cam_force")

    @property
    def slot_force(self):
        """Force of the slotted crank on the block across the ray, positive with growing crank angle, N."""
        return self.scalar("slot_force")

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
        """Largest torque that one load alone would take, N m: what the balancing torque is a sum of."""
        return self.dynamics.largest_torque_term

    @property
    def largest_force_term(self):
        """Largest load on one link, weight, inertia or applied, N: what a reaction is a sum of."""
        return self.dynamics.largest_force_term

    @property
    def shaking_force(self):
        """Force of the inertia of all moving masses on the frame, (2, ..., N), N."""
        return self._found("shaking_force")

    @property
    def shaking_moment(self):
        """Moment about O of the inertia of all moving masses on the frame, (..., N), N m."""
        return self._found("shaking_moment")

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
    def pressure_angle(self):
        """Pressure angle of the cam pair, atan(r'/r), (..., N), rad."""
        return self.measure("pressure_angle")

    @cached_property
    def condition(self):
        """How many times relative errors of lengths, rounding among them, are magnified in rates and forces, (..., N).

        A bound of the true magnification: the sum over all lengths and the crank angle p of ``|p dq/dp|``, over the
        largest term of q, worst of rates, reactions and torque (`solution.condition`). Below 1e3 where nothing is lost,
        infinite at a limit position, toggle or change point, NaN where the mechanism does not close; a result has about
        16 - log10(condition) correct digits of its largest term, or more.

        Where change points are passed ("open", "crossed") it is of motion and torque alone, which are ordinary there;
        `condition_of` tells it of a reaction.

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

        Of a vector that is its magnitude, "O" as "|O|".

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

    def frame(self):
        """All results as a pandas DataFrame, one row for each crank angle (and design), units in the column names."""
        from .frame import solution_frame

        return solution_frame(self)

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
    def closed(self):
        """Whether the mechanism closes at each angle."""
        return self.dynamics.closed

    @property
    def placement(self):
        """Joints and links by name, as kinematic coefficients."""
        return self.dynamics.placement

    @cached_property
    def _values(self):
        return {}

    @property
    def is_given(self):
        """Whether nothing of it is code of the user's, which may be wrong and is to be told when it is asked."""
        return self.mechanism.trusted and self.loads_are_given

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

    def _force(self, kind, name, vector):
        """A force by name; all are computed together if they are not too many."""
        if isinstance(name, str) and name in self._values:
            return self._values[name]
        self._look_up(kind, name, dict.fromkeys(self.reactions if vector else self.scalars))
        return self._found(name)

    def _found(self, name):
        if name not in self._values:
            if not self.mechanism.trusted and name in self.mechanism.outputs:
                self.dynamics.resolved  # noqa: B018  warns if forces of a group of the user's own lose power
            of_all = self.is_given if name == "closure" else name in resolved_names(self)
            together = of_all and math.prod(self.shape) <= MAX_VALUES_TOGETHER
            self._values.update(self.engine.values(self.dynamics, None if together else (name,)))
        return self._values[name]
