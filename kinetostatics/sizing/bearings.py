"""Bearings of pins: equivalent load and rating life by relative rotation, rings, pressure and pv of plain bearings.

Loads are weighted by the relative rotation w_rel of the rings (ISO 281:2007; Harris, *Rolling Bearing Analysis*, 2006):

    P = (int |F|^p |w_rel| dphi / int |w_rel| dphi)^(1/p),    L10 = 1e6 (C/P)^p turns of the rings, both ways
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..cycle.extremes import extrema, largest_of
from ..cycle.means import TERM_ROUNDING, closed_turn, means
from ..cycle.piecewise import Pieces
from ..errors import ParameterError
from ..machine.cams.profile import POSITIVE
from ..machine.group import FRAME
from ..machine.links import CamDriven, Turning
from ..machine.loads import TURN
from ..machine.supports import Joining, pairs_of
from ..mechanics.ground import pair_forces
from ..numbers import checks
from ..numbers.planar import left, rotate_back
from .result import Row, Sized, warn_of_notes

NUMBERS = {
    **dict.fromkeys(("capacity", "static_capacity"), ("N", POSITIVE)),
    "exponent": ("1", {"low": 1.0}),
    **dict.fromkeys(("diameter", "width"), ("m", POSITIVE)),
}
ROLLER, BALL_EXPONENT = "roller", 3.0
"""Name of a cam's roller, as a bearing and as a rotating ring; exponent p of ball bearings and of roller bearings."""
LEAST_SHARES, MAX_SHARE = (0.01, 0.02), 0.5
"""Least load over C at which balls, or rollers, do not slide (SKF, 2018); largest P over C with a life by ISO 281."""
POINT_SHARE, FEW_ELEMENTS, MIN_TURNS = np.pi / 4, 12, 1e-9
"""Share of point load where a rotating load is as large as a fixed one. Rolling elements of a small bearing. Turns of a
pin per turn of the crank, and net share of its travel, that count as rounding."""


class BearingPin(NamedTuple):
    """Pin in a bearing: the load acts on the first of the two links, its `rings`; a roller has a `radius`."""

    name: str
    joining: Joining
    rings: tuple[str, str]
    radius: Any = None

    def load(self, at):
        """Load on the first ring, (2, N), N; for a massless roller the opposite of the cam's force."""
        force = at.as_vector(pair_forces(at, self.name, self.joining)[self.name].force)
        return -force if self.radius else force

    def rotation(self, at):
        """Rate of the first ring less that of the other, relative to the crank speed, (N,)."""
        first = self._rolling(at) if self.radius else _rate(at, self.rings[0])
        return (first - _rate(at, self.rings[1])) / at.crank_speed + np.zeros(at.shape)

    def _rolling(self, at):
        """Rate of a roller that rolls on its cam without sliding, rad/s."""
        led = self.joining.pair
        velocity, turning = at.velocity(led.joint), _rate(at, led.body)
        if led.body != FRAME:
            base = at.mechanism.references[led.body]
            velocity = velocity - at.velocity(base) - turning * left(at.position(led.joint) - at.position(base))
        side = np.where(at.scalar(led.force) > 0.0, -1.0, 1.0) * np.sign(at.crank_speed)
        return turning + side * np.hypot(*velocity) / self.radius

    def in_rings(self, at):
        """Load on each ring in its own axes, (2, 2, N), N; NaN for a roller, whose loads never repeat."""
        found = np.stack([self.load(at), -self.load(at)])
        for row, ring in enumerate(self.rings):
            if ring == ROLLER:
                found[row] = np.nan
            elif ring != FRAME:
                found[row] = np.stack(np.broadcast_arrays(*rotate_back(found[row], at.placement.links[ring].direction)))
        return found


def _rate(at, link):
    return 0.0 if link == FRAME else at.rate(link)


@dataclass(frozen=True, eq=False, repr=False)
class Bearing(Sized):
    """Rolling bearing of a pin, as `ks.sizing.bearing` returns it; `pin` has its rings, load and relative rotation."""

    ROWS: ClassVar = {
        "equivalent_load": Row("N", "constant load of the same life", "(int F^p |w_rel| / int |w_rel|)^(1/p), ISO 281"),
        "largest_load": Row("N", "over the turn", "|F|"),
        "smallest_load": Row("N", "over the turn", "|F|"),
        "needed_load": Row("N", "least load to roll without sliding", "0.01 C ball, 0.02 C roller (SKF 2018)"),
        "relative_turns": Row("1", "turns of the rings, both ways, per crank turn", "int |w_rel| dphi / (2 pi omega)"),
        "life_turns": Row("1", "turns of the crank with 90 % survival", "1e6 (C/P)^p / relative turns, ISO 281"),
        "life_hours": Row("h", "at the crank speed of the solution", "life_turns 2 pi/(3600 omega)"),
        "oscillation": Row("rad", "amplitude of a swinging pin, inf if it turns", "half its range"),
        "static_safety": Row("1", "against indentation", "C0/largest load, ISO 76:2006"),
        "point_share": Row("1", "of the ring on the first link; 1 point load", "|mean of F| / mean of |F|, its axes"),
        "point_share_against": Row("1", "of the ring on the other link", "|mean of F| / mean of |F|, its axes"),
    }
    solution: Any
    pin: BearingPin
    equivalent_load: float
    largest_load: float
    smallest_load: float
    needed_load: float
    relative_turns: float
    life_turns: float
    life_hours: float
    oscillation: float
    static_safety: float
    point_share: float
    point_share_against: float

    @property
    def ring_loads(self):
        """Load by link, "point" or "circumferential or indeterminate" (DIN 5425-1); empty without load.

        A share above pi/4 means point load: a fixed load then exceeds a rotating one. Other rings need a tight fit.
        """
        shares = (self.point_share, self.point_share_against) if self.largest_load else ()
        words = ("point" if share > POINT_SHARE else "circumferential or indeterminate" for share in shares)
        return dict(zip(self.pin.rings, words, strict=False))


def bearing(solution, joint, *, capacity, static_capacity, exponent=10 / 3):
    """Rolling bearing of a pin under the load of the turn: equivalent load, rating life, static safety, rings.

    Parameters
    ----------
    solution : Solution
    joint : str
        Reaction of a pin, "O", "A" ...; "roller" is the pin of a massless roller that rolls on its cam. With several
        cams: "cam roller", "contact2 roller" ...
    capacity, static_capacity : float
        Dynamic and static load rating C, C0, N.
    exponent : float
        p: 10/3 for roller bearings, 3 for ball bearings.

    Returns
    -------
    Bearing

    Raises
    ------
    ParameterError
        The pin is unknown, never turns, or its roller has no radius. The mechanism has gaps or several designs, the
        crank is at rest, or the load grows without bound.

    Warns
    -----
    HintWarning
        Danger of false brinelling at a small swing; a load too small for rolling, or beyond the ratings.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").solve("plain", 4)
    >>> found = ks.sizing.bearing(saw, "A", capacity=600e3, static_capacity=1e6)
    >>> print(f"{found.equivalent_load / 1e3:.2f} kN, {found.life_hours:.0f} h")
    198.35 kN, 2085 h
    >>> found.ring_loads
    {'coupler': 'circumferential or indeterminate', 'crank': 'point'}
    """
    given = {"capacity": capacity, "static_capacity": static_capacity, "exponent": exponent}
    pin, turn, least, most, rating, static, power = _prepared("bearing", solution, joint, **given)
    load, turns, turned, low, high, *shares = _integrals(pin, turn, most, power)
    if turns < MIN_TURNS:
        raise ParameterError(f"bearing: at {joint} {' and '.join(pin.rings)} turn together, without relative rotation")
    swing = 0.5 * (high - low) if abs(turned) < MIN_TURNS * turns * turn.period else np.inf
    needed = LEAST_SHARES[int(power > BALL_EXPONENT)] * rating
    with np.errstate(divide="ignore", over="ignore"):
        life = 1e6 * np.power(np.divide(rating, load), power) / turns
        safety = np.divide(static, most)
    hours = life * TURN / (3600.0 * abs(float(np.mean(solution.crank_speed))))
    notes = []
    if swing < TURN / FEW_ELEMENTS:
        words = f"{joint} swings by +-{np.degrees(swing):.3g} deg: with fewer than {TURN / swing:.0f} rolling elements"
        notes.append(f"{words} their tracks do not overlap, a danger of false brinelling")
    if least < needed:
        words = f"the load at {joint} falls to {least:.0f} N, below the {needed:.0f} N"
        notes.append(f"{words} that rolling elements need, so they may slide")
    if most > static or load > MAX_SHARE * rating:
        notes.append(f"the load at {joint} exceeds C0 or its equivalent C/2, so the life by ISO 281 does not hold")
    found = (load, most, least, needed, turns, life, hours, swing, safety, *shares)
    return warn_of_notes("bearing", Bearing(tuple(notes), solution, pin, *map(float, found)))


def rollers_of(mechanism):
    """Name and pair of each cam with a roller, by the name of the roller's bearing."""
    cams = [
        pair for pair in pairs_of(mechanism).items() if isinstance(pair[1].pair, CamDriven) and not pair[1].pair.flat
    ]
    return {ROLLER if len(cams) == 1 else f"{name} {ROLLER}": (name, own) for name, own in cams}


def _prepared(owner, solution, joint, **values):
    """`BearingPin`, turn, smallest and largest load, N, and options, after all checks."""
    checks.require(owner, checks.solution("solution", solution))
    pairs = pairs_of(solution.mechanism).items()
    pins = {name: BearingPin(name, own, (own.link, own.against)) for name, own in pairs if type(own.pair) is Turning}
    for roller, (name, own) in rollers_of(solution.mechanism).items():
        rubs = solution.friction.get(name)
        radius = solution.mechanism.rollers.get(own.pair.joint) if rubs is None else rubs.roller_radius
        pins[roller] = BearingPin(name, own, (ROLLER, own.link), radius)
    given = {name: (value, *NUMBERS[name]) for name, value in values.items()}
    numbers = checks.single_numbers(owner, checks.choice("pin joint", joint, tuple(pins)), **given)
    turn, pin = closed_turn(solution, owner), pins[joint]
    slow = None if np.all(solution.crank_speed) else "the crank is at rest and no pin turns; solve at its crank speed"
    lacks = f"the rotation of {joint} follows from its radius; give the follower or CamRoller a ks.Roller"
    checks.require(owner, slow, lacks if pin.rings[0] == ROLLER and pin.radius is None else None)
    least, most = extrema(solution, (lambda at: np.hypot(*pin.load(at))) if pin.radius else pin.name).range
    endless = None if np.isfinite(most) else f"the load at {joint} grows without bound, so no bearing can carry it"
    checks.require(owner, endless)
    clear = least > TERM_ROUNDING * np.max(turn.even.largest_force_term)
    return pin, turn, least if clear else 0.0, most, *numbers.values()


def _integrals(pin, turn, most, power):
    """Equivalent load, turns and angle turned, smallest and largest angle, and shares of point load of both rings."""
    scale = most or 1.0

    def curves(angle):
        at = turn.at.moved_to(turn.clear(angle))
        rings, rotation = np.nan_to_num(pin.in_rings(at) / scale), pin.rotation(at)
        size, travel = np.hypot(*pin.load(at)) / scale, np.abs(rotation)
        return np.stack([size**power * travel, travel, rotation, size, *rings.reshape(4, -1)])

    at = turn.at.moved_to(turn.angle[turn.usable])
    rounding, fast = TERM_ROUNDING * float(np.max(at.largest_force_term)) / scale, np.abs(pin.rotation(at)).max()
    floor = np.array([power * rounding * fast, *[TERM_ROUNDING * max(fast, 1.0)] * 2, *[rounding] * 5])
    mean, _, pieces, values = means(curves, turn, floor)
    place, piece = pieces.zeros(values[2, :, 1:-1])
    parts = Pieces(np.union1d(pieces.edges, pieces.angle_at(piece, place)), pieces.count)
    moves = parts.piece_integrals(curves(parts.angle.ravel())[2].reshape(parts.angle.shape))
    angle = np.cumsum([0.0, *moves])
    with np.errstate(invalid="ignore"):
        load = scale * np.power(mean[0] / mean[1], 1.0 / power) if most else 0.0
        shares = np.hypot(*mean[4:].reshape(2, 2).T) / mean[3]
    return load, np.abs(moves).sum() / turn.period, angle[-1], angle.min(), angle.max(), *shares


def equivalent_load(loads, shares, exponent=10 / 3):
    """Constant load with the same life as loads in steps, N.

    Parameters
    ----------
    loads, shares : sequence of float
        Loads, N, and turns of the bearing under each of them, in any unit.
    exponent : float
        As for `bearing`.

    Returns
    -------
    float
        (sum F^p n / sum n)^(1/p), ISO 281.

    Raises
    ------
    ParameterError
        A number is negative, lengths differ, or no share is positive.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> round(ks.sizing.equivalent_load([650, 750, 250], [30, 10, 20], exponent=3))
    597
    """
    found, problems = [], []
    for name, unit, value in (("loads", "N", loads), ("shares", "", shares)):
        values, problem = checks.Series(unit, "", 1).check(value, name)
        numbers = np.ravel(values) if problem is None else np.zeros(0)
        found.append(numbers)
        problems += [problem, f"{name} must not be negative, got {numbers.min():g}" if np.any(numbers < 0.0) else None]
    if not any(problems) and (found[0].size != found[1].size or not np.any(found[1])):
        problems.append("shares and loads must be equal in number, with a share greater than 0")
    power = checks.single_numbers("equivalent_load", *problems, exponent=(exponent, *NUMBERS["exponent"]))["exponent"]
    largest = found[0].max() or 1.0
    return float(largest * np.average((found[0] / largest) ** power, weights=found[1]) ** (1.0 / power))


@dataclass(frozen=True, eq=False, repr=False)
class PlainBearing(Sized):
    """Plain bearing of a pin over the turn; means are over time."""

    ROWS: ClassVar = {
        "largest_pressure": Row("Pa", "on the projected area", "F/(d b)"),
        "largest_speed": Row("m/s", "sliding speed", "|w_rel| d/2"),
        "largest_pv": Row("Pa*m/s", "at one crank angle", "F/(d b) |w_rel| d/2 (Shigley 2015, chapter 12)"),
        "mean_pv": Row("Pa*m/s", "times friction coefficient and area the heat, W", "mean of F/(d b) |w_rel| d/2"),
    }
    largest_pressure: float
    largest_speed: float
    largest_pv: float
    mean_pv: float


def plain_bearing(solution, joint, *, diameter, width):
    """Pressure, sliding speed and pv of a plain bearing over the turn.

    Parameters
    ----------
    solution, joint
        As for `bearing`.
    diameter, width : float
        m.

    Returns
    -------
    PlainBearing

    Raises
    ------
    ParameterError
        As for `bearing`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.5)), 0.0, crank_speed=100.0)
    >>> ks.sizing.plain_bearing(s, "B", diameter=0.02, width=0.03)
    <PlainBearing: largest_pressure 1562500 Pa, largest_speed 0.25 m/s, largest_pv 390630 Pa*m/s, mean_pv 159280 Pa*m/s>
    """
    given = {"diameter": diameter, "width": width}
    pin, turn, _, most, diameter, width = _prepared("plain_bearing", solution, joint, **given)

    def speed(at):
        return 0.5 * diameter * pin.rotation(at) * at.crank_speed

    def pv(at):
        return np.hypot(*pin.load(at)) / (diameter * width) * np.abs(speed(at))

    fast = max(map(abs, extrema(solution, speed).range))
    rounding = TERM_ROUNDING * np.max(turn.even.largest_force_term) / (diameter * width) * fast
    (mean,), *_ = means(lambda angle: pv(turn.at.moved_to(turn.clear(angle)))[None], turn, rounding)
    highest, _ = largest_of(extrema(solution, pv))
    return PlainBearing((), *map(float, (most / (diameter * width), fast, highest, mean)))
