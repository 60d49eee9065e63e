"""Every page is found, its links lead somewhere, its code is run by the build; the first page keeps its promise."""

import re

import numpy as np
import pytest

from support.pages import DOCS, RUN_AT_BUILD, code_cells, links, pages, shown_code, text_of

PAGES = pages()
LINES = 15
"""Of code, from a drawing to its forces."""
RUN_BY_TESTS = {"gallery": "tests/docs/test_gallery.py", "api/loads": "tests/machine/loads/test_kinked.py"}
"""Pages that show code as the repository's own page does, and the test that runs it."""


@pytest.mark.parametrize("name", PAGES)
def test_links_lead_to_pages_and_files(name):
    for link in links(text_of(PAGES[name])):
        path, _, _ = link.partition("#")
        if "://" in link or not path:
            continue
        notebook = re.fullmatch(r"(?:\.\./)*(notebooks/.*)", path)  # copied beside the pages when they are built
        found = DOCS.parent / notebook[1] if notebook else PAGES[name].parent / path
        assert found.resolve().exists(), link


def test_every_page_stands_in_one_list_of_pages():
    below = {}
    for name, path in PAGES.items():
        for tree in re.findall(r"```\{toctree\}\n(.*?)```", text_of(path), flags=re.DOTALL):
            entries = [line.strip() for line in tree.splitlines() if line.strip() and not line.startswith(":")]
            for entry in entries:
                full = (path.parent / entry).relative_to(DOCS).as_posix()
                assert full not in below, f"{full} stands in {below.get(full)} and {name}"
                below[full] = name
    assert set(PAGES) - {"index"} <= set(below)


@pytest.mark.parametrize("name", PAGES)
def test_python_on_pages_is_run_by_build_or_test(name):
    text = text_of(PAGES[name])
    if code_cells(text):
        assert RUN_AT_BUILD.match(text), "a page with code cells needs the header of docs/start.md"
    if shown_code(text):
        assert (DOCS.parent / RUN_BY_TESTS[name]).exists()


@pytest.mark.parametrize("name", PAGES)
def test_pages_name_no_host_to_load_from(name):
    assert not re.search(r"!\[[^\]]*\]\((?:https?:)?//|<(?:script|img|iframe)\b[^>]*//", text_of(PAGES[name]))


def test_first_page_goes_from_drawing_to_forces(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = text_of(PAGES["index"])
    code = code_cells(text)[0]
    assert len([line for line in code.splitlines() if line.strip()]) <= LINES
    names: dict = {}
    exec(compile(code, "index", "exec"), names)
    assert "reaction_O_y [N]" in capsys.readouterr().out
    assert {"reaction_B_x [N]", "guide_force [N]"} <= set(
        (tmp_path / "press.csv").read_text().split("\n")[0].split(",")
    )
    peak = names["ks"].extremes(names["s"], "balancing_torque")
    told = float(re.search(r"(\d+) degrees, where the torque is largest", text)[1])
    assert np.degrees(peak.angle[np.argmax(np.abs(peak.value))]) == pytest.approx(told, abs=0.5)


def test_the_first_page_counts_its_lines():
    written = re.search(r"(\w+) lines of code", text_of(PAGES["index"]))[1]
    assert written == "Fifteen"


def test_certainty_page_says_what_its_code_finds(capsys):
    names: dict = {}
    codes = [code for code in code_cells(text_of(PAGES["this_number"])) if "subprocess" not in code]
    with pytest.warns(UserWarning, match="236.5 deg the first makes 0.89 N m, the second 1.2e"):
        exec(compile("\n".join(codes), "this_number", "exec"), names)
    printed = capsys.readouterr().out
    s, peak = names["s"], names["peak"]
    plain, tight = (s.error_bound("balancing_torque", tight)[peak] for tight in (False, True))
    assert tight < plain < 1e-13 * s.balancing_torque[peak]
    assert max(names["shares"], key=names["shares"].get) == "coupler_length"
    assert f"{s.balancing_torque[peak]:.0f} N m +- " in printed
    single, double = (float(line.split(" +- ")[1]) for line in sorted(printed.splitlines()[-3:-1], reverse=True))
    assert double < 1e-10 < 1e-3 < single
