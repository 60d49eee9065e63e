"""Which cam makes the slider follow a law: the one coupler length with which it is smooth, or why there is none.

The coupler is across the crank ray where d, how far the slider is off that ray, is largest and where it is least
(`law_cam`): a smooth cam needs a coupler as long as both.
"""

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from .law import TURN, knots_of, law_problem
from .law_cam import GRID, LawCam, Turning, across

SAME = 1e-10
"""How far the two lengths may differ, relative to them."""


def from_law(law, coupler_length=None, guide_angle=0.0, guide_offset=0.0):
    """Cam that makes the slider of a cam-balanced crank-slider follow a law exactly, of assembly +1.

    Parameters
    ----------
    law : Law
        Coordinate of the slider along the guide from the foot of O, m, by the crank angle from the guide's direction:
        from `laws`, or a function that gives position and three derivatives of a whole turn.
    coupler_length : float, optional
        m; computed unless told. A smooth cam exists for one length only.
    guide_angle : float
        Direction of the guide from +x, rad.
    guide_offset : float
        Signed distance of the guide from O along its left normal, m.

    Returns
    -------
    LawCam
        Runs in every engine, its radii computed beforehand as those of sampled cams.

    Raises
    ------
    ParameterError
        No smooth cam makes this law: the coupler would have to be of two lengths; with both, their crank angles, and
        the phase of the law that makes them one, if there is one. Or the coupler has another length, or the law leads
        the cam through O or the slider behind the roller.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.from_law(ks.laws.cosine(0.3, 2.0))
    >>> round(cam.coupler_length, 10)
    2.0219051769
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length)
    >>> round(float(ks.solve(saw, 1.0, crank_speed=30.0).slider_position), 9)  # 2 + 0.3 cos(1)
    2.162090692
    """
    values = checks.singles(
        "from_law",
        law_problem(law),
        guide_angle=(guide_angle, "rad", {}),
        guide_offset=(guide_offset, "m", {}),
        coupler_length=(1.0 if coupler_length is None else coupler_length, "m", {"low": 0.0, "strict": True}),
    )
    offset = values["guide_offset"]
    far, near = turnings(law, offset)
    if abs(far.length - near.length) > SAME * far.length:
        raise ParameterError(_of_two_lengths(law, offset, far, near))
    length = (far.length + near.length) / 2
    if coupler_length is not None and abs(values["coupler_length"] - length) > 1e-9 * length:
        raise ParameterError(
            f"from_law: a smooth cam makes this law with a coupler of {length:.10g} m only, where it is across the ray "
            f"at {_degrees(far)} and {_degrees(near)} deg from the guide, got {values['coupler_length']:.10g} m; leave "
            "coupler_length out to have it computed"
        )
    cam = LawCam(law, length, values["guide_angle"], offset, far, near)
    checks.require("from_law", *_no_cam(cam))
    return cam


def turnings(law, offset):
    """Where d is largest, and where least."""
    grid = np.unique(np.concatenate([GRID, np.mod(np.array(knots_of(law)) + np.pi, TURN) - np.pi]))
    values = across(law, offset, grid).value
    return _extreme(law, offset, grid, values, 1.0), _extreme(law, offset, grid, values, -1.0)


def _extreme(law, offset, grid, values, side):
    from scipy.optimize import brentq

    def slope(angle):
        return float(across(law, offset, np.array(angle)).first)

    place = int(np.argmax(side * values))
    angle, low, high = grid[place], grid[place - 1], grid[(place + 1) % grid.size]
    low, high = (low - TURN if low > angle else low), (high + TURN if high < angle else high)
    if slope(low) * slope(high) < 0:
        angle = brentq(slope, low, high, xtol=1e-15, rtol=1e-15)
    return Turning(float(angle), float(side * across(law, offset, np.array(angle)).value))


def phase_of(law, offset, most=np.pi / 4):
    """Least phase by which the law must come later so that one coupler length serves, rad; None up to `most`."""
    from scipy.optimize import brentq

    def excess(phase):
        far, near = turnings(lambda phi: law(phi - phase), offset)
        return far.length - near.length

    start = excess(0.0)
    for reach in most * 2.0 ** np.arange(-8, 1):
        for phase in (reach, -reach):
            if start * excess(phase) <= 0:
                return brentq(excess, *sorted((0.0, phase)), xtol=1e-16, rtol=1e-15)
    return None


def _of_two_lengths(law, offset, far, near):
    phase = phase_of(law, offset)
    remedy = "no phase of the law repairs it"
    if phase is not None:
        remedy = f"the law later by {np.degrees(phase):.4g} deg needs one only: law.shifted({phase!r})"
        if not hasattr(law, "shifted"):
            remedy = f"the law later by {np.degrees(phase):.4g} deg needs one only: lambda phi: law(phi - {phase!r})"
    return (
        f"from_law: no smooth cam makes this law: the coupler would have to be {far.length:.10g} m long at "
        f"{_degrees(far)} deg from the guide, and {near.length:.10g} m at {_degrees(near)} deg, where it is across the "
        f"ray; {remedy}"
    )


def _degrees(turning):
    return f"{np.degrees(turning.angle) % 360:.6g}"


def _no_cam(cam):
    """Why the law is no motion of a slider ahead of a roller that goes around O, as sentences."""
    radius = cam.radius(GRID + cam.guide_angle)[0]
    position = cam.law(GRID)[0]
    ahead = np.array(position - radius * np.cos(GRID))
    worst = int(np.argmin(radius))
    if not np.all(np.isfinite(radius)):
        place = int(np.argmax(~np.isfinite(radius)))
        yield f"the law has no cam at {np.degrees(GRID[place]) % 360:.4g} deg from the guide"
    elif radius[worst] <= 0:
        yield (
            f"the pitch curve must go around O, but its radius falls to {radius[worst]:.6g} m at "
            f"{np.degrees(GRID[worst]) % 360:.4g} deg from the guide; {_remedy(position)}"
        )
    elif np.min(ahead) <= 0:
        place = int(np.argmin(ahead))
        yield (
            f"the slider must stay ahead of the roller along the guide, but is {-ahead[place]:.6g} m behind it at "
            f"{np.degrees(GRID[place]) % 360:.4g} deg from the guide; move the law farther from O, or turn the guide"
        )


def _remedy(position):
    """What leads the pitch curve of a law around O: the roller, and with it the slider, is farthest on the guide."""
    farthest = GRID[int(np.argmax(position))]
    if np.cos(farthest) > 0.0 or np.ptp(position) == 0.0:
        return "move the law farther from O" if np.ptp(position) else "the law must have a stroke"
    return (
        f"the slider must be farthest near 0 deg from the guide, but is so at {np.degrees(farthest) % 360:.4g}: take "
        f"law.shifted({-float(farthest)!r})"
    )
