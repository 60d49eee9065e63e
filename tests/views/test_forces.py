"""Figures of who causes a force, and of the free body of a link: values as they are, to one scale; refusals."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Polygon

import kinetostatics as ks
from kinetostatics.mechanics.free_body import free_body
from support.every import every
from support.scenes import BATCH, PASSING

SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
S = ks.Scene(SAW, 33.5, loads=[ks.Gravity(), ks.Spring(5e5, 2.0)]).solve(8)
RUBBING = ks.Scene(SAW, 33.5, loads=[ks.Gravity()], friction={"guide": ks.GuideFriction(0.1, 0.3)}).solve(8)
CAM = ks.Scene(ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.0, slider=ks.Link(600.0)), 33.5).solve(8)


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


def arrows(ax):
    """Lengths of the arrows in order, from the shaft's tail to the tip of its head."""
    shafts = [line.get_xydata() for line in ax.lines if line.get_solid_capstyle() == "butt"]
    tips = [patch.get_xy()[0] for patch in ax.patches if isinstance(patch, Polygon) and patch.get_zorder() == 5]
    return np.array([np.hypot(*(tip - shaft[0])) for shaft, tip in zip(shafts, tips, strict=False)])


@pytest.mark.slow
@every("solution, link", [(S, "crank"), (S, "coupler"), (S, "slider"), (CAM, "block"), (RUBBING, "slider")])
def test_arrows_are_to_one_scale(solution, link):
    actions = free_body(solution.at(np.radians([50.0])).dynamics, link)
    sizes = np.array([np.hypot(*item.force[:, 0]) for item in actions])
    sizes = sizes[sizes > 1e-9 * sizes.max()]
    drawn = arrows(ks.plots.free_body(solution, link, 50))
    np.testing.assert_allclose(drawn / drawn.max(), sizes / sizes.max(), rtol=1e-9)


def test_values_stand_at_forces_and_couples():
    ax = ks.plots.free_body(S, "slider", 0)
    at = S.at(0.0)
    texts = [text.get_text() for text in ax.texts]
    inertia, spring = (np.hypot(*at.inertia_force("slider")), 5e5 * abs(at.slider_position - 2.0))
    assert {f"inertia {inertia / 1e3:.4g} kN", f"Spring {spring / 1e3:.4g} kN", "weight 5.886 kN"} <= set(texts)
    rubbed = ks.plots.free_body(RUBBING, "crank", 50)
    torque = RUBBING.at(np.radians(50.0)).balancing_torque
    assert f"balancing torque {torque / 1e3:.4g} kN m" in [text.get_text() for text in rubbed.texts]
    assert rubbed.get_title() == "crank at crank angle 50°"


def test_arrows_on_a_planet_are_as_long_as_its_ring_needs():
    knife = ks.YokeGroup(on="P", slider=ks.Link(5.0))
    drive = ks.Mechanism("mower", ks.Crank(0.019), (ks.PlanetaryCrank(0.019), knife))
    ax = ks.plots.free_body(ks.Scene(drive, 60.0).solve(8), "planet", 60)
    assert arrows(ax).max() > 0.3 * 4 * 0.019  # of the ring's diameter


def test_massless_unloaded_link_has_no_arrow():
    idle = ks.solve(ks.crank_slider(0.3, 2.0), 0.0, crank_speed=1.0)
    assert arrows(ks.plots.free_body(idle, "coupler", 40)).size == 0


def test_only_the_link_is_drawn():
    figures = {link: len(ks.plots.free_body(S, link, 60).lines) for link in SAW.links}
    assert min(figures.values()) > 0
    assert len(ks.plots.mechanism(S, angles=(60,)).lines) > max(figures.values())


@pytest.mark.slow
@every("quantity, superposed", [("O", S), ("balancing_torque", RUBBING)])
def test_bars_are_the_shares(quantity, superposed):
    found = superposed.shares(quantity)
    ax = ks.plots.shares(superposed, quantity)
    wide = [bar.get_width() for bar in ax.patches]
    rows = (*found.rows, found.total)
    np.testing.assert_allclose(wide, [1e-3 * row.value for row in rows] + [1e-3 * row.peak for row in rows])
    assert [text.get_text() for text in ax.get_yticklabels()] == [row.source for row in rows]
    assert ax.get_xlabel() == f"{'share of' if found.superposed else 'effect on'} {found.label} [k{found.unit}]"


OPEN = ks.solve(ks.crank_slider(1.0, 0.5, slider=ks.Link(1.0)), np.zeros(1), crank_speed=1.0)


@every(
    "solution, link, angle, error, message",
    [
        (S, "rod", 60, ks.QuantityError, "link is 'rod', allowed: 'crank', 'coupler', 'slider'"),
        (S, 3, 60, ks.QuantityError, "link is 3, allowed"),
        (S, "coupler", "sixty", ks.ParameterError, "angle"),
        (S, "coupler", float("nan"), ks.ParameterError, "angle"),
        (S, "coupler", [10, 20], ks.ParameterError, "angle"),
        (SAW, "coupler", 60, ks.ParameterError, "must be a Solution"),
        (BATCH, "coupler", 60, ks.ParameterError, "plots show one design"),
        (OPEN, "coupler", 90, ks.AssemblyError, "cannot be assembled"),
        (PASSING, "rocker", 0, ks.ParameterError, "grow without bound at crank angle 0 deg"),
    ],
)
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning", "ignore::kinetostatics.ConditionWarning")
def test_bad_input_is_refused(solution, link, angle, error, message):
    with pytest.raises(error, match=message):
        ks.plots.free_body(solution, link, angle)


@every("given, message", [(BATCH, "one design at a time"), (SAW, "must be a Solution")])
def test_shares_of_what_is_no_single_design_are_refused(given, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.plots.shares(given, "O")
