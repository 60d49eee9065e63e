"""Free body of a link: every force and couple on it with its point; including inertia they are in equilibrium.

    sum F = 0        sum (r x F + C) = 0

Reactions are the forces of pairs (`pair_forces`). A reaction acts on the `link` of its pair, and its opposite on the
other link (`machine.links.Turning`, `Sliding`). Inertia (d'Alembert: -m a at the mass centre and -I alpha) and weight
are those of `Dynamics`; loads give their forces or wrenches.
"""

from typing import Any, NamedTuple

import numpy as np

from ..errors import QuantityError
from ..machine.group import CRANK
from ..machine.loads import Gravity, balance_shafts
from ..machine.loads.points import PlacedLoad, point_on_link
from ..machine.supports import pairs_of
from ..numbers import checks
from ..numbers.planar import cross, minus, product, scale_vector
from .ground import pair_forces
from .load_values import evaluate_load, numbered_titles, slider_push

REACTION, INERTIA, WEIGHT, LOAD, DRIVE = "reaction", "inertia", "weight", "load", "drive"
"""Kinds of actions on a link."""
MAX_IMBALANCE = 1e-6
"""Largest sum of the forces on a link with a user's own group, relative to the largest of them."""


class Action(NamedTuple):
    """Force and couple on a link by one cause.

    Attributes
    ----------
    name : str
        "A", "guide", "inertia", "weight", title of a load, "balancing torque".
    kind : str
        "reaction", "inertia", "weight", "load" or "drive".
    point, force : array (2, ..., N)
        m, N.
    couple : array (..., N)
        N m, counter-clockwise.
    """

    name: str
    kind: str
    point: Any
    force: Any
    couple: Any

    def moment(self, about=(0.0, 0.0)):
        """Moment about a point, (..., N), N m."""
        return cross((self.point[0] - about[0], self.point[1] - about[1]), self.force) + self.couple


def free_body(dynamics, link) -> tuple[Action, ...]:
    """All actions on a link of a scene at its crank angles; their forces and moments add up to zero.

    `QuantityError` for an unknown link, `ParameterError` for pairs of a user's group that do not balance it.
    """
    links = dynamics.mechanism.links
    if not isinstance(link, str) or link not in links:
        raise QuantityError(checks.choice(f"{dynamics.mechanism.name}: link", link, tuple(links)))
    with np.errstate(all="ignore"):
        found = [*_reactions(dynamics, link), *_masses(dynamics, link), *_loads(dynamics, link)]
        if link == CRANK:
            found.append(("balancing torque", DRIVE, None, None, dynamics.resolved.scalars["balancing_torque"]))
        actions = tuple(
            Action(name, kind, dynamics.as_vector(point), dynamics.as_vector(force), dynamics._scalar(couple))
            for name, kind, point, force, couple in found
        )
    if not dynamics.mechanism.trusted:
        _require_balance(dynamics, link, actions)
    return actions


def _require_balance(dynamics, link, actions):
    """Refuse forces that are not in equilibrium, as from a user's group with undeclared pairs."""
    sums = [np.sum([item.force for item in actions], axis=0), np.sum([item.moment() for item in actions], axis=0)]
    sizes = [np.abs([item.force for item in actions]), np.abs([item.moment() for item in actions])]
    lost = [np.max(np.abs(part)) > MAX_IMBALANCE * np.max(size) for part, size in zip(sums, sizes, strict=True)]
    text = "its forces do not balance: a group of your own does not declare all its pairs with their forces"
    checks.require(f"free body of {link!r}", text if any(lost) else None)


def _reactions(dynamics, link):
    """Yield name, kind, point, force and couple of each reaction on a link."""
    for name, joining in pairs_of(dynamics.mechanism).items():
        if link in (joining.link, joining.against):
            for part, found in pair_forces(dynamics, name, joining).items():
                force, point, couple = found if link == joining.link else found.opposite()
                yield part, REACTION, point, force, couple


def _masses(dynamics, link):
    """Yield inertia force and couple, and weight, of a link with mass, and those of springs on a slider."""
    body, centre = dynamics.mechanism.links[link].body, dynamics.spot(link).position
    force, couple = dynamics.inertia[link].force, None
    if body.inertia is not None:
        couple = minus(None, body.inertia * dynamics.angular_acceleration(link))
    if force is not None or couple is not None:
        yield "inertia", INERTIA, centre, force, couple
    if body.mass is not None and dynamics.gravity is not None:
        yield "weight", WEIGHT, centre, scale_vector(body.mass, dynamics.gravity), None
    for item in balance_shafts(dynamics.loads) if link == CRANK else ():
        torque = minus(None, product(item.crank_inertia, dynamics.accelerating[1]))
        if torque is not None:
            yield f"inertia of {item.title}", INERTIA, centre, None, torque
    for name, wrench in dynamics.spring_loads:
        if name == link:
            origin = dynamics.placement.links[link].joint.position
            yield "inertia and weight of springs", INERTIA, origin, wrench.force, None


def _loads(dynamics, link):
    """Yield force and couple of each load on a link, at the point of the load."""
    loads = [item for item in dynamics.loads if not isinstance(item, Gravity)]
    origin = dynamics.placement.links[link].joint.position
    for title, item in zip(numbered_titles(loads), loads, strict=True):
        if hasattr(item, "push") and item.on == link:
            direction = tuple(dynamics.mechanism.guides[link].direction)
            yield title, LOAD, origin, scale_vector(slider_push(item, dynamics), direction), None
        if isinstance(item, PlacedLoad):
            for place, force in evaluate_load(item, dynamics).forces(dynamics):
                if point_on_link(dynamics.mechanism, place).link == link:
                    yield title, LOAD, dynamics.spot(place).position, force, None
        elif hasattr(item, "wrenches"):
            for name, (force, moment) in evaluate_load(item, dynamics).wrenches(dynamics):
                if name == link:
                    yield title, LOAD, dynamics.spot(link).position if force is None else origin, force, moment
