"""Friction in the joints of a group: reactions and friction together, by Newton's method.

Friction is a constant times the magnitude of a reaction. All reactions of a group are linear in the moments and forces
of friction on its links. A magnitude is the reaction times its own direction, so with known directions the
equations are linear. Each pass solves them with the directions of the pass before, which is Newton's method and doubles
the digits; the first pass takes friction from the reactions without friction. For a guide alone the direction is a
sign, and the second pass is exact: N = N0 / (1 + kappa sgn N0).

To first order a magnitude does not change with its direction, so derivatives use fixed directions and need only the
last pass. The number of passes is fixed (`jamming.solve_friction` chooses it), so friction is plain arithmetic.
"""

from dataclasses import dataclass, field
from functools import reduce
from typing import Any, NamedTuple

from ..machine.group import FRAME, Resolved
from ..machine.links import Rolling, Sliding, Turning, Wrench, present
from ..machine.loads.points import wrench_at
from ..numbers.arithmetic import clamped_sqrt, sign, sqrt, stop_gradient
from ..numbers.planar import (
    SYMBOLIC_ZERO,
    add_vectors,
    cross,
    length,
    minus,
    none_if_zero,
    number_or_zero,
    plus,
    product,
    quotient,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
)

MIN_SQUARE = 1e-290
"""Square of a force, N2, that guards divisors: added to the square of a magnitude."""
MIN_FORCE = 1e-100
"""Force, N, or moment, N m, that guards divisors: added to a scale."""


# Friction of one pair


class Channel(NamedTuple):
    """Unit friction load: wrenches on links and pushes on sliders of a moment or force 1."""

    name: str
    wrenches: tuple = ()
    pushes: tuple = ()


class FrictionLaw(NamedTuple):
    """A friction moment or force: `factor` times the size of a reaction.

    Attributes
    ----------
    name : str
        Name of the pair.
    factor : number
        Coefficient, or moment arm, with the sign of the motion.
    reaction : function
        Components of the reaction, a tuple, from a `Resolved`.
    kind : str
        Size of the reaction: "length" of a vector, "size" of a number, "larger" of the sizes of two, or the number
        "itself".
    effects : tuple of (Channel, int)
        Channels by which it acts on links, each with a sign.
    """

    name: str
    factor: Any
    reaction: Any
    kind: str
    effects: tuple

    def magnitude(self, parts):
        """Size of a reaction, or of its change, without its sign."""
        return size_of("size" if self.kind == "itself" else self.kind, parts)


class PairFriction(NamedTuple):
    """Friction of a pair, N m or N, opposite on its link, and the rate; `couple`: of a roller's pin, with its rate."""

    amount: Any
    rate: Any
    couple: Any = None
    couple_rate: Any = None

    @property
    def work(self):
        """Loss per unit of crank angle, with the sign of the crank speed, N m."""
        return plus(product(self.amount, self.rate), product(self.couple, self.couple_rate))


def pair_rate(part, name, pair, placement):
    """Rate by the crank angle at which a pair of a part turns (1) or slides (m); None if it never does."""
    if isinstance(pair, Sliding):
        return part.sliding(name, placement).rate
    if pair.against == pair.link:
        return None
    against = None if pair.against == FRAME else placement.links[pair.against].ratio
    return minus(placement.links[pair.link].ratio, against)


def rolling_resistance(friction):
    """Force t along the curve that turns a roller, and couple of its pin, m (None if zero), for a force of 1 across.

    With the roller's radius r, p = mu times the pin's radius and e the arm of rolling friction: t r = e + p sqrt(1 +
    t^2). The last term is the couple.
    """
    mu, arm, radius = present(friction.mu), present(friction.rolling_arm), friction.roller_radius
    if mu is None:
        return arm / radius, None
    lever = mu * friction.pin_radius / radius
    if arm is None:
        force = lever / sqrt(1.0 - lever * lever)
        return force, force * radius
    share = arm / radius
    force = (share + lever * sqrt(1.0 - lever * lever + share * share)) / (1.0 - lever * lever)
    return force, radius * lever * sqrt(1.0 + force * force)


def size_of(kind, parts):
    """Size of a reaction from its components, N; None if it is absent."""
    if kind == "itself":
        return parts[0]
    given = [part for part in parts if part is not None]
    if len(given) < 2:
        return abs(given[0]) if given else None
    if kind == "length":
        return sqrt(given[0] * given[0] + given[1] * given[1] + MIN_SQUARE)
    return larger(abs(given[0]), abs(given[1]))


def direction_of(law, parts):
    """Factor of a law times the direction of its reaction, by components."""
    if law.kind == "itself":
        return (law.factor,)
    given = [part for part in parts if part is not None]
    if law.kind == "length" and given:
        over = 1.0 / size_of("length", parts)  # derivatives keep the direction
        return tuple(product(law.factor, None if part is None else stop_gradient(over * part)) for part in parts)
    if len(given) < 2:
        return tuple(None if part is None else law.factor * sign(part) for part in parts)
    first, second = given
    ahead = 0.5 * sign(abs(first) - abs(second))
    return law.factor * (0.5 + ahead) * sign(first), law.factor * (0.5 - ahead) * sign(second)


def kink_functions(kind, parts):
    """Functions whose zeros are kinks of the size of a reaction; the length of a vector counts as smooth."""
    given = [part for part in parts if part is not None]
    if kind == "larger" and len(given) == 2:
        return [given[0], given[1], abs(given[0]) - abs(given[1])]
    return given if kind == "size" else []


def larger(a, b):
    return 0.5 * (a + b + abs(a - b))


def smaller(a, b):
    return 0.5 * (a + b - abs(a - b))


# Friction of all pairs of a part


@dataclass(eq=False)
class FrictionSolver:
    """Resolves groups with friction, and keeps the friction of each pair.

    Attributes
    ----------
    found : dict of str to PairFriction
    margins, residuals : list
        By group: margin from jamming and relative change by one more pass (`FrictionEquations`).
    rates, kinks : list
        Rates at whose zeros friction jumps, and forces at whose zeros it has a kink.
    """

    mechanism: Any
    friction: Any
    direction: Any
    found: dict = field(default_factory=dict)
    margins: list = field(default_factory=list)
    residuals: list = field(default_factory=list)
    rates: list = field(default_factory=list)
    kinks: list = field(default_factory=list)

    def __post_init__(self):
        self.acting, self.senses = self.friction.acting, self.friction.senses

    def __call__(self, part, placement, loads, along):
        """Reactions and other forces of a part with friction, a `Resolved` as from `part.resolve`."""
        rates: dict[str, Any] = {}
        laws: list[FrictionLaw] = []
        for name in part.pairs:
            if name in self.acting:
                laws += self._laws(part, name, placement, rates)
        free = part.resolve(placement, loads, along)
        if not laws:
            return free
        own = part.links
        channels = {channel.name: channel for law in laws for channel, _ in law.effects}
        inner = [
            channel
            for channel in channels.values()
            if any(link in own for link, _ in (*channel.wrenches, *channel.pushes))
        ]
        unloaded = dict.fromkeys(own, Wrench((SYMBOLIC_ZERO, SYMBOLIC_ZERO), SYMBOLIC_ZERO))
        columns = [part.resolve(placement, *_with_friction(unloaded, {}, [(channel, 1.0)], own)) for channel in inner]
        equations = FrictionEquations(laws, [channel.name for channel in inner], free, columns)
        amounts = self._amounts(equations, laws, placement)
        for law, amount in zip(laws, amounts, strict=True):
            if law.kind == "itself":  # the roller turns in the opposite sense on the other side of the cam
                turning = pair_rate(part, law.name, self.mechanism.pairs[law.name], placement)
                self.found[law.name] = self.found[law.name]._replace(couple=amount, couple_rate=turning)
            else:
                self.found[law.name] = PairFriction(amount, rates[law.name])
        if equations.margin is not None:
            self.margins.append(equations.margin)
            self.residuals.append(equations.residual)
        acting = [
            (channel, amount if way > 0 else -amount)
            for law, amount in zip(laws, amounts, strict=True)
            for channel, way in law.effects
        ]
        resolved = part.resolve(placement, *_with_friction(loads, along, acting, own))
        self.rates += rates.values()
        for law in laws:
            self.kinks += kink_functions(law.kind, law.reaction(resolved))
        return self._with_friction_forces(resolved, part, placement, acting, own)

    def _amounts(self, equations, laws, placement):
        """Friction of each law."""
        return equations.solve(self.friction.passes, placement.angle)

    def _laws(self, part, name, placement, rates):
        """Friction laws of a pair; its rate goes into `rates`."""
        pair, friction = self.mechanism.pairs[name], self.acting[name]
        if isinstance(pair, Rolling):
            yield from self._rolling_laws(name, pair, placement, rates)
            return
        rate = pair_rate(part, name, pair, placement)
        if rate is None:
            return
        rates[name] = rate
        way = self.senses[name] if name in self.senses else self.direction * sign(rate)
        if isinstance(pair, Turning):
            effects = [(_moment(pair.link), -1)]
            if pair.against != FRAME:
                effects.append((_moment(pair.against), 1))
            factor = friction.mu * friction.radius * way
            yield FrictionLaw(
                name, factor, lambda found: vector_or_zero(found.reactions[name]), "length", tuple(effects)
            )
        else:
            slide, half = part.sliding(name, placement), friction.half_length

            def reaction(found):
                force = found.scalars[pair.force]
                return (force,) if half is None else (force, quotient(found.scalars[pair.couple], half))

            kind = "size" if half is None else "larger"
            if pair.against == FRAME:  # the force stays in the guide's axes
                force = Channel(name, (), ((pair.link, 1.0),))
            else:
                back = Wrench(scale_vector(-1.0, slide.direction), minus(None, slide.moment))
                force = Channel(name, ((pair.link, Wrench(slide.direction, None)), (pair.against, back)))
            yield FrictionLaw(name, friction.mu * way, reaction, kind, ((force, -1),))

    def _rolling_laws(self, name, pair, placement, rates):
        """Force of friction along the curve of a roller, and the couple of its pin.

        The pin carries the cam force and the force along the curve that turns the roller; the couple acts on the link
        that carries the pin. The opposite of both acts on the link of the curve.
        """
        position, _, _ = placement.joints[pair.joint]
        first = vector_or_zero(placement.rate_from(pair.joint, pair.against))
        rates[name] = speed = length(first)
        slope, couple = rolling_resistance(self.acting[name])
        way = self.senses.get(name, self.direction)
        tangent = (first[0] / speed, first[1] / speed)
        wrenches = [wrench_at(placement, self.mechanism.joints[pair.joint], tangent)]
        effects = [(_moment(pair.link), -1)]
        if pair.against != FRAME:
            lever = subtract_vectors(position, placement.links[pair.against].joint.position)
            wrenches.append((pair.against, Wrench(scale_vector(-1.0, tangent), cross(tangent, lever))))
            effects.append((_moment(pair.against), 1))
        force = Channel(f"force of {name}", tuple(wrenches))

        def reaction(found):
            return (found.scalars[pair.force],)

        yield FrictionLaw(name, slope * way, reaction, "size", ((force, -1),))
        if couple is not None:
            yield FrictionLaw(name, couple * way, reaction, "itself", tuple(effects))

    def _with_friction_forces(self, resolved, part, placement, acting, own):
        """The forces of a part, with friction added to reactions of guides and to demands on other links."""
        reactions, demands = dict(resolved.reactions), dict(resolved.demands)
        for channel, amount in acting:
            name = channel.name
            if name in reactions and name in part.pairs:
                along = part.sliding(name, placement).direction
                reactions[name] = add_vectors(
                    reactions[name], scale_vector(amount, (1.0, 0.0) if along is None else along)
                )
            for link, wrench in channel.wrenches:
                if link not in own:
                    demands[link] = demands.get(link, Wrench(None, None)).plus(wrench.times(-amount))
        return Resolved(reactions, resolved.scalars, demands)


def _moment(link):
    return Channel(f"moment on {link}", ((link, Wrench(None, 1.0)),))


def _with_friction(loads, along, acting, own):
    """Loads and pushes of a part, with friction added."""
    loads, along = dict(loads), dict(along)
    for channel, amount in acting:
        for link, wrench in channel.wrenches:
            if link in own:
                loads[link] = loads[link].plus(wrench.times(amount))
        for link, push in channel.pushes:
            along[link] = plus(along.get(link), amount * push)
    return loads, along


# Equations of the friction laws of a part


class FrictionEquations:
    """Friction laws of a part, with the slopes of their reactions by the channels through which friction acts.

    Attributes
    ----------
    margin : number or None
        Margin from jamming: 1 without friction, 0 where friction may jam or have several solutions; None if no
        reaction of a law depends on friction. It is the smallest pivot of I - K, with K the largest feedback from
        friction to friction. All pivots are positive if and only if the spectral radius of K is less than 1. Then
        friction is a contraction for all loads and senses of motion, so there is exactly one solution. For a guide or
        pin alone, 1 - |kappa|, this is also necessary; for several joints it is not, as feedbacks may differ in sign.
    residual : number or None
        Change of the reactions by one more pass over the largest of them; set by `solve`.
    """

    def __init__(self, laws, names, free, columns):
        self._laws = laws
        self._free = [tuple(map(none_if_zero, law.reaction(free))) for law in laws]
        slopes = [[tuple(map(none_if_zero, law.reaction(column))) for column in columns] for law in laws]
        counts = [sum(any(part is not None for part in law[place]) for law in slopes) for place in range(len(names))]
        used = [place for place in sorted(range(len(names)), key=counts.__getitem__) if counts[place]]
        self._slopes = [[law[place] for place in used] for law in slopes]
        places = {names[place]: number for number, place in enumerate(used)}
        self._effects = [
            [(places[channel.name], way) for channel, way in law.effects if channel.name in places] for law in laws
        ]
        self._count = len(used)
        self.margin = self.residual = None
        if used:
            columns = [
                [
                    product(abs(law.factor), law.magnitude(slopes[place]))
                    for law, slopes in zip(laws, self._slopes, strict=True)
                ]
                for place in range(self._count)
            ]
            matrix = list(zip(*(self._totals(column, all_positive=True) for column in columns), strict=True))
            above, _, _ = _triangle(matrix, [None] * self._count)
            self.margin = reduce(smaller, (row[place] for place, row in enumerate(above)))  # the pivots of I - matrix

    def solve(self, passes, angle):
        """Friction of each law after a number of passes, N or N m; NaN where the margin is not positive."""
        reactions: list[Any] = self._free
        amounts, unknowns = self._amounts(reactions), []
        if self.margin is None:
            return amounts
        all_signs = all(law.kind != "length" for law in self._laws)  # signs need one pass less
        for step in range(passes - all_signs):
            unknowns = self._by_directions(reactions) if step else self._totals(amounts)
            reactions = [
                tuple(
                    _weighted(unknowns, slope, part)
                    for part, slope in zip(free, zip(*slopes, strict=True), strict=True)
                )
                for free, slopes in zip(self._free, self._slopes, strict=True)
            ]
        amounts = self._amounts(reactions)
        changes = [minus(total, unknown) for total, unknown in zip(self._totals(amounts), unknowns, strict=True)]
        moved, sizes = [], []
        for law, slopes, parts in zip(self._laws, self._slopes, reactions, strict=True):
            shifts = [_weighted(changes, column) for column in zip(*slopes, strict=True)]
            moved.append(law.magnitude(shifts))
            sizes.append(law.magnitude(parts))
        given = [[part for part in found if part is not None] for found in (moved, sizes)]
        change, largest = (reduce(larger, found, 0.0) for found in given)
        self.residual = change / (largest + MIN_FORCE)
        closed = stop_gradient(0.0 * clamped_sqrt(self.margin + 0.0 * angle, 1.0))
        return [amount + closed for amount in amounts]

    def _amounts(self, reactions):
        """Friction of each law from its reaction."""
        sizes = (size_of(law.kind, parts) for law, parts in zip(self._laws, reactions, strict=True))
        return [number_or_zero(product(law.factor, size)) for law, size in zip(self._laws, sizes, strict=True)]

    def _totals(self, amounts, all_positive=False):
        """Friction by channel from the friction of each law."""
        found: list[Any] = [None] * self._count
        for amount, effects in zip(amounts, self._effects, strict=True):
            for place, way in effects:
                found[place] = (plus if way > 0 or all_positive else minus)(found[place], amount)
        return found

    def _by_directions(self, reactions):
        """Friction by channel, from the linear equations with the directions of these reactions.

        They are solved by elimination without pivoting, because the pivots are near 1.
        """
        directed = [direction_of(law, parts) for law, parts in zip(self._laws, reactions, strict=True)]
        right = self._totals(map(_weighted, directed, self._free))
        columns = [self._totals(map(_weighted, directed, slopes)) for slopes in zip(*self._slopes, strict=True)]
        matrix = list(zip(*columns, strict=True))
        above, right, inverse = _triangle(matrix, right)
        found: list[Any] = [None] * self._count
        for i in reversed(range(self._count)):
            rest = reduce(plus, (product(above[i][k], found[k]) for k in range(i + 1, self._count)), None)
            found[i] = product(minus(right[i], rest), inverse[i])
        return [number_or_zero(one) for one in found]


def _weighted(weights, parts, start=None):
    """A start value plus the sum of parts times weights."""
    return reduce(plus, map(product, weights, parts), start)


def _triangle(matrix, right):
    """I - matrix and a right-hand side after elimination below the pivots, and the inverses of the pivots."""
    count = len(right)
    rows = [[minus(1.0 if i == k else None, matrix[i][k]) for k in range(count)] for i in range(count)]
    right, inverse = list(right), []
    for i in range(count):
        inverse.append(1.0 / rows[i][i])
        for k in range(i + 1, count):
            factor = product(rows[k][i], inverse[i])
            rest = zip(rows[k][i + 1 :], rows[i][i + 1 :], strict=True)
            rows[k][i + 1 :] = [minus(one, product(factor, other)) for one, other in rest]
            right[k] = minus(right[k], product(factor, right[i]))
    return rows, right, inverse
