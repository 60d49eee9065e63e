"""Hints at probable mistakes: values in other units, sliders that stand still, loads that act beside a rod.

Each function returns or yields sentences; the values are used as given.
"""

from typing import Any

import numpy as np

from ..errors import NotGivenError, ParameterError
from ..numbers import checks
from ..numbers.arithmetic import sqrt
from .group import FRAME
from .links import present
from .loads import GasSpring, ProcessForce, Spring, Table, dead_centres, spring_masses, surge
from .loads.gas_spring import PRESSURES
from .loads.points import point_on_link

SMALL_INERTIA_FACTOR = 1000.0
"""Inertia of a uniform rod, m l^2 / 12, over the least plausible inertia of a link."""
LARGE_INERTIA_FACTOR = 3.0
"""Largest plausible inertia over m l^2: a uniform rod has 1/12, in kg cm2 833, in kg mm2 83 333."""
OTHER_UNITS = {8333.0: ("kg mm2", 1e-6), 30.0: ("kg cm2", 1e-4)}
"""Probable unit of an inertia and its factor to kg m2, by the least inertia over m l^2."""
MAX_LENGTH = 100.0
"""Largest plausible length of a link, m."""
MAX_LENGTH_RATIO = 2000.0
"""Largest plausible length of the longest link over the shortest: millimetres mixed with metres give more."""
MAX_PIN_SPEED = 60.0
"""Largest plausible speed of a crank's pin, m/s: racing engines reach 50."""
MIN_MASS = 1e-75
"""Mass, kg, that replaces zero in a batch of springs with and without mass."""
MAX_PEAK_DISTANCE = np.radians(60.0)
"""Distance of the largest force of a table on a slider from a dead centre beyond which its zero may be missing, rad."""
PEAK_SHARE, MAX_PEAK_WIDTH, MAX_SUCTION = 0.99, np.radians(90.0), 0.2
"""Limits of an indicator diagram, relative to its largest force: least force of its peak, largest force of the other
sign. `MAX_PEAK_WIDTH` is the largest width of the peak at half its height, rad."""
RATE_STEP = np.radians(5.0)
RATE_ANGLES = 1e-3 + RATE_STEP * np.arange(73)
"""Crank angles between which the dead centres of a slider are expected, rad, and their step."""
TWO_TURNS = 4.0 * np.pi
"""Least size of crank angles that may be degrees, rad."""
TURN_CONVERTED_TWICE = 2.0 * np.pi * np.pi / 180.0
"""A turn in radians, converted from degrees to radians again."""
CONVERTED_TURN_LIMITS = 0.9 * TURN_CONVERTED_TWICE, 1.01 * TURN_CONVERTED_TWICE
"""Range of crank angles of a turn converted twice, with or without its end, rad."""


def mechanism_hints(mechanism):
    """Sentences on sliders that stand still, and on improbable lengths and inertias of links."""
    bars = [bar for bar in mechanism.bars if checks.has_known_values(bar.length)]
    hints = [*_still(mechanism)]
    if bars:
        lengths = [(_most(bar.length), bar.link) for bar in bars]
        (longest, link), (shortest, other) = max(lengths), min(lengths)
        if longest > MAX_LENGTH:
            hints.append(f"the {link} is {longest:.6g} m long; are lengths in mm?")
        elif longest > MAX_LENGTH_RATIO * shortest:
            hints.append(
                f"the {link} is {longest:.6g} m long, {longest / shortest:.4g} times the {other} ({shortest:.4g} m); "
                "is one of them in mm?"
            )
    inertias = (_inertia(bar, mechanism.links.get(bar.link), mechanism.crank) for bar in bars)
    return (*hints, *filter(None, inertias))


def scene_hints(mechanism, crank_speed, numbers):
    """Hints on the mechanism, its drive and `numbers`: path, value and plausible range."""
    longest = max((_most(bar.length) for bar in mechanism.bars if checks.has_known_values(bar.length)), default=0.0)
    hints = [*mechanism.hints]
    hints += [text for path, value, usual in numbers if (text := checks.implausibility(path, value, usual, longest))]
    length = mechanism.crank.length
    if length is None or longest > MAX_LENGTH or not all(map(checks.has_known_values, (length, crank_speed))):
        return hints
    radius, speed = _most(length), _most(abs(crank_speed))
    if radius * speed > MAX_PIN_SPEED:
        hints.append(
            f"the pin of the crank moves at {radius * speed:.4g} m/s, faster than in any racing engine; is "
            f"crank_speed, {speed:.6g} rad/s, in rpm? That makes {speed * np.pi / 30.0:.6g} rad/s"
        )
    return hints


def needs_look(loads):
    """Whether loads may need hints outside the compiled plausibility test."""
    return any(isinstance(load, GasSpring) for load in loads) or bool(spring_masses(loads))


def spring_hints(mechanism, loads, crank_speed):
    """Yield hints on gas springs below the ambient pressure, and on springs with mass that swing too slowly."""
    for load in loads:
        if isinstance(load, GasSpring) and all(map(checks.has_known_values, (load.pressure, load.ambient))):
            if np.any((load.pressure < load.ambient) & (load.pressure >= PRESSURES.least)):  # less looks like bar
                yield (
                    f"{load.title}: its pressure of {np.min(load.pressure):.6g} Pa is absolute and below the ambient "
                    f"{np.max(load.ambient):.6g} Pa, so the gas pulls there; is it a gauge pressure?"
                )
        elif isinstance(load, Spring) and np.any(present(load.mass)):
            yield from _surge_hints(mechanism, load, crank_speed)


def _surge_hints(mechanism, spring, crank_speed):
    if not all(map(checks.has_known_values, (spring.stiffness, spring.mass, spring.cubic, crank_speed))):
        return
    found = surge.highest_harmonic(mechanism, spring.on)
    if found is None or not np.any(crank_speed):
        return
    order, position = found
    rate, mass, speed = np.maximum(spring.mean_rate(position), 0.0), np.asarray(spring.mass), np.abs(crank_speed)
    natural = surge.surge_frequency(rate, np.maximum(mass, MIN_MASS))
    natural, mass, driven = np.broadcast_arrays(natural, mass, order * speed)
    ratio = np.full(natural.shape, np.inf)
    np.divide(natural, driven, out=ratio, where=(mass > 0.0) & (driven > 0.0))
    worst = np.unravel_index(np.argmin(ratio), ratio.shape)
    if ratio[worst] < surge.MIN_RATIO:
        yield (
            f"{spring.title}: its surge ratio is {ratio[worst]:.3g}, below {surge.MIN_RATIO:g}. With "
            f"{mass[worst]:.6g} kg it swings between its ends at {natural[worst]:.4g} rad/s, and harmonic {order:g} of "
            f"the slider, the highest that counts, drives it at {driven[worst]:.4g} rad/s. Waves in the spring, which "
            f"its `mass` leaves out, change the stiffness of its end by {surge.wave_percentage(ratio[worst])}"
        )


def doubtful_table(load):
    """Table over the angle that is a force on a slider, with a dead centre as its zero or without a zero, or None."""
    table = load.value_now if isinstance(load, ProcessForce) else None
    return table if isinstance(table, Table) and table.over == "angle" and table.zero != 0.0 else None


def table_hints(motion):
    """Yield hints on tables over the angle: a peak far from all dead centres, or a sense against the rotation."""
    speed = motion.crank_speed
    for load in motion.loads:
        table = doubtful_table(load)
        if table is not None and table.zero is None:
            yield from _peak_hints(motion, load, table)
        elif table is not None and checks.has_known_values(speed) and np.all(speed * table.sense < 0.0):
            yield (
                f"{load.title}: its table from {table.zero} has sense={table.sense:+d}, but the crank turns at "
                f"{_most(speed):.6g} rad/s, so it is read backwards. For degrees after {table.zero} in the sense of "
                f"rotation give sense={-table.sense:+d}"
            )


def _peak_hints(motion, load, table):
    """Hint if an indicator diagram without a zero has its peak far from the dead centres; none for a follower."""
    is_follower = any(led.link == load.on for group in motion.mechanism.groups for led in group.led)
    is_piston = not is_follower and _is_diagram(table)
    rate = motion.mechanism.place(RATE_ANGLES).travels[load.on].first if is_piston else None
    if rate is None or not checks.has_known_values(rate):
        return
    peaks = table.x[table.y / table.largest >= PEAK_SHARE]
    stops = RATE_ANGLES[:-1][np.diff(np.signbit(rate))] if rate.ndim == 1 else np.empty(0)
    if np.any(_turn_distance(peaks[:, None], stops) < MAX_PEAK_DISTANCE - RATE_STEP):
        return
    try:
        angles = np.column_stack(dead_centres(motion, load.on)[0])
    except (ParameterError, NotGivenError):
        return
    distance = _turn_distance(peaks[:, None], angles[:, None]).min(axis=(1, 2))
    far = np.flatnonzero(distance > MAX_PEAK_DISTANCE)
    if far.size:
        top, bottom = np.round(np.degrees(angles[far[0]]), 6) % 360.0  # not 5e-14 deg
        yield (
            f"{load.title}: the largest value of its table, {table.largest:.6g} N at {np.degrees(peaks[0]):.4g} deg, "
            f"is {np.degrees(distance[far[0]]):.4g} deg from the dead centres of {load.on!r}, TDC at {top:.4g} deg and "
            f'BDC at {bottom:.4g} deg. Is its angle 0 at a dead centre? Give zero="TDC" (or "BDC"), or zero=0.0 if it '
            "is the crank angle from +x"
        )


def _is_diagram(table):
    """Whether a table over the angle has one short peak, and little of the other sign."""
    x, (y,) = table.closed()
    if not table.largest or (y / table.largest).min() < -MAX_SUCTION:
        return False
    above = np.interp(np.linspace(x[0], x[-1], 720), x, y / table.largest) > 0.5
    return above.mean() * table.period < MAX_PEAK_WIDTH


def _turn_distance(angle, other):
    """Distance of crank angles within a turn, rad."""
    return np.abs((angle - other + np.pi) % (2.0 * np.pi) - np.pi)


def load_hints(mechanism, loads):
    """Yield a hint for each load between two points that acts on a cylinder, but not on its rod."""
    for load, slot, other in loads_beside_rods(mechanism, loads):
        place = f"({', '.join(map(repr, other))})" if isinstance(other, tuple) else repr(other)
        yield (
            f"{load.title}: it acts along the {slot.link} on {slot.joint!r}, a joint of the "
            f"{mechanism.joints[slot.joint].link}, so the {slot.rod} does not carry it. For the pressure in the "
            f'{slot.link} give a place on the {slot.rod}, between=(("{slot.rod}", 0.0, 0.0), {place})'
        )


def loads_beside_rods(mechanism, loads):
    """Loads between a cylinder and the joint of its rod that another link owns, with the slot and the other point."""
    for slot in mechanism.slots:
        for load in loads:
            ends: Any = getattr(load, "between", ())
            if slot.rod and len(ends) == 2 and slot.joint in ends:
                carriers = {point_on_link(mechanism, end).link for end in ends}
                if slot.link in carriers and slot.rod not in carriers:
                    yield load, slot, ends[ends[0] == slot.joint]


def compared_sizes(mechanism):
    """Numbers that the compiled plausibility test compares.

    In order:

    - all lengths together; the lengths whose shortest one counts; the bars
    - triples of inertia, mass and distance of the mass centre along the link; triples of inertia, mass and bar length
    - pairs of a bar's length and its distance from the arm of its inner joint

    There are no hints if no bar is as long as its arm, the longest length is not huge, and no inertia is small or large
    relative to its bar.
    """
    reaches = [reach for part in mechanism.parts for reach in part.reaches]
    bodies = [
        (link.inertia, link.mass, link.centre[0])
        for link in mechanism.links.values()
        if present(link.inertia) is not None
    ]
    turning = [
        (link.inertia, link.mass, bar.length)
        for bar in mechanism.bars
        if (link := mechanism.links.get(bar.link)) is not None and bar.link not in mechanism.crank.links
        if present(link.inertia) is not None and present(link.mass) is not None
    ]
    arms = [(bar.length, away - bar.length) for bar, _, away in _on_arms(mechanism)]
    return mechanism.extent, reaches, [bar.length for bar in mechanism.bars], bodies, turning, arms


def _still(mechanism):
    """Yield a hint for each slider that stands on the fixed pivot of an arm as long as its bar."""
    for bar, slider, away in _on_arms(mechanism):
        are_known = checks.has_known_values(away) and checks.has_known_values(bar.length)
        if are_known and np.any(abs(away - bar.length) <= 1e-9 * bar.length):
            angle = np.linspace(0.0, 2.0 * np.pi * mechanism.turns, 60 * mechanism.turns, endpoint=False) + 1e-3
            rate = np.abs(mechanism.place(angle).travels[slider].first)
            if np.any(np.max(rate, axis=-1) <= 1e-9 * _most(bar.length)):
                yield (
                    f"the {slider} stands still all over the turn: the {bar.link} is as long as the arm of {bar.start} "
                    f"about the point where {bar.end} rests; another assembly lets it move"
                )


def _on_arms(mechanism):
    """Bars from a link about a fixed pivot to a slider, with the slider and the arm of the bar's inner joint, m."""
    for bar in mechanism.bars:
        arm, slider = (mechanism.joints[end].link for end in (bar.start, bar.end))
        if slider in mechanism.guides and arm != FRAME and mechanism.joints[mechanism.references[arm]].link == FRAME:
            _, along, across = mechanism.joints[bar.start]
            yield bar, slider, abs(along) if present(across) is None else sqrt(along * along + across * across)


def _inertia(bar, link, crank):
    """Hint on an inertia that is improbable for mass and length, or None; 0 makes a point mass."""
    if link is None or not all(map(checks.has_known_values, (link.mass, link.centre[0], link.inertia))):
        return None
    reach = np.maximum(bar.length, 2.0 * np.abs(link.centre[0]))  # the arm of a wiper goes on beyond its joints
    inertia, unit = link.inertia, link.mass * reach * reach
    if np.any((inertia > 0) & (SMALL_INERTIA_FACTOR * 12.0 * inertia < unit)):
        odd, beside, advice = np.min(inertia), "less than a thousandth of", "is it in kg m2? 0 makes it a point mass"
    elif bar.link not in crank.links and np.any((inertia > LARGE_INERTIA_FACTOR * unit) & (unit > 0)):
        # the inertia of a crank may include the drive
        times, inertia = map(np.ravel, np.broadcast_arrays(inertia / np.where(unit > 0, unit, np.inf), inertia))
        worst = np.argmax(times)
        odd, most = inertia[worst], times[worst]
        beside, advice = f"{12.0 * most:.4g} times", "is it in kg m2, about the mass centre?"
        name, factor = next((unit for least, unit in OTHER_UNITS.items() if most > least), ("", 0.0))
        if name:
            advice = f"is it in {name}? That makes {factor * odd:.4g} kg m2"
    else:
        return None
    rod = f"a uniform rod of {np.max(link.mass):.4g} kg and {np.max(reach):.4g} m"
    return f"the inertia of the {bar.link}, {odd:.4g} kg m2, is {beside} that of {rod}; {advice}"


def single_angle_hints(angle):
    """Hint if a single crank angle looks like degrees: whole, from two turns in radians to three in degrees."""
    if not TWO_TURNS <= abs(angle) <= 1080.0 or not _whole(angle):
        return ()
    return (
        f"the crank angle {angle:g} looks like degrees; it is used as {angle:g} rad; {angle:g} deg is "
        f"np.radians({angle:g})",
    )


def angle_hints(angle, given=None):
    """Hint if crank angles look like degrees, like radians converted twice, or, as `given`, like a number of them."""
    if isinstance(given, int | np.integer) and given >= TWO_TURNS:
        return (
            f"{given} is used as one crank angle, {given} rad; for {given} of them over the turn give "
            f"np.linspace(0, 2 * np.pi, {given}, endpoint=False), for degrees np.radians({given})",
        )
    if not isinstance(angle, np.ndarray) or angle.dtype.char == "O" or not angle.size:
        return ()
    first, last = angle.item(0), angle.item(-1)
    is_small = -TWO_TURNS < first < TWO_TURNS and -TWO_TURNS < last < TWO_TURNS
    if is_small and (angle.size < 3 or not CONVERTED_TURN_LIMITS[0] < abs(last - first) < CONVERTED_TURN_LIMITS[1]):
        return ()
    row = np.ravel(angle)
    if row.size < 3:
        if not all(_whole(angle / 30.0) for angle in row.tolist()):
            return ()
        text = " and ".join(f"{angle:g}" for angle in row.tolist())
        if row.size == 1:
            return (f"the crank angle {text} looks like degrees; it is used as radians",)
        return (f"crank angles {text} look like degrees; they are used as radians",)
    step, reach = row[1] - row[0], row[-1] - row[0]
    if not np.all(abs(np.diff(row) - step) <= 1e-9 * abs(step)):
        return ()
    if is_small:
        is_turn = any(abs(abs(whole) - TURN_CONVERTED_TWICE) < 1e-9 for whole in (reach, reach + step))
        words = "are a turn in radians, converted from degrees once more"
    else:
        is_turn = abs(step) >= 0.25 and _whole(360.0 / step) and (_whole(reach / 90.0) or _whole((reach + step) / 90.0))
        words = f"by {step:g} look like degrees"
    if not is_turn:
        return ()
    return (f"crank angles from {row[0]:g} to {row[-1]:g} {words}; they are used as radians",)


def _whole(number):
    return abs(number - round(number)) < 1e-9


def _most(values):
    return float(np.max(values))
