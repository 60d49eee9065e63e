"""The page on explore: its code runs, its numbers are those of the library, its film and picture are small."""

import re
import tomllib

import numpy as np
import pytest

import kinetostatics as ks
from support.pages import DOCS, cells, needed, shown_code, text_of

pytestmark = needed
PAGE = "explore.md"
MAX_FILM = 1_500_000
"""Bytes, as the film stands on the first screen of the README."""


def test_cell_gives_the_ratios_that_the_task_names(capsys):
    for cell in cells(PAGE):
        exec(cell, {})
    ratios = [float(text) for text in re.findall(r"torque (\S+) times less", capsys.readouterr().out)]
    np.testing.assert_allclose(ratios, [6.1, 5.5, 57.9, 39.2], atol=0.05)
    text = " ".join(text_of(DOCS / PAGE).split())
    assert "the mean torque is 6.1 times less" in text
    stiffness, mass = re.search(r"(\d+) kN/m balance (\d+) kg at 320 rpm", text).groups()
    assert float(mass) == pytest.approx(1e3 * float(stiffness) / (320 * np.pi / 30) ** 2, abs=0.5)


def test_cells_of_the_notebook_run():
    pytest.importorskip("anywidget")
    names = {"ks": ks, "case": ks.load_case("sawframe_2r63")}
    for block in shown_code(text_of(DOCS / PAGE)):
        exec(block, names)
    assert names["w"].scene.parameters["spring.stiffness"] == 805e3


def test_extra_has_all_that_the_page_needs():
    project = tomllib.loads((DOCS.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = {re.match(r"[\w-]+", item)[0] for item in project["optional-dependencies"]["explore"]}
    assert named == {"anywidget", "tornado"}


def test_film_is_small():
    assert 0 < (DOCS / "explore" / "film.gif").stat().st_size <= MAX_FILM
