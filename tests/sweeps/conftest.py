"""What tests of workers and folders compare with."""

import pytest

from support import factories
from support.sweeping import sweep


@pytest.fixture(scope="session")
def expected():
    """What a sweep of pumps gives here."""
    return sweep(factories.pump, factories.DESIGNS, factories.OUTPUTS)
