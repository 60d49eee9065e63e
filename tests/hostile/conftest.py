"""Hostile input ends at once: within two seconds and a gigabyte, whatever is handed in."""

import resource
import signal
import sys

import pytest

SECONDS = 2
BYTES = 10**9


def _memory():
    """Largest memory this process has held, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


@pytest.fixture(autouse=True)
def soon_and_small(request):
    """Stops a test, or an input of it, after two seconds, and fails it for taking a gigabyte.

    One that is marked `slow_start` has a minute.
    """

    def late(*_):
        raise TimeoutError(f"took more than {SECONDS} s")

    allowed = 60 if request.node.get_closest_marker("slow_start") else SECONDS
    before, held = signal.signal(signal.SIGALRM, late), _memory()
    signal.setitimer(signal.ITIMER_REAL, allowed, allowed)  # `support.every` begins anew with each input
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert _memory() - held < BYTES
