"""Tables of a case file in the order of the page, and the types that stand in them."""

import re
import types
import typing
from functools import cache

from kinetostatics.casefile.schema import designs, drives, parts, tables, variants


def sections():
    """Every table of a case file: heading, model, and the keys left out because they stand in another section."""
    named = list(named_sections())
    yield from named
    for model in sorted(reached(model for _, model, _ in named) - {model for _, model, _ in named}, key=repr):
        yield re.sub(r"(?<!^)([A-Z])", r" \1", model.__name__.removesuffix("Table")).capitalize(), model, ()


def named_sections():
    """The sections in the order of the page; tables that it lacks follow."""
    yield "Head of the file", variants.CaseTable, ()
    yield "Every mechanism", variants.MechanismVariant, ()
    common = set(variants.MechanismVariant.model_fields)
    for word, model in variants.VARIANTS.items():
        yield f"Mechanism: {word}", model, common
    yield "Link", tables.LinkTable, ()
    yield "Gravity", tables.GravityTable, ()
    yield "Springs along the guide", variants.SpringTable, ()
    yield "Force along the guide", variants.ProcessForceTable, ()
    for word, model in tables.CAMS.items():
        yield f"Cam: {word}", model, ()
    for word, model in of_kinds(parts.GROUPS).items():
        yield f"Group: {word}", model, ()
    for word, model in of_kinds(parts.LOADS).items():
        yield f"Load: {word}", model, ()
    yield "File of values", tables.ValuesTable, ()
    yield "Friction", variants.FrictionTable, ()
    yield "Balancing", tables.BalancingTable, ()
    yield "Counterweight", tables.CounterweightTable, ()
    yield "Drive", drives.DriveTable, ()
    for word, model in chosen("motor").items():
        yield f"Motor: {word}", model, ()
    for word, model in designs.KINDS.items():
        yield f"Design: {word}", model, ()
    yield "Robust design", designs.RobustTable, ()
    yield "Published figures", variants.PublishedTable, ()


def reached(models):
    """Every table that these contain, directly or in another table."""
    found, left = set(), list(models)
    while left:
        model = left.pop()
        found.add(model)
        kinds = [kind for field in model.model_fields.values() for kind in tables_within(field.annotation)]
        left += [kind for kind in kinds if kind not in found]
    return found - {tables.Table}


def tables_within(annotation):
    """Tables within a type."""
    for kind, _ in flattened(annotation):
        if isinstance(kind, type) and issubclass(kind, tables.Table):
            yield kind
        else:
            for part in typing.get_args(kind):
                yield from tables_within(part)


def of_kinds(kinds):
    """Tables of groups or loads by their word."""
    made = {kind: model for model, kind in parts.MADE_OF.items()}
    return {word: made[kind] for word, kind in kinds.items()}


def chosen(family):
    """Tables of several kinds, by their word."""
    tagged = ((tag.partition(":"), model) for tag, model in tables.TAGS.items())
    return {word: model for (name, _, word), model in tagged if name == family}


def anchor(title):
    """Where links to a heading lead."""
    return "key-" + title.lower().replace(": ", "-").replace(" ", "-")


@cache
def titles():
    """Heading of each table."""
    return {model: title for title, model, _ in sections()}


def flattened(annotation, extra=()):
    """All types within an annotation, each with what is said of it."""
    origin = typing.get_origin(annotation)
    if origin is typing.Annotated:
        inner, *more = typing.get_args(annotation)
        yield from flattened(inner, (*extra, *more))
    elif origin in (typing.Union, types.UnionType):
        for part in typing.get_args(annotation):
            yield from flattened(part, extra)
    else:
        yield annotation, extra
