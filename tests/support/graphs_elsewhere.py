"""Random graphs as another arithmetic runs them: single precision."""

import numpy as np

from kinetostatics.engines.error_bounds import SINGLE, ErrorBounds
from kinetostatics.engines.jax_backend import Given, MixedPrecision
from kinetostatics.engines.program import Program


def _single(program, angle, given, rows):
    """Values in single precision, of what a design fixes in double."""
    recording, split = program.recording, MixedPrecision(program)
    bounds = ErrorBounds(recording.graph, recording.inputs, SINGLE).of(program.outputs)
    fixed = [np.asarray(part, np.float32) for part in split._fixed_by(given)]
    turn = [np.asarray(part, np.float32) for part in (angle, np.sin(angle), np.cos(angle))]
    handed = Given(*turn, fixed, [row.astype(np.float32) for row in rows], angle.shape)
    return *split.by_numpy(handed), *Program(recording, bounds).by_numpy(angle, given, rows, angle.shape)


SINGLE_PRECISION = {"single": _single}
