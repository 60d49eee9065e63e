"""Stretch of a follower's spring over the crank angle that balances a given energy of the machine, exactly.

A follower of mass m on a spring of rate k, moved by a cam on a crank of constant speed, satisfies with mu = m omega^2

    mu x'^2 / 2 + k x^2 / 2 = C - E(phi)

where x is the stretch, E the energy of the machine, C the level. By the derivative, the cam force is
mu x'' + k x = -E' / x': the contact presses if the follower moves out while E falls and back while E rises. At a
minimum of E, x' vanishes with x'' = a, a root of mu a^2 + k x a + E'' = 0, real only for (k x)^2 > 4 mu E''.

Solutions of the first-order equation converge from a maximum of E to the neighbouring minima, in both directions. The
integration starts at maxima and continues from panel to panel by Chebyshev collocation. At a kink of E the follower
keeps x, x' and x'' and continues on the curve after the kink.
"""

import numpy as np
from numpy.polynomial import chebyshev

from ..errors import ParameterError
from ..numbers.panels import PANEL_DEGREE, Panels

MAX_NEWTON_STEPS = 40
"""Newton steps on a panel."""
NEWTON_TOLERANCE = 3e-15
"""Change relative to the stretch at which Newton's method ends."""
SERIES_TOLERANCE = 1e-13
"""Size of the last coefficients, relative to the largest stretch, of a resolved panel."""
CONTACT_TOLERANCE = 1e-9
"""Negligible power of wrong sign, relative to the largest speed times slope."""
MIN_PANEL = 1e-7
"""Width of the narrowest panel, rad."""
_NODES = -np.cos(np.pi * np.arange(PANEL_DEGREE + 1) / PANEL_DEGREE)
_FIT = np.linalg.inv(chebyshev.chebvander(_NODES, PANEL_DEGREE))
_DERIVATIVE = np.array([chebyshev.chebval(_NODES, chebyshev.chebder(row)) for row in _FIT.T]).T
"""Matrix from values at _NODES to derivatives there."""


def reserve(energy, low, level, mass, stiffness):
    """Spring force at an energy minimum over the force for contact, 2 sqrt(mu E''); `mass` is mu = m omega^2."""
    force = np.sqrt(2.0 * stiffness * (level - float(energy(low))))
    bend = max(float(energy.at(low + side, 2)[2]) for side in (-1e-9, 1e-9))  # the larger value of both sides of a kink
    return float(force / (2.0 * np.sqrt(mass * bend)))


def spring_stretch(energy, level, mass, stiffness):
    """Stretch x of the spring over the crank angle, as `Panels`, m, for an energy in panels; `mass` is m omega^2.

    Raises `ParameterError`, with the crank angle, if the follower lifts off: no smooth solution stays in contact.
    """
    rows = chebyshev.chebder(energy.coefficients, axis=1) * (2.0 / np.diff(energy.edges)[:, None])
    slope = Panels(energy.edges, np.pad(rows, ((0, 0), (0, 1))))
    turns, found = slope.roots, []
    values = energy(turns)
    for place, angle in enumerate(turns):
        before, after = turns[place - 1], turns[(place + 1) % turns.size]
        if values[place] > values[place - 1]:
            after = after + energy.period * (after <= angle)
            before = before - energy.period * (before >= angle)
            if reserve(energy, after, level, mass, stiffness) <= 1.0:
                raise ParameterError(_lift_off_text(after))
            for stop in (before, after):
                found += _march_panels(energy, slope, angle, stop, level, mass, stiffness)
    first = turns[int(np.argmax(values))]
    starts = np.mod([low - first + 1e-9 for low, *_ in found], energy.period) - 1e-9
    order = np.argsort(starts)
    edges = first + np.array([0.0, *starts[order[1:]], energy.period])
    return Panels(edges, np.array([found[place][-1] for place in order]))


def _march_panels(energy, slope, start, stop, level, mass, stiffness):
    """Panels (low, high, coefficients) from an energy maximum to the neighbouring minimum."""
    edges = np.concatenate([energy.edges[:-1] + turn * energy.period for turn in (-1, 0, 1, 2)])
    low, high = min(start, stop), max(start, stop)
    inner = edges[(edges > low + MIN_PANEL) & (edges < high - MIN_PANEL)]
    marks = list(inner if stop > start else inner[::-1]) + [stop]
    found, at, value = [], start, None
    while marks:
        nodes = at + (_NODES + 1.0) / 2.0 * (marks[0] - at)
        inside = np.clip(nodes, *sorted((at + 1e-13 * (marks[0] - at), marks[0] - 1e-13 * (marks[0] - at))))
        rest = 2.0 * (level - energy(inside)) / stiffness
        x = _collocate(rest, marks[0] - at, mass / stiffness, value)
        if x is None:
            if abs(marks[0] - at) < MIN_PANEL:
                raise ParameterError(_lift_off_text(at))
            marks.insert(0, (at + marks[0]) / 2)
            continue
        rows = _FIT @ x
        rate, steep = 2.0 / (marks[0] - at) * (_DERIVATIVE @ x), slope(inside)
        worst = int(np.argmax(rate * steep))  # a stretch that grows with the machine's energy: the contact would pull
        if (rate * steep)[worst] > CONTACT_TOLERANCE * np.max(np.abs(rate)) * np.max(np.abs(steep)):
            raise ParameterError(_lift_off_text(nodes[worst]))
        mirrored = rows if stop > start else rows * (-1.0) ** np.arange(PANEL_DEGREE + 1)
        found.append((*sorted((at, marks[0])), mirrored))
        at, value = marks.pop(0), x[-1]
    return found


def _collocate(rest, width, share, value):
    """Stretch at the nodes of a panel by x^2 + share x'^2 = rest and x = `value` at the start; None if not resolved."""
    rate = 2.0 / width * _DERIVATIVE
    # from rough values by implicit Euler steps
    start = [np.sqrt(max(rest[0], 0.0)) if value is None else value]
    for step, there in zip(np.diff(_NODES) * width / 2.0, rest[1:], strict=True):
        q = share / (step * step)
        square = (1.0 + q) * there - q * start[-1] * start[-1]
        start.append((q * start[-1] + np.sqrt(max(square, 0.0))) / (1.0 + q))
    x = np.array(start)
    for _ in range(MAX_NEWTON_STEPS):
        fast = rate @ x
        off = (x * x + share * fast * fast - rest) / 2.0
        matrix = np.diag(x) + share * fast[:, None] * rate
        if value is not None:
            off[0], matrix[0] = x[0] - value, np.eye(x.size)[0]
        try:
            step = np.linalg.solve(matrix, off)
        except np.linalg.LinAlgError:
            break
        x = x - step
        size = np.max(np.abs(x))
        if not np.isfinite(size):
            break
        if np.max(np.abs(step)) <= NEWTON_TOLERANCE * size * 30:
            tail = np.max(np.abs((_FIT @ x)[-3:]))
            return x if tail <= SERIES_TOLERANCE * size and np.all(x > 0.0) else None
    return None


def _lift_off_text(angle):
    return (
        f"the roller would lift off near crank angle {np.degrees(angle) % 360:.6g} deg: no motion of the follower "
        "balances and stays in contact. Preload the spring more, or make the follower lighter or its travel shorter"
    )
