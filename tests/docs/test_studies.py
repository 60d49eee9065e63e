"""Each figure of the studies is drawn, with its number on it; what pages compute is asserted when they are built."""

import re

import pytest

from support import pages

pytestmark = pages.needed
FIGURES = {
    "sawframe": {"3", "5", "6a", "6b", "7a", "7b"},
    "mower": {"5a", "5b", "6a", "6b"},
    "chain_unit": {"5", "6", "7", "8", "9", "10", "11", "12"},
}


@pytest.mark.parametrize("name", ["sawframe", "mower"])
def test_study_page_draws_its_figures_and_numbers(name):
    code = "\n".join(pages.cells(f"studies/{name}.md"))
    titles = re.findall(r'set_title\(f?"figure (\w+)', code) + re.findall(r'"(\d[ab])[,:]', code)
    for letters in re.findall(r'zip\(axes, "(ab)"', code):
        titles += [f"6{letter}" for letter in letters]
    assert set(titles) >= FIGURES[name]


@pytest.mark.parametrize("name", FIGURES)
def test_a_page_asserts_what_it_shows(name):
    code = "\n".join(pages.cells(f"studies/{name}.md"))
    assert code.count("assert ") >= 2
    compile(code, name, "exec")
