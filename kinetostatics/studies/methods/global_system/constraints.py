"""Constraint equations of a whole mechanism, from which follow its motion, and all its forces by one linear system.

Every moving link has three coordinates in q: x and y of its reference joint, and its angle theta. Joints, guides,
slot, cam and drive give as many constraint equations C(q, phi) = 0 with Jacobian J = dC/dq (Nikravesh, *Computer-Aided
Analysis of Mechanical Systems*; Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*):

    J qdot = -omega dC/dphi        J qddot = gamma - alpha dC/dphi        J^T lambda = M qddot - Q

Each equation is written so that its multiplier in lambda is a reaction, signed as in the library, or the drive torque.

Other ways to the motion of the joints: differences, spectra, harmonic series; and the coupler as two masses.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ....engines.engines import Kernels
from ....errors import NotGivenError, ParameterError
from ....machine.group import FRAME
from ....mechanics.quantities import components
from ....numbers.planar import left
from ...series import assembled, closed_paths, harmonic_series, joints_of, positions
from ...simplifications import two_mass_coupler
from ..engines import compiled_run
from ..method import Method, require_one_design
from ..structures import structure
from .applied import Following

POSITION, RATE, ACCELERATION, FORCE = range(4)


class Sliding(NamedTuple):
    """Equation `row`: the reference joint of one link stays on a straight slot of another.

    The slot runs at the angle of `way`, a complex unit vector, to the direction of its link, at `offset` to the left of
    that link's reference joint.
    """

    row: int
    slotted: int
    block: int
    way: complex
    offset: float


class Model:
    """Constraint equations and masses of a mechanism with k links, in coordinates q (..., 3k): all x, all y, all theta.

    Apart from those of slots and cam, which the configuration fills in, the equations are linear in the terms
    (q, cos theta, sin theta, 1, phi).

    Attributes
    ----------
    equations : array (3k, 5k + 2)
        Coefficients of these terms.
    readings : dict
        By quantity: what it is read from, POSITION q, RATE qdot, ACCELERATION qddot or FORCE lambda, and the
        coefficients (components, 3k) that make it.
    """

    def __init__(self, mechanism):
        self.mechanism = mechanism
        self.names = list(mechanism.links)
        self.size = len(self.names)
        self.equations: Any = []
        self.readings: dict[str, tuple[int, Any]] = {}
        self.guides: dict[str, complex] = {}
        self.cam = None
        self.slidings: list[Sliding] = []
        self.followings: list[Following] = []
        self._held: list[tuple[str, str | None, float]] = []
        *self._terms, (self._one, self._phi) = np.split(np.eye(5 * self.size + 2), np.arange(1, 6) * self.size)
        self._write()
        self.equations = np.array(self.equations)
        self.linear, self.of_cosine, self.of_sine, _ = np.split(self.equations, np.arange(3, 6) * self.size, axis=1)
        self.drive = -self.equations @ self._phi
        links = mechanism.links.values()
        self.mass, self.inertia = (np.array([getattr(link, name) for link in links]) for name in ("mass", "inertia"))
        self.centre = np.array([complex(*link.centre) for link in links])

    def _write(self):
        self._add("O", *self._point("crank"))
        self._add("balancing_torque", self._theta("crank") - self._phi)
        made, self.numbers = structure(self.mechanism)
        bars = {(end, link) for part in made.parts for _, end, link in part.bars}
        for part, group in zip(made.parts[1:], self.mechanism.groups, strict=True):
            for pinned in part.pinned:
                one, other = (self._on(link, pinned.joint, bars) for link in (pinned.link, pinned.other))
                self._add(pinned.name, *(one - other))
            for slid in part.slid:
                self._slide(slid)
            for cam in part.cams:
                self._follow(cam, group)
        for name in self.names:
            turning = self._theta(name)[None, : 3 * self.size]
            self.readings |= {f"{name}_rate": (RATE, turning), f"{name}_angular_acceleration": (ACCELERATION, turning)}

    def _joint(self, name):
        """Joint by name, (2, terms)."""
        point = self.mechanism.joints[name]
        if point.link == FRAME:
            return np.multiply.outer((point.along, point.across), self._one)
        return self._point(point.link, point.along, point.across)

    def _on(self, link, joint, bars):
        """Joint as a point of a link, (2, terms)."""
        point = self.mechanism.joints[joint]
        if point.link == link or (joint, link) not in bars:
            return self._joint(joint) if self.mechanism.references.get(link) != joint else self._point(link)
        return self._point(link, self.numbers[f"{link}_length"])

    def _slide(self, item):
        """Keep a link on a guide; or on a slot of another, a rod the other way round, and at an angle to it."""
        if item.other == FRAME:
            self._guide(item)
            return
        place = f"{item.other}_{item.joint}"
        offset, angle = self.numbers[f"{place}_offset"], self.numbers[f"{place}_angle"]
        ends = (item.link, item.other) if item.rod else (item.other, item.link)
        slotted, block = (self.names.index(name) for name in ends)
        self.slidings.append(Sliding(len(self.equations), slotted, block, np.exp(1j * angle), offset))
        self._add(item.force, 0.0 * self._one)
        ahead = angle + (np.pi if item.rod else 0.0)
        self._held.append((item.link, item.other, ahead))
        self._add(item.couple, self._theta(item.link) - self._theta(item.other) - ahead * self._one)

    def _guide(self, item):
        slider = item.link
        guide, pin = self.mechanism.guides[slider], self._joint(item.joint)
        self._held.append((slider, None, guide.guide_angle))
        along, across = np.array(guide.direction), np.array(left(guide.direction))
        self.guides[slider] = complex(*along)
        force = self._add(item.force, across @ pin - guide.guide_offset * self._one)
        self._add(item.couple, self._theta(slider) - guide.guide_angle * self._one)
        if item.vector:
            self.readings[item.vector] = (FORCE, across[:, None] * force)
        for name, order in {"position": POSITION, "velocity": RATE, "acceleration": ACCELERATION}.items():
            self.readings[f"{slider}_{name}"] = (order, (along @ pin)[None, : 3 * self.size])

    def _follow(self, led, group):
        """Keep a joint on the cam of a group, which is fixed to the frame or to the crank."""
        if led.body == FRAME:
            self.cam, self.block, self.contact = group.cam, self.names.index(led.link), len(self.equations)
        else:
            places = self.names.index(led.body), self.names.index(led.link)
            along = self.numbers[f"{led.joint}_along"]
            self.followings.append(Following(len(self.equations), *places, along, group))
        self._add(led.force, 0.0 * self._one)

    def _add(self, name, *equations):
        """Add equations; their multipliers are the components of the force or moment `name`."""
        start = len(self.equations)
        self.equations += equations
        found = np.eye(3 * self.size)[start : len(self.equations)]
        self.readings[name] = (FORCE, found)
        return found

    def _point(self, link, along=0.0, across=0.0):
        """Point of a link at so far along it and across it, to the left, (2, terms)."""
        x, y, _, cosine, sine = (term[self.names.index(link)] for term in self._terms)
        return np.array([x + along * cosine - across * sine, y + along * sine + across * cosine])

    def _theta(self, link):
        return self._terms[2][self.names.index(link)]

    def start(self, angle):
        """The library's position at one crank angle as coordinates, from which continuation starts."""
        links = self.mechanism.place(np.array(angle)).links
        x, y, ahead, aside = np.array([(*links[k].joint.position, *links[k].direction) for k in self.names], float).T
        theta = _nearest(np.arctan2(aside, ahead), angle)
        for link, other, ahead in self._held:
            place = self.names.index(link)
            wanted = ahead + (0.0 if other is None else theta[self.names.index(other)])
            theta[place] = _nearest(theta[place], wanted)
        return np.concatenate([x, y, theta])


def _nearest(angle, wanted):
    """The angle less or plus whole turns, next to another."""
    return angle + 2 * np.pi * np.rint((wanted - angle) / (2 * np.pi))


STENCILS = {
    2: ((-1, 0, 1), (-0.5, 0.0, 0.5), (1.0, -2.0, 1.0)),
    4: ((-2, -1, 0, 1, 2), (1 / 12, -2 / 3, 0.0, 2 / 3, -1 / 12), (-1 / 12, 4 / 3, -5 / 2, 4 / 3, -1 / 12)),
}
"""By order: offsets in steps, weights of the first and of the second derivative (Fornberg 1988)."""


def _differences(order):
    offsets, first, second = (np.array(row) for row in STENCILS[order])

    def prepare(solution, quantity, step):
        require_one_design(solution)

        def way(mechanism, angle):
            position = positions(mechanism, angle + step * offsets[:, None])
            return assembled(
                mechanism,
                angle,
                joints_of(
                    mechanism,
                    position[:, :, offsets.size // 2],
                    np.tensordot(first / step, position, (0, 2)),
                    np.tensordot(second / step**2, position, (0, 2)),
                ),
            )

        return _approximated(lambda: components(replace(solution, engine=Kernels(way)), quantity))

    return prepare


def _spectral(solution, quantity, samples):
    """Joint positions sampled over the turn, differentiated and interpolated to the crank angles by FFT."""
    require_one_design(solution)
    angle = solution.crank_angle
    if not _is_even_turn(angle):
        raise NotGivenError("spectral differentiation needs crank angles evenly over one turn, its end excluded")
    if samples > angle.size:
        raise NotGivenError(f"{samples} samples are more than the {angle.size} crank angles asked for")
    sampled = np.linspace(0.0, 2 * np.pi, samples, endpoint=False)
    closed_paths(solution.mechanism, sampled)
    harmonic = 1j * np.arange((samples + 1) // 2)
    onward = np.exp(harmonic * angle[0])

    def way(mechanism, angle):
        spectrum = np.fft.rfft(positions(mechanism, sampled))[..., : harmonic.size] * (onward * (angle.size / samples))
        parts = (np.fft.irfft(spectrum * harmonic**k, n=angle.size) for k in range(3))
        return assembled(mechanism, angle, joints_of(mechanism, *parts))

    return _approximated(lambda: components(replace(solution, engine=Kernels(way)), quantity))


def _approximated(run):
    """The same function, which cannot give what loads have no value for where a coarse motion takes the slider."""

    def approximated():
        try:
            return run()
        except ParameterError as why:
            raise NotGivenError(f"the motion found is too coarse: {why}") from why

    return approximated


def _is_even_turn(angle):
    turn = np.linspace(0.0, 2 * np.pi, np.size(angle), endpoint=False)
    return np.ndim(angle) == 1 and np.allclose(angle - angle[0], turn, atol=1e-9)


def _series(solution, order):
    """The solution with its kinematics as a truncated series."""
    require_one_design(solution)
    return replace(solution, engine=Kernels(harmonic_series(solution, order)))


def _two_mass(solution, setting):
    """The solution with its couplers as two masses each."""
    mechanism = two_mass_coupler(solution.mechanism)
    if mechanism is None:
        raise NotGivenError("there is no coupler mass to share out between its joints")
    return replace(solution, mechanism=mechanism)


def _eager(model):
    """Method that computes a simpler model by NumPy."""

    def prepare(solution, quantity, setting):
        simpler = model(solution, setting)
        return _approximated(lambda: components(replace(simpler), quantity))

    return prepare


def _compiled(model):
    """Method that computes a simpler model by a compiled loop, its fastest."""
    return lambda solution, quantity, setting: _approximated(compiled_run(model(solution, setting), quantity))


HARMONICS = (1, 2, 4, 6)
METHODS = (
    Method("differences, 2nd order", _differences(2), "step [rad]", (1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5)),
    Method("differences, 4th order", _differences(4), "step [rad]", (3e-1, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4)),
    Method("spectral differentiation", _spectral, "samples", (8, 12, 16, 24, 32, 48, 64, 128)),
    Method("harmonic series", _eager(_series), "harmonics", HARMONICS),
    Method("harmonic series, compiled", _compiled(_series), "harmonics", HARMONICS),
    Method("two-mass coupler", _eager(_two_mass)),
    Method("two-mass coupler, compiled", _compiled(_two_mass)),
)
