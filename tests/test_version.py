"""One version, wherever it is asked."""

import kinetostatics as ks
from kinetostatics import version


def test_the_package_tells_its_version_in_three_numbers():
    assert ks.__version__ == version.__version__
    assert all(part.isdigit() for part in version.__version__.split("."))
    assert version.__version__.count(".") == 2
