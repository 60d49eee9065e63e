"""Each formula of the theory is what the library computes, and each drawing shows forces in equilibrium."""

import re

import numpy as np
import pytest

import kinetostatics as ks
from support import pages
from support.every import every

pytestmark = pages.needed
theory = pages.script("draw_theory")
PAGES = sorted(path.relative_to(pages.DOCS).as_posix() for path in pages.DOCS.glob("theory/*.md"))
CHECKED = [path for path in PAGES if path != "theory/index.md"]
APART = ("crank_slider", "four_bar", "lever", "cylinder", "yoke", "cam_roller")
DRAWINGS = theory.DRAWINGS if theory else {}


@pytest.mark.slow
@pytest.mark.parametrize("path", CHECKED)
def test_formulas_of_a_page_are_those_of_the_library(path):
    names: dict = {}
    for number, code in enumerate(pages.cells(path)):
        exec(compile(code, f"{path}, cell {number}", "exec"), names)
    assert "ks" in names


@every("path", CHECKED)
def test_a_page_names_sources_and_shows_pictures(path):
    text = (pages.DOCS / path).read_text(encoding="utf-8")
    assert "*Source:*" in text or path == "theory/signs.md"
    for picture in re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text):
        assert (pages.DOCS / "theory" / picture).exists()


def test_a_formula_with_a_wrong_sign_is_found():
    first, code = pages.cells("theory/place_and_resolve.md")[:2]
    names: dict = {}
    exec(first, names)
    with pytest.raises(AssertionError):
        exec(code.replace("slope = (ratio**2 * d - dot", "slope = (ratio**2 * d + dot"), names)


@pytest.mark.slow
@pytest.mark.parametrize("name", DRAWINGS)
def test_a_drawing_comes_out_as_it_is_shown(name):
    shown = (theory.FOLDER / f"{name}.svg").read_text(encoding="utf-8")
    assert len(shown.encode()) < 100_000
    pages.same_picture(shown, theory.drawn(name))


@pytest.mark.parametrize("name", APART)
def test_drawn_bodies_are_in_equilibrium(name, monkeypatch):
    """All of them, with the load: so each is drawn on the right body, and with the right sign."""
    seen = {}
    monkeypatch.setattr(theory, "apart", lambda solution, *rest, **more: seen.update(solution=solution))
    getattr(theory, name)()
    s = seen["solution"]
    (load,) = s.loads
    for link, some in theory.forces(s).items():
        total = sum(force for _, _, force, _ in some)
        if isinstance(load, ks.ProcessForce) and link == "slider":
            total = total + load.force * np.ravel(s.mechanism.guides[link].direction)
        elif isinstance(load, ks.Force) and load.at[0] == link:
            total = total + load.value * np.array([np.cos(load.direction), np.sin(load.direction)])
        assert np.abs(total).max() < 1e-9, link
