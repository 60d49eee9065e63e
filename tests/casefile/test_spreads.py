"""Tolerances in a case file, and units in it that look like slips."""

import warnings

import pytest

import kinetostatics as ks
from support.case_files import PLAIN, case_file

DOUBTFUL = [
    ('"slider.mass" = "normal 600000 kg +- 5 kg"', True),
    ('"slider.mass" = "normal 600 g +- 5 g"', True),
    ('"crank_length" = "299..301 m"', True),
    ('"coupler_length" = "normal 0 mm +- 0.5 mm"', True),
    ('"slider.mass" = "normal 590 kg +- 5 kg"', False),
    ('"slider.mass" = "0..1200 kg"', False),
    ('"slider.centre.along" = "normal 0 mm +- 5 mm"', False),
    ('"slider.centre.across" = "normal 0 mm +- 5 mm"', False),
]


@pytest.mark.parametrize(("spread", "doubted"), DOUBTFUL)
def test_tolerance_far_off_its_parameter_is_doubted(tmp_path, spread, doubted):
    path = case_file(tmp_path, f"{PLAIN}[tolerances]\n{spread}\n")
    if doubted:
        words = r"tolerances: .* but the parameter of .*; is the unit right\?"
        with pytest.warns(ks.HintWarning, match=words) as caught:
            ks.load_case(path)
        assert caught[0].filename == __file__
    else:
        ks.load_case(path)


def test_unit_slips_in_links_are_hinted_on_reading(tmp_path):
    """By file and variant, once; and as ever when it is solved."""
    path = case_file(tmp_path, PLAIN.replace('"mid-length"', '"1000 m"').replace("20.5", "0.01"))
    with pytest.warns(ks.HintWarning) as caught:
        case = ks.load_case(path)
    texts = [str(item.message) for item in caught]
    assert len(texts) == 2
    assert all(text.startswith(f"{path}: variants.plain: ") for text in texts)
    assert "the inertia of the coupler" in texts[0]
    assert "coupler.centre.along is 1000 m, 500 times the longest link" in texts[1]
    assert {item.filename for item in caught} == {__file__}
    with pytest.warns(ks.HintWarning) as caught:
        case.solve("plain", 12)
    assert len(caught) == 2


def test_balancing_spring_is_compared_by_its_number(tmp_path):
    spring = '[variants.plain.spring]\nstiffness = "balance the slider"\nfree_position = "2 m"\n'
    for unit, doubted in (("kN/m", False), ("N/m", True)):
        path = case_file(
            tmp_path, f'{PLAIN}{spring}[tolerances]\n"spring.stiffness" = "normal 674 {unit} +- 7 {unit}"\n'
        )
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ks.load_case(path)
        assert bool(caught) is doubted
