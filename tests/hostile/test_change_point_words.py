"""Assemblies by words where they cannot be meant: one error that says why, never a wrong branch."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

ROCKER = {"coupler_length": 2.0, "rocker_length": 1.0, "pivot": (2.0, 0.0)}
WORDS = (
    "Open",
    "OPEN",
    "open ",
    "",
    "left",
    "+1",
    "cross",
    b"open",
    0,
    2,
    1.5,
    np.nan,
    None,
    True,
    ["open"],
    ("open",),
)


@every("word", WORDS, ids=repr)
@every("group", ["rocker", "slider", "lever"])
def test_other_words_are_refused(group, word):
    make = {
        "rocker": lambda: ks.RockerGroup(**ROCKER, assembly=word),
        "slider": lambda: ks.SliderGroup(1.0, assembly=word),
        "lever": lambda: ks.LeverGroup((1.0, 0.0), assembly=word),
    }
    with pytest.raises(ks.ParameterError, match=r"assembly must be \+1 or -1, got"):
        make[group]()


@every("word", ["open", "crossed"])
@every("on", ["O", "B", "O2"])
def test_words_need_a_joint_of_the_crank(on, word):
    chain = (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ks.SliderGroup(0.5, assembly=word, on=on, pin="C", label="2"))
    with pytest.raises(ks.ParameterError, match=f"it is attached to '{on}'; give"):
        ks.Mechanism("chain", ks.Crank(0.1), chain)


MIXED = [
    {"crank_length": np.array([[1.0], [1.1]])},
    {"coupler_length": np.array([[2.0], [3.0], [2.0]])},
    {"rocker_pivot": (np.array([[2.0], [-2.0]]), 0.0)},
    {"rocker_pivot": (-np.sqrt(2.0), np.array([[1.0], [-1.0]]) * np.sqrt(2.0))},
    {"crank_length": np.array([[1.0], [2.0]]), "coupler_length": np.array([[2.0], [1.0]])},
]


@every(
    ("make", "words"),
    [
        (lambda a: ks.four_bar(a, 3 * a, 2 * a, rocker_pivot=(4.0, 0.0), assembly="open"), r"none; a \+ d = b"),
        (lambda a: ks.slotted_lever(a, pivot=(1.0, 0.0), assembly="open"), "none; a = d"),
    ],
)
def test_designs_of_another_kind_are_named(make, words):
    with pytest.raises(ks.ParameterError, match=f"must be of one kind, but these have change points {words}") as error:
        make(np.array([[1.0], [2.5], [0.3]]))
    assert error.value.designs.tolist() == [True, False, False]


@every("changes", MIXED, ids=lambda changes: "-".join(changes))
def test_batches_of_several_kinds_are_refused(changes):
    given = {"crank_length": 1.0, "coupler_length": 2.0, "rocker_length": 1.0, "rocker_pivot": (2.0, 0.0)} | changes
    with pytest.raises(ks.ParameterError, match="must be of one kind"):
        ks.four_bar(**given, assembly="open")


@every("path", ["crank_length", "coupler_length", "rocker_length", "rocker_pivot.x"])
@every("factor", [1.0 - 1e-14, 1.0 + 1e-14, 0.5, 3.0])
def test_programs_keep_the_kind_of_four_bars(path, factor):
    made = ks.four_bar(1.0, 3.0, 2.0, rocker_pivot=(4.0, 0.0), assembly="crossed", rocker=ks.Link(1.0))
    program = ks.compile(ks.Scene(made, 1.0), "balancing_torque", engine="numpy")
    with pytest.raises(ks.ParameterError, match="another kind"):
        program(0.3, {path: factor * program.parameters[path]})


def test_change_points_of_a_batch_are_refused():
    scale = np.array([[1.0], [2.5], [0.3]])
    made = ks.four_bar(scale, 3 * scale, 2 * scale, rocker_pivot=(4 * scale, 0.0), assembly="open")
    assert made.turns == 2
    assert ks.solve(made, np.linspace(0.0, 12.0, 9), crank_speed=1.0).position("B").shape == (2, 3, 9)
    with pytest.raises(ks.ParameterError, match="solve a single design"):
        _ = made.change_points


def test_linkage_without_ground_has_no_change_point():
    made = ks.four_bar(1.0, 0.5, 0.5, rocker_pivot=(0.0, 0.0), assembly="open")
    assert not made.passes


# Slotted levers


@every("word", ["open", "crossed"])
@every("on", ["O", "B", "O2"])
def test_lever_words_need_a_joint_of_the_crank(on, word):
    lever = ks.LeverGroup((0.5, 0.2), on=on, assembly=word, pivot_name="O3", label="2")
    with pytest.raises(
        ks.ParameterError, match=f"lever group: assembly '{word}' is for .* it is attached to '{on}'; give"
    ):
        ks.Mechanism("chain", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), lever))


@pytest.mark.parametrize("word", ["open", "crossed"])
def test_lever_words_refuse_a_sliding_pin(word):
    roller = ks.CamRoller(ks.cams.Circle(0.3, (0.05, 0.0)))
    with pytest.raises(ks.ParameterError, match="slides in its slot; give"):
        ks.Mechanism("chain", ks.Crank(), (roller, ks.LeverGroup((0.0, -0.6), label="2", assembly=word)))


MIXED_LEVERS = [
    {"crank_length": np.array([[1.0], [1.1]])},
    {"offset": np.array([[0.0], [1e-9]])},
    {"pivot": (np.array([[1.0], [-1.0]]), 0.0)},
    {"pivot": (0.0, np.array([[1.0], [2.0], [1.0]]))},
    {"pivot": (2.0, 0.0), "offset": np.array([[1.0], [-1.0]])},
    {"pivot": (np.array([[2.0], [0.5]]), 0.0), "offset": 0.5 * np.array([[2.0], [1.0]])},
]


@every("changes", MIXED_LEVERS, ids=repr)
def test_mixed_batches_of_levers_are_refused(changes):
    given = {"crank_length": 1.0, "pivot": (1.0, 0.0)} | changes
    with pytest.raises(ks.ParameterError, match="must be of one kind"):
        ks.slotted_lever(**given, assembly="open")


@every("path", ["crank_length", "lever_pivot.x", "slot_offset"])
@every("factor", [1.0 - 1e-14, 1.0 + 1e-14, 0.5, 3.0, -1.0])
def test_programs_keep_the_kind_of_levers(path, factor):
    made = ks.slotted_lever(1.0, pivot=(2.0, 0.0), offset=1.0, assembly="crossed", lever=ks.Link(1.0, (0.2, 0.0), 0.1))
    program = ks.compile(ks.Scene(made, 1.0), "balancing_torque", engine="numpy")
    with pytest.raises(
        ks.ParameterError, match=r"another kind|crank length must be greater|crank_length must be greater"
    ):
        program(0.3, {path: factor * program.parameters[path]})


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@pytest.mark.parametrize("length", [1e-74, 1e-12, 1e12, 1e74])
def test_levers_of_any_size_pass_their_change_point(length):
    made = ks.slotted_lever(length, pivot=(0.0, -length), assembly="open")
    solution = ks.solve(made, np.array([0.0, 1.0, 4.0]), crank_speed=1.0)
    assert made.passes
    np.testing.assert_allclose(np.hypot(*solution.placement.links["lever"].direction), 1.0, rtol=1e-15)


def test_slot_turning_with_crank_has_no_change_point():
    """The slot would turn with the crank, its block at the foot for ever."""
    made = ks.slotted_lever(1.0, pivot=(0.0, 0.0), offset=1.0, assembly="open")
    assert not made.passes


@pytest.mark.parametrize("ulps", [-9, 9, 1000])
def test_lengths_beyond_eight_ulp_keep_their_side(ulps):
    made = ks.slotted_lever(1.0 + ulps * 2.0**-52, pivot=(1.0 + (ulps < 0) * 2.0**-52, 0.0), assembly="crossed")
    assert not made.passes
