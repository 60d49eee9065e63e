"""Methods under study refuse what they cannot give: always by `NotGivenError` with the reason, never by a traceback."""

from typing import ClassVar

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.group import Group, Resolved
from kinetostatics.mechanics.quantities import components
from kinetostatics.studies.precision import METHODS
from support.every import every

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
PLAIN = ks.crank_slider(0.1, 0.4, **BODIES)
SPRING = ks.Spring(500.0, 0.9)
SIX_BAR = ks.Mechanism(
    "six-bar", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.05)), ks.SliderGroup(0.5, on="B", pin="C", label="2"))
)
COLUMN = np.array([[1.0], [2.0]])
BATCHES = {
    "lengths": solved(ks.crank_slider(0.1 * COLUMN, 0.4, **BODIES)),
    "masses": solved(ks.crank_slider(0.1, 0.4, coupler=BODIES["coupler"], slider=ks.Link(COLUMN))),
    "gravities": ks.solve(PLAIN, TURN, crank_speed=10.0, loads=[ks.Gravity(9.81 * COLUMN)]),
    "one of one": solved(ks.crank_slider(np.array([[0.1]]), 0.4, **BODIES)),
    "rockers": solved(ks.four_bar(0.1, 0.4, 0.1 * COLUMN + 0.2, rocker_pivot=(0.35, 0.1))),
    "cams": solved(cam(ks.cams.Circle(0.3, (-0.01 * COLUMN, 0.0))), loads=[SPRING]),
    "springs": solved(cam(CIRCLE), loads=[ks.Spring(100.0 * COLUMN, 0.9)]),
    "one angle, no row": solved(PLAIN, np.array(0.3)),
    "rows of angles": solved(PLAIN, np.tile(TURN, (2, 1))),
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
    (KANE, solved(ks.Mechanism("own", ks.Crank(0.1), (Wheel(),))), "O", "Wheel does not declare in its pairs"),
    (KANE, solved(PLAIN), "nonsense", "not set up to give nonsense"),
    *((name, solved(PLAIN, friction=RUBBING), "O", "no friction, but there is some in O") for name in (KANE, PAPERS)),
    (NEWTON, solved(PLAIN), "nonsense", "give no nonsense"),
    (NEWTON, solved(PLAIN), "cam_force", "give no cam_force"),
    (PRINTED, solved(PLAIN), "O", "circular cam; crank-slider has none"),
    (PRINTED, solved(cam(OwnCam()), loads=[SPRING]), "O", "has the cam OwnCam"),
    (PRINTED, solved(cam(CIRCLE)), "O", "no spring"),
    (PRINTED, solved(SIX_BAR), "O", "circular cam; six-bar has none"),
    (PRINTED, solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "circular cam; fan has none"),
    ("two-mass coupler", solved(ks.crank_slider(0.1, 0.4, slider=ks.Link(5.0))), "O", "no coupler mass"),
    ("two-mass coupler", solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "no coupler mass"),
    *((name, solved(ks.Mechanism("fan", ks.Crank(0.1), ())), "O", "fan is a crank alone") for name in BY_TURN),
    ("spectral differentiation", solved(PLAIN, TURN[:-1]), "O", "evenly over one turn"),
    ("spectral differentiation", solved(PLAIN, TURN[:4] * 6), "O", "8 samples are more than the 4"),
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
