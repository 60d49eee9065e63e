"""Formulas and cams as the published studies print them, each by itself."""

import numpy as np

from ...machine.cams.cams import Circle, CosineLaw


def turned_to_length(vector, angle, length):
    """TurnV: a vector turned by an angle and given a length (Kotov 2024, equation 1).

    Parameters
    ----------
    vector : array (2, N)
    angle : float or array
        Counter-clockwise, rad.
    length : float
        m.

    Returns
    -------
    array (2, N)

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> ks.papers.turned_to_length(np.array([3.0, 4.0]), np.pi / 2, 10.0).round(12)
    array([-8.,  6.])
    """
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

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> ends = (0.0, -0.02), (0.3, -0.02)
    >>> s = ks.solve(ks.crank_slider(0.038, 0.3, guide=ks.Guide.through(*ends)), [0.5, 1.0], crank_speed=1.0)
    >>> pin = ks.papers.slider_by_double_cross(s.position("A"), 0.3, *ends, ends[1])
    >>> bool(np.allclose(pin, s.position("B")))
    True
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

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> gamma, psi, *_ = ks.papers.chain_unit_by_atan_acos(0.1, 1.0, 0.5, 0.994987, np.array([0.0, 0.5]))
    >>> s = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), ks.linkage.chain_unit_angle([0.0, 0.5]), crank_speed=1.0)
    >>> bool(np.allclose(psi - psi[0], ks.linkage.rocker_angle(s), atol=1e-6))
    True
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


def four_bar_by_atan_acos(crank_length, coupler_length, rocker_length, pivot, assembly, angle):
    """Coupler and rocker of any four-bar by the formulas of `chain_unit_by_atan_acos`, and their accelerations.

    The x axis is turned into the frame line O-O2, so that f2 and f5 of the study are the same; the rates are
    differentiated once more, as the study says. All holds while b - r cos(phi) > 0.

    Parameters
    ----------
    crank_length, coupler_length, rocker_length : float
        m.
    pivot : (x, y)
        O2, m.
    assembly : +1 or -1
        +1, as in the study: B to the left of A-O2.
    angle : array (N,)
        Crank angle, rad.

    Returns
    -------
    coupler, rocker : tuple of arrays (N,)
        Direction (rad, counter-clockwise from +x), angular velocity ratio to the crank and its slope.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> coupler, rocker = ks.papers.four_bar_by_atan_acos(0.1, 1.0, 0.5, (1.0, -0.5), 1, np.array([0.5]))
    >>> s = ks.solve(ks.four_bar(0.1, 1.0, 0.5, rocker_pivot=(1.0, -0.5)), [0.5], crank_speed=1.0)
    >>> bool(np.allclose(rocker[1], s.rate("rocker")))
    True
    """
    r, b = crank_length, np.hypot(*pivot)
    frame = np.arctan2(pivot[1], pivot[0])
    phi = frame - angle
    s, c = b * np.sin(phi), b * np.cos(phi)
    square = r * r + b * b - 2 * r * c
    growth = 2 * r * s
    to_pivot = frame + np.arctan(r * np.sin(phi) / (b - r * np.cos(phi)))
    turning, closing = -(c - r) / square, s / square
    turning_slope, closing_slope = (s - turning * growth) / square, (c - closing * growth) / square

    def link(start, near, far, sense):
        p = square + near * near - far * far
        root = np.sqrt(4 * square * near * near - p * p)
        opening = (2 * square - p) / root
        opening_slope = growth * (1 - opening * (2 * near * near - p) / root) / root
        return (
            start + sense * np.arccos(p / (2 * np.sqrt(square) * near)),
            r * (turning + sense * closing * opening),
            -r * (turning_slope + sense * (closing_slope * opening + closing * opening_slope)),
        )

    return (
        link(to_pivot, coupler_length, rocker_length, assembly),
        link(to_pivot + np.pi, rocker_length, coupler_length, -assembly),
    )


class CircleAsPrinted(Circle):
    """Circle by the sawframe study's r = -a cos(phi) + sqrt(R^2 - a^2 sin^2(phi)), centre at a behind O."""

    def polar(self, angle, ray):
        x, y = self.centre
        R, a, phi = self.pitch_radius, np.hypot(x, y), angle - np.arctan2(-y, -x)
        s, c = a * np.sin(phi), a * np.cos(phi)
        square = R * R - s * s
        root = np.sqrt(square)
        return root - c, s - s * c / root, c - (R * R * (c * c - s * s) + s * s * s * s) / (square * root)


class CosineLawAsPrinted(CosineLaw):
    """Cosine law by the sawframe study's r = x_B cos(phi) - w, w = +-sqrt(l^2 - x_B^2 sin^2(phi)).

    w has the sign of cos(phi) - cos(phi*). At the singular angle phi* the radicand, a double zero, has lost half its
    digits, and the derivatives divide by it.
    """

    def polar(self, angle, ray):
        a, b, phi = self.amplitude, self.mean, angle - self.guide_angle
        singular = (np.sqrt(b * b + 8 * a * a) - b) / (4 * a)
        length = (b + a * singular) * np.sqrt(1 - singular * singular)
        s, c = np.sin(phi), np.cos(phi)
        x, x1, x2 = b + a * c, -a * s, -a * c
        z, z1, z2 = x * s, x1 * s + x * c, x2 * s + 2 * x1 * c - x * s
        w = np.sign(c - singular) * np.sqrt(length * length - z * z)
        w1 = -z * z1 / w
        w2 = -(z1 * z1 + z * z2 + w1 * w1) / w
        return x * c - w, x1 * c - x * s - w1, x2 * c - 2 * x1 * s - x * c - w2
