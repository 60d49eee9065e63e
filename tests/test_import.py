"""Importing the package is cheap."""

import subprocess
import sys
from pathlib import Path

import kinetostatics as ks

HEAVY = ("matplotlib", "pandas", "pint", "pydantic", "scipy.optimize", "sympy")


def test_import_leaves_heavy_libraries_alone_until_they_are_used():
    code = f"import sys, kinetostatics; print([name for name in {HEAVY} if name in sys.modules])"
    root = Path(ks.__file__).parents[1]
    done = subprocess.run([sys.executable, "-c", code], cwd=root, check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "[]"
