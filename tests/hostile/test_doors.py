"""Doors of studies, sweeps and figures: what cannot be answered ends in one clear error, before any work."""

import math

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

import kinetostatics as ks
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
    "chain_unit_motion": (lambda thing: ks.plots.chain_unit_motion(thing, "rocker"), SOLUTIONS),
    "characteristics": (lambda thing: ks.linkage.characteristics({"a": thing}, "a"), f"a {SOLUTIONS}"),
    "model_ladder": (ks.plots.model_ladder, "needs must be what ks.needs(...) returns"),
}


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
    "no solutions": (lambda: ks.plots.torque({}), "there are no solutions to draw"),
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
    "spreads in a list": (lambda: ks.tolerances(SAW, "rms O", ["a"]), "spreads must be a dict"),
}


@every("name", CALLS)
def test_calls_that_cannot_be_answered_are_refused(name):
    call, message = CALLS[name]
    with pytest.raises(ks.ParameterError) as caught:
        call()
    assert message in str(caught.value)
    plt.close("all")
