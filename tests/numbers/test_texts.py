"""Names in one Unicode form, and files whose names are written in another."""

import pytest

from kinetostatics.numbers.texts import normal, on_disk

ONE, APART = "s\u00e4ge", "sa\u0308ge"


def test_both_forms_of_a_name_are_one():
    assert normal(ONE) == normal(APART) == ONE
    assert normal(3) == 3


@pytest.mark.parametrize(("there", "asked"), [(ONE, APART), (APART, ONE), (ONE, ONE), (APART, APART)])
def test_a_file_is_found_whatever_form_its_name_has(tmp_path, there, asked):
    (tmp_path / there).write_text("x")
    assert on_disk(tmp_path / asked).read_text() == "x"


def test_of_two_forms_the_one_that_is_asked_for_is_taken(tmp_path):
    for name in (ONE, APART):
        (tmp_path / name).write_text(name)
    if len(list(tmp_path.iterdir())) == 2:  # not where the disk has one form alone
        assert [on_disk(tmp_path / name).read_text() for name in (ONE, APART)] == [ONE, APART]


def test_what_is_not_there_stays_as_it_is(tmp_path):
    assert on_disk(tmp_path / ONE) == tmp_path / ONE
    assert on_disk(tmp_path / "none" / ONE) == tmp_path / "none" / ONE
