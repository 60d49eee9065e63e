"""What looks like a slip of units, though a machine could have it: said once, as a warning, and computed all the same."""

import numpy as np

from . import checks

FAR = 20.0
"""Lengths of the longest link beyond which nobody puts a mass centre: millimetres beside metres make 1000."""
UNEQUAL = 500.0
"""Ratio of the longest link to the shortest beyond which one of them is in another unit."""
THIN = 1000.0
"""How many times the inertia of a link may be less than a uniform rod's of its mass and length, or more than m l^2."""


def of_mechanism(mechanism):
    """Sentences on lengths, mass centres and inertias that look like those of another unit."""
    bars = [bar for bar in mechanism.bars if checks.known(bar.length)]
    if not bars:
        return ()
    longest, shortest = max(_most(bar.length) for bar in bars), min(-_most(-bar.length) for bar in bars)
    found = []
    if longest > UNEQUAL * shortest:
        found.append(
            f"links are from {shortest:.4g} m to {longest:.4g} m long, {longest / shortest:.3g} times; are some lengths "
            "in mm?"
        )
    for name, link in mechanism.links.items():
        away = max((_most(abs(part)) for part in link.centre if checks.known(part)), default=0.0)
        if away > FAR * longest:
            found.append(
                f"the mass centre of the {name} is {away:.4g} m from its reference joint, {away / longest:.3g} times "
                f"the longest link ({longest:.4g} m); is it in mm?"
            )
    return (*found, *(text for bar in bars if (text := _inertia(bar, mechanism.links.get(bar.link)))))


def _inertia(bar, link):
    """What is odd about a link's inertia beside its mass and length; a point mass and a flywheel on the crank are not."""
    if link is None or not (checks.known(link.mass) and checks.known(link.inertia)):
        return None
    inertia, unit = link.inertia, link.mass * bar.length * bar.length
    thin = (inertia > 0) & (THIN * 12.0 * inertia < unit)
    thick = (unit > 0) & (inertia > THIN * unit) & (bar.link != "crank")
    odd = thin | thick
    if odd is False or not np.any(odd):
        return None
    words = "less than a thousandth of a uniform rod's" if np.any(thin) else "more than a thousand times mass times length squared"
    return (
        f"the inertia of the {bar.link}, {np.min(inertia):.4g} kg m2, is {words}, with {np.max(link.mass):.4g} kg and "
        f"{np.max(bar.length):.4g} m; is it about the mass centre, in kg m2?"
    )


def of_angles(angle):
    """What is odd about crank angles: an even grid over quarters of a turn counted in degrees."""
    if angle.size < 3 or max(abs(angle.item(0)), abs(angle.item(-1))) < 4 * np.pi:
        return None
    row = np.ravel(angle)
    step, reach = row[1] - row[0], row[-1] - row[0]
    even = abs(step) >= 0.25 and _whole(360.0 / step) and np.all(abs(np.diff(row) - step) <= 1e-9 * abs(step))
    if not even or not (_whole(reach / 90.0) or _whole((reach + step) / 90.0)):
        return None
    return f"crank angles from {row[0]:g} to {row[-1]:g} by {step:g} look like degrees; they are taken as radians"


def _whole(number):
    return abs(number - round(number)) < 1e-9


def _most(values):
    return values if isinstance(values, float) else float(np.max(values))
