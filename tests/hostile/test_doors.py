"""Functions and methods called with things that they do not take."""

import math
from typing import ClassVar

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

import kinetostatics as ks
from kinetostatics.machine.group import Group, Resolved
from kinetostatics.mechanics.quantities import components
from kinetostatics.studies.precision import METHODS
from kinetostatics.views.figures import draw_case
from support.case_files import shipped
from support.every import every

mpl.use("agg")
SAW = shipped("sawframe_2r63")
PLAIN, FOUR_BAR = SAW.solve("plain", 36), shipped("chain_unit").solve("rho-0.5", 36)
STILL = ks.solve(FOUR_BAR.mechanism, FOUR_BAR.crank_angle, crank_speed=0.0)
TABLE = pd.DataFrame({"a": [1.0, 2.0], "b": [3.0, 4.0], "c": [1.0, 1.0]})


COUNTS = [-1, 0, 2.5, True, "many", None, math.nan, np.float64(3.0), np.int64(0), [3], 10**9, 10**400, 10**5000]


@every("count", COUNTS, ids=map(str, range(len(COUNTS))))
def test_impossible_angle_counts_are_refused(count):
    for solve in (SAW.variant("plain").solve, lambda angles: SAW.solve("plain", angles=angles)):
        with pytest.raises(ks.ParameterError, match=r"^solve: angles must be (a whole number of at least 1|at most 1)"):
            solve(count)


def test_angle_counts_may_be_numpy_integers():
    assert SAW.solve("plain", np.int16(8)).shape == (8,)


OTHERS = {
    "None": None,
    "number": 3,
    "name": "plain",
    "mechanism": PLAIN.mechanism,
    "case": SAW,
    "variant": SAW.variant("plain"),
    "list": [PLAIN],
    "table": TABLE,
    "class": ks.Solution,
}
SOLUTIONS = "must be a Solution, as ks.solve(...), case.solve(name) and variant.solve() return, got "
WANTED = {
    "extremes": (lambda thing: ks.extremes(thing, "O"), SOLUTIONS),
    "compare": (lambda thing: ks.compare(PLAIN, thing), f"balanced {SOLUTIONS}"),
    "compare, reference": (lambda thing: ks.compare(thing, PLAIN), f"reference {SOLUTIONS}"),
    "swing": (ks.linkage.swing, SOLUTIONS),
    "transmission angle": (ks.linkage.transmission_angle, SOLUTIONS),
    "rocker angle": (ks.linkage.rocker_angle, SOLUTIONS),
    "study": (ks.precision.study, SOLUTIONS),
    **{
        name: (getattr(ks.plots, name), SOLUTIONS)
        for name in ("torque", "cam_force", "pressure_angle", "acceleration_error", "hodograph", "shaking_force")
    },
    **{name: (getattr(ks.plots, name), SOLUTIONS) for name in ("mechanism", "mass_centres", "animation")},
    "over_turn": (lambda thing: ks.plots.over_turn(thing, "O"), SOLUTIONS),
    "over_turn, among others": (lambda thing: ks.plots.over_turn({"a": PLAIN, "b": thing}, "O"), f"b {SOLUTIONS}"),
    "free_body": (lambda thing: ks.plots.free_body(thing, "coupler", 60), SOLUTIONS),
    "shares": (lambda thing: ks.plots.shares(thing, "O"), SOLUTIONS),
    "chain_unit_motion": (lambda thing: ks.plots.chain_unit_motion(thing, "rocker"), SOLUTIONS),
    "characteristics": (lambda thing: ks.linkage.characteristics({"a": thing}, "a"), f"a {SOLUTIONS}"),
    "model_ladder": (ks.plots.model_ladder, "needs must be a Needs, as from ks.needs(...), got"),
}


@pytest.mark.slow
@every("other", OTHERS)
@every("name", WANTED)
def test_functions_of_solutions_refuse_other_things(name, other):
    function, message = WANTED[name]
    with pytest.raises(ks.ParameterError) as caught:
        function(OTHERS[other])
    assert message in str(caught.value)
    plt.close("all")


CALLS = {
    **{
        f"principal points of {name}": (lambda thing=thing: ks.principal_points(thing), "mechanism must be a Mechanism")
        for name, thing in OTHERS.items()
        if name != "mechanism"
    },
    **{
        f"Grashof of {name}": (lambda thing=thing: ks.linkage.grashof(thing), "mechanism must be a Mechanism")
        for name, thing in OTHERS.items()
        if name != "mechanism"
    },
    **{
        f"needs of {name}": (lambda thing=thing: ks.needs(thing, "O"), "scene must be a Solution or a Case")
        for name, thing in OTHERS.items()
        if name != "case"
    },
    **{
        f"{kind.__name__} of {name}": (lambda thing=thing, kind=kind: kind(thing, TABLE, ["rms O"]), "must be a Case")
        for kind in (ks.sweep, ks.tolerances)
        for name, thing in OTHERS.items()
        if name not in ("case", "class", "variant")
    },
    **{
        f"quantity {quantity!r} of {kind.__name__}": (
            lambda quantity=quantity, kind=kind: kind(PLAIN, quantity),
            "quantity must be a name",
        )
        for quantity in (None, 3, ["O"], {"O": 1}, b"O")
        for kind in (ks.extremes, ks.needs, ks.plots.over_turn, ks.plots.hodograph, ks.precision.study)
    },
    **{
        f"{kind.__name__} of a table {table!r}": (lambda table=table, kind=kind: kind(table), "table")
        for table in (None, 3, {}, TABLE, TABLE[:0])
        for kind in (ks.plots.work_precision, ks.plots.error_by_distance)
    },
    **{
        f"axes {ax!r}": (lambda ax=ax, kind=kind: kind(PLAIN, ax=ax), "ax must be matplotlib Axes")
        for ax in (3, "polar", Figure)
        for kind in (ks.plots.torque, ks.plots.mechanism, ks.plots.shaking_force, ks.plots.animation)
    },
    **{
        f"{kind.__name__} of {outputs!r}": (lambda outputs=outputs, kind=kind: kind(outputs), "outputs must be texts")
        for outputs in (None, 3)
        for kind in (
            lambda outputs: ks.sweep(SAW, TABLE, outputs),
            lambda outputs: ks.tolerances(SAW, outputs),
        )
    },
    **{
        f"marks {marks!r}": (lambda marks=marks: ks.plots.hodograph(PLAIN, marks=marks), "marks must be")
        for marks in (0, -1, math.nan, math.inf, "ten", 1e-9)
    },
    **{
        f"angles {angles!r}": (lambda angles=angles: ks.plots.mechanism(PLAIN, angles=angles), "angles must be")
        for angles in ("ten", [math.nan], [[0, 1]], {"a": 1})
    },
    **{
        f"frames {frames!r}": (lambda frames=frames: ks.plots.animation(PLAIN, frames=frames), "frames must be a whole")
        for frames in (0, -1, 2.5, "ten")
    },
    "no solutions": (lambda: ks.plots.torque({}), "give at least one solution to draw"),
    "no reactions": (lambda: ks.plots.animation(PLAIN, joints=()), "joints must name at least one"),
    "other direction": (lambda: ks.plots.shaking_force(PLAIN, by="x"), "by is 'x'"),
    "third order": (lambda: ks.plots.chain_unit_motion(FOUR_BAR, "rocker", 3), "order must be 1 or 2, got 3"),
    "no coupler": (lambda: ks.plots.chain_unit_motion(FOUR_BAR, "crank"), "link is 'crank', allowed"),
    "motion at rest": (lambda: ks.plots.chain_unit_motion(STILL, "rocker"), "crank speed"),
    "map of nothing": (lambda: ks.plots.sweep_map(TABLE, [], "c"), "one or two different parameters"),
    "map of three": (lambda: ks.plots.sweep_map(TABLE, ["a", "b", "c"], "c"), "one or two different parameters"),
    "map of one twice": (lambda: ks.plots.sweep_map(TABLE, ["a", "a"], "c"), "one or two different parameters"),
    "map of another": (lambda: ks.plots.sweep_map(TABLE, ["a"], "d"), "no column 'd'; it has a, b, c"),
    "characteristics at rest": (lambda: ks.linkage.characteristics({"a": STILL}, "a"), "a: the crank speed is 0"),
    "characteristics of none": (lambda: ks.linkage.characteristics({}, "a"), "solutions must be a dict"),
    "characteristics of a list": (lambda: ks.linkage.characteristics([STILL], "a"), "solutions must be a dict"),
    "other reference": (lambda: ks.linkage.characteristics({"a": FOUR_BAR}, "b"), "reference is 'b', allowed: 'a'"),
    "start in words": (lambda: ks.linkage.rocker_angle(FOUR_BAR, "up"), "start must be a number"),
    "angle in words": (lambda: ks.linkage.chain_unit_angle("up"), "angle must be a number"),
    "precision of none": (lambda: ks.precision.case_study(None, "out"), "case must be a Case"),
    "figures of none": (lambda: draw_case(None, "out"), "case must be a Case"),
    "spreads in a list": (
        lambda: ks.tolerances(SAW, "rms O", ["a"]),
        "tolerances: spreads must be a dict of parameter",
    ),
}


@pytest.mark.slow
@every("name", CALLS)
def test_calls_that_cannot_be_answered_are_refused(name):
    call, message = CALLS[name]
    with pytest.raises(ks.ParameterError) as caught:
        call()
    assert message in str(caught.value)
    plt.close("all")


# Methods under study refuse what they cannot give

TURN = 2 * np.pi * np.arange(24) / 24
BODIES = {"coupler": ks.Link(2.0, 0.2, 0.03), "slider": ks.Link(5.0)}
CHOSEN = {method.name: method for method in METHODS if not method.ours and not method.name.endswith("compiled")}
BY_TURN = ("spectral differentiation", "harmonic series")
OTHER_MOTION = ("differences, 2nd order", "differences, 4th order", *BY_TURN)
OF_ONE_DESIGN = [name for name in CHOSEN if name not in ("float32 crank angles", "two-mass coupler")]
OF_KNOWN_GROUPS = ["papers' formulas", *OTHER_MOTION]


class OwnSlider(ks.SliderGroup):
    """A group of a user's own, which places itself in another way than the library's."""

    def place(self, placement):
        """As the library does, which nobody can know."""
        super().place(placement)


class Wheel(Group):
    """A group of a user's own with one link, massless, that turns with the crank."""

    links: ClassVar = {"wheel": ks.Link()}
    references: ClassVar = {"wheel": "O"}
    joints: ClassVar = {}
    outputs: ClassVar = {}
    hangs_on = ("O",)

    def place(self, placement):
        """Put the wheel where the crank is."""
        placement.links["wheel"] = placement.links["crank"]

    def closure(self, placement):
        """Always assembled."""
        return 1.0

    def requirement(self, placement):
        """Never asked for."""

    def resolve(self, placement, loads, along):
        """Bears nothing."""
        return Resolved({}, {}, {})


class OwnCam:
    """A cam of a user's own."""

    def polar(self, angle, ray):
        """Radius and its derivatives."""
        return 0.3 + 0.02 * np.cos(angle), -0.02 * np.sin(angle), -0.02 * np.cos(angle)


def solved(mechanism, angle=TURN, loads=(), **settings):
    return ks.solve(mechanism, angle, crank_speed=10.0, loads=[ks.Gravity(), *loads], **settings)


def cam(profile, **bodies):
    return ks.cam_crank_slider(profile, 0.9, **(BODIES | bodies))


CIRCLE = ks.cams.Circle(0.3, (-0.02, 0.0))
MACHINE = ks.crank_slider(0.1, 0.4, **BODIES)
SPRING = ks.Spring(500.0, 0.9)
SIX_BAR = ks.Mechanism(
    "six-bar", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.05)), ks.SliderGroup(0.5, on="B", pin="C", label="2"))
)
COLUMN = np.array([[1.0], [2.0]])
BATCHES = {
    "lengths": solved(ks.crank_slider(0.1 * COLUMN, 0.4, **BODIES)),
    "masses": solved(ks.crank_slider(0.1, 0.4, coupler=BODIES["coupler"], slider=ks.Link(COLUMN))),
    "gravities": ks.solve(MACHINE, TURN, crank_speed=10.0, loads=[ks.Gravity(9.81 * COLUMN)]),
    "one of one": solved(ks.crank_slider(np.array([[0.1]]), 0.4, **BODIES)),
    "rockers": solved(ks.four_bar(0.1, 0.4, 0.1 * COLUMN + 0.2, rocker_pivot=(0.35, 0.1))),
    "cams": solved(cam(ks.cams.Circle(0.3, (-0.01 * COLUMN, 0.0))), loads=[SPRING]),
    "springs": solved(cam(CIRCLE), loads=[ks.Spring(100.0 * COLUMN, 0.9)]),
    "one angle, no row": solved(MACHINE, np.array(0.3)),
    "rows of angles": solved(MACHINE, np.tile(TURN, (2, 1))),
}
FOREIGN = {
    "group": solved(ks.Mechanism("own", ks.Crank(0.1), (OwnSlider(0.4, **BODIES),))),
    "group in a chain": solved(
        ks.Mechanism("own", ks.Crank(0.1), (ks.SliderGroup(0.4), OwnSlider(0.5, pin="C", label="2")))
    ),
}
PRINTED = "sawframe study as printed, wrong sign"
PAPERS, KANE, NEWTON = "papers' formulas", "SymPy Kane, lambdified", "Newton iteration, global system"
RUBBING = {"O": ks.PinFriction(mu=0.1, radius=0.02)}
MIXED = [
    (PAPERS, solved(cam(OwnCam())), "O", "this cam"),
    (PAPERS, solved(SIX_BAR), "O", "no study has formulas for the groups"),
    (PAPERS, solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "no study has formulas for the groups"),
    (KANE, solved(ks.Mechanism("own", ks.Crank(0.1), (Wheel(),))), "O", "Wheel does not declare its pairs"),
    (KANE, solved(MACHINE), "nonsense", "not set up to give nonsense"),
    (KANE, solved(ks.four_bar(0.2, 0.2, 0.2, rocker_pivot=(0.2, 0.0), assembly="open")), "O", "passes change points"),
    (PAPERS, solved(cam(ks.cams.Sampled(TURN, 0.3 + 0.02 * np.cos(TURN)))), "O", "this cam"),
    *(
        (name, solved(MACHINE, friction=RUBBING), "O", "no friction, but the scene has some in O")
        for name in (KANE, PAPERS)
    ),
    (NEWTON, solved(MACHINE), "nonsense", "give no nonsense"),
    (NEWTON, solved(MACHINE), "cam_force", "give no cam_force"),
    (PRINTED, solved(MACHINE), "O", "circular cam; crank-slider has none"),
    (PRINTED, solved(cam(OwnCam()), loads=[SPRING]), "O", "has the cam OwnCam"),
    (PRINTED, solved(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))), "O", "circular cam; four-bar has none"),
    (PRINTED, solved(cam(CIRCLE)), "O", "no spring"),
    (PRINTED, solved(SIX_BAR), "O", "circular cam; six-bar has none"),
    (PRINTED, solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "circular cam; fan has none"),
    ("two-mass coupler", solved(ks.crank_slider(0.1, 0.4, slider=ks.Link(5.0))), "O", "no coupler mass"),
    ("two-mass coupler", solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "no coupler mass"),
    *((name, solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "fan is only a crank") for name in BY_TURN),
    ("spectral differentiation", solved(MACHINE, TURN[:-1]), "O", "even crank angles over one turn"),
    ("spectral differentiation", solved(MACHINE, TURN[:4] * 6), "O", "8 samples are more than the 4"),
]  # fmt: skip


def refused(name, solution, quantity, words):
    method = CHOSEN[name]
    with pytest.raises(ks.errors.NotGivenError, match=words):
        method.prepare(solution, quantity, method.settings[0])()


@every("batch", BATCHES)
@every("name", OF_ONE_DESIGN)
def test_batches_are_refused_by_single_design_calls(name, batch):
    refused(name, BATCHES[batch], "O", "one mechanism at crank angles|circular cam|no spring")


@every("own", FOREIGN)
@every("name", OF_KNOWN_GROUPS)
def test_own_groups_are_refused_where_unknown(name, own):
    refused(name, FOREIGN[own], "O", "own|OwnSlider")


@pytest.mark.slow
@every(("name", "solution", "quantity", "words"), MIXED)
def test_missing_formulas_are_refused_with_reason(name, solution, quantity, words):
    refused(name, solution, quantity, words)


@pytest.mark.parametrize("name", BY_TURN)
def test_gaps_are_refused_by_whole_turn_calls(name):
    short = solved(ks.crank_slider(0.21, 0.1, slider=ks.Link(3.0)), on_gap="nan")
    refused(name, short, "O", "crank-slider does not close all around the turn")


@pytest.mark.parametrize("name", [name for name in OTHER_MOTION if name not in BY_TURN])
def test_a_crank_alone_is_solved_by_all_methods(name):
    fan = solved(ks.Mechanism("fan", ks.Crank(0.1, ks.Link(2.0, 0.05, 0.1)), ()))
    method = CHOSEN[name]
    for quantity in ("O", "balancing_torque", "shaking_force"):
        found = method.prepare(fan, quantity, method.settings[0])()
        np.testing.assert_array_equal(found, components(fan, quantity))
