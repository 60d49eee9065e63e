"""Names in a chain of parts: each is told before it is asked for, and no two things have one."""

from dataclasses import fields

from ..numbers import checks
from ..numbers.parameter_tree import with_fields
from .group import FRAME, RATES, RESERVED, TRAVELS

REMEDY = "give the second group another pin, pivot_name or label"


def _spelled(part, table):
    """Names in a table of a part; of the library's own parts also those that coincide, which a table has once."""
    if not part.trusted:
        return list(getattr(part, table))
    texts = {field.name: getattr(part, field.name) for field in fields(part)}
    marks = {name: f"\0{name}\0" for name, text in texts.items() if type(text) is str}
    found = []
    for spelled in getattr(with_fields(part, **marks), table):
        for name, mark in marks.items():
            spelled = spelled.replace(mark, texts[name])
        found.append(spelled)
    return found


def name_problems(parts):
    """What is wrong with the names in a chain of parts: unknown ones, and ones that two things would have."""
    points: dict[str, str] = {}
    joints: set[str] = set()
    links = [FRAME]
    forces = dict.fromkeys(("closure", *RESERVED), "result of every mechanism")
    problems = []
    repeated = []

    def add(table, what, kind, names):
        for name in names:
            if name in table:
                repeated.append(f"{kind} adds {what} {name!r} a second time, after the {table[name]}")
            table[name] = f"{what} of {kind}"

    for part in parts:
        kind = type(part).__name__
        for name in (name for name in part.hangs_on if name not in joints):
            if name in links:
                problems.append(
                    f"{kind} hangs on {name!r}, which is a link; put a Pin on that link, and name its joint"
                )
                continue
            remedy = "; give the crank a length, or put a CamRoller before it" if name == "A" else ""
            problems.append(f"{kind} hangs on joint {name!r}, which no part before it places{remedy}")
        links += part.links
        for name, point in part.joints.items():
            if point.link not in links:
                found = checks.choice(f"{kind}: link that carries joint {name!r}", point.link, links)
                problems.append(f"{found}; the part that adds a link stands before what is fixed to it")
        joints.update(part.joints)
        own = [link for link in part.links if link not in points]
        add(points, "joint", kind, _spelled(part, "joints"))
        add(points, "link", kind, part.links)
        outputs = _spelled(part, "outputs")
        for vector, what in ((True, "reaction"), (False, "quantity")):
            add(forces, what, kind, [name for name in outputs if part.outputs[name].vector == vector])
        endings = [*RATES, *(ending for link in part.guides for ending in TRAVELS)]
        add(forces, "quantity", kind, [f"{link}{ending}" for link in own for ending in endings])
        add(forces, "quantity", kind, [*part.motions, *part.contacts])
    return [*problems, *repeated, *([REMEDY] if repeated else [])]
