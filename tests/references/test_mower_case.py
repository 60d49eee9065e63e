"""The mower case file: variants, comparison with the study's table 1, figures, and wrong balancing tables."""

import re
from functools import cache

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from kinetostatics.views.canvas import with_peaks
from kinetostatics.views.figures import draw_case
from support.case_files import case_file, problems, shipped
from support.every import every

pytestmark = pytest.mark.slow

BARE = """
title = "test"
reference = "bare"
[common]
mechanism = "crank-slider"
crank_speed = "600 rpm"
crank_length = "38 mm"
coupler_length = "300 mm"
crank = { mass = "1 kg", centre = "19 mm" }
coupler = { mass = "2 kg", centre = "100 mm" }
slider = { mass = "5 kg" }
[variants.bare]
"""
X = BARE + "[variants.x.balancing]\n"
FOUR_BAR = """
title = "test"
reference = "bare"
[common]
mechanism = "four-bar"
crank_speed = "60 rpm"
crank_length = "0.3 m"
coupler_length = "0.8 m"
rocker_length = "0.6 m"
rocker_pivot = ["0.7 m", "0.1 m"]
crank = { mass = "3 kg", centre = ["0.1 m", "0.04 m"] }
coupler = { mass = "7 kg", centre = ["0.4 m", "-0.06 m"] }
rocker = { mass = "5 kg", centre = "0.2 m" }
[variants.bare]
[variants.full.balancing]
method = "full"
crank = { mass = "5 kg" }
rocker = { arm = "-150 mm" }
"""
FIGURES = ("mass_centres", "shaking_by_direction", "shaking_by_crank_angle")


@cache
def case():
    return shipped("mower_drive")


@cache
def solutions():
    return {name: case().solve(name, angles=90) for name in case().variants}


def largest_force(name):
    return ks.extremes(case().solve(name), "shaking_force").range[1]


@pytest.fixture
def polar():
    figure, ax = plt.subplots(subplot_kw={"projection": "polar"})
    yield ax
    plt.close(figure)


# Variants


def test_mower_case_has_the_study_and_an_optimum():
    assert list(case().variants) == ["unbalanced", "full", "partial-1", "partial-2", "partial-3", "optimal"]
    assert case().reference == "unbalanced"
    assert case().variants["unbalanced"].balanced is None
    for name, s in solutions().items():
        assert s.crank_speed == pytest.approx(20 * np.pi, rel=1e-15)
        assert s.power_residual < 1e-14, name


def test_guide_runs_20_mm_below_the_crank_pivot():
    for s in solutions().values():
        np.testing.assert_allclose(s.position("B")[1], -0.02, rtol=1e-15)
        assert np.ptp(s.slider_position) > 0.076


def test_balanced_variants_keep_what_the_balancing_did():
    bare = case().variants["unbalanced"].mechanism
    for name, variant in case().variants.items():
        if variant.balanced is not None:
            assert variant.balanced.mechanism is variant.mechanism
            assert variant.balanced.bare.links["slider"].mass == bare.links["slider"].mass
            assert ("coupler" in variant.balanced.counterweights) == (name == "full")


def test_each_variant_reaches_its_aim():
    ratios = {name: case().variants[f"partial-{number}"].balanced.ratio for number, name in ((1, 1), (2, 0), (3, 0.5))}
    assert ratios == {ratio: pytest.approx(ratio, rel=1e-13, abs=1e-14) for ratio in ratios}
    assert largest_force("full") < 1e-12 * largest_force("unbalanced")
    assert largest_force("optimal") < largest_force("partial-3") < largest_force("partial-2")


def test_crank_balancing_costs_mass_but_no_torque():
    """The price of full balancing: eight times the shaking moment, five times the force at the crank pin."""
    bare, partial, full = (solutions()[name] for name in ("unbalanced", "partial-3", "full"))
    np.testing.assert_allclose(partial.balancing_torque, bare.balancing_torque, rtol=0, atol=1e-13)
    effect = case().variants["full"].balanced.effect(crank_speed=full.crank_speed)
    assert effect.loc["mass of links [kg]", "after"] == pytest.approx(1226.3636 / 50 + 1500 / 55 + 5, rel=1e-7)
    price = effect["after"] / effect["before"]
    assert price["largest shaking moment [N m]"] > 8
    assert price["largest reaction A [N]"] > 5


# Command line


def test_compare_brackets_every_published_figure(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "400")
    assert main(["compare", "mower_drive"]) == 0
    printed = capsys.readouterr().out.splitlines()
    for quantity, entries in case().published.balancing.items():
        (line,) = [line for line in printed if line.startswith(quantity)]
        assert [part for part in line.split() if part.startswith("(")] == [f"({text})" for text in entries.values()]
    (masses,) = [line for line in printed if line.startswith("link mass with counterweight [kg]")]
    assert masses.split()[5:9] == ["24.5273", "(24.5)", "27.2727", "(27.2)"]
    others = [name for name in case().variants if name != "unbalanced"]
    assert [line.split()[1:] for line in printed if line.startswith("quantity")][-1] == others


def test_run_prints_the_extremes_of_one_variant(capsys):
    assert main(["run", "mower_drive", "--variant", "partial-1", "--angles", "36"]) == 0
    printed = capsys.readouterr().out
    (line,) = [line for line in printed.splitlines() if line.startswith("shaking force")]
    assert line.split()[-2:] == ["959.646", "357.578"]
    assert "unbalanced" not in printed.split("partial-1")[1]


# Figures


@pytest.mark.parametrize("name", FIGURES)
def test_figures_of_the_study_are_drawn_for_the_mower(name, tmp_path):
    (path,) = draw_case(case(), tmp_path, only=name)
    assert path == tmp_path / f"mower_drive_{name}.png"
    assert path.read_bytes().startswith(b"\x89PNG")


def test_balancing_figures_need_balancing(tmp_path):
    for name in FIGURES:
        with pytest.raises(ks.ParameterError, match=f"figure is '{name}', allowed: 'overview'"):
            draw_case(ks.load_case("sawframe_2r63"), tmp_path, only=name)


def curves(ax):
    """Drawn curves by variant, (2, N) each; of one that stands still the label says so in brackets."""
    named = ((line.get_label().partition(" (")[0], line) for line in ax.lines)
    return {name: np.array(line.get_data()) for name, line in named if name in case().variants}


def test_mass_centre_paths_are_closed_and_to_scale(axes):
    assert ks.plots.mass_centres(solutions(), ax=axes) is axes
    assert axes.get_aspect() == 1
    found = curves(axes)
    assert list(found) == list(case().variants)
    for name, s in solutions().items():
        expected = ks.principal_points(s.mechanism).mass_centre(s)
        np.testing.assert_allclose(found[name][:, :-1], expected, rtol=0, atol=1e-15)
        np.testing.assert_array_equal(found[name][:, -1], found[name][:, 0])
    assert np.max(np.ptp(found["full"], axis=1)) < 1e-15


@pytest.mark.parametrize("by", ["direction", "crank angle"])
def test_hodographs_show_size_by_direction_or_angle(polar, by):
    assert ks.plots.shaking_force(solutions(), by=by, ax=polar) is polar
    assert "N" in polar.get_title()
    drawn = with_peaks(solutions(), "shaking_force")
    for name, (angle, size) in curves(polar).items():
        assert np.isin(solutions()[name].crank_angle, drawn[name].crank_angle).all()
        x, y = drawn[name].shaking_force
        np.testing.assert_allclose(size[:-1], np.hypot(x, y), rtol=0, atol=1e-12)
        expected = np.arctan2(y, x) if by == "direction" else drawn[name].crank_angle
        np.testing.assert_allclose(angle[:-1], expected, rtol=0, atol=1e-15)
    assert set(curves(polar)) == set(case().variants)


def test_centred_mower_hodographs_are_symmetric(polar):
    """With e = 0, by direction: turning the crank the other way mirrors the force."""
    links = {"crank": ks.Link(1.0, 0.019), "coupler": ks.Link(2.0, 0.1), "slider": ks.Link(5.0)}
    angle = np.linspace(-np.pi, np.pi, 91)
    centred = {
        name: ks.solve(ks.crank_slider(0.038, 0.3, guide_offset=offset, **links), angle, crank_speed=20 * np.pi)
        for name, offset in (("unbalanced", 0.0), ("full", -0.02))
    }
    ks.plots.shaking_force(centred, ax=polar)
    solved = {name: np.isin(s.crank_angle, angle) for name, s in with_peaks(centred, "shaking_force").items()}
    forces = {name: (size * np.exp(1j * way))[:-1][solved[name]] for name, (way, size) in curves(polar).items()}
    difference = {name: np.max(np.abs(f - np.conj(f[::-1]))) for name, f in forces.items()}
    assert difference["unbalanced"] < 1e-10
    assert difference["full"] > 10


def test_hodograph_by_something_else_is_refused(polar):
    with pytest.raises(ks.ParameterError, match="by is 'crank', allowed: 'direction', 'crank angle'"):
        ks.plots.shaking_force(solutions(), by="crank", ax=polar)


# Case files with balancing


def test_four_bar_case_is_fully_balanced(tmp_path):
    made = ks.load_case(case_file(tmp_path, FOUR_BAR))
    forces = {name: np.max(np.hypot(*made.solve(name).shaking_force)) for name in made.variants}
    assert forces["full"] < 1e-13 * forces["bare"]
    rocker = made.balancing_table()["full rocker"]
    assert rocker["counterweight arm [mm]"] == pytest.approx(-150.0)


@every(
    ("table", "words"),
    [
        ('method = "ful"', "variants.x.balancing.method"),
        ('crank = { mass = "5 kg" }', "variants.x.balancing.method is missing"),
        ('method = "partial"\ncrank = { arm = "-50" }', "variants.x.balancing.crank.arm has no unit"),
        ('method = "partial"\ncrank = { arm = "-5 kg" }', 'variants.x.balancing.crank.arm "kg" does not measure'),
        ('method = "partial"\ncrank = { arm = -50 }', "variants.x.balancing.crank.arm must be text of a number"),
        ('method = "partial"\ncrank = { mas = "5 kg" }', "variants.x.balancing.crank.mas is not a key here; .* 'mass'"),
        ('method = "partial"\ncrank = "5 kg"', "variants.x.balancing.crank must be a table of keys"),
        (
            'method = "partial"\ncrank = { mass = "5 kg", keep_out = "-1 mm" }',
            "variants.x.balancing.crank.keep_out must",
        ),
        (
            'method = "partial"\nratio = "acros"\ncrank = { mass = "5 kg" }',
            r"variants\.x\.balancing\.ratio[: ].*'across'",
        ),
        ('method = "partial"\nslider = { mass = "5 kg" }', "variants.x.balancing.slider is not a key here"),
        ('method = "partial"\ncrank = { mass = "5 kg" }\ncoupler = { mass = "5 kg" }', "variants.x.*coupler"),
        ('method = "partial"\ncrank = { mass = "5 kg", arm = "5 mm" }', "variants.x.*either mass or arm, not both"),
        ('method = "partial"\ncrank = {}', "variants.x.*either mass or arm, not neither"),
        ('method = "partial"', "variants.x.*needs a counterweight on the crank: balancing.crank"),
        ('method = "full"\ncrank = { mass = "5 kg" }', "variants.x: full .* crank and coupler, got crank only"),
        ('method = "optimal"', "variants.x: .*give at least one counterweight"),
        ('method = "optimal"\nnorm = "larges"\ncrank = { mass = "5 kg" }', "variants.x.balancing.norm.*'largest'"),
        ('method = "optimal"\nrocker = { mass = "5 kg" }', "variants.x: .*'rocker', allowed: 'crank'"),
    ],
)
def test_wrong_balancing_table_is_one_problem(tmp_path, table, words):
    (found,) = problems(tmp_path, X + table + "\n")
    assert re.match(words, found)


def test_all_balancing_problems_are_reported_at_once(tmp_path):
    text = X + 'method = "ful"\ncrank = { arm = "1" }\n[variants.y.balancing]\nmethod = "partial"\n'
    assert len(problems(tmp_path, text)) == 3
