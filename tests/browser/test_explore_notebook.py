"""Explore in a notebook of JupyterLab: curves follow a slider, and the next cell has the scene that is shown."""

import json
import os
import re
import subprocess
import sys
import threading
import time
from importlib.util import find_spec

import pytest

pytest.importorskip("anywidget")
pytest.importorskip("selenium")
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.expected_conditions import staleness_of
from selenium.webdriver.support.ui import WebDriverWait

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("jupyterlab") is None, reason="JupyterLab is not installed"),
]
TOKEN = "token-of-this-test"
PATIENCE = 90.0
"""Seconds in which the kernel starts and answers on a machine that is busy with other tests."""
SOON = 15.0
"""Seconds in which a cell begins to run after its keys were pressed."""
CELLS = {
    "show": "import kinetostatics as ks\nw = ks.explore('sawframe_2r63', variant='cam-circle')\nw",
    "print": "import json\nprint('shown:', json.dumps([w.scene.parameters['slider.mass'], w.state]))",
    "second": "v = ks.explore(w.scene)\nv",
    "again": "w",
    "set": "w.state = {'variant': 'plain', 'values': {'crank_length': 0.25}}",
    "set variant": "w.state = {'variant': 'plain'}",
    "end": "import os\nos._exit(1)",
}
CURVES = "return [...arguments[0].querySelectorAll('.chart .curve')].map((path) => path.getAttribute('d'))"


def notebook(cells):
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    empty = {"cell_type": "code", "metadata": {}, "execution_count": None, "outputs": []}
    made = [empty | {"id": name, "source": text} for name, text in cells.items()]
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": made}


class Notebook:
    """A notebook open in JupyterLab."""

    def __init__(self, driver):
        self.driver = driver
        unready = (WebDriverException, IndexError)  # JupyterLab places cells one after another
        self.wait = WebDriverWait(driver, PATIENCE, poll_frequency=0.1, ignored_exceptions=unready)
        self.soon = WebDriverWait(driver, SOON, poll_frequency=0.1, ignored_exceptions=unready)

    def cell(self, name):
        """A cell."""
        return self.driver.find_elements(By.CSS_SELECTOR, ".jp-Notebook .jp-CodeCell")[list(CELLS).index(name)]

    def run(self, name):
        """Run a cell, as a person does: the keys are pressed again when the cell does not begin."""
        self.wait.until(lambda _: self.idle())
        before = self.wait.until(lambda _: self.prompt(name))
        self.wait.until(lambda _: self.press(name) and self.soon.until(lambda _: self.prompt(name) != before))

    def idle(self):
        """Whether the kernel has started and ended its work."""
        return self.driver.find_elements(By.CSS_SELECTOR, ".jp-Notebook-ExecutionIndicator[data-status=idle]")

    def prompt(self, name):
        """Number of a cell's last run, a star while it runs; "" before JupyterLab has drawn the cell."""
        return self.cell(name).find_element(By.CSS_SELECTOR, ".jp-InputPrompt").text

    def press(self, name):
        """Put the caret into a cell and press the keys that run it."""
        cell = self.cell(name)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'start'})", cell)
        cell.find_element(By.CSS_SELECTOR, ".cm-content").click()
        ActionChains(self.driver).key_down(Keys.SHIFT).send_keys(Keys.ENTER).key_up(Keys.SHIFT).perform()
        return True

    def page(self, name):
        """The explore page below a cell, when it shows curves."""
        self.wait.until(lambda _: self.cell(name).find_elements(By.CSS_SELECTOR, ".explore .chart .curve"))
        return self.cell(name).find_element(By.CSS_SELECTOR, ".explore")

    def curves(self, page):
        """Outlines of all curves."""
        return self.driver.execute_script(CURVES, page)

    def row(self, page, path):
        """The row of a parameter."""
        return page.find_element(By.CSS_SELECTOR, f'.row[title="{path}"]')

    def number(self, page, path):
        """The number in the field of a parameter, in its shown unit."""
        return float(self.row(page, path).find_element(By.CSS_SELECTOR, "[type=number]").get_property("value"))

    def rests(self, element):
        """Scroll to an element; whether it stays in its place, as when all numbers of its page are shown."""
        script = "arguments[0].scrollIntoView({block: 'center'}); return arguments[0].getBoundingClientRect().top"
        before = self.driver.execute_script(script, element)
        time.sleep(0.5)
        return self.driver.execute_script(script, element) == before

    def drag(self, page, path, pixels):
        """Drag a slider; the curves, when they have followed."""
        slider, before = self.row(page, path).find_element(By.CSS_SELECTOR, "[type=range]"), self.curves(page)
        self.wait.until(lambda _: self.rests(slider))
        ActionChains(self.driver).click_and_hold(slider).move_by_offset(pixels, 0).release().perform()
        self.wait.until(lambda _: self.curves(page) != before)
        return self.curves(page)

    def printed(self):
        """Mass and state that the next cell prints, when the page has put them into the widget."""
        time.sleep(1.0)
        self.run("print")
        text = self.wait.until(lambda _: re.search(r"shown: (\[.*\])", self.cell("print").text))
        return json.loads(text[1])


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """Address of a JupyterLab with the notebook; it has its own settings and asks nobody for news."""
    folder = tmp_path_factory.mktemp("lab")
    (folder / "explore.ipynb").write_text(json.dumps(notebook(CELLS)), encoding="utf-8")
    settings = folder / "settings" / "@jupyterlab" / "apputils-extension"
    settings.mkdir(parents=True)
    quiet = {"fetchNews": "false", "checkForUpdates": False}
    (settings / "notification.jupyterlab-settings").write_text(json.dumps(quiet), encoding="utf-8")
    own = {"JUPYTER_CONFIG_DIR": "config", "JUPYTER_DATA_DIR": "data", "JUPYTER_RUNTIME_DIR": "runtime"}
    own |= {"IPYTHONDIR": "ipython", "JUPYTERLAB_SETTINGS_DIR": "settings", "JUPYTERLAB_WORKSPACES_DIR": "workspaces"}
    environment = os.environ | {name: str(folder / place) for name, place in own.items()}
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--ServerApp.port=0", "--allow-root"]
    command += [f"--IdentityProvider.token={TOKEN}", f"--ServerApp.root_dir={folder}"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment) as server:
        try:
            places = (re.search(r"http://(?:localhost|127\.0\.0\.1):\d+/", line) for line in server.stderr)
            address = next(place[0] for place in places if place)
            threading.Thread(target=server.stderr.read, daemon=True).start()  # a full pipe would stop it
            yield f"{address}lab/tree/explore.ipynb?token={TOKEN}"
        finally:
            server.terminate()


@pytest.fixture(scope="module")
def opened(driver, lab):
    """The notebook in JupyterLab."""
    driver.get_log("performance")
    driver.get(lab)
    found = Notebook(driver)
    found.wait.until(lambda _: driver.find_elements(By.CSS_SELECTOR, ".jp-Notebook .jp-CodeCell .cm-content"))
    return found


@pytest.fixture
def shown(opened):
    """The notebook with the page of a new widget below its first cell."""
    before = opened.cell("show").find_elements(By.CSS_SELECTOR, ".explore")
    opened.run("show")
    for element in before:
        opened.wait.until(staleness_of(element))
    return opened, opened.page("show")


def test_curves_follow_a_slider_and_the_next_cell_has_the_scene(shown):
    notebook, page = shown
    notebook.drag(page, "slider.mass", 25)
    mass = notebook.number(page, "slider.mass")
    assert mass > 600.0
    assert notebook.printed() == [mass, {"variant": "cam-circle", "values": {"slider.mass": mass}}]


def test_two_widgets_do_not_disturb_each_other(shown):
    notebook, page = shown
    notebook.run("second")
    other = notebook.page("second")
    before, others = notebook.curves(page), notebook.drag(other, "slider.mass", 25)
    assert notebook.curves(page) == before
    notebook.drag(page, "slider.mass", -25)
    assert notebook.curves(other) == others


def test_two_pages_of_one_widget_show_one_machine(shown):
    notebook, page = shown
    notebook.run("again")
    other = notebook.page("again")
    curves = notebook.drag(page, "slider.mass", 25)
    notebook.wait.until(lambda _: notebook.curves(other) == curves)
    assert notebook.number(other, "slider.mass") == notebook.number(page, "slider.mass") != 600.0


def test_a_state_set_in_a_cell_is_shown(shown):
    notebook, page = shown
    before = notebook.curves(page)
    notebook.run("set")
    notebook.wait.until(lambda _: notebook.curves(page) != before)
    assert page.find_element(By.CSS_SELECTOR, "[aria-selected=true]").text == "plain"
    assert notebook.number(page, "crank_length") == 0.25
    notebook.run("set variant")
    notebook.wait.until(lambda _: notebook.number(page, "crank_length") == 0.3)
    notebook.drag(page, "slider.mass", 25)
    mass = notebook.number(page, "slider.mass")
    assert notebook.printed() == [mass, {"variant": "plain", "values": {"slider.mass": mass}}]


def test_keys_in_the_page_do_not_edit_the_notebook(shown):
    notebook, page = shown
    before = notebook.number(page, "slider.mass")
    slider = notebook.row(page, "slider.mass").find_element(By.CSS_SELECTOR, "[type=range]")
    notebook.driver.execute_script("arguments[0].focus()", slider)
    ActionChains(notebook.driver).send_keys("b", "d", "d", Keys.ARROW_RIGHT).perform()
    notebook.wait.until(lambda _: notebook.number(page, "slider.mass") > before)
    assert len(notebook.driver.find_elements(By.CSS_SELECTOR, ".jp-Notebook .jp-CodeCell")) == len(CELLS)


def test_nothing_is_loaded_from_elsewhere(shown, lab):
    notebook, _ = shown
    events = [json.loads(entry["message"])["message"] for entry in notebook.driver.get_log("performance")]
    asked = [item["params"]["request"]["url"] for item in events if item["method"] == "Network.requestWillBeSent"]
    assert any("anywidget" in url for url in asked)
    own = (lab.partition("/lab/")[0], "data:", "blob:")
    assert [url for url in asked if not url.startswith(own)] == []


def test_a_page_whose_kernel_has_ended_says_it(shown):
    notebook, page = shown
    notebook.run("end")
    notebook.wait.until(lambda _: "kernel has ended" in page.find_element(By.CSS_SELECTOR, ".problem").text)
