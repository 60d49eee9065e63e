"""What groups declare of slots and cams is how they place their links, at every crank angle."""

import numpy as np
import pytest

import kinetostatics as ks
from support import followers

TURN = np.linspace(0.0, 6.0, 7)
SLOTTED = {
    "lever": ks.LeverGroup((0.0, -0.3), offset=0.02),
    "lever, other way": ks.LeverGroup((0.0, -0.3), offset=-0.03, assembly=-1),
    "cylinder": ks.CylinderGroup((0.4, 0.1)),
    "yoke": ks.YokeGroup(ks.Guide.at(0.3, 0.02), 1.2),
}


@pytest.mark.parametrize("name", SLOTTED)
def test_joint_of_a_slot_lies_on_its_line(name):
    s = ks.solve(ks.Mechanism(name, ks.Crank(0.1), (SLOTTED[name],)), TURN, crank_speed=1.0)
    (slot,) = s.mechanism.slots
    link = s.placement.links[slot.link]
    ray = np.exp(1j * slot.angle) * (link.direction[0] + 1j * link.direction[1])
    apart = [end - start for end, start in zip(s.position(slot.joint), link.joint.position, strict=True)]
    across = np.imag(np.conj(ray) * (apart[0] + 1j * apart[1]))
    np.testing.assert_allclose(across, slot.offset, atol=1e-15)


@pytest.mark.parametrize("kind", followers.KINDS)
def test_cam_declares_the_link_it_leads_the_joint_it_meets_and_its_force(kind):
    mechanism = followers.scene(followers.KINDS[kind]()).mechanism
    (led,) = (led for group in mechanism.groups for led in group.led)
    assert led.flat == kind.startswith("flat")
    assert (led.body, mechanism.joints[led.joint].link) == ("crank", led.link)
    assert mechanism.outputs[led.force].unit == "N"


def test_cam_of_a_roller_on_the_crank_is_fixed_to_the_frame():
    (led,) = ks.CamRoller(ks.cams.Circle(0.3)).led
    assert (led.link, led.joint, led.body, led.force, led.flat) == ("block", "A", "frame", "cam_force", False)
