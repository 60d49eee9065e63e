"""The designs of a case file: what is wrong with them, and the search that each describes.

The tolerances of a case file: what is wrong with them, and units that look like slips.
"""

from dataclasses import dataclass, field, fields
from typing import Any

from ..design import case_text
from ..design.cam_start import Options, starting_machine
from ..design.constraints import parse_constraint, parse_output
from ..design.optimise import optimise
from ..design.pareto import Front, pareto
from ..design.problem import parse_bounds
from ..design.result import Found
from ..design.torque_free import torque_free_cam
from ..errors import DesignError, KinetostaticsError
from ..numbers import checks
from ..numbers.formatting import heading, si_columns
from ..numbers.spreads import parse_spread, read_spreads
from ..numbers.units import base_factor
from . import schema

CAM_KEYS = tuple(item.name for item in fields(Options) if item.name in schema.TorqueFreeCamTable.model_fields)
"""Keys of a torque-free cam as `torque_free_cam` takes them."""


@dataclass(frozen=True, eq=False)
class Design:
    """What a case file wants to be found.

    Attributes
    ----------
    name : str
        Under which what is found is written as a variant.
    source, reference : str
        Variants: what the search begins with, and what ratios refer to.
    kind : "optimum", "torque-free-cam" or "front"
    raw : dict
        What stands in the file.
    """

    name: str
    source: str
    reference: str
    table: Any = field(repr=False)
    raw: dict = field(repr=False)
    _variants: Any = field(repr=False)

    @property
    def kind(self):
        return self.table.kind

    @property
    def spread(self):
        """How numbers spread if a quantile is the goal, a `ks.design.Spread`; else None."""
        robust = getattr(self.table, "robust", None)
        return None if robust is None else robust.spread

    def find(self, *, starts=None, progress=False) -> "Found | Front":
        """Search for it; `starts` is how many searches, as the file says unless told.

        Raises
        ------
        DesignError
            There is no such machine; the message tells why, and how near the best comes.
        """
        table = self.table
        source, reference = self._variants[self.source], self._variants[self.reference]
        shared: dict[str, Any] = {"limits": table.limits, "reference": reference, "seed": table.seed}
        shared |= {"starts": table.starts if starts is None else starts, "progress": progress}
        if isinstance(table, schema.FrontTable):
            return pareto(source, table.vary, table.minimise, points=table.points, angles=table.angles, **shared)
        shared |= {"minimise": table.minimise, "maximise": table.maximise}
        shared |= {"robust": self.spread}
        if isinstance(table, schema.OptimumTable):
            return optimise(source, table.vary, angles=table.angles, **shared)
        own = {name: getattr(table, name) for name in CAM_KEYS}
        return torque_free_cam(source, vary=table.vary, **own, **shared)


def write_found(path, case, found):
    """Write a case file of what designs of a case found, by their names: ready to run, and to be found again.

    Besides what is found, of a front one by one, it has what the searches began with, what ratios refer to, and the
    tables of the designs.

    Raises
    ------
    ParameterError
        A part of a scene is a function or an object that case files have no text for.
    """
    designs = [case.designs[name] for name in found]
    names = dict.fromkeys([case.reference, *(name for item in designs for name in (item.reference, item.source))])
    scenes = {name: case.variant(name).scene for name in names}
    for name, result in found.items():
        if isinstance(result, Front):
            scenes |= {f"{name}-{number}": item.scene for number, item in enumerate(result.designs, 1)}
        else:
            scenes[name] = result.scene
    raw = {item.name: item.raw | {"variant": item.source, "reference": item.reference} for item in designs}
    comment = f"Found by: kinetostatics design {case.path.name}"
    return case_text.write_case(path, case.title, scenes, case.source, comment=comment, designs=raw)


def read_designs(tables, reference, variants, problems):
    """Designs by name, of tables as they stand in the file; what is wrong with them is added to the problems."""
    found = {}
    for name, raw in tables.items():
        read, wrong = schema.validated(
            schema.OneDesign, {"design": raw}, lambda keys, name=name: _design_keys(name, keys)
        )
        problems += wrong
        if read is None:
            continue
        table = read.design
        first = next((other for other in variants if other not in (reference, name)), reference)
        chosen = table.variant or first, table.reference or reference
        given = {f"design.{name}.{key}": getattr(table, key) for key in ("variant", "reference")}
        wrong = [checks.choice(key, word, tuple(variants)) for key, word in given.items() if word is not None]
        wrong += [f"{key} is what it is to find: give another" for key, word in given.items() if word == name]
        problems += [problem for problem in wrong if problem]
        if all(map(variants.get, chosen)):
            problems += [f"design.{name}{text}" for text in _problems(table, *map(variants.get, chosen))]
        found[name] = Design(name, *chosen, table, raw, variants)
    return found


def _design_keys(name, keys):
    return "design", name, *keys[1:]


def _problems(table, source, reference):
    """What is wrong with a design of variants that are right, each behind its key."""
    scene, vary, varied = source.scene, table.vary, source
    if isinstance(table, schema.TorqueFreeCamTable):
        try:
            start = starting_machine(scene, Options.checked(**{name: getattr(table, name) for name in CAM_KEYS}))
        except DesignError:  # the search says so, with the numbers
            return
        except KinetostaticsError as error:
            yield f": {_without_owner(error)}"
            return
        scene, varied, vary = start.scene, start.machine, start.vary | vary
    if vary:
        yield from _problem_of(".vary", parse_bounds, varied, vary)
    for key, text in _outputs(table):
        yield from _problem_of(key, _check_output, text, scene, reference.scene)
    for number, text in enumerate(table.limits, 1):
        yield from _problem_of(f".limits[{number}]", _check_limit, text, scene, reference.scene)
    if getattr(table, "robust", None) is not None:
        for path in table.robust.spreads:
            problem = checks.choice("parameter", path, tuple(scene.units))
            if problem:
                yield f".robust.spreads: {problem}"


def _outputs(table):
    """Texts of what is made least or greatest, by key."""
    if isinstance(table, schema.FrontTable):
        return [
            (f".minimise[{number}]", text.strip().removeprefix("-")) for number, text in enumerate(table.minimise, 1)
        ]
    pairs = [(f".{key}", getattr(table, key)) for key in ("minimise", "maximise")]
    return [(key, text) for key, text in pairs if text is not None]


def _problem_of(key, take, *given):
    try:
        take(*given)
    except KinetostaticsError as error:
        yield f"{key}: {_without_owner(error)}"


def _check_limit(text, scene, reference):
    _check_reference(parse_constraint(text, scene).output, reference)


def _check_output(text, scene, reference):
    _check_reference(parse_output(text, scene), reference)


def _check_reference(output, reference):
    """Refuse a ratio to what the reference has not."""
    if output.ratio:
        output.of(reference)


def _without_owner(error):
    """What an error says, without its owner."""
    text = str(error)
    owner, colon, rest = text.partition(": ")
    return rest if colon and owner in ("design", "torque-free cam") else text


MAX_SIZE_RATIO = 300.0
"""How many times a tolerance may be above or below its parameter before its unit is doubted."""


def tolerance_problems(spreads, variants):
    """What is wrong with the tolerances: texts that cannot be read, parameters and units that no variant has."""
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
    """Tolerances whose size is far from that of their parameter in every variant that has it, as a sentence each."""
    for name, text in spreads.items():
        spread = parse_spread(text)
        size = max(abs(spread.median), spread.deviation) * base_factor(spread.unit)
        nominal = [abs(value) for item in variants.values() if (value := _nominal(item, name))]
        if nominal and all(not 1 / MAX_SIZE_RATIO < size / value < MAX_SIZE_RATIO for value in nominal):
            si = next(paths[name] for item in variants.values() if name in (paths := item.units))
            yield (
                f"tolerances: {name} = {text!r} is of the size {size:.6g} {si}, but the parameter of "
                f"{nominal[0]:.6g} {si}; is the unit right?"
            )


def _nominal(variant, path):
    """Value of a parameter, also where the file has a word for it; None if the variant has none."""
    value = variant.parameters.get(path)
    value = variant.scene.parameters.get(path) if isinstance(value, str) else value
    return value if isinstance(value, float) else None
