"""Least squares of the torque by harmonics of a cam, with the ends of the stroke among them.

Steps of Gauss and Newton, from the exact derivatives of torque and position.
"""

import numpy as np

TORQUE, POSITION = "balancing_torque", "slider_position"
PASSES = ((2.0, 1.0), (2e3, 0.0))
"""Passes of the least squares, one after the other: what ends of the stroke count, a miss by half of it as so many mean
torques, and what the bends of the cam do. From far away the first finds the way, the second keeps to the ends."""
STEPS = 100


def least_squares(problem, start, values):
    """Design of least squares of the torque, with the ends of the stroke among them, by Gauss and Newton's steps.

    Numbers besides those of the cam, the coupler and the linear spring stay as they are.
    """
    columns = [place for place, name in enumerate(problem.names) if name in start.first]
    for weight, smooth in PASSES:
        values = _squared(problem, start, values, columns, weight, smooth)
    return np.clip(values, problem.low, problem.high)


def _squared(problem, start, values, columns, weight, smooth):
    """Least squares by some of the numbers, with weights of the ends of the stroke and of the waves of the cam."""
    from scipy import optimize

    waves = smooth * np.array([wave(problem.names[place]) for place in columns]) / start.half
    ends = np.array(start.ends)
    reach = (problem.high - problem.low)[columns]
    count = problem.angles

    def placed(steps):
        found = values.copy()
        found[columns] += reach * steps
        return found

    def residuals(steps):
        curves = problem.curves(placed(steps))
        torque, place = curves[TORQUE].values, curves[POSITION].values
        missed = (np.array([place.min(), place.max()]) - ends) / start.half
        found = [torque / (start.unit * np.sqrt(count)), weight * missed, waves * placed(steps)[columns]]
        return np.nan_to_num(np.concatenate(found), nan=1e3)

    def slopes(steps):
        curves = problem.curves(placed(steps))
        place = curves[POSITION]
        extreme = place.slopes[:, [place.values.argmin(), place.values.argmax()]]
        rows = np.hstack([curves[TORQUE].slopes / (start.unit * np.sqrt(count)), weight * extreme / start.half])
        return np.nan_to_num(np.vstack([rows[columns].T, np.diag(waves)]) * reach)

    found = optimize.least_squares(
        residuals, np.zeros(len(columns)), slopes, method="lm", x_scale=1.0, xtol=1e-12, ftol=1e-12, max_nfev=STEPS
    )
    return placed(found.x)


def wave(name):
    """How much a harmonic of the cam bends it: the square of its order, from the second on."""
    kind, _, order = name.rpartition(".")
    return float(order) ** 2 if kind in ("cam.cosine", "cam.sine") and int(order) > 1 else 0.0
