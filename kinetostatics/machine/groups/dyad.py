"""Dyad (RRR): two links from two moving joints to a pin between them, in either assembly.

Seen from the second joint it is a rocker group whose pivot stands still: the intersection of two circles, the ratios of
both links and all forces are those of `rocker`, of the motion of the first joint relative to the second.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...numbers import checks
from ...numbers.planar import add_vectors, subtract_vectors
from ..group import Bar, Declaration, Group, Point, Resolved, rules_of_parts, separation
from ..links import Joint, Link, Turning, Wrench
from . import rocker


class TwoJoints:
    """Rule of the two joints that a dyad hangs on."""

    rule = checks.Name()

    def quick(self, value):
        named = type(value) is tuple and len(value) == 2 and all(self.rule.quick(name) is name for name in value)
        return value if named and value[0] != value[1] else checks.UNDECIDED

    def check(self, value, field=""):
        if not isinstance(value, tuple | list) or len(value) != 2:
            return value, f"{field} must be the names of two joints, got {checks.shown(value)}"
        found = [self.rule.check(name, f"{field} {place}") for place, name in enumerate(value, 1)]
        problem = found[0][1] or found[1][1]
        if problem is None and value[0] == value[1]:
            problem = f"{field} must name two different joints, got {value[0]!r} twice"
        return tuple(name for name, _ in found), problem


def place(first, second, length1, length2, assembly):
    """Both links for given inner joints (kernel)."""
    passing = (subtract_vectors(first.first, second.first), subtract_vectors(first.second, second.second))
    seen = rocker.place(Joint(first.position, *passing), length1, length2, second.position, assembly)
    pin = Joint(
        seen.pin.position, add_vectors(seen.pin.first, second.first), add_vectors(seen.pin.second, second.second)
    )
    return seen._replace(coupler=seen.coupler._replace(joint=first), rocker=seen.rocker._replace(joint=second), pin=pin)


@dataclass(frozen=True, eq=False)
class Dyad(checks.Checked, Group):
    """Two links from the joints `on` to a joint `pin` that they share, as between two arms of a Watt chain.

    Parameters
    ----------
    length1, length2 : float or array
        From the first and from the second joint to the pin, m.
    on : (str, str)
        Names of the joints it hangs on, which may both move.
    pin : str
        Name of the joint it adds.
    assembly : +1 or -1
        +1: the pin to the left of the direction from the first joint to the second.
    dyad1, dyad2 : Link
        Reference joints are those they hang on, directions run from there to the pin.
    label : str
        Appended to the names of links and forces of a second dyad in one mechanism.

    Raises
    ------
    ParameterError
        A value no machine can have, or the same joint twice.

    Notes
    -----
    Reactions, vectors in N: "dyad1_B" on the first link from what carries B (the name of the joint it hangs on),
    "dyad2_C" on the second likewise, and `pin`, of the first link on the second.

    Examples
    --------
    Two cranks of one shaft, and a rod on each:

    >>> import kinetostatics as ks
    >>> parts = ks.Pin(on="crank", at=(0.0, 0.1), name="C"), ks.Dyad(0.3, 0.4, on=("A", "C"))
    >>> s = ks.solve(ks.Mechanism("rigid triangle", ks.Crank(0.1), parts), 0.0, crank_speed=10.0)
    >>> bool(abs(s.rate("dyad1") - 10.0) < 1e-12)
    True
    """

    length1: Any
    length2: Any
    on: Any = ("B", "C")
    pin: str = "D"
    assembly: int = 1
    dyad1: Link = Link()
    dyad2: Link = Link()
    label: str = ""

    LINKS: ClassVar = {"dyad1": "on", "dyad2": "on"}
    TRUSTED = is_rigid_triangle = True
    PATHS: ClassVar = {"length1": "dyad1_length", "length2": "dyad2_length"}
    RULES = checks.Rules(
        "dyad",
        length1=checks.Number("m", low=0.0, strict=True),
        length2=checks.Number("m", low=0.0, strict=True),
        on=TwoJoints(),
        assembly=checks.Sign(),
        **rules_of_parts(("dyad1", "dyad2"), "pin"),
    )

    @property
    def hangs_on(self):
        return self.on

    @property
    def names(self):
        return [*super().names, *self.on]

    @property
    def references(self):
        return dict(zip(self.links, self.on, strict=True))

    @property
    def declaration(self):
        first, second = self.on
        return Declaration(
            joints={self.pin: Point("dyad2", self.length2)},
            bars=(Bar(first, self.pin, "dyad1", self.length1), Bar(second, self.pin, "dyad2", self.length2)),
            pairs=(Turning("dyad1", first), Turning("dyad2", second), Turning("dyad2", self.pin, "dyad1")),
        )

    def place(self, placement):
        first, second = (placement.joints[name] for name in self.on)
        motion = place(first, second, self.length1, self.length2, self.assembly)
        self.enter(placement, motion, {self.pin: motion.pin})

    def follow(self, placement, joints):
        """Place both links at known joints."""
        pin, (first, second) = joints[self.pin], (placement.joints[name] for name in self.on)
        self.enter(placement, rocker.between(first, second, pin, self.length1, self.length2), {self.pin: pin})

    def closure(self, placement):
        """Squared sine of the angle between the links."""
        return self.placed(placement).closure

    def requirement(self, placement):
        low, high = abs(self.length1 - self.length2), self.length1 + self.length2
        return (
            f"{separation(placement, *self.on)} lie between the difference and the sum of the lengths of "
            f"{self.called('dyad1')} and {self.called('dyad2')}, {np.min(low):.6g} and {np.max(high):.6g} m"
        )

    def resolve(self, placement, loads, along) -> Resolved:
        first, pin, second = rocker.resolve(self.placed(placement), self.length1, self.length2, *self.of_links(loads))
        demands = {name: Wrench(force, None) for name, force in zip(self.on, (first, second), strict=True)}
        return self.resolved((first, second, pin), (), demands)
