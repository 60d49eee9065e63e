"""Friction by joint: which kind belongs to which pair, and what a mapping of it keeps."""

import pytest

import kinetostatics as ks
from kinetostatics.machine import friction

SAW = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.0)
LEVER = ks.slotted_lever(0.1, pivot=(0.0, -0.3))


@pytest.mark.parametrize(
    ("mechanism", "joint", "kind"),
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
