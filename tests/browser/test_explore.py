"""The explore page in a real browser: numbers follow the hand, and all that is shown belongs to one state."""

from urllib.parse import quote

import numpy as np
import pytest

import kinetostatics as ks

pytest.importorskip("selenium")
pytest.importorskip("tornado")
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from support.explored import ExplorePage

pytestmark = pytest.mark.slow
CASE, VARIANT = "sawframe_2r63", "cam-cosine"
TORQUE = "balancing_torque"


@pytest.fixture
def page(explored):
    """The page of the saw, opened anew."""
    found = explored(CASE, "--variant", VARIANT)
    found.settled()
    return found


def scene(variant=VARIANT, **values):
    found = ks.load_case(CASE).variants[variant].scene
    return found.varied({path.replace("__", "."): value for path, value in values.items()})


def assert_shows(page, wanted):
    """The page shows the torque and the reaction O of a scene, and its numbers in the fields."""
    solution = wanted.solve(360)
    for name, values in {TORQUE: solution.balancing_torque, "O": solution.reaction("O")}.items():
        np.testing.assert_allclose(page.values(name), np.ravel(values), rtol=1e-12, atol=1e-9 * np.max(np.abs(values)))
    assert page.script("return page.shown.values") == wanted.parameters
    fields = page.script("return [...page.parameters.rows].map(([path, row]) => [path, row.value])")
    assert {path: value for path, value in wanted.parameters.items() if path in dict(fields)} == dict(fields)


def press(page, *keys, held=()):
    actions = ActionChains(page.driver)
    for key in held:
        actions.key_down(key)
    actions.send_keys(*keys)
    for key in held:
        actions.key_up(key)
    actions.perform()


def test_page_shows_the_variant_that_was_asked_for(page):
    assert_shows(page, scene())
    assert page.find("[role=tab][aria-selected=true]").text == VARIANT
    assert "balancing torque" in page.find(".figure figcaption").text
    assert page.severe() == []


def test_slider_and_field_change_the_curves_to_the_numbers_of_the_library(page):
    page.slide("slider.mass", 700)
    assert_shows(page, scene(slider__mass=700.0))
    page.write("spring.stiffness", "900000")
    assert_shows(page, scene(slider__mass=700.0, spring__stiffness=900000.0))
    assert page.row("spring.stiffness")[0].get_attribute("aria-valuetext") == "900000 N/m"


def test_number_beyond_the_slider_widens_it(page):
    page.write("slider.mass", "5000")
    assert_shows(page, scene(slider__mass=5000.0))
    slider = page.row("slider.mass")[0]
    assert float(slider.get_attribute("max")) > 5000
    assert float(slider.get_attribute("value")) == 5000
    press(page, "z", held=[Keys.CONTROL])
    page.settled()
    assert [slider.get_attribute(name) for name in ("min", "max", "value")] == ["0", "1200", "600"]


def test_a_movement_is_one_step_of_undo(page):
    for mass in (610, 620, 630):
        page.slide("slider.mass", mass, end=False)
    page.slide("slider.mass", 640)
    page.slide("coupler.mass", 150, end=False)  # the present number: no movement yet
    page.slide("coupler.mass", 100)
    press(page, "z", held=[Keys.CONTROL])
    page.settled()
    assert_shows(page, scene(slider__mass=640.0))
    press(page, "z", held=[Keys.CONTROL])
    page.settled()
    assert_shows(page, scene())
    assert not page.button("Undo").is_enabled()
    press(page, "z", held=[Keys.CONTROL, Keys.SHIFT])
    press(page, "y", held=[Keys.CONTROL])
    page.settled()
    assert_shows(page, scene(slider__mass=640.0, coupler__mass=100.0))
    assert not page.button("Redo").is_enabled()


def test_changed_number_goes_back_to_that_of_the_variant(page):
    page.slide("slider.mass", 700)
    back = page.row("slider.mass")[2]
    back.click()
    page.settled()
    assert page.state == {"variant": VARIANT, "values": {}}
    assert not back.is_displayed()


def test_each_tab_keeps_its_numbers(page):
    page.slide("slider.mass", 700)
    page.tab("plain")
    assert_shows(page, scene("plain"))
    page.slide("slider.mass", 500)
    page.tab(VARIANT)
    assert_shows(page, scene(slider__mass=700.0))
    page.tab("plain")
    assert_shows(page, scene("plain", slider__mass=500.0))
    press(page, "z", held=[Keys.CONTROL])
    page.settled()
    assert_shows(page, scene(slider__mass=700.0))
    assert page.find("[role=tab][aria-selected=true]").text == VARIANT


def test_tab_that_is_left_at_once_leaves_nothing_behind(page):
    variant = page.state["variant"]
    page.script(f"page.turnTo('upright-plain'); page.turnTo('{variant}')")
    page.settled()
    assert page.script("return page.known.parameters.map(({ path }) => path)").count("spring.stiffness") == 1
    page.script("page.set('slider.mass', 610)")
    page.settled()
    assert_shows(page, scene(slider__mass=610.0))


def test_machine_that_cannot_be_assembled_is_a_ghost_until_it_can(page):
    page.tab("plain")
    page.write("coupler_length", "0.25")
    problem = page.find(".problem")
    with pytest.raises(ks.KinetostaticsError) as told:
        scene("plain", coupler_length=0.25).solve(360)
    angles = str(told.value).partition(". Change")[0]
    assert problem.text.startswith(angles)
    assert "56.4427 .. 123.557 deg" in angles
    assert page.script("return page.shown") is None
    assert "ghost" in page.find(".drawing > g").get_attribute("class")
    assert all("stale" in chart.get_attribute("class") for chart in page.all(".figure .chart"))
    assert {values.text for values in page.all(".figure .values")} == {""}
    assert float(page.row("coupler_length")[1].get_attribute("value")) == 0.25
    page.slide("coupler_length", 1.5)
    assert_shows(page, scene("plain", coupler_length=1.5))
    assert not problem.is_displayed()
    assert "ghost" not in (page.find(".drawing > g").get_attribute("class") or "")
    assert not page.all(".chart.stale")


def test_reference_is_the_variant_s_or_what_was_frozen(page):
    plain = scene("plain").solve(360).balancing_torque
    reference = "return Array.from(page.reference.quantities.balancing_torque.values)"
    np.testing.assert_allclose(page.script(reference), plain, atol=1e-9 * np.max(np.abs(plain)))
    page.slide("slider.mass", 700)
    page.button("Compare with now").click()
    page.settled()
    page.slide("slider.mass", 500)
    frozen = scene(slider__mass=700.0).solve(360).balancing_torque
    np.testing.assert_allclose(page.script(reference), frozen, atol=1e-9 * np.max(np.abs(frozen)))
    assert VARIANT in page.find(".legend .before").text
    page.button("Compare with plain").click()
    page.settled()
    np.testing.assert_allclose(page.script(reference), plain, atol=1e-9 * np.max(np.abs(plain)))
    assert page.find(".legend .before").text == "plain"


def test_values_at_the_crank_angle_are_of_the_curves(page):
    page.slide("slider.mass", 700)
    page.find(".degrees").send_keys(Keys.CONTROL, "a", Keys.NULL, "40", Keys.ENTER)
    shown = float(page.find(".figure .values").text)
    factor = page.script("return page.shown.quantities.balancing_torque.factor")
    assert shown == pytest.approx(factor * scene(slider__mass=700.0).solve(360).balancing_torque[40], rel=1e-3)


def test_link_reopens_all_that_was_shown(page, driver):
    page.slide("slider.mass", 700)
    page.button("Compare with now").click()
    page.script("page.curves.choose('guide_force', true); page.curves.turn('O'); page.clock.choose(77)")
    page.slide("coupler.mass", 120)
    page.settled()
    page.wait(lambda: "77" in driver.current_url and "120" in driver.current_url)
    shown = "return [page.state, page.compared, page.curves.chosen, [...page.curves.planes], page.clock.degrees]"
    before, link = page.script(shown), driver.current_url
    other = ExplorePage(driver, link)
    other.settled()
    assert other.script(shown) == before
    assert_shows(other, scene(slider__mass=700.0, coupler__mass=120.0))


def test_crank_turns_under_the_pointer(page):
    page.tab("plain")
    pin = "const [x, y] = page.drawing.machine.at(page.shown.drawing.joints.A, arguments[0]), "
    pin += "box = page.drawing.svg.getBoundingClientRect(); return [box.left + x, box.top + y].map(Math.round)"
    start, end = page.script(pin, 0), page.script(pin, 60)
    actions = ActionChains(page.driver)
    actions.w3c_actions.pointer_action.move_to_location(*start).pointer_down().move_to_location(*end).pointer_up()
    actions.perform()
    assert page.script("return page.clock.degrees") == pytest.approx(60, abs=2)


def test_motor_speed_is_that_of_steady_running(page):
    page.slide("slider.mass", 700)
    page.script("page.curves.choose('motor speed', true)")
    values = page.wait(
        lambda: page.script("return page.curves.runs[0] && page.curves.runs[0].quantities['motor speed'].values")
    )
    variant = ks.load_case(CASE).variants[VARIANT]
    run = ks.drive.steady(scene(slider__mass=700.0), variant.motor, variant.flywheel, angles=360)
    np.testing.assert_allclose(values, run.motor_speed, rtol=1e-9)


def test_keyboard_alone_reaches_sliders_curves_and_tabs(page):
    slider = page.row("slider.mass")[0]
    reached = []
    for _ in range(200):
        press(page, Keys.TAB)
        focus = page.driver.switch_to.active_element
        reached.append(focus.get_attribute("aria-label") or focus.text)
        if focus == slider:
            break
    assert focus == slider
    assert {"play", "Curves", "balancing torque over the crank angle"} <= set(reached), reached
    press(page, Keys.ARROW_RIGHT)
    page.settled()
    assert_shows(page, scene(slider__mass=605.0))
    press(page, "z", held=[Keys.CONTROL])
    page.settled()
    assert_shows(page, scene())
    page.driver.execute_script("arguments[0].focus()", page.find("[role=tab][aria-selected=true]"))
    press(page, Keys.ARROW_RIGHT)
    page.settled()
    assert_shows(page, scene("upright-plain"))


def test_narrow_page_has_one_column_without_scrolling_aside(page):
    size = {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": False}
    page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        page.wait(lambda: page.script("return page.drawing.width < 400"))
        assert page.script("return document.documentElement.scrollWidth") == 400
        page.slide("slider.mass", 700)
        page.script("page.parameters.focus('spring.mass')")
        box = page.find(".drawing").rect
        assert box["y"] >= page.script("return scrollY")  # the drawing stays in sight
    finally:
        page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_frame_and_scale_of_forces_stay_while_a_slider_moves(page):
    page.tab("plain")
    frame = "const {box, scale} = page.drawing.frame; return [Array.from(box), scale]"
    before = page.script(frame)
    for length in (2.2, 3.0, 3.8):
        page.slide("coupler_length", length, end=False)
        page.wait(lambda: page.script("return !page.requests.busy"))
        assert page.script(frame) == before
    page.slide("coupler_length", 3.8)
    box, scale = page.script(frame)
    assert box[2] > before[0][2] + 1
    page.slide("coupler_length", 3.6)
    assert page.script(frame) == [box, scale]


def test_link_to_a_machine_that_cannot_be_assembled_opens(explored):
    state = quote('{"variant": "plain", "values": {"coupler_length": 0.25}}')
    page = explored(CASE, "--variant", VARIANT, fields=f"&state={state}")
    assert "cannot be assembled" in page.find(".problem").text
    page.write("coupler_length", "1.5")
    assert_shows(page, scene("plain", coupler_length=1.5))
    assert page.severe() == []
