"""Questions on the explore page: numbers, sensitivities and bands follow each change; a search leaves the page live."""

import os
import re
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.numbers.formatting import number

pytest.importorskip("selenium")
pytest.importorskip("tornado")
from selenium.webdriver.common.keys import Keys

pytestmark = pytest.mark.slow
CASE = ks.load_case("sawframe_2r63")
CIRCLE, PLAIN = (CASE.variants[name].scene for name in ("cam-circle", "plain"))
LONG = ["spring.stiffness", "spring.free_position", "coupler_length", "cam.radius", "cam.centre.x", "cam.centre.y"]
"""Parameters of a search that takes many steps."""


@pytest.fixture
def page(explored):
    found = explored("sawframe_2r63", "--variant", "cam-circle")
    found.settled()
    return found


def answered(page, selector=".ask table"):
    """Wait until the numbers belong to what is shown."""
    page.settled()
    page.wait(lambda: page.script("return document.querySelector(arguments[0]).className", selector).find("stale") < 0)


def section(page, title):
    found = next(item for item in page.all(".ask > details > summary") if item.text == title)
    if not page.script("return arguments[0].parentElement.open", found):
        found.send_keys(Keys.ENTER)


def row_of(page, label):
    """Texts of the table row of a quantity or figure by column."""
    script = """const rows = [...document.querySelectorAll(".ask tbody tr")];
        const row = rows.find((one) => one.querySelector("th").textContent.startsWith(arguments[0]));
        return Object.fromEntries([...row.querySelectorAll("td")].map((cell) =>
            [cell.dataset.column, cell.firstChild ? cell.firstChild.textContent : ""]))"""
    return page.script(script, label)


def bars(page):
    """Path and text of each bar."""
    script = """return [...document.querySelectorAll(".bars > ul button")].map((bar) =>
        [bar.dataset.path, bar.querySelector(".amount").textContent])"""
    return page.script(script)


def band(page):
    return page.find(".figure .band").get_attribute("d")


def texts(scene):
    """Largest torque, and its ratio and that of the means to the plain saw, as the page shows them."""
    solution, plain = scene.solve(360), PLAIN.solve(360)
    largest = ks.extremes(solution, "balancing_torque").range[1]
    ratio = ks.compare(plain, solution).mean_torque_ratio
    return number(largest if abs(largest) < 1e4 else largest / 1e3), f"{ratio:.4g}"


def shown_texts(page):
    return row_of(page, "balancing torque")["largest"], row_of(page, "mean |balancing torque|")["ratio"]


def test_numbers_follow_each_change_and_are_grey_until_then(page):
    answered(page)
    assert shown_texts(page) == texts(CIRCLE)
    page.slide("spring.stiffness", 7e5)
    assert page.script("return [...document.querySelectorAll('.ask table')].every((one) => one.matches('.stale'))")
    answered(page)
    assert shown_texts(page) == texts(CIRCLE.varied({"spring.stiffness": 7e5}))
    page.script("page.compare(true)")
    page.wait(lambda: page.script("return page.reference.label.includes(' at ')"))
    answered(page)
    assert row_of(page, "mean |balancing torque|")["ratio"] == "1"
    assert page.severe() == []


def test_numbers_of_what_cannot_be_assembled_stay_grey(page):
    answered(page)
    before = shown_texts(page)
    page.script("page.set('coupler_length', 0.1, false)")
    page.settled()
    assert page.find(".problem").is_displayed()
    page.script("page.questions.follow()")
    assert "stale" in page.find(".ask table").get_attribute("class")
    page.script("page.set('coupler_length', 2.0219, false)")
    answered(page)
    assert shown_texts(page) == before


def test_bars_answer_what_to_change_and_lead_to_its_slider(page):
    section(page, "What should I change?")
    answered(page, ".bars")
    found = bars(page)
    assert found[0][0] == "coupler_length"
    assert re.fullmatch("−51\\.\\d %", found[0][1])
    sizes = [float(text.replace("−", "-").rstrip(" %")) for _, text in found]
    assert [abs(size) for size in sizes] == sorted(map(abs, sizes), reverse=True)
    page.slide("crank_speed", 300)
    answered(page, ".bars")
    assert bars(page) != found
    path = bars(page)[1][0]
    page.find(f".bars > ul button[data-path='{path}']").send_keys(Keys.ENTER)
    assert page.driver.switch_to.active_element == page.row(path)[0]
    assert page.severe() == []


def test_another_output_has_other_bars(page):
    section(page, "What should I change?")
    answered(page, ".bars")
    first = bars(page)
    page.find(".bars").find_element("xpath", "..").find_elements("css selector", "select")[1].send_keys("slider pos")
    page.wait(lambda: bars(page) != first)
    assert bars(page)[0][0] == "coupler_length"


def test_bands_of_the_case_follow_each_change(page):
    assert not band(page)
    section(page, "Tolerances")
    page.wait(lambda: page.all(".uncertainties input[data-path='spring.stiffness']"))
    page.find(".uncertainties input[type=checkbox]").send_keys(Keys.SPACE)
    page.wait(lambda: band(page))
    wide = page.script("const { low, high } = page.curves.figures.get('balancing_torque').chart.area; "
                       "return Math.max(...high.map((value, place) => value - low[place]))")  # fmt: skip
    names = [path for path in CASE.tolerances if path in CIRCLE.parameters]
    page.slide("crank_speed", 300)
    assert not band(page)
    page.wait(lambda: band(page))
    for name in names:
        box = page.find(f".uncertainties input[data-path='{name}']")
        page.driver.execute_script("arguments[0].value = 0; arguments[0].dispatchEvent(new Event('change'))", box)
    flat = "const { low, high } = page.curves.figures.get('balancing_torque').chart.area ?? { low: [0], high: [1] }; "
    page.wait(lambda: page.script(flat + "return high.every((value, place) => value === low[place])"))
    assert wide > 100.0
    assert page.severe() == []


def searches():
    """Numbers of the processes of searches whose servers this test started."""
    parents, found = {}, []
    for folder in Path("/proc").iterdir():
        try:
            if folder.name.isdigit():
                stat = (folder / "stat").read_text().rpartition(")")[2].split()
                parents[int(folder.name)] = int(stat[1])
                if stat[0] != "Z" and b"searching import work" in (folder / "cmdline").read_bytes():
                    found.append(int(folder.name))
        except (FileNotFoundError, ProcessLookupError):
            continue
    return [search for search in found if parents.get(parents[search]) == os.getpid()]


def start(page, paths, reduction="largest size"):
    section(page, "Optimise")
    page.find(".search select + select").send_keys(reduction)
    for path in paths:
        page.find(f".search input[value='{path}']").send_keys(Keys.SPACE)
    page.find(".search button[type=submit]").send_keys(Keys.ENTER)


def step(page):
    found = re.match(r"Step (\d+)", page.find(".search .progress").text)
    return int(found[1]) if found else 0


def test_a_search_runs_while_the_page_answers_and_can_be_cancelled(page):
    start(page, LONG)
    page.wait(lambda: step(page))
    before = step(page)
    page.slide("slider.mass", 620)
    answered(page)
    scene = CIRCLE.varied({"slider.mass": 620.0})
    assert shown_texts(page) == texts(scene)
    page.wait(lambda: step(page) > before)
    assert len(searches()) == 1
    page.find(".search button:not([type=submit])").send_keys(Keys.ENTER)
    page.wait(lambda: page.find(".search .progress").text == "Cancelled.")
    page.wait(lambda: not searches())
    assert page.find(".search button[type=submit]").is_enabled()
    assert page.severe() == []


@pytest.fixture(scope="module")
def best():
    """Stiffness of the spring that the library finds."""
    varied = {"spring.stiffness": (0.0, 1.35e6)}
    found = ks.design.optimise(CIRCLE, varied, "largest_absolute balancing_torque")
    return pytest.approx(found.values["spring.stiffness"], rel=1e-6)


def test_values_of_a_search_are_taken_in_one_step_of_undo(page, best):
    start(page, ["spring.stiffness"])
    page.wait(lambda: page.all(".search .take"))
    page.find(".search .take").send_keys(Keys.ENTER)
    page.settled()
    assert page.state["values"]["spring.stiffness"] == best
    page.script("page.move(-1)")
    page.settled()
    assert page.state["values"] == {}


def test_values_of_a_search_belong_to_the_state_that_was_searched(page, best):
    start(page, ["spring.stiffness"])
    page.slide("slider.mass", 300)
    page.wait(lambda: page.all(".search .take"))
    page.find(".search .take").send_keys(Keys.ENTER)
    page.settled()
    assert page.state["values"] == {"spring.stiffness": best}
    page.tab("plain")
    assert not page.all(".search .take")


def test_a_search_ends_when_another_machine_is_chosen(page):
    start(page, LONG)
    page.wait(lambda: step(page))
    page.tab("plain")
    page.wait(lambda: not searches())
    assert page.find(".search .progress").text == "Cancelled, as another machine is shown."
    assert page.find(".search button[type=submit]").is_enabled()
    assert not page.find(".search button:not([type=submit])").is_enabled()
    start(page, ["coupler.mass"])
    page.wait(lambda: page.all(".search .take"))
    assert page.severe() == []


def test_a_search_that_cannot_be_says_why(page):
    start(page, [])
    assert "Tick" in page.find(".search .progress").text
    page.find(".search textarea").send_keys("largest O <= 1 N")
    start(page, ["spring.stiffness"])
    page.wait(lambda: "no design that keeps all limits" in page.find(".search .progress").text)
    assert page.find(".search button[type=submit]").is_enabled()


def test_a_search_ends_with_its_page(page):
    start(page, LONG)
    page.wait(lambda: step(page))
    assert len(searches()) == 1
    page.driver.get("about:blank")
    page.wait(lambda: not searches())
