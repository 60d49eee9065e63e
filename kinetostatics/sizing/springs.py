"""Helical springs of round wire: stress, fatigue, set, buckling, mass and surge; the lightest for a stress or safety.

With the force F of one spring, the mean diameter D of its coils, the wire d, the index C = D / d and N active turns

    stress  K 8 F D / (pi d^3)    stiffness  G d^4 / (8 D^3 N)    mass  rho pi^2 d^2 D N / 4

K is Ks = 1 + 0.5 / C for static forces, Wahl's (4 C - 1) / (4 C - 4) + 0.615 / C for alternating forces (Wahl,
*Mechanical Springs*, 1963; Norton, *Machine Design*, chapter 14). Without K all wire stores tau^2 / (4 G) per volume,
so the mass for an energy depends only on the stress, not on wire, index or count.
"""

from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar

import numpy as np

from ..errors import ParameterError
from ..machine.cams.profile import POSITIVE
from ..machine.loads.surge import surge_frequency
from ..numbers import checks
from .result import Row, Sized, warn_of_notes

NUMBERS = {
    **dict.fromkeys(("travel", "wire_diameter", "coil_diameter"), ("m", POSITIVE)),
    **dict.fromkeys(("active_turns", "end_factor"), ("1", POSITIVE)),
    "stiffness": ("N/m", POSITIVE),
    "preload": ("N", {"low": 0.0}),
    "allowed_stress": ("Pa", POSITIVE),
    "safety": ("1", POSITIVE | {"high": 100.0}),
    "index": ("1", {"low": 1.0, "strict": True}),
    "crank_speed": ("rad/s", {}),
    "carried_mass": ("kg", POSITIVE),
    "surge_excitation": ("m", {"low": 0.0}),
}
"""Unit and rule of each number of this module."""
CORRECTIONS = {
    "none": lambda index: 1.0,
    "Ks": lambda index: 1.0 + 0.5 / index,
    "Wahl": lambda index: (4.0 * index - 1.0) / (4.0 * index - 4.0) + 0.615 / index,
}
"""Factors of the stress by the index."""
END_TURNS, CLASH_SHARE, SHEAR_SHARE = 2.0, 0.15, 0.67
"""Inactive turns of squared and ground ends; clearance at the largest force over the travel; ultimate strength in
torsion over that in tension (Norton; Shigley)."""
INDICES, LEAST_TURNS, LEAST_SURGE_RATIO = (4.0, 12.0), 3.0, 13.0
"""Range of the index that is easily coiled; least active turns; least surge ratio (Norton; Shigley)."""
WIRE_RANGE = 1e-6, 1e6
"""Wire diameters of the search over that at a stress of G."""
SAFE = 1.0 - 1e-9
"""Least safety without a note: 1 to rounding."""
REMEDIES = {
    "fatigue_safety": "it fails by fatigue; allow less stress by thicker wire, or use peened wire",
    "static_safety": "it sets; allow less stress by thicker wire",
    "solid_safety": "it sets if its coils close; give it a stop before that",
    "buckling_safety": "it buckles; guide it on a rod or in a tube",
}
"""Remedy for a safety below 1."""
_positive = partial(checks.Number, low=0.0, strict=True)


@dataclass(frozen=True, eq=False)
class SpringMaterial(checks.Checked):
    """Wire of a spring, with the source of its numbers.

    Parameters
    ----------
    name, source : str
    strength, exponent : float
        Tensile strength of wire with the diameter d: strength (d / 1 mm)^-exponent, Pa.
    thinnest, thickest : float
        Wires of known strength, m. Beyond them the strength of the nearest is used, with a note.
    shear_modulus, youngs_modulus, density : float
        Pa and kg/m3.
    set_share : float
        Stress in torsion at which the spring sets, over the tensile strength.
    unpeened, peened : (mean, alternating)
        Stresses in torsion for endless life, Pa; by default Zimmerli's values, which apply to all spring steels.

    Raises
    ------
    ParameterError
        A number is out of its range, or a mean stress of endless life exceeds the ultimate stress of the thickest wire.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> own = ks.sizing.SpringMaterial("51CrV4", 1.9e9, 0.15, 5e-4, 0.06, 78.5e9, 206e9, 0.5, source="mill")
    >>> round(own.tensile_strength(0.01) / 1e6)  # MPa
    1345
    """

    name: str
    strength: float
    exponent: float
    thinnest: float
    thickest: float
    shear_modulus: float
    youngs_modulus: float
    set_share: float
    density: float = 7850.0
    unpeened: tuple[Any, Any] = (379e6, 241e6)
    peened: tuple[Any, Any] = (534e6, 398e6)
    source: str = ""

    RULES = checks.Rules(
        "spring material",
        also=lambda item: item._faults(),
        exponent=checks.Number("1", low=0.0),
        set_share=_positive("1"),
        density=_positive("kg/m**3"),
        **dict.fromkeys(("thinnest", "thickest"), _positive("m")),
        **dict.fromkeys(("strength", "shear_modulus", "youngs_modulus"), _positive("Pa")),
        **dict.fromkeys(("unpeened", "peened"), checks.Pair("Pa", parts=("mean", "alternating"))),
    )

    def _faults(self):
        if not self.thinnest <= self.thickest:
            yield f"thinnest must not exceed thickest, got {self.thinnest:g} and {self.thickest:g} m"
        if not self.shear_modulus < self.youngs_modulus:
            moduli = f"{self.shear_modulus:g} and {self.youngs_modulus:g} Pa"
            yield f"shear_modulus must be less than youngs_modulus, got {moduli}"
        ultimate = SHEAR_SHARE * self.tensile_strength(self.thickest)
        for name in ("unpeened", "peened"):
            mean, alternating = getattr(self, name)
            if not (0.0 <= mean < ultimate and alternating > 0.0):
                yield (
                    f"{name} must be a mean from 0 to less than {ultimate:.4g} Pa (ultimate stress in torsion of the "
                    f"thickest wire), and an alternating stress above 0. Got {mean:.4g} and {alternating:.4g} Pa"
                )

    def tensile_strength(self, wire_diameter):
        """Tensile strength of a wire, Pa."""
        return self.strength * (min(max(wire_diameter, self.thinnest), self.thickest) / 1e-3) ** -self.exponent


_MUSIC = ("music wire", 2153.5e6, 0.1625, 0.3e-3, 6e-3, 79.3e9, 206.8e9, 0.45)
_CRSI = ("EN 10270-2 CrSi", 2100e6, 0.106, 1.3e-3, 6.5e-3, 79.5e9, 206e9, 0.5)
MATERIALS = {
    "music wire": SpringMaterial(*_MUSIC, source="ASTM A228; Norton, Machine Design, chapter 14"),
    "EN 10270-2 CrSi": SpringMaterial(*_CRSI, source="EN 10270-2:2011, lower bound of VDSiCr; moduli of EN 13906-1"),
}


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class HelicalSpring(Sized):
    """Helical springs of given wire: stress, safety, length, mass and surge.

    Parameters
    ----------
    wire_diameter, coil_diameter : float
        m; `coil_diameter` is the mean diameter, greater than that of the wire.
    active_turns : float
        Active turns of each spring.
    travel : float
        Travel between the ends of the stroke, m.
    preload, material, arrangement, count, peened, crank_speed, end_factor
        As for `helical_spring`.

    Attributes
    ----------
    springs, amplitude, largest_force
        Number of springs, two in an opposed pair; forces of each, N.
    ultimate_stress, set_stress, endurance
        Stresses in torsion, Pa; `endurance` is (mean, alternating) for endless life.

    Raises
    ------
    ParameterError
        As for `helical_spring`, or the wire is not thinner than the coils.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> given = {"wire_diameter": 5e-3, "coil_diameter": 0.045, "active_turns": 4.5, "travel": 0.025}
    >>> found = ks.sizing.HelicalSpring(**given, preload=470.0)
    >>> print(f"{found.mean_stress / 1e6:.0f} MPa, fatigue safety {found.fatigue_safety:.2f}")
    455 MPa, fatigue safety 1.77
    """

    wire_diameter: float
    coil_diameter: float
    active_turns: float
    travel: float
    preload: Any = None
    material: Any = "music wire"
    arrangement: str = "push-pull"
    count: int = 1
    peened: bool = True
    crank_speed: float = 0.0
    end_factor: float = 0.5
    notes: tuple[str, ...] = field(init=False)
    springs: int = field(init=False)
    amplitude: float = field(init=False)
    largest_force: float = field(init=False)
    endurance: tuple[float, float] = field(init=False)
    ultimate_stress: float = field(init=False)
    set_stress: float = field(init=False)
    stiffness: float = field(init=False)
    mass: float = field(init=False)
    whole_mass: float = field(init=False)
    solid_length: float = field(init=False)
    free_length: float = field(init=False)
    initial_stress: float = field(init=False)
    mean_stress: float = field(init=False)
    alternating_stress: float = field(init=False)
    static_safety: float = field(init=False)
    solid_safety: float = field(init=False)
    surge_frequency: float = field(init=False)
    surge_ratio: float = field(init=False)

    ROWS: ClassVar[dict[str, Row]] = {
        "wire_diameter": Row("m", "diameter of the wire", "d"),
        "coil_diameter": Row("m", "mean diameter of the coils", "D"),
        "active_turns": Row("1", "active turns", "N = G d^4 / (8 D^3 k), Wahl 1963"),
        "stiffness": Row("N/m", "stiffness of all springs", "sum of G d^4 / (8 D^3 N), Wahl 1963"),
        "mass": Row("kg", "active turns of all springs", "sum of rho pi^2 d^2 D N / 4"),
        "whole_mass": Row("kg", "with 2 end turns each", "mass (N + 2) / N"),
        "solid_length": Row("m", "length with coils closed", "(N + 2) d, ends squared and ground, Norton"),
        "free_length": Row("m", "length without force", "solid length + F max / k + 0.15 travel, Norton"),
        "initial_stress": Row("Pa", "stress at the least force, 0 if it pulls", "Ks 8 F D / (pi d^3), Norton"),
        "mean_stress": Row("Pa", "stress at mid-travel", "Ks 8 F D / (pi d^3), Ks = 1 + 0.5 / C, Norton"),
        "alternating_stress": Row("Pa", "half the range of stress", "Kw 8 F D / (pi d^3), Wahl 1963"),
        "fatigue_safety": Row("1", "endless life, as the travel grows", "Haigh: Zimmerli's stresses, Norton"),
        "static_safety": Row("1", "against set at the largest force", "set share Rm / (Ks 8 F D / (pi d^3)), Norton"),
        "solid_safety": Row("1", "against set with coils closed", "the same at F max + 0.15 travel k, Norton"),
        "buckling_safety": Row("1", "deflection at which it buckles over the largest", "Wahl 1963; Shigley"),
        "surge_frequency": Row("Hz", "first natural frequency between fixed ends", "sqrt(k / m) / 2, Wahl 1963"),
        "surge_ratio": Row("1", "surge frequency over crank frequency", "pi sqrt(k / m) / crank speed, Wahl 1963"),
    }

    def __post_init__(self):
        vars(self).update(_checked("helical spring", **vars(self)))
        wire, coil, turns, travel = self.wire_diameter, self.coil_diameter, self.active_turns, self.travel
        if not coil > wire:
            problem = f"coil_diameter must be greater than wire_diameter, got {coil:g} and {wire:g} m"
            raise ParameterError(f"helical spring: {problem}")
        material, opposed = self.material, self.arrangement == "opposed"
        each = material.shear_modulus * wire**4 / (8.0 * coil**3 * turns)
        amplitude = 0.5 * travel * each
        preload = amplitude * opposed if self.preload is None else self.preload
        if opposed and preload < amplitude * (1.0 - 1e-12):
            least = f"preload must be at least {amplitude:.6g} N, or an opposed spring loses its load"
            raise ParameterError(f"helical spring: {least}, got {preload:.6g} N")
        springs, strength = self.count * (1 + opposed), material.tensile_strength(wire)
        mass = springs * material.density * np.pi**2 * wire**2 * coil * turns / 4.0
        surge = float(surge_frequency(springs * each, mass))
        solid, clash, largest = (turns + END_TURNS) * wire, CLASH_SHARE * travel, preload + amplitude
        set_stress = material.set_share * strength
        vars(self).update(
            preload=preload,
            springs=springs,
            amplitude=amplitude,
            largest_force=largest,
            endurance=material.peened if self.peened else material.unpeened,
            ultimate_stress=SHEAR_SHARE * strength,
            set_stress=set_stress,
            stiffness=springs * each,
            mass=mass,
            whole_mass=mass * (1.0 + END_TURNS / turns),
            solid_length=solid,
            free_length=solid + largest / each + clash,
            initial_stress=self.stress(max(preload - amplitude, 0.0)),
            mean_stress=self.stress(preload),
            alternating_stress=self.stress(amplitude, "Wahl"),
            static_safety=set_stress / self.stress(largest),
            solid_safety=set_stress / self.stress(largest + clash * each),
            surge_frequency=surge / (2.0 * np.pi),
            surge_ratio=surge / abs(self.crank_speed) if self.crank_speed else np.inf,
        )
        vars(self).update(notes=tuple(self._notes()))

    def stress(self, force, correction="Ks"):
        """Stress at a force of each spring, Pa, with the factor "none", "Ks" or "Wahl"."""
        checks.require("stress", checks.choice("correction", correction, tuple(CORRECTIONS)))
        factor = CORRECTIONS[correction](self.coil_diameter / self.wire_diameter)
        return factor * 8.0 * force * self.coil_diameter / (np.pi * self.wire_diameter**3)

    def alternating_limit(self, mean):
        """Alternating stress for endless life at a mean stress, Pa.

        Up to the mean stress of Zimmerli's tests it is constant; above, it falls linearly to the ultimate stress.
        """
        tested, alternating = self.endurance
        return alternating * np.minimum((self.ultimate_stress - mean) / (self.ultimate_stress - tested), 1.0)

    @property
    def fatigue_safety(self):
        """Factor on the stresses above the initial stress at the limit of endless life."""
        tested, alternating = self.endurance
        rise = self.alternating_stress / alternating
        rest = self.ultimate_stress - self.initial_stress
        along = rest / (rise * (self.ultimate_stress - tested) + (self.mean_stress - self.initial_stress))
        return float(max(min(1.0 / rise, along), 0.0))

    @property
    def buckling_safety(self):
        """Deflection at which the spring buckles over the largest; infinite if it never buckles."""
        shear, young = self.material.shear_modulus, self.material.youngs_modulus
        slender = self.end_factor * self.free_length / self.coil_diameter
        bound = 2.0 * np.pi**2 * (young - shear) / (2.0 * shear + young) / slender**2
        if bound >= 1.0:
            return np.inf
        deflection = 0.5 * young / (young - shear) * self.free_length * (1.0 - np.sqrt(1.0 - bound))
        return float(deflection * self.stiffness / (self.springs * self.largest_force))

    def _notes(self):
        """Sentences on points to check."""
        wire, low, high = (1e3 * d for d in (self.wire_diameter, self.material.thinnest, self.material.thickest))
        if not low <= wire <= high:
            known = f"strength of {self.material.name} is known from {low:g} to {high:g} mm"
            yield f"wire of {wire:.4g} mm: {known}; that of {high if wire > high else low:g} mm is used"
        index = self.coil_diameter / self.wire_diameter
        if not INDICES[0] <= index <= INDICES[1]:
            yield f"index {index:.3g}: wire is easily coiled with an index of {INDICES[0]:g} to {INDICES[1]:g}"
        if self.active_turns < LEAST_TURNS:
            advice = "choose a smaller index, or more springs"
            yield f"{self.active_turns:.3g} active turns; textbooks recommend {LEAST_TURNS:g}: {advice}"
        for name, remedy in REMEDIES.items():
            if (safety := getattr(self, name)) < SAFE:
                yield f"{name.replace('_', ' ')} is {safety:.3g}, below 1: {remedy}"
        if self.surge_ratio < LEAST_SURGE_RATIO:
            yield f"surge ratio {self.surge_ratio:.3g}; textbooks recommend {LEAST_SURGE_RATIO:g}, as coils may clash"


def helical_spring(
    stiffness,
    travel,
    *,
    preload=None,
    material="music wire",
    arrangement="push-pull",
    count=1,
    allowed_stress=None,
    correction="Wahl",
    safety=1.2,
    index=8.0,
    peened=True,
    crank_speed=0.0,
    end_factor=0.5,
):
    """Lightest helical springs of a stiffness for an allowed stress, or for a safety.

    Parameters
    ----------
    stiffness : float
        Stiffness of all springs together, N/m.
    travel : float
        Travel between the ends of the stroke, m.
    preload : float, optional
        Force of each spring at mid-travel, in compression, N. By default 0 for "push-pull", and for "opposed" the
        smallest that keeps each spring in compression.
    material : str or SpringMaterial
        "music wire" or "EN 10270-2 CrSi", or your own.
    arrangement : "push-pull" or "opposed"
        Springs in compression and tension, or pairs of compression springs against each other.
    count : int
        Number of equal springs, or of equal pairs.
    allowed_stress : float, optional
        Pa, at the largest force; by default `safety` decides.
    correction : "none", "Ks" or "Wahl"
        Correction factor in the allowed stress.
    safety : float
        Least of the fatigue and static safety.
    index : float
        Mean diameter of the coils over that of the wire.
    peened : bool
        Whether the wire is shot-peened, which raises its stresses for endless life.
    crank_speed : float
        rad/s, for the surge ratio.
    end_factor : float
        Buckling length over free length: 0.5 between parallel plates, 1 with hinged ends, 2 with one end free.

    Returns
    -------
    HelicalSpring

    Raises
    ------
    ParameterError
        A number is not positive or finite, the material is unknown, or an opposed spring loses its load.

    Warns
    -----
    HintWarning
        Each note of the result.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found = ks.sizing.helical_spring(20e3, 0.02, preload=400.0, safety=1.3)
    >>> print(f"wire {found.wire_diameter * 1e3:.2f} mm, {found.active_turns:.1f} turns, {found.mass:.3f} kg")
    wire 4.74 mm, 4.6 turns, 0.075 kg
    """
    return warn_of_notes("helical_spring", lightest("helical_spring", **locals()))


def _checked(owner, *, material, arrangement, count, peened, correction="none", **numbers):
    """The options with numbers as floats and the material's data; one error with all faults."""
    given = {
        name: (value, *NUMBERS[name])
        for name, value in numbers.items()
        if value is not None or name not in ("preload", "allowed_stress")
    }
    found = checks.single_numbers(
        owner,
        None if isinstance(material, SpringMaterial) else checks.choice("material", material, tuple(MATERIALS)),
        checks.choice("arrangement", arrangement, ("push-pull", "opposed")),
        checks.count("count", count),
        checks.truth("peened", peened),
        checks.choice("correction", correction, tuple(CORRECTIONS)),
        **given,
    )
    material = MATERIALS.get(material, material)
    return found | {"material": material, "arrangement": arrangement, "count": count, "peened": peened}


def lightest(owner, *, correction, **options):
    """The `HelicalSpring` of the arguments of `helical_spring`, without warnings."""
    given = _checked(owner, correction=correction, **options)
    stiffness, index, safety = (given.pop(name) for name in ("stiffness", "index", "safety"))
    allowed, shear = given.pop("allowed_stress", None), given["material"].shear_modulus
    opposed = given["arrangement"] == "opposed"
    each = stiffness / (given["count"] * (1 + opposed))
    amplitude = 0.5 * each * given["travel"]
    load = 8.0 * index * (amplitude + given.get("preload", amplitude * opposed)) / np.pi

    def made(wire):
        turns = shear * wire / (8.0 * index**3 * each)
        return HelicalSpring(wire_diameter=wire, coil_diameter=index * wire, active_turns=turns, **given)

    if allowed is not None:
        return made(float(np.sqrt(CORRECTIONS[correction](index) * load / allowed)))
    from scipy.optimize import brentq

    def surplus(exponent):
        spring = made(unit * np.exp(exponent))
        return min(spring.fatigue_safety, spring.static_safety) / safety - 1.0

    unit, ends = np.sqrt(load / shear), np.log(WIRE_RANGE)
    return made(float(unit * np.exp(brentq(surplus, *ends, xtol=1e-13))))
