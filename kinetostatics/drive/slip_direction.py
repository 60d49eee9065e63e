"""Senses of motion of joints with friction over the crank angle; friction jumps where one changes."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..cycle.kinks import FINE_SAMPLES
from ..machine.links import Rolling
from ..machine.loads import TURN
from ..mechanics.friction import pair_rate
from ..numbers.sign_changes import sign_changes

ANGLE_TOLERANCE = 1e-12
"""Crank angles nearer than this to an end of the period, rad, count as 0."""


@dataclass(frozen=True, eq=False)
class SlipDirections:
    """Sign of the sliding speed of each joint with friction as the crank turns forward.

    Attributes
    ----------
    period : float
    edges : dict of joint to array
        Crank angles in [0, period) at which the sign changes, rising.
    signs : dict of joint to array
        Signs before the first edge, between neighbouring edges, and after the last one.
    rates : function
        From crank angles to the rates, by the crank angle, of the non-rolling joints in `edges`, in order.
    """

    period: float
    edges: dict[str, np.ndarray]
    signs: dict[str, np.ndarray]
    rates: Any

    @classmethod
    def of(cls, scene):
        """Slip directions of a scene with friction."""
        mechanism, period = scene.mechanism, scene.period
        acting, parts = scene.friction.acting, (*mechanism.groups, mechanism.crank)
        moving = [
            (part, name, mechanism.pairs[name])
            for part in parts
            for name in part.pairs
            if name in acting and not isinstance(mechanism.pairs[name], Rolling)
        ]

        def rates(angle):
            placement = scene.unsolved(np.asarray(angle, dtype=float)).placement
            found = (pair_rate(part, name, pair, placement) for part, name, pair in moving)
            return [1.0 if rate is None else rate for rate in found]

        changes = sign_changes(rates, period, FINE_SAMPLES * round(period / TURN))
        row, angle = changes.row[0], changes.angle[0]
        angle = np.where((angle < ANGLE_TOLERANCE) | (angle > period - ANGLE_TOLERANCE), 0.0, angle)
        edges = {name: np.unique(angle[row == place]) for place, (_, name, _) in enumerate(moving)}
        signs = {}
        for place, (name, own) in enumerate(edges.items()):
            middle = 0.5 * (np.append(0.0, own) + np.append(own, period))
            with np.errstate(all="ignore"):
                rate = np.broadcast_to(rates(middle)[place], middle.shape)
            signs[name] = np.copysign(1.0, rate)
        rolling = dict.fromkeys((name for name in acting if name not in edges), np.empty(0))
        return cls(period, edges | rolling, signs | dict.fromkeys(rolling, np.ones(1)), rates)

    @cached_property
    def all_edges(self):
        """Crank angles in [0, period) at which any sign changes, rising."""
        return np.unique(np.concatenate(list(self.edges.values())))

    def at(self, angle, direction):
        """Signs of the motion at crank angles, the crank turning forward (+1) or backward (-1).

        Keys are the parameter names of a scene's program: "sense" of the crank, "friction.JOINT.sense".
        """
        inside = np.mod(angle, self.period)
        found = {
            f"friction.{name}.sense": direction * self.signs[name][np.searchsorted(edges, inside, side="right")]
            for name, edges in self.edges.items()
        }
        own = np.append(self.all_edges, self.period)
        place = np.searchsorted(own, inside)
        close = np.minimum(np.abs(inside - own[np.minimum(place, own.size - 1)]), np.abs(inside - own[place - 1]))
        if np.any(close < ANGLE_TOLERANCE) and self.all_edges.size:
            for name, rate in zip(found, self.rates(angle), strict=False):
                found[name] = np.where(close < ANGLE_TOLERANCE, direction * np.copysign(1.0, rate), found[name])
        return found | {"sense": np.broadcast_to(direction, inside.shape)}
