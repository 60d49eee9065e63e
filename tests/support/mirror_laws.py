"""How far results of a scene's mirror image are from the mirror image of its results; each a dict of errors by name."""

import math

import numpy as np

import kinetostatics as ks

from .mirrored import TURN, differences, mirrored, sign_of, values_of

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


def both(function, *arguments):
    """What a function gives for scenes or other things and for their mirror images; errors by their class alone."""
    found = []
    for side in (arguments, [mirrored(item) for item in arguments]):
        try:
            found.append(function(*side))
        except ks.KinetostaticsError as error:
            found.append(type(error))
    return found


def solved(scene, angles=ANGLES):
    return differences(scene.solve(angles), mirrored(scene).solve(-angles), unsigned(scene))


def compiled(scene, angles=ANGLES, engine="numpy"):
    """Programs of all quantities."""
    before = scene.solve(angles)
    values = values_of(before)
    names = [name for name in values if name in PROGRAMMED or name.endswith("_rate")]
    names += [joint for joint in ("O", "A", "B") if joint in scene.mechanism.outputs]
    one, other = (
        ks.compile(item, names, engine=engine)(at) for item, at in ((scene, angles), (mirrored(scene), -angles))
    )
    found = {}
    for name in names:
        if name in values:
            expected = sign(scene, name, values[name][1]) * one[name]
        else:
            expected = one[name] * np.array([[1.0], [-1.0]])
        found[name] = relative(other[name], expected, max(np.max(np.abs(one[name])), 1e-300))
    return found


PROGRAMMED = (
    "balancing_torque",
    "slider_position",
    "slider_acceleration",
    "guide_force",
    "guide_moment",
    "cam_force",
    "slot_force",
    "contact_force",
    "kinetic_energy",
    "load_torque",
    "reduced_inertia_slope",
)


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
