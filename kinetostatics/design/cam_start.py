"""Start of the search for a torque-free cam: the machine with a cam for the cosine law, and its varied numbers."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..cycle.extremes import extrema
from ..errors import DesignError, ParameterError
from ..machine.builders import cam_crank_slider, crank_slider, crank_slider_parts
from ..machine.cams.cam import Harmonic
from ..machine.cams.cams import CosineLaw
from ..machine.guide import Guide
from ..machine.loads import Gravity, Spring, TorsionSpring, spring_masses
from ..numbers import checks
from ..numbers.arithmetic import SQUARE_TOLERANCE
from ..numbers.planar import cross
from ..solution.scene import Scene

OWNER = "torque-free cam"
MAX_HARMONICS = 64
"""Largest number of harmonics of a search within a minute; with eight the remainder is below workshop accuracy."""
END_RULES = {"ends": checks.Optional(checks.Pair("m", parts=("low", "high")))}
OPTION_RULES: dict[str, tuple[str, dict]] = {
    "guide_offset": ("m", {}),
    "counterweight": ("kg", {"low": 0.0, "strict": True}),
    "coupler_spring": ("rad", {}),
    "shaft_radius": ("m", {"low": 0.0, "strict": True}),
}
"""Units and limits of optional parts."""
LENGTH_REACH = 0.5
"""Largest change of lengths from the start of the search, relative to half the stroke."""
MAX_STIFFNESS_RATIO = 3.0
"""Largest stiffness relative to the spring that balances the slider."""
HARMONIC_REACH = 0.1
"""Largest harmonics of random starts added to a circle about O, relative to half the stroke."""
WEIGHT_REACH = 0.1
"""Largest shift of the counterweight from the balance of the coupler's weight, relative to its arm."""
SPRING_PATH, OFFSET_PATH = "torsion_spring.stiffness", "guide_offset"
WEIGHT_PATHS = ("crank.centre.along", "crank.centre.across")


@dataclass(frozen=True)
class Machine:
    """A scene whose coupler keeps its mass centre at a share of its length."""

    scene: Scene
    share: float

    @property
    def units(self):
        return self.scene.units

    @property
    def parameters(self):
        return self.scene.parameters

    def varied(self, values):
        values = dict(values)
        if "coupler_length" in values:
            values.setdefault("coupler.centre.along", values["coupler_length"] * self.share)
        return Machine(self.scene.varied(values), self.share)


@dataclass(frozen=True)
class Start:
    """Start of a search: machine, extreme positions of its slider (m), and bounds of the numbers that vary by path.

    `first` are the paths that vary in the least squares of the torque. `weight` is that of the coupler on A across the
    guide to its left (N), `unit` the mean torque of a plain crank-slider with that stroke (N m).
    """

    machine: Machine
    ends: tuple[float, float]
    vary: dict
    first: frozenset[str]
    weight: float
    unit: float

    @property
    def scene(self):
        return self.machine.scene

    @property
    def half(self):
        return (self.ends[1] - self.ends[0]) / 2

    def random(self, names, start, generator):
        """A start with random harmonics within a tenth of the radius."""
        found = start.copy()
        for place, name in enumerate(names):
            if name.startswith(("cam.cosine", "cam.sine")):
                mean = self.half if name == "cam.cosine.0" else 0.0
                found[place] = mean + HARMONIC_REACH * self.half * generator.uniform(-1.0, 1.0)
        return found


@dataclass(frozen=True)
class Options:
    """Harmonics of the cam and optional parts, as in `torque_free_cam`."""

    cosine: int = 8
    sine: int = 0
    ends: Any = None
    gravity: bool = True
    guide_offset: float | None = None
    coupler_spring: float | None = None
    counterweight: float | None = None
    cubic: Any = None
    shaft_radius: float | None = None

    @classmethod
    def checked(cls, *problems, **given):
        """Checked options; one error lists their faults and the given `problems`."""
        asked = cls(**given)
        own = {name: (given[name], *rule) for name, rule in OPTION_RULES.items() if given.get(name) is not None}
        found = checks.single_numbers(
            OWNER,
            _harmonics_problem("cosine", asked.cosine),
            _harmonics_problem("sine", asked.sine) if asked.sine or asked.sine is False else None,
            checks.truth("gravity", asked.gravity),
            *problems,
            **own,
        )
        return replace(asked, **checks.check_values(OWNER, END_RULES, {"ends": asked.ends}), **found)


def _harmonics_problem(name, value):
    """Sentence about a wrong number of harmonics, or None."""
    wrong, too_many = checks.count(name, value), f"{name} must be at most {MAX_HARMONICS}, got {value}"
    return wrong or (too_many if value > MAX_HARMONICS else None)


def starting_machine(given, options) -> Start:
    """Start of a search, with the links and loads of a scene; an error for other machines or impossible strokes."""
    group, links = crank_slider_links(given)
    low, high = _ends(given, options.ends)
    half, mean = (high - low) / 2, (high + low) / 2
    law = CosineLaw(half, mean)
    offset = group.guide.guide_offset if options.guide_offset is None else options.guide_offset
    guide = Guide(group.guide.guide_angle, offset)
    share = group.coupler.centre[0] / group.coupler_length
    links["coupler"] = _coupler_of_length(group.coupler, law.coupler_length, share)
    spring = Spring(group.slider.mass * given.crank_speed * given.crank_speed, mean)
    if springs := spring_masses(given.loads):
        mass = springs["slider"].whole
        spring = Spring.balancing(group.slider.mass, given.crank_speed, mean, spring_mass=mass)
    replaced = Spring if options.gravity else (Spring, Gravity)
    loads = (*(item for item in given.loads if not isinstance(item, replaced)), spring)
    carried = group.coupler.mass * (1.0 - share)
    pulls = [item.vector for item in loads if isinstance(item, Gravity)]
    across = sum(float(cross(guide.direction, pull)) for pull in pulls)
    is_along = abs(across) <= SQUARE_TOLERANCE * sum(np.hypot(*pull) for pull in pulls)
    weight = 0.0 if is_along else carried * across
    length, reach = law.coupler_length, LENGTH_REACH * half
    vary = {
        "cam.cosine.0": (half - reach, half + reach),
        **{
            f"cam.{kind}.{order}": (-reach, reach)
            for kind, count in (("cosine", options.cosine), ("sine", options.sine))
            for order in range(1, count + 1)
        },
        "coupler_length": (length - reach, length + reach),
        "spring.stiffness": (0.0, MAX_STIFFNESS_RATIO * spring.stiffness),
        "spring.free_position": (mean - reach, mean + reach),
    }
    first = frozenset(vary)
    if options.cubic is not None:
        vary["spring.cubic"] = options.cubic
    if options.coupler_spring is not None:
        found = _weight_spring(weight * length, options.coupler_spring)
        loads += (found,)
        vary[SPRING_PATH] = (0.5 * found.stiffness, 1.5 * found.stiffness)
    if options.counterweight is not None:
        arm = -carried * half / options.counterweight
        links["crank"] = replace(links["crank"], mass=options.counterweight, centre=(arm, 0.0))
        first, near = first | {OFFSET_PATH}, WEIGHT_REACH * arm
        vary |= dict(zip(WEIGHT_PATHS, ((arm + near, arm - near), (near, -near)), strict=True))
        vary[OFFSET_PATH] = -reach, reach
    angle = np.linspace(0.0, 2 * np.pi, 1024, endpoint=False)
    series = np.fft.rfft(law.radius(angle)[0]).real / angle.size
    harmonics = (series[0], *2 * series[1 : options.cosine + 1])
    cam = Harmonic(harmonics, (0.0,) * options.sine, group.guide.guide_angle)
    mechanism = cam_crank_slider(cam, length, guide=guide, **links)
    scene = Scene(mechanism, given.crank_speed, loads=loads)
    unit = _mean_torque(half, mean, _coupler_of_length(links["coupler"], mean, share), group.slider, given.crank_speed)
    return Start(Machine(scene, share), (float(low), float(high)), vary, first, weight, unit)


def crank_slider_links(given):
    """Slider group of a crank-slider scene, and its links by name; an error for other scenes."""
    mechanism = given.mechanism
    roller, slider = crank_slider_parts(mechanism) or (None, None)
    if slider is None or slider.assembly != 1:
        raise ParameterError(
            "torque-free cam: needs a crank-slider, plain or with a cam, whose slider is ahead of A (assembly +1), "
            f"got {mechanism.name}"
        )
    links = {"crank": mechanism.crank.link, "coupler": slider.coupler, "slider": slider.slider}
    return slider, links | ({"block": roller.block} if roller else {})


def _ends(given, ends):
    """Extreme positions of the slider, m; by default those of the scene."""
    low, high = extrema(given.solve(12), "slider_position").range if ends is None else map(float, ends)
    if not (0 < low < high):
        raise DesignError(
            f"torque-free cam: the slider must stay ahead of O between two ends, but would move from {low:.6g} m to "
            f"{high:.6g} m; lengthen the coupler or shorten the stroke"
        )
    return low, high


def _coupler_of_length(coupler, length, share):
    """The coupler with its mass centre at a share of a length."""
    return replace(coupler, centre=(share * length, coupler.centre[1]))


def _mean_torque(crank_length, coupler_length, coupler, slider, speed):
    """Mean torque of a plain crank-slider, N m."""
    plain = crank_slider(crank_length, coupler_length, coupler=coupler, slider=slider)
    found = float(np.mean(np.abs(Scene(plain, speed).solve(360).balancing_torque)))
    if not found:
        raise DesignError("torque-free cam: without masses or at rest the machine already needs no torque")
    return found


def _weight_spring(moment, free_angle):
    """Torsion spring with a given moment on the coupler where the coupler lies along the guide."""
    if not moment:
        raise ParameterError("torque-free cam: coupler_spring carries weight across the guide, but none acts")
    if not moment * free_angle > 0:
        side = "negative" if moment < 0 else "positive"
        raise ParameterError(f"torque-free cam: coupler_spring, a free angle, must be {side}, got {free_angle:g} rad")
    return TorsionSpring(moment / free_angle, free_angle, on="coupler", against="slider")
