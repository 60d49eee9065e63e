"""Importing the package is cheap, and all its names are there when asked for."""

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import kinetostatics as ks

pytestmark = pytest.mark.slow

HEAVY = ("matplotlib", "numba", "pandas", "pint", "pydantic", "scipy.optimize", "scipy.stats", "sympy")
FEW = 3
"""Modules that importing the package may load, the standard library's aside."""


def printed(code):
    root = Path(ks.__file__).parents[1]
    return subprocess.run([sys.executable, "-c", code], cwd=root, check=True, capture_output=True, text=True).stdout


def test_import_loads_next_to_nothing_and_solve_no_heavy_library():
    loaded = "{name for name in sys.modules if name.partition('.')[0] not in sys.stdlib_module_names}"
    code = (
        f"import sys; before = {loaded}; import kinetostatics as ks; print(len({loaded} - before)); "
        f"ks.solve, ks.compile; print([name for name in {HEAVY} if name in sys.modules])"
    )
    count, heavy = printed(code).splitlines()
    assert 1 <= int(count) <= FEW
    assert heavy == "[]"


@pytest.mark.parametrize("arguments", [["list"], ["run", "sawframe_2r63"], ["compare", "sawframe_2r63"]])
def test_a_command_loads_no_library_that_it_does_not_use(arguments):
    used = {"numba", "pydantic"} if arguments != ["list"] else set()
    code = f"import sys; from kinetostatics.cli import main; status = main({arguments}); print(status, *sys.modules)"
    status, *loaded = printed(code).splitlines()[-1].split()
    assert status == "0"
    assert not ({*HEAVY} - used) & {*loaded}


@pytest.mark.parametrize("package", [ks, ks.design])
def test_the_stub_gives_every_public_name_its_place(package):
    """Type checkers read it, and so does the package when a name is first used."""
    stub = Path(package.__file__).with_suffix(".pyi").read_text("utf-8")
    places = [
        (item.module, alias)
        for item in ast.parse(stub).body
        if isinstance(item, ast.ImportFrom)
        for alias in item.names
    ]
    assert all(alias.asname == alias.name for _, alias in places)  # only these are names for type checkers
    assert sorted(alias.name for _, alias in places) == package.__all__
    assert set(package.__all__) <= set(dir(package))
    for module, alias in places:
        place = f"{package.__name__}.{module or alias.name}"
        found = getattr(import_module(place), alias.name, None) if module else import_module(place)
        assert getattr(package, alias.name) is (found or import_module(f"{place}.{alias.name}"))


def test_every_public_name_is_there_by_star():
    found: dict = {}
    exec("from kinetostatics import *", found)
    assert set(ks.__all__) <= set(found)


def test_a_name_is_looked_for_once_and_is_the_same_as_in_its_module():
    from kinetostatics.solution.scene import solve

    assert ks.solve is solve
    assert vars(ks)["solve"] is solve


def test_a_name_that_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'kinetostatics' has no attribute 'sovle'"):
        ks.sovle  # noqa: B018 - looking it up is the test
