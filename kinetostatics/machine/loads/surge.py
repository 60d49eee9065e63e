"""Surge: waves in a spring with mass between a fixed foot and a slider.

The displacement u(h, t) of a uniform spring is at the fraction h of its length from the foot. With stiffness c and mass
m it obeys the wave equation m u_tt = c u_hh (Wahl, *Mechanical Springs*, 1963, chapter 13). For an end that moves as
sin(s t), u = sin(z h) / sin(z) sin(s t), z = s sqrt(m / c). The end pushes back with c u_h at h = 1:

    dynamic stiffness  c z cot z  =  c - m s^2 / 3 - ...

The natural frequency between fixed ends, pi sqrt(c / m) in rad/s, is at z = pi, where this stiffness is infinite. The
surge ratio is the natural frequency over s, pi / z.
"""

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

MIN_RATIO = 5.0
"""Surge ratio below which a spring that stretches evenly, without waves, is a poor model.

At this ratio the end's stiffness without waves, c - m s^2 / 3, is in error by c z^4 / 45 + ..., 0.36 % of c."""
HARMONIC_SHARE = 0.05
"""Least harmonic of the slider's acceleration that counts, relative to the largest one."""
SAMPLES = 256
"""Crank angles per turn for the harmonics of the acceleration."""
NEWTON_STEPS = 8
"""Newton steps for the root z of z tan z = m / M, enough for every ratio of spring mass to carried mass."""


def surge_frequency(stiffness, mass):
    """First natural frequency of a spring between fixed ends, pi sqrt(c / m), rad/s."""
    return np.pi * np.sqrt(stiffness / mass)


def end_stiffness(stiffness, mass, frequency):
    """Stiffness of the moving end at a frequency, rad/s: c z cot z, N/m; negative where inertia dominates."""
    z = frequency * np.sqrt(mass / stiffness)
    return stiffness * z / np.tan(z)


def wave_percentage(ratio):
    """Change of the end's stiffness by waves at a surge ratio, in per cent of the stiffness c, as text for a hint."""
    if ratio <= 1.0:
        return "more than itself"
    z = np.pi / ratio
    return f"{100.0 * abs(end_stiffness(1.0, 1.0, z) - (1.0 - z * z / 3.0)):.2g} %"


_HIGHEST_HARMONICS: WeakKeyDictionary[Any, dict] = WeakKeyDictionary()
"""Results of `highest_harmonic` by mechanism, then by slider."""


def highest_harmonic(mechanism, slider):
    """Order of a slider's highest harmonic that counts, per crank turn, and its coordinate, m; None if unknown."""
    known = _HIGHEST_HARMONICS.setdefault(mechanism, {})
    if slider not in known:
        count = SAMPLES * mechanism.turns
        with np.errstate(invalid="ignore", divide="ignore"):
            travel = mechanism.place(np.linspace(0.0, 2.0 * np.pi * mechanism.turns, count, endpoint=False)).travels[
                slider
            ]
        known[slider] = _highest_harmonic(travel, mechanism.turns)
    return known[slider]


def _highest_harmonic(travel, turns):
    if not all(isinstance(part, np.ndarray) and part.dtype.kind == "f" and np.isfinite(part).all() for part in travel):
        return None
    sizes = np.abs(np.fft.rfft(travel.second))[..., 1:]
    largest = np.max(sizes, axis=-1, keepdims=True)
    matters = (sizes >= HARMONIC_SHARE * largest) & (largest > 0.0)
    if not matters.any():
        return None
    return (1 + np.max(np.nonzero(matters)[-1])) / turns, travel.position


def balancing_stiffness(slider, spring):
    """Stiffness c, N/m, with c z cot z = M w^2 at z = w sqrt(m / c); `slider` is M w^2, `spring` is m w^2, N/m."""
    ratio = np.where(spring == 0.0, 0.0, spring / slider)
    z = np.sqrt(ratio / (1.0 + ratio * (4.0 / np.pi**2)))
    for _ in range(NEWTON_STEPS):
        sine, cosine = np.sin(z), np.cos(z)
        z = z - (z * sine - ratio * cosine) / np.where(ratio == 0.0, 1.0, (1.0 + ratio) * sine + z * cosine)
    found = np.where(ratio == 0.0, slider, spring / np.where(ratio == 0.0, 1.0, z * z))
    return found if np.ndim(found) else float(found)
