"""Pages are held to what they say where the documentation can be built."""

from importlib.util import find_spec
from pathlib import Path

import pytest

HERE = Path(__file__).parent


def pytest_collection_modifyitems(items):
    if find_spec("sphinx") is None:
        for item in items:
            if HERE in item.path.parents:
                item.add_marker(pytest.mark.skip(reason="sphinx is not installed (extra: docs)"))
