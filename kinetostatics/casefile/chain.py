"""Chains and loads: groups and loads of any kind, made of their tables."""

from ..machine.crank import Crank
from ..machine.guide import Guide
from ..machine.loads import Spring
from ..machine.mechanism import Mechanism
from ..numbers.parameter_tree import with_fields
from . import schema
from .pieces import PartsError, all_of, cam_of, guide_of, link_of, roller_of


def chain(table, tabulated):
    """Mechanism of a variant that lists its groups."""
    crank = Crank(table.crank_length, link_of(table.crank, table.crank_length))
    angle = _guide_angle(table.groups)
    groups = all_of(
        (("groups", number), lambda part=part, read=tabulated.get(("groups", number, "cam")): _group(part, read, angle))
        for number, part in enumerate(table.groups)
    )
    return Mechanism(table.name, crank, tuple(groups.values()))


def _guide_angle(groups):
    """Angle of the first guide whose slider hangs on A: what a cam with a law of its own is cut for."""
    guides = (guide_of(part) for part in groups if getattr(part, "on", "") == "A" and hasattr(part, "guide_angle"))
    return next(guides, Guide()).guide_angle


def _group(table, cam, guide_angle):
    """Group of its table; centres at mid-length follow from the bars it has without them."""
    kind = schema.MADE_OF[type(table)]
    values = {name: getattr(table, name) for name in type(table).model_fields if name in kind.RULES.rules}
    links = {name: part for name, part in values.items() if isinstance(part, schema.LinkTable)}
    if "guide" in kind.RULES.rules:
        values["guide"] = guide_of(table)
    if "cam" in values:
        values["cam"] = cam_of(table.cam, cam, guide_angle)
    if "roller" in values:
        values["roller"] = roller_of(table.roller)
    middles = {name: part.model_copy(update={"centre": (0.0, 0.0)}) for name, part in links.items() if _at_middle(part)}
    group = kind(**values | {name: link_of(middles.get(name, part)) for name, part in links.items()})
    lengths = {group.own_names[bar.link]: bar.length for bar in group.bars}
    return with_fields(group, **{name: link_of(links[name], lengths.get(name)) for name in middles})


def _at_middle(table):
    return isinstance(table.centre, str)


def loads(table, tabulated, mechanism):
    """Loads of a variant that it lists, looked at one by one."""
    found = all_of(
        (
            ("loads", number),
            lambda part=part, number=number: _load(part, number, tabulated, mechanism, table.crank_speed),
        )
        for number, part in enumerate(table.loads)
    )
    wrong = [(keys, text) for keys, load in found.items() for text in load.problems(mechanism) if text]
    if wrong:
        raise PartsError(wrong)
    return tuple(found.values())


def _load(table, number, tabulated, mechanism, crank_speed):
    kind = schema.MADE_OF[type(table)]
    names = [name for name in type(table).model_fields if name != "kind"]
    values = {name: tabulated.get(("loads", number, name), getattr(table, name)) for name in names}
    if kind is Spring and isinstance(values["stiffness"], str):
        slider = mechanism.links.get(table.on)
        if slider is None:
            return kind(**values | {"stiffness": 0.0})
        values["stiffness"] = Spring.balancing(slider.mass, crank_speed, table.free_position).stiffness
    return kind(**values)
