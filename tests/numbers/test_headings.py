"""Headings of columns: name and unit, to SI, with all that is wrong."""

import pytest

from kinetostatics.numbers.formatting import heading, parted, si_columns


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("slider.mass [kg]", ("slider.mass", "kg")),
        (" force[ N m ]", ("force", "N m")),
        ("angle", ("angle", "")),
        (7, ("7", "")),
    ],
)
def test_a_heading_is_parted_into_name_and_unit(text, expected):
    assert parted(text) == expected


def test_what_is_parted_makes_the_same_heading_again():
    assert parted(heading("O_x", "N")) == ("O_x", "N")


def test_columns_have_factors_to_si_and_si_where_no_unit_is_told():
    columns, problems = si_columns(["spring.stiffness [kN/m]", "slider.mass"])
    assert columns == (("spring.stiffness [kN/m]", "spring.stiffness", 1000.0), ("slider.mass", "slider.mass", 1.0))
    assert problems == []


def test_unknown_double_and_unlike_columns_are_all_told():
    _, problems = si_columns(["mas [kg]", "mass [mm]", "mass"], {"mass": "kg"})
    assert [part in text for part, text in zip(("'mas'", "'mass [mm]'", "two columns"), problems, strict=True)] == [
        True
    ] * 3


def test_a_unit_in_round_brackets_is_told_to_stand_in_square_ones():
    _, problems = si_columns(["length (mm)", "size (mm)"], {"length": "m"})
    assert problems[0] == "parameter 'length (mm)' has its unit in round brackets; write 'length [mm]'"
    assert "allowed: 'length'" in problems[1]
