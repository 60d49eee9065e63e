"""The report in a real browser: it opens, asks for nothing, turns under the hand, and says what the library says."""

import json
import re
import time
import warnings
from contextlib import contextmanager
from io import BytesIO

import numpy as np
import pytest
from matplotlib.image import imread

import kinetostatics as ks
from kinetostatics.cycle.rounding import FLOOR
from kinetostatics.mechanics.quantities import components, of_scene

pytest.importorskip("jinja2")
pytest.importorskip("selenium")
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from support.reports import near_change_points
from support.reports import page as html_of

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
    wait.until(lambda found: found.execute_script("return document.documentElement.dataset.ready"))


def press(driver, *keys):
    ActionChains(driver).send_keys(*keys).perform()


def angle(driver):
    return int(driver.find_element(By.CSS_SELECTOR, ".chosen").text)


def choose(driver, degrees):
    script = "x.value = arguments[0]; x.dispatchEvent(new Event('input'))"
    driver.execute_script(f"const x = document.querySelector('input.angle'); {script}", degrees)
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
    ready = float(driver.execute_script("return document.documentElement.dataset.ready"))
    record_property("usable after ms", ready)
    assert ready / 1e3 < USABLE
    assert made[0].stat().st_size < 1.2e6


def test_slider_turns_the_crank_with_its_joints(page):
    driver, solutions = page
    slider = driver.find_element(By.CSS_SELECTOR, "input.angle")
    choose(driver, 100)
    slider.send_keys(Keys.ARROW_RIGHT)
    assert angle(driver) == 101
    for row, solution in enumerate(solutions.values()):
        script = """const it = document.body.report.drawings[arguments[0]];
            const { pin } = it.machine.pins.find(({ name }) => name === 'A');
            return it.metres(...['cx', 'cy'].map((name) => pin.getAttribute(name)))"""
        np.testing.assert_allclose(driver.execute_script(script, row), solution.position("A")[:, 101], atol=2e-4)


def test_links_turn_with_their_joints(page):
    driver, solutions = page
    choose(driver, 60)
    script = """const it = document.body.report.drawings[0], { strokes } = it.data;
        const path = it.machine.paths.find((_, n) => strokes[n].kind === 'bar' && strokes[n].poses);
        const at = (share) => {
            const p = path.getPointAtLength(share * path.getTotalLength()).matrixTransform(path.getCTM());
            return it.metres(p.x, p.y); };
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
    box = driver.find_element(By.CSS_SELECTOR, "input.degrees")
    box.send_keys(Keys.CONTROL, "a")
    box.send_keys("275")
    assert angle(driver) == 275
    assert driver.find_element(By.CSS_SELECTOR, "input.angle").get_property("value") == "275"


def test_it_plays_by_button_and_space_and_stops(page):
    driver, _ = page
    choose(driver, 10)
    play = driver.find_element(By.CSS_SELECTOR, "button.play")
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
            script = """const it = document.body.report.drawings[arguments[0]];
                return [it.arrows[arguments[1]].path.getAttribute('d'), it.scale * it.frame.scale,
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
    shown = "return document.body.report.drawings[0].arrows.A.group.getAttribute('visibility')"
    box = driver.find_element(By.CSS_SELECTOR, "[data-arrow='A']")
    box.click()
    assert driver.execute_script(shown) == "hidden"
    box.click()
    assert driver.execute_script(shown) == "visible"


def test_values_at_an_angle_are_the_librarys(page):
    driver, solutions = page
    quantities = driver.execute_script("return document.body.report.data.quantities")
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


CHARTED = """const chart = document.body.report.charts[arguments[0]];
    const texts = (group) => [...group.children].map((text) => text.textContent);
    const numbers = (item, names) => names.map((name) => Number(item.getAttribute(name)));
    return {
        labels: texts(chart.labels), ticks: texts(chart.texts), period: chart.across,
        paths: [...chart.lines.children].map((path) => path.getAttribute("d")),
        tips: [...chart.dots.children].filter((dot) => dot.getAttribute("visibility") === "visible")
            .map((dot) => chart.value(numbers(dot, ["cx", "cy"]))),
        cursor: chart.value([parseFloat(chart.needle.getAttribute("d").slice(1)), 0])[0],
        pixel: [1 / chart.scaleX, 1 / chart.scaleY],
        curves: Object.fromEntries(chart.curves.map((curve) => {
            const points = [];
            chart.visit(curve, (x, y) => points.push([x, y]), () => points.push([null, null]));
            return [curve.name, points];
        })),
    }"""
"""What a figure shows: its texts, its curves as they become paths, and its points, in the unit shown."""


def charted(driver, name):
    found = driver.execute_script(CHARTED, name)
    curves = {key: np.array(points, dtype=float).T for key, points in found["curves"].items()}
    assert [path != "" for path in found["paths"][: len(curves)]] == [True] * len(curves)
    return found | {"curves": curves}


def at(degrees, wanted):
    """Places of crank angles in a curve; between them stand extremes."""
    places = np.searchsorted(degrees, wanted - 1e-9)
    np.testing.assert_allclose(degrees[places], wanted, atol=1e-9)
    return places


def choose_in(driver, figure, name):
    script = """const box = document.querySelector(`[data-chooses=${arguments[0]}]`);
        box.value = arguments[1];
        box.dispatchEvent(new Event('change'))"""
    driver.execute_script(script, figure, name)
    return charted(driver, figure)


def test_curve_of_the_torque_is_the_solutions(page):
    driver, solutions = page
    found = charted(driver, "torque")
    degrees, values = found["curves"][OTHER]
    torque = solutions[OTHER].balancing_torque
    np.testing.assert_allclose(values[at(degrees, np.arange(361))], 1e-3 * np.append(torque, torque[0]), rtol=1e-14)
    extremes = 1e-3 * ks.extremes(solutions[OTHER], "balancing_torque").value
    assert (values.max(), values.min()) == pytest.approx((extremes.max(), extremes.min()), rel=1e-13)
    assert found["labels"] == ["crank angle [°]", "balancing torque [kN·m]"]
    assert (found["period"], found["ticks"][:5]) == ([0, 360], ["0", "90", "180", "270", "360"])
    assert set(found["curves"]) == set(solutions)


def test_cursor_and_points_of_figures_follow(page):
    driver, solutions = page
    choose(driver, 200)
    torque = charted(driver, "torque")
    assert torque["cursor"] == pytest.approx(200, abs=0.01 * torque["pixel"][0])
    for tip, solution in zip(torque["tips"], solutions.values(), strict=True):
        assert tip[1] == pytest.approx(1e-3 * solution.balancing_torque[200], abs=0.01 * torque["pixel"][1])
    for name, forces in (
        ("hodograph", [solution.reaction("O") for solution in solutions.values()]),
        ("ground cam", [solutions[OTHER].ground["cam"].force]),
    ):
        found = charted(driver, name)
        wanted = [1e-3 * force[:, 200] for force in forces]
        np.testing.assert_allclose(found["tips"], wanted, atol=0.01 * found["pixel"][0])


def test_a_machine_without_a_quantity_has_no_curve(page):
    driver, _ = page
    assert list(charted(driver, "ground cam")["curves"]) == [OTHER]
    assert list(choose_in(driver, "explore", "cam_force")["curves"]) == [OTHER]


def test_another_quantity_or_vector_can_be_chosen(page):
    driver, solutions = page
    found = choose_in(driver, "explore", "cam_force")
    assert found["labels"][1] == "cam force [kN]"
    degrees, values = found["curves"][OTHER]
    assert degrees[-1] == 360.0
    whole = solutions[OTHER].at(np.radians(degrees))
    np.testing.assert_allclose(values, 1e-3 * whole.cam_force, rtol=1e-12)
    assert max(values) == pytest.approx(1e-3 * ks.extremes(whole, "cam_force").largest, rel=1e-12)
    found = choose_in(driver, "hodograph", "B")
    assert found["labels"] == ["reaction B, x [kN]", "reaction B, y [kN]"]
    x, y = found["curves"][OTHER]
    angles = driver.execute_script("return document.body.report.charts.hodograph.curves[1].angle")
    there = 1e-3 * whole.at(np.radians([*angles, 0.0])).reaction("B")
    np.testing.assert_allclose([x, y], there, rtol=1e-9, atol=1e-12)
    assert np.hypot(x, y).max() == pytest.approx(1e-3 * ks.extremes(whole, "B").largest, rel=1e-12)
    assert choose_in(driver, "explore", "O")["labels"][1] == "|reaction O| [kN]"
    assert severe(driver) == []


def test_a_machine_is_hidden_and_shown_in_all_figures(page):
    driver, _ = page
    shown = """return Object.values(document.body.report.charts).map((chart) => chart.curves.map(({ name }) => name))"""
    before = driver.execute_script(shown)
    key = driver.find_element(By.CSS_SELECTOR, "[data-machine='0']")
    driver.execute_script("arguments[0].click()", key)
    assert driver.execute_script(shown) == [[name for name in names if name != "plain"] for names in before]
    assert key.get_attribute("aria-pressed") == "false"
    driver.execute_script("arguments[0].click()", key)
    assert driver.execute_script(shown) == before
    assert all("plain" in names or names == [OTHER] for names in before)


def test_a_figure_chooses_the_angle_and_reads_its_curves(page):
    driver, solutions = page
    svg = driver.find_element(By.CSS_SELECTOR, "[data-figure='torque'] svg")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", svg)
    place = driver.execute_script("const it = document.body.report.charts.torque; return it.x(90) + 58 - it.width / 2")
    ActionChains(driver).move_to_element_with_offset(svg, round(place), 0).click().perform()
    assert angle(driver) == pytest.approx(90, abs=1)
    script = "return [...document.body.report.charts.torque.values.children].map((text) => text.textContent)"
    head, *lines = driver.execute_script(script)
    assert float(head.rstrip("°")) == pytest.approx(90, abs=1)
    for line, (name, solution) in zip(lines, solutions.items(), strict=True):
        torque = 1e-3 * solution.balancing_torque[88:93]
        assert torque.min() <= float(re.fullmatch(rf"{name}: (\S+) kN·m", line)[1]) <= torque.max()


@contextmanager
def on_phone(driver):
    """The page as a phone shows it, to the end of the block."""
    size = {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": True}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        time.sleep(0.3)
        yield
    finally:
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_it_is_as_wide_as_a_phone(page):
    driver, _ = page
    with on_phone(driver):
        assert driver.execute_script("return document.documentElement.scrollWidth") <= 400
        assert driver.execute_script("return document.body.report.drawings[0].svg.viewBox.baseVal.width") < 400


def test_a_wide_table_on_a_phone_shows_it_goes_on_and_keeps_the_names_of_its_rows(page):
    driver, _ = page
    with on_phone(driver):
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
        assert driver.find_element(By.CSS_SELECTOR, "select.pace").is_displayed()


def test_on_paper_every_figure_stands_as_lines(page):
    driver, _ = page
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        sizes = """return [...document.querySelectorAll('[data-figure]')].map((place) => {
            const { width, height } = place.querySelector('svg').getBoundingClientRect();
            return [width, height, place.querySelectorAll('svg path.curve').length] })"""
        sizes = np.array(driver.execute_script(sizes))
        assert (sizes[:, :2] > 100).all()
        assert sizes[:, 2].sum() > 15
        driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
        printed = "return [...document.querySelectorAll('[data-printed]')].every((part) => part.open)"
        assert driver.execute_script(printed)
    finally:
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def test_shorter_periods_are_repeated(driver, tmp_path):
    path = tmp_path / "v_twin.html"
    path.write_text(html_of("v_twin")[0], encoding="utf-8")
    opened(driver, path)
    found = charted(driver, "torque")
    assert [curve[0, -1] for curve in found["curves"].values()] == [720, 720, 720]
    assert found["ticks"][:5] == ["0", "180", "360", "540", "720"]
    degrees, value = next(iter(found["curves"].values()))
    places = at(degrees, np.arange(721))
    np.testing.assert_allclose(value[places[360:]], value[places[:361]], rtol=1e-14)


def test_unbounded_values_are_cut(driver, tmp_path):
    with warnings.catch_warnings(action="ignore"):
        opened(driver, ks.report({"a": near_change_points()}, tmp_path / "change.html"))
        size = np.hypot(*near_change_points().solve(360).reaction("O"))
    assert size.max() > 1e12
    found = charted(driver, "reaction O")
    degrees, drawn = found["curves"]["a"]
    kept = np.isfinite(degrees)
    assert found["labels"][1] == "|reaction O| [N]"
    assert drawn[kept].max() < 1e3
    whole = np.isin(degrees, np.arange(360))
    assert 340 < whole.sum() < 360
    np.testing.assert_allclose(drawn[whole], size[degrees[whole].astype(int)], rtol=1e-14)
    assert np.nanmax(np.hypot(*charted(driver, "hodograph")["curves"]["a"])) < 1e3
    choose(driver, 77)
    texts = driver.execute_script("return [...document.querySelectorAll('td.num')].map((cell) => cell.textContent)")
    assert any(re.match(r"\d\.\d{5}e\+\d+ ∠", text) for text in texts)
    assert severe(driver) == []


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
