"""Hodographs of the forces on the frame, and of forces in the axes of a link."""

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import shipped
from support.every import every


@pytest.fixture(scope="module")
def saw():
    return {name: variant.scene.solve(36) for name, variant in shipped("sawframe_2r63").variants.items()}


def drawn(axes):
    """Points of the first curve, N."""
    return 1e3 * np.array(axes.lines[0].get_data())


def largest(points):
    return np.hypot(*points).max()


@every("place", ["cam", "spring", "ground O"])
def test_the_force_on_the_frame_is_drawn_by_its_place(saw, place):
    s = saw["cam-circle"]
    axes = ks.plots.hodograph(s, place)
    name = place.removeprefix("ground ")
    assert axes.get_xlabel() == f"force on the frame, {name}, x [kN]"
    assert largest(drawn(axes)) == pytest.approx(ks.extremes(s, f"ground {name}").largest, rel=1e-12)


def test_a_joint_is_that_of_its_reaction(saw, axes):
    ks.plots.hodograph(saw["cam-circle"], "guide", ax=axes)
    assert axes.get_xlabel() == "reaction guide, x [kN]"


def test_in_the_axes_of_a_link_the_force_turns_relative_to_it(saw, axes):
    s = saw["plain"]
    ks.plots.hodograph(s, "A", on="crank", ax=axes, marks=90)
    assert [axes.get_xlabel(), axes.get_ylabel()] == [
        f"reaction A, {way} the crank [kN]" for way in ("along", "across")
    ]
    force = s.at(np.radians([0.0, 90.0, 180.0, 270.0])).reaction("A")
    turned = np.array(
        [[force[0, 0], force[1, 1], -force[0, 2], -force[1, 3]], [force[1, 0], -force[0, 1], -force[1, 2], force[0, 3]]]
    )
    np.testing.assert_allclose(1e3 * np.array(axes.lines[1].get_data()), turned, atol=1e-9 * np.abs(force).max())


def test_a_panel_for_each_place(saw):
    cams = ["cam-circle", "cam-cosine"]
    figure = ks.plots.hodographs({name: saw[name] for name in ("plain", *cams)})
    shown = {ax.get_title(): [text.get_text() for text in ax.get_legend().get_texts()] for ax in figure.axes}
    assert shown == {"O": ["plain", *cams], "guide": ["plain", *cams], "cam": cams, "spring": cams}
    assert all(ax.get_xlabel() == "x [kN]" and ax.get_ylabel() == "y [kN]" for ax in figure.axes)
    colours = [{line.get_label(): line.get_color() for line in ax.lines} for ax in figure.axes]
    assert len({own["cam-cosine"] for own in colours}) == 1
    s = saw["cam-circle"]
    for ax in ks.plots.hodographs(s).axes:
        assert largest(drawn(ax)) == pytest.approx(ks.extremes(s, f"ground {ax.get_title()}").largest, rel=1e-12)


REFUSED = [
    (lambda s: ks.plots.hodograph(s, "sprung"), "force is 'sprung', allowed: 'shaking_force', 'A', 'B', 'guide', 'O'"),
    (lambda s: ks.plots.hodograph(s, "motor"), "allowed"),
    (
        lambda s: ks.plots.hodograph({"one": s, "other": saw_without_cam()}, "cam"),
        "crank-slider: force is 'ground cam'",
    ),
    (lambda s: ks.plots.hodograph(s, "A", on="crnk"), "on is 'crnk', allowed: 'crank', 'block', 'coupler', 'slider'"),
    (lambda s: ks.plots.hodographs(s, marks=0.0), "marks"),
    (lambda s: ks.plots.hodographs({}), "give at least one solution to draw"),
    (lambda s: ks.plots.hodographs(pair_of_designs()), "single design"),
]


def saw_without_cam():
    return ks.Scene(ks.crank_slider(0.3, 2.0), 1.0).solve(36)


def pair_of_designs():
    return ks.Scene(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0), 1.0).solve(36)


@every("call, words", REFUSED)
def test_what_is_refused(saw, call, words):
    with pytest.raises(ks.KinetostaticsError) as caught:
        call(saw["cam-circle"])
    assert words in str(caught.value)


@pytest.mark.slow
def test_a_report_shows_them_all(tmp_path):
    pytest.importorskip("jinja2")
    scenes = {name: shipped("sawframe_2r63").variants[name].scene for name in ("plain", "cam-circle")}
    page = ks.report(scenes, tmp_path / "saw.html").read_text(encoding="utf-8")
    figures = [name.split('"')[0] for name in page.split('data-figure="')[1:]]
    shown = [name for name in figures if name.startswith("ground")]
    assert shown == ["ground", "ground O", "ground guide", "ground cam", "ground spring"]
    assert '<option value="ground spring">force on the frame, spring</option>' in page
