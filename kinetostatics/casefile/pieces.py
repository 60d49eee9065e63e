"""Pieces of mechanisms, made of their tables: links, guides, cams; and many of them at once, with all that is wrong."""

from dataclasses import MISSING, fields

from ..errors import CaseError, KinetostaticsError
from ..machine.cams import cams
from ..machine.cams.roller import Roller
from ..machine.friction import kind_for
from ..machine.guide import Guide
from ..machine.links import Link
from ..numbers.checks import choice
from . import schema


class PartsError(KinetostaticsError, ValueError):
    """What is wrong with parts of a variant, pairs of the keys that lead there and a sentence."""

    def __init__(self, problems):
        self.problems = tuple(problems)
        super().__init__("; ".join(text for _, text in self.problems))


def all_of(makers):
    """What functions return, by their keys; all problems that they raise in one error."""
    found, problems = {}, []
    for keys, make in makers:
        try:
            found[keys] = make()
        except CaseError as error:
            problems += [(keys, f"{error.path}: {problem}") for problem in error.problems]
        except KinetostaticsError as error:
            problems.append((keys, str(error)))
    if problems:
        raise PartsError(problems)
    return found


def link_of(table, length=None):
    """Link of its table; the length of one between two joints tells where its middle is."""
    centre = table.centre
    if isinstance(centre, str):
        if length is None:
            raise KinetostaticsError(
                'centre "mid-length" is for links between two joints, not for slider, block or slotted crank; give a '
                "distance there"
            )
        centre = (length / 2, 0.0)
    return Link(table.mass, centre, table.inertia)


def guide_of(table):
    """Guide of a table that has its keys."""
    if table.guide_through is None:
        angle, offset = (0.0 if value is None else value for value in (table.guide_angle, table.guide_offset))
        return Guide.at(angle, offset)
    if table.guide_angle is not None or table.guide_offset is not None:
        raise KinetostaticsError("give either guide_through or guide_angle and guide_offset")
    return Guide.through(*table.guide_through)


def cam_of(table, read, guide_angle):
    """Cam of its table, or as `read` from its file."""
    if isinstance(table, schema.SampledTable):
        return read
    if isinstance(table, schema.CosineLawTable):
        return cams.CosineLaw(table.amplitude, table.mean, guide_angle)
    if isinstance(table, schema.HarmonicTable):
        return cams.Harmonic(table.cosine, table.sine, guide_angle)
    return cams.Circle(table.radius, table.centre)


def roller_of(table):
    """Roller of its table, or None."""
    return None if table is None else Roller(**dict(table))


def friction_of(tables, mechanism):
    """Friction by joint of its tables."""
    found = all_of((("friction", joint), lambda joint=joint: _rub(tables[joint], joint, mechanism)) for joint in tables)
    return {joint: friction for (_, joint), friction in found.items()}


def _rub(table, joint, mechanism):
    problem = choice("joint", joint, tuple(mechanism.pairs))
    if problem:
        raise KinetostaticsError(problem)
    kind = kind_for(mechanism.pairs[joint])
    given = {name: value for name in type(table).model_fields if (value := getattr(table, name)) is not None}
    allowed = [field.name for field in fields(kind)]
    lacking = [field.name for field in fields(kind) if field.default is MISSING and field.name not in given]
    strange = [name for name in given if name not in allowed]
    if lacking or strange:
        words = [f"lacks {', '.join(lacking)}"] * bool(lacking) + [f"has {', '.join(strange)}"] * bool(strange)
        raise KinetostaticsError(f"{' and '.join(words)}, but friction at {joint!r} takes {', '.join(allowed)}")
    return kind(**given)
