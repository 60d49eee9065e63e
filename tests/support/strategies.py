"""Random mechanisms, bodies and numbers for hypothesis, and how results are compared with an oracle's."""

import numpy as np
from hypothesis import Phase, assume, settings
from hypothesis import strategies as st

import kinetostatics as ks

from .machines import BARS, TORQUES, FourBar
from .multibody import Body, CrankSlider, pin_by_cosine_law, pin_on_circle, pin_on_crank

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


@st.composite
def cases(draw, kind):
    """A scene, and the same thing solved by the package at three crank angles."""
    size, guide_angle, guide_offset, assembly = draw(number(0.1, 1.0)), draw(number(-3.1, 3.1)), 0.0, 1
    if kind == "cosine law":
        driver = ks.cams.CosineLaw(size, size * draw(number(1.2, 8.0)), guide_angle)
        pin, coupler_length = pin_by_cosine_law(driver.amplitude, driver.mean, guide_angle), driver.coupler_length
    else:
        guide_offset, assembly = size * draw(either_sign(0.01, 1.5)), draw(st.sampled_from((-1, 1)))
        if kind == "circle":
            centre = tuple(size * draw(either_sign(0.01, 0.4)) for _ in "xy")
            driver, pin, reach = ks.cams.Circle(size, centre), pin_on_circle(size, centre), size + np.hypot(*centre)
        else:
            driver, pin, reach = size, pin_on_crank(size), size
        coupler_length = (reach + abs(guide_offset)) * draw(number(1.15, 5.0))
    names = ["crank", "coupler", "slider"] + (["block"] if kind != "plain" else [])
    stiffness, free, process = draw(number(1.0, 1e4)), draw(number(-2.0, 2.0)), draw(either_sign(1.0, 1e3))
    scene = CrankSlider(
        pin=pin,
        has_cam=kind != "plain",
        coupler_length=coupler_length,
        guide_angle=guide_angle,
        guide_offset=guide_offset,
        assembly=assembly,
        bodies={name: draw(body(size)) for name in names},
        speed=draw(either_sign(0.1, 50.0)),
        acceleration=draw(either_sign(0.1, 500.0)),
        gravity=(draw(number(1.0, 20.0)), draw(number(-3.1, 3.1))),
        push=lambda coordinate: process - stiffness * (coordinate - free),
    )
    solution = ks.solve(
        (ks.crank_slider if kind == "plain" else ks.cam_crank_slider)(
            driver,
            coupler_length,
            guide_angle=guide_angle,
            guide_offset=guide_offset,
            assembly=assembly,
            **{name: ks.Link(b.mass, b.centre, b.inertia) for name, b in scene.bodies.items()},
        ),
        np.array([draw(number(0.0, 6.28)) for _ in range(3)]),
        crank_speed=scene.speed,
        crank_acceleration=scene.acceleration,
        loads=[ks.Gravity(*scene.gravity), ks.Spring(stiffness, free), ks.ProcessForce(process)],
    )
    return scene, solution


def errors(found, expected, scale=None):
    """Error of each quantity by name, relative to the largest of all or to a given scale."""
    scale = max(np.max(np.abs(values)) for values in expected.values()) if scale is None else scale
    return {name: float(np.max(np.abs(found[name] - expected[name])) / scale) for name in expected}


def columns(tables, names):
    return {name: np.array([table[name] for table in tables]) for name in names}


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
