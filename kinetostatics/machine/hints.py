"""What looks like a slip, though a machine could have it: a warning, and computed all the same."""

import numpy as np

from ..numbers import checks
from ..numbers.elementary import sqrt
from .group import FRAME
from .links import present

FAR = 20.0
"""Lengths of the longest link beyond which nobody puts a mass centre: millimetres beside metres make 1000."""
THIN = 1000.0
"""How many times less than that of a uniform rod of its mass and length, m l^2 / 12, the inertia of a link may be."""


def of_mechanism(mechanism):
    """Sentences on sliders that stand still, and on mass centres and inertias that look like those of another unit."""
    return (*_still(mechanism), *_of_units(mechanism))


def sizes(mechanism):
    """What a first look compares, of any numbers.

    In turn all lengths together, those of which the shortest counts, the bars, pairs of inertia and mass, and pairs of
    a bar's length and how far that is from the arm of its inner joint. There are no hints where no bar is as long as
    its arm, all lengths together are less than `FAR` of the longest bar, and no inertia is small even beside that bar.
    """
    reaches = [reach for part in mechanism.parts for reach in part.reaches]
    bodies = [(link.inertia, link.mass) for link in mechanism.links.values() if present(link.inertia) is not None]
    arms = []
    for bar, _ in _on_arms(mechanism):
        _, along, across = mechanism.joints[bar.start]
        away = abs(along) if present(across) is None else sqrt(along * along + across * across)
        arms.append((bar.length, away - bar.length))
    return mechanism.extent, reaches, [bar.length for bar in mechanism.bars], bodies, arms


def _of_units(mechanism):
    bars = [bar for bar in mechanism.bars if checks.known(bar.length)]
    if not bars:
        return ()
    longest, found = max(_most(bar.length) for bar in bars), []
    for name, link in mechanism.links.items():
        away = max((_most(abs(part)) for part in link.centre if checks.known(part)), default=0.0)
        if away > FAR * longest:
            found.append(
                f"the mass centre of the {name} is {away:.4g} m from its reference joint, {away / longest:.3g} times "
                f"the longest link ({longest:.4g} m); is it in mm?"
            )
    return (*found, *(text for bar in bars if (text := _inertia(bar, mechanism.links.get(bar.link)))))


def _still(mechanism):
    """Say which sliders stand still all over the turn.

    That takes a bar as long as the arm of its inner joint about a fixed pivot, with the slider's pin on the pivot.
    """
    for bar, slider in _on_arms(mechanism):
        if _as_long_as_its_arm(mechanism, bar):
            angle = np.linspace(0.0, 2.0 * np.pi * mechanism.turns, 60 * mechanism.turns, endpoint=False) + 1e-3
            rate = np.abs(mechanism.place(angle).travels[slider].first)
            if np.any(np.max(rate, axis=-1) <= 1e-9 * _most(bar.length)):
                yield (
                    f"the {slider} stands still all over the turn: the {bar.link} is as long as the arm of {bar.start} "
                    f"about the point where {bar.end} rests; another assembly lets it move"
                )


def _on_arms(mechanism):
    """Bars from a joint on a link that turns about a fixed pivot to a slider, each with that slider."""
    for bar in mechanism.bars:
        arm, slider = (mechanism.joints[end].link for end in (bar.start, bar.end))
        if slider in mechanism.guides and arm != FRAME and _is_on_the_frame(mechanism, arm):
            yield bar, slider


def _is_on_the_frame(mechanism, link):
    return mechanism.joints[mechanism.references[link]].link == FRAME


def _as_long_as_its_arm(mechanism, bar):
    """Whether a bar is as long as its inner joint is far from the fixed pivot that its link turns about."""
    _, along, across = mechanism.joints[bar.start]
    if not all(map(checks.known, (along, across, bar.length))):
        return False
    return bool(np.any(np.abs(np.hypot(along, across) - bar.length) <= 1e-9 * bar.length))


def _inertia(bar, link):
    """What is odd about a link's inertia beside its mass and length; none at all makes a point mass."""
    if link is None or not (checks.known(link.mass) and checks.known(link.inertia)):
        return None
    inertia, unit = link.inertia, link.mass * bar.length * bar.length
    thin = (inertia > 0) & (THIN * 12.0 * inertia < unit)
    if thin is False or not np.any(thin):
        return None
    return (
        f"the inertia of the {bar.link}, {np.min(inertia):.4g} kg m2, is less than a thousandth of that of a uniform "
        f"rod of {np.max(link.mass):.4g} kg and {np.max(bar.length):.4g} m; is it in kg m2? 0 makes it a point mass"
    )


def of_angles(angle):
    """Say if crank angles look like degrees: an even grid over quarters of a turn counted in them."""
    if not isinstance(angle, np.ndarray) or angle.dtype == object or angle.size < 3:
        return ()
    if -4 * np.pi < angle.item(0) < 4 * np.pi and -4 * np.pi < angle.item(-1) < 4 * np.pi:
        return ()
    row = np.ravel(angle)
    step, reach = row[1] - row[0], row[-1] - row[0]
    even = abs(step) >= 0.25 and _whole(360.0 / step) and np.all(abs(np.diff(row) - step) <= 1e-9 * abs(step))
    if not even or not (_whole(reach / 90.0) or _whole((reach + step) / 90.0)):
        return ()
    return (f"crank angles from {row[0]:g} to {row[-1]:g} by {step:g} look like degrees; they are taken as radians",)


def _whole(number):
    return abs(number - round(number)) < 1e-9


def _most(values):
    return values if isinstance(values, float) else float(np.max(values))
