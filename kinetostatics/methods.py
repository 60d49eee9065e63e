"""Methods under study: the papers' own ways to a result, kept to be measured against the library's.

Nothing in the library calls them; where they fail is counted by the tests.
"""

import numpy as np


def turned_to_length(vector, angle, length):
    """TurnV: a vector (2, N) turned counter-clockwise by an angle (rad) and given a length (Kotov 2024, equation 1)."""
    quarter = np.pi / 2
    x, y = vector
    scale = length / np.hypot(x, y)
    return np.array(
        [
            (np.cos(angle) * x + np.cos(quarter + angle) * y) * scale,
            (np.cos(quarter - angle) * x + np.cos(angle) * y) * scale,
        ]
    )


def slider_by_double_cross(A, coupler_length, W1, W2, W):
    """Slider: position of the slider pin by double cross product, acos and the sign of a mixed product.

    Steps as printed (Kotov 2024, figure 3): the perpendicular AC from A to the guide W1-W2, the angle CAB by acos, its
    side by the sign of a mixed product, and a special case for A on the guide. Near a dead centre of an inclined guide
    the sign and the special case come from different roundings of the same zero and may disagree.

    Parameters
    ----------
    A : array (2, N)
        Crank pin, m.
    coupler_length : float
        m.
    W1, W2 : (x, y)
        Points of the guide, m.
    W : (x, y)
        W1 or W2: the end of the guide the slider lies toward.

    Returns
    -------
    array (2, N)
        Slider pin B, m; NaN where the coupler does not reach the guide.
    """
    guide = np.subtract(W2, W1)[:, None]
    unit = guide / np.hypot(*guide)
    to_W1 = np.asarray(W1)[:, None] - A
    normal = unit[0] * to_W1[1] - unit[1] * to_W1[0]
    AC = np.array([-normal * unit[1], normal * unit[0]])
    distance = np.hypot(*AC)
    side = np.sign(to_W1[0] * guide[1] - to_W1[1] * guide[0])
    toward = 1.0 if tuple(W) == tuple(W2) else -1.0
    with np.errstate(invalid="ignore", divide="ignore"):
        turned = turned_to_length(AC, toward * side * np.arccos(distance / coupler_length), coupler_length)
    return A + np.where(distance == 0, toward * coupler_length * unit, turned)


def chain_unit_by_atan_acos(crank_length, coupler_length, rocker_length, pivot_x, angle):
    """Coupler and rocker angle of the chain unit by atan and acos, and their rates by the two-component formulas.

    As in the Belarusian study of the chain unit, with phi = angle - phi_0 counted from the frame line O-O2, clockwise,
    and B to the left of A-O2. The coupler angle holds only while A is left of O2, the rocker angle only while
    b - r cos(phi) > 0: beyond, atan is off by half a turn.

    Parameters
    ----------
    crank_length, coupler_length, rocker_length, pivot_x : float
        m; O2 = (pivot_x, -rocker_length).
    angle : array (N,)
        Crank angle clockwise from +y, rad.

    Returns
    -------
    gamma, psi, coupler_rate, rocker_rate : arrays (N,)
        Coupler angle below +x and rocker angle clockwise from vertical, rad; rates at crank speed 1, clockwise.
    """
    r, c, h = crank_length, coupler_length, rocker_length
    b = np.hypot(pivot_x, h)
    phi = angle - (np.pi / 2 + np.arctan(h / pivot_x))
    square = r * r + b * b - 2 * r * b * np.cos(phi)
    a = np.sqrt(square)
    to_pivot = np.arctan((r * np.cos(angle) + h) / (pivot_x - r * np.sin(angle)))
    gamma = to_pivot - np.arccos((square + c * c - h * h) / (2 * a * c))
    f5 = r * np.sin(phi) / (b - r * np.cos(phi))
    psi = -np.arctan(f5) + np.arccos((square + h * h - c * c) / (2 * a * h)) - np.arctan(pivot_x / h)

    turning = -(b * np.cos(phi) - r) / square
    p, q = square + c * c - h * h, square + h * h - c * c
    closing = b * np.sin(phi) / square
    coupler_rate = r * (turning + closing * (2 * square - p) / np.sqrt(4 * square * c * c - p * p))
    rocker_rate = r * (turning + closing * (q - 2 * square) / np.sqrt(4 * square * h * h - q * q))
    return gamma, psi, coupler_rate, rocker_rate
