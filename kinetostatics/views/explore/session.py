"""Session: what a page or notebook asks of a case or scene, answered without a browser.

A state is ``{"variant": name, "values": {path: number in SI}}``: numbers that differ from the scene of the variant. A
request is a dict with `id` and `kind`; its answer carries the same `id` and the state to which its numbers belong.
"""

import warnings
from collections import OrderedDict
from types import GeneratorType

import numpy as np

from ...casefile.case import Case, load_case
from ...cycle.rounding import FLOOR, zeroed
from ...errors import KinetostaticsError, ParameterError
from ...mechanics.quantities import components, largest_term, of_scene
from ...numbers import checks
from ...numbers.formatting import pretty_unit
from ...solution.scene import Scene
from ..canvas import display_unit, ordinary_size
from ..report.movement import drawing_of
from ..report.tables import KINDS, decimals
from . import fields

MAX_SCENES = 32
"""Scenes kept of the states asked for last."""
MAX_COUNT = 3600
"""Most crank angles of a request."""


class Session:
    """Answers to the requests of one page on a case, or on a scene.

    Parameters
    ----------
    what : Case, str, path or Scene
    variant : str, optional
        Variant shown first.
    folder : path, optional
        The only folder into which files are written; None: none are.
    """

    def __init__(self, what, variant=None, folder=None):
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
        self._scenes: OrderedDict[str, Scene] = OrderedDict()

    def answer(self, request):
        """The answer to a request, a dict, or a generator of several; a sentence `problem` on what a user can mend."""
        try:
            kind = request["kind"]
            checks.require("explore", checks.choice("kind of request", kind, tuple(ANSWERS)))
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                found = ANSWERS[kind](self, request)
            if isinstance(found, GeneratorType):
                return self._parts(request, found)
            notes = list(dict.fromkeys(str(item.message) for item in caught if issubclass(item.category, UserWarning)))
            return self._marked(request, {"notes": notes} | found)
        except KinetostaticsError as error:
            return self._marked(request, {"problem": str(error)})

    def _parts(self, request, parts):
        """Answers in parts, all but the last with `more`; None where the next part is not ready."""
        try:
            for part in parts:
                yield part and self._marked(request, {"more": True} | part)
            yield self._marked(request, {"more": False})
        except KinetostaticsError as error:
            yield self._marked(request, {"problem": str(error)})
        finally:
            parts.close()

    def _marked(self, request, found):
        return {"id": request.get("id"), "kind": request.get("kind"), "state": request.get("state")} | found

    def base(self, state):
        """Scene of a state without its changed numbers."""
        name = state.get("variant", self.first)
        checks.require("explore", checks.choice("variant", name, tuple(self.bases)))
        return self.bases[name]

    def scene(self, state):
        """Scene of a state."""
        key = repr((state.get("variant"), sorted(state.get("values", {}).items())))
        if key not in self._scenes:
            self._scenes[key] = self.base(state).varied(state.get("values", {}))
            while len(self._scenes) > MAX_SCENES:
                self._scenes.popitem(last=False)
        self._scenes.move_to_end(key)
        return self._scenes[key]


def open_page(session, request):
    """What a page needs at its start."""
    references = session.case.reference_of if session.case else lambda name: name
    variants = [{"name": name, "reference": references(name)} for name in session.bases]
    start = {"variant": session.first, "values": {}}
    return {"title": session.title, "source": session.source, "variants": variants, "start": start}


def describe(session, request):
    """Fields of the parameters and names of the quantities of a state."""
    scene = session.scene(request["state"])
    quantities = [
        {"name": name, "label": item.label, "unit": pretty_unit(item.unit), "vector": item.vector, "kind": item.kind}
        for name, item in of_scene(scene).items()
        if item.kind in KINDS
    ]
    return {"parameters": fields.fields(scene), "quantities": quantities}


def look(session, request):
    """The machine of a state over the period: its drawing and the quantities to show."""
    scene = session.scene(request["state"])
    count = request.get("count", 360)
    if not isinstance(count, int) or not 1 <= count <= MAX_COUNT:
        raise ParameterError(f"explore: count must be a whole number from 1 to {MAX_COUNT}, got {count!r}")
    solution = scene.solve(count)
    known = of_scene(scene)
    return {
        "values": {path: value for path, value in scene.parameters.items() if np.ndim(value) == 0},
        "drawing": drawing_of(solution),
        "angle": np.degrees(solution.crank_angle),
        "period": float(np.degrees(scene.period)),
        "way": -1 if np.any(np.asarray(scene.crank_speed) < 0) else 1,
        "quantities": {name: curve(solution, name) for name in request.get("show", ()) if name in known},
    }


def curve(solution, name):
    """Values of a quantity over the angles of a solution, (parts, N), SI, with the unit in which to show them."""
    known = of_scene(solution)[name]
    shape, rounding = solution.crank_angle.shape, FLOOR * float(np.max(largest_term(solution, name)))
    values = zeroed(np.stack([np.broadcast_to(part, shape) for part in components(solution, name)]), rounding)
    size = np.hypot(*values) if known.vector else values
    factor, unit = display_unit(known.unit, [size])
    return {
        "label": known.label,
        "unit": pretty_unit(unit),
        "factor": factor,
        "decimals": decimals(factor * ordinary_size([size])),
        "vector": known.vector,
        "values": values,
    }


ANSWERS = {"open": open_page, "describe": describe, "look": look}
"""Function of a session and a request, by the kind of request: it returns a dict, or yields dicts as parts."""
OF_NEWEST: tuple[str, ...] = ()
"""Kinds of requests whose answers are dropped when a newer state is asked for."""
