"""Loss of contact in a joint with play, with the journal as a pendulum in the joint force without play.

With radial play c in one joint the journal touches its bearing in a direction e(beta); t is a quarter turn ahead. F is
the contact force without play, M the effective mass against a relative motion r of journal and
bearing with the crank prescribed. To first order in c, by time,

    M r'' = F - N e,   r = c e:    M_tt c beta'' = F_t + M_te c beta'^2,    N = F_e + c (M_ee beta'^2 - M_et beta'')

With M = m_e in all directions and the lag d of e behind F, m_e c beta'' = |F| sin d, N = |F| cos d + m_e c beta'^2. A
unit relative motion moves link i by V_i, so M = sum V_i^T m_i V_i. By virtual work -V_i are the reactions at the joint
under unit loads on link i.
"""

import itertools
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ..cycle.extremes import extrema
from ..cycle.means import TERM_ROUNDING, closed_turn, means
from ..cycle.piecewise import JUMP_OFFSET, chebyshev_values, rule
from ..errors import ParameterError
from ..machine.cams.profile import POSITIVE
from ..machine.links import Turning, Wrench, arm
from ..machine.loads import TURN, spring_masses
from ..numbers import checks
from ..numbers.planar import cross
from ..numbers.sign_changes import sign_changes
from .result import Row, Sized, warn_of_notes

NUMBERS = {"clearance": ("m", POSITIVE), "damping": ("1", POSITIVE)}
"""Units and rules of the options."""
KNOT_STEP = 1.5e-3
"""Largest crank angle between knots of the splines of forces and masses, rad: cubic interpolation errs by 1e-12."""
TINY = np.finfo(float).tiny
ZERO_FORCE, MIN_MASS_RATIO = 1e-9, 1e-9
"""Least over largest force, and principal effective mass, below which the least counts as zero."""
OFFSETS = np.geomspace(1e-9, 1e-2, 60)
"""Distances from least forces, rad, at which the index is also evaluated, because it peaks there."""
BEFORE = 1e-5
"""Distance from a zero of a force at which its direction is evaluated, rad."""
TOLERANCE, PERIODIC_TOLERANCE, MAX_PERIODS = 1e-8, 1e-6, 30
"""Relative error of a step; negligible change of angle (rad) and rate over a period; largest number of periods."""
MAX_SWINGS, MAX_INDEX, MAX_EVALUATIONS = 3000, 0.5, 80_000
"""Largest number of swings per period; index below which more swings count as rest; evaluations of the motion."""
SCREEN = "a screen for one joint with play: it gives the loss of contact and the first landing, not the motion after it"


class Flight(NamedTuple):
    """A loss of contact: crank angles of leaving and landing, rad, then speed (m/s) and energy (J) of the impact.

    The journal crosses its play freely, M r'' = F. A landing with the velocity v along the normal n is an impact
    without rebound of the energy v^2/(2 n.M^-1.n).
    """

    start: float
    stop: float
    speed: float
    energy: float


@dataclass(frozen=True, eq=False, repr=False)
class ContactLoss(Sized):
    """Loss of contact of a journal, and its impacts; `contact_loss` returns it.

    Attributes
    ----------
    joint : str
    period : float
        rad.
    reversals : tuple of float
        Crank angles at which the force without play passes through zero, rad.
    flights : tuple of Flight
        Losses of contact, in order of time.
    angle, force, normal, lag, index_curve : array (N,)
        Crank angle, rad; magnitude of the force without play and normal force of the pendulum, N; angle from journal to
        force, counter-clockwise, rad; index. After a loss the pendulum, always in contact, no longer describes the
        journal.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, coupler=ks.Link(1.0, 0.08, 0.01), slider=ks.Link(2.0))
    >>> found = ks.sizing.contact_loss(ks.solve(pump, 0.0, crank_speed=100.0), "B", clearance=2e-5)
    >>> print(", ".join(f"{flight.energy * 1e3:.2f} mJ at {flight.stop:.3f} rad" for flight in found.flights[:2]))
    0.24 mJ at 1.475 rad, 0.17 mJ at 5.074 rad
    """

    ROWS: ClassVar = {
        "index": Row("1", "largest index; contact is lost from about 1", "|dtheta/dt| sqrt(M_tt c/|F|), theta of F"),
        "earles_wu": Row("rad/s/N^0.5", "index without mass and play", "|dtheta/dt|/sqrt|F| (Earles, Wu 1977)"),
        "least_force": Row("N", "least force on the joint without play", "min |F|"),
        "least_normal": Row("N", "least normal force, negative: lost", "F_e + c (M_ee beta'^2 - M_et beta'')"),
        "effective_mass": Row("kg", "mass across F at the largest index; along F at a reversal", "M = sum V^T m V"),
        "lost_angle": Row("rad", "crank angle without contact in a period", "sum of flights, M r'' = F"),
        "impact_speed": Row("m/s", "largest speed of impact", "along the normal, M r'' = F in flight"),
        "impact_energy": Row("J", "largest energy of an impact without rebound", "v^2/(2 n.M^-1.n)"),
    }
    joint: str
    period: float
    reversals: tuple[float, ...]
    flights: tuple[Flight, ...]
    angle: np.ndarray
    force: np.ndarray
    normal: np.ndarray
    lag: np.ndarray
    index_curve: np.ndarray
    index: float
    earles_wu: float
    effective_mass: float
    least_force: float
    least_normal: float
    lost_angle: float
    impact_speed: float
    impact_energy: float


def contact_loss(solution, joint, clearance, damping=0.05):
    """Contact loss in a joint with play: where the journal leaves the bearing, and the impact at its landing.

    The method is approximate: the journal is a pendulum in the rotating force without play (Earles and Wu, *J. Eng.
    Ind.* 99(2), 1977, 375); its periodic motion gives the normal force. Across a direction without mass the journal
    follows the force, and contact is lost only where the force passes through zero.

    Parameters
    ----------
    solution : Solution
        One design; its crank angles have no effect, and its speed counts as constant.
    joint : str
        Name of the reaction of a pin: "O", "A", "B" ...
    clearance : float
        Radial play c, half the difference of the diameters, m.
    damping : float
        Damping ratio of the journal's oscillation about the direction of the force. It is divided by 1 + index^2, so
        that a fast-turning force does not drag the journal along. A loss that vanishes with other damping is marginal.

    Returns
    -------
    ContactLoss

    Raises
    ------
    ParameterError
        A number is not positive, or the solution is a batch of designs. The joint is not a pin, carries no force or has
        no mass. The crank is at rest, the mechanism does not close all round, or its force grows without bound. The
        journal does not land within a period, or swings too often in a period.

    Warns
    -----
    HintWarning
        The force passes through zero, or the motion does not become periodic.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, coupler=ks.Link(1.0, 0.08, 0.01), slider=ks.Link(2.0))
    >>> found = ks.sizing.contact_loss(ks.solve(pump, 0.0, crank_speed=100.0), "B", clearance=2e-5)
    >>> print(f"index {found.index:.3f}, least normal force {found.least_normal:.0f} N")
    index 76.061, least normal force -18 N
    """
    owner = "contact_loss"
    checks.require(owner, checks.solution("solution", solution))
    pins = tuple(
        name
        for name, pair in solution.mechanism.pairs.items()
        if isinstance(pair, Turning) and pair.link != pair.against and name in solution.reactions
    )
    given = {"clearance": (clearance, *NUMBERS["clearance"]), "damping": (damping, *NUMBERS["damping"])}
    numbers = checks.single_numbers(owner, checks.choice("joint", joint, pins), **given)
    play = _Play(solution, joint, closed_turn(solution, owner), **numbers)
    found = extrema(solution, joint)
    least = found.angle[~found.maximum]
    reversals = least[found.value[~found.maximum] <= ZERO_FORCE * found.largest]
    around = np.mod(np.add.outer(least, [*-OFFSETS, 0.0, *OFFSETS]).ravel(), play.period)
    result = _judged(play, joint, reversals, np.union1d(play.knots, around))
    warn_of_notes(owner, Sized(result.notes[1:]))  # all but the first, SCREEN, which applies to every result
    return result


def _judged(play, joint, reversals, angle):
    """The `ContactLoss` at crank angles, including those near least forces."""
    size, direction, _, across = play.follow(angle)
    index, notes, peaks = play.indices(angle)[1], [SCREEN], [np.inf, np.inf]
    mass, starts = across[np.argmax(index)], [(at, play.follow(at - play.sense * BEFORE)[1], 0.0) for at in reversals]
    if reversals.size:
        mass = _resolved(play.at(reversals[0])[2:5], (np.cos(starts[0][1]), np.sin(starts[0][1])))[0]
        degrees = ", ".join(f"{degree:.1f}" for degree in np.degrees(reversals))
        notes.append(f"the force at {joint} passes through zero at {degrees} deg: the index is infinite")
    else:
        peaks = [_largest(lambda at, row=row: play.indices(at)[row], angle) for row in (1, 0)]
    normal, lag, least = size, np.zeros(angle.shape), float(size.min())
    swings = play.swings()
    if swings > MAX_SWINGS and index.max() > MAX_INDEX:
        words = f"the journal swings {swings:.2g} times in a period, more than the {MAX_SWINGS} allowed"
        raise ParameterError(f"contact_loss: {words}; give a larger clearance or crank speed")
    if swings > MAX_SWINGS:
        notes.append(f"the journal swings {swings:.2g} times in a period: it counts as aligned with the force")
    elif not play.lacks_mass:
        motion, repeats, periods = play.motion()

        def normal_force(at):
            return play.contact(at, *motion(at))[1]

        if not repeats:
            notes.append(f"the journal reached no periodic motion in {periods} periods: the last one is used")
        normal, lag = normal_force(angle), _within_half_a_turn(direction - motion(angle)[0])
        least = -_largest(lambda at: -normal_force(at), angle)
        changes = sign_changes(lambda at: [normal_force(at[0])], play.period, angle).angle[0]
        leaving = (at for at in np.sort(changes) if normal_force(at + play.sense * BEFORE) < 0.0)
        starts = [(at, *motion(at)) for at in leaving]
    flights: list[Flight] = []
    for start in starts[:: int(play.sense)]:
        if not flights or play.sense * (start[0] - flights[-1].stop) >= 0.0:
            flights.append(play.flight(*start))
    curves = angle, size, normal, lag, np.where(np.isin(angle, reversals), np.inf, index)
    lost = sum(abs(flight.stop - flight.start) for flight in flights)
    hardest = np.max([(0.0, 0.0), *(flight[2:] for flight in flights)], axis=0).tolist()
    numbers = *peaks, float(mass / play.scale), float(size.min()), least, float(lost), *hardest
    return ContactLoss(tuple(notes), joint, play.period, tuple(reversals.tolist()), tuple(flights), *curves, *numbers)


def _largest(function, angle):
    """Largest value of a function, refined around its maximum at the crank angles."""
    from scipy.optimize import minimize_scalar

    values = function(angle)
    place = int(np.argmax(values))
    ends = angle[max(place - 1, 0)], angle[min(place + 1, angle.size - 1)]
    found = minimize_scalar(lambda at: -function(at), bounds=ends, method="bounded", options={"xatol": 1e-12})
    return max(float(values[place]), -float(found.fun))


def effective_mass(solution, joint):
    """Effective mass M (2, 2, N) against relative motion in a turning pair, crank prescribed, without friction, kg."""
    placement, links, springs = solution.placement, solution.mechanism.links, spring_masses(solution.loads)
    units, loads, masses = iter(np.eye(3 * len(links))[..., None]), {}, []
    for name, link in links.items():
        force, to_centre = (next(units), next(units)), arm(placement.links[name].direction, *link.body[1:3])
        loads[name] = Wrench(force, next(units) + (0.0 if to_centre is None else cross(to_centre, force)))
        mass = link.mass + (springs[name].moving if name in springs else 0.0)
        masses += [mass, mass, link.inertia]
    with np.errstate(divide="ignore", invalid="ignore"):
        found = solution.mechanism.resolve(placement, loads, {}).reactions[joint]
    shape = len(masses), *solution.shape
    ways = np.stack([np.broadcast_to(0.0 if part is None else part, shape) for part in found])
    return np.einsum("aiN,i,biN->abN", ways, np.array(masses, dtype=float), ways)


class _Play:
    """Force F and mass M over the crank angle, and the journal in its play; M times c omega^2, rates by crank angle."""

    def __init__(self, solution, joint, turn, clearance, damping):
        self.speed, self.period = float(np.mean(solution.crank_speed)), turn.period
        self.sense, self.clearance, self.damping = np.sign(self.speed), clearance, damping
        self.scale = clearance * self.speed**2

        def function(angle):
            at = turn.at.moved_to(turn.clear(angle))
            mass = self.scale * effective_mass(at, joint)
            return np.stack([*-at.reaction(joint), mass[0, 0], mass[0, 1], mass[1, 1]])

        usable = turn.angle[turn.usable]
        sizes, rounding = function(usable), TERM_ROUNDING * np.max(turn.at.moved_to(usable).largest_force_term)
        force, mass = np.abs(sizes[:2]).max(), np.abs(sizes[2:]).max()
        grows = not np.isfinite(force + mass) or solution.mechanism.grows(joint)
        whys = {
            "crank_speed must not be 0": self.speed == 0.0,
            f"the force at {joint!r} grows without bound": grows,
            f"{joint!r} carries no force": force <= rounding,
            f"{joint!r} has no mass on either side; give its links masses": mass == 0.0,
        }
        if why := next((text for text, holds in whys.items() if holds), None):
            raise ParameterError(f"contact_loss: {why}, so its contact loss cannot be computed")
        _, _, pieces, values = means(function, turn, np.array([rounding] * 2 + [TERM_ROUNDING * mass] * 3))
        self._interpolate(pieces, values[..., 1:-1])

    def _interpolate(self, pieces, values):
        from scipy.interpolate import CubicHermiteSpline

        own, half = rule(pieces.count), pieces.half
        places = np.linspace(-1.0, 1.0, 2 + int(2.0 * half.max() / KNOT_STEP)) * (1.0 - JUMP_OFFSET / half)
        orders = [values @ own.series.T]
        for _ in range(2):
            orders.append(orders[-1] @ own.derived.T / half)
        at_places = chebyshev_values(pieces.count, places.ravel()).reshape(pieces.count, *places.shape)
        value, slope, bend = (np.einsum("fpc,cpk->pkf", part, at_places).reshape(-1, 5) for part in orders)
        self.knots = (pieces.middle[:, None] + half * places).ravel()
        both = np.column_stack([value, slope[:, :2]]), np.column_stack([slope, bend[:, :2]])
        self.spline = CubicHermiteSpline(self.knots, *both)
        self.cubics = np.moveaxis(self.spline.c, 1, 0).copy()
        xx, xy, yy = value[:, 2:].T
        self.lacks_mass = bool(np.any(xx * yy - xy * xy <= MIN_MASS_RATIO * (xx + yy) ** 2))

    def at(self, angle):
        """F, M and F' at crank angles, (7, ...): x, y, xx, xy, yy, x', y'."""
        if not isinstance(angle, float):
            return self.spline(np.mod(angle, self.period)).T
        angle = angle % self.period  # a call of the spline takes several times as long
        part = min(max(int(self.knots.searchsorted(angle)) - 1, 0), self.knots.size - 2)
        third, second, first, value = self.cubics[part]
        step = angle - self.knots[part]
        return (value + step * (first + step * (second + step * third))).tolist()

    def follow(self, angle):
        """Magnitude of F, its direction, its rate of turning, and M across it."""
        x, y, *mass, dx, dy = self.at(angle)
        size = np.maximum(np.hypot(x, y), TINY)
        across = _resolved(mass, (x / size, y / size))[2]
        across = np.where(across > MIN_MASS_RATIO * (mass[0] + mass[2]), across, 0.0)
        return size, np.arctan2(y, x), (x * dy - y * dx) / size / size, across

    def indices(self, angle):
        """Rate of turning of F by time over the root of its magnitude, and over the journal's natural frequency."""
        size, _, rate, across = self.follow(angle)
        index = np.abs(rate) / np.sqrt(size)
        return np.array([abs(self.speed) * index, np.sqrt(across) * index])

    def contact(self, angle, turned, rate):
        """Second derivative of the journal's angle, and the normal force without damping, N."""
        x, y, *mass, dx, dy = self.at(angle)
        e = np.cos(turned), np.sin(turned)
        ee, et, tt = _resolved(mass, e)
        size = np.maximum(np.hypot(x, y), TINY)
        turning, own = (x * dy - y * dx) / size / size, np.sqrt(size / tt)
        free = (e[0] * y - e[1] * x + et * rate * rate) / tt
        damped = free - 2.0 * self.damping * self.sense * own * (rate - turning) / (1.0 + (turning / own) ** 2)
        return damped, e[0] * x + e[1] * y + ee * rate * rate - et * free

    def swings(self):
        """Number of swings about the force in a period; 0 for a journal without mass."""
        size, *_, across = self.follow(self.knots)
        return 0.0 if self.lacks_mass else float(np.trapezoid(np.sqrt(size / across), self.knots) / (2.0 * np.pi))

    def motion(self):
        """Angle and rate of the journal by the crank angle, whether they repeat after the period, number of periods."""
        from scipy.integrate import solve_ivp

        def slopes(angle, y, calls):
            if next(calls) > MAX_EVALUATIONS:
                words = f"the journal's motion cannot be computed at {np.degrees(np.mod(angle, self.period)):.6g} deg"
                raise ParameterError(f"contact_loss: {words}, where forces or masses jump")
            turned, rate = y.tolist()
            return rate, self.contact(angle, turned, rate)[0]

        size, direction, rate, _ = self.follow(self.knots)
        first = int(np.argmax(size))
        ends = self.knots[first], self.knots[first] + self.sense * self.period
        state, repeats, periods, evaluations = np.array([direction[first], rate[first]]), False, 0, 0
        options = {"method": "LSODA", "rtol": TOLERANCE, "atol": TOLERANCE, "dense_output": True}
        while not repeats and periods < MAX_PERIODS and evaluations < MAX_EVALUATIONS:
            run = solve_ivp(slopes, ends, state, args=(itertools.count(),), **options)
            change, state, periods = run.y[:, -1] - state, run.y[:, -1], periods + 1
            evaluations += run.nfev
            change[0] = _within_half_a_turn(change[0])
            repeats = bool(np.abs(change).max() < PERIODIC_TOLERANCE * (1.0 + abs(state[1])))
        return lambda angle: run.sol(min(ends) + np.mod(angle - min(ends), self.period)), repeats, periods

    def flight(self, start, turned, rate):
        """`Flight` of a journal from the angle and rate at which it leaves."""
        from scipy.integrate import solve_ivp

        def pushed(angle, force=None):
            x, y, xx, xy, yy, *_ = self.at(angle)
            inverse = np.linalg.pinv([[xx, xy], [xy, yy]], MIN_MASS_RATIO, hermitian=True)
            return inverse @ ((x, y) if force is None else force)

        def slopes(angle, y):
            return [*y[2:], *pushed(angle)]

        def landing(angle, y):
            return np.hypot(*y[:2]) - (1.0 + TOLERANCE)

        vars(landing).update(terminal=True, direction=1.0)
        e, ends = np.array([np.cos(turned), np.sin(turned)]), (start, start + self.sense * self.period)
        begin, options = [*e, -rate * e[1], rate * e[0]], {"rtol": TOLERANCE, "atol": TOLERANCE**1.5, "max_step": 0.02}
        run = solve_ivp(slopes, ends, begin, events=landing, **options)
        if not run.t_events[0].size:
            raise ParameterError("contact_loss: the journal does not land within a period: the clearance is too large")
        (stop,), (state,) = run.t_events[0], run.y_events[0]
        n = state[:2] / np.hypot(*state[:2])
        speed = abs(float(n @ state[2:]))
        energy = 0.5 * self.clearance * speed**2 / float(n @ pushed(stop, n))
        return Flight(float(start), float(stop), speed * self.clearance * abs(self.speed), energy)


def _within_half_a_turn(angle):
    return np.remainder(angle + np.pi, TURN) - np.pi


def _resolved(mass, e):
    """M_ee, M_et, M_tt of M by xx, xy, yy in a direction e, t a quarter turn ahead of it."""
    (xx, xy, yy), (a, b) = mass, e
    along, across = xx * a * a + 2.0 * xy * a * b + yy * b * b, xx * b * b - 2.0 * xy * a * b + yy * a * a
    return along, (yy - xx) * a * b + xy * (a * a - b * b), across
