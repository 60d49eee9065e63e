"""Exact periodic running of a machine under its motor, or under the constant torque that textbooks assume."""

import math
from functools import partial

import numpy as np

from ..errors import DriveError
from ..numbers import checks
from ..numbers.parameter_tree import with_fields
from ..solution.angles import crank_angles
from ..solution.scene import scene_problem
from .bends import parted
from .following import from_above
from .friction import driven_by
from .newton import interpolated, looked_at, settled, unresolved
from .operating import operating_speed, require_known
from .pieces import LEVELS, MOST_PIECES, TAIL
from .resolution import require_inertia, resolved_with_bends
from .running import Running

AGAIN = 60
"""How often friction is found anew under a constant torque, at most."""
SETTLED = 2e-15
"""Relative change of speed that is rounding."""


def steady(scene, motor, flywheel=0.0, *, angles=720, engine=None) -> Running:
    """Periodic running of a machine under its motor, exact to rounding.

    Where there are several, the stable one, at the highest speed; a motor below its breakdown torque does not count.
    It is followed over one turn, or as many as motion and loads take to repeat.

    Parameters
    ----------
    scene : Scene
        Mechanism and loads; its crank speed does not matter, but for `motor` None.
    motor : Motor or None
        None: a motor that gives the constant torque that the machine takes at the mean speed of the scene, as textbooks
        assume; loads must not depend on the speed then.
    flywheel : float
        Moment of inertia on the crank, beside its own link, kg m2.
    angles : int or array
        Crank angles of the tables: so many over the period, its end excluded, or these, rad.
    engine : "numpy" or "compiled"
        As for `solve`; "compiled" pays where the same kind of machine is run often.

    Returns
    -------
    Running

    Raises
    ------
    DriveError
        There is no periodic running: the motor is too weak, with the torque missing; nothing holds the speed; the
        inertia vanishes somewhere.
    ParameterError
        A value is out of range, or a load cannot be taken at any crank angle.
    AssemblyError
        The mechanism does not make full turns.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> run = ks.drive.steady(pump, motor, flywheel=0.05)
    >>> print(f"{run.mean_speed:.4f} rad/s, fluctuation {run.fluctuation:.5f}")
    104.6753 rad/s, fluctuation 0.05021
    """
    direction = _direction(scene) if motor is None else None
    driven = driven_by("steady", scene, motor, flywheel, engine, direction)
    checks.require("steady", _angles_problem(angles))
    scene = with_fields(scene, sense=None)  # running never stands: its sense is that of its speed
    pieces, energy = (_prescribed if motor is None else _driven_running)(driven, scene)
    angle = np.linspace(0.0, driven.period, angles, endpoint=False) if _is_count(angles) else crank_angles(angles)
    again = partial(steady, scene, motor, angles=angles, engine=engine)
    return Running(scene, motor, driven.flywheel, angle, driven, pieces, energy, again)


def _driven_running(driven, scene):
    """Pieces, and the energy U at their points, of stable periodic running under a motor."""
    start = operating_speed(driven)
    pieces, bends = resolved_with_bends(driven, start)
    require_inertia(driven, pieces)
    found = settled(driven, pieces, lambda pieces: 0.5 * driven.inertia(pieces.angle) * start * start)
    pieces, energy = found or from_above(driven, pieces, start)
    for _ in range(LEVELS):
        speed = looked_at(driven, pieces, energy)[2]
        moved = parted(driven, pieces, driven.forces_on(pieces.angle, speed), bends)
        if moved is None:
            finer = _finer(driven, pieces, energy)
            if finer is None:
                break
        else:
            finer, bends = moved
        found = settled(driven, finer, interpolated(pieces, energy))
        pieces, energy = found or from_above(driven, finer, start)
    require_known(driven, looked_at(driven, pieces, energy)[2])
    return pieces, energy


def _finer(driven, pieces, energy):
    """Pieces halved where series are not done; None where all are, or there are too many."""
    marked = unresolved(driven, pieces, energy)
    return pieces.split(marked) if marked.any() and len(pieces.half) <= MOST_PIECES else None


def _prescribed(driven, scene):
    """Pieces, and the energy U at their points, under the constant torque that keeps the mean speed of the scene."""
    if driven.loads_by_speed:
        raise DriveError(
            f"{scene.mechanism.name}: loads depend on the speed, so no constant torque is known that carries them; "
            "give a motor"
        )
    speed = abs(scene.crank_speed)
    pieces, bends = resolved_with_bends(driven, driven.direction * speed)
    require_inertia(driven, pieces)
    for _ in range(LEVELS):
        energy, slow, acceleration = _under_constant_torque(driven, pieces, speed)
        rows = driven.forces_at(pieces.angle, driven.direction / slow, acceleration)
        moved = parted(driven, pieces, rows, bends)
        if moved is not None:
            pieces, bends = moved
            continue
        marked = ((pieces.tail(energy) > TAIL) | (pieces.tail(slow) > TAIL)) & pieces.can_split
        if not marked.any():
            break
        pieces = pieces.split(marked)
    return pieces, energy


def _under_constant_torque(driven, pieces, speed):
    """Energy U at a mean speed, the inverse of the speed, and the acceleration; the torque goes to `driven`.

    Friction that hangs on speed and acceleration is found anew until they stay.
    """
    slow, acceleration = np.full(pieces.angle.shape, 1.0 / speed), np.zeros(pieces.angle.shape)
    for _ in range(AGAIN):
        state = driven.at_acceleration(pieces.angle, driven.direction / slow, acceleration)
        inertia, before = driven.flywheel + state.inertia, slow
        driven.torque_given = pieces.total(state.torque) / driven.period
        gained = pieces.integrated(driven.torque_given - state.torque)
        gained = gained + pieces.largest(-gained)[0]
        energy, slow = _at_mean_speed(driven, pieces, inertia, gained, speed)
        acceleration = (driven.torque_given - state.torque - 0.5 * state.slope / slow**2) / inertia
        if not driven.by_speed or np.abs(slow - before).max() <= SETTLED * slow.max():
            break
    return energy, slow, acceleration


def _at_mean_speed(driven, pieces, inertia, gained, speed):
    """Energy U, gained but for a constant, that gives a mean speed; and the inverse of the speed."""
    from scipy.optimize import brentq

    scale = 0.5 * speed * speed * pieces.total(inertia) / driven.period

    def too_fast(size):
        slowness = np.sqrt(0.5 * inertia / (gained + scale * math.exp(size)))
        return driven.period / pieces.total(slowness) - speed

    low = next((size for size in (-5.0, -12.0, -25.0) if too_fast(size) < 0.0), None)
    if low is None:
        raise DriveError(
            f"{driven.scene.mechanism.name}: no constant torque keeps a mean speed as low as {speed:.6g} rad/s: the "
            "energy gained over the turn alone makes it faster; give a larger flywheel or a higher speed"
        )
    energy = gained + scale * math.exp(brentq(too_fast, low, 5.0, xtol=1e-15, rtol=1e-15))
    return energy, np.sqrt(0.5 * inertia / energy)


def _direction(scene):
    """Sign of the crank speed of a scene that is to be run without motor."""
    checks.require("steady", scene_problem(scene))
    speed, wrong = checks.single("crank_speed of the scene", scene.crank_speed, "rad/s", unequal=0.0)
    checks.require("steady", wrong)
    return math.copysign(1.0, speed)


def _is_count(angles):
    return isinstance(angles, int | np.integer) and not isinstance(angles, bool)


def _angles_problem(angles):
    """What is wrong with a number of crank angles, or None."""
    return checks.count("angles", angles, size=checks.ANGLE) if _is_count(angles) else None
