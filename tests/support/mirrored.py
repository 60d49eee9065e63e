"""The mirror image of a scene in the x axis, y -> -y, made of public names alone, and the signs its results have.

A mirrored machine moves at each instant as the mirror image of the machine: crank angles, angles, offsets to the left
and moments change sign; lengths, coordinates along guides and links, forces along links, powers and energies stay.
"""

from dataclasses import dataclass, fields, replace
from functools import singledispatch
from typing import Any

import numpy as np

import kinetostatics as ks

TURN = 2 * np.pi
ODD_UNITS = ("N m", "rad", "rad/s", "rad/s2")
"""Units of what turns: it changes its sign."""
ODD_NAMES = ("guide_force", "slot_force", "cylinder_force", "contact_place", "cam_friction", "reduced_inertia_slope")
"""What counts along a left normal or with the crank angle, which the mirror turns round, whatever its unit."""


def negated(value):
    """The negative of a number or array; 0 stays +0."""
    return 0.0 - np.asarray(value, dtype=float) if np.ndim(value) else 0.0 - value


def across(pair):
    """A place (along, across) or (x, y) in the mirror."""
    return pair[0], negated(pair[1])


def at_point(point):
    """A point of a load in the mirror: a joint, a place on a link, or a fixed point."""
    if isinstance(point, str):
        return point
    return (*point[:-1], negated(point[-1]))


@singledispatch
def mirrored(item) -> Any:
    """The mirror image of a scene or of anything that a scene is made of."""
    raise TypeError(f"no mirror image is known of {item!r}")


@mirrored.register(ks.Scene)
def _(scene):
    return ks.Scene(
        mirrored(scene.mechanism),
        negated(scene.crank_speed),
        negated(scene.crank_acceleration),
        tuple(map(mirrored, scene.loads)),
        dict(scene.friction),
        sense=None if scene.sense is None else negated(scene.sense),
    )


@mirrored.register(ks.Mechanism)
def _(mechanism):
    crank = replace(mechanism.crank, link=mirrored(mechanism.crank.link))
    return ks.Mechanism(mechanism.name, crank, tuple(map(mirrored, mechanism.groups)))


@mirrored.register(ks.Link)
def _(link):
    return replace(link, centre=across(link.centre))


@mirrored.register(ks.Guide)
def _(guide):
    angle, exact = (None, across(guide.exact)) if guide.angle is None else (negated(guide.angle), None)
    return replace(guide, angle=angle, guide_offset=negated(guide.guide_offset), exact=exact)


# Groups


def with_mirrored_links(group, **changes):
    """A group with the mirror images of its links, and these fields changed."""
    links = {
        field.name: mirrored(getattr(group, field.name))
        for field in fields(group)
        if isinstance(getattr(group, field.name), ks.Link)
    }
    return replace(group, **links, **changes)


def other_branch(group):
    """Assembly of a group that passes one change point a turn: in the half turn before it is on the other branch."""
    if group.turns == 1 or not isinstance(group.assembly, str):
        return group.assembly
    return {"open": "crossed", "crossed": "open"}[group.assembly]


def other_side(assembly):
    """An assembly that is named by the side on which something lies: left is right in the mirror."""
    return assembly if isinstance(assembly, str) else -assembly


@mirrored.register(ks.SliderGroup)
def _(group):
    return with_mirrored_links(group, guide=mirrored(group.guide))


@mirrored.register(ks.YokeGroup)
def _(group):
    return with_mirrored_links(group, guide=mirrored(group.guide), slot_angle=negated(group.slot_angle))


@mirrored.register(ks.RockerGroup)
def _(group):
    return with_mirrored_links(group, pivot=across(group.pivot), assembly=other_side(group.assembly))


@mirrored.register(ks.Dyad)
def _(group):
    return with_mirrored_links(group, assembly=other_side(group.assembly))


@mirrored.register(ks.LeverGroup)
def _(group):
    pivot, offset = across(group.pivot), negated(group.offset)
    return with_mirrored_links(group, pivot=pivot, offset=offset, assembly=other_branch(group))


@mirrored.register(ks.CylinderGroup)
def _(group):
    return with_mirrored_links(group, pivot=across(group.pivot))


@mirrored.register(ks.Pin)
def _(pin):
    return replace(pin, at=across(pin.at))


@mirrored.register(ks.CamRoller)
def _(group):
    return with_mirrored_links(group, cam=mirrored(group.cam))


@mirrored.register(ks.RollerFollower)
@mirrored.register(ks.FlatFollower)
def _(group):
    return with_mirrored_links(group, guide=mirrored(group.guide), cam=reversed_law(group.cam.law))


@mirrored.register(ks.SwingingFollower)
def _(group):
    pivot, assembly = across(group.pivot), other_side(group.assembly)
    return with_mirrored_links(group, pivot=pivot, assembly=assembly, cam=reversed_law(group.cam.law))


# Cams and laws


@mirrored.register(ks.cams.Circle)
def _(cam):
    return ks.cams.Circle(cam.pitch_radius, across(cam.centre))


@mirrored.register(ks.cams.CosineLaw)
def _(cam):
    return ks.cams.CosineLaw(cam.amplitude, cam.mean, negated(cam.guide_angle))


@mirrored.register(ks.cams.Harmonic)
def _(cam):
    return ks.cams.Harmonic(cam.cosine, tuple(map(negated, cam.sine)), negated(cam.guide_angle))


@mirrored.register(ks.cams.Sampled)
def _(cam):
    return ks.cams.Sampled(*reversed_rows(cam.angle, cam.samples))


@mirrored.register(ks.cams.LawCam)
def _(cam):
    law = reversed_law(cam.law)
    return ks.cams.from_law(law, None, guide_angle=negated(cam.guide_angle), guide_offset=negated(cam.guide_offset))


def reversed_rows(angle, *values, period=TURN):
    """Rows of tables over the angle in the mirror: angles from 0 up to the period."""
    angle = np.mod(-np.asarray(angle), period)
    order = np.argsort(angle)
    return angle[order], *(np.asarray(row)[order] for row in values)


@dataclass(frozen=True)
class ReversedLaw:
    """A law of the crank angle as the mirrored cam has it: the position at -phi, with its derivatives by phi."""

    law: Any

    @property
    def knots(self):
        """Crank angles at which the jerk may jump, rad."""
        return tuple(np.mod(-np.array(getattr(self.law, "knots", ()), dtype=float), TURN).tolist())

    def __call__(self, phi):
        """Position and three derivatives, as a law gives them."""
        found = self.law(-np.asarray(phi, dtype=float))
        return tuple(sign * part for sign, part in zip((1.0, -1.0, 1.0, -1.0), found, strict=True))


def reversed_law(law):
    """The mirror image of a law; twice that is the law itself."""
    return law.law if isinstance(law, ReversedLaw) else ReversedLaw(law)


# Loads


@dataclass(frozen=True)
class _Reflection:
    """A motion as it is seen in the mirror, for functions that loads have as values."""

    motion: Any

    def __getattr__(self, name):
        return getattr(self.motion, name)

    @property
    def crank_angle(self):
        return -self.motion.crank_angle

    @property
    def crank_speed(self):
        return -self.motion.crank_speed

    def rate(self, link):
        return -self.motion.rate(link)

    def position(self, point):
        return self._reflected(self.motion.position(at_point(point)))

    def velocity(self, point):
        return self._reflected(self.motion.velocity(at_point(point)))

    @staticmethod
    def _reflected(vector):
        return vector[0], -vector[1]


@dataclass(frozen=True)
class ReflectedFunction:
    """A function of the motion in the mirror, with the sign that its value has there."""

    function: Any
    sign: float

    def __call__(self, motion):
        """Value of the load in the mirror."""
        return self.sign * self.function(_Reflection(motion))


def reflected_value(value, sign=1.0):
    """The value of a load in the mirror: a number, an array by crank angle, a table or a function of the motion."""
    if isinstance(value, ks.Table):
        return reflected_table(value, sign)
    if callable(value):
        return ReflectedFunction(value, sign)
    return value if sign > 0 else negated(value)


def reflected_table(table, sign=1.0):
    """A table over the angle runs backwards; over travel it stays, for the slider takes the same way at each time."""
    if table.over == "angle":
        x, y = reversed_rows(table.x, table.y, period=table.period)
        return ks.Table(x, sign * y, period=table.period)
    back = None if table.back is None else sign * table.back
    return ks.Table(table.x, sign * table.y, over="travel", back=back, slider=table.slider)


@mirrored.register(ks.Gravity)
def _(load):
    return replace(load, direction=negated(load.direction))


@mirrored.register(ks.Spring)
@mirrored.register(ks.TorsionDamper)
def _(load):
    return load


@mirrored.register(ks.ProcessForce)
def _(load):
    return replace(load, force=reflected_value(load.force))


@mirrored.register(ks.Force)
def _(load):
    return replace(load, value=reflected_value(load.value), at=at_point(load.at), direction=negated(load.direction))


@mirrored.register(ks.PointForce)
def _(load):
    return replace(load, value=reflected_value(load.value), between=tuple(map(at_point, load.between)))


@mirrored.register(ks.PointSpring)
@mirrored.register(ks.PointDamper)
def _(load):
    return replace(load, between=tuple(map(at_point, load.between)))


@mirrored.register(ks.Torque)
def _(load):
    return replace(load, value=reflected_value(load.value, -1.0))


@mirrored.register(ks.TorsionSpring)
def _(load):
    return replace(load, free_angle=negated(load.free_angle), moment=negated(load.moment))


# Drives and counterweights


@mirrored.register(ks.drive.Motor)
def _(motor):
    """The motor turns the crank the other way."""
    return replace(motor, transmission=-motor.transmission)


@mirrored.register(ks.Counterweight)
def _(weight):
    return weight


# Results


def sign_of(name, unit):
    """Sign, +1 or -1, that a quantity has in the mirror, by its name and unit."""
    if name.endswith("_x"):
        return 1.0
    if name.endswith("_y"):
        return -1.0
    return -1.0 if unit in ODD_UNITS or (name.startswith(ODD_NAMES) and unit != "W") else 1.0


def values_of(solution):
    """Every quantity of a solution by name, with its unit: arrays over the crank angles."""
    table = solution.frame()
    found = {}
    for heading in table.columns:
        name, unit = heading.rstrip("]").split(" [")
        if name not in ("crank_angle", "design", "friction_residual"):
            found[name] = (table[heading].to_numpy(), unit)
    for name, unit in ENERGIES.items():
        found[name] = (np.array(getattr(solution, name)), unit)
    return found


ENERGIES = {
    "reduced_inertia": "kg m2",
    "reduced_inertia_slope": "kg m2",
    "kinetic_energy": "J",
    "potential_energy": "J",
    "load_torque": "N m",
}


def differences(solution, image, without_sign=()):
    """How far the values of a mirrored solution are from those expected, relative to the largest value of their unit.

    Parameters
    ----------
    solution, image : Solution
        Of a scene at crank angles, and of its mirror image at the negative angles.
    without_sign : sequence of str
        Quantities that count without sign though their unit has one.
    """
    before, after = values_of(solution), values_of(image)
    assert before.keys() == after.keys()
    largest = {}
    for values, unit in before.values():
        largest[unit] = max(largest.get(unit, 0.0), float(np.max(np.abs(values), initial=0.0)))
    found = {}
    for name, (values, unit) in before.items():
        sign = 1.0 if name in without_sign else sign_of(name, unit)
        error = float(np.max(np.abs(after[name][0] - sign * values)))
        found[name] = error / largest[unit] if largest[unit] else error
    return found
