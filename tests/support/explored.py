"""The explore page in a browser: a server of its own for each, and what the page shows."""

import json
import subprocess
import sys
from contextlib import contextmanager

import pytest

pytest.importorskip("selenium", reason="selenium is not installed (extra: browser)")
pytest.importorskip("tornado", reason="tornado is not installed (extra: explore)")
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

READY = 60.0
"""Seconds in which a server and its page must be ready on a busy machine; alone they take under three."""


@contextmanager
def explore_server(*options):
    """A server `kinetostatics explore` with these options, ended after the block; the address of its page."""
    command = [sys.executable, "-m", "kinetostatics", "explore", *map(str, options), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            yield next(line.strip() for line in server.stdout if line.startswith("http"))
        finally:
            server.terminate()


class ExplorePage:
    """The explore page of an address, opened in a browser."""

    def __init__(self, driver, address, fields=""):
        self.driver = driver
        driver.get("about:blank")
        for kind in driver.log_types:
            driver.get_log(kind)
        driver.get(address + fields)
        self.wait(lambda: self.script("return document.querySelector('.explore').dataset.shown"))

    def wait(self, condition):
        """Wait until a function is true; its value."""
        return WebDriverWait(self.driver, READY, poll_frequency=0.02).until(lambda _: condition())

    def script(self, text, *values):
        """Value of a script; `page` is the Explore of the page."""
        before = "const page = document.querySelector('.explore').explore; "
        return self.driver.execute_script(before + text, *values)

    def find(self, selector):
        """First element of a selector of CSS."""
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector):
        """All elements of a selector of CSS."""
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    @property
    def state(self):
        """State that is asked for."""
        return self.script("return page.state")

    def settled(self):
        """Wait until what is shown belongs to the state that is asked for, curves of the reference included."""
        self.wait(lambda: self.script("return page.settled"))

    def values(self, name):
        """Values of the curve of a quantity in SI, all its parts one after another; None while none are shown."""
        return self.script("return page.shown && Array.from(page.shown.quantities[arguments[0]].values)", name)

    def row(self, path):
        """Slider, number field and button back of a parameter."""
        found = self.find(f".row[title='{path}']")
        return [found.find_element(By.CSS_SELECTOR, part) for part in ("[type=range]", "[type=number]", ".back")]

    def slide(self, path, value, end=True):
        """Move a slider to a number in its unit, as a pointer does; without the end the hand stays on it."""
        slider = self.row(path)[0]
        kinds = ["input", "change"] if end else ["input"]
        script = "arguments[0].value = arguments[1]; "
        script += "arguments[2].forEach((kind) => arguments[0].dispatchEvent(new Event(kind, {bubbles: true})))"
        self.driver.execute_script(script, slider, value, kinds)
        if end:
            self.settled()

    def write(self, path, text):
        """Type a number into the field of a parameter."""
        self.row(path)[1].send_keys(Keys.CONTROL, "a", Keys.NULL, text, Keys.ENTER)
        self.settled()

    def button(self, text):
        """Button whose text ends so."""
        return next(found for found in self.all(".tools button") if found.text.endswith(text))

    def tab(self, name):
        """Choose a variant."""
        next(found for found in self.all("[role=tab]") if found.text == name).click()
        self.settled()

    def severe(self):
        """Errors on the console."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def asked(self):
        """Addresses that the page asked for."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [item["params"]["request"]["url"] for item in events if item["method"] == "Network.requestWillBeSent"]
