"""Random graphs as other arithmetics run them: single precision, and numbers of more digits than a double."""

import numpy as np

from kinetostatics.engines.arithmetic import SINGLE, BoundsElsewhere, BoundsOfLonger
from kinetostatics.engines.codegen import BY_DESIGN, compile_line, line_source
from kinetostatics.engines.functions import OTHER
from kinetostatics.engines.graph import needed
from kinetostatics.engines.jax_backend import Given, MixedPrecision
from kinetostatics.engines.program import Program
from kinetostatics.engines.steep import _TWOFOLD, UNKNOWN, _long_rest, _long_total
from kinetostatics.numbers.planar import number
from kinetostatics.numbers.twofold import Twofold, sine_and_cosine


def _single(program, angle, given, rows):
    """Values in single precision, of what a design fixes in double."""
    recording, split = program.recording, MixedPrecision(program)
    bounds = BoundsElsewhere(recording.graph, recording.inputs, SINGLE).of(program.outputs)
    fixed = [np.asarray(part, np.float32) for part in split._fixed_by(given)]
    turn = [np.asarray(part, np.float32) for part in (angle, np.sin(angle), np.cos(angle))]
    handed = Given(*turn, fixed, [row.astype(np.float32) for row in rows], angle.shape)
    return *split.by_numpy(handed), *Program(recording, bounds).by_numpy(angle, given, rows, angle.shape)


def _of_more_digits(made_of, number, turn):
    def way(program, angle, given, rows):
        outputs, recording = program.outputs, program.recording
        bounds = BoundsOfLonger(recording.graph, recording.inputs).of(outputs)
        numbers = [number(part) for part in given]
        values = made_of(outputs)(number(angle), *turn(number(angle)), numbers, [number(row) for row in rows])
        found = Program(recording, bounds).by_numpy(angle, given, rows, angle.shape)
        return *(_spread(value, angle.shape) for value in values), *found

    return way


def _spread(value, shape):
    """An array of numbers of more digits, of which a design may have one for all angles."""
    if isinstance(value, Twofold):
        parts = (np.broadcast_to(part, shape).ravel() for part in (value.value, number(value.rest)))
        found = np.empty(shape, object)
        found.ravel()[:] = [Twofold(*pair) for pair in zip(*parts, strict=True)]
        return found
    return np.broadcast_to(np.asarray(value), shape)


SINGLE_PRECISION = {"single": _single}
MORE_DIGITS = {
    "long": _of_more_digits(
        lambda outputs: compile_line(line_source(outputs), BY_DESIGN | {"total": _long_total, "rest": _long_rest}),
        np.longdouble,
        lambda angle: (np.sin(angle), np.cos(angle)),
    ),
    "two parts": _of_more_digits(
        lambda outputs: compile_line(line_source(outputs), _TWOFOLD), Twofold, sine_and_cosine
    ),
}
"""Of programs without what `steep` does not run so."""


def runs_in_more_digits(case):
    """Whether a program has only what `steep` has run so: no sine but of the crank angle."""
    return not any(_is_left_out(node) for node in needed(case.program.outputs))


def _is_left_out(node):
    return node.operation in UNKNOWN or (node.operation in OTHER and node.arguments[0].operation != "angle")
