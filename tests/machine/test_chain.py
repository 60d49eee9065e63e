"""A chain is a tuple of groups, each derived from Group, that hang on what has a name."""

import pytest

import kinetostatics as ks
from support.every import every


@every(
    "groups, message",
    [
        (ks.SliderGroup(0.2), "must be a tuple of groups"),
        ((3,), "a group"),
        ((object(),), "a group"),
    ],
)
def test_what_is_no_chain_is_refused(groups, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.Mechanism("none", ks.Crank(0.05), groups)


def test_a_list_of_groups_is_taken_as_a_tuple():
    made = ks.Mechanism("pump", ks.Crank(0.05), [ks.SliderGroup(0.2)])
    assert isinstance(made.groups, tuple)
