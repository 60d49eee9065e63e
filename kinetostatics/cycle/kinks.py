"""Crank angles over the period where loads, friction and laws of cams have kinks or jumps, of one design or of many.

Friction has kinks where a rate or force changes its sign, teeth where their force does (`numbers.sign_changes`).
Load functions without `kinks` are sampled at the resolution of their scene (`load_functions`); narrower features
may be missed.
"""

import warnings

import numpy as np

from ..errors import HintWarning
from ..machine.loads import (
    KINK_TOLERANCE,
    TURN,
    has_significant_kinks,
    kink_sources,
    kinks_of,
    period_on,
    significant_kinks,
)
from ..mechanics.quantities import LOAD_FREE_KINDS, quantity
from ..numbers.sign_changes import sign_changes
from .load_functions import check_resolution, samples_of_functions, undeclared_functions

SMALL_KINK, MAX_SMALL_KINKS = 1e-9, 200
"""Least size of a kink relative to its load's largest value, and largest number of these kinks of a load."""
SAMPLES = 720
"""Crank angles of a turn between which a friction rate or force changes its sign at most once."""
FINE_SAMPLES = 1440
"""The same for one design."""
ANGLE_TOLERANCE = 1e-9
"""Crank angles nearer than this, rad, count as one."""


def has_kinks(solution, name, tolerance=KINK_TOLERANCE):
    """Whether friction, a cam's law, or a load may put a kink above `tolerance` into a quantity."""
    if law_kinks(solution).size:
        return True
    kinked = any(has_significant_kinks(part, tolerance) for part in kink_sources(solution.loads))
    loads = kinked or undeclared_functions(solution.loads)
    return bool(has_sign_changes(solution) or loads) and quantity(solution, name).kind not in LOAD_FREE_KINDS


def design_kinks(solution, tolerance=KINK_TOLERANCE):
    """Kinks of all designs of a solution; of loads with many only those above `tolerance` times the largest value.

    Returns the crank angles (1 or designs, K), NaN where a design has fewer, and the largest kink left out, relative
    to the largest value of its load.
    """
    sources, largest_left_out = [law_kinks(solution)[None]], 0.0
    if has_sign_changes(solution):
        sources.append(_sign_changes_of(solution, SAMPLES))
    for part in kink_sources(solution.loads):
        angles, _, left_out = significant_kinks(part, solution, SMALL_KINK)
        if angles.shape[1] > MAX_SMALL_KINKS:
            angles, _, left_out = significant_kinks(part, solution, tolerance)
        sources.append((angles[..., None] + _period_starts(part, solution)).reshape(len(angles), -1))
        largest_left_out = max(largest_left_out, left_out)
    sources += [function.rough_places for function in samples_of_functions(solution)]
    designs = max(map(len, sources))
    angles = np.column_stack([np.broadcast_to(part, (designs, part.shape[1])) for part in sources])
    return angles, largest_left_out


def kinks_and_jumps(solution):
    """Crank angles of all kinks, and of those that may be jumps, of one design over the period, rad, rising.

    A `HintWarning` names crank angles where load functions without kinks change between their samples.
    """
    kinks, jumps = declared_kinks(solution)
    functions = samples_of_functions(solution)
    for function in functions:
        kinks = np.union1d(kinks, function.rough_places)
    for text in () if solution.silent else check_resolution(solution, functions, solution.resolution).hints:
        warnings.warn(HintWarning(solution.mechanism.name, text), stacklevel=3)
    if not has_sign_changes(solution):
        return kinks, jumps
    signs = _sign_changes_of(solution, FINE_SAMPLES).ravel()
    return np.union1d(kinks, signs), np.union1d(jumps, signs)


def declared_kinks(motion):
    """Kinks and jumps of loads and laws of cams, without friction and load functions, of a solution or a motion."""
    sources = [(law_kinks(motion), law_kinks(motion, jumps=True))]
    for part in kink_sources(motion.loads):
        starts = _period_starts(part, motion)[:, None]
        kinks, jumps = kinks_of(part, motion)
        sources.append((np.ravel(np.concatenate([kinks, jumps]) + starts), np.ravel(jumps + starts)))
    return tuple(np.unique(_wrapped(np.concatenate(angles), motion.period)) for angles in zip(*sources, strict=True))


def _wrapped(angle, period):
    """Crank angles in [0, period); those within `ANGLE_TOLERANCE` below the period become 0."""
    angle = np.mod(angle, period)
    return np.where(angle > period - ANGLE_TOLERANCE, 0.0, angle)


def law_kinks(solution, jumps=False):
    """Crank angles over the period at which laws of cams have kinks or jumps, or jumps only."""
    angles = [knot.angle for group in solution.mechanism.groups for knot in group.knots if knot.jumps or not jumps]
    starts = np.arange(0.0, solution.period - ANGLE_TOLERANCE, TURN)[:, None]
    return np.ravel(np.mod(np.array(angles, dtype=float), TURN) + starts)


def _period_starts(part, solution):
    """Crank angles at which the period of a part with kinks starts again within the period of a solution."""
    return np.arange(0.0, solution.period - ANGLE_TOLERANCE, period_on(part, solution.mechanism))


def has_sign_changes(solution):
    """Whether friction, or a change of tooth flank, may cause kinks of forces."""
    return bool(solution.friction.acting or solution.mechanism.sign_forces)


def _sign_changes_of(solution, samples):
    count = samples * round(solution.period / TURN)
    return sign_changes(lambda angle: solution.unsolved_at(angle).dynamics.sign_functions, solution.period, count).angle
