"""Simplifications of a scene: parts left out, or replaced by simpler ones.

They include couplers as two point masses, and kinematics as Fourier series of the joint paths (harmonic series of
engine theory; Biezeno and Grammel, *Technische Dynamik*).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate, repeat

import numpy as np

from ..engines.engines import Kernels
from ..errors import NotGivenError
from ..machine.crank import ray
from ..machine.friction import KINDS as FRICTIONS
from ..machine.friction import friction_kind
from ..machine.friction import frictions_by_joint as friction_of
from ..machine.group import FRAME
from ..machine.guide import Guide
from ..machine.kinematic_state import Placement
from ..machine.links import Joint, Link
from ..machine.loads import KINDS
from ..numbers import checks
from ..numbers.parameter_tree import come_from_one_class, map_numbers
from ..numbers.planar import rotate
from ..solution.solution import Solution

SERIES_SAMPLES = 512
"""Samples of a turn for the coefficients of harmonic series."""


def placement_from_joints(mechanism, angle, *orders) -> Placement:
    """Placement of a mechanism from the positions of its moving joints, (joints, 2, ...), and their derivatives."""
    found = zip(moving_joints(mechanism), *orders, strict=True)
    joints = {name: Joint(*map(tuple, parts)) for name, *parts in found}
    placement = mechanism.crank.place(angle)
    for group in mechanism.groups:
        if not come_from_one_class(type(group), "follow", "place"):
            raise NotGivenError(f"{type(group).__name__} has no `follow` to place it at known joints")
        group.follow(placement, joints)
    return placement


def moving_joints(mechanism):
    """Names of the moving joints of groups; the crank pin is not among them."""
    return [name for group in mechanism.groups for name, point in group.joints.items() if point.link != FRAME]


def joint_positions(mechanism, angle):
    """Positions of the moving joints, (joints, 2, ...), m."""
    names, shape = moving_joints(mechanism), np.shape(angle)
    joints = mechanism.place(angle).joints
    found = [[np.broadcast_to(part, shape) for part in joints[name].position] for name in names]
    return np.array(found, dtype=float).reshape(len(names), 2, *shape)


def paths_over_turn(mechanism, angle):
    """Positions over a whole turn; an error if no joint moves or a group does not close all around."""
    found = joint_positions(mechanism, angle)
    if not found.size:
        what = "moves only the crank pin" if mechanism.groups else "is only a crank"
        raise NotGivenError(f"{mechanism.name} {what}: no joint has a path for a series")
    if mechanism.turns > 1:
        raise NotGivenError(f"{mechanism.name} repeats after {mechanism.turns} turns, a Fourier series after one")
    if not np.all(np.isfinite(found)):
        raise NotGivenError(f"{mechanism.name} does not close all around the turn, which a Fourier series needs")
    return found


def up_to_harmonic(order, solution):
    """The solution by Fourier series of the joint paths, truncated after a harmonic of the crank angle.

    For the plain crank-slider these are the series of engine theory (Biezeno and Grammel, *Technische Dynamik*), with
    coefficients to all powers of crank over coupler length.
    """
    mechanism = solution.mechanism
    path = paths_over_turn(mechanism, np.linspace(0.0, 2 * np.pi, SERIES_SAMPLES, endpoint=False))
    spectrum = 2.0 * np.fft.rfft(path)[..., : order + 1] / SERIES_SAMPLES
    spectrum[..., 0] /= 2.0
    spectrum[abs(spectrum) < 1e-14 * abs(spectrum).max()] = 0.0
    return replace(solution, engine=Kernels(partial(_evaluate_series, order=order, series=spectrum.tolist())))


def _evaluate_series(mechanism, angle, order, series):
    multiples = list(accumulate(repeat(ray(angle), order), rotate))  # unit vectors at 1, 2 ... times the crank angle

    def total(coefficients, derivative):
        """Derivative of the real part of the series sum of a conj(multiple), without zero terms."""
        value = coefficients[0].real if derivative == 0 else 0.0
        for k, (coefficient, (cosine, sine)) in enumerate(zip(coefficients[1:], multiples, strict=True), 1):
            factor = coefficient * (1j * k) ** derivative
            for part, function in ((factor.real, cosine), (-factor.imag, sine)):
                if part != 0.0:
                    value = value + part * function
        return value

    orders = ([[total(row, derivative) for row in rows] for rows in series] for derivative in range(3))
    return placement_from_joints(mechanism, angle, *orders)


@dataclass(frozen=True)
class Choice:
    """A simplification by name; `simplify` returns the simpler solution, or None if nothing changes.

    `simplify` raises `NotGivenError` with the reason if the scene does not allow it.
    """

    name: str
    simplify: Callable[[Solution], Solution | None]


def two_mass_coupler(mechanism, only=None):
    """The mechanism with each coupler replaced by two point masses at its joints; None if no coupler has mass.

    Total mass and position of the mass centre along the link are kept; the moment of inertia becomes m s (l - s)
    (Biezeno and Grammel, *Technische Dynamik*). A coupler is a bar from a joint of one link to a joint of another
    (`Mechanism.couplers`); a mass at a joint of the frame does not count.

    Parameters
    ----------
    mechanism : Mechanism
    only : str, optional
        Name of the couplers to replace, without the labels of their groups; all by default.

    Returns
    -------
    Mechanism or None

    Raises
    ------
    NotGivenError
        A mass centre is beyond a joint, so the mass at the other joint would be negative.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> simpler = ks.two_mass_coupler(saw)
    >>> simpler.links["crank"].mass, simpler.links["slider"].mass, simpler.links["coupler"].mass
    (75.0, 675.0, 0.0)
    """
    checks.require("two_mass_coupler", checks.mechanism("mechanism", mechanism))
    made = mechanism
    for bar in reversed(mechanism.couplers):
        coupler = made.links[bar.link]
        if only not in (None, mechanism.own_names[bar.link]) or _is_zero(coupler.mass):
            continue
        outer = coupler.mass * coupler.centre[0] / bar.length
        if np.any(outer < 0) or np.any(outer > coupler.mass):
            raise NotGivenError(
                f"the mass centre of the {bar.link}, {coupler.centre[0]} m along its {bar.length} m, is beyond "
                "its joints, so one of two masses at them would be negative"
            )
        made = made.with_link(bar.link, Link())
        for joint, mass in ((bar.start, coupler.mass - outer), (bar.end, outer)):
            link, along, across = mechanism.joints[joint]
            if link != FRAME:
                made = made.with_link(link, made.links[link].joined(mass, (along, across)))
    return None if made is mechanism else made


def _is_zero(value):
    return isinstance(value, int | float) and value == 0


# Simplifications of a scene: functions of the solution that return None if there is nothing to simplify


def _without_load(kind, solution):
    """The solution without its springs, weight or other loads of a kind."""
    kept = tuple(item for item in solution.loads if not isinstance(item, kind))
    return replace(solution, loads=kept) if len(kept) < len(solution.loads) else None


def _without_friction(kind, solution):
    gone = {joint for joint, friction in solution.friction.acting.items() if isinstance(friction, kind)}
    left = {
        joint: replace(item, **dict.fromkeys(item.COEFFICIENTS, 0.0)) if joint in gone else item
        for joint, item in solution.friction.items()
    }
    return replace(solution, friction=replace(friction_of(left), passes=solution.friction.passes)) if gone else None


def _at_constant_speed(solution):
    return None if _is_zero(solution.crank_acceleration) else replace(solution, crank_acceleration=0.0)


def _with_links(changed, kind, solution):
    """The solution with the links of a kind (None: all) by ``changed(link)``, or the same link if nothing changes."""
    mechanism = solution.mechanism
    for name, link in solution.mechanism.links.items():
        if kind in (None, mechanism.own_names[name]) and (new := changed(link)) is not link:
            mechanism = mechanism.with_link(name, new)
    return None if mechanism is solution.mechanism else replace(solution, mechanism=mechanism)


def _massless(link):
    return link if _is_zero(link.mass) and _is_zero(link.inertia) else Link()


def _without_inertia(link):
    return link if _is_zero(link.inertia) else replace(link, inertia=0.0)


def _centre_on_axis(link):
    return link if _is_zero(link.centre[1]) else replace(link, centre=(link.centre[0], 0.0))


def two_masses(kind, solution):
    mechanism = two_mass_coupler(solution.mechanism, kind)
    return None if mechanism is None else replace(solution, mechanism=mechanism)


def _guides_through_crank_centre(solution):
    mechanism = solution.mechanism
    if all(_is_zero(guide.guide_offset) for guide in mechanism.guides.values()):
        return None
    through = {Guide: lambda guide: replace(guide, guide_offset=0.0)}
    return replace(solution, mechanism=map_numbers(mechanism, lambda number: number, through))


CHOICES_BEFORE_LINKS = {
    **{name: (Choice(f"no {name}", partial(_without_load, kind)),) for kind in KINDS for name in [kind.RULES.owner]},
    "crank acceleration": (Choice("constant crank speed", _at_constant_speed),),
    "guide offset": (Choice("guide through O", _guides_through_crank_centre),),
    "mass-centre offsets": (Choice("mass centres on the links", partial(_with_links, _centre_on_axis, None)),),
}
HARMONICS = Choice("two harmonics", partial(up_to_harmonic, 2)), Choice("one harmonic", partial(up_to_harmonic, 1))


def ingredients(mechanism):
    """Simplifications by ingredient, in order of severity; they are applied in this order.

    Links have their names without the labels of groups. Couplers come after other links, to which they add masses;
    kinematics come last.
    """
    kinds = mechanism.own_names
    couplers = {kinds[bar.link] for bar in mechanism.couplers}
    hung = {kinds[bar.link] for group in mechanism.groups for bar in group.bars}
    links = {}
    for kind in sorted(dict.fromkeys(kinds.values()), key=lambda kind: kind in couplers):
        choices = []
        if kind in hung:
            choices.append(Choice(f"no {kind} inertia", partial(_with_links, _without_inertia, kind)))
        if kind in couplers:
            choices.append(Choice(f"two-mass {kind}", partial(two_masses, kind)))
        links[kind] = (*choices, Choice(f"massless {kind}", partial(_with_links, _massless, kind)))
    rubs = {friction_kind(pair) for pair in mechanism.pairs.values()}
    names = {kind.RULES.owner: kind for kind in FRICTIONS if kind in rubs}
    friction = {name: (Choice(f"no {name}", partial(_without_friction, kind)),) for name, kind in names.items()}
    return CHOICES_BEFORE_LINKS | friction | links | {"kinematics": HARMONICS}
