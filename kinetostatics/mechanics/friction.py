"""Forces of a part whose joints rub: reactions and friction found together, to rounding.

All reactions of a part are linear in the moments and forces that friction puts on its links, and friction is the
magnitude of a reaction times a constant. A magnitude is the reaction times its own direction, so with directions known
the equations are linear; they are solved with the directions of the reactions found before, and directions are found
anew. That is Newton's method: each pass doubles the digits; the first takes friction from the reactions without it. Of
a guide alone the direction is a sign, and the second pass exact: N = N0 / (1 + kappa sgn N0).

A magnitude does not change with its direction to first order, so derivatives take directions as given, and need the
last pass alone. The number of passes is fixed, so that all this is arithmetic like all else of a group.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..machine.group import FRAME, Resolved
from ..machine.links import Wrench
from ..machine.pairs import Rolling, Turning
from ..numbers.elementary import sign, sqrt
from ..numbers.nothing import NOTHING
from ..numbers.planar import added, length, minus, plus, product, quotient, stretched, vector
from .friction_laws import Channel, Law, bends, rate_of
from .friction_system import System


class Rubbed(NamedTuple):
    """Friction of a pair: its moment or force, positive where the pair moves positively, and the rate of that motion.

    On the link it acts the other way round. `couple` is that of a roller's pin on the link, with its own rate.
    """

    amount: Any
    rate: Any
    couple: Any = None
    couple_rate: Any = None

    @property
    def work(self):
        """Loss per unit of crank angle, with the sign of the crank speed."""
        return plus(product(self.amount, self.rate), product(self.couple, self.couple_rate))


@dataclass(eq=False)
class Rubbing:
    """Resolves parts with friction, and keeps what rubs.

    Attributes
    ----------
    found : dict of str to Rubbed
    margins, residuals : list
        Of each part: how far it is from jamming (`_margin`), and what the last pass still changed, relative.
    turning, bending : list
        Rates, and forces, at whose zeros friction jumps or has a kink.
    """

    mechanism: Any
    friction: Any
    direction: Any
    found: dict = field(default_factory=dict)
    margins: list = field(default_factory=list)
    residuals: list = field(default_factory=list)
    turning: list = field(default_factory=list)
    bending: list = field(default_factory=list)

    def __post_init__(self):
        self.acting, self.senses = self.friction.acting, self.friction.senses

    def __call__(self, part, placement, loads, along):
        rates: dict[str, Any] = {}
        laws: list[Law] = []
        for name in part.pairs:
            if name in self.acting:
                laws += self._laws(part, name, placement, rates)
        free = part.resolve(placement, loads, along)
        if not laws:
            return free
        own = part.links
        channels = {channel.name: channel for law in laws for channel, _ in law.effects}
        inner = [channel for channel in channels.values() if _acts_on(channel, own)]
        unloaded = dict.fromkeys(own, Wrench((NOTHING, NOTHING), NOTHING))
        columns = [part.resolve(placement, *_with(unloaded, {}, [(channel, 1.0)], own)) for channel in inner]
        system = System(laws, [channel.name for channel in inner], free, columns)
        amounts = self._amounts(system, laws, placement)
        self._keep(system, laws, amounts, rates)
        acting = [
            (channel, amount if way > 0 else -amount)
            for law, amount in zip(laws, amounts, strict=True)
            for channel, way in law.effects
        ]
        resolved = part.resolve(placement, *_with(loads, along, acting, own))
        self.turning += rates.values()
        for law in laws:
            self.bending += bends(law.kind, law.watched(resolved))
        return self._completed(resolved, part, placement, acting, own)

    def _amounts(self, system, laws, placement):
        """Friction of each law."""
        return system.solved(self.friction.passes, placement.angle)

    def _laws(self, part, name, placement, rates):
        """Laws of a pair; what it moves at goes into `rates`."""
        pair, friction = self.mechanism.pairs[name], self.acting[name]
        if isinstance(pair, Rolling):
            yield from self._of_roller(name, pair, friction, placement, rates)
            return
        rate = rate_of(part, name, pair, placement)
        if rate is None:
            return
        rates[name] = rate
        way = self._way(name, rate)
        if isinstance(pair, Turning):
            effects = [(_moment(pair.link), -1)]
            if pair.against != FRAME:
                effects.append((_moment(pair.against), 1))
            factor = friction.mu * friction.radius * way
            yield Law(name, factor, lambda found: vector(found.reactions[name]), "length", tuple(effects))
        else:
            slide, half = part.sliding(name, placement), friction.half_length

            def watched(found):
                force = found.scalars[pair.force]
                return (force,) if half is None else (force, quotient(found.scalars[pair.couple], half))

            kind = "size" if half is None else "larger"
            yield Law(name, friction.mu * way, watched, kind, ((_force(name, pair, slide), -1),))

    def _way(self, name, rate=None):
        """Sign of the motion of a pair; of a roller that of the crank."""
        if name in self.senses:
            return self.senses[name]
        return self.direction if rate is None else self.direction * sign(rate)

    def _of_roller(self, name, pair, friction, placement, rates):
        """A roller rubs on its pin with the whole of its load: cam force and the force along the profile by which the
        cam turns it. The couple stays with the link that carries the pin.
        """
        first = vector(placement.joints[pair.joint].first)
        speed = length(first)
        lever = friction.mu * friction.pin_radius / friction.roller_radius
        slope = lever / sqrt(1.0 - lever * lever) * self._way(name)
        rates[name] = speed
        tangent = (first[0] / speed, first[1] / speed)
        force = Channel(f"force of {name}", ((pair.link, Wrench(tangent, None)),))

        def watched(found):
            return (found.scalars[pair.force],)

        yield Law(name, slope, watched, "size", ((force, -1),))
        yield Law(name, slope * friction.roller_radius, watched, "itself", ((_moment(pair.link), -1),))

    def _keep(self, system, laws, amounts, rates):
        for law, amount in zip(laws, amounts, strict=True):
            if law.kind == "itself":  # the roller turns the other way round on the other side of the cam
                self.found[law.name] = self.found[law.name]._replace(couple=amount, couple_rate=1.0)
            else:
                self.found[law.name] = Rubbed(amount, rates[law.name])
        if system.margin is not None:
            self.margins.append(system.margin)
            self.residuals.append(system.residual)

    def _completed(self, resolved, part, placement, acting, own):
        """What a part finds, with friction along guides, and with what it demands of other links."""
        reactions, demands = dict(resolved.reactions), dict(resolved.demands)
        for channel, amount in acting:
            name = channel.name
            if name in reactions and name in part.pairs:
                along = part.sliding(name, placement).direction
                reactions[name] = added(reactions[name], stretched(amount, (1.0, 0.0) if along is None else along))
            for link, wrench in channel.wrenches:
                if link not in own:
                    old = demands.get(link, Wrench(None, None))
                    given = stretched(-amount, wrench.force), product(-amount, wrench.moment)
                    demands[link] = Wrench(added(old.force, given[0]), plus(old.moment, given[1]))
        return Resolved(reactions, resolved.scalars, demands)


def _moment(link):
    return Channel(f"moment on {link}", ((link, Wrench(None, 1.0)),))


def _force(name, pair, slide):
    """Force along a straight pair; along a guide it stays in the guide's axes."""
    if pair.against == FRAME:
        return Channel(name, (), ((pair.link, 1.0),))
    back = Wrench(stretched(-1.0, slide.direction), minus(None, slide.moment))
    return Channel(name, ((pair.link, Wrench(slide.direction, None)), (pair.against, back)))


def _acts_on(channel, own):
    return any(link in own for link, _ in (*channel.wrenches, *channel.pushes))


def _with(loads, along, acting, own):
    """Loads and pushes of a part, and what friction adds to them."""
    loads, along = dict(loads), dict(along)
    for channel, amount in acting:
        for link, wrench in channel.wrenches:
            if link in own:
                old = loads[link]
                force, moment = stretched(amount, wrench.force), product(amount, wrench.moment)
                loads[link] = Wrench(added(old.force, force), plus(old.moment, moment))
        for link, push in channel.pushes:
            along[link] = plus(along.get(link), amount * push)
    return loads, along
