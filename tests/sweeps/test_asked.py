"""What a sweep is asked for: all that is wrong is told at once, and which engines are tried."""

import sys
from dataclasses import dataclass
from types import SimpleNamespace

import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.sweeps import chunk, sweeps
from kinetostatics.sweeps.sweeps import FAILED, _type_problems
from support import factories
from support.case_files import shipped
from support.every import every
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, sweep


def test_all_that_is_wrong_is_told_at_once():
    designs = pd.DataFrame({"slider.mas [kg]": [1.0], "cam.radius [kg]": [1.0], "cam.centre.x [mm]": ["a"]})
    with pytest.raises(ks.ParameterError) as caught:
        sweep(SAW, designs, ["larges O", "harmonic_180 O"], angles=360, chunk=0, engine="fortran")
    for text in (
        "did you mean 'slider.mass'",
        '"kg" does not measure the same as "m"',
        "column 'cam.centre.x [mm]' must hold numbers",
        "did you mean 'largest O'",
        "output 'harmonic_180 O' takes more than 360 crank angles, got 360",
        "chunk must be a whole number of at least 1, got 0",
        "engine is 'fortran', allowed: 'compiled', 'numpy'",
    ):
        assert text in str(caught.value)


WRONG = {
    "a list": (factories.pump, [0.1, 0.2], OUTPUTS, {}, "designs must be a pandas DataFrame, .* got list"),
    "a client": (factories.pump, DESIGNS, OUTPUTS, {"executor": 2}, r"client.get_executor\(\)\), got int"),
    "no designs": (factories.pump, DESIGNS[:0], OUTPUTS, {}, "there are no designs"),
    "no outputs": (factories.pump, DESIGNS, [], {}, "no outputs are asked for"),
    "half an angle": (factories.pump, DESIGNS, OUTPUTS, {"angles": 1.5}, "angles must be a whole number"),
    "no reference": (factories.pump, DESIGNS, ["ratio rms O"], {}, "ratios need a reference: a Scene"),
    "other parameters": (factories.pump, DESIGNS.assign(arm=1), OUTPUTS, {}, "unexpected keyword argument 'arm'"),
    "missing parameters": (factories.pump, DESIGNS[["mass"]], OUTPUTS, {}, "missing a required argument: 'crank'"),
    "unknown unit": (
        factories.pump,
        DESIGNS.rename(columns={"mass": "mass [x]"}),
        OUTPUTS,
        {},
        'unit "x" is not known',
    ),
    "no variant": (
        lambda crank, mass: 3,
        DESIGNS,
        OUTPUTS,
        {},
        "must return a kinetostatics.Scene, got 3",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_done_is_refused(name):
    source, designs, outputs, options, message = WRONG[name]
    with pytest.raises(ks.ParameterError, match=message):
        sweep(source, designs, outputs, **options)


@pytest.mark.parametrize("name", ["rms O [N]", "failed"])
def test_column_named_like_an_output_is_refused(name):
    designs = DESIGNS[["mass"]].assign(**{name: 1.0})
    with pytest.raises(ks.ParameterError, match="of the designs has the name of an output") as caught:
        sweep(factories.pump, designs, ["rms O"])
    assert repr(name) in str(caught.value)


def engines_taken(monkeypatch):
    taken = []
    monkeypatch.setattr(sweeps, "dry_run", lambda *call: taken.append(call[2]))
    return taken


def test_many_crank_angles_are_compiled_unless_told(monkeypatch):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    taken = engines_taken(monkeypatch)
    monkeypatch.setattr(sweeps, "MIN_VALUES_COMPILED", 41 * 200)
    for options in ({}, {"engine": "numpy"}, {"angles": 199}):
        sweep(factories.pump, DESIGNS, OUTPUTS, **{"angles": 200} | options)
    monkeypatch.setitem(sys.modules, "numba", None)
    sweep(factories.pump, DESIGNS, OUTPUTS, angles=200)
    assert taken == [["compiled", "numpy"], ["numpy"], ["numpy"], ["numpy"]]
    with pytest.raises(ks.errors.MissingLibraryError, match="kinetostatics\\[fast\\]"):
        sweep(factories.pump, DESIGNS, OUTPUTS, engine="compiled")


def test_columns_of_quantities_name_their_unit():
    (problem,) = _type_problems(SimpleNamespace(dtypes={"slider.mass": SimpleNamespace(units="kilogram")}))
    assert "with the unit kilogram in its heading" in problem


# The trial of a sweep


def test_unknown_sweep_quantities_are_refused(tmp_path):
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


def test_uncompilable_sweeps_use_numpy(interpreted, monkeypatch):
    mechanism = ks.Mechanism("one-sided", ks.Crank(0.1), (OneSided(0.4, slider=ks.Link(1.0)),))
    made = lambda: ks.Scene(mechanism, 10.0)  # noqa: E731
    designs = pd.DataFrame(index=range(2))
    with pytest.raises(ks.errors.NotGivenError, match=r'must not branch on values.*use engine="numpy"'):
        sweep(made, designs, ["rms O"], engine="compiled")
    monkeypatch.setattr(sweeps, "MIN_VALUES_COMPILED", 1)
    assert sweep(made, designs, ["rms O"])[FAILED].tolist() == ["", ""]


@every("angles", [12, 13, 36, 48, 100])
def test_few_angles_are_raised_to_enough(angles):
    outputs, designs = ["largest balancing_torque", "mean_absolute A"], pd.DataFrame({"crank_speed": [2.0, 2.5]})
    options = {"variant": "idle"}
    found = sweep(shipped("shaper"), designs, outputs, angles=angles, **options)
    assert_equal(found, sweep(shipped("shaper"), designs, outputs, angles=chunk.MIN_ANGLES_PER_TURN, **options))
