"""Pages, notebooks and references of the documentation."""

import json
import re
import tomllib
import types

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.schema import designs, meanings, parts, variants
from support.every import every
from support.pages import DOCS, RUN_AT_BUILD, code_cells, links, pages, script, shown_code, text_of

PAGES = pages()
LINES = 15
"""Of code, from a drawing to its forces."""
RUN_BY_TESTS = {
    "gallery": "tests/docs/test_gallery.py",
    "api/loads": "tests/machine/loads/test_kinked.py",
    "explore": "tests/docs/test_explore_page.py",
}
"""Pages that show code as the repository's own page does, and the test that runs it."""


@every("name", PAGES)
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


@every("name", PAGES)
def test_python_on_pages_is_run_by_build_or_test(name):
    text = text_of(PAGES[name])
    if code_cells(text):
        assert RUN_AT_BUILD.match(text), "a page with code cells needs the header of docs/start.md"
    if shown_code(text):
        assert (DOCS.parent / RUN_BY_TESTS[name]).exists()


@every("name", PAGES)
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
    assert written == "fifteen"


@pytest.mark.slow
def test_certainty_page_says_what_its_code_finds(capsys):
    names: dict = {}
    codes = [code for code in code_cells(text_of(PAGES["this_number"])) if "subprocess" not in code]
    with pytest.warns(UserWarning, match="236.5 deg first order 0.89 N m, second order 1.2e"):
        exec(compile("\n".join(codes), "this_number", "exec"), names)
    printed = capsys.readouterr().out
    s, peak = names["s"], names["peak"]
    plain, tight = (s.error_bound("balancing_torque", tight)[peak] for tight in (False, True))
    assert tight < plain < 1e-13 * s.balancing_torque[peak]
    assert max(names["shares"], key=names["shares"].get) == "coupler_length"
    assert f"{s.balancing_torque[peak]:.0f} N m +- " in printed
    single, double = (float(line.split(" +- ")[1]) for line in sorted(printed.splitlines()[-3:-1], reverse=True))
    assert double < 1e-10 < 1e-3 < single


# Every public name stands on one page of the API reference, and no other does


def listed():
    """Names that the pages list, with how often."""
    texts = [text_of(path) for name, path in pages().items() if name.startswith("api/")]
    blocks = [block for text in texts for block in re.findall(r"```\{api\}\n(.*?)```", text, flags=re.DOTALL)]
    return [line for block in blocks for line in block.split() if not line.startswith(":")]


def public():
    """Names as users call them, without the ``ks.``; a name called in two ways by the shorter one."""
    modules = {name: found for name in ks.__all__ if isinstance(found := getattr(ks, name), types.ModuleType)}
    short = [name for name in ks.__all__ if name not in modules]
    objects = {id(getattr(ks, name)) for name in short if isinstance(getattr(ks, name), type)}
    deep = [
        f"{module}.{name}"
        for module, found in modules.items()
        for name in found.__all__
        if id(getattr(found, name)) not in objects
    ]
    return short + deep


def test_each_public_name_stands_on_one_page():
    assert sorted(listed()) == sorted(public())


# Notebooks are kept as they were run, with pictures, and small; that they run is for ``.ci/run``

NOTEBOOKS = script("execute_notebooks")


@every("path", sorted(NOTEBOOKS.FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebook_is_kept_with_its_outputs(path):
    assert not list(NOTEBOOKS.problems(path)), "run: python docs/execute_notebooks.py " + path.stem


@every("path", sorted(NOTEBOOKS.FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def test_links_of_notebooks_lead_to_pages_and_notebooks(path):
    cells = json.loads(text_of(path))["cells"]
    for link in links("\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")):
        assert "://" in link or (path.parent / link).exists(), link


# The case-file reference has every key of the schema, each with a meaning and an example that the schema takes

KEYS = script("casefile_keys")
PARTS = KEYS.parts_of_the_reference()
MODELS = {title: model for title, model, _ in KEYS.sections.sections()}


def test_every_table_of_a_case_file_has_a_section():
    whole = KEYS.sections.reached([variants.CaseTable, *variants.VARIANTS.values(), *designs.KINDS.values()])
    told = set(MODELS.values()) - {variants.MechanismVariant}
    assert {model.__name__ for model in whole} == {model.__name__ for model in told}


@every("part", PARTS, ids=lambda part: part.title)
def test_every_key_of_a_table_is_told_of(part):
    elsewhere = set(variants.MechanismVariant.model_fields) if part.title.startswith("Mechanism") else set()
    assert {key.name for key in part.keys} | elsewhere >= set(MODELS[part.title].model_fields)
    for key in part.keys:
        assert key.meaning.endswith("."), key.name
        assert key.takes, key.name
        assert key.default, key.name
        assert key.example, key.name


@every("part", PARTS, ids=lambda part: part.title)
def test_examples_are_toml(part):
    for key in part.keys:
        assert tomllib.loads(key.example)


@pytest.mark.slow
def test_reference_links_lead_to_sections():
    page = KEYS.page()
    anchors = {part.anchor for part in PARTS}
    assert len(anchors) == len(PARTS)
    assert all(link.partition(")")[0] in anchors for link in page.split("](#")[1:])


def test_documented_meanings_belong_to_known_keys():
    keys = {
        name
        for model in parts.MADE_OF
        for key in model.model_fields
        for name in (key, f"{meanings.word_of(model)}.{key}")
    }
    assert set(meanings.MEANINGS) <= keys
