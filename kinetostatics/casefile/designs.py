"""Designs of a case file (searches), and the faults of designs and tolerances."""

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from ..design.cam_start import Options, starting_machine
from ..design.constraints import MEAN, parse_constraint, parse_output
from ..design.duties import read_duties
from ..design.problem import parse_bounds
from ..errors import DesignError, KinetostaticsError
from ..numbers import checks
from ..numbers.formatting import heading, si_columns
from ..numbers.spreads import parse_spread, read_spreads
from ..numbers.units import base_factor
from .schema.designs import FrontTable, OneDesign, OptimumTable, TorqueFreeCamTable
from .schema.tables import validate

if TYPE_CHECKING:
    from ..design.pareto_front import Front
    from ..design.result import Found

CAM_KEYS = tuple(item.name for item in fields(Options) if item.name in TorqueFreeCamTable.model_fields)
"""Keys of a torque-free cam that are arguments of `torque_free_cam`."""


@dataclass(frozen=True, eq=False)
class Design:
    """A search described by a case file.

    Attributes
    ----------
    name : str
        Name of the variant with the result.
    sources : dict of str to str
        Variant at the start of the search (with duties one each), with its reference in ratios.
    kind : "optimum", "torque-free-cam" or "front"
    raw : dict
        Its table in the file.
    """

    name: str
    sources: dict[str, str]
    table: Any = field(repr=False)
    raw: dict = field(repr=False)
    _variants: Any = field(repr=False)

    @property
    def kind(self):
        return self.table.kind

    @property
    def duties(self):
        """Share of the time by variant; None for a search with one variant."""
        return getattr(self.table, "duties", None)

    @property
    def source(self):
        """Variant at the start of the search, the first of several duties."""
        return next(iter(self.sources))

    @property
    def reference(self):
        """Reference of that variant in ratios."""
        return self.sources[self.source]

    def variants_of(self, name):
        """Sources of a result by the names of its variants; the name of a duty is appended."""
        return {f"{name}-{source}": source for source in self.sources} if self.duties else {name: self.source}

    @property
    def spread(self):
        """Spread of numbers for a robust design, a `ks.design.Spread`; else None."""
        robust = getattr(self.table, "robust", None)
        return None if robust is None else robust.spread

    def find(self, *, starts=None, progress=False) -> "Found | Front":
        """Result of the search; `starts` is the number of searches, by default as in the file.

        Raises
        ------
        DesignError
            No machine meets the limits; the message gives the reason and the nearest machine.
        """
        from ..design.optimisation import optimise
        from ..design.pareto_front import pareto
        from ..design.torque_free import torque_free_cam

        table = self.table
        source, reference = self._variants[self.source], self._variants[self.reference]
        if self.duties:
            source = {name: (self._variants[name], share) for name, share in self.duties.items()}
            reference = {name: self._variants[other] for name, other in self.sources.items()}
        starts = table.starts if starts is None else starts
        shared = {"limits": table.limits, "reference": reference, "seed": table.seed, "starts": starts}
        shared["progress"] = progress
        if isinstance(table, FrontTable):
            return pareto(source, table.vary, table.minimise, points=table.points, angles=table.angles, **shared)
        shared |= {"minimise": table.minimise, "maximise": table.maximise, "robust": self.spread}
        if isinstance(table, OptimumTable):
            return optimise(source, table.vary, angles=table.angles, **shared)
        own = {name: getattr(table, name) for name in CAM_KEYS}
        return torque_free_cam(source, vary=table.vary, **own, **shared)


def write_found(path, case, found):
    """Write the results of designs, by name, as a case file that can be run and searched again.

    It also has the variants at the start of the searches, the references, and the tables of the designs.

    Raises
    ------
    ParameterError
        A part of a scene is a function or object without a text in case files.
    """
    from ..design import case_text
    from ..design.pareto_front import Front
    from ..design.result import named_scenes

    designs = [case.designs[name] for name in found]
    pairs = [pair for item in designs for pair in item.sources.items()]
    names = dict.fromkeys([case.reference, *(name for source, other in pairs for name in (other, source))])
    scenes = {name: case.variant(name).scene for name in names}
    drives = {name: case.variant(name).raw_drive for name in names}
    references = {name: reference for name in names if (reference := case.reference_of(name)) in names}
    for name, result in found.items():
        ends = {name: result}
        if isinstance(result, Front):
            ends = {f"{name}-{number}": item for number, item in enumerate(result.designs, 1)}
        for end, item in ends.items():
            scenes |= named_scenes(end, item.scene)
            of = case.designs[name].variants_of(end)
            references |= {made: case.designs[name].sources[source] for made, source in of.items()}
            drives |= {made: drives[source] for made, source in of.items()}
    raw = {
        item.name: item.raw | ({} if item.duties else {"variant": item.source, "reference": item.reference})
        for item in designs
    }
    comment = f"Found by: kinetostatics design {case.path.name}"
    tables = {"drives": drives, "designs": raw, "sizing": {name: part.raw for name, part in case.sizing.items()}}
    return case_text.write_case(path, case.title, scenes, case.source, comment=comment, references=references, **tables)


def read_designs(tables, reference, variants, problems):
    """Designs by name, of the tables in the file; appends their faults to `problems`."""
    found = {}
    for name, raw in tables.items():
        read, wrong = validate(OneDesign, {"design": raw}, lambda keys, name=name: ("design", name, *keys[1:]))
        problems += wrong
        if read is None:
            continue
        table = read.design
        first = next((other for other in variants if other not in (reference, name)), reference)
        duties = getattr(table, "duties", None)
        chosen = {}
        for source in (table.variant or first,) if duties is None else duties:
            own = variants[source].table.reference if variants.get(source) else None
            chosen[source] = table.reference or own or reference
        given = [(f"design.{name}.{key}", getattr(table, key)) for key in ("variant", "reference")]
        given += [(f"design.{name}.duties", duty) for duty in duties or ()]
        wrong = [checks.choice(key, word, tuple(variants)) for key, word in given if word is not None]
        wrong += [f"{key} is the name of the result: give another" for key, word in given if word == name]
        problems += [problem for problem in wrong if problem]
        if all(map(variants.get, (*chosen, *chosen.values()))):
            pairs = {source: (variants[source], variants[other]) for source, other in chosen.items()}
            texts = [f"design.{name}{text}" for source in chosen for text in _problems(table, source, *pairs[source])]
            problems += dict.fromkeys(texts)
            if duties is not None:
                shared = {source: (variants[source], share) for source, share in duties.items()}
                problems += [f"design.{name}{text}" for text in _problem_of(".duties", read_duties, shared, None, None)]
        found[name] = Design(name, chosen, table, raw, variants)
    return found


def _problems(table, duty, source, reference):
    """Faults of a design of valid variants in one of its duties, each after its key."""
    scene, vary, varied = source.scene, table.vary, source
    if isinstance(table, TorqueFreeCamTable):
        try:
            start = starting_machine(scene, Options.checked(**{name: getattr(table, name) for name in CAM_KEYS}))
        except DesignError:  # the search reports it with the numbers
            return
        except KinetostaticsError as error:
            yield f": {_without_owner(error)}"
            return
        scene, varied, vary = start.scene, start.machine, start.vary | vary
    if vary:
        yield from _problem_of(".vary", parse_bounds, varied, vary)
    if isinstance(table, FrontTable):
        texts = {f".minimise[{at}]": text.strip().removeprefix("-") for at, text in enumerate(table.minimise, 1)}
    else:
        texts = {f".{key}": text for key in ("minimise", "maximise") if (text := getattr(table, key)) is not None}
    limits = {}
    for number, text in enumerate(table.limits, 1):
        own, colon, rest = text.partition(":")
        if not colon or getattr(table, "duties", None) is None:
            limits[f".limits[{number}]"] = text
        elif problem := checks.choice("duty", own.strip(), (*table.duties, MEAN)):
            yield f".limits[{number}]: {problem}"
        elif own.strip() in (duty, MEAN):
            limits[f".limits[{number}]"] = rest
    for key, text in (texts | limits).items():
        yield from _problem_of(key, _require_output, text, key in limits, scene, reference.scene, source.sizing)
    if getattr(table, "robust", None) is not None:
        for path in table.robust.spreads:
            problem = checks.choice("parameter", path, tuple(scene.units))
            if problem:
                yield f".robust.spreads: {problem}"


def _problem_of(key, take, *given):
    try:
        take(*given)
    except KinetostaticsError as error:
        yield f"{key}: {_without_owner(error)}"


def _require_output(text, limit, scene, reference, parts):
    """Raise an error unless the scene (for a ratio also the reference) has the output, or that of a limit."""
    output = parse_constraint(text, scene, parts).output if limit else parse_output(text, scene, parts)
    if output.ratio:
        output.of(reference)


def _without_owner(error):
    """Text of an error without its owner."""
    text = str(error)
    owner, colon, rest = text.partition(": ")
    return rest if colon and owner in ("design", "torque-free cam") else text


MAX_SIZE_RATIO = 300.0
"""Largest ratio of a tolerance to its parameter, or the inverse, without a hint about its unit."""


def tolerance_problems(spreads, variants):
    """Faults of the tolerances: unreadable texts, unknown parameters, wrong units."""
    known = {path: unit for item in variants.values() if item for path, unit in item.units.items()}
    for name, text in spreads.items():
        columns = [name]
        try:
            columns = [heading(name, read_spreads({name: text}, parse_spread)[name].unit)]
        except KinetostaticsError as error:
            yield f"tolerances: {str(error).removeprefix('designs: ')}"
        if all(variants.values()):
            yield from (f"tolerances: {problem}" for problem in si_columns(columns, known)[1])


def doubtful_tolerances(spreads, variants):
    """Sentences on tolerances of a very different size than their parameter in every variant."""
    for name, text in spreads.items():
        spread = parse_spread(text)
        size = max(abs(spread.median), spread.deviation) * base_factor(spread.unit)
        given = [item.parameters.get(name) for item in variants.values()]
        derived = [item.scene.parameters.get(name) for item in variants.values()]  # for words in the file
        values = [there if isinstance(value, str) else value for value, there in zip(given, derived, strict=True)]
        nominal = [abs(value) for value in values if isinstance(value, float) and value]
        if nominal and all(not 1 / MAX_SIZE_RATIO < size / value < MAX_SIZE_RATIO for value in nominal):
            si = next(paths[name] for item in variants.values() if name in (paths := item.units))
            yield (
                f"tolerances: {name} = {text!r} is of the size {size:.6g} {si}, but the parameter of "
                f"{nominal[0]:.6g} {si}; is the unit right?"
            )
