"""A rigid link: motion of its points by complex numbers, and inertia and weight as d'Alembert has them."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine import links
from kinetostatics.machine.links import Joint, LinkMotion

ANGLE, RATIO, SLOPE = 0.6, -0.8, 0.35
ALONG, ACROSS = 0.4, -0.15
JOINT = Joint((0.2, 0.1), (0.5, -0.3), (-0.7, 0.9))
LINK = LinkMotion(JOINT, (np.cos(ANGLE), np.sin(ANGLE)), RATIO, SLOPE)
SPEED, ACCELERATION = 7.0, -11.0


def z(vector):
    return complex(*vector)


ARM = complex(ALONG, ACROSS) * np.exp(1j * ANGLE)


def test_load_is_weight_less_inertia_at_the_joint():
    body = ks.Link(3.0, (ALONG, ACROSS), 0.2).body
    found = links.load(LINK, body, SPEED**2, ACCELERATION, (0.0, -9.81))
    centre = (z(JOINT.second) + (1j * SLOPE - RATIO**2) * ARM) * SPEED**2
    centre += (z(JOINT.first) + 1j * RATIO * ARM) * ACCELERATION
    force = 3.0 * (-9.81j - centre)
    turning = 0.2 * (SLOPE * SPEED**2 + RATIO * ACCELERATION)
    assert z(found.force) == pytest.approx(force, rel=1e-14)
    assert found.moment == pytest.approx((ARM.conjugate() * force).imag - turning, rel=1e-14)
    work = (force * z(JOINT.first).conjugate()).real + found.moment * RATIO
    assert links.virtual_work(LINK, found) == pytest.approx(work, rel=1e-14)


def test_fast_spin_keeps_the_moment_exact():
    """The pull of its mass centre, 1e16 times as large, goes through its reference joint."""
    body = links.Body(2.0, ALONG, ACROSS, 0.3)
    spinning = LINK._replace(ratio=1e8)
    arm = links.arm(LINK.direction, ALONG, ACROSS)
    slow, fast = (links.load(link, body, SPEED**2, None, (0.0, -9.81)) for link in (LINK._replace(ratio=0.0), spinning))
    assert fast.moment == slow.moment
    assert z(fast.force) == pytest.approx(2.0 * SPEED**2 * 1e16 * z(arm), rel=1e-14)
