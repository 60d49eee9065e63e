"""Vibration of a sprung block that carries the machine, and the force that springs and dampers pass to the ground.

The crank turns at a constant speed relative to the block. The machine loads the block with the force F on a fixed frame
(`Solution.ground`), less the inertia of the moving block. With the total mass M, each harmonic n of x, y and turning is

    M u'' + C u' + K u = F(t),    X_n = F_n / (K - (n w)^2 M + i n w C)

(Den Hartog, *Mechanical Vibrations*, 1956, chapter 2). In x and y this is exact. For rotation the moving links count as
fixed in their mean position, and the resultant of the springs passes through the centre of mass.
"""

from collections import namedtuple
from dataclasses import dataclass

import numpy as np

from ..cycle.extremes import extrema, largest_of
from ..cycle.means import TERM_ROUNDING, closed_turn, means
from ..cycle.piecewise import Pieces, edges_between, rule
from ..errors import ParameterError
from ..machine.cams.profile import POSITIVE
from ..machine.loads import TURN
from ..numbers import checks
from .result import Row, Sized, warn_of_notes

Machine = namedtuple("Machine", "speed order force mass acceleration")
"""Harmonics (3, N) of a machine's force on the frame and moment about the centre, by order, with its numbers."""
NUMBERS = {
    "mass": ("kg", POSITIVE),
    "inertia": ("kg*m**2", POSITIVE),
    "stiffness": ("N/m", POSITIVE),
    "damping": ("1", {"low": 0.0}),
    "v_rms": ("m/s", POSITIVE),
    "tuning": ("1", POSITIVE),
}
"""Unit and rule of each number; `stiffness` and `damping` may be lists of up to three, for rotation in N m/rad."""
HARMONICS, POINTS, REACH = 256, 24, 12.0
"""Harmonics of a period; points of a piece, and its width times the highest harmonic, rad."""
NEGLIGIBLE, RESONANT = 1e-13, 1e-9
"""Largest neglected harmonic, relative to the largest harmonic; distance from resonance relative to its frequency."""
MAX_TAIL, MAX_COUPLING = 1e-3, 0.05
"""Largest values without a note: v_peak above the last harmonic, relative; acceleration of block over machine."""
BLOW_STEP, MAX_JUMP = 1e-6, 1e-3
"""Distance from a kink or limit position, rad; largest relative jump of velocity that is no shock."""
WAYS = {"x": ("m", "N"), "y": ("m", "N"), "turn": ("rad", "N m")}
"""Directions of the block, with units of motion and load."""
ROWS = {
    "mass": Row("kg", "block, frame and moving links together", "given; of block_for: v rms of 1 kg / v rms allowed"),
    "tuning": Row("1", "lowest natural frequency / crank speed", "sqrt(K / M) / w"),
    "v_rms": Row("m/s", "largest rms velocity in x or y, at the centre or at O", "sqrt(sum |n w X_n|^2 / 2)"),
    "v_peak": Row("m/s", "largest velocity in x or y, at the centre or at O", "peak of sum Re(i n w X_n e^(i n phi))"),
    "coupling": Row("1", "largest acceleration of the block / of a joint", "peak of sum (n w)^2 X_n / peak of a"),
}
for _way, (_unit, _load) in WAYS.items():
    ROWS |= {
        f"v_rms_{_way}": Row(f"{_unit}/s", f"rms velocity of the centre, {_way}", "sqrt(sum |n w X_n|^2 / 2)"),
        f"v_peak_{_way}": Row(f"{_unit}/s", f"largest velocity of the centre, {_way}", "peak of sum i n w X_n"),
        f"travel_{_way}": Row(_unit, f"peak to peak, {_way}", "X_n = F_n / (K - (n w)^2 M + i n w C), Den Hartog 1956"),
        f"ground_{_way}": Row(_load, f"largest dynamic load on the ground, {_way}", "peak of sum (K + i n w C) X_n"),
        f"transmissibility_{_way}": Row(
            "1", f"load on the ground / on a fixed frame, {_way}", "of peaks; NaN without load"
        ),
    }


@dataclass(frozen=True, eq=False, repr=False)
class Mount(Sized):
    """Vibration of a block with its machine, as `ks.sizing.mount` and `ks.sizing.block_for` return it.

    A blocked direction has no velocity and transmits its full load. Loads are dynamic: weights and other means over the
    period are left out.

    Attributes
    ----------
    numbers : dict
        Value by name, as in `table()`; each is also an attribute.
    order : array (N,)
        Multiples of the crank speed, whole numbers unless a load repeats after several turns.
    crank_speed : float
        rad/s.
    force, displacement, ground_force : array (3, N) of complex
        Amplitudes X_n in x, y, rotation; N, N m, m, rad. Values are sums of Re(X_n e^(i n phi)) at crank angles phi.
        Force on a fixed frame, displacement of the centre, force on the ground.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.solve(ks.crank_slider(0.05, 0.16, slider=ks.Link(1.5)), 0.0, crank_speed=75.4)
    >>> block = ks.sizing.mount(pump, mass=75.0, stiffness=220e3, damping=0.02)
    >>> block.harmonics("x")["displacement"].iloc[:2].round(6).tolist()  # m
    [0.002062, 9.2e-05]
    """

    ROWS = ROWS
    numbers: dict
    order: np.ndarray
    crank_speed: float
    force: np.ndarray
    displacement: np.ndarray
    ground_force: np.ndarray

    def __post_init__(self):
        vars(self).update(self.numbers)

    def harmonics(self, way="x"):
        """Amplitudes of one direction, SI, and the lag of the displacement behind the force in time, a DataFrame."""
        import pandas as pd

        checks.require("harmonics", checks.choice("way", way, tuple(WAYS)))
        rows = self.force, self.displacement, self.ground_force
        force, moves, ground = (part[list(WAYS).index(way)] for part in rows)
        angle = -np.sign(self.crank_speed) * np.degrees(np.angle(moves * np.conj(force)))
        lag = np.where(moves * force == 0.0, np.nan, angle)
        table = {"force": abs(force), "displacement": abs(moves), "ground": abs(ground), "lag [deg]": lag}
        return pd.DataFrame(table, index=pd.Index(self.order, name="order"))


def mount(solution, *, mass, stiffness, damping, inertia=None, centre=(0.0, 0.0)):
    """Periodic vibration of a sprung block with its machine, from all harmonics of the force on the frame.

    Parameters
    ----------
    solution : Solution
        One design at constant speed; its crank angles have no effect.
    mass : float
        Mass of block, frame and moving links together, kg.
    stiffness : float or list of up to three floats
        Stiffness of the springs in x, y, N/m, and rotation, N m/rad. Omitted directions are blocked.
    damping : float or list with the same length
        Ratio to the critical damping of each direction, c / (2 sqrt(k m)).
    inertia : float, optional
        Total moment of inertia about the centre, kg m2; given together with the stiffness of rotation.
    centre : (x, y)
        Mean position of the common mass centre, m, in the axes of the machine; the springs' resultant acts there.

    Returns
    -------
    Mount

    Raises
    ------
    ParameterError
        A number is out of range; the machine has gaps, several designs, no constant speed, or velocities that jump; a
        harmonic meets a natural frequency without damping.

    Warns
    -----
    HintWarning
        The block's acceleration exceeds 5 % of the machine's; or the force jumps and harmonics above 256 matter.

    Examples
    --------
    The saw of the case on 30 t. The result shows little gain: good foundations stay within 1 to 7 mm/s.

    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").solve("cam-circle", 90)
    >>> block = ks.sizing.mount(saw, mass=30e3, stiffness=30e3 * (0.5 * saw.crank_speed) ** 2, damping=0.1)
    >>> print(f"{block.v_rms * 1e3:.1f} mm/s, {block.ground_x / 1e3:.1f} kN to the ground")
    235.3 mm/s, 90.2 kN to the ground
    """
    checks.require("mount", checks.solution("solution", solution))
    springs = tuple(stiffness) if isinstance(stiffness, list | tuple) else (stiffness,)
    ratios = tuple(damping) if isinstance(damping, list | tuple) else (damping,) * len(springs)
    centre, wrong = checks.Pair("m").check(centre, "centre")
    count = len(springs)
    few, alike, both = 0 < count <= len(WAYS), len(ratios) == count, (count == len(WAYS)) == (inertia is not None)
    problems = [
        None if few else f"stiffness must be a number or a list of up to three, got {checks.shown(stiffness)}",
        None if alike else f"damping must be a list of {count} numbers like stiffness, got {checks.shown(damping)}",
        None if both else "inertia and a third stiffness, for rotation, must be given together",
    ]
    given = {"mass": (mass, *NUMBERS["mass"])}
    if inertia is not None:
        given["inertia"] = (inertia, *NUMBERS["inertia"])
    for way, spring, ratio in zip(WAYS, springs, ratios, strict=False):
        unit = "N*m/rad" if way == "turn" else NUMBERS["stiffness"][0]
        given |= {f"stiffness {way}": (spring, unit, POSITIVE), f"damping {way}": (ratio, *NUMBERS["damping"])}
    found = checks.single_numbers("mount", *problems, wrong, **given)
    machine = _machine("mount", solution, centre)
    if found["mass"] <= machine.mass:
        words = f"mass must be greater than that of the moving links, {machine.mass:.6g} kg, which it includes"
        raise ParameterError(f"mount: {words}, got {found['mass']:.6g}")
    masses = [found["mass"], found["mass"], found.get("inertia")][: len(springs)]
    rates, dampers = ([found[name] for name in found if name.startswith(own)] for own in ("stiffness", "damping"))
    return warn_of_notes("mount", _mount("mount", machine, masses, rates, dampers, centre))


def block_for(solution, *, v_rms, tuning=0.5, damping=0.1):
    """Block with an allowed rms velocity in x and y, on springs tuned to a ratio of the crank speed.

    At given tuning and damping the velocity is inversely proportional to the mass. Rotation is blocked; check it by
    `mount`.

    Parameters
    ----------
    solution : Solution
        One design at constant speed.
    v_rms : float
        Largest rms velocity in x or y, m/s.
    tuning : float
        Natural frequency in x and y over the crank speed.
    damping : float
        Ratio to the critical damping.

    Returns
    -------
    Mount
        Vibration with the total mass.

    Raises
    ------
    ParameterError
        As for `mount`; or the mass of the moving links is already sufficient.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").solve("cam-circle", 90)
    >>> print(f"{ks.sizing.block_for(saw, v_rms=7.1e-3).mass / 1e3:.0f} t")
    994 t
    """
    checks.require("block_for", checks.solution("solution", solution))
    values = {"v_rms": v_rms, "tuning": tuning, "damping": damping}
    found = checks.single_numbers("block_for", **{name: (value, *NUMBERS[name]) for name, value in values.items()})
    machine = _machine("block_for", solution, (0.0, 0.0))

    def block(mass):
        spring = mass * (found["tuning"] * machine.speed) ** 2
        return _mount("block_for", machine, [mass] * 2, [spring] * 2, [found["damping"]] * 2, (0.0, 0.0))

    mass = block(1.0).v_rms / found["v_rms"]
    if mass <= machine.mass:
        words = f"{mass:.6g} kg suffice for v_rms, and the moving links already have {machine.mass:.6g} kg"
        raise ParameterError(f"block_for: no block is needed: {words}")
    return warn_of_notes("block_for", block(mass))


def _machine(owner, solution, centre):
    """`Machine` of a machine at constant speed, by integrals on the pieces between kinks."""
    turn = closed_turn(solution, owner)
    speed = np.unique(solution.crank_speed)
    if speed.size != 1 or not speed[0] or np.any(solution.crank_acceleration):
        raise ParameterError(f"{owner}: needs a machine at a constant crank speed other than 0, without acceleration")
    edges, size = turn.pieces.edges, abs(speed * solution.mechanism.extent)
    before, after = (turn.at.moved_to(edges + side * BLOW_STEP) for side in (-1.0, 1.0))
    for joint in solution.mechanism.joints:
        blows = edges[np.any(abs(after.velocity(joint) - before.velocity(joint)) > MAX_JUMP * size, axis=0)]
        if blows.size:
            words = f"changes its velocity at once at {np.degrees(blows[0]):.6g} deg, a shock on the frame"
            raise ParameterError(f"{owner}: {joint} {words}")

    def wrench(angle):
        ground = turn.at.moved_to(turn.clear(angle)).ground
        return np.stack([*ground.resultant, ground.moment(centre)])

    def acceleration(at):
        return np.max([np.hypot(*at.acceleration(joint)) for joint in at.mechanism.joints], axis=0)

    largest = float(np.max(turn.at.moved_to(turn.angle[turn.usable]).largest_force_term))
    arm = solution.mechanism.extent + np.hypot(*centre)
    floor = TERM_ROUNDING * largest * np.array([[1.0], [1.0], [arm]])
    *_, pieces, values = means(wrench, turn, floor)
    order = TURN / turn.period * np.arange(1, HARMONICS + 1)
    fine = Pieces(edges_between(pieces.edges, REACH / order[-1]), POINTS)
    rows = np.stack([pieces.evaluate(pieces.series(row), fine.angle) for row in values[..., 1:-1]])
    rows *= fine.half * rule(POINTS).weights * (2.0 / turn.period)
    force = np.einsum("kpq,npq->kn", rows, np.exp(-1j * np.multiply.outer(order, fine.angle)))
    counts = abs(force) > np.maximum(floor, NEGLIGIBLE * abs(force).max(axis=1, keepdims=True))
    last = 1 + int(np.max(np.flatnonzero(counts.any(axis=0)), initial=0))
    force = np.where(counts, force, 0.0)[:, :last]
    mass = sum(float(np.max(link.mass)) for link in solution.mechanism.links.values())
    peak = largest_of(extrema(solution, acceleration, pulsed=False))[0]
    return Machine(float(speed[0]), order[:last], force, mass, peak)


def _mount(owner, machine, masses, springs, ratios, centre):
    """`Mount` on springs of the first directions."""
    order, force, count = machine.order, machine.force, len(springs)
    masses, springs, ratios = (np.array(part, dtype=float)[:, None] for part in (masses, springs, ratios))
    natural, rate = np.sqrt(springs / masses), 1j * order * machine.speed
    resonant = np.argwhere((ratios == 0.0) & (np.abs(np.abs(rate) / natural - 1.0) < RESONANT))
    if resonant.size:
        row, at = resonant[0]
        words = f"harmonic {order[at]:g} of the crank meets the natural frequency of {natural[row, 0] / TURN:.6g} Hz"
        raise ParameterError(f"{owner}: {words} without damping; give damping, or another mass or stiffness")
    support = springs + rate * 2.0 * ratios * np.sqrt(springs * masses)
    moves, ground = np.zeros_like(force), force.copy()
    moves[:count] = force[:count] / (support + rate**2 * masses)
    ground[:count] = support * moves[:count]
    at_o = moves[:2] + np.outer([centre[1], -centre[0]], moves[2])
    velocity = rate * np.concatenate([moves, at_o])
    pieces = Pieces(edges_between(np.array([0.0, TURN / order[0]]), REACH / order[-1]), POINTS)
    waves = np.exp(1j * np.multiply.outer(order, pieces.angle))
    parts = np.concatenate([velocity, rate * velocity, moves, ground, force])
    curves = np.real(np.einsum("kn,npq->kpq", parts, waves))
    high, low = (np.array([pieces.largest(side * curve)[0] for curve in curves]) for side in (1.0, -1.0))
    peak, acceleration, _, load, fixed = np.split(np.maximum(high, low), [5, 10, 13, 16])
    rms, straight = np.sqrt(0.5 * np.sum(np.abs(velocity) ** 2, axis=1)), [0, 1, 3, 4]
    gain = np.divide(load, fixed, out=np.full(len(WAYS), np.nan), where=fixed > 0.0)
    coupling = acceleration[straight].max() / (machine.acceleration or np.nan)
    rows = zip(rms, peak, (high + low)[10:], load, gain, strict=False)
    own = [masses[0, 0], natural.min() / abs(machine.speed), rms[straight].max(), peak[straight].max(), coupling]
    numbers = dict(zip(ROWS, map(float, np.append(own, [*rows])), strict=True))
    notes = []
    if coupling > MAX_COUPLING:
        words = "reactions and torque, computed on a fixed frame, have errors of about this size"
        notes.append(f"the block's acceleration is {100.0 * coupling:.3g} % of the machine's; {words}")
    tail = HARMONICS * np.max(np.abs(velocity[straight, 3 * HARMONICS // 4 :]), initial=0.0)
    if tail > MAX_TAIL * numbers["v_peak"]:
        share = f"{100.0 * tail / numbers['v_peak']:.2g} % of v_peak"
        notes.append(f"the force on the frame jumps: harmonics above {HARMONICS} add up to {share}")
    return Mount(tuple(notes), numbers, order, machine.speed, force, moves, ground)
