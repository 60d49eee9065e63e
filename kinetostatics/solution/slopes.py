"""Derivatives of what a program computes, by numbers of its scene."""

import numpy as np

from ..numbers.elementary import read_only


def slopes(program, by, state, leaves, backend):
    """Derivatives by quantity and by path, shaped as the quantities; NaN where these are.

    Parameters
    ----------
    program : engines.program.Program
    by : dict of path to int
        Which leaf each number is.
    state : Dynamics
    leaves : Leaves
    backend : engines.jax_backend.Backend
    """
    rows = backend.run(program.by_parameters(tuple(by.values())), state, leaves)
    count = len(program.outputs)
    gaps, found = np.isnan(rows[:count]), rows[count:].reshape(count, len(by), *state.shape)
    if gaps.any():
        found = np.where(gaps[:, None], np.nan, found)
    return {
        quantity: dict(zip(by, np.moveaxis(part, -1 - len(state.shape), 0), strict=True))
        for quantity, part in program.recording.named(read_only(found)).items()
    }
