"""Notebooks are kept as they were run, with pictures, and small; that they run is for ``.ci/run``."""

import pytest

from support.pages import script

NOTEBOOKS = script("execute_notebooks")


@pytest.mark.parametrize("path", sorted(NOTEBOOKS.FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebook_is_kept_with_its_outputs(path):
    assert not list(NOTEBOOKS.problems(path)), "run: python docs/execute_notebooks.py " + path.stem
