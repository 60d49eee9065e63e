"""What designs may vary in a case: paths as in scenes, with what the file derives following."""

import numpy as np
import pytest

import kinetostatics as ks
from support.case_chains import EXAMPLES, IN_PYTHON


@pytest.mark.parametrize("name", IN_PYTHON)
def test_numbers_of_a_chain_are_called_as_in_scenes_and_vary_as_there(name):
    """But for what the file derives of others: centres at mid-length, a spring that balances, a law's guide."""
    case = ks.load_case(EXAMPLES / f"{name}.toml")
    variant = case.variant(case.reference)
    scene, derived = variant.scene, {path for path, value in variant.parameters.items() if not isinstance(value, float)}
    units = variant.units
    absent = {path for path in units if variant.parameters[path] is None} - scene.units.keys()
    assert absent <= {"crank_length"}
    assert {path for path in units if path.rpartition(".")[2] != "centre"} - absent <= scene.units.keys()
    for path in units.keys() - derived - {"crank_length"}:
        assert units[path] == scene.units[path].replace("**", "^").replace("*", " "), path
        assert variant.parameters[path] == scene.parameters[path], path
        follows = path.startswith(("coupler_length", "rocker_length", "dyad")) or path in ("crank_speed", "slider.mass")
        if not follows and not path.startswith("guide"):
            value = variant.parameters[path] * 1.001
            assert variant.varied({path: value}).scene.parameters == scene.varied({path: value}).parameters, path


def test_centres_at_mid_length_follow_lengths_that_vary():
    variant = ks.load_case(EXAMPLES / "dyad.toml").variant("watt")
    lengths = np.array([[0.35], [0.36]])
    varied = variant.varied({"dyad1_lengthW": lengths}).scene.parameters
    np.testing.assert_array_equal(varied["dyad1W.centre.along"], lengths / 2)
    assert varied["dyad2W.centre.along"] == 0.15


def test_a_varied_variant_keeps_what_it_read_from_files():
    variant = ks.load_case(EXAMPLES / "slider.toml").variant("plain")
    assert [path.name for path in variant.files] == ["indicator.csv"]
    (before,) = (item for item in variant.loads if isinstance(item, ks.ProcessForce))
    (after,) = (item for item in variant.varied({"slider.mass": 1.0}).loads if isinstance(item, ks.ProcessForce))
    assert after.force is before.force
