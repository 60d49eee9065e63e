"""Places where a machine and its frame push each other: pairs of links with the frame, loads, and the motor.

A group declares its pairs, a load by `rests_on_frame` that the frame takes a force or couple of it. A pair has the name
of its reaction, a load its name in parameter paths, where all loads of its kind count ("spring", "spring2"). The torque
that keeps the motion is "motor".
"""

from collections import Counter
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from ..numbers.formatting import with_units
from ..numbers.planar import minus, subtract_vectors
from .group import FRAME
from .links import CamDriven, Rolling

MOTOR = "motor"
"""Place at which the drive takes the opposite of the balancing torque."""


@with_units(force="N", point="m", couple="N m")
class Support(NamedTuple):
    """Force (x, y) and couple of the machine on the frame, N and N m, and the point at which the force acts, m.

    Kernels give None for zero; `Solution.ground` gives arrays (2, ..., N), (2, ..., N) and (..., N). A pair also has
    the force and couple on its link.
    """

    force: Any
    point: Any
    couple: Any = None

    def opposite(self):
        """The opposite force and couple at the same point."""
        return Support(subtract_vectors(None, self.force), self.point, minus(None, self.couple))


class Joining(NamedTuple):
    """A pair of a `part`: its force acts on `link`, the opposite force on `against`; a cam is a `CamDriven`."""

    part: Any
    pair: Any
    link: str
    against: str


class Place(NamedTuple):
    """A place by its `pair` or the number of its load; neither for the motor. `pushes`: whether it takes a force."""

    pair: Joining | None = None
    load: int | None = None
    pushes: bool = True


_joinings: WeakKeyDictionary[Any, dict[str, Joining]] = WeakKeyDictionary()
"""Pairs by mechanism."""


def pairs_of(mechanism) -> dict[str, Joining]:
    """Pairs of all links and cams of a mechanism by the name of their force."""
    if mechanism not in _joinings:
        found: dict[str, Joining] = {}
        for part in mechanism.parts:
            cams = {led.force.replace("_force", ""): led for led in part.led}
            for name, pair in part.pairs.items():
                if isinstance(pair, Rolling):
                    cams.setdefault(name, CamDriven(pair.link, pair.joint, pair.against, pair.force))
                else:
                    against = pair.against or mechanism.joints[pair.joint].link
                    found[name] = Joining(part, pair, pair.link, against)
            found |= {name: Joining(part, led, led.link, led.body) for name, led in cams.items()}
        _joinings[mechanism] = found
    return _joinings[mechanism]


def places(scene) -> dict[str, Place]:
    """Places by name of a scene, or another object with a mechanism."""
    mechanism = scene.mechanism
    found = {
        name: Place(pair)
        for name, pair in pairs_of(mechanism).items()
        if pair.against == FRAME
        if isinstance(pair.pair, CamDriven) or name in pair.part.outputs  # a user's own group needs a reaction
    }
    counts: Counter[str] = Counter()
    for number, item in enumerate(getattr(scene, "loads", ())):
        if not hasattr(item, "rests_on_frame"):
            continue
        kind = item.PATH or type(item).__name__
        counts[kind] += 1
        while (name := f"{kind}{counts[kind]}" if counts[kind] > 1 else kind) in found:
            counts[kind] += 1
        if item.rests_on_frame(mechanism):
            found[name] = Place(None, number, item.UNIT != "N m")
    found[MOTOR] = Place(pushes=False)
    return found
