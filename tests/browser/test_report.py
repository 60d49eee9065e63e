"""The report in a real browser: it opens, asks for nothing, turns under the hand, and says what the library says."""

import json
import re
import time
import warnings
from io import BytesIO

import numpy as np
import pytest
from matplotlib.image import imread

import kinetostatics as ks
from kinetostatics.cycle.rounding import FLOOR
from kinetostatics.mechanics.quantities import components, of_scene

pytest.importorskip("bokeh")
pytest.importorskip("selenium")
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from support.reports import near_change_points

pytestmark = pytest.mark.slow
CASE, OTHER = "sawframe_2r63", "cam-cosine"
USABLE = 30.0
"""Seconds in which the page must be ready on a machine that is busy with other tests; alone it takes under one."""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A report, and the solutions that it is to show."""
    case = ks.load_case(CASE)
    path = ks.report(case, tmp_path_factory.mktemp("report") / "saw.html", variant=OTHER)
    return path, {name: case.solve(name, 360) for name in ("plain", OTHER)}


@pytest.fixture(scope="module")
def page(driver, made):
    """The report, opened; its solutions."""
    opened(driver, made[0])
    return driver, made[1]


def opened(driver, path):
    for kind in ("browser", "performance"):
        driver.get_log(kind)
    driver.get(path.as_uri())
    wait = WebDriverWait(driver, 60, poll_frequency=0.05)
    wait.until(lambda found: found.execute_script("return document.documentElement.dataset.figures"))


def press(driver, *keys):
    ActionChains(driver).send_keys(*keys).perform()


def angle(driver):
    return int(driver.find_element(By.ID, "chosen").text)


def choose(driver, degrees):
    script = "const x = document.getElementById('angle'); x.value = arguments[0]; x.dispatchEvent(new Event('input'))"
    driver.execute_script(script, degrees)
    assert angle(driver) == degrees


def severe(driver):
    return [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]


def test_page_opens_without_errors_or_requests(page, made):
    driver, _ = page
    opened(driver, made[0])
    events = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    asked = [item["params"]["request"]["url"] for item in events if item["method"] == "Network.requestWillBeSent"]
    assert made[0].as_uri() in asked
    assert [url for url in asked if url != made[0].as_uri() and not url.startswith(("data:", "blob:"))] == []
    assert severe(driver) == []


def test_it_is_small_and_soon_usable(page, made, record_property):
    driver, _ = page
    first, all_drawn = (
        float(driver.execute_script(f"return document.documentElement.dataset.{name}")) for name in ("ready", "figures")
    )
    record_property("usable after ms", first)
    record_property("all figures after ms", all_drawn)
    assert first / 1e3 < USABLE
    assert made[0].stat().st_size < 6e6


def test_slider_turns_the_crank_with_its_joints(page):
    driver, solutions = page
    slider = driver.find_element(By.ID, "angle")
    choose(driver, 100)
    slider.send_keys(Keys.ARROW_RIGHT)
    assert angle(driver) == 101
    for row, solution in enumerate(solutions.values()):
        script = """const it = report.drawings[arguments[0]], pin = it.pins[it.machine.moving.indexOf('A')];
            const [x, y] = ['cx', 'cy'].map((name) => pin.getAttribute(name));
            return [(x - it.originX) / it.scale, (it.originY - y) / it.scale]"""
        np.testing.assert_allclose(driver.execute_script(script, row), solution.position("A")[:, 101], atol=2e-4)


def test_links_turn_with_their_joints(page):
    driver, solutions = page
    choose(driver, 60)
    script = """const it = report.drawings[0];
        const path = it.paths.find((_, n) => it.strokes[n].kind === 'bar' && it.strokes[n].poses);
        const at = (share) => {
            const p = path.getPointAtLength(share * path.getTotalLength()).matrixTransform(path.getCTM());
            return [(p.x - it.originX) / it.scale, (it.originY - p.y) / it.scale]; };
        return [at(0), at(1)]"""
    found = driver.execute_script(script)
    np.testing.assert_allclose(found, [[0.0, 0.0], solutions["plain"].position("A")[:, 60]], atol=4e-3)


def test_the_crank_turns_by_keyboard(page):
    driver, _ = page
    driver.find_element(By.TAG_NAME, "h1").click()
    press(driver, Keys.HOME)
    assert angle(driver) == 0
    press(driver, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    assert angle(driver) == 3
    press(driver, Keys.ARROW_LEFT, Keys.ARROW_LEFT, Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    assert angle(driver) == 359
    ActionChains(driver).key_down(Keys.SHIFT).send_keys(Keys.ARROW_RIGHT).key_up(Keys.SHIFT).perform()
    assert angle(driver) == 9


def test_a_number_can_be_typed(page):
    driver, _ = page
    box = driver.find_element(By.ID, "degrees")
    box.send_keys(Keys.CONTROL, "a")
    box.send_keys("275")
    assert angle(driver) == 275
    assert driver.find_element(By.ID, "angle").get_property("value") == "275"


def test_it_plays_by_button_and_space_and_stops(page):
    driver, _ = page
    choose(driver, 10)
    play = driver.find_element(By.ID, "play")
    play.click()
    time.sleep(0.6)
    moved = angle(driver)
    assert 10 < moved < 200
    driver.execute_script("document.activeElement.blur()")
    press(driver, " ")
    stopped = angle(driver)
    time.sleep(0.3)
    assert angle(driver) == stopped
    assert play.get_attribute("aria-label") == "play"


def test_arrows_follow_the_forces_to_one_scale(page):
    driver, solutions = page
    for degrees in (20, 250):
        choose(driver, degrees)
        for row, (name, joint) in ((0, ("plain", "A")), (0, ("plain", "O")), (1, (OTHER, "A"))):
            script = """const it = report.drawings[arguments[0]];
                return [it.arrows[arguments[1]].path.getAttribute('d'), it.scale * it.machine.scale,
                    it.arrows[arguments[1]].group.getAttribute('visibility')]"""
            path, scale, seen = driver.execute_script(script, row, joint)
            assert seen == "visible"
            corners = np.array([[float(part) for part in pair.split()] for pair in re.findall(r"[ML]([^ML]+)", path)])
            found = (corners[3] - corners[0]) * [1, -1] / scale
            largest = np.hypot(*solutions["plain"].reaction("A")).max()
            np.testing.assert_allclose(found, solutions[name].reaction(joint)[:, degrees], atol=2e-3 * largest)


def test_an_arrow_can_be_hidden_and_all_be_longer(page):
    driver, _ = page
    choose(driver, 20)
    shown = "return report.drawings[0].arrows.A.group.getAttribute('visibility')"
    box = driver.find_element(By.CSS_SELECTOR, "[data-arrow='A']")
    box.click()
    assert driver.execute_script(shown) == "hidden"
    box.click()
    assert driver.execute_script(shown) == "visible"


def test_values_at_an_angle_are_the_librarys(page):
    driver, solutions = page
    quantities = driver.execute_script("return report.data.quantities")
    for degrees in (0, 37, 123, 359):
        choose(driver, degrees)
        script = """return [...document.querySelectorAll('td[data-quantity]')]
            .map((cell) => [cell.dataset.quantity, Number(cell.dataset.row), cell.textContent])"""
        cells = driver.execute_script(script)
        assert len(cells) == 2 * len(quantities)
        for name, row, text in cells:
            solution = list(solutions.values())[row]
            if name not in of_scene(solution):
                assert text == ""
                continue
            assert text == told(quantities[name], solution, name, degrees), (name, degrees)


def told(quantity, solution, name, degrees):
    """A value as text, from the library alone."""
    terms = solution.largest_torque_term if of_scene(solution)[name].unit == "N m" else solution.largest_force_term
    rounding = FLOOR * terms if of_scene(solution)[name].unit in ("N", "N m") else 0.0
    parts = [np.broadcast_to(part, solution.shape)[degrees] for part in components(solution, name)]
    parts = [0.0 if abs(part) < rounding else quantity["factor"] * part for part in parts]
    fixed = f"{np.hypot(*parts) if len(parts) > 1 else parts[0]:.{quantity['decimals']}f}"
    fixed = fixed.removeprefix("-") if float(fixed) == 0 else fixed
    if len(parts) == 1 or not any(parts):
        return fixed
    way = f"{np.degrees(np.arctan2(parts[1], parts[0])):.1f}"
    return f"{fixed} ∠ {way.removeprefix('-') if float(way) == 0 else way}°"


def test_cursor_and_point_of_the_hodograph_follow(page):
    driver, solutions = page
    driver.execute_script("document.getElementById('figures').scrollIntoView()")
    time.sleep(0.3)
    choose(driver, 200)
    script = """const tip = report.figures.hodograph.model.renderers.find((x) => x.name === 'tip 1').data_source.data;
        return [tip.x[0], tip.y[0], report.figures.explore.cursor.location]"""
    x, y, place = driver.execute_script(script)
    np.testing.assert_allclose([x, y], 1e-3 * solutions[OTHER].reaction("O")[:, 200], rtol=1e-12)
    assert place == 200


def test_points_of_the_forces_on_the_frame_follow(page):
    driver, solutions = page
    driver.execute_script("""document.querySelector("[data-figure='ground cam']").scrollIntoView()""")
    time.sleep(0.3)
    choose(driver, 200)
    script = """return [0, 1].map((row) => report.figures["ground cam"].model.renderers
        .find((x) => x.name === `tip ${row}`).data_source.data).map(({ x, y }) => [...x, ...y])"""
    without, shown = driver.execute_script(script)
    assert without == []
    np.testing.assert_allclose(shown, 1e-3 * solutions[OTHER].ground["cam"].force[:, 200], rtol=1e-12)


def test_another_quantity_or_vector_can_be_chosen(page):
    driver, solutions = page
    script = """const box = document.getElementById(arguments[0]);
        box.value = arguments[1];
        box.dispatchEvent(new Event('change'));
        const { model } = report.figures[arguments[0]];
        const { data } = model.renderers.find((x) => x.name === 'line 1').data_source;
        return [model.left[0].axis_label.text, [...data.angle], [...(data.value || data.y)], [...(data.x || [])]]"""
    label, degrees, values, _ = driver.execute_script(script, "explore", "cam_force")
    assert label == "cam force [kN]"
    assert degrees[-1] == 360.0
    whole = solutions[OTHER].at(np.radians(degrees))
    np.testing.assert_allclose(values, 1e-3 * whole.cam_force, rtol=1e-12)
    assert max(values) == pytest.approx(1e-3 * ks.extremes(whole, "cam_force").largest, rel=1e-12)
    label, degrees, y, x = driver.execute_script(script, "hodograph", "B")
    assert label == "reaction B, y [kN]"
    np.testing.assert_allclose(y, 1e-3 * whole.at(np.radians(degrees)).reaction("B")[1], rtol=1e-9, atol=1e-12)
    assert np.hypot(x, y).max() == pytest.approx(1e-3 * ks.extremes(whole, "B").largest, rel=1e-12)
    assert severe(driver) == []


def test_a_machine_is_hidden_and_shown_in_all_figures(page):
    driver, _ = page
    shown = """return Object.values(report.figures)
        .map((figure) => figure.model.renderers.find((item) => item.name === 'line 0').visible)"""
    key = driver.find_element(By.CSS_SELECTOR, "[data-machine='0']")
    driver.execute_script("arguments[0].click()", key)
    assert not any(driver.execute_script(shown))
    driver.execute_script("arguments[0].click()", key)
    assert all(driver.execute_script(shown))


def test_it_is_as_wide_as_a_phone(page):
    driver, _ = page
    size = {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": True}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        time.sleep(0.3)
        assert driver.execute_script("return document.documentElement.scrollWidth") <= 400
        assert driver.execute_script("return report.drawings[0].svg.viewBox.baseVal.width") < 400
    finally:
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_a_wide_table_on_a_phone_shows_it_goes_on_and_keeps_the_names_of_its_rows(page):
    driver, _ = page
    size = {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": True}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        time.sleep(0.3)
        wide = driver.find_element(By.CSS_SELECTOR, "#glance .scroll")
        driver.execute_script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", wide)
        assert driver.execute_script("return arguments[0].scrollWidth > arguments[0].clientWidth", wide)

        def shades(place):
            driver.execute_script("arguments[0].scrollLeft = arguments[1]", wide, place)
            time.sleep(0.2)
            rows = imread(BytesIO(wide.screenshot_as_png))[..., 0]
            return [float(np.median(rows[:, column])) for column in (0, -1)]

        (left, right), (left_at_end, right_at_end) = shades(0), shades(10_000)
        assert left == left_at_end == right_at_end == 1.0  # at the left are the names, on white
        assert right < 0.9
        name = wide.find_element(By.CSS_SELECTOR, "tbody th")
        places = "return [...arguments].map((item) => item.getBoundingClientRect().left)"
        assert np.ptp(driver.execute_script(places, wide, name)) < 1.0
        assert driver.find_element(By.ID, "pace").is_displayed()
    finally:
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_hodograph_near_change_point_is_readable(driver, tmp_path):
    with warnings.catch_warnings(action="ignore"):
        opened(driver, ks.report({"a": near_change_points()}, tmp_path / "change.html"))
    scales = """const [x, y] = [report.figures.hodograph.model.x_range, report.figures.hodograph.model.y_range];
        return [x.start, x.end, y.start, y.end]"""
    assert np.abs(driver.execute_script(scales)).max() < 1e3
    choose(driver, 77)
    texts = driver.execute_script("return [...document.querySelectorAll('td.num')].map((cell) => cell.textContent)")
    assert any(re.match(r"\d\.\d{5}e\+\d+ ∠", text) for text in texts)
    assert severe(driver) == []


def test_on_paper_every_figure_stands_as_lines(page):
    driver, _ = page
    driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    many = "return document.querySelectorAll(arguments[0]).length"
    assert driver.execute_script(many, ".printed svg path") > 50
    assert driver.execute_script(many, ".printed svg[viewBox]") == driver.execute_script(many, "[data-figure]")


def test_hostile_names_run_nothing(driver, tmp_path):
    hostile = "</script><script>document.title='run'</script><img src=x onerror=\"document.title='run'\"> $$x$$"
    hostile += " @{y} {{ z }} \u202eשלום"
    press_scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(mass=50.0)), 10.0)
    path = ks.report({hostile: press_scene, "__proto__": press_scene}, tmp_path / "hostile.html", title=hostile)
    opened(driver, path)
    assert severe(driver) == []
    assert driver.title.startswith("</script>")
    assert hostile in driver.execute_script("return document.querySelector('.panel b').textContent")
    assert driver.find_elements(By.TAG_NAME, "img") == []


def test_it_is_printed_to_a_pdf(tmp_path):
    scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(mass=50.0)), 10.0)
    ks.report(scene, tmp_path / "x.html", pdf=tmp_path / "x.pdf")
    content = (tmp_path / "x.pdf").read_bytes()
    assert content.startswith(b"%PDF")
    assert 2 <= len(re.findall(rb"/Type\s*/Page\b", content)) <= 12
