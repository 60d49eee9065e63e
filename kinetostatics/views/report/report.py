"""A report of a case or of scenes: the public function, and the machines solved at the selectable angles."""

import hashlib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...casefile.case import Case, load_case
from ...cycle.extremes import extremes_by_name
from ...errors import ParameterError
from ...machine.loads import period_of
from ...numbers import checks, files
from ...numbers.lazy import cached_property
from ...numbers.output_units import output_units, shown_in
from ...solution.scene import Scene
from ..canvas import angles_between
from . import html

MAX_ANGLES = 1440
"""Largest number of selectable angles over the period."""


@dataclass(frozen=True, eq=False)
class Machine:
    """One of the machines of a report: a case's variant, or a scene; `step` between its selectable angles, degrees.

    `given` has (value, unit) of each parameter by path: numbers in SI, or words for derived ones.
    """

    name: str
    scene: Scene
    step: int
    given: Mapping[str, tuple[Any, str]]
    variant: Any = None

    @cached_property
    def solution(self):
        return self.scene.solve(round(np.degrees(self.period)) // self.step)

    @property
    def period(self):
        return period_of(self.scene.loads, self.scene.mechanism.turns)

    @cached_property
    def extremes(self):
        """Extremes of all quantities by name: `Row` of `tables`."""
        return extremes_by_name(self.solution)

    @cached_property
    def between(self):
        """The solution at 0 and at angles between the selectable ones: extremes of tables, kinks, jumps."""
        ends = np.reshape([row.ends for row in self.extremes.values()], (-1, 2))
        angles = angles_between(self.solution, np.radians(ends[np.isfinite(ends).all(axis=1), 1]))
        return self.solution.at(np.append(0.0, angles))

    @property
    def motor(self):
        return None if self.variant is None else self.variant.motor


@dataclass(frozen=True, eq=False)
class Subject:
    """The machines of a report by name, the reference first, with their title and source.

    `command` made the report; variants of its `case` may have references of their own.
    """

    title: str
    source: str
    machines: Mapping[str, Machine]
    command: str
    case: Case | None = field(default=None, repr=False)

    @property
    def reference(self):
        """The first machine, with which the others are compared."""
        return next(iter(self.machines.values()))

    def reference_of(self, name):
        """The machine with which the one of this name is compared."""
        if self.case is None:
            return self.reference
        return self.machines.get(self.case.reference_of(name), self.reference)

    @property
    def comparisons(self):
        """Machines compared with each reference, lists by its name."""
        found: dict[str, list[Machine]] = {}
        for name, machine in self.machines.items():
            if machine is not (reference := self.reference_of(name)):
                found.setdefault(reference.name, []).append(machine)
        return found

    @property
    def solutions(self):
        return {name: machine.solution for name, machine in self.machines.items()}

    @cached_property
    def files(self):
        """Name and SHA-256 of each file of the case."""
        paths = [] if self.case is None else list(dict.fromkeys(map(Path, self.case.files)))
        return [(path.name, hashlib.sha256(path.read_bytes()).hexdigest()) for path in paths]

    @property
    def text(self):
        """Text of the case file with its comments; "" without a case."""
        return "" if self.case is None else Path(self.case.path).read_text(encoding="utf-8-sig")


def subject_of(what, variant=None, title=None, command="") -> Subject:
    """Subject of a report, from a case, its name or path, a scene, or a mapping of label to scene."""
    if isinstance(what, Scene):
        what = {what.mechanism.name: what}
    if isinstance(what, Mapping):
        return _of_scenes(what, variant, title, command)
    case = what if isinstance(what, Case) else load_case(what)
    if variant is not None:
        case.variant(variant)
    names = dict.fromkeys(
        [case.reference, *case.variants] if variant is None else [case.reference_of(variant), variant]
    )
    scenes = {name: case.variants[name].scene for name in names}
    step = _step(scenes.values())
    machines = {}
    for name in names:
        variant = case.variants[name]
        units, derived = variant.units, variant.scene.parameters
        given = {  # parameters left open or given as a word have their derived number
            path: (derived.get(path, value) if value is None or isinstance(value, str) else value, units[path])
            for path, value in variant.parameters.items()
            if value is not None or path in derived
        }
        machines[name] = Machine(name, variant.scene, step, given, variant)
    return Subject(title or case.title, case.source, machines, command, case)


def _of_scenes(scenes, variant, title, command):
    labels = Counter(map(str, scenes))
    checks.require(
        "report",
        None if scenes else "there are no scenes to report",
        None if variant is None else "variant is for case files; give only the wanted scenes",
        *(
            None if isinstance(scene, Scene) else f"{name!r} must be a Scene, got a {type(scene).__name__}"
            for name, scene in scenes.items()
        ),
        *(f"{name!r} labels several scenes; give each its own label" for name, count in labels.items() if count > 1),
    )
    several = [name for name, scene in scenes.items() if scene.solve(1).shape != (1,)]
    if several:
        raise ParameterError(
            f"report: {', '.join(map(str, several))} has arrays, several designs or values for certain crank angles;  "
            "give a scene of one design, and values over the turn as a ks.Table or a function"
        )
    step = _step(scenes.values())
    machines = {}
    for name, scene in scenes.items():
        units = scene.units
        given = {path: (value, units[path]) for path, value in scene.parameters.items()}
        machines[str(name)] = Machine(str(name), scene, step, given)
    kinds = dict.fromkeys(scene.mechanism.name for scene in scenes.values())
    return Subject(title or " and ".join(kinds), "", machines, command)


def _step(scenes):
    """Step between the selectable angles, degrees, a divisor of 360."""
    longest = max(period_of(scene.loads, scene.mechanism.turns) for scene in scenes)
    return next(
        step for step in range(1, 361) if 360 % step == 0 and (step * MAX_ANGLES >= np.degrees(longest) or step == 360)
    )


PROGRESS_DELAY = 1.0
"""Time until a progress bar appears, s."""


def report(what, path, *, variant=None, title=None, pdf=None, units=None, command="", progress=False):
    """Write a report: one HTML file without external files or requests, for reading, animation and print.

    The mechanism turns by slider, play button or arrow keys, with its reactions as arrows. The page also shows figures
    to zoom, values at the chosen angle, extremes, comparison with published figures, certainty, friction, drive, and
    the parameters of the machines.

    Parameters
    ----------
    what : Case, str, path, Scene or mapping of label to Scene
        A case, its name or path, or scenes; the first scene is the reference of the others.
    path : path
        File to write, .html.
    variant : str, optional
        Of a case, show only this variant and the reference.
    title : str, optional
        By default the case's title, or the names of the mechanisms.
    pdf : path, optional
        File for the report as PDF too, printed by an installed browser.
    units : dict of dimension to unit, optional
        Units of tables and figures, {"force": "kN", "length": "mm"}, as for `in_units`; the hand calculation and
        published figures stay in SI.
    command : str
        Command that made the report, shown in it.
    progress : bool
        Show a progress bar after one second.

    Returns
    -------
    Path
        Of the HTML file.

    Raises
    ------
    FileError
        A file cannot be written.
    MissingLibraryError
        Jinja2 is not installed, or no browser for the PDF.
    CaseError, ParameterError
        The case, the scenes or the units cannot be used.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> press = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(mass=50.0)), 10.0, loads=ks.ProcessForce(-2e3))
    >>> ks.report(press, "press.html", title="Press")  # doctest: +SKIP
    PosixPath('press.html')
    """
    case = what
    if not (isinstance(what, Case | Scene) or hasattr(what, "items")):
        try:
            case = load_case(what)
        except ParameterError:
            raise ParameterError(
                f"report takes a case, the name or path of one, a Scene or a mapping of label to Scene, got a "
                f"{type(what).__name__}"
            ) from None
    inputs = case.files if isinstance(case, Case) else ()
    checks.require(
        "report",
        files.write_problem(path, inputs=inputs, endings=(".html", ".htm")),
        None if pdf is None else files.write_problem(pdf, inputs=inputs, endings=(".pdf",)),
        None if title is None or (isinstance(title, str) and title.strip()) else f"title must be a text, got {title!r}",
    )
    units = None if units is None else output_units(units, "report")
    html.require_jinja()
    if pdf is not None:
        html.browser()
    subject = subject_of(case, variant, title, command)
    from tqdm import tqdm

    with tqdm(
        desc="report",
        total=html.PROGRESS_STEPS + (pdf is not None),
        unit=" parts",
        delay=PROGRESS_DELAY,
        leave=False,
        disable=not progress,
    ) as bar:

        def tell(text):
            bar.set_postfix_str(text, refresh=False)
            bar.update()

        with shown_in(units):
            text = html.page(subject, tell)
        with files.write_atomically(path) as temporary:
            Path(temporary).write_text(text, encoding="utf-8", errors="replace")  # names of files may be invalid UTF-8
        if pdf is not None:
            tell("PDF")
            with files.write_atomically(pdf) as temporary:
                html.print_page(path, temporary)
    return Path(path)
