"""Whatever a user calls is declared, explained, and shown by an example that runs as a test."""

import inspect
import json
import pydoc
import re
import types
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.machine import group

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))
MODULES = {name: found for name in ks.__all__ if isinstance(found := getattr(ks, name), types.ModuleType)}
FIRST_SCREEN = 24
"""Lines of a terminal."""


def public_names():
    """Functions and classes by the name that users call them by."""
    named = {f"ks.{name}": getattr(ks, name) for name in ks.__all__}
    for module, found in MODULES.items():
        named |= {f"ks.{module}.{name}": getattr(found, name) for name in found.__all__}
    return {name: item for name, item in named.items() if inspect.isclass(item) or inspect.isfunction(item)}


def constructors():
    """Methods of classes that make an object, by the name that users call them by."""
    return {
        f"{name}.{method}": getattr(item, method)
        for name, item in public_names().items()
        if inspect.isclass(item)
        for method, found in vars(item).items()
        if isinstance(found, classmethod | staticmethod) and not method.startswith("_")
        if isinstance(found, classmethod) or found.__annotations__.get("return") == item.__name__
    }


def parameters(item):
    """Names of the arguments that a call may give; none of what the library raises."""
    if inspect.isclass(item) and issubclass(item, BaseException):
        return []
    return [name for name in inspect.signature(item).parameters if not name.startswith("_")]


PUBLIC = public_names()
CALLED = PUBLIC | constructors()
MADE_BY_OTHERS = re.compile(r"\b(made|returned|raised|warned|given) (by|of|where|when|from)\b", re.IGNORECASE)


@pytest.mark.parametrize("module", MODULES)
def test_dir_of_a_public_module_shows_its_public_names_only(module):
    found = MODULES[module]
    assert sorted(dir(found)) == sorted(found.__all__)
    assert inspect.getdoc(found)


def test_plots_are_functions_all_of_them():
    assert all(inspect.isfunction(getattr(ks.plots, name)) for name in dir(ks.plots))


@pytest.mark.parametrize("name", CALLED)
def test_every_public_name_says_what_it_is_and_shows_an_example(name):
    text = inspect.getdoc(CALLED[name]) or ""
    assert re.match(r"[A-Z\"`].*[.;:]", text), "its first line must be a sentence"
    _, _, examples = text.partition("\nExamples\n--------\n")
    assert ">>> import kinetostatics as ks\n" in examples


@pytest.mark.parametrize("name", CALLED)
def test_every_argument_is_told_of(name):
    """Of what users make or call themselves; of what they are given, the docstring says by what."""
    item, text = CALLED[name], inspect.getdoc(CALLED[name])
    missing = [parameter for parameter in parameters(item) if not re.search(rf"\b{parameter}\b", text)]
    assert not missing or MADE_BY_OTHERS.search(text), missing


@pytest.mark.parametrize("name", CALLED)
def test_every_argument_that_a_docstring_lists_exists(name):
    item, text = CALLED[name], inspect.getdoc(CALLED[name])
    section = re.search(r"Parameters\n-+\n(.*?)(?:\n\n[A-Z][a-z]+\n---|\Z)", text, flags=re.DOTALL)
    listed = re.findall(r"^([\w*, ]+?)(?: : .*)?$", section[1], flags=re.MULTILINE) if section else []
    told = {part.strip(" *") for line in listed if not line.startswith(" ") for part in line.split(",")}
    assert told - {""} <= set(parameters(item))


@pytest.mark.parametrize("name", [name for name, item in PUBLIC.items() if inspect.isclass(item)])
def test_every_public_method_is_explained(name):
    """Those of a group or cam by the protocol, `kinetostatics.machine.group`."""
    kind = PUBLIC[name]
    own = {method: item for method, item in vars(kind).items() if not method.startswith("_")}
    asked = {method: getattr(item, "func", item) for method, item in own.items()}
    missing = [
        method
        for method, item in asked.items()
        if not re.search(rf"\b{method}\b", group.__doc__)
        and (inspect.isroutine(item) or isinstance(item, property))
        and not inspect.getdoc(getattr(kind, method))
    ]
    assert not missing


def test_help_starts_with_what_to_call_first():
    text = pydoc.plain(pydoc.render_doc(ks))
    shown = "\n".join(text.splitlines()[:FIRST_SCREEN])
    assert "Call first" in shown
    assert all(call in shown for call in ("import kinetostatics as ks", "ks.crank_slider(", ".solve(", "ks.extremes("))
    assert text.index("Call first") < text.index("load_case") < text.index("Rooms")


def test_help_names_every_public_module():
    assert all(re.search(rf"\b{name}\b", ks.__doc__.partition("Rooms")[0]) for name in MODULES)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_import_public_names_only(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    assert not re.findall(r"(?:from|import) +kinetostatics[. ](?!as ks$).*", code, flags=re.MULTILINE)
    for path in re.findall(r"\bks((?:\.\w+)+)", code):
        first, *rest = path[1:].split(".")
        assert first in ks.__all__
        assert first not in MODULES or not rest or rest[0] in MODULES[first].__all__
