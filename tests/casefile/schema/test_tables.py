"""Tables within a variant."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.case_files import PLAIN, case_file, problems


def test_a_cam_of_a_kind_that_is_not_there_is_told_the_nearest(tmp_path):
    text = PLAIN + '[variants.cam]\nmechanism = "cam-crank-slider"\ncoupler_length = "2 m"\ncam = { kind = "cirkle" }\n'
    kind, radius = problems(tmp_path, text)
    assert kind.startswith("variants.cam.cam.kind is 'cirkle'")
    assert "did you mean 'circle'?" in kind
    assert radius == "variants.cam.cam.radius is missing"


ROLLED = (
    PLAIN
    + """[variants.cam]
mechanism = "cam-crank-slider"
cam = { kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }
slider = { mass = "600 kg" }
roller = { radius = "50 mm", width = "60 mm", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }
"""
)


def test_a_roller_with_units_makes_the_pressure_an_output(tmp_path):
    case = ks.load_case(case_file(tmp_path, ROLLED))
    variant = case.variant("cam")
    assert variant.units["roller.width"] == "m"
    assert variant.units["roller.youngs_modulus"] == "Pa"
    solution = variant.solve(36)
    expected = ks.design.contact(solution, 0.05, 0.06, 210e9, 0.3).pressure
    assert_allclose(solution.contact_pressure, expected, rtol=1e-13)
    table = ks.sweep(
        case,
        ks.designs.grid({"roller.width": "30..60 mm:2"}),
        ["largest contact_pressure"],
        variant="cam",
        progress=False,
    )
    narrow, wide = table["largest contact_pressure [Pa]"]
    assert_allclose(narrow / wide, np.sqrt(2.0), rtol=1e-12)


@pytest.mark.parametrize(
    ("good", "bad", "message"),
    [
        ("poissons_ratio = 0.3", "poissons_ratio = 0.7", "poissons_ratio: input should be less than or equal to 0.5"),
        ("poissons_ratio = 0.3", 'poissons_ratio = "0.3"', "poissons_ratio: input should be a valid number"),
        (
            'youngs_modulus = "210 GPa"',
            'youngs_modulus = "210 mm"',
            'youngs_modulus "mm" does not measure the same as "Pa"',
        ),
        ('width = "60 mm", ', "", "width is missing"),
        ('radius = "50 mm"', 'radius = "3 m"', "undercuts the side of its cam"),
    ],
)
def test_what_is_wrong_with_a_roller_is_told_with_its_key(tmp_path, good, bad, message):
    (told,) = problems(
        tmp_path, ROLLED.replace(good, bad) + 'spring = { stiffness = "1.5 MN/m", free_position = "2 m" }\n'
    )
    assert told.startswith("variants.cam")
    assert message in told
