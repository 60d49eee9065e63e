"""A mechanism that is built on the explore page: groups and loads are added, changed and removed."""

import pytest

pytest.importorskip("selenium")
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from support.explored import ExplorePage, explore_server

pytestmark = pytest.mark.slow


class Builder(ExplorePage):
    """The explore page of a chain with its list of groups."""

    def settled(self):
        """Wait until curves and forms belong to the state that is asked for."""
        super().settled()
        self.wait(lambda: self.script("return page.groups.settled"))

    @property
    def titles(self):
        """Titles of the parts."""
        return self.script("return [...document.querySelectorAll('.part > summary')].map((item) => item.textContent)")

    def wait_for(self, *titles):
        """Wait until these parts are there and all is settled."""
        self.wait(lambda: set(titles) <= set(self.titles))
        self.settled()

    def add(self, kind):
        """Add a group or load of a kind."""
        self.settled()
        Select(self.find(".adding select")).select_by_visible_text(kind)
        self.find(".adding button").click()

    def part(self, title):
        """The form of a part, opened."""
        self.settled()
        found = self.all(".part")[self.titles.index(title)]
        self.driver.execute_script("arguments[0].open = true", found)
        return found

    def field(self, title, name):
        """The field of a key of a part."""
        labels = self.part(title).find_elements(By.CSS_SELECTOR, ".field")
        return next(item for item in labels if item.find_element(By.CSS_SELECTOR, ".name").text == name)

    def type(self, title, name, text):
        """Type another text for a key and leave the field."""
        entry = self.field(title, name).find_element(By.TAG_NAME, "input")
        entry.clear()
        entry.send_keys(text, Keys.TAB)

    def press(self, title, text):
        """Press a button of a part."""
        buttons = self.part(title).find_elements(By.TAG_NAME, "button")
        next(item for item in buttons if item.text == text).click()

    @property
    def kinds(self):
        """Kinds of the groups in the state that is asked for."""
        return [group["kind"] for group in self.state["chain"]["groups"]]


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    with explore_server("--new", "four-bar", "--folder", tmp_path_factory.mktemp("explore")) as found:
        yield found


@pytest.fixture
def page(driver, address):
    driver.set_window_size(1400, 1000)
    return Builder(driver, address)


def test_a_group_is_added_changed_by_a_slider_removed_and_comes_back_by_undo(page):
    page.wait_for("crank", "gravity", "1 rocker B", "1 torque", "2 force")
    page.add("slider")
    page.wait_for("2 slider C")
    before = page.values("balancing_torque")
    page.slide("slider2.mass", 1.5)
    page.wait(lambda: page.values("balancing_torque") != before)
    entry = page.field("2 slider C", "slider mass").find_element(By.TAG_NAME, "input")
    assert entry.get_attribute("value") == "1.5 kg"
    page.add("slider")
    page.wait_for("3 slider D")
    page.press("3 slider D", "Remove")
    page.wait(lambda: "3 slider D" not in page.titles)
    page.press("2 slider C", "Remove")
    page.wait(lambda: page.kinds == ["rocker"])
    for kinds in (["rocker", "slider"], ["rocker", "slider", "slider"], ["rocker", "slider"]):
        page.find(".tools button").click()
        page.wait(lambda kinds=kinds: page.kinds == kinds)
    page.settled()
    assert page.script("return page.shown.values['slider2.mass']") == 1.5
    assert page.severe() == []


def test_a_wrong_text_is_told_beside_its_field_and_changes_nothing(page):
    page.wait_for("1 rocker B")
    state = page.state
    page.type("1 rocker B", "rocker length", "long <b>")
    fault = page.field("1 rocker B", "rocker length").find_element(By.CSS_SELECTOR, ".fault")
    page.wait(lambda: "groups[1].rocker_length must be text of a number" in fault.text)
    assert "long <b>" in fault.text
    assert page.state == state
    page.type("1 rocker B", "rocker length", "320 mm")
    page.wait(lambda: page.state["chain"]["groups"][0]["rocker_length"] == "320 mm")
    page.wait(
        lambda: page.script("return [...document.querySelectorAll('.groups .fault')].every((p) => !p.textContent)")
    )
    assert page.severe() == []


def test_a_group_that_carries_others_is_removed_with_them_on_request(page):
    page.add("slider")
    page.wait_for("2 slider C")
    page.add("process force")
    page.wait_for("3 process force")
    page.press("2 slider C", "Remove")
    page.wait(lambda: "carries loads[3] (process force); remove these too" in page.part("2 slider C").text)
    page.press("2 slider C", "Remove all")
    page.wait(lambda: page.kinds == ["rocker"])
    assert len(page.state["chain"]["loads"]) == 2


def test_a_load_that_the_machine_cannot_take_is_refused_beside_the_list(page):
    page.wait_for("1 rocker B")
    page.add("spring")
    page.wait(lambda: "four-bar has no slider" in page.find(".groups .fault").text)
    assert page.severe() == []


def test_names_with_markup_are_text(page):
    page.add("slider")
    page.wait_for("2 slider C")
    page.type("2 slider C", "pin", "<img src=x onerror=alert(1)>")
    page.wait(lambda: "2 slider <img src=x onerror=alert(1)>" in page.titles)
    page.settled()
    assert page.severe() == []


def test_the_address_reopens_the_chain(page, driver):
    page.add("dyad")
    page.wait(lambda: page.kinds == ["rocker", "dyad"])
    page.settled()
    page.wait(lambda: "dyad" in driver.current_url)
    again = Builder(driver, driver.current_url)
    again.wait(lambda: again.kinds == ["rocker", "dyad"])
    again.wait(lambda: any(title.startswith("2 dyad") for title in again.titles))
