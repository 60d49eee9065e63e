"""Random machines that turn all round, of every kind, with loads and friction of every kind: one for each seed."""

import math
from dataclasses import dataclass

import numpy as np

import kinetostatics as ks

TURN = 2 * np.pi
ANGLES = np.linspace(0.0, TURN, 48, endpoint=False)
LOADS = (
    "gravity",
    "spring",
    "cubic spring",
    "process",
    "table over angle",
    "table over travel",
    "table with back",
    "function",
    "function of speed",
    "force",
    "turning force",
    "force by table",
    "torque",
    "torque by table",
    "torque by table with back",
    "torque by function",
    "point force",
    "point spring",
    "point damper",
    "torsion spring",
    "torsion damper",
)
SPEED_LOADS = ("function of speed", "point damper", "torsion damper")
"""Those whose value depends on the speed."""


@dataclass(frozen=True)
class Wave:
    """mean + amplitude cos(order phi - phase): a load by a function of the crank angle."""

    mean: float
    amplitude: float
    order: int
    phase: float

    def __call__(self, motion):
        """Force or torque, N or N m."""
        angle = self.order * motion.crank_angle
        return self.mean + self.amplitude * (
            math.cos(self.phase) * np.cos(angle) + math.sin(self.phase) * np.sin(angle)
        )


@dataclass(frozen=True)
class Drag:
    """A force against the velocity of a slider, and a part of it with its square."""

    slider: str
    linear: float
    square: float

    def __call__(self, motion):
        """Force along the guide, N."""
        velocity = motion.travel_velocity(self.slider)
        return -self.linear * velocity - self.square * velocity * velocity


class _Draw:
    """Random numbers of one machine; `machine()` draws a scene."""

    def __init__(self, *seed):
        self.rng = np.random.default_rng(seed)
        self.r = self.real(0.08, 0.15)

    def real(self, low, high):
        return float(self.rng.uniform(low, high))

    def sign(self):
        return int(self.rng.choice((-1, 1)))

    def either(self, low, high):
        return self.sign() * self.real(low, high)

    def link(self):
        return ks.Link(self.real(0.2, 8.0), (self.real(-0.05, 0.15), self.real(-0.05, 0.05)), self.real(0.005, 0.1))

    def guide(self, size):
        return ks.Guide.at(self.real(-3.1, 3.1), size * self.real(-0.4, 0.4))

    def crank(self, length=None):
        return ks.Crank(length, self.link())

    # machines

    def machine(self, kind):
        """A mechanism of a kind."""
        crank, *groups = getattr(self, kind.replace("-", "_").replace(" ", "_"))()
        return ks.Mechanism(kind, crank, tuple(groups))

    def coupled(self, reach, on="A", pin="B", label=""):
        guide, length = self.guide(self.r), reach * self.real(3.0, 6.0)
        return ks.SliderGroup(length, guide, self.sign(), self.link(), self.link(), on, pin, label)

    def crank_slider(self):
        return self.crank(self.r), self.coupled(self.r)

    def circle_cam(self):
        centre = self.r * self.real(-0.2, 0.2), self.r * self.real(-0.2, 0.2)
        roller = ks.CamRoller(ks.cams.Circle(self.r, centre), self.link())
        return self.crank(), roller, self.coupled(1.3 * self.r)

    def harmonic_cam(self):
        even, odd = (tuple(self.r * self.real(-0.03, 0.03) for _ in range(2)) for _ in range(2))
        cam = ks.cams.Harmonic((self.r, *even), odd, self.real(-3.0, 3.0))
        return self.crank(), ks.CamRoller(cam, self.link()), self.coupled(1.3 * self.r)

    def sampled_cam(self):
        angle = np.linspace(0.0, TURN, 60, endpoint=False) + self.real(0.01, 0.09)
        a, b = self.r * self.real(-0.05, 0.05), self.r * self.real(-0.05, 0.05)
        cam = ks.cams.Sampled(angle, self.r + a * np.cos(angle) + b * np.sin(2 * angle))
        return self.crank(), ks.CamRoller(cam, self.link()), self.coupled(1.3 * self.r)

    def cosine_cam(self):
        cam = ks.cams.CosineLaw(self.r, self.r * self.real(4.0, 7.0), self.real(-3.0, 3.0))
        group = ks.SliderGroup(cam.coupler_length, ks.Guide.at(cam.guide_angle), 1, self.link(), self.link())
        return self.crank(), ks.CamRoller(cam, self.link()), group

    def law_cam(self):
        law, angle = ks.laws.cosine(self.r, self.r * self.real(5.0, 7.0)), self.real(-3.0, 3.0)
        cam = ks.cams.from_law(law, guide_angle=angle)
        group = ks.SliderGroup(cam.coupler_length, ks.Guide.at(angle), 1, self.link(), self.link())
        return self.crank(), ks.CamRoller(cam, self.link()), group

    def bars(self):
        a, away = self.r, self.real(-3.1, 3.1)
        frame = a * self.real(2.0, 2.5)
        pivot = frame * math.cos(away), frame * math.sin(away)
        lengths = a * self.real(2.2, 2.8), a * self.real(2.2, 2.8)
        return ks.RockerGroup(*lengths, pivot, self.sign(), self.link(), self.link())

    def four_bar(self):
        return self.crank(self.r), self.bars()

    def drag_link(self):
        a = self.r
        pivot = a * self.real(0.2, 0.4), a * self.real(-0.3, 0.3)
        lengths = a * self.real(1.0, 1.3), a * self.real(1.2, 1.4)
        return self.crank(a), ks.RockerGroup(*lengths, pivot, self.sign(), self.link(), self.link())

    def six_bar(self):
        return self.crank(self.r), self.bars(), self.coupled(3.0 * self.r, "B", "C", "2")

    def coupler_point(self):
        pin = ks.Pin(on="coupler", at=(self.r * self.real(0.5, 1.5), self.r * self.real(-0.5, 0.5)), name="C")
        return self.crank(self.r), self.bars(), pin, self.coupled(3.0 * self.r, "C", "D", "2")

    def dyad(self):
        pin = ks.Pin(on="crank", at=(self.r * self.real(-0.6, -0.3), self.r * self.real(-0.2, 0.2)), name="C")
        lengths = self.r * self.real(4.0, 5.0), self.r * self.real(4.0, 5.0)
        dyad = ks.Dyad(*lengths, ("B", "C"), assembly=self.sign(), dyad1=self.link(), dyad2=self.link())
        return self.crank(self.r), self.bars(), pin, dyad

    def away(self, low, high):
        far, angle = self.r * self.real(low, high), self.real(-3.1, 3.1)
        return far * math.cos(angle), far * math.sin(angle)

    def lever(self):
        offset = self.r * self.real(-0.3, 0.3)
        group = ks.LeverGroup(self.away(1.6, 2.5), offset=offset, lever=self.link(), block=self.link())
        return self.crank(self.r), group

    def whitworth(self):
        offset = self.r * self.real(-0.2, 0.2)
        group = ks.LeverGroup(self.away(0.2, 0.5), offset=offset, lever=self.link(), block=self.link(), assembly=-1)
        return self.crank(self.r), group

    def shaper(self):
        lever = ks.LeverGroup(self.away(1.8, 2.5), lever=self.link(), block=self.link())
        pin = ks.Pin(on="lever", at=(self.r * self.real(2.0, 3.0), self.r * self.real(-0.1, 0.1)), name="C")
        return self.crank(self.r), lever, pin, self.coupled(6.0 * self.r, "C", "D", "2")

    def cylinder(self):
        return self.crank(self.r), ks.CylinderGroup(self.away(2.0, 4.0), rod=self.link(), cylinder=self.link())

    def yoke(self):
        slot = self.real(1.1, 2.0) * self.sign()
        return self.crank(self.r), ks.YokeGroup(self.guide(self.r), slot, slider=self.link(), block=self.link())

    def law(self, low, high):
        """A law of the whole turn between two positions."""
        if self.rng.random() < 0.4:
            return ks.laws.cosine((high - low) / 2, (high + low) / 2, self.real(-3.0, 3.0))
        curve = (ks.laws.cycloidal, ks.laws.modified_sine)[int(self.rng.integers(2))]
        parts = np.array([self.real(1.5, 2.0), self.real(0.3, 0.6), self.real(1.7, 2.2)])
        rise, stay, fall = parts.tolist()
        rest = ks.laws.dwell(low, TURN - float(parts.sum()))
        law = ks.laws.joined(curve(low, high, rise), ks.laws.dwell(high, stay), curve(high, low, fall), rest)
        return law.shifted(self.real(0.1, 3.0))

    def roller_follower(self):
        law, guide = self.law(0.1, 0.12), ks.Guide.at(self.real(-3.0, 3.0), self.real(-0.01, 0.01))
        return self.crank(), ks.RollerFollower(law, guide, self.link())

    def flat_follower(self):
        law, guide = self.law(0.1, 0.103), ks.Guide.at(self.real(-3.0, 3.0), self.real(-0.01, 0.01))
        return self.crank(), ks.FlatFollower(law, guide, self.link())

    def swinging_follower(self):
        law = self.law(0.5, 0.7)
        return self.crank(), ks.SwingingFollower(law, 0.1, self.away(1.0, 1.3), self.sign(), self.link())

    def two_sliders(self):
        pin = ks.Pin(on="crank", at=(self.r * self.real(-0.7, 0.2), self.r * self.real(0.3, 0.7)), name="C")
        return self.crank(self.r), self.coupled(self.r), pin, self.coupled(self.r, "C", "D", "2")

    # loads

    def loads(self, mechanism, kinds):
        """Loads of these kinds on a mechanism, those left out that it has no place for."""
        still = ks.Scene(mechanism, 1.0).solve(ANGLES)
        found = (self.load(kind, still) for kind in kinds)
        return tuple(item for item in found if item is not None)

    def load(self, kind, still):
        mechanism = still.mechanism
        slider = str(self.rng.choice(list(mechanism.guides))) if mechanism.guides else None
        link, other = map(str, self.rng.choice(list(mechanism.links), 2))
        force, torque = self.either(20.0, 300.0), self.either(2.0, 30.0)
        place = (link, self.real(-0.1, 0.1), self.real(-0.1, 0.1))
        fixed = (self.either(0.8, 1.2), self.either(0.8, 1.2))
        made = {
            "gravity": lambda: ks.Gravity(self.real(1.0, 20.0), self.angle()),
            "force": lambda: ks.Force(force, at=place, direction=self.angle()),
            "turning force": lambda: ks.Force(force, at=place, direction=self.angle(), along=other),
            "force by table": lambda: ks.Force(self.table_over_angle(force), at=place, direction=self.angle()),
            "torque": lambda: ks.Torque(torque, on=link),
            "torque by table": lambda: ks.Torque(self.table_over_angle(torque), on=link),
            "torque by function": lambda: ks.Torque(self.wave(torque), on=link),
            "point force": lambda: ks.PointForce(force, between=(place, fixed)),
            "point spring": lambda: ks.PointSpring(self.stiffness(), self.real(0.5, 1.0), between=(place, fixed)),
            "point damper": lambda: ks.PointDamper(self.real(1.0, 20.0), between=(place, fixed)),
            "torsion damper": lambda: ks.TorsionDamper(self.real(0.01, 0.3), on=link),
            "torsion spring": lambda: self.torsion_spring(still),
        }
        along = {
            "spring": lambda: ks.Spring(self.stiffness(), self.travel(still, slider)[0], slider),
            "cubic spring": lambda: self.cubic_spring(still, slider),
            "process": lambda: ks.ProcessForce(force, slider),
            "table over angle": lambda: ks.ProcessForce(self.table_over_angle(force), slider),
            "table over travel": lambda: ks.ProcessForce(self.table_over_travel(force, still, slider, False), slider),
            "table with back": lambda: ks.ProcessForce(self.table_over_travel(force, still, slider, True), slider),
            "torque by table with back": lambda: ks.Torque(
                self.table_over_travel(torque, still, slider, True, slider), on=link
            ),
            "function": lambda: ks.ProcessForce(self.wave(force), slider),
            "function of speed": lambda: ks.ProcessForce(
                Drag(slider, self.real(1.0, 20.0), self.either(0.1, 2.0)), slider
            ),
        }
        if kind in along and slider is None:
            return None
        return (made | along)[kind]()

    def angle(self):
        return self.real(-3.1, 3.1)

    def stiffness(self):
        return self.real(100.0, 3000.0)

    def cubic_spring(self, still, slider):
        middle, stroke = self.travel(still, slider)
        return ks.Spring(self.stiffness(), middle, slider, self.real(0.0, 3e3) / stroke**2)

    def wave(self, size):
        return Wave(size, size * self.real(0.2, 0.9), int(self.rng.integers(1, 4)), self.real(-3.0, 3.0))

    def table_over_angle(self, size):
        count = int(self.rng.integers(5, 9))
        angle = TURN * (np.arange(count) + self.rng.uniform(-0.15, 0.15, count)) / count
        return ks.Table(np.sort(np.mod(angle, TURN)), size * self.rng.uniform(-0.4, 1.0, count))

    def table_over_travel(self, size, still, slider, with_back, by=None):
        middle, stroke = self.travel(still, slider)
        x = middle + stroke * np.array([-0.7, self.real(-0.4, 0.0), self.real(0.1, 0.4), 0.7])
        y, back = size * self.rng.uniform(-0.4, 1.0, (2, 4))
        return ks.Table(x, y, over="travel", back=back if with_back else None, slider=by)

    @staticmethod
    def travel(still, slider):
        travel = still.travel(slider)
        low, high = float(travel.min()), float(travel.max())
        return (low + high) / 2, high - low

    def torsion_spring(self, still):
        """On a link that only swings, free near the middle of its swing."""
        for link in self.rng.permutation(list(still.mechanism.links)):
            rate = still.rate(str(link))
            turned = np.cumsum(rate) * TURN / len(ANGLES)
            if np.max(np.abs(rate)) > 1e-9 and abs(turned[-1]) < 0.3 and np.ptp(turned) < 2.0:
                start, tip = still.position((str(link), 0.0, 0.0)), still.position((str(link), 1.0, 0.0))
                axis = np.sum(tip - start, axis=1)
                free = math.atan2(axis[1], axis[0]) + self.real(-0.3, 0.3)
                return ks.TorsionSpring(self.real(1.0, 50.0), free, on=str(link), moment=self.either(0.5, 5.0))
        return None

    # friction

    def friction(self, mechanism, scale=1.0):
        """Friction in every joint that may have it."""
        found = {}
        for name, kind in mechanism.friction_kinds.items():
            mu = scale * self.real(0.01, 0.08)
            if kind is ks.PinFriction:
                found[name] = ks.PinFriction(mu, self.real(0.004, 0.01))
            elif kind is ks.RollerFriction:
                found[name] = ks.RollerFriction(mu, self.real(0.004, 0.008), self.real(0.02, 0.03))
            else:
                found[name] = kind(mu, self.real(0.1, 0.3) if self.rng.random() < 0.5 else None)
        return found


KINDS = (
    "crank slider",
    "circle cam",
    "harmonic cam",
    "sampled cam",
    "cosine cam",
    "law cam",
    "four-bar",
    "drag link",
    "six-bar",
    "coupler point",
    "dyad",
    "lever",
    "whitworth",
    "shaper",
    "cylinder",
    "yoke",
    "roller follower",
    "flat follower",
    "swinging follower",
    "two sliders",
)


def turning_scene(kind, seed, *, loads=None, friction=False, speed=None, acceleration=None):
    """A random scene that closes all round, at any speed; None where this seed gives none.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    seed : int
    loads : sequence of str, optional
        Kinds of loads, of `LOADS`; three drawn at random unless told.
    friction : bool
    speed, acceleration : float, optional
        Drawn unless told.
    """
    draw = _Draw(KINDS.index(kind), seed)
    try:
        mechanism = draw.machine(kind)
        still = ks.Scene(mechanism, 1.0).solve(ANGLES)
    except (ks.AssemblyError, ks.ParameterError):
        return None
    if min(float(np.min(margin)) for margin in still.closure) < 0.05:
        return None
    kinds = draw.rng.choice(LOADS, 3, replace=False) if loads is None else loads
    return ks.Scene(
        mechanism,
        draw.either(3.0, 30.0) if speed is None else speed,
        draw.either(0.0, 60.0) if acceleration is None else acceleration,
        draw.loads(mechanism, kinds),
        draw.friction(mechanism) if friction else {},
    )


def random_machine(kind, seed=0, **options):
    """The first scene of a kind, from a seed on, that closes all round."""
    found = (turning_scene(kind, number, **options) for number in range(seed, seed + 9))
    return next(scene for scene in found if scene is not None)
