"""The crankshaft: rocking moment of the machine, reactions of two bearings, torque between throws.

Each group acts in its plane, at a position z along the shaft (`machine.planes`). The inertia forces F_i of links and
springs have the moment

    (M_x, M_y) = sum of z_i k x F_i = (-sum z_i F_iy, sum z_i F_ix)

on the frame, about the axes x and y through O in the plane z = 0, right-handed, k along z. The shaft is statically
determinate on bearings at z1 < z2. With the forces P_i of groups on the crank, its own inertia and weight,

    R_right = -sum of P_i (z_i - z1) / (z2 - z1),    R_left = R_O - R_right

The torque in the shaft beside a throw is minus the sum of the moments about O of all loads between it and the free end.
Friction in main bearings, belts and gears are left out. Source of the couples: J. P. den Hartog, *Mechanical
Vibrations*, 1956, chapter 5.
"""

from functools import reduce

from ..errors import QuantityError
from ..machine.group import CRANK
from ..machine.links import Wrench, acceleration_of, arm, first_at, present, second_at
from ..machine.loads import balance_shafts
from ..numbers import checks
from ..numbers.arithmetic import sign
from ..numbers.planar import add_vectors, left, minus, plus, product, scale_vector, subtract_vectors


def _require_planes(mechanism):
    if not mechanism.has_planes:
        raise QuantityError(f"{mechanism.name}: no part has a plane; give one, as in ks.SliderGroup(..., plane=0.1)")


def rocking_moment(state):
    """Moment of the inertia of all moving masses on the frame about x and y through O, (x, y), N m; None without."""
    _require_planes(state.mechanism)
    planes = state.mechanism.planes
    forces = [(name, wrench.force) for name, wrench in state.inertia.items()] + state.spring_inertia
    moments = (scale_vector(present(planes[name]), force) for name, force in forces)
    shafts = (scale_vector(present(item.plane), item.shaking(state).force) for item in balance_shafts(state.loads))
    total = reduce(add_vectors, (*moments, *shafts), _couple_of_crank(state))
    return None if total is None else left(total)


def _couple_of_crank(state):
    """Sum of z times inertia force over the crank, without that of its mass centre, N m; None without couple."""
    couple = state.mechanism.crank.link.couple_unbalance
    lever = couple and arm(state.placement.links[CRANK].direction, *map(present, couple))
    if lever is None:
        return None
    turning = state.placement.links[CRANK], lever
    return scale_vector(-1.0, acceleration_of(first_at(*turning), second_at(*turning), *state.accelerating))


def _loads_on_shaft(state):
    """Pairs of a plane and the wrench about O on the crank: of each group on it, and its own."""
    planes, loads = state.mechanism.planes, [(state.mechanism.planes[CRANK], state.link_loads[CRANK])]
    for name, wrench in state.resolved.demands.items():
        loads.append((planes[name], Wrench(subtract_vectors(None, wrench.force), minus(None, wrench.moment))))
    return [(present(plane), wrench) for plane, wrench in loads]


def bearing_reaction(state, joint, at):
    """Force of a main bearing, "left" or "right", on the crank, (x, y), N."""
    mechanism = state.mechanism
    problem = checks.choice(f"{mechanism.name}: joint with main bearings", joint, ("O",))
    problem = problem or checks.choice(f"{mechanism.name}: at", at, ("left", "right"))
    if problem is None and mechanism.crank.bearings is None:
        problem = f"{mechanism.name}: the crank has no bearings; give ks.Crank(..., bearings=(-0.4, 0.4))"
    if problem:
        raise QuantityError(problem)
    first, second = mechanism.crank.bearings
    moments = (scale_vector(minus(z, present(first)), wrench.force) for z, wrench in _loads_on_shaft(state))
    total = reduce(add_vectors, moments, _couple_of_crank(state))
    right = scale_vector(-1.0 / (second - first), total)
    return right if at == "right" else subtract_vectors(state.resolved.reactions[joint], right)


def shaft_torque(state, group, drive):
    """Torque in the shaft beside the throw of a group, on the side of the drive, N m; None if it is 0."""
    mechanism = state.mechanism
    _require_planes(mechanism)
    problem = checks.choice(f"{mechanism.name}: group on the crank", group, mechanism.on_shaft)
    if problem := problem or checks.choice(f"{mechanism.name}: drive", drive, ("left", "right")):
        raise QuantityError(problem)
    here, total = present(mechanism.planes[group]), None
    for z, wrench in _loads_on_shaft(state):
        nearer = minus(here, z) if drive == "right" else minus(z, here)
        share = 1.0 if z is here or nearer is None else 0.5 + 0.5 * sign(nearer)
        total = plus(total, product(share, wrench.moment))
    return minus(None, total)
