"""What all tests share."""

import os

import pytest


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):
    """A folder for compiled programs that goes with pytest's others, unless the environment names one."""
    with pytest.MonkeyPatch.context() as patch:
        if not os.environ.get("KINETOSTATICS_CACHE"):
            patch.setenv("KINETOSTATICS_CACHE", str(tmp_path_factory.mktemp("compiled")))
        yield
