"""First keys of an added group, load or friction pair, from the motion of the machine, so that it can be assembled."""

import json
import string
from dataclasses import MISSING, fields
from itertools import combinations
from typing import Any

import numpy as np

from ...machine.friction import friction_kind
from ...machine.group import FRAME
from .forms import SEGMENTS

ANGLES = 72
"""Crank angles at which the path of a joint is computed."""
MM_DECIMALS = 6
"""Decimals of proposed lengths in mm."""
MIN_CHANGE = 1e-6
"""Least change of the distance of two joints for a dyad, over the distance."""
SCALE = 0.1
"""Radius of the path of a joint, m, where there is none: of a crank without a length."""
MASS = {"mass": "1 kg"}
BODY = {"mass": "1 kg", "inertia": "0.01 kg m^2"}
"""Of the last link of a group, so that forces flow; of one that turns."""
CAMS: dict[str, dict[str, Any]] = {
    "circle": {"radius": "200 mm"},
    "cosine-law": {"amplitude": "100 mm", "mean": "500 mm"},
    "harmonic": {"cosine": ["200 mm", "0 mm", "5 mm"]},
    "cosine": {"amplitude": "10 mm", "mean": "60 mm"},
    "joined": {"segments": SEGMENTS},
}
"""Required keys by the kind of a cam or law."""
FRICTION = {"mu": 0.1, "radius": "20 mm", "pin_radius": "15 mm", "roller_radius": "40 mm"}
"""Keys of friction; those that a pair has are proposed."""


def proposed_group(kind, mechanism):
    """Keys of a group of a kind attached to a mechanism, without a label."""
    layout = Layout(mechanism)
    (x, y), r = layout.centre, layout.radius
    pin, pivot = {"pin": layout.free_name("B")}, {"pivot_name": layout.free_pivot}
    on = {"on": layout.joint}
    turned = 90 * sum(layout.joint in group.hangs_on for group in mechanism.groups if group.guides)
    offset = y * np.cos(np.radians(turned)) - x * np.sin(np.radians(turned))
    level = {"guide_angle": f"{turned % 360} deg", "guide_offset": _mm(offset)}
    match kind:
        case "slider":
            return {"coupler_length": _mm(4 * r), **level, **on, **pin, "slider": MASS}
        case "rocker":
            bars = {"coupler_length": _mm(4 * r), "rocker_length": _mm(3 * r), "pivot": _point(x + 3.5 * r, y + r)}
            return {**bars, **on, **pin, **pivot, "rocker": BODY}
        case "lever":
            return {"pivot": _point(x, y - 2.4 * r), **on, **pivot, "lever": BODY}
        case "cylinder":
            return {"pivot": _point(x - 4 * r, y), **on, **pivot, "cylinder": BODY}
        case "yoke":
            return {**level, **on, **pin, "slider": MASS}
        case "planetary crank":
            return {"radius": _mm(r), **pin, "planet": MASS}
        case "dyad":
            first, second, apart = layout.two_joints
            return {
                "length1": _mm(0.75 * apart),
                "length2": _mm(0.75 * apart),
                "on": [first, second],
                **pin,
                "dyad2": MASS,
            }
        case "pin":
            link, length = layout.bar
            return {"on": link, "at": [_mm(length), "0 mm"], "name": layout.free_name("C")}
        case "cam roller":
            return {"cam": {"kind": "circle", **CAMS["circle"]}, "block": MASS}
        case "swinging follower":
            law = {"kind": "cosine", "amplitude": "5 deg", "mean": "40 deg"}
            return {
                "arm_length": _mm(2 * r),
                "pivot": _point(3 * r, 0.0),
                "cam": law,
                "pin": layout.free_name("R"),
                **pivot,
                "arm": BODY,
            }
    law = {"kind": "cosine", **CAMS["cosine"]}
    return {"cam": law, "guide_angle": "90 deg", "pin": layout.free_name("R"), "follower": MASS}


def proposed_load(kind, mechanism):
    """Keys of a load of a kind on a mechanism."""
    layout = Layout(mechanism)
    slider, swinging = layout.slider, layout.swinging_link
    position = layout.middle_of(slider) if slider else 0.0
    on = {"on": slider} if slider else {}
    x, y = layout.centre
    match kind:
        case "gravity":
            return {"direction": "-90 deg"}
        case "spring":
            return {"stiffness": "10 kN/m", "free_position": _mm(position), **on}
        case "process force":
            return {"force": "-500 N", **on}
        case "sawing":
            cut = {"kerf": "3 mm", "height": "250 mm", "saws": 8, "feed_per_stroke": "20 mm"}
            return {**cut, "resistance": "50 MPa", **on}
        case "mowing":
            return {"force": "600 N", "pitch": "76.2 mm", "start": "26 mm", "end": "60 mm", **on}
        case "gas spring":
            volume = f"{1e3 * 1e-3 * 8 * layout.radius:.4g} l"
            return {"area": "10 cm^2", "volume": volume, "pressure": "2 bar", "at": _mm(position), **on}
        case "force":
            return {"value": "100 N", "at": layout.joint, "direction": "-90 deg"}
        case "balance shaft":
            return {"unbalance": "0.1 kg m"}
        case "torque":
            return {"value": "-20 N m", "on": swinging}
        case "torsion spring":
            return {"stiffness": "10 N m/rad", "free_angle": f"{layout.middle_angle(swinging):.4g} deg", "on": swinging}
        case "torsion damper":
            return {"coefficient": "0.1 N m s", "on": swinging}
    first = {"point force": "value", "point spring": "stiffness", "point damper": "coefficient"}[kind]
    number = {"value": "100 N", "stiffness": "1 kN/m", "coefficient": "100 N s/m"}[first]
    return {first: number, "between": [layout.joint, _point(x, y + 4 * layout.radius)]}


def proposed_friction(joint, mechanism):
    """Keys of friction at a joint."""
    kind = friction_kind(mechanism.pairs[joint])
    return {item.name: FRICTION[item.name] for item in fields(kind) if item.default is MISSING}


def friction_keys(joint, mechanism):
    """Names of the keys of friction at a joint."""
    return [item.name for item in fields(friction_kind(mechanism.pairs[joint]))]


def cam_of_kind(kind, unit):
    """Cam or law of a kind; `unit` is that of the positions of a law, "rad" of a swinging follower."""
    text = json.dumps({"kind": kind, **CAMS[kind]})
    return json.loads(text.replace(" mm", " deg") if unit == "rad" else text)


class Layout:
    """Joints and links of a mechanism over its period, and free names."""

    def __init__(self, mechanism):
        self.mechanism = mechanism
        with np.errstate(all="ignore"):
            turn = np.linspace(0.0, 2.0 * np.pi * mechanism.turns, ANGLES, endpoint=False)
            self.placement = mechanism.place(turn)

    def position(self, joint):
        """Position of a joint, (2, N), m."""
        return np.stack([np.broadcast_to(part, ANGLES) for part in self.placement.joints[joint].position])

    @property
    def moving(self):
        """Joints that move, the last one first."""
        return [name for name, point in reversed(self.mechanism.joints.items()) if point.link != FRAME]

    @property
    def joint(self):
        """The last joint that moves on a curve, not on a guide."""
        on_guides = set(self.mechanism.guides)
        curved = [name for name in self.moving if self.mechanism.joints[name].link not in on_guides]
        return next(iter(curved or self.moving), "A")

    @property
    def centre(self):
        """Centre of the path of this joint, m."""
        if self.joint not in self.mechanism.joints:
            return 0.0, 0.0
        return tuple(map(_middle, self.position(self.joint)))

    @property
    def radius(self):
        """Greatest distance of this joint from that centre, m."""
        if self.joint not in self.mechanism.joints:
            return SCALE
        (x, y), (mid_x, mid_y) = self.position(self.joint), self.centre
        return float(np.nanmax(np.hypot(x - mid_x, y - mid_y))) or SCALE

    @property
    def two_joints(self):
        """Two joints for a dyad and their greatest distance, m: of those whose distance varies the most."""
        found = []
        for first, second in combinations(reversed(self.mechanism.joints), 2):
            apart = np.hypot(*(self.position(first) - self.position(second)))
            varies = np.nanmax(apart) - np.nanmin(apart) > MIN_CHANGE * np.nanmax(apart)
            found.append((varies, "O" not in (first, second), np.ptp(apart), (first, second, float(np.nanmax(apart)))))
        return max(found, default=(0, 0, 0, ("B", "C", SCALE)))[-1]

    @property
    def bar(self):
        """Link of the last bar between joints and half its length, m; the crank, without one."""
        bars = [
            (bar.link, float(np.max(bar.length)) / 2) for bar in self.mechanism.bars if bar.link in self.mechanism.links
        ]
        return bars[-1] if bars else ("crank", SCALE)

    @property
    def slider(self):
        """The last slider, or None."""
        return next(iter(reversed(self.mechanism.guides)), None)

    def middle_of(self, slider):
        """Coordinate of a slider in the middle of its stroke, m."""
        guide = self.mechanism.guides[slider]
        x, y = self.position(self.mechanism.references[slider])
        along = x * np.cos(guide.guide_angle) + y * np.sin(guide.guide_angle)
        return _middle(along)

    @property
    def swinging_link(self):
        """The last link that turns to and fro, else the crank."""
        for link in reversed(self.mechanism.links):
            if link not in self.mechanism.guides and 0.0 < np.ptp(self._angle(link)) < np.pi:
                return link
        return "crank"

    def middle_angle(self, link):
        """Angle of a link in the middle of its swing, deg."""
        return float(np.degrees(_middle(self._angle(link))))

    def _angle(self, link):
        """Angle of a link, rad; 0 where it cannot be placed."""
        x, y = self.placement.links[link].direction
        return np.unwrap(np.nan_to_num(np.broadcast_to(np.arctan2(y, x), ANGLES)))

    def free_name(self, first):
        """The first letter from `first` on that names no joint."""
        letters = string.ascii_uppercase[string.ascii_uppercase.index(first) :] + string.ascii_uppercase
        return next((name for name in letters if name not in ("O", *self.mechanism.joints)), first)

    @property
    def free_pivot(self):
        """The first of O2, O3 ... that names no joint."""
        names = (f"O{number}" for number in range(2, 3 + len(self.mechanism.joints)))
        return next(name for name in names if name not in self.mechanism.joints)


def _middle(values):
    return float(np.nanmin(values) + np.nanmax(values)) / 2


def _mm(length):
    return f"{round(1e3 * length, MM_DECIMALS) or 0.0:.4g} mm"


def _point(x, y):
    return [_mm(x), _mm(y)]
