"""Drag points of the explore page: by pointer, by keys, into a gap and back."""

import math

import pytest

from kinetostatics.views.explore.session import Session

pytestmark = pytest.mark.slow
webdriver = pytest.importorskip("selenium.webdriver")
pytest.importorskip("support.explored")
CASES = {"four-bar": ("cases/pumpjack.toml",), "slider": ("cases/sawframe_2r63.toml", "--variant", "plain")}


@pytest.fixture
def opened(driver, explored):
    driver.set_window_size(1400, 1000)

    def open_page(name):
        page = explored(*CASES[name])
        page.settled()
        return page

    yield open_page
    driver.get("about:blank")


def grip(page, name):
    return page.find(f"[data-handle='{name}'] .reach")


def middle(element):
    """Middle of an element in the window, pixels."""
    box = element.rect
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def hand(page):
    return webdriver.ActionChains(page.driver, duration=30)


def field(page, path):
    return float(page.row(path)[1].get_attribute("value"))


def place_of(page, name):
    """Place of a point in the drawing that is shown, m."""
    script = "const grip = page.handles.grips.get(arguments[0]); return Array.from(page.handles.at(grip.item))"
    return page.script(script, name)


def drag(page, name, x, y, release=True):
    """Drag a point by pixels."""
    done = (
        hand(page)
        .click_and_hold(grip(page, name))
        .move_by_offset(x // 2, y // 2)
        .move_by_offset(x - x // 2, y - y // 2)
    )
    done.perform()
    page.wait(lambda: not page.script("return page.requests.busy || page.handles.frame"))
    if release:
        hand(page).release().perform()
        page.settled()


def test_a_pivot_follows_the_pointer_and_one_undo_brings_it_back(opened):
    page = opened("four-bar")
    x, y = field(page, "rocker_pivot.x"), field(page, "rocker_pivot.y")
    frame, start = page.script("return page.drawing.scale"), middle(grip(page, "rocker_pivot.x"))
    drag(page, "rocker_pivot.x", 24, -16, release=False)
    reached = middle(grip(page, "rocker_pivot.x"))
    assert page.script("return page.drawing.scale") == frame
    assert math.dist(reached, (start[0] + 24, start[1] - 16)) < 0.75 * page.script("return page.handles.snap") * frame
    hand(page).release().perform()
    page.settled()
    moved = field(page, "rocker_pivot.x") - x, field(page, "rocker_pivot.y") - y
    assert moved == pytest.approx((24 / frame, 16 / frame), abs=0.02)
    assert page.state["values"] == {
        "rocker_pivot.x": field(page, "rocker_pivot.x"),
        "rocker_pivot.y": field(page, "rocker_pivot.y"),
    }
    page.find("[title='Ctrl+Z']").click()
    page.settled()
    assert (field(page, "rocker_pivot.x"), field(page, "rocker_pivot.y")) == (x, y)
    assert page.script("return page.history.first")
    assert page.severe() == []


def test_the_crank_can_turn_while_a_point_is_held(opened):
    page = opened("four-bar")
    drag(page, "rocker_pivot.x", 24, -16, release=False)
    assert page.script("return page.shown.drawing.pose") == 0
    page.script("page.clock.choose(90)")
    page.wait(lambda: page.script("return page.shown.drawing.pose === undefined"))
    pins = (
        "return page.drawing.machine.pins.flatMap(({pin}) => "
        "page.drawing.metres(+pin.getAttribute('cx'), +pin.getAttribute('cy')))"
    )
    turned = page.script(pins)
    hand(page).release().perform()
    page.settled()
    assert page.script(pins) == pytest.approx(turned, abs=1e-3)
    page.script("page.clock.choose(0)")
    assert page.script(pins) != pytest.approx(turned, abs=0.1)


HAND = """
const done = arguments[arguments.length - 1], page = document.querySelector(".explore").explore;
const wait = (time) => new Promise((after) => setTimeout(after, time));
const grip = page.handles.grips.get("rocker_pivot.x"), [x, y] = page.handles.at(grip.item), step = page.handles.snap;
const index = page.clock.index;
const move = (steps, still) => page.drag({ handle: grip.name, x: x + steps * step, y, index, snap: true, step }, still);
(async () => { STEPS })().then(() => done(""), (error) => done(String(error)));
"""
"""A hand whose steps do not wait for answers."""
TURNS = {
    "after the drop": "move(1, true); await wait(500); move(2, true); move(3, false); page.clock.choose(90);",
    "by play after the drop": "move(1, true); await wait(500); move(2, true); move(3, false); page.clock.run(true); "
    "await wait(300); page.clock.run(false);",
    "while held": "move(1, true); await wait(500); page.clock.choose(90); await wait(500); move(2, true); "
    "move(3, false);",
}


@pytest.mark.parametrize("when", TURNS)
def test_a_drop_is_not_lost_when_the_crank_turns(opened, when):
    page = opened("four-bar")
    start, snap = field(page, "rocker_pivot.x"), page.script("return page.handles.snap")
    assert page.driver.execute_async_script(HAND.replace("STEPS", TURNS[when])) == ""
    page.settled()
    assert page.state["values"]["rocker_pivot.x"] == pytest.approx(start + 3 * snap, abs=0.51 * snap)
    assert page.script("return page.shown.state.values") == page.state["values"]
    assert page.script("return [page.moving, page.history.states.length]") == [False, 2]
    page.wait(lambda: page.script("return page.drawing.machine.count") == 360)
    assert page.severe() == []


def test_the_ghost_turns_with_the_crank(opened):
    page = opened("four-bar")
    drag(page, "coupler_length", -60, 60)
    page.wait(lambda: page.script("return page.shown === null && page.drawing.machine.count === 360"))
    pins = "return page.drawing.machine.pins.map(({pin}) => pin.getAttribute('cx'))"
    before = page.script(pins)
    page.script("page.clock.choose(90)")
    assert page.script(pins) != before
    assert page.script("return page.drawing.root.classList.contains('ghost')")


def test_steps_of_keys_without_a_pause_are_all_taken(opened):
    page = opened("four-bar")
    start, snap = field(page, "rocker_pivot.x"), page.script("return page.handles.snap")
    page.script("page.handles.grips.get('rocker_pivot.x').group.focus()")
    keys = webdriver.ActionChains(page.driver, duration=0)
    for _ in range(5):
        keys.key_down(webdriver.Keys.ARROW_RIGHT).key_up(webdriver.Keys.ARROW_RIGHT)
    keys.perform()
    page.settled()
    assert field(page, "rocker_pivot.x") == pytest.approx(start + 5 * snap, abs=0.51 * snap)


def test_a_mass_centre_follows_the_pointer_in_the_axes_of_its_link(opened):
    page = opened("four-bar")
    page.script("page.clock.choose(60)")
    before = page.values("O")
    drag(page, "coupler.centre.along", 14, 22)
    along, across = field(page, "coupler.centre.along"), field(page, "coupler.centre.across")
    solution = Session(*CASES["four-bar"]).scene(page.state).solve(360)
    assert place_of(page, "coupler.centre.along") == pytest.approx(solution.position("coupler")[:, 60], abs=1e-6)
    assert (along, across) != (1.55, 0.0)
    assert page.values("O") != before


def test_the_guide_is_shifted_and_turned(opened):
    page = opened("slider")
    drag(page, "guide_offset", 0, -12)
    assert field(page, "guide_offset") > 0.0
    drag(page, "guide_angle", 0, -30)
    assert field(page, "guide_angle") == round(field(page, "guide_angle")) > 0.0


def test_the_pin_of_the_crank_turns_it_and_the_grip_beside_it_changes_its_length(opened):
    page = opened("slider")
    x, y = place_of(page, "crank_length")
    script = (
        "const box = page.drawing.svg.getBoundingClientRect(), [x, y] = page.drawing.pixel(arguments[0], arguments[1]);"
    )
    pin = page.script(f"{script} return [Math.round(box.left + x), Math.round(box.top + y)]", x, y)
    actions = webdriver.ActionChains(page.driver, duration=30)
    actions.w3c_actions.pointer_action.move_to_location(*pin)
    actions.click_and_hold().move_by_offset(-20, -40).release().perform()
    assert 10 < page.script("return page.clock.index") < 100
    assert page.state["values"] == {}
    page.script("page.clock.choose(0)")
    drag(page, "crank_length", 12, 0)
    assert field(page, "crank_length") > 0.3
    assert page.script("return page.clock.index") == 0


def test_a_gap_is_told_in_words_the_last_machine_stays_as_a_ghost_and_the_way_back_is_open(opened):
    page = opened("four-bar")
    drag(page, "coupler_length", -60, 60, release=False)
    assert "cannot be assembled" in page.find(".problem").text
    assert page.all(".drawing .ghost")
    assert page.values("balancing_torque") is None
    lengths = field(page, "coupler_length"), field(page, "rocker_length")
    assert lengths != (3.1, 2.45)
    hand(page).move_by_offset(60, -60).perform()
    page.wait(lambda: page.script("return page.shown"))
    hand(page).release().perform()
    page.settled()
    assert not page.all(".drawing .ghost")
    assert page.find(".problem").text == ""
    assert field(page, "coupler_length") == 3.1
    assert page.values("balancing_torque") is not None
    assert page.severe() == []


OTHER_CHANGES = {
    "page.move(-1)": {"variant": "plain", "values": {}},
    "page.set('slider.mass', 700, false)": {"variant": "plain", "values": {"slider.mass": 700.0}},
    "page.turnTo('cam-circle')": {"variant": "cam-circle", "values": {}},
}


@pytest.mark.parametrize("change", OTHER_CHANGES)
def test_a_drag_that_is_answered_after_another_change_is_dropped(opened, change):
    page = opened("slider")
    page.slide("slider.mass", 620)
    wanted = "page.drag({handle: 'coupler_length', x: 2.6, y: 0, index: 0, snap: true, step: page.shown.snap}, true); "
    page.script(wanted + change)
    page.settled()
    assert page.state == OTHER_CHANGES[change]
    assert page.script("return page.shown.state") == page.state
    assert page.script("return page.known.parameters.length") == page.script("return page.parameters.rows.size")
    assert page.script("return page.history.last") is (change != "page.move(-1)")
    assert page.severe() == []


def test_impossible_numbers_of_a_drag_are_told_while_it_is_held(opened):
    page = opened("slider")
    page.tab("cam-circle")
    wanted = "page.drag({handle: 'cam.radius', x: 0, y: 0, index: 0, snap: true, step: 0.01}, arguments[0])"
    page.script(wanted, True)
    page.wait(lambda: "radius must be greater than 0" in page.find(".problem").text)
    assert page.all(".drawing .ghost")
    page.script(wanted, False)
    page.settled()
    assert page.state == {"variant": "cam-circle", "values": {}}
    assert page.script("return page.shown.state") == page.state
    assert not page.find(".problem").is_displayed()
    assert not page.all(".drawing .ghost")


def test_keys_move_a_point_by_a_step_by_ten_and_without_snapping(opened):
    keys = webdriver.Keys
    page = opened("four-bar")
    point, step = page.find("[data-handle='rocker_pivot.x']"), page.script("return page.handles.snap")
    point.send_keys(keys.ARROW_RIGHT)
    page.settled()
    x = field(page, "rocker_pivot.x")  # on the grid of steps
    rows = [(keys.ARROW_RIGHT, 1.0), (keys.SHIFT + keys.ARROW_RIGHT, 11.0), (keys.ALT + keys.ARROW_LEFT, 10.9)]
    for pressed, steps in rows:
        point.send_keys(pressed + keys.NULL)
        page.settled()
        assert field(page, "rocker_pivot.x") == pytest.approx(x + steps * step, abs=1e-9)
    assert point.get_attribute("aria-label").startswith("rocker pivot, rocker pivot x = ")
    assert page.script("return page.clock.index") == 0
