"""How fast the explore page is: forces that follow the hand, a mechanism that turns, a page that opens.

The latency is that from a pointer event of the browser to the drawing and ten figures redrawn.

Run by ``python -m pytest tests/browser/test_explore_latency.py --benchmark-only -n 0``, alone on the machine. The
pointer moves 60 times a second. An event that comes while a machine is under way waits, and is counted from its own
time, unless a newer one takes its place.
"""

import json
import time
from urllib.parse import quote

import numpy as np
import pytest

from kinetostatics.views.explore.session import Session

pages = pytest.importorskip("support.explored")

MEDIAN, WORST = 30.0, 50.0
"""Limits of the latency and of its 95 % quantile, ms."""
LOGS = ("browser",)
FIGURES, MOVES, PACE = 10, 150, 1.0 / 60.0
FRAMES = 30.0
"""Least frames a second while the crank turns."""
COLD, READY = 3.0, 0.5
"""Limits of the time from the command to the address, and from there to the first machine, s."""
WATCH = """
page.latencies = [];
page.shares = {draw: [], server: []};
let moved = 0;
for (const kind of ["pointerrawupdate", "pointermove"]) { // a browser may have one or both
  addEventListener(kind, (event) => { moved = event.timeStamp; }, true);
}
const drag = page.drag.bind(page), { onlook, send } = page.requests;
page.drag = (fields, still) => drag({ ...fields, moved }, still);
page.requests.send = (kind, fields) => {
  fields.sent = performance.now();
  return send.call(page.requests, kind, fields);
};
page.requests.onlook = (answer, asked) => {
  const come = performance.now();
  onlook(answer, asked);
  page.root.getBoundingClientRect(); // with the layout
  if (!asked.moved || answer.problem) return;
  page.latencies.push(performance.now() - asked.moved);
  page.shares.draw.push(performance.now() - come);
  page.shares.server.push(come - asked.sent);
};
"""


def shown_at_first(path, variant):
    """Address fields that show ten quantities of a case."""
    session = Session(path, variant)
    described = session.answer({"id": 1, "kind": "describe", "state": {"variant": session.first, "values": {}}})
    return "&show=" + quote(json.dumps([item["name"] for item in described["quantities"]][:FIGURES]))


@pytest.mark.parametrize(
    ("case", "variant", "handle"),
    [("sawframe_2r63", "cam-circle", "cam.centre.x"), ("pumpjack", "weights", "rocker_pivot.x")],
)
def test_forces_follow_the_hand(benchmark, explored, driver, tell, case, variant, handle):
    path = f"cases/{case}.toml"
    driver.set_window_size(1600, 1200)
    page = explored(path, "--variant", variant, fields=shown_at_first(path, variant))
    page.settled()
    assert len(page.all(".figure")) == FIGURES
    box = page.find(f"[data-handle='{handle}'] .form").rect
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def pointer(kind, to_x, to_y):
        fields = {"type": kind, "x": to_x, "y": to_y, "button": "left", "buttons": 1, "clickCount": 1}
        driver.execute_cdp_cmd("Input.dispatchMouseEvent", fields)

    def hand():
        page.script(WATCH)
        pointer("mousePressed", x, y)
        for turn in np.linspace(0.0, 6 * np.pi, MOVES):
            start = time.perf_counter()
            pointer("mouseMoved", x + 12 * np.sin(turn), y + 8 * np.sin(1.7 * turn))
            time.sleep(max(0.0, PACE - (time.perf_counter() - start)))
        pointer("mouseReleased", x, y)
        page.settled()

    benchmark.pedantic(hand, rounds=1)
    times = np.array(page.script("return page.latencies"))
    shares = {name: np.median(values) for name, values in page.script("return page.shares").items()}
    median, worst = np.quantile(times, [0.5, 0.95])
    tell(
        f"{case}: {median:.1f} ms median, {worst:.1f} ms at 95 %, of {times.size} machines; server and messages "
        f"{shares['server']:.1f} ms, page {shares['draw']:.1f} ms"
    )
    assert times.size > MOVES / 6
    assert page.severe() == []
    assert median <= MEDIAN
    assert worst <= WORST


CASES = pytest.mark.parametrize(("case", "variant"), [("sawframe_2r63", "cam-circle"), ("pumpjack", "weights")])


@CASES
def test_the_crank_turns_in_even_frames(benchmark, explored, driver, tell, case, variant):
    path = f"cases/{case}.toml"
    driver.set_window_size(1600, 1200)
    page = explored(path, "--variant", variant, fields=shown_at_first(path, variant))
    page.settled()

    def turn():
        page.script("""page.times = []; page.clock.follow(() => {
            page.root.getBoundingClientRect(); page.times.push(performance.now());
        }); page.clock.pace.value = "2"; page.clock.run(true);""")
        time.sleep(4.0)
        return np.diff(page.script("page.clock.run(false); return page.times"))[1:]

    between = benchmark.pedantic(turn, rounds=1)
    frames = 1e3 / between.mean()
    tell(f"{case}: {frames:.0f} frames a second, {np.quantile(between, 0.95):.0f} ms apart at 95 %")
    assert frames >= FRAMES


@CASES
def test_the_page_opens_at_once(benchmark, driver, tell, case, variant):
    def opened():
        start = time.perf_counter()
        with pages.explore_server(f"cases/{case}.toml", "--variant", variant) as address:
            served = time.perf_counter()
            pages.ExplorePage(driver, address)
            return served - start, time.perf_counter() - served

    cold, ready = benchmark.pedantic(opened, rounds=1)
    tell(f"{case}: address after {cold:.2f} s, first machine shown {ready:.2f} s later")
    assert cold <= COLD
    assert ready <= READY
