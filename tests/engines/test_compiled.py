"""Whether numba can be had: what is said, and what goes on without it."""

import sys

import numpy as np
import pytest

import kinetostatics as ks
from support.scenes import (
    SAMPLES,
    SCENES,
    solve,
)


def test_missing_numba_is_said_with_the_way_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    with pytest.raises(ks.errors.MissingLibraryError, match=r'pip install "kinetostatics\[fast\]".*engine="numpy"'):
        solve(SCENES["plain"], SAMPLES, engine="compiled")


def test_single_precision_is_refused_by_the_compiled_engine(interpreted):
    with (
        pytest.warns(UserWarning, match="single precision"),
        pytest.raises(ks.ParameterError, match='double precision; use engine="numpy"'),
    ):
        solve(SCENES["plain"], SAMPLES.astype(np.float32), engine="compiled")
