"""Strength and rigidity of links: stress, fatigue and buckling of a bar, its pins, bending vibration, twist of a shaft.

The forces inside the bar are those of `Solution.sections`. Sources: Shigley, *Mechanical Engineering Design*, 2015,
chapters 4 and 6; Timoshenko, *Vibration Problems in Engineering*, 1937.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..cycle.extremes import extrema, extremes
from ..cycle.means import closed_turn
from ..machine.cams.profile import POSITIVE
from ..machine.loads import TURN
from ..numbers import checks
from ..solution.sections import BAR, Sections, evaluate
from .result import Row, Sized, warn_of_notes

NUMBERS = {
    **BAR,
    **dict.fromkeys(("ultimate", "endurance", "yield_strength", "shear_modulus"), ("Pa", POSITIVE)),
    **dict.fromkeys(("diameter", "width", "length"), ("m", POSITIVE)),
    "shear_planes": ("1", {"low": 1.0}),
    "polar_moment": ("m**4", POSITIVE),
}
"""Unit and rule of each option, and of the numbers of a bar."""
SHAFT = ("length", "polar_moment", "shear_modulus")
PLACES = 401
"""Places between stations of a bar at which fatigue is evaluated: the error of the safety is below 1e-5."""
MAX_COMPRESSION = 0.1
"""Compression, relative to Euler's load P, below which its effect on bending, a factor 1/(1 - F/P), is neglected."""
SINES = 24
"""Terms of the deflection in Ritz's method."""
ANGLES, MIN_HARMONIC = 1440, 1e-9
"""Crank angles of a series by harmonics, and size of a harmonic, relative to the largest, that counts as rounding."""
GAUSS = np.polynomial.legendre.leggauss(3)
"""Places and weights in (-1, 1) that integrate a moment, cubic in x, times a straight line."""


@dataclass(frozen=True, eq=False, repr=False)
class BarStrength(Sized):
    """Stress, fatigue and buckling of a bar; `sections` are the internal forces, `x` is the place of fatigue, m."""

    ROWS: ClassVar = {
        "largest_tension": Row("N", "over bar and turn", "N' = mu (a - g).t"),
        "largest_compression": Row("N", "over bar and turn", "N' = mu (a - g).t"),
        "largest_shear": Row("N", "size, over bar and turn", "V' = mu (g - a).n"),
        "largest_moment": Row("N m", "size, over bar and turn", "M' = V"),
        "largest_stress": Row("Pa", "over bar and turn, tension positive", "N/A +- M/W"),
        "smallest_stress": Row("Pa", "over bar and turn, compression negative", "N/A +- M/W"),
        "stress_amplitude": Row("Pa", "at the fibre nearest to fatigue", "s_a = (max - min)/2 over the turn"),
        "mean_stress": Row("Pa", "at that fibre", "s_m = (max + min)/2 over the turn"),
        "fatigue_safety": Row("1", "at that fibre", "1/n = s_a/S_e + max(s_m, 0)/S_u, Goodman, Haigh (Shigley 6-46)"),
        "slenderness": Row("1", "length over radius of gyration", "L/k, k = sqrt(I/A)"),
        "buckling_load": Row(
            "N",
            "in the plane of motion, free to turn at both pins",
            "Euler pi^2 E I/L^2; if L/k < pi sqrt(2 E/S_y) Johnson A S_y (1 - S_y (L/k)^2/(4 pi^2 E)); Shigley 4-12",
        ),
        "buckling_safety": Row("1", "least over the turn, inf without compression", "buckling load/compression"),
    }
    sections: Sections
    x: float
    largest_tension: float
    largest_compression: float
    largest_shear: float
    largest_moment: float
    largest_stress: float
    smallest_stress: float
    stress_amplitude: float
    mean_stress: float
    fatigue_safety: float
    slenderness: float
    buckling_load: float
    buckling_safety: float


def bar_strength(solution, link, bar, *, ultimate, endurance, yield_strength) -> BarStrength:
    """Stress N/A +- M/W in a straight link over length and turn, fatigue by Haigh's diagram, buckling.

    Fatigue uses the largest and the smallest stress of the turn at the same fibre. Include the effects of notches, size
    and surface in the endurance limit; stress around the pins is left out.

    Parameters
    ----------
    solution : Solution
    link : str
    bar : Bar
        Section and mass, with `second_moment` and `youngs_modulus`.
    ultimate, endurance, yield_strength : float
        Ultimate strength S_u, endurance limit S_e of the part, yield strength S_y, Pa.

    Returns
    -------
    BarStrength
        `.fatigue_safety`, `.buckling_safety`, `.largest_stress` ..., `.table()`; `.sections` are the internal forces.

    Raises
    ------
    ParameterError
        A strength is not positive, or the bar lacks a number; or as for `Solution.sections`.

    Warns
    -----
    HintWarning
        Compression exceeds 10 % of Euler's load, so the bending moment grows by this share; or the stress exceeds the
        yield strength.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 50.0), slider=ks.Link(600))
    >>> bar = ks.Bar(6e-3, 3e-4, second_moment=8e-5, youngs_modulus=206e9)
    >>> s = ks.Scene(saw, 33.5).solve(360)
    >>> found = ks.sizing.bar_strength(s, "coupler", bar, ultimate=600e6, endurance=200e6, yield_strength=355e6)
    >>> print(f"fatigue {found.fatigue_safety:.2f} at {found.x:.2f} m, buckling {found.buckling_safety:.1f}")
    fatigue 4.27 at 0.71 m, buckling 9.6
    """
    values = {"ultimate": ultimate, "endurance": endurance, "yield_strength": yield_strength}
    strength, endured, yields = _numbers("bar_strength", solution, values, bar).values()
    sections = solution.sections(link, bar)

    def fibres(axial, shear, moment):
        return np.array([axial / bar.area + side * moment / bar.modulus for side in (1.0, -1.0)])

    def use(smallest, largest):
        return 0.5 * (largest - smallest) / endured + np.maximum(0.5 * (largest + smallest), 0.0) / strength

    def stress(at):
        return evaluate(fibres(*sections.polynomials(at))[side][:, [part]], x)[0]

    side, part, x = _worst_fibre(sections, fibres, use)
    low, high = extrema(solution, stress, pulsed=False).range
    slenderness = sections.stations[-1] / np.sqrt(bar.second_moment / bar.area)
    euler = np.pi**2 * bar.youngs_modulus * bar.area / slenderness**2
    crushing = yields * bar.area
    critical = euler if euler < 0.5 * crushing else crushing * (1.0 - 0.25 * crushing / euler)
    peaks = sections.largest | sections.peaks({"most": fibres, "least": lambda *forces: -fibres(*forces)})
    *forces, most, least = (peak.value for peak in peaks.values())
    _, compression, _, moment = forces
    notes = []
    if compression > MAX_COMPRESSION * euler and moment > 0.0:
        notes.append(
            f"compression is {compression / euler:.0%} of Euler's load, which raises the bending moment by this share"
        )
    if max(most, least) > yields:
        words = f"the stress reaches {max(most, least) / 1e6:.4g} MPa, above the yield strength"
        notes.append(f"{words} of {yields / 1e6:.4g} MPa; give the bar a larger area and modulus")
    with np.errstate(divide="ignore"):
        fatigue, safety = 1.0 / np.float64(use(low, high)), critical / np.float64(max(compression, 0.0))
    found = (most, 0.0 - least, 0.5 * (high - low), 0.5 * (high + low), fatigue, slenderness, critical, safety)
    return warn_of_notes("bar_strength", BarStrength(tuple(notes), sections, x, *forces, *map(float, found)))


def _worst_fibre(sections, fibres, use):
    """Side, part between stations, and place x, m, of the fibre with the largest use of its fatigue strength."""
    share, ends = np.linspace(0.0, 1.0, PLACES), sections.stations
    x = np.concatenate([low + share * (high - low) for low, high in itertools.pairwise(ends)])
    part = np.arange(len(ends) - 1).repeat(PLACES)
    stress = evaluate(fibres(*sections.polynomials(sections.solution.sampled.at))[:, :, part], x[:, None])
    side, place = divmod(int(use(stress.min(axis=-1), stress.max(axis=-1)).argmax()), len(x))
    return side, int(part[place]), float(x[place])


def _numbers(owner, solution, values, bar=None):
    """Options by name as floats, after the checks of a solution and of the elasticity of a bar."""
    lacks = [name for name in ("second_moment", "youngs_modulus") if getattr(bar, name, 0.0) is None]
    texts = (f"the bar lacks its {name}, give ks.Bar(..., {name}=...)" for name in lacks)
    given = {name: (value, *NUMBERS[name]) for name, value in values.items()}
    return checks.single_numbers(owner, checks.solution("solution", solution), *texts, **given)


@dataclass(frozen=True, eq=False, repr=False)
class PinStrength(Sized):
    """Stress of a pin by the largest reaction of the turn."""

    ROWS: ClassVar = {
        "largest_load": Row("N", "largest reaction over the turn", "F"),
        "shear_stress": Row("Pa", "mean over the section; 4/3 of it in the middle", "4 F/(n pi d^2), n shear planes"),
        "bearing_stress": Row("Pa", "on the projected area", "F/(d b)"),
    }
    largest_load: float
    shear_stress: float
    bearing_stress: float


def pin_strength(solution, joint, *, diameter, width, shear_planes=2) -> PinStrength:
    """Shear and bearing stress of a pin by the largest reaction of the turn.

    Parameters
    ----------
    solution : Solution
    joint : str
        Name of a reaction, "A", "B" ...
    diameter, width : float
        Diameter of the pin and width of the eye on it, m.
    shear_planes : int
        1 for a pin supported at one end, 2 in a fork.

    Returns
    -------
    PinStrength
        `.shear_stress`, `.bearing_stress`, `.largest_load`, `.table()`.

    Raises
    ------
    ParameterError
        A number is not positive; the mechanism does not close all round; a batch.
    QuantityError
        The reaction is unknown.

    Warns
    -----
    ConditionWarning
        The reaction grows without bound.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 0.0, crank_speed=33.5)
    >>> ks.sizing.pin_strength(s, "B", diameter=0.08, width=0.1)
    <PinStrength: largest_load 232310 N, shear_stress 23108000 Pa, bearing_stress 29038000 Pa>
    """
    values = {"diameter": diameter, "width": width, "shear_planes": shear_planes}
    d, b, planes = _numbers("pin_strength", solution, values).values()
    closed_turn(solution, "pin_strength")
    solution.reaction(joint)
    load = float(extremes(solution, joint).largest)
    return PinStrength((), load, 4.0 * load / (planes * np.pi * d * d), load / (d * b))


@dataclass(frozen=True, eq=False, repr=False)
class Rigidity(Sized):
    """Elastic motion of a bar or shaft that counts as rigid in the solution."""

    ROWS: ClassVar = {
        "natural_frequency": Row(
            "rad/s",
            "first bending mode between pins; machine on its shaft",
            "bar pi^2 sqrt(E I/(mu L^4)), with point masses Ritz; shaft sqrt(G J_p/(L J)), J mean reduced inertia",
        ),
        "order": Row("1", "natural frequency over crank speed", "natural frequency/omega"),
        "deflection": Row("1", "mid-span over length; twist, rad", "int M min(x, L - x) dx/(2 E I L); T L/(G J_p)"),
        "departure": Row(
            "1", "relative error of the rigid model", "r^2/(1 - r^2) by harmonic, r = n/order (Timoshenko)"
        ),
    }
    natural_frequency: float
    order: float
    deflection: float
    departure: float


def rigidity_of(solution, bars=None, shaft=None) -> dict[str, Rigidity]:
    """`Rigidity` of straight links, by a mapping to `Bar`, and of the "shaft", by a mapping of its numbers."""
    given = {"bars": {} if bars is None else bars, "shaft": {} if shaft is None else shaft}
    texts = {"bars": '{"coupler": ks.Bar(...)}', "shaft": f"{{{', '.join(f'{name!r}: ...' for name in SHAFT)}}}"}
    wrong = (f"{name} must be a dict, as {texts[name]}" for name in given if not isinstance(given[name], Mapping))
    checks.require("needs", *wrong)
    found = {link: bar_rigidity(solution, link, bar) for link, bar in given["bars"].items()}
    return found | ({"shaft": shaft_rigidity(solution, given["shaft"])} if given["shaft"] else {})


def bar_rigidity(solution, link, bar) -> Rigidity:
    """First bending frequency and deflection of a straight link, and the relative error of the rigid model."""
    _numbers("needs: bars", solution, {}, bar)
    sections = solution.sections(link, bar)
    stiffness, ends, number = bar.youngs_modulus * bar.second_moment, sections.stations, np.arange(1, SINES + 1)
    length = ends[-1]
    root = np.sqrt(0.5 * stiffness * (number * np.pi) ** 4 / length**3)
    shapes = (np.sqrt(mass) * np.sin(number * np.pi * x / length) / root for x, mass in bar.masses)
    compliance = np.diag(0.5 * sections.bar.mass / root**2) + sum(np.outer(shape, shape) for shape in shapes)
    with np.errstate(divide="ignore"):
        natural = 1.0 / np.sqrt(np.linalg.eigvalsh(compliance)[-1])
    edges = np.union1d(ends, 0.5 * length)
    half = 0.5 * np.diff(edges)
    x = np.ravel(edges[:-1] + half + GAUSS[0][:, None] * half)
    weight = np.ravel(GAUSS[1][:, None] * half) * np.minimum(x, length - x) / (2.0 * stiffness * length)
    part = np.searchsorted(ends, x) - 1

    def deflection(at):
        return weight @ evaluate(sections.polynomials(at)[2][:, part], x[:, None])

    return _against_harmonics("needs: bars", solution, deflection, natural)


def shaft_rigidity(solution, shaft) -> Rigidity:
    """Twist of a shaft with the balancing torque at the crank; the drive keeps its speed at the other end."""
    checks.require("needs: shaft", *(checks.choice("number", name, SHAFT) for name in shaft))
    values = {name: shaft.get(name) for name in SHAFT}
    length, polar_moment, shear_modulus = _numbers("needs: shaft", solution, values).values()
    stiffness = shear_modulus * polar_moment / length
    with np.errstate(divide="ignore"):
        natural = np.sqrt(stiffness / _evenly(closed_turn(solution, "needs: shaft")).reduced_inertia.mean())
    return _against_harmonics("needs: shaft", solution, lambda at: at.balancing_torque / stiffness, natural)


def _evenly(turn):
    """Solution at even crank angles; angles without correct digits are replaced by the nearest usable ones."""
    return turn.at.moved_to(turn.clear(np.linspace(0.0, turn.period, ANGLES, endpoint=False)))


def _against_harmonics(owner, solution, function, natural):
    """`Rigidity` by a natural frequency, rad/s, and the deflection of a rigid machine, a function of a solution."""
    speed = abs(float(np.mean(solution.crank_speed)))
    checks.require(owner, None if speed else "the crank is at rest, so nothing vibrates; solve it at its crank speed")
    series = np.fft.rfft(function(_evenly(solution.sampled)))
    squares = (np.arange(series.size) * TURN / solution.period * speed / natural) ** 2
    rounding = np.abs(series) <= MIN_HARMONIC * np.abs(series).max()
    with np.errstate(divide="ignore", invalid="ignore"):
        change = np.fft.irfft(np.where(rounding, 0.0, series * squares / (1.0 - squares)))
    largest = abs(float(extrema(solution, function).largest))
    departure = float(np.nan_to_num(np.abs(change).max(), nan=np.inf) / largest) if largest else 0.0  # inf at resonance
    return Rigidity((), float(natural), float(natural / speed), largest, departure)
