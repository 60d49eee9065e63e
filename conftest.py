"""Examples in docstrings: figures are closed behind them, and what needs an extra is skipped where it is missing."""

import importlib.util
import re
import sys

import pytest

NEEDS_FLINT = re.compile(r"(certified|enclosure|relative_errors|precision\.study(_running)?|stability\.study)\(")
"""Calls that compute at many digits (extra `precision`)."""


@pytest.fixture(autouse=True)
def _example(request):
    if not isinstance(request.node, pytest.DoctestItem):
        yield
        return
    source = "".join(example.source for example in request.node.dtest.examples)
    if NEEDS_FLINT.search(source) and importlib.util.find_spec("flint") is None:
        pytest.skip("python-flint is not installed (extra: precision)")
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")
