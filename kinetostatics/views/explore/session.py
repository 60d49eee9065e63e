"""Session: what a page or notebook asks of a case or scene, answered without a browser.

A state is ``{"variant": name, "values": {path: number in SI}}``: numbers that differ from the scene of the variant, or
of its `chain`, the table of a chain that is built on the page (`groups`). A request is a dict with `id` and `kind`; its
answer carries the same `id` and the state to which its numbers belong.
"""

import json
import sys
import warnings
from functools import lru_cache
from types import GeneratorType
from typing import Any

import numpy as np

from ...casefile.case import Case, load_case
from ...cycle.rounding import curve_values
from ...errors import AssemblyError, KinetostaticsError, ParameterError
from ...mechanics.quantities import of_scene
from ...numbers import checks
from ...numbers.formatting import pretty_unit
from ...solution.scene import Scene
from ..canvas import drawn_limit, ordinary_size, unit_for
from ..movement import drawing_of, one_pose, turning_sense
from ..report.html import remarks
from ..report.tables import KINDS
from . import answers, fields, groups, keeping, searching
from .handles import Points

MAX_SCENES = 32
"""Scenes kept of the states asked for last."""
MAX_COUNT = 3600
"""Most crank angles of a request."""
MAX_SHOWN = 100
"""Most quantities of a request."""
MAX_ADDRESS = 100_000
"""Longest state in the address of a page, characters."""
STATE_KEYS = ("variant", "values", "chain")


class Session:
    """Answers to the requests of one page on a case, on a scene, or on a chain that is built on the page.

    A dict is the table of a chain (`groups.template`), from which the page starts, `variant` the one shown first.
    `folder` is the only one into which files are written; None: none are.
    """

    def __init__(self, what, variant=None, folder=None):
        self.chain = what if isinstance(what, dict) else None
        if self.chain is not None:
            what = groups.scene_of(self.chain)
        if isinstance(what, Scene):
            name = what.mechanism.name
            self.case, self.title, self.source, self.bases = None, name, "", {name: what}
        else:
            case = what if isinstance(what, Case) else load_case(what)
            self.case, self.title, self.source = case, case.title, case.source
            self.bases = {name: item.scene for name, item in case.variants.items()}
        if variant is not None:
            checks.require("explore", checks.choice("variant", variant, tuple(self.bases)))
        self.first = variant if variant is not None else next(iter(self.bases))
        self.folder = folder
        self.search: Any = None
        self.saved: tuple[dict, str, str] | None = None
        """State saved last, the path of its file, and the name of its variant there."""
        self._reference: tuple[Any, Any] = None, None
        self._scene = lru_cache(MAX_SCENES)(self._scene_of_text)
        self.looked: tuple[Any, Any] = None, None
        """Scene of the last look, and the points of its solution."""

    def answer(self, request):
        """The answer to a request, a dict, or a generator of several; a sentence `problem` on what a user can mend."""
        request = {"state": None} | request
        try:
            checks.require("explore", checks.choice("kind of request", request.get("kind"), tuple(ANSWERS)))
            require_fields(request)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                found = ANSWERS[request["kind"]](self, request)
            if isinstance(found, GeneratorType):
                return self._parts(request, found)
            return self._marked(request, {"notes": remarks(caught)} | found)
        except Exception as error:
            return self._marked(request, {"problem": problem_text(error)})

    def _parts(self, request, parts):
        """Answers in parts, all but the last with `more`; None where the next part is not ready."""
        try:
            for part in _unwarned(parts):
                yield part and self._marked(request, {"more": True} | part)
            yield self._marked(request, {"more": False})
        except Exception as error:
            yield self._marked(request, {"problem": problem_text(error)})
        finally:
            parts.close()

    def _marked(self, request, found):
        return {"id": request.get("id"), "kind": request.get("kind"), "state": request.get("state")} | found

    def base(self, state):
        """Scene of a state without its changed numbers."""
        require_state("state", state)
        name = state.get("variant", self.first)
        checks.require("explore", checks.choice("variant", name, tuple(self.bases)))
        return groups.scene_of(state["chain"]) if "chain" in state else self.bases[name]

    def scene(self, state):
        """Scene of a state."""
        return self._scene(json.dumps(state, sort_keys=True))

    def _scene_of_text(self, text):
        state = json.loads(text)
        return self.base(state).varied(state.get("values", {}))

    def points(self, state, count):
        """Points of a state at even crank angles, gaps allowed: those of the last look, if it is of that state."""
        scene, (looked, points) = self.scene(state), self.looked
        same = looked is scene and points.solution.crank_angle.size == count
        return points if same else Points(scene.solve(count, on_gap="nan"), scene.places)

    def reference(self, state):
        """The `Reference` of a state, kept until another one is asked for."""
        scene = self.scene(state)
        if self._reference[0] is not scene:
            self._reference = scene, answers.Reference(scene.solve(answers.COUNT))
        return self._reference[1]


def _unwarned(parts):
    """Parts without warnings: `look` has them, or the parts themselves."""
    end = object()
    while True:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            part = next(parts, end)
        if part is end:
            return
        yield part


def require_state(key, state):
    """Raise `ParameterError` unless this is a state."""
    checks.require(
        "explore", None if isinstance(state, dict) else f"{key} must be an object, got {checks.shown(state)}"
    )
    wrong = [checks.choice(f"key of {key}", name, STATE_KEYS) for name in state]
    variant, values = state.get("variant", ""), state.get("values", {})
    wrong += [] if isinstance(variant, str) else [f"variant must be a text, got {checks.shown(variant)}"]
    if isinstance(values, dict):
        numbers = {path: value for path, value in values.items() if is_number(value)}
        wrong += [f"{path} must be a number, got {checks.shown(values[path])}" for path in values.keys() - numbers]
    else:
        wrong += [f"values must be an object, got {checks.shown(values)}"]
    checks.require("explore", *wrong)


def is_number(value):
    """Whether this is a finite number of JSON; Python reads longer integers than floats can hold."""
    return isinstance(value, float | int) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def problem_text(error):
    """Sentence on an error for the page; one that is not the user's is named as a fault of the library."""
    if isinstance(error, AssemblyError):
        return f"{error.condition}; change the lengths"
    if isinstance(error, KinetostaticsError):
        return str(error)
    return f"this is a fault of the library, please report it: {type(error).__name__}: {error}"


def open_page(session, request):
    """What a page needs at its start: the state and the names of the quantities in its address, if they are valid."""
    references = session.case.reference_of if session.case else lambda name: name
    variants = [{"name": name, "reference": references(name)} for name in session.bases]
    found = {"title": session.title, "source": session.source, "variants": variants, "show": None}
    found["file"] = keeping.first_name(session)
    chain = {} if session.chain is None else {"chain": session.chain}
    found["start"] = {"variant": session.first, "values": {}, **chain}
    address = request.get("address")
    try:
        return found | kept_in_address(session, address if isinstance(address, dict) else {})
    except KinetostaticsError as error:
        return found | {"notes": [f"the address has no state of this case, so the first one is shown: {error}"]}


def kept_in_address(session, address):
    """State and names of quantities in the texts of an address, those that it has."""
    found: dict[str, Any] = {}
    for key, name in (("state", "start"), ("show", "show")):
        text = address.get(key)
        if text is None:
            continue
        try:
            short = isinstance(text, str) and len(text) <= MAX_ADDRESS
            found[name] = json.loads(text) if short else None
        except (ValueError, RecursionError):
            found[name] = None
        if found[name] is None:
            raise ParameterError(f"{key} is no JSON of at most {MAX_ADDRESS} characters")
    if "start" in found:
        session.scene(found["start"])
        found["start"] = {"variant": session.first, "values": {}} | found["start"]
    if "show" in found:
        require_names(found["show"])
    return found


def require_names(names):
    """Raise `ParameterError` unless these are names of quantities to show."""
    if not isinstance(names, list) or len(names) > MAX_SHOWN or not all(isinstance(name, str) for name in names):
        raise ParameterError(f"explore: show must be a list of at most {MAX_SHOWN} names, got {checks.shown(names)}")


def require_fields(request):
    """Raise `ParameterError` unless the fields that several kinds of requests have are of their types."""
    for key in ("state", "reference"):
        if request.get(key) is not None:
            require_state(key, request[key])
    require_names(request.get("show", []))
    count_of(request)
    kinds: dict[str, tuple[Any, str]] = {"limits": (list, "a list"), "spreads": (dict | None, "an object")}
    kinds |= dict.fromkeys(("vary", "action"), (dict, "an object"))
    kinds |= dict.fromkeys(("goal", "output"), (str, "a text"))
    wrong = [
        f"{key} must be {words}, got {checks.shown(request[key])}"
        for key, (kind, words) in kinds.items()
        if key in request and not isinstance(request[key], kind)
    ]
    missing = [key for key in NEEDED.get(request["kind"], ()) if request.get(key) is None]
    checks.require("explore", *wrong, f"a request {request['kind']} needs {', '.join(missing)}" if missing else None)


def describe(session, request):
    """Fields of the parameters and names of the quantities of a state."""
    scene = session.scene(request["state"])
    quantities = [
        {"name": name, "label": item.label, "unit": pretty_unit(item.unit), "vector": item.vector, "kind": item.kind}
        for name, item in of_scene(scene).items()
        if item.kind in KINDS
    ]
    drive = answers.motor_of(session, request["state"])[0] is not None
    return {"parameters": fields.fields(scene), "quantities": quantities, "drive": drive}


def count_of(request):
    """Number of crank angles of a request."""
    count = request.get("count", 360)
    if type(count) is not int or not 1 <= count <= MAX_COUNT:
        raise ParameterError(f"explore: count must be a whole number from 1 to {MAX_COUNT}, got {checks.shown(count)}")
    return count


def look(session, request):
    """The machine of a state over the period: its drawing and the quantities to show."""
    scene = session.scene(request["state"])
    solution = scene.solve(count_of(request))
    points = Points(solution, scene.places)
    session.looked = scene, points
    known = of_scene(scene)
    show = [name for name in dict.fromkeys(request.get("show", ())) if name in known]
    return {
        "values": {path: value for path, value in scene.parameters.items() if np.ndim(value) == 0},
        "drawing": drawing_of(points.shape),
        "angle": np.degrees(solution.crank_angle),
        "period": float(np.degrees(scene.period)),
        "sense": turning_sense(scene),
        "quantities": {name: curve(solution, known[name]) for name in show},
        **points.data(),
    }


def drag(session, request):
    """The machine of another state: with a point dragged to (x, y), m, at the crank angle of an index.

    `step` is the snapping step, m; the page keeps it while a point is dragged. While the hand goes on, `still`, the
    drawing has the pose at the index alone, so that the answer comes sooner.
    Impossible numbers are a problem and leave the state; a machine that cannot be assembled is a state with a problem.
    """
    state, place = request["state"], [request.get(key) for key in ("x", "y", "index", "step")]
    if not all(map(is_number, place)) or not place[3] > 0:
        raise ParameterError(f"explore: x, y, index and step (above 0) must be numbers, got {checks.shown(place)}")
    x, y, index, step = place
    count = count_of(request)
    at = float(x), float(y), int(index) % count
    moved = session.points(state, count).dragged(request.get("handle"), *at, request.get("snap") is not False, step)
    base, values = session.base(state), state.get("values", {}) | moved
    own = {path: place.value(base) for path, place in base.places.items() if path in values}
    new = state | {"values": {path: value for path, value in values.items() if value != own.get(path)}}
    session.scene(new)
    try:
        found = {"state": new} | look(session, request | {"state": new})
    except KinetostaticsError as error:
        return {"state": new, "problem": problem_text(error)}
    if request.get("still") is True:
        found["drawing"] = one_pose(found["drawing"], at[2])
    return found


def curve(solution, known):
    """Values of a quantity over the angles of a solution, (parts, N), SI, with the unit in which to show them."""
    values = curve_values(solution, known)
    size = np.hypot(*values) if known.vector else values
    most = ordinary_size([size])
    factor, unit = unit_for(known.unit, most)
    limit = drawn_limit([size], most)
    return {
        "label": known.label,
        "unit": pretty_unit(unit),
        "factor": factor,
        "vector": known.vector,
        "sight": factor * limit if np.isfinite(limit) else None,
        "values": values,
    }


ANSWERS = {
    "open": open_page,
    "describe": describe,
    "look": look,
    "running": answers.running,
    "drag": drag,
    "ask": answers.ask,
    "sensitivities": answers.ask_sensitivities,
    "tolerances": answers.ask_tolerances,
    "optimise": searching.answers,
    "cancel": searching.cancel,
    "groups": groups.answer_groups,
    "edit": groups.answer_edit,
    "save": keeping.save,
    "python": keeping.python,
    "report": keeping.report,
}
"""Function of a session and a request, by the kind of request: it returns a dict, or yields dicts as parts."""
NEEDED = {"optimise": ("vary", "goal", "output"), "sensitivities": ("output",), "edit": ("action",)}
"""Fields without which a kind of request means nothing."""
OF_NEWEST: tuple[str, ...] = ("ask", "running", "sensitivities", "tolerances")
"""Kinds of requests whose answers are dropped when a newer state is asked for."""
