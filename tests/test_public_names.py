"""Whatever a user calls is declared, explained, and shown by an example that runs as a test."""

import inspect
import json
import pkgutil
import pydoc
import re
import types
from functools import cache
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.machine import group
from support.every import every

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))
FIRST_SCREEN = 24
"""Lines of a terminal."""
GIVEN = re.compile(r"\b(made|returned|given) by\b|\breturns? (it|them)\b|\bis one of\b", re.IGNORECASE)
"""How a docstring says where users get an object that they do not make."""


@cache
def modules():
    """Public modules by name."""
    return {name: found for name in ks.__all__ if isinstance(found := getattr(ks, name), types.ModuleType)}


@cache
def public():
    """Functions and classes by the name that users call them by."""
    named = {f"ks.{name}": getattr(ks, name) for name in ks.__all__}
    for module, found in modules().items():
        named |= {f"ks.{module}.{name}": getattr(found, name) for name in found.__all__}
    return {name: item for name, item in named.items() if inspect.isclass(item) or inspect.isfunction(item)}


@cache
def called():
    """The same with methods of classes that make an object."""
    return public() | {
        f"{name}.{method}": getattr(item, method)
        for name, item in public().items()
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


def undocumented(kind):
    """Public methods and properties of a class without a docstring, but those of the protocol of groups and cams."""
    own = {name: getattr(item, "func", item) for name, item in vars(kind).items() if not name.startswith("_")}
    return [
        name
        for name, item in own.items()
        if not re.search(rf"\b{name}\b", group.__doc__)
        and (inspect.isroutine(item) or isinstance(item, property))
        and not inspect.getdoc(getattr(kind, name))
    ]


def test_no_function_has_the_name_of_a_module():
    """Importing the module would put it in the function's place."""
    for package in (ks, *modules().values()):
        files = {file.name for file in pkgutil.iter_modules(getattr(package, "__path__", ()))}
        assert not [name for name in files & set(package.__all__) if not inspect.ismodule(getattr(package, name))]


def test_dir_of_public_modules_is_public():
    for found in modules().values():
        assert sorted(dir(found)) == sorted(found.__all__)
        assert inspect.getdoc(found)


def test_plots_are_functions_all_of_them():
    assert all(inspect.isfunction(getattr(ks.plots, name)) for name in dir(ks.plots))


def test_every_public_name_says_what_it_is():
    wrong = [name for name, item in called().items() if not re.match(r"[A-Z\"`].*[.;:]", inspect.getdoc(item) or "")]
    assert not wrong, "their docstrings must begin with a sentence"


def test_every_public_name_shows_an_example():
    texts = {name: inspect.getdoc(item) or "" for name, item in called().items()}
    ends = {name: text.partition("\nExamples\n--------\n")[2] for name, text in texts.items()}
    assert not [name for name, text in ends.items() if ">>> import kinetostatics as ks\n" not in text]


def test_every_argument_is_documented():
    missing = {}
    for name, item in called().items():
        text = inspect.getdoc(item)
        untold = [argument for argument in parameters(item) if not re.search(rf"\b{argument}\b", text)]
        if untold and not (inspect.isclass(item) and GIVEN.search(text)):
            missing[name] = untold
    assert not missing


def test_every_argument_that_a_docstring_lists_exists():
    strange = {}
    for name, item in called().items():
        section = re.search(r"Parameters\n-+\n(.*?)(?:\n\n[A-Z][a-z]+\n---|\Z)", inspect.getdoc(item), flags=re.DOTALL)
        heads = re.findall(r"^(\S.*?)(?: : .*)?$", section[1], flags=re.MULTILINE) if section else []
        told = {part.strip(" *") for head in heads for part in head.split(",")}
        if told - set(parameters(item)):
            strange[name] = told - set(parameters(item))
    assert not strange


def test_docstring_sections_are_in_order():
    order = ["Parameters", "Attributes", "Methods", "Returns", "Raises", "Warns", "Notes", "Examples"]
    wrong = {}
    for name, item in called().items():
        sections = re.findall(r"^(\w+)\n-{5,}$", inspect.getdoc(item), flags=re.MULTILINE)
        if sections != [section for section in order if section in sections]:
            wrong[name] = sections
    assert not wrong


@pytest.mark.slow
def test_every_public_method_is_explained():
    classes = {name: item for name, item in public().items() if inspect.isclass(item)}
    assert not {name: missing for name, item in classes.items() if (missing := undocumented(item))}


@pytest.mark.slow
def test_help_starts_with_what_to_call_first():
    text = pydoc.plain(pydoc.render_doc(ks))
    shown = "\n".join(text.splitlines()[:FIRST_SCREEN])
    assert "Call first" in shown
    assert all(call in shown for call in ("import kinetostatics as ks", "ks.crank_slider(", ".solve(", "ks.extremes("))
    assert text.index("Call first") < text.index("load_case") < text.index("docs/contributors.md")


def test_help_names_every_public_module():
    shown = ks.__doc__.partition("docs/contributors.md")[0]
    assert all(re.search(rf"\b{name}\b", shown) for name in modules())


@every("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_imports_public_names_only(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    assert set(re.findall(r"^.*\b(?:from|import) +kinetostatics\b.*$", code, flags=re.MULTILINE)) == {
        "import kinetostatics as ks"
    }
    for first, second in re.findall(r"\bks\.(\w+)(?:\.(\w+))?", code):
        assert first in ks.__all__
        assert first not in modules() or second in modules()[first].__all__
