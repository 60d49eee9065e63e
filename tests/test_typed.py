"""Whoever installs the package has its types (PEP 561)."""

import shutil
from importlib import resources
from pathlib import Path

import pytest

import kinetostatics as ks

PACKAGE = Path(str(resources.files(ks)))


@pytest.mark.parametrize("marked", [True, False])
def test_mypy_takes_types_from_the_installed_package_for_its_marker_alone(tmp_path, marked):
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
