"""Places where a machine and its frame push each other: pairs of links with the frame, loads, and the motor.

A group declares its pairs, a load by `rests_on_frame` that the frame takes a force or couple of it. A pair is called as
its reaction, a load as in paths of parameters ("spring", "spring2"), the torque that keeps the motion "motor".
"""

from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from .group import FRAME
from .links import Rolling, Sliding, Turning

MOTOR = "motor"
"""Place at which the drive takes the opposite of the balancing torque."""


class Support(NamedTuple):
    """Force (x, y) and couple of the machine on the frame, N and N m, and the point at which the force acts, m.

    A kernel leaves out what is zero as None; `Solution.ground` gives arrays (2, ..., N), (2, ..., N) and (..., N).
    """

    force: Any
    point: Any
    couple: Any = None


class Place(NamedTuple):
    """A place by its `pair` or the number of its load; neither for the motor. `pushes`: whether it takes a force."""

    pair: Any = None
    load: int | None = None
    pushes: bool = True


_of_pairs: WeakKeyDictionary[Any, dict[str, Place]] = WeakKeyDictionary()
"""Places of pairs by mechanism."""


def places(scene) -> dict[str, Place]:
    """Places by name of a scene, or another object with a mechanism."""
    mechanism = scene.mechanism
    if mechanism not in _of_pairs:
        _of_pairs[mechanism] = {name: Place(pair) for name, pair in _pairs_on_frame(mechanism)}
    found = dict(_of_pairs[mechanism])
    for number, item in enumerate(getattr(scene, "loads", ())):
        if hasattr(item, "rests_on_frame") and item.rests_on_frame(mechanism):
            kind = item.PATH or type(item).__name__
            names = (f"{kind}{count if count > 1 else ''}" for count in range(1, len(found) + 2))
            found[next(name for name in names if name not in found)] = Place(None, number, item.UNIT != "N m")
    found[MOTOR] = Place(pushes=False)
    return found


def _pairs_on_frame(mechanism):
    """Pairs of links with the frame by name; those of a group of a user's own need a reaction."""
    for part in mechanism.parts:
        for name, pair in part.pairs.items():
            if isinstance(pair, Rolling):
                yield name, pair
                continue
            against = pair.against
            if isinstance(pair, Turning):
                against = against or mechanism.joints[pair.joint].link
            if against == FRAME and name in part.outputs:
                yield name, pair


def joint_of(pair):
    """Joint at which the frame takes the force of a pair, and about which its couple counts."""
    return (pair.about or pair.joint) if isinstance(pair, Sliding) else pair.joint
