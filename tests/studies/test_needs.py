"""How much model a scene needs: known answers, every combination tried, and the smallest model run again here."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.program import program_of
from kinetostatics.studies import needs as ingredients
from kinetostatics.studies import simplifications
from support.case_files import shipped
from support.studied import MECHANISMS, SPEED, TURN, alone, change, cranked, solved

pytestmark = pytest.mark.slow


def operations(solution, quantity):
    """Number of operations of a quantity at each crank angle, as recorded."""
    program, _ = program_of(solution.dynamics, (quantity,))
    return program.recording.operations


@pytest.fixture
def few_models(monkeypatch):
    """Of combinations, for tests of simplifications alone."""
    monkeypatch.setattr(ingredients, "MAX_MODELS", 10)


@pytest.fixture(scope="module")
def saw():
    case = ks.load_case("sawframe_2r63")
    return {name: case.solve(name, 72) for name in case.variants}


@pytest.fixture(scope="module")
def mower():
    return shipped("mower_drive").solve("unbalanced", 72)


# Known answers


def test_massless_crank_is_free_for_torque_alone(mower):
    """There is no gravity, and the crank only turns: the pull of its mass has no moment, and costs nothing as it is."""
    torque, bearing = (ks.needs(mower, quantity) for quantity in ("balancing_torque", "O"))
    assert alone(torque)["massless crank"].error < 1e-16
    assert torque.smallest.simplifications == ("massless crank",)
    assert torque.smallest.operations == torque.full.operations
    assert bearing.full.operations > torque.full.operations
    centrifugal = 1.0 * 0.019 * (600 * 2 * np.pi / 60) ** 2 / np.max(np.hypot(*mower.reaction("O")))
    assert alone(bearing)["massless crank"].error == pytest.approx(centrifugal, rel=1e-12)
    assert "massless crank" not in bearing.smallest.simplifications


@pytest.mark.parametrize("quantity", ["balancing_torque", "O"])
def test_cancelling_spring_and_slider_go_together(saw, quantity):
    needs = ks.needs(saw["cam-cosine"], quantity, within=1e-13)
    assert needs.smallest.simplifications == ("no spring", "massless slider")
    assert 1e-16 < needs.smallest.error < 1e-13
    assert min(alone(needs)[name].error for name in needs.smallest.simplifications) > 5


def test_thirteen_digits_need_the_whole_model(saw):
    needs = ks.needs(saw["plain"], "balancing_torque", within=1e-13)
    assert needs.smallest.name == "full scene"
    assert needs.smallest is needs.ladder[0]
    assert min(made.error for made in needs.alone) > 1e-3


def test_useless_ingredient_is_dropped(saw):
    """A process force that is zero throughout, as a function that costs operations."""
    plain = saw["plain"]
    idle = ks.ProcessForce(lambda motion: 0.0 * motion.travel())
    scene = ks.solve(plain.mechanism, TURN, crank_speed=plain.crank_speed, loads=[*plain.loads, idle])
    needs = ks.needs(scene, "balancing_torque", within=1e-13)
    assert needs.smallest.simplifications == ("no process force",)
    assert needs.smallest.error == 0.0
    assert needs.full.name == "full scene"
    assert needs.full.operations == operations(scene, "balancing_torque") > needs.smallest.operations


def test_open_simplification_is_no_model():
    """The crank is longer than the coupler, which reaches the guide at these angles only because of its offset."""
    angle = np.pi / 2 + np.linspace(-0.1, 0.1, 9)
    mechanism = ks.crank_slider(0.3, 0.25, guide_offset=0.2, slider=ks.Link(5.0), coupler=ks.Link(4.0, 0.1))
    needs = ks.needs(solved(mechanism, angle=angle), "O", within=1e9)
    assert alone(needs)["guide through O"].error == np.inf
    assert not {"one harmonic", "two harmonics"} & set(alone(needs))
    assert "guide through O" not in needs.smallest.simplifications


# The smallest of all


@pytest.mark.parametrize(
    ("quantity", "within"), [("O", 1e-13), ("balancing_torque", 0.01), ("O", 0.05), ("slider_acceleration", 0.3)]
)
def test_smallest_model_keeps_the_tolerance(saw, quantity, within):
    for scene in (saw["plain"], saw["cam-cosine"]):
        needs = ks.needs(scene, quantity, within)
        found = change(needs.smallest.solution.at(TURN), scene.at(TURN), quantity)
        assert found <= within
        assert found == pytest.approx(needs.smallest.error, rel=1e-9, abs=1e-15)
        assert needs.smallest.operations == operations(needs.smallest.solution, quantity)


@pytest.mark.parametrize("quantity", ["balancing_torque", "O"])
def test_no_cheaper_combination_fits(mower, quantity):
    """All combinations, each made and run here."""
    needs, models = ks.needs(mower, quantity, 0.05), [mower]
    for choices in simplifications.ingredients(mower.mechanism).values():
        models += [made for model in models for choice in choices if (made := choice.simplify(model)) is not None]
    found = [(operations(made, quantity), change(made, mower, quantity)) for made in models]
    assert len(found) == needs.tried
    assert min(operations for operations, error in found if error <= 0.05) == needs.smallest.operations
    for rung in needs.ladder:
        assert min(operations for operations, error in found if error <= rung.error * (1 + 1e-9)) == rung.operations


def test_ladder_falls_in_operations(saw):
    for scene, within in (("plain", 1e-3), ("plain", 0.5), ("cam-circle", 0.05)):
        needs = ks.needs(saw[scene], "balancing_torque", within)
        errors, operations = ([getattr(made, name) for made in needs.ladder] for name in ("error", "operations"))
        assert errors == sorted(set(errors))
        assert operations == sorted(set(operations), reverse=True)
        last = [made for made in needs.ladder if made.error <= within][-1]
        assert needs.smallest.operations == last.operations
        assert len(needs.smallest.simplifications) >= len(last.simplifications)
        assert (needs.ladder[0].name, needs.ladder[0].error) == ("full scene", 0.0)
        assert all(made.operations < needs.full.operations for made in needs.ladder[1:])


def test_too_many_models_drop_what_changes_most(saw, monkeypatch):
    everything = ks.needs(saw["plain"], "balancing_torque")
    monkeypatch.setattr(ingredients, "MAX_MODELS", 10)
    few = ks.needs(saw["plain"], "balancing_torque")
    assert everything.tried == 48
    assert few.tried <= 10
    assert len(few.alone) == len(everything.alone)
    worst = max(everything.alone, key=lambda made: made.error).name
    assert not any(worst in made.simplifications for made in few.ladder)
    assert few.smallest.name == everything.smallest.name


def test_six_bar_runs_a_limited_number_of_models(monkeypatch):
    """Its combinations would be tens of thousands."""
    bar = MECHANISMS["four-bar"]
    ram = ks.SliderGroup(1.5, ks.Guide.at(0.0, 0.2), on="B", pin="C", label="2", slider=ks.Link(2.0))
    loads = (
        ks.Gravity(),
        ks.Spring(50.0, 2.0, on="slider2"),
        ks.ProcessForce(-900.0, on="slider2"),
        ks.Force(300.0, at="B"),
        ks.Torque(20.0, on="rocker"),
        ks.PointSpring(30.0, between=("B", (0.5, 1.0))),
        ks.PointDamper(5.0, between=("A", (0.5, 1.0))),
        ks.TorsionDamper(2.0, on="rocker"),
    )
    s = solved(ks.Mechanism("six-bar", bar.crank, (*bar.groups, ram)), loads, angle=TURN[::3])
    assert ingredients.MAX_MODELS <= 2000
    monkeypatch.setattr(ingredients, "MAX_MODELS", 40)
    found = ks.needs(s, "balancing_torque")
    assert found.tried <= 40
    assert found.smallest.error <= 0.01
    told = {name for name, why in found.left_out.items() if why.endswith("more than 40 models")}
    kept = {name for model in found.ladder for name in model.simplifications}
    assert told
    assert not told & kept
    assert min(made.error for made in found.alone if made.name in told) >= max(
        (made.error for made in found.alone if made.name in kept), default=0.0
    )


@pytest.mark.parametrize("progress", [True, False])
def test_progress_bar_is_optional(mower, monkeypatch, capsys, progress):
    monkeypatch.setattr(ingredients, "PROGRESS_DELAY", 0.0)
    tried = ks.needs(mower, "balancing_torque", progress=progress).tried
    assert (f"/{tried} " in capsys.readouterr().err) == progress


# What it gives


def test_case_needs_use_the_chosen_variant(few_models):
    case = ks.load_case("sawframe_2r63")
    for variant, name in ((None, "plain"), ("cam-circle", "cam-circle")):
        by_case, by_solution = ks.needs(case, "O", variant=variant), ks.needs(case.solve(name), "O")
        for one, two in zip(by_case.ladder, by_solution.ladder, strict=True):
            assert (one.name, one.error, one.operations) == (two.name, two.error, two.operations)
    with pytest.raises(ks.CaseError, match="cam-circle"):
        ks.needs(case, "O", variant="cam")


def test_tables_have_a_row_for_each_model_with_units(saw):
    needs = ks.needs(saw["plain"], "O", 0.05)
    frame, ladder = needs.frame(), needs.ladder_frame()
    for table, models in ((frame, (needs.full, *needs.alone)), (ladder, needs.ladder)):
        assert list(table.columns) == ["change", "operations", "operations saved", "time [ns/angle]"]
        assert list(table.index) == [made.name for made in models]
        assert list(table["change"]) == [made.error for made in models]
        assert np.all(table["operations"] + table["operations saved"] == needs.full.operations)
        assert np.all(table["time [ns/angle]"] > 0)


def test_answer_reads_as_a_sentence(saw):
    needs = ks.needs(saw["plain"], "O", 0.05)
    few, all_of_them = needs.smallest.operations, needs.full.operations
    assert str(needs) == (
        f"reaction O within 0.05: no gravity, two-mass coupler, {few} of {all_of_them} operations "
        f"({1 - few / all_of_them:.0%} saved), error {needs.smallest.error:.2g}; 48 models run"
    )


def test_needs_chart_shows_ladder_and_tolerance(saw):
    needs = ks.needs(saw["cam-cosine"], "O", 0.05)
    figure, ax = plt.subplots()
    assert ks.plots.model_ladder(needs, ax=ax) is ax
    assert ax.get_xlabel() == "operations per crank angle [1]"
    assert ax.get_ylabel() == "change of reaction O, relative to largest value [1]"
    assert (ax.get_xscale(), ax.get_yscale()) == ("linear", "log")
    assert ax.xaxis_inverted()
    alone_drawn, rungs, tolerance, smallest = lines = ax.lines
    floor = rungs.get_ydata().min()
    assert ax.get_ylim()[0] < floor < needs.within / 100
    for line, models in ((alone_drawn, needs.alone), (rungs, needs.ladder), (smallest, [needs.smallest])):
        expected = [(made.operations, max(made.error, floor)) for made in models]
        np.testing.assert_allclose(line.get_xydata(), expected, rtol=1e-12)
    assert list(tolerance.get_ydata()) == [0.05, 0.05]
    assert tolerance.get_label() == "tolerance 0.05"
    assert smallest.get_label() == f"smallest: {needs.smallest.name}"
    assert {text.get_text() for text in ax.texts} == {made.name for made in needs.alone}
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [line.get_label() for line in lines]
    figure.canvas.draw()
    plt.close(figure)


# What cannot be


@pytest.mark.parametrize("within", [0.0, -0.1, np.nan, np.inf])
def test_tolerance_that_is_not_positive_is_refused(saw, within):
    with pytest.raises(ks.ParameterError, match="within"):
        ks.needs(saw["plain"], "O", within)


def test_batch_is_refused_with_its_shape():
    batch = solved(ks.crank_slider(np.array([[0.2], [0.3]]), 1.3, slider=ks.Link(5.0)))
    with pytest.raises(ks.ParameterError, match=r"single design.*\(2, 72\)"):
        ks.needs(batch, "O")


def test_quantity_that_is_zero_throughout_is_refused(saw):
    with pytest.raises(ks.ParameterError, match=r"guide_moment is 0\.0"):
        ks.needs(saw["plain"], "guide_moment")


def test_harmonics_of_gaps_are_left_out():
    gapping = ks.crank_slider(1.0, 0.8, slider=ks.Link(1.0))
    found = ks.needs(solved(gapping, angle=np.linspace(-0.5, 0.5, 12)), "O")
    assert "does not close all around the turn" in found.left_out["one harmonic"]


def test_needs_of_new_groups_names_failures():
    """The guide through O would be out of reach of the ram: no reason to leave out harmonics."""
    groups = (
        ks.LeverGroup((0.0, -0.2), lever=ks.Link(8.0, 0.3, 0.4)),
        ks.Pin(on="lever", at=(0.55, 0.0), name="C"),
        ks.SliderGroup(0.3, ks.Guide.at(0.0, 0.33), on="C", slider=ks.Link(10.0)),
    )
    spring = ks.PointSpring(1e-6, 0.1, between=("C", (0.3, 0.0)))
    s = ks.solve(ks.Mechanism("shaper", ks.Crank(0.1), groups), TURN, crank_speed=6.0, loads=spring)
    found = ks.needs(s, "balancing_torque", within=1e-6)
    assert found.smallest.name == "no point spring"
    assert found.left_out == {}
    assert "two harmonics" in {made.name for made in found.alone}


def test_simplification_leaving_a_table_is_left_out():
    """Harmonics miss the dead centres by microns, a guide moved to O by much more; the table ends there."""
    machine = cranked(guide_offset=0.05)
    ends = np.sort(ks.extremes(ks.solve(machine, TURN, crank_speed=SPEED), "slider_position").value)
    table = ks.Table([*ends], [-90.0, -50.0], over="travel")
    found = ks.needs(ks.solve(machine, TURN, crank_speed=SPEED, loads=ks.ProcessForce(table)), "balancing_torque")
    for name in ("guide through O", "one harmonic"):
        assert "but the table from" in found.left_out[name]
        assert all(name not in model.simplifications for model in (*found.alone, *found.ladder))
    assert found.smallest.error <= 0.01


# Friction

RUBBING = {
    "O": ks.PinFriction(0.05, 0.02),
    "A": ks.PinFriction(0.05, 0.02),
    "B": ks.PinFriction(1e-9, 0.02),
    "guide": ks.GuideFriction(0.1),
}


def rubbing(mechanism, friction, **options):
    return solved(mechanism, angle=TURN + 0.01, friction=friction, **options)


def test_friction_is_an_ingredient_by_joint(few_models):
    full = rubbing(MECHANISMS["crank-slider"], RUBBING)
    found = alone(ks.needs(full, "balancing_torque"))
    assert {name for name in found if "friction" in name} == {"no pin friction", "no guide friction"}
    for name, kept in (("no pin friction", ["guide"]), ("no guide friction", ["O", "A", "B"])):
        without = rubbing(MECHANISMS["crank-slider"], {joint: RUBBING[joint] for joint in kept})
        assert found[name].error == pytest.approx(change(without, full, "balancing_torque"), rel=1e-9)
        assert found[name].operations == operations(without, "balancing_torque")
    assert not [name for name in alone(ks.needs(solved(MECHANISMS["crank-slider"]), "O")) if "friction" in name]
    none = rubbing(MECHANISMS["crank-slider"], {"O": ks.PinFriction(0.0, 0.02)})
    assert not [name for name in alone(ks.needs(none, "O")) if "friction" in name]
    cam = RUBBING | {"slot": ks.SlotFriction(0.1), "cam": ks.RollerFriction(0.01, 0.02, 0.04)}
    assert {"no slot friction", "no roller friction"} <= set(alone(ks.needs(rubbing(MECHANISMS["cam"], cam), "O")))


def test_friction_counts_for_losses_not_for_torque(few_models):
    s = rubbing(MECHANISMS["crank-slider"], {"O": ks.PinFriction(1e-4, 0.02)})
    assert "no pin friction" in ks.needs(s, "balancing_torque", within=0.01).smallest.simplifications
    lost = ks.needs(s, "friction_loss", within=0.5)
    assert alone(lost)["no pin friction"].error == 1.0
    assert "no pin friction" not in lost.smallest.simplifications


def test_frictionless_model_is_equal_bit_for_bit(few_models):
    s = rubbing(MECHANISMS["four-bar"], dict.fromkeys(("O", "A"), RUBBING["O"]))
    model = alone(ks.needs(s, "O"))["no pin friction"].solution
    plain = solved(MECHANISMS["four-bar"], angle=TURN + 0.01)
    assert np.array_equal(model.reaction("O"), plain.reaction("O"))
    assert np.array_equal(model.balancing_torque, plain.balancing_torque)
    assert operations(model, "O") == operations(plain, "O")
