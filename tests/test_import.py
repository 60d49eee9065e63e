"""Importing the package is cheap, and all its names are there when asked for."""

import ast
import pickle
import shutil
import subprocess
import sys
from importlib import import_module, resources
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics import errors, version

pytestmark = pytest.mark.slow

HEAVY = (
    *("anywidget", "matplotlib", "numba", "pandas", "pint", "pydantic", "scipy.optimize", "scipy.stats", "sympy"),
    "tornado",
)
FEW = 3
"""Modules that importing the package may load, the standard library's aside."""


def printed(code):
    root = Path(ks.__file__).parents[1]
    return subprocess.run([sys.executable, "-c", code], cwd=root, check=True, capture_output=True, text=True).stdout


def test_import_is_light():
    loaded = "{name for name in sys.modules if name.partition('.')[0] not in sys.stdlib_module_names}"
    code = (
        f"import sys; before = {loaded}; import kinetostatics as ks; print(len({loaded} - before)); "
        f"ks.solve, ks.compile; print([name for name in {HEAVY} if name in sys.modules])"
    )
    count, heavy = printed(code).splitlines()
    assert 1 <= int(count) <= FEW
    assert heavy == "[]"


@pytest.mark.parametrize("arguments", [["list"], ["run", "sawframe_2r63"], ["compare", "sawframe_2r63"]])
def test_commands_load_only_what_they_use(arguments):
    used = {"numba", "pydantic"} if arguments != ["list"] else set()
    code = f"import sys; from kinetostatics.cli import main; status = main({arguments}); print(status, *sys.modules)"
    status, *loaded = printed(code).splitlines()[-1].split()
    assert status == "0"
    assert not ({*HEAVY} - used) & {*loaded}


@pytest.mark.parametrize("package", [ks, ks.design])
def test_stub_places_every_public_name(package):
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


def test_public_names_are_complete():
    found: dict = {}
    exec("from kinetostatics import *", found)
    assert set(ks.__all__) <= set(found)


def test_name_is_looked_up_once():
    from kinetostatics.solution.scene import solve

    assert ks.solve is solve
    assert vars(ks)["solve"] is solve


def test_absent_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'kinetostatics' has no attribute 'sovle'"):
        ks.sovle  # noqa: B018 - looking it up is the test


# One version, wherever it is asked


def test_version_has_three_numbers():
    assert ks.__version__ == version.__version__
    assert all(part.isdigit() for part in version.__version__.split("."))
    assert version.__version__.count(".") == 2


# Whoever installs the package has its types (PEP 561)


PACKAGE = Path(str(resources.files(ks)))


@pytest.mark.parametrize("marked", [True, False])
def test_mypy_reads_types_of_the_package(tmp_path, marked):
    modulefinder = pytest.importorskip("mypy.modulefinder")
    installed = tmp_path / "kinetostatics"
    installed.mkdir()
    shutil.copy(PACKAGE / "__init__.py", installed)
    if marked:
        shutil.copy(PACKAGE / "py.typed", installed)
    paths = modulefinder.SearchPaths(python_path=(), mypy_path=(), package_path=(str(tmp_path),), typeshed_path=())
    found = modulefinder.FindModuleCache(paths, None, None).find_module("kinetostatics")
    assert (found == str(installed / "__init__.py")) == marked
    assert (found == modulefinder.ModuleNotFoundReason.FOUND_WITHOUT_TYPE_HINTS) != marked


# Errors


MADE = [
    errors.ParameterError("wrong", designs=[1, 2]),
    errors.AssemblyError("does not close", ((0.1, 0.2),)),
    errors.JammingError("jams", (0.3,)),
    errors.DesignError("cannot be met", {"coupler_length": 2.0}),
    errors.DriveError("stalls", missing=3.0, crank_angle=1.0),
    errors.QuantityError("no such"),
    errors.NotGivenError("not given"),
    errors.MissingLibraryError("not installed"),
    errors.FileError("no file"),
    errors.CaseError("saw.toml", ["a", "b"]),
]


@pytest.mark.parametrize("error", MADE, ids=lambda error: type(error).__name__)
def test_errors_are_one_family_and_picklable(error):
    again = pickle.loads(pickle.dumps(error))
    assert isinstance(error, errors.KinetostaticsError)
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


def test_every_error_of_the_module_is_tried_here():
    kinds = {kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, Exception)}
    family = {kind for kind in kinds if issubclass(kind, errors.KinetostaticsError)} - {errors.KinetostaticsError}
    assert family == set(map(type, MADE))
    assert all(issubclass(kind, Warning) for kind in kinds - family - {errors.KinetostaticsError})


def test_hints_name_their_place_and_are_picklable():
    for hint in (errors.HintWarning("saw.toml", "variants.plain", "is it in mm?"), errors.HintWarning("is it in mm?")):
        again = pickle.loads(pickle.dumps(hint))
        assert again.hint == hint.hint == "is it in mm?"
        assert str(again) == str(hint)
    assert str(errors.HintWarning("saw.toml", "variants.plain", "is it?")) == "saw.toml: variants.plain: is it?"
