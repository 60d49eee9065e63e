"""Errors: one family, whose members travel to other processes whole."""

import pickle

import pytest

from kinetostatics import errors

MADE = [
    errors.ParameterError("wrong", designs=[1, 2]),
    errors.AssemblyError("does not close", ((0.1, 0.2),)),
    errors.JammingError("jams", (0.3,)),
    errors.DesignError("cannot be met", {"coupler_length": 2.0}),
    errors.DriveError("stalls", missing=3.0, crank_angle=1.0),
    errors.QuantityError("no such"),
    errors.NotGivenError("not given"),
    errors.MissingLibraryError("not installed"),
    errors.FileError("no file"),
    errors.CaseError("saw.toml", ["a", "b"]),
]


@pytest.mark.parametrize("error", MADE, ids=lambda error: type(error).__name__)
def test_an_error_is_one_of_the_family_and_travels_with_its_numbers(error):
    again = pickle.loads(pickle.dumps(error))
    assert isinstance(error, errors.KinetostaticsError)
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


def test_every_error_of_the_module_is_tried_here():
    kinds = {kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, Exception)}
    family = {kind for kind in kinds if issubclass(kind, errors.KinetostaticsError)} - {errors.KinetostaticsError}
    assert family == set(map(type, MADE))
    assert all(issubclass(kind, Warning) for kind in kinds - family - {errors.KinetostaticsError})


def test_a_hint_says_where_it_is_before_what_it_says_and_travels_with_both():
    for hint in (errors.HintWarning("saw.toml", "variants.plain", "is it in mm?"), errors.HintWarning("is it in mm?")):
        again = pickle.loads(pickle.dumps(hint))
        assert again.hint == hint.hint == "is it in mm?"
        assert str(again) == str(hint)
    assert str(errors.HintWarning("saw.toml", "variants.plain", "is it?")) == "saw.toml: variants.plain: is it?"
