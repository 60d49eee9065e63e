"""Mean powers of a machine over its period: friction by joint, dampers, loads, drive; mechanical efficiency.

Over a period, masses, weight and springs return all the energy that they store. The power put in by the drive and other
loads is taken out by them or lost:

    given = taken + lost        efficiency = taken / given = taken / (taken + lost)

(Artobolevskii, *Theory of Mechanisms and Machines*: the work of the useful resistances over that of the driving forces,
in a period of steady motion.) The sign of the work over the whole period decides whether the drive or a load gives or
takes power. An engine's gas force gives and its drive takes; in a pump it is the reverse. An idling machine has the
efficiency 0, and so has a machine in which load and drive both give, for example where friction holds a weight that is
let down.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from operator import methodcaller
from typing import Any

import numpy as np

from ..errors import ConditionWarning, ParameterError
from ..machine.loads import TURN
from ..mechanics.energy_contact import work_of
from ..mechanics.load_values import numbered_titles
from ..numbers.lazy import cached_property
from ..numbers.planar import number_or_zero
from .extremes import extrema, largest_of
from .load_functions import resolution_note, with_resolution
from .means import TERM_ROUNDING, WARNING_ERROR, closed_turn, means
from .rounding import PLACED, zeroed

POWER_TOLERANCE = 1e-12
"""Mean power, relative to the largest power, that counts as 0."""


@dataclass(frozen=True, eq=False)
class Losses:
    """Mean powers over time of one design over its period, W; `losses` returns them.

    Attributes
    ----------
    solution : Solution
    friction : dict of str to float
        Power lost, by joint.
    dampers : dict of str to float
        Power lost, by damper.
    loads : dict of str to float
        Power taken by each load except dampers, weight and springs; negative if the load gives power.
    drive : float
        Power given by the drive; negative if it takes power, as in an engine.
    turn_time : float
        Duration of a turn of the crank, s.
    powers : dict of str to function
        By joint and damper: from a solution to the power lost over its crank angles.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> pressing = ks.ProcessForce(ks.Table([0.15, 0.25], [0.0, 0.0], over="travel", back=[1000.0, 1000.0]))
    >>> friction = {"O": ks.PinFriction(0.05, 0.02), "guide": ks.GuideFriction(0.1)}
    >>> s = ks.solve(pump, 0.0, crank_speed=30.0, loads=pressing, friction=friction)
    >>> found = s.losses
    >>> print(f"{found.drive:.1f} W in, {found.taken:.1f} W out, {found.friction['O']:.1f} W lost at O")
    503.4 W in, 477.5 W out, 15.9 W lost at O
    >>> print(f"{s.efficiency:.4f}")
    0.9485
    """

    solution: Any = field(repr=False)
    friction: dict[str, float]
    dampers: dict[str, float]
    loads: dict[str, float]
    drive: float
    turn_time: float
    powers: dict[str, Callable[[Any], Any]]

    @property
    def lost(self):
        """Power lost, by joint and damper, W."""
        return self.friction | self.dampers

    @property
    def total(self):
        """Power lost by friction and dampers, W."""
        return sum(self.lost.values())

    @property
    def given(self):
        """Power put in by the drive and the loads that give power, W."""
        return sum(power for power in self._ports if power > 0)

    @property
    def taken(self):
        """Useful power, W: taken out by loads, and by the drive if its power is negative."""
        return -sum(power for power in self._ports if power < 0)

    @property
    def efficiency(self):
        """Mechanical efficiency, taken / (taken + lost); NaN without power."""
        whole = self.taken + self.total
        return self.taken / whole if whole > 0 else np.nan

    @property
    def _ports(self):
        return [self.drive, *(-power for power in self.loads.values())]

    @cached_property
    def peaks(self):
        """Largest power lost, W, with its crank angle, rad, by joint and damper, and of "all" together."""
        found = {name: largest_of(extrema(self.solution, power)) for name, power in self.powers.items()}
        return found | {"all": largest_of(extrema(self.solution, self.power))}

    def frame(self):
        """Losses by joint and damper, a pandas DataFrame: mean, share, largest and its crank angle, energy per turn."""
        import pandas as pd

        mean = np.array([*self.lost.values(), self.total])
        names = [*self.lost, "all"]
        largest, angle = np.transpose([self.peaks[name] for name in names])
        degrees = np.degrees(zeroed(angle, PLACED))
        with np.errstate(invalid="ignore"):
            share = 100.0 * mean / self.total
        columns = {"mean [W]": mean, "share [%]": share, "largest [W]": largest, "largest at [deg]": degrees}
        columns |= {"per turn [J]": mean * self.turn_time}
        return with_resolution(pd.DataFrame(columns, pd.Index(names, name="lost at")), self.solution)

    def power(self, at):
        """Power lost by friction and dampers at the crank angles of a solution, W."""
        return sum((power(at) for power in self.powers.values()), np.zeros(at.crank_angle.shape))

    def __str__(self):
        if np.isnan(self.efficiency):
            return "no power is taken or lost"
        return (
            f"of {self.taken + self.total:.6g} W put in, {self.taken:.6g} W is used and {self.total:.6g} W lost: "
            f"efficiency {self.efficiency:.6g}"
        )

    def __repr__(self):
        return f"<Losses: {'; '.join(filter(None, [str(self), resolution_note(self.solution)]))}>"


def lose(*solutions):
    """Whether losses can be shown: a machine has friction, and all machines turn."""
    return any(s.friction for s in solutions) and all(np.all(np.asarray(s.crank_speed)) for s in solutions)


def losses(solution) -> Losses:
    """Mean powers of a machine over the period of a solution: put in, taken out and lost.

    They are integrals of Chebyshev series between the crank angles where friction jumps or has a kink (`means`).

    Parameters
    ----------
    solution : Solution
        Of one design; its own crank angles do not matter.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, does not close all round, or its crank stands still.
    JammingError
        Friction jams somewhere in the turn.

    Warns
    -----
    ConditionWarning
        A load is too uneven for full accuracy; the message gives the error.
    """
    turn = closed_turn(solution, "losses")
    at = turn.at.moved_to(turn.angle[turn.usable])
    if not np.all(np.asarray(at.crank_speed)):
        raise ParameterError("losses: the crank stands still, so no power flows; give a crank_speed")
    own = [item for item in solution.loads if not hasattr(item, "potential")]
    items = dict(zip(numbered_titles(own), own, strict=True))
    dampers = {name: item for name, item in items.items() if getattr(item, "DISSIPATES", False)}
    loads = {name: item for name, item in items.items() if name not in dampers}
    lost: dict[str, Any] = {joint: methodcaller("friction_loss_at", joint) for joint in solution.friction}
    lost |= {name: partial(_taken, item) for name, item in dampers.items()}
    powers = [*lost.values(), *(partial(_taken, item) for item in loads.values())]

    def by_angle(angle):
        there = turn.at.moved_to(turn.clear(angle))
        speed = np.broadcast_to(np.abs(there.crank_speed), angle.shape)
        drive = there.crank_speed * there.balancing_torque
        return np.array([np.ones(angle.shape), drive, *(power(there) for power in powers)]) / speed

    sizes = np.abs(by_angle(turn.angle)).max(axis=-1)
    floor = TERM_ROUNDING * np.array([sizes[0], *[max(at.largest_torque_term, *sizes[1:])] * (1 + len(powers))])
    found, errors, *_ = means(by_angle, turn, floor)
    if np.any(errors > WARNING_ERROR * sizes + floor):
        error = np.max(errors[1:]) / found[0]
        text = f"losses: powers are accurate only to about {error:.2g} W, because the loads are uneven"
        warnings.warn(text, ConditionWarning, stacklevel=3)
    drive, *rest = np.where(np.abs(found) <= POWER_TOLERANCE * sizes, 0.0, found)[1:] / found[0]
    mean = dict(zip((*lost, *loads), map(float, rest), strict=True))
    return Losses(
        solution,
        {name: mean[name] for name in solution.friction},
        {name: mean[name] for name in dampers},
        {name: mean[name] for name in loads},
        float(drive),
        TURN * float(found[0]),
        lost,
    )


def _taken(item, at):
    """Power that a load takes, W."""
    return np.broadcast_to(-at.crank_speed * number_or_zero(work_of(item, at)), at.crank_angle.shape)
