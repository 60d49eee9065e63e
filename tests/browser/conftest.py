"""A real browser without a window, in which pages that the library makes are opened."""

import importlib.util
import os
import shutil
from contextlib import ExitStack
from functools import cache

import pytest

TOOLS = ("chromium", "chromedriver")
"""A browser and what drives it, as Debian's packages of these names install them."""

QUIET = ("--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run")
"""The browser asks nobody for news of its own."""


def missing():
    """What is lacking to run a browser, as a sentence, or ""."""
    lacking = [name for name in TOOLS if shutil.which(name) is None]
    lacking += [name for name in ("selenium", "jinja2") if importlib.util.find_spec(name) is None]
    return f"a browser is needed for these tests; not installed: {', '.join(lacking)}" if lacking else ""


@pytest.fixture(scope="module")
def driver(request):
    """Chromium, driven by Selenium, that keeps a log of its console and of all that it asks for.

    It ends with its tests, and does not draw turning mechanisms beside all others. A module that measures time has
    `LOGS = ("browser",)`: a log of all that is asked for costs as much time as the page.
    """
    if missing():
        pytest.skip(missing())
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    for word in (*QUIET, "--headless=new", "--disable-dev-shm-usage", "--hide-scrollbars", "--window-size=1240,1000"):
        options.add_argument(word)
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    options.binary_location = shutil.which(TOOLS[0])
    logs = getattr(request.module, "LOGS", ("browser", "performance"))
    options.set_capability("goog:loggingPrefs", dict.fromkeys(logs, "ALL"))
    found = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which(TOOLS[1])))
    found.set_script_timeout(60)
    yield found
    found.quit()


@pytest.fixture(scope="module")
def explored(driver):
    """Opens explore pages: `explored("pumpjack", "--variant", "weights")`; those of the same options share a server."""
    from support.explored import ExplorePage, explore_server

    with ExitStack() as servers:
        address = cache(lambda *options: servers.enter_context(explore_server(*options)))
        yield lambda *options, fields="": ExplorePage(driver, address(*options), fields)
