"""What a sweep is to do with designs, and its trial: the first that can be built tells engine, angles and units."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..engines.program import program_of
from ..errors import HintWarning, NotGivenError, ParameterError, QuantityError
from ..machine.loads import STRAIGHT, TURN
from ..mechanics.quantities import components
from ..numbers import checks
from ..results.bends import bent
from ..results.reductions import Output
from ..results.turn import repeating_problem
from ..solution.parted import PARTED
from ..solution.scene import Scene, odd
from . import together

PROBED = 64
"""Designs among which one that can be built is looked for, to try a sweep before it begins."""
FEWEST = 12
"""Crank angles below which a sweep is refused."""
LEAST = 180
"""Crank angles a turn that are taken at least: fewer may agree with twice as many, and both be wrong."""


@dataclass(frozen=True)
class Job:
    """What to do with a chunk of designs; goes to the workers.

    Attributes
    ----------
    make, make_reference : function
        From values in SI by name to a `Scene`, or what has one; the reference's is None without ratios.
    columns : tuple of (column, name, factor)
        Where the values stand in the table of designs.
    threads : int
        Cores to use for a chunk.
    wide : bool
        Whether a compiled loop takes all designs of a chunk, and no table for each of them.
    bent : bool
        Whether tables or friction act on an output, so that its turn may be parted.
    straight : float
        Share of its largest value by which a table bends where the turn is parted.
    hints : tuple of HintWarning
        What looks like a slip in the design that was tried.
    """

    make: Callable[[dict], Any]
    make_reference: Callable[[dict], Any] | None
    columns: tuple[tuple[str, str, float], ...]
    outputs: tuple[Output, ...]
    angles: int
    engine: str
    threads: int
    wide: bool = False
    bent: bool = False
    straight: float = STRAIGHT
    hints: tuple[HintWarning, ...] = ()

    @property
    def ratios(self):
        """Places of the outputs that are ratios to the reference."""
        return [place for place, item in enumerate(self.outputs) if item.ratio]

    @property
    def sides(self):
        """Functions that make scenes, each with the outputs wanted of what it makes."""
        own = [(self.make, self.outputs)]
        return [*own, (self.make_reference, [self.outputs[place] for place in self.ratios])] if self.ratios else own

    def given(self, frame):
        """Numbers (designs, columns) of designs, in SI."""
        rows = [frame[column].to_numpy(dtype=float) * scale for column, _, scale in self.columns]
        return np.reshape(rows, (len(rows), len(frame))).T

    def values(self, given):
        """What to call the functions with for some designs, in turn: arrays, and plain numbers for a single design."""
        names = (name for _, name, _ in self.columns)
        arrays = dict(zip(names, given.T.copy()[..., None], strict=True))  # which the functions may change
        return [arrays] if len(given) > 1 else [arrays, {name: float(value[0, 0]) for name, value in arrays.items()}]


class _NoSceneError(ParameterError):
    """A function makes something else than a scene."""


def tried(job, designs, engines):
    """The job with the first of the engines that takes the mechanism, and units of its outputs.

    Tried on the first design that can be built; None if none can. Raises what would otherwise be the reason of every
    design: `QuantityError` for a quantity that the mechanism does not have, `ParameterError` for a function that makes
    something else than a scene, `NotGivenError` if no engine takes it. The same for fewer crank angles than tell
    anything, and loads that do not repeat after their period.
    """
    few = None if job.angles >= FEWEST else f"angles must be at least {FEWEST}, got {job.angles}: they miss every peak"
    checks.require("sweep", few)
    for row in range(len(designs)):
        *_, plain = job.values(job.given(designs.iloc[row : row + 1]))
        try:
            scenes = [scene_of(make, plain) for make, _ in job.sides]
        except _NoSceneError:
            raise
        except Exception:
            continue
        try:
            solutions = [together.solution_of(scene, job.angles) for scene in scenes]
            pairs = list(zip(solutions, job.sides, strict=True))
            for solution, (_, outputs) in pairs:
                for name in together.quantities(outputs):
                    components(solution, name)
            problems = [repeating_problem(solution) for solution in solutions]
        except QuantityError:
            raise
        except Exception:
            continue
        checks.require("sweep", *problems)
        hints = tuple(HintWarning(scenes[0].mechanism.name, text) for text in odd(solutions[0]))
        outputs = tuple(item.of(scenes[0]) for item in job.outputs)
        engine = _engine(job, solutions, engines)
        wide = engine == "compiled" and not any(program.recording.rows for program in _programs(job, solutions))
        parted = any(bent(solution, item.quantity, 0.0) for solution, (_, wanted) in pairs for item in wanted)
        angles = max(job.angles, (PARTED if parted else LEAST) * round(scenes[0].period / TURN))
        return replace(job, engine=engine, outputs=outputs, wide=wide, bent=parted, angles=angles, hints=hints)
    return None


def scene_of(make, values):
    """What a function makes of values, if it is a scene or has one."""
    found = make(values)
    scene = getattr(found, "scene", found)
    if not isinstance(scene, Scene):
        raise _NoSceneError(f"sweep: the function must return a kinetostatics.Scene, got {checks.shown(found)}")
    return scene


def _engine(job, solutions, engines):
    first, *others = engines
    if first == "numpy":
        return first
    try:
        _programs(job, solutions)
    except NotGivenError:
        if not others:
            raise
        return _engine(job, solutions, others)
    return first


def _programs(job, solutions):
    """What a compiled loop of each side computes."""
    return [
        program_of(solution.dynamics, (*together.quantities(outputs), "closure"), sizes=True)[0]
        for solution, (_, outputs) in zip(solutions, job.sides, strict=True)
    ]
