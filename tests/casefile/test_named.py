"""Names of variants and designs that a case has not."""

import copy
import pickle

import pytest

import kinetostatics as ks
from kinetostatics.casefile.named import NoSuchNameError
from support.case_files import shipped
from support.every import every

CASE = shipped("sawframe_2r63")


@every(
    "ask",
    [
        lambda case: case.variants["plane"],
        lambda case: case.variant("plane"),
        lambda case: pickle.loads(pickle.dumps(case)).variants["plane"],
        lambda case: copy.deepcopy(case).variants["plane"],
    ],
)
def test_a_variant_that_is_not_there_is_an_error_of_the_case_with_the_nearest_name(ask):
    with pytest.raises(
        ks.CaseError, match=r"sawframe_2r63.toml: 1 problem\n  variant is 'plane'.*mean 'plain'\?"
    ) as raised:
        ask(CASE)
    assert isinstance(raised.value, KeyError)
    again = pickle.loads(pickle.dumps(raised.value))
    assert (type(again), str(again)) == (NoSuchNameError, str(raised.value))


def test_a_design_that_is_not_there_is_told_so_too():
    with pytest.raises(ks.CaseError, match=r"design is 'x', allowed: none"):
        CASE.designs["x"]


def test_whoever_asks_whether_there_is_a_variant_gets_an_answer():
    assert CASE.variants.get("plane") is None
    assert "plane" not in CASE.variants
    assert list(CASE.variants) == ["plain", "cam-circle", "cam-cosine"]


@every("name", [None, 3, ("plain",)], ids=repr)
def test_what_is_no_name_is_refused_as_one(name):
    with pytest.raises(ks.CaseError, match="variant is"):
        CASE.variant(name)
