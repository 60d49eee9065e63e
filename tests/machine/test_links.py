"""Links, guides and friction of joints."""

import re

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.machine import friction, links
from kinetostatics.machine.links import Joint, LinkMotion
from kinetostatics.numbers.parameter_tree import Axis
from support.every import every

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


# The straight guide


@every("angle", [0.0, 0.7, -2.5, np.pi / 2])
@every("offset", [0.0, -0.3])
def test_two_points_on_a_guide_make_the_same_guide(angle, offset):
    along, left = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    made = ks.Guide.through(*(tuple(offset * left + s * along) for s in (-0.4, 1.1)))
    given = ks.Guide.at(angle, offset)
    assert made.direction == pytest.approx(given.direction, abs=1e-15)
    assert made.guide_offset == pytest.approx(offset, abs=1e-15)
    assert made.guide_angle == pytest.approx(angle, abs=1e-15)


def test_a_level_guide_is_known_by_plain_numbers_only():
    assert ks.Guide.at(0.0, 0.2).is_level
    assert ks.Guide.through((0.0, 1.0), (3.0, 1.0)).is_level
    assert not ks.Guide.at(np.pi).is_level
    assert not ks.Guide.at(np.zeros((2, 1))).is_level
    assert ks.Guide.at(0.0).line == (None, None)


def test_coincident_points_make_no_guide():
    with pytest.raises(ks.ParameterError, match="W1 and W2 coincide"):
        ks.Guide.through((1.0, 2.0), (1.0, 2.0))
    with pytest.raises(ks.ParameterError, match="W2 must be one point, not a batch"):
        ks.Guide.through((0.0, 0.0), (np.ones((2, 1)), 1.0))
    with pytest.raises(ks.ParameterError, match="direction must have length 1"):
        ks.Guide(None, 0.0, (1.0, 1.0))


def nested(structure):
    """All that a structure is made of."""
    yield structure
    if isinstance(structure, tuple) and not isinstance(structure, Axis):
        for part in structure:
            yield from nested(part)


@every("end", [(0.0, 2.0), (0.0, -2.0), (-2.0, 0.0), (2.0, 0.0), (1.0, 2.0)])
def test_guide_along_an_axis_has_it_in_its_structure(end):
    saw = ks.crank_slider(0.1, 3.0, guide=ks.Guide.through((0.0, 0.0), end), slider=ks.Link(1.0))
    s = ks.solve(saw, np.linspace(0, 6, 50), crank_speed=3.0)
    structure, leaves = s.apart
    along = 0.0 in end
    assert [part for part in nested(structure) if isinstance(part, Axis)] == (
        [saw.groups[0].guide.exact] if along else []
    )
    assert len(leaves.numbers) == (4 if along else 6)
    plain = ks.solve(
        ks.crank_slider(0.1, 3.0, guide_angle=saw.groups[0].guide.guide_angle, slider=ks.Link(1.0)),
        s.crank_angle,
        crank_speed=3.0,
    )
    np.testing.assert_allclose(s.balancing_torque, plain.balancing_torque, rtol=0, atol=1e-14)


def two_guides():
    groups = (
        ks.SliderGroup(0.4, guide=ks.Guide.at(0.0)),
        ks.SliderGroup(0.5, guide=ks.Guide.through((1.0, 0.2), (2.0, 0.25)), on="A", pin="C", label="2"),
    )
    return ks.Scene(ks.Mechanism("two", ks.Crank(0.1), groups), 10.0)


@every(
    "ask",
    [
        lambda scene: scene.varied({"guide_angle2": 0.1}),
        lambda scene: ks.compile(scene, "C", parameters="guide_angle2", engine="numpy"),
        lambda scene: ks.compile(scene, "C", engine="numpy")(0.3, {"guide_angle2": 0.1}),
        lambda scene: ks.compile(scene, "C", engine="numpy").derivatives(0.3, "guide_angle2"),
        lambda scene: scene.solve(12).uncertainty("C", {"guide_angle2": 1e-4}),
        lambda scene: ks.sweep(scene, pd.DataFrame({"guide_angle2 [deg]": [1.0]}), ["largest C"], progress=False),
    ],
)
def test_changing_a_guide_by_points_gives_advice(ask):
    with pytest.raises(ks.ParameterError) as raised:
        ask(two_guides())
    told = str(raised.value)
    assert "parameter guide_angle2 has no number here, as the guide runs through two points" in told
    assert told.endswith("to change its angle; its neighbours are guide_offset2, exact2.x, exact2.y")
    angle, offset = map(float, re.search(r"make it by Guide.at\((.*), (.*)\)", told).groups())
    same = ks.Guide.at(angle, offset)
    guide = two_guides().mechanism.guides["slider2"]
    assert (*same.direction, same.guide_offset) == pytest.approx((*guide.direction, guide.guide_offset))


def test_what_has_no_number_is_told_beside_what_has():
    scene = ks.Scene(ks.crank_slider(0.1, 0.4), 10.0, friction={"guide": ks.GuideFriction(0.1)})
    with pytest.raises(
        ks.ParameterError, match=r"half_length has no number here; its neighbours are friction\.guide\.mu"
    ):
        scene.varied({"friction.guide.half_length": 0.1})


# Friction by joint

SAW = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.0)
LEVER = ks.slotted_lever(0.1, pivot=(0.0, -0.3))


@every(
    "mechanism, joint, kind",
    [
        (SAW, "O", ks.PinFriction),
        (SAW, "B", ks.PinFriction),
        (SAW, "guide", ks.GuideFriction),
        (SAW, "cam", ks.RollerFriction),
        (LEVER, "slot", ks.SlotFriction),
    ],
)
def test_each_pair_has_its_kind(mechanism, joint, kind):
    (name,) = (name for name in mechanism.pairs if name == joint or name.startswith(f"{joint}_"))
    assert friction.friction_kind(mechanism.pairs[name]) is kind


def test_mapping_keeps_joints_without_friction():
    given = {"O": ks.PinFriction(0.1, 0.02), "guide": ks.GuideFriction(0.0)}
    kept = friction.frictions_by_joint(given)
    assert dict(kept) == given
    assert list(kept.acting) == ["O"]
    assert friction.frictions_by_joint(kept) is kept
    assert friction.frictions_by_joint({}) is friction.NO_FRICTION
    with pytest.raises(KeyError):
        kept["A"]
