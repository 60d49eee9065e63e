"""Where quantities have no value since parts of the mechanism cannot be assembled.

Motion of a group has none where the group, or one that it hangs on, cannot be assembled; its forces have none either
where a group cannot that hangs on it, for they carry that group's. What is of the crank, or of the mechanism as a
whole, has none where any group cannot. All else does not hang on the gap, and stays.
"""

from collections import defaultdict
from functools import reduce

from ..machine.group import RATES, TRAVELS
from ..numbers.arithmetic import held, namespace
from ..numbers.planar import plus


def groups_behind(mechanism):
    """Groups that must be assembled for a quantity to have a value, by its name: all, unless it is of a group."""
    groups, inner = mechanism.groups, _inner(mechanism.groups)
    found: defaultdict[str, tuple] = defaultdict(lambda: groups)
    for place, group in enumerate(groups):
        outer = set().union(*(own for own in inner if place in own))
        rubbing = [f"{name}{ending}" for name in group.pairs for ending in ("_friction", "_friction_loss")]
        rates = [f"{link}{ending}" for link in group.links for ending in RATES]
        travels = [f"{slider}{ending}" for slider in group.guides for ending in TRAVELS]
        for behind, names in (
            (outer, (*group.outputs, *group.contacts, *rubbing)),
            (inner[place], (*group.motions, *rates, *travels)),
        ):
            found.update(dict.fromkeys(names, tuple(groups[one] for one in behind)))
    return found


def _inner(groups):
    """Places of each group and of all that it hangs on."""
    found: list[set[int]] = []
    joints: dict[str, set[int]] = {}
    links: dict[str, set[int]] = {}
    for place, group in enumerate(groups):
        under = [joints.get(name, set()) for name in group.hangs_on]
        under += [links.get(point.link, set()) for point in group.joints.values()]
        own = {place}.union(*under)
        joints |= dict.fromkeys(group.joints, own)
        links |= dict.fromkeys(group.links, own)
        found.append(own)
    return found


def places(placement, groups):
    """Coordinates of the joints and directions of the links of groups, all NaN where one cannot be assembled."""
    joints = [placement.joints[name].position for group in groups for name in group.joints]
    directions = [placement.links[name].direction for group in groups for name in group.links]
    return [part for pair in (*joints, *directions) for part in pair]


def gap(placement, groups):
    """Zero where all of some groups are assembled, NaN elsewhere; None if none of them moves."""
    total = reduce(plus, (part for part in places(placement, groups) if hasattr(part, "shape")), None)
    if total is None or total.dtype == object:
        return None if total is None else 0.0 * held(total)
    xp = namespace(total)
    return xp.where(xp.isfinite(total), xp.zeros_like(total), xp.full_like(total, xp.nan))
