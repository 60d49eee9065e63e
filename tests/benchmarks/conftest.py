"""What all benchmarks share."""

import pytest

from kinetostatics.studies import timing


@pytest.fixture(scope="session")
def tell(request):
    """Prints a line past pytest's capturing; first of all the machine and the versions."""
    capturing = request.config.pluginmanager.getplugin("capturemanager")

    def line(text):
        with capturing.global_and_fixture_disabled():
            print(f"\n{text}", end="")

    for text in timing.circumstances().values():
        line(text)
    return line
