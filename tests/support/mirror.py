"""Scenes mirrored in the x axis, and how their results compare."""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

import kinetostatics as ks
from kinetostatics.mechanics.quantities import ENERGIES

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


def mirrored(item) -> Any:
    """The mirror image of a scene or of anything that a scene is made of."""
    kind = next((kind for kind in type(item).__mro__ if kind in IMAGES), None)
    if kind is None:
        raise TypeError(f"no mirror image is known of {item!r}")
    return IMAGES[kind](item)


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
    if table.from_dead_centre:
        own = {"period": table.period, "slider": table.slider, "zero": table.zero, "sense": -table.sense}
        return ks.Table(table.sense * table.x, sign * table.y, **own)
    if table.over == "angle":
        x, y = reversed_rows(table.x, table.y, period=table.period)
        return ks.Table(x, sign * y, period=table.period, zero=table.zero)
    back = None if table.back is None else sign * table.back
    return ks.Table(table.x, sign * table.y, over="travel", back=back, slider=table.slider)


def _of_scene(scene):
    return ks.Scene(
        mirrored(scene.mechanism),
        negated(scene.crank_speed),
        negated(scene.crank_acceleration),
        tuple(map(mirrored, scene.loads)),
        dict(scene.friction),
        sense=None if scene.sense is None else negated(scene.sense),
    )


def _of_mechanism(mechanism):
    crank = replace(mechanism.crank, link=mirrored(mechanism.crank.link))
    return ks.Mechanism(mechanism.name, crank, tuple(map(mirrored, mechanism.groups)))


def _of_guide(guide):
    angle, exact = (None, across(guide.exact)) if guide.angle is None else (negated(guide.angle), None)
    return replace(guide, angle=angle, guide_offset=negated(guide.guide_offset), exact=exact)


def _of_lever(group):
    pivot, offset = across(group.pivot), negated(group.offset)
    return with_mirrored_links(group, pivot=pivot, offset=offset, assembly=other_branch(group))


def _of_guided_follower(group):
    return with_mirrored_links(group, guide=mirrored(group.guide), cam=reversed_law(group.cam.law))


def _of_swinging_follower(group):
    pivot, assembly = across(group.pivot), other_side(group.assembly)
    return with_mirrored_links(group, pivot=pivot, assembly=assembly, cam=reversed_law(group.cam.law))


def _of_law_cam(cam):
    law = reversed_law(cam.law)
    return ks.cams.from_law(law, None, guide_angle=negated(cam.guide_angle), guide_offset=negated(cam.guide_offset))


def _of_force(load):
    return replace(load, value=reflected_value(load.value), at=at_point(load.at), direction=negated(load.direction))


def _of_point_force(load):
    return replace(load, value=reflected_value(load.value), between=tuple(map(at_point, load.between)))


IMAGES: dict[type, Callable] = {
    ks.Scene: _of_scene,
    ks.Mechanism: _of_mechanism,
    ks.Link: lambda link: replace(link, centre=across(link.centre)),
    ks.Guide: _of_guide,
    ks.SliderGroup: lambda group: with_mirrored_links(group, guide=mirrored(group.guide)),
    ks.YokeGroup: lambda group: with_mirrored_links(
        group, guide=mirrored(group.guide), slot_angle=negated(group.slot_angle)
    ),
    ks.RockerGroup: lambda group: with_mirrored_links(
        group, pivot=across(group.pivot), assembly=other_side(group.assembly)
    ),
    ks.Dyad: lambda group: with_mirrored_links(group, assembly=other_side(group.assembly)),
    ks.LeverGroup: _of_lever,
    ks.CylinderGroup: lambda group: with_mirrored_links(group, pivot=across(group.pivot)),
    ks.Pin: lambda pin: replace(pin, at=across(pin.at)),
    ks.CamRoller: lambda group: with_mirrored_links(group, cam=mirrored(group.cam)),
    ks.RollerFollower: _of_guided_follower,
    ks.FlatFollower: _of_guided_follower,
    ks.SwingingFollower: _of_swinging_follower,
    ks.cams.Circle: lambda cam: ks.cams.Circle(cam.pitch_radius, across(cam.centre)),
    ks.cams.CosineLaw: lambda cam: ks.cams.CosineLaw(cam.amplitude, cam.mean, negated(cam.guide_angle)),
    ks.cams.Harmonic: lambda cam: ks.cams.Harmonic(cam.cosine, tuple(map(negated, cam.sine)), negated(cam.guide_angle)),
    ks.cams.Sampled: lambda cam: ks.cams.Sampled(*reversed_rows(cam.angle, cam.values)),
    ks.cams.LawCam: _of_law_cam,
    ks.Gravity: lambda load: replace(load, direction=negated(load.direction)),
    ks.Spring: lambda load: load,
    ks.GasSpring: lambda load: load,
    ks.BalanceShaft: lambda load: replace(load, phase=negated(load.phase), at=across(load.at)),
    ks.TorsionDamper: lambda load: load,
    ks.ProcessForce: lambda load: replace(load, force=reflected_value(load.force)),
    ks.Force: _of_force,
    ks.PointForce: _of_point_force,
    ks.PointSpring: lambda load: replace(load, between=tuple(map(at_point, load.between))),
    ks.PointDamper: lambda load: replace(load, between=tuple(map(at_point, load.between))),
    ks.Sawing: lambda load: replace(load, thrust=negated(load.thrust)),
    ks.Mowing: lambda load: load,
    ks.Torque: lambda load: load if load.opposing else replace(load, value=reflected_value(load.value, -1.0)),
    ks.TorsionSpring: lambda load: replace(load, free_angle=negated(load.free_angle), moment=negated(load.moment)),
    ks.drive.Motor: lambda motor: replace(motor, transmission=-motor.transmission),  # the crank turns the other way
    ks.Counterweight: lambda weight: weight,
}


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


ANGLES = np.array([-6.1, -2.9, -0.3, 0.4, 1.7, 2.6, 4.4, 5.9])
TIE = 1e-12
"""Share of a value by which two peaks of one height differ."""
REDUCTIONS = ("mean", "mean_absolute", "rms", "range", "largest_absolute", "swing", "harmonic_2")


def unsigned(scene):
    """Quantities that have no sign though their unit has one."""
    swinging = any(isinstance(group, ks.SwingingFollower) for group in scene.mechanism.groups)
    return ("pressure_angle",) if swinging else ()


def sign(scene, name, unit):
    return 1.0 if name in unsigned(scene) else sign_of(name, unit)


def relative(found, expected, scale=None):
    """Largest difference, relative to the largest value expected or to a scale; inf where one alone is no number."""
    found, expected = np.atleast_1d(found).astype(float), np.atleast_1d(expected).astype(float)
    if found.shape != expected.shape or not np.array_equal(np.isfinite(found), np.isfinite(expected)):
        return math.inf
    here = np.isfinite(expected)
    if not here.any():
        return 0.0
    scale = float(np.max(np.abs(expected[here]))) if scale is None else scale
    error = float(np.max(np.abs(found[here] - expected[here])))
    return error / scale if scale else error


def apart(found, expected, period=TURN):
    """Largest distance of crank angles, taken modulo the period, rad."""
    found, expected = np.atleast_1d(found).astype(float), np.atleast_1d(expected).astype(float)
    if found.shape != expected.shape:
        return math.inf
    distance = np.abs(np.mod(found - expected + period / 2, period) - period / 2)
    return float(np.max(distance, initial=0.0))


def solved(scene, angles=ANGLES):
    return differences(scene.solve(angles), mirrored(scene).solve(-angles), unsigned(scene))


def extremes(scene, names=("balancing_torque", "O", "shaking_moment")):
    """Values of extremes, and angles, rad."""
    found = {}
    before, after = (item.solve(12) for item in (scene, mirrored(scene)))
    for name in names:
        one, other = (ks.extremes(item, name) for item in (before, after))
        sense = sign(scene, name, "N m") if name.endswith(("torque", "moment")) else 1.0
        if len(one) != len(other):
            found[name] = math.inf
            continue
        if not len(one):
            found[name] = relative(other.constant, sense * one.constant)
            continue
        period, backwards = before.period, np.arange(len(one))[::-1]
        turns = [np.roll(backwards, shift) for shift in range(len(one))]
        order = min(turns, key=lambda order: apart(other.angle, -one.angle[order], period))
        found[name] = relative(other.value, sense * one.value[order])
        found[f"{name} at"] = apart(other.angle, -one.angle[order], period)
        maximum = one.maximum[order]
        found[f"{name} which"] = float(np.any(other.maximum != (maximum if sense > 0 else ~maximum)))
    return found


def largest(scene, names=("balancing_torque", "O", "shaking_moment")):
    """Largest and smallest values alone."""
    found = {}
    before, after = (item.solve(12) for item in (scene, mirrored(scene)))
    for name in names:
        one, other = (ks.extremes(item, name) for item in (before, after))
        sense = sign(scene, name, "N m") if name.endswith(("torque", "moment")) else 1.0
        found[name] = relative(sorted(other.range), sorted(sense * end for end in one.range))
    return found


def means(scene):
    """Energy of a turn, and mean powers by joint, damper and load."""
    one, other = (item.solve(12) for item in (scene, mirrored(scene)))
    size = max(abs(one.energy_per_turn), float(np.max(np.abs(one.at(ANGLES).balancing_torque))))
    found = {"energy_per_turn": relative(other.energy_per_turn, one.energy_per_turn, size)}
    if np.any(scene.crank_speed):
        power = size * abs(scene.crank_speed)
        for kind in ("friction", "dampers", "loads"):
            before, after = (list(getattr(item.losses, kind).values()) for item in (one, other))
            found[kind] = relative(after, before, power)
        found["drive"] = relative(other.losses.drive, one.losses.drive, power)
    return found


def swept(scene, path="crank_speed", quantities=("balancing_torque", "O"), engine="numpy"):
    """Reductions of a sweep over the crank speed."""
    import pandas as pd

    values = np.asarray(scene.crank_speed) * np.array([0.7, 1.0, 1.3])
    opposite = {"largest": "smallest", "smallest": "largest", "largest_at": "smallest_at", "smallest_at": "largest_at"}
    asked = [
        (reduction, name)
        for name in quantities
        for reduction in (*REDUCTIONS, *opposite)
        if reduction != "swing" or name.endswith("torque")
    ]
    outputs = [" ".join(pair) for pair in asked]
    one = ks.sweep(scene, pd.DataFrame({path: values}), outputs, engine=engine, progress=False)
    other = ks.sweep(mirrored(scene), pd.DataFrame({path: -values}), outputs, engine=engine, progress=False)
    found = {"failed": float(np.any(one["failed"] != other["failed"]))}
    column = {heading.split(" [")[0]: heading for heading in one.columns}
    for reduction, name in asked:
        odd = name.endswith(("torque", "moment"))
        twin = opposite.get(reduction, reduction) if odd else reduction
        before, after = one[column[f"{reduction} {name}"]].to_numpy(), other[column[f"{twin} {name}"]].to_numpy()
        if reduction.endswith("_at"):
            pairs = zip(values, after, before, strict=True)
            places = [
                0.0 if alike(scene.varied({path: at}), name, -one, other) else one + other for at, one, other in pairs
            ]
            found[f"{reduction} {name}"] = apart(np.array(places), np.zeros(len(places)), scene.period)
        else:
            turned = -1.0 if odd and reduction in ("mean", "largest", "smallest") else 1.0
            scale = np.max(np.abs(one[column[f"largest_absolute {name}"]]))
            found[f"{reduction} {name}"] = relative(after, turned * before, scale)
    return found


def alike(scene, name, *places):
    """Whether a quantity is the same at crank angles, so that either is the place of its largest value."""
    at = scene.solve(np.array(places))
    one, other = at.balancing_torque if name == "balancing_torque" else np.hypot(*at.reaction(name))
    return abs(one - other) <= TIE * abs(one)


# Drives

RUNNING = (
    "duration",
    "fluctuation",
    "fluctuation_arithmetic",
    "energy_per_turn",
    "mean_power",
    "rms_power",
    "peak_power",
    "rms_motor_torque",
    "peak_motor_torque",
    "mean_friction_loss",
    "flywheel",
)


def running(one, other):
    """Periodic running of a machine, at crank angles, and of its mirror image, at the negative angles."""
    power, pull = max(abs(one.peak_power), abs(one.mean_power)), 0.0
    if one.motor is not None:  # what a motor gives is a steep function of the speed: rounding is that of its peak
        most = float(np.max(np.abs(one.motor.torque(np.linspace(0.0, 1.05 * np.max(np.abs(one.motor_speed)), 99)))))
        power, pull = most * abs(one.motor_speed).max(), most * abs(one.motor.transmission) / one.flywheel
    scales = {"mean_power": power, "rms_power": power, "peak_power": power}
    scales |= {"energy_per_turn": power * one.duration, "mean_friction_loss": power}
    if one.motor is not None:
        scales |= dict.fromkeys(("motor_torque", "rms_motor_torque", "peak_motor_torque"), most)
    scales |= {"fluctuation": 1.0, "fluctuation_arithmetic": 1.0}  # a difference of speeds, beside the mean speed
    found = {name: relative(getattr(other, name), getattr(one, name), scales.get(name)) for name in RUNNING}
    found["mean_speed"] = relative(other.mean_speed, -one.mean_speed)
    found["speed_range"] = relative(other.speed_range, one.speed_range)
    found["speed"] = relative(other.speed, -one.speed)
    found["acceleration"] = relative(
        other.acceleration, -one.acceleration, max(np.max(np.abs(one.acceleration)), pull) or 1.0
    )
    found["motor_torque"] = relative(other.motor_torque, one.motor_torque, scales.get("motor_torque"))
    found["time"] = relative(other.time, one.time, one.duration)
    before, after = one.energy_flow, other.energy_flow
    size = max(power * one.duration, *(0.0 if math.isnan(part.swing) else part.swing for part in before.parts))
    for here, there in zip(before.parts, after.parts, strict=True):
        assert here.kind == there.kind  # names tell places of loads, which the mirror moves
        found[f"energy of {here.name}"] = relative(there.energy, here.energy, size)
        found[f"swing of {here.name}"] = relative(there.swing, here.swing, size)
    return found


def moving(one, other):
    """Motion over time of a machine and of its mirror image."""
    if [event.name for event in one.events] != [event.name for event in other.events]:
        return {"events": math.inf}
    times = np.linspace(0.0, min(one.time[-1], other.time[-1]), 41)
    before, after = one.at(times), other.at(times)
    found = {
        "crank_angle": relative(after.crank_angle, -before.crank_angle),
        "speed": relative(after.speed, -before.speed),
        "motor_torque": relative(after.motor_torque, before.motor_torque),
        "friction_energy": relative(after.friction_energy, before.friction_energy),
    }
    for name, sense in (("time", 1.0), ("crank_angle", -1.0)):
        expected, found_there = ([getattr(event, name) for event in item.events] for item in (one, other))
        found[f"{name} of events"] = relative(found_there, sense * np.array(expected))
    return found
