"""Random mechanisms, bodies and numbers for hypothesis, and how results are compared with an oracle's."""

import numpy as np
from hypothesis import Phase, assume, settings
from hypothesis import strategies as st

from .machines import BARS, TORQUES, FourBar
from .multibody import Body

reproducible = settings(
    derandomize=True, database=None, deadline=None, max_examples=10, phases=[Phase.explicit, Phase.generate]
)


def number(low, high):
    return st.floats(low, high, allow_nan=False)


def either_sign(low, high):
    return st.builds(lambda sign, size: sign * size, st.sampled_from((-1, 1)), number(low, high))


def body(size):
    offset = either_sign(0.01 * size, size)
    return st.builds(Body, number(0.1, 100.0), st.tuples(offset, offset), number(0.01, 10.0))


def between(low, high, share):
    return low + share * (high - low)


@st.composite
def four_bars(draw, kind):
    """A four-bar of a kind with mass everywhere, and crank angles at which it closes with room."""
    size, share, turned = draw(number(0.1, 1.0)), draw(number(0.1, 0.9)), draw(number(-3.1, 3.1))
    angles = np.array([draw(number(0.0, 6.28)) for _ in range(3)])
    if kind == "non-Grashof":
        angles = angles[:1]
        r, b = size, size * draw(number(0.4, 2.5))
        a = abs(b - r * np.exp(1j * angles[0]))
        assume(a > 0.1 * r)
        c = a * draw(number(0.4, 2.5))
        h = between(abs(a - c), a + c, share)
        lengths = sorted((r, c, h, b))
        assume(lengths[0] + lengths[3] > lengths[1] + lengths[2])
    else:
        c, h = size * draw(number(1.4, 5.0)), size * draw(number(1.4, 5.0))
        other = between(abs(c - h) + size, c + h - size, share)
        r, b = (size, other) if kind == "crank-rocker" else (other, size)
    bar = FourBar(
        crank=r,
        coupler=c,
        rocker=h,
        pivot=complex(b * np.exp(1j * turned)),
        assembly=draw(st.sampled_from((-1, 1))),
        links={name: draw(body(size)) for name in BARS},
        gravity=(draw(number(1.0, 20.0)), draw(number(-3.1, 3.1))),
        speed=draw(either_sign(0.1, 50.0)),
        acceleration=draw(either_sign(0.1, 500.0)),
    )
    return bar, angles + turned


def dimension(name):
    """Power of the length a force or moment grows with, besides mass."""
    return 2 if name.endswith("moment") or name in TORQUES else 1
