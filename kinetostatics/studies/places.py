"""Places where methods may fail: families of scenes with one number that leads toward each."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..machine.builders import cam_crank_slider, crank_slider, four_bar, slotted_lever
from ..machine.cams.cams import Circle, CosineLaw
from ..machine.links import Link
from ..machine.loads import Gravity, Spring
from ..numbers.arithmetic import UNIT
from ..solution.solution import Solution

SPEED = 320 * math.pi / 30
DISTANCES = tuple(10.0**k for k in range(-17, 0))


@dataclass(frozen=True)
class Place:
    """Where methods may fail.

    Attributes
    ----------
    name : str
    axis : str
        What the number is that leads toward it, with its unit.
    numbers : tuple of float
    scene : function
        Solution for one number.
    quantity : str

    Examples
    --------
    >>> import kinetostatics as ks
    >>> place = ks.stability.PLACES[0]
    >>> place.name, place.axis, place.quantity
    ('dead centres, inclined guide', 'crank angle from there [rad]', 'slider_position')
    >>> place.scene(1e-6).shape
    (400,)
    """

    name: str
    axis: str
    numbers: tuple[float, ...]
    scene: Callable[[float], Solution]
    quantity: str


def _solution(mechanism, angle, loads=(Gravity(),)):
    return Solution(mechanism, np.asarray(angle, dtype=float), SPEED, 0.0, tuple(loads))


def _saw(size=1.0, mass=1.0, **lengths):
    """Sawframe-like plain crank-slider; any size, any mass."""
    given = {"crank_length": 0.3, "coupler_length": 2.0, "guide_offset": 0.0, "guide_angle": 0.0} | lengths
    return crank_slider(
        given["crank_length"] * size,
        given["coupler_length"] * size,
        guide_offset=given["guide_offset"] * size,
        guide_angle=given["guide_angle"],
        coupler=Link(150.0 * mass, 0.5 * given["coupler_length"] * size, 20.5 * mass * size**2),
        slider=Link(600.0 * mass),
    )


def _chain_unit(crank=0.1, coupler=0.4, rocker=0.3, pivot=(0.35, 0.1)):
    return four_bar(
        crank,
        coupler,
        rocker,
        rocker_pivot=pivot,
        crank=Link(1.0, crank / 2, 1e-3),
        coupler=Link(4.0, coupler / 2, 5e-2),
        rocker=Link(3.0, rocker / 2, 3e-2),
    )


def _around(angle, distance, count=200):
    return angle + distance * np.linspace(-1.0, 1.0, count)


def _before(angle, distance, count=20):
    return angle - distance * np.linspace(0.5, 1.0, count)


def _turn(count=90):
    return np.linspace(0.0, 2 * np.pi, count, endpoint=False)


def _dead_centre(distance):
    """Guide through O; no length is a power of two, so that points on the guide round as they do elsewhere."""
    mechanism = _saw(coupler_length=2.2, guide_angle=1.3)
    return _solution(mechanism, np.concatenate([_around(1.3, distance), _around(1.3 + math.pi, distance)]))


def _limit_position(distance):
    """Crank longer than the coupler; the coupler stands across the guide at 40 degrees of crank angle."""
    angle = math.radians(40.0)
    coupler = float(np.nextafter(2.0 * math.sin(angle), 3.0))
    return _solution(_saw(crank_length=2.0, coupler_length=coupler), _before(angle, distance))


def _barely_long_enough(distance):
    coupler = 0.5 * (1.0 + distance)
    mechanism = _saw(crank_length=0.3, coupler_length=coupler, guide_offset=0.2)
    return _solution(mechanism, np.radians(270.0) + np.linspace(-0.5, 0.5, 21))


def _singular_angle(distance):
    cam = CosineLaw(0.3, 2.0)
    mechanism = cam_crank_slider(cam, cam.coupler_length, coupler=Link(150.0, 1.0, 20.5), slider=Link(600.0))
    spring = Spring.balancing(600.0, SPEED, 2.0)
    return _solution(mechanism, _around(float(cam.singular_angle), distance, 60), [Gravity(), spring])


def _pressure_angle(distance):
    cam = Circle(0.3, (-0.3 * (1.0 - distance), 0.0))
    mechanism = cam_crank_slider(cam, 2.0, coupler=Link(150.0, 1.0, 20.5), slider=Link(600.0))
    return _solution(mechanism, np.radians(90.0) + np.linspace(-0.01, 0.01, 21))


def _toggle(distance):
    """Coupler and rocker stretched into one line: as far as this crank can turn."""
    crank, coupler, rocker, pivot = 0.3, 0.4, 0.2, 0.7
    angle = math.acos((crank**2 + pivot**2 - (coupler + rocker) ** 2) / (2 * crank * pivot))
    just_closing = rocker * (1.0 + 8.0 * UNIT)
    return _solution(_chain_unit(crank, coupler, just_closing, (pivot, 0.0)), _before(angle, distance))


def _change_point(distance):
    mechanism = _chain_unit(0.2, 0.5, 0.2, (0.5, 0.0))
    return _solution(mechanism, np.concatenate([_before(0.0, distance), -_before(0.0, distance)]))


def _just_turning(distance):
    """Crank and ground in one line are a little shorter than coupler and rocker: the crank only just gets through."""
    crank, coupler, ground = 0.3, 0.45, 0.7
    mechanism = _chain_unit(crank, coupler, (crank + ground - coupler) * (1.0 + distance), (ground, 0.0))
    return _solution(mechanism, math.pi + math.sqrt(distance) * np.linspace(-2.0, 2.0, 21))


def _just_sliding(distance):
    """The block of a slotted lever all but reaches the foot of the pivot on the slot."""
    lever, block = Link(3.0, 0.2, 5e-2), Link(1.0)
    mechanism = slotted_lever(0.1, pivot=(0.2, 0.0), offset=0.1 * (1.0 - distance), lever=lever, block=block)
    return _solution(mechanism, math.sqrt(distance) * np.linspace(-2.0, 2.0, 22))


def _folding(crank, coupler, rocker, frame, *angles):
    """Scene by distance of a four-bar before its links come to lie in one line at these crank angles, and beyond."""

    def scene(distance):
        mechanism = _chain_unit(crank, coupler, rocker, (frame, 0.0))
        steps = np.concatenate([_before(0.0, distance, 10), -_before(0.0, distance, 10)])
        return _solution(mechanism, np.concatenate([angle + steps for angle in angles]))

    return scene


def _equal_links(distance):
    """Crank as long as the coupler: across the guide they lie in one line, one over the other."""
    mechanism = _saw(crank_length=0.3, coupler_length=0.3)
    return _solution(mechanism, 0.5 * math.pi + np.concatenate([_before(0.0, distance), -_before(0.0, distance)]))


def _size(size):
    return _solution(_saw(size=size, guide_offset=0.1), _turn(), ())


def _mass_ratio(ratio):
    mass = math.sqrt(ratio)
    mechanism = crank_slider(
        0.3,
        2.0,
        coupler=Link(mass, 1.0, 0.1 * mass),
        slider=Link(1.0 / mass),
        crank=Link(mass, 0.1),
    )
    return _solution(mechanism, _turn())


def _many_turns(angle):
    return _solution(_saw(guide_offset=0.1), angle + _turn())


def _nearly_balanced(share):
    """Spring and slider cancel; what is left is the torque of a coupler that has a small share of its mass."""
    cam = CosineLaw(0.3, 2.0)
    coupler = Link(150.0 * share, 1.0, 20.5 * share)
    mechanism = cam_crank_slider(cam, cam.coupler_length, coupler=coupler, slider=Link(600.0))
    return _solution(mechanism, _turn(), [Spring.balancing(600.0, SPEED, 2.0)])


_DISTANCE = "crank angle from there [rad]"
_IN_LINE = "crank angle from all links in line [rad]"
_SCALES = tuple(10.0**k for k in range(-9, 10))
PLACES = (
    Place("dead centres, inclined guide", _DISTANCE, DISTANCES, _dead_centre, "slider_position"),
    Place("limit position", _DISTANCE, DISTANCES, _limit_position, "O"),
    Place("coupler barely long enough", "excess of the coupler's length [1]", DISTANCES, _barely_long_enough, "O"),
    Place("singular angle of the cosine cam", _DISTANCE, DISTANCES, _singular_angle, "cam_force"),
    Place(
        "pressure angle toward 90 deg",
        "distance of O from the pitch circle [radii]",
        DISTANCES[2:],
        _pressure_angle,
        "cam_force",
    ),
    Place("four-bar toggle", _DISTANCE, DISTANCES, _toggle, "O"),
    Place("four-bar change point", _IN_LINE, DISTANCES, _change_point, "O"),
    Place("four-bar that only just turns", "excess of the rocker's length [1]", DISTANCES[2:], _just_turning, "O"),
    Place("slotted lever that only just turns", "what the slot's offset lacks [1]", DISTANCES[2:], _just_sliding, "O"),
    Place("rhombus", _IN_LINE, DISTANCES, _folding(0.3, 0.3, 0.3, 0.3, 0.0, math.pi), "O"),
    Place("kite", _IN_LINE, DISTANCES, _folding(0.2, 0.2, 0.5, 0.5, math.pi), "O"),
    Place(
        "kite, A passing O2",
        "crank angle from A on O2 [rad]",
        DISTANCES,
        _folding(0.2, 0.5, 0.5, 0.2, 0.0),
        "balancing_torque",
    ),
    Place("parallelogram, folded", _IN_LINE, DISTANCES, _folding(0.2, 0.5, 0.2, 0.5, math.pi), "O"),
    Place("coupler as long as the crank", _IN_LINE, DISTANCES, _equal_links, "O"),
    Place("size", "size, times the sawframe's [1]", _SCALES, _size, "O"),
    Place(
        "unequal masses",
        "mass of coupler and crank over slider's [1]",
        tuple(10.0**k for k in range(-24, 1, 4)),
        _mass_ratio,
        "balancing_torque",
    ),
    Place("many turns", "crank angle [rad]", tuple(10.0**k for k in range(8)), _many_turns, "balancing_torque"),
    Place("nearly balanced", "share of the coupler's mass [1]", DISTANCES, _nearly_balanced, "balancing_torque"),
)
