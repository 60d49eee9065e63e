"""Headings of columns: name and unit, to SI, with all that is wrong."""

from kinetostatics.numbers.formatting import si_columns


def test_unit_in_round_brackets_is_corrected():
    _, problems = si_columns(["length (mm)", "size (mm)"], {"length": "m"})
    assert problems[0] == "parameter 'length (mm)' has its unit in round brackets; write 'length [mm]'"
    assert "allowed: 'length'" in problems[1]
