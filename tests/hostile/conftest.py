"""Hostile input ends at once: within two seconds of computing and a gigabyte, whatever is handed in."""

import resource
import sys

import pytest

from support.every import limited

SECONDS = 2
BYTES = 10**9


def _memory():
    """Largest memory this process has held, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


@pytest.fixture(autouse=True)
def soon_and_small(request):
    """Stops a test, or an input of it, after two seconds, and fails it for taking a gigabyte.

    One that is marked `slow` or `slow_start` has a minute.
    """
    held = _memory()
    patient = any(map(request.node.get_closest_marker, ("slow", "slow_start")))
    with limited(60 if patient else SECONDS):
        yield
    assert _memory() - held < BYTES
