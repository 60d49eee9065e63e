"""A state of the explore page kept as a case file, Python text or a report.

Files go into the folder of the session alone, by names without a path. An existing file is replaced only on request,
whole or not at all; a file that the case itself was read from never is.
"""

import re
from functools import partial
from pathlib import Path

from ...casefile.case import shipped_cases
from ...design.case_text import write_case
from ...errors import ParameterError
from ...numbers import checks, files
from ...numbers.formatting import normalise
from ...numbers.output_units import shown_units
from ..report.report import report as write_report

NAME = re.compile(r"\w[\w -]{0,79}")
"""Name of a file without its ending: no separators of folders, and no dots."""
MAX_NAME = 200
"""Longest name of a file without its ending, bytes; file systems take 255 with it."""


def first_name(session):
    """Name of files that the page offers first."""
    name = f"{session.case.path.stem}_changed" if session.case else session.title
    return re.sub(r"^[_ -]+|[^\w -]", "", normalise(name))[:80].strip() or "machine"


def path_of(session, request, ending):
    """Path of a file of this name in the session's folder; `ParameterError` if it must not be written."""
    if session.folder is None:
        raise ParameterError("explore: no folder to write into was given; start with a folder")
    name = request.get("name")
    plain = normalise(name).strip().removesuffix(ending) if isinstance(name, str) else ""
    if not NAME.fullmatch(plain) or len(plain.encode()) > MAX_NAME:
        raise ParameterError(
            f"explore: the name of a file has letters, digits, blanks, - and _, 80 at most, got {checks.shown(name)}"
        )
    path = Path(session.folder) / f"{plain}{ending}"
    inputs = session.case.files if session.case else ()
    link = f"{path} is a link to another place; give another name" if path.is_symlink() else None
    checks.require("explore", link or files.write_problem(path, inputs=inputs))
    return path


def scenes_of(session, state):
    """Scene of the reference of a state by the name of its variant, and last the scene of the state."""
    name, scene = state.get("variant", session.first), session.scene(state)
    reference = session.case.reference_of(name) if session.case else name
    if "chain" in state or (reference == name and not state.get("values")):
        return {name: scene}
    return {reference: session.bases[reference], name if reference != name else f"{name}-changed": scene}


def save(session, request):
    """Write a case file of a state and its reference; `exists` in place of `saved` where a file has to be replaced."""
    state, path = request["state"], path_of(session, request, ".toml")
    if path.exists() and request.get("overwrite") is not True:
        return {"exists": path.name}
    scenes = scenes_of(session, state)
    sizing = {name: part.raw for name, part in session.case.sizing.items()} if session.case else {}
    comment = f"Saved by: kinetostatics explore {session.case.path.name}" if session.case else ""
    drives, notes = {}, []
    if session.case:
        sources = [*list(scenes)[:-1], state.get("variant", session.first)]
        variants = [session.case.variants[name] for name in sources]
        drives = {name: item.raw_drive for name, item in zip(scenes, variants, strict=True)}
        notes = [f"The tolerances of {session.case.path.name} are not in it."] if session.case.tolerances else []
    write_case(path, session.title, scenes, session.source, comment=comment, drives=drives, sizing=sizing)
    session.saved = state, str(path.absolute()), list(scenes)[-1]
    return {"saved": path.name, "path": str(path.absolute()), "notes": notes}


def python(session, request):
    """Python text that builds the scene of a state: from its case, or else from the file in which it was saved."""
    state = request["state"]
    session.scene(state)
    variant, values = state.get("variant", session.first), state.get("values", {})
    if session.case and "chain" not in state:
        path = session.case.path
        case = path.stem if shipped_cases().get(path.stem) == path else str(path.absolute())
    elif session.saved is not None and session.saved[0] == state:
        (_, case, variant), values = session.saved, {}
    else:
        raise ParameterError("explore: save the case first; the Python text reads its file")
    scene = f"scene = case.variants[{variant!r}].scene"
    if values:
        numbers = [f"        {path!r}: {float(value)!r}," for path, value in values.items()]
        scene = "\n".join([f"{scene}.varied(", "    {", *numbers, "    }", ")"])
    head = ["import kinetostatics as ks", "", f"case = ks.load_case({case!r})"]
    return {"text": "\n".join([*head, scene, "solution = scene.solve(360)", "print(solution.balancing_torque)", ""])}


def report(session, request):
    """Write a report of a state and its reference in a process of its own; None until it is written."""
    path = path_of(session, request, ".html")
    if path.exists() and request.get("overwrite") is not True:
        yield {"exists": path.name}
        return
    scenes = scenes_of(session, request["state"])
    if request.get("reference") is not None:
        name, scene = list(scenes.items())[-1]
        scenes = {"reference" if name == "before" else "before": session.scene(request["reference"]), name: scene}
    from ...sweeps.workers import Workers

    with Workers(count=1) as workers:
        write = partial(write_report, title=session.title, units=shown_units().chosen or None)
        future = workers.submit(write, scenes, path)
        while not future.done():
            yield None
        future.result()
    yield {"report": str(path.absolute()), "saved": path.name}
