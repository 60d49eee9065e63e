"""The trial of a sweep: quantities, engine and crank angles are told by the first design that can be built."""

from dataclasses import dataclass

import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.sweeps import asked, job
from kinetostatics.sweeps.sweeps import FAILED
from support.case_files import shipped
from support.every import every
from support.sweeping import SAW, assert_equal, sweep


def test_unknown_quantities_of_design_and_reference_are_refused(tmp_path):
    for outputs, message in ((["rms cam_forc"], "cam_force"), (["ratio rms cam_force"], "crank-slider: quantity")):
        with pytest.raises(ks.QuantityError, match=message):
            sweep(
                SAW, ks.designs.grid({"slider.mass": "6..7 kg:2"}), outputs, variant="cam-circle", folder=tmp_path / "a"
            )
    assert not (tmp_path / "a").exists()


@dataclass(frozen=True)
class OneSided(ks.SliderGroup):
    """A group that looks at values."""

    def resolve(self, placement, loads, along):
        """The same on either side."""
        found = super().resolve(placement, loads, along)
        return found if placement.joints["A"].position[0].sum() > 0 else found._replace(scalars=dict(found.scalars))


def test_what_cannot_be_compiled_is_left_to_numpy_unless_told(interpreted, monkeypatch):
    mechanism = ks.Mechanism("one-sided", ks.Crank(0.1), (OneSided(0.4, slider=ks.Link(1.0)),))
    made = lambda: ks.Scene(mechanism, 10.0)  # noqa: E731
    designs = pd.DataFrame(index=range(2))
    with pytest.raises(ks.errors.NotGivenError, match=r'must not branch on values.*use engine="numpy"'):
        sweep(made, designs, ["rms O"], engine="compiled")
    monkeypatch.setattr(asked, "WORTH_COMPILING", 1)
    assert sweep(made, designs, ["rms O"])[FAILED].tolist() == ["", ""]


@every("angles", [12, 13, 36, 48, 100])
def test_few_crank_angles_a_turn_are_as_many_as_tell_its_numbers(angles):
    outputs, designs = ["largest balancing_torque", "mean_absolute A"], pd.DataFrame({"crank_speed": [2.0, 2.5]})
    options = {"variant": "idle"}
    found = sweep(shipped("shaper"), designs, outputs, angles=angles, **options)
    assert_equal(found, sweep(shipped("shaper"), designs, outputs, angles=job.LEAST, **options))
