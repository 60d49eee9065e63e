"""The explore page in a browser: what it loads, hostile titles and addresses, what it keeps, the server gone."""

import json
from urllib.parse import quote

import numpy as np
import pytest

pytest.importorskip("tornado")
pytest.importorskip("selenium")
from selenium.webdriver.common.by import By

import kinetostatics as ks
from kinetostatics.design.case_text import write_case
from support.explored import ExplorePage, explore_server

pytestmark = pytest.mark.slow

PRESS = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(50.0)), 10.0, loads=ks.Gravity())
HOSTILE = "<img src=x onerror=\"document.title='hacked'\"></script><script>document.title='hacked'</script>&#x41;"


def origin(page):
    """Address of the server of a page."""
    return page.driver.current_url.partition("#")[0]


def test_nothing_is_loaded_from_elsewhere(explored):
    page = explored("sawframe_2r63")
    page.settled()
    page.slide("slider.mass", 620)
    server = origin(page)
    asked = page.asked()
    assert set(asked) >= {server, f"{server}explore.js", f"{server}explore.css"}
    assert [address for address in asked if not address.startswith((server, "data:"))] == []
    assert page.severe() == []


def test_the_token_is_in_the_fragment_alone(explored):
    page = explored("sawframe_2r63")
    token = page.script("return new URLSearchParams(location.hash.slice(1)).get('token')")
    assert len(token) >= 32
    assert not any(token in address for address in page.asked())
    assert token not in page.driver.title + page.find("body").text


def test_hostile_titles_names_and_sources_are_texts(explored, tmp_path):
    path = write_case(tmp_path / "hostile.toml", HOSTILE, {HOSTILE: PRESS}, HOSTILE)
    page = explored(path)
    page.settled()
    assert page.find("h1").text == HOSTILE
    assert page.find("[role=tab]").text == HOSTILE
    assert "hacked" not in page.driver.title
    assert page.all(".explore img, .explore script") == []
    assert page.severe() == []


def shown(page):
    """State of the page, as an object."""
    page.settled()
    return page.state


START = {"variant": "plain", "values": {}}
ADDRESSES = {
    "broken": "{",
    "unknown variant": json.dumps({"variant": HOSTILE, "values": {}}),
    "unknown path": json.dumps({"variant": "plain", "values": {HOSTILE: 1}}),
    "1 MB": "0" * 1_000_000,
}


@pytest.mark.parametrize("name", ADDRESSES)
def test_a_hostile_address_gives_words_and_the_first_state(explored, name):
    others = "&show=5&compared=5&planes=7&angle=x"
    page = explored("sawframe_2r63", fields=f"&state={quote(ADDRESSES[name])}{others}")
    assert shown(page) == START
    assert "the address has no state of this case, so the first one is shown" in page.find(".notes").text
    assert "hacked" not in page.driver.title
    assert page.severe() == []


@pytest.mark.parametrize("state", ["{}", '{"variant": "plain"}'])
def test_an_address_without_values_and_with_an_endless_angle_opens(explored, state):
    page = explored("sawframe_2r63", fields=f"&state={quote(state)}&angle=Infinity")
    assert shown(page) == START
    assert page.script("return page.clock.index") == 0
    page.slide("slider.mass", 620)
    assert page.state == {"variant": "plain", "values": {"slider.mass": 620.0}}
    assert page.severe() == []


def test_a_link_reopens_the_state_in_another_tab(explored):
    page = explored("sawframe_2r63")
    page.slide("slider.mass", 620)
    page.wait(lambda: "620" in page.driver.current_url)
    link, state = page.driver.current_url, page.state
    assert state["values"] == {"slider.mass": 620.0}
    page.driver.switch_to.new_window("tab")
    other = ExplorePage(page.driver, link)
    assert shown(other) == state
    page.driver.close()
    page.driver.switch_to.window(page.driver.window_handles[0])


def test_two_pages_do_not_disturb_each_other(explored):
    page = explored("sawframe_2r63")
    first, link = page.driver.current_window_handle, page.driver.current_url
    page.driver.switch_to.new_window("tab")
    other = ExplorePage(page.driver, link)
    other.slide("slider.mass", 620)
    page.driver.close()
    page.driver.switch_to.window(first)
    page.slide("crank_length", 0.31)
    assert page.state["values"] == {"crank_length": 0.31}
    assert page.script("return page.shown.values['slider.mass']") == 600.0


def test_a_case_saved_by_the_page_has_the_numbers_that_it_shows(explored, tmp_path):
    shown = "&show=" + quote('["balancing_torque"]')
    page = explored("sawframe_2r63", "--variant", "cam-circle", "--folder", tmp_path, fields=shown)
    page.slide("slider.mass", 620)

    def press(text):
        page.driver.find_element(By.XPATH, f"//div[contains(@class, 'keep')]//button[.='{text}']").click()

    def told(text):
        page.wait(lambda: text in page.find(".keep .message").text)

    press("Save case")
    told("Saved as sawframe_2r63_changed.toml")
    variant = ks.load_case(tmp_path / "sawframe_2r63_changed.toml").variants["cam-circle"]
    np.testing.assert_array_equal(page.values("balancing_torque"), variant.solve(360).balancing_torque)
    page.slide("slider.mass", 630)
    press("Save case")
    told("sawframe_2r63_changed.toml exists already.")
    assert ks.load_case(tmp_path / "sawframe_2r63_changed.toml").variants["cam-circle"].parameters["slider.mass"] == 620
    press("Replace it")
    told("Saved as")
    assert ks.load_case(tmp_path / "sawframe_2r63_changed.toml").variants["cam-circle"].parameters["slider.mass"] == 630
    press("Copy Python")
    page.wait(lambda: page.find(".keep textarea").is_displayed())
    names: dict = {}
    exec(page.find(".keep textarea").get_attribute("value"), names)
    np.testing.assert_array_equal(page.values("balancing_torque"), names["solution"].balancing_torque)
    press("Report")
    page.wait(lambda: page.all(".keep a"))
    assert (tmp_path / "sawframe_2r63_changed.html").is_file()
    page.driver.get(page.find(".keep a").get_attribute("href"))
    assert "Log frame saw" in page.find("h1").text
    assert page.severe() == []


def test_a_page_without_its_server_says_so(driver):
    with explore_server("sawframe_2r63") as address:
        page = ExplorePage(driver, address)
        page.settled()
    page.wait(lambda: "The library has ended. Start it again" in page.find(".problem").text)


def test_an_address_of_an_earlier_start_says_so(driver):
    with explore_server("sawframe_2r63") as address:
        driver.get(address.partition("#")[0] + "#token=earlier")
        page = ExplorePage.__new__(ExplorePage)
        page.driver = driver
        page.wait(lambda: "This address is of an earlier start" in page.find(".problem").text)
