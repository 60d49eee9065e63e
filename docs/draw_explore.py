"""The film and the picture of explore.md, from the page itself in a browser: python docs/draw_explore.py.

A pointer drags the stiffness of a saw's springs and the centre of its cam while the saw turns. Chromium, its driver and
Selenium are needed, as for the tests in a browser.
"""

import json
import shutil
import subprocess
import sys
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from urllib.parse import urlencode

from PIL import Image

FOLDER = Path(__file__).parent / "explore"
CASE, VARIANT, START = "sawframe_2r63", "upright-circle", {"spring.stiffness": 150e3}
SHOWN, FOLDED = ["balancing_torque", "O"], ("coupler", "slider", "gravity", "drive")
WIDTH, HEIGHT, SCALE = 1160, 600, 0.8
"""Pixels of the page, and of the film for each of these."""
RATE, TURN = 10, 6.0
"""Pictures a second; seconds of a turn."""
COLOURS = 64
STILL, STILL_SCALE = {"spring.stiffness": 400e3}, 1.3
"""Numbers and scale of the picture for print."""
POINTER = """
const made = document.createElement("div");
made.id = "pointer";
made.style = "position: fixed; z-index: 9; pointer-events: none; left: -99px; top: 0";
const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
svg.setAttribute("width", 24);
svg.setAttribute("height", 30);
path.setAttribute("d", "M1 1V22L6.5 17L10 25.5L14 24L10.5 15.8H18Z");
path.setAttribute("fill", "#111");
path.setAttribute("stroke", "#fff");
path.setAttribute("stroke-width", 1.6);
svg.append(path);
made.append(svg);
document.body.append(made);
"""
"""A picture of a page has no pointer of its own."""


@contextmanager
def page():
    """The driver of a browser with the explore page."""
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    for word in ("--headless=new", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-sandbox"):
        options.add_argument(word)
    options.binary_location = shutil.which("chromium")
    command = [sys.executable, "-m", "kinetostatics", "explore", CASE, "--variant", VARIANT, "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
        try:
            scale(driver, SCALE)
            address = next(line.strip() for line in server.stdout if line.startswith("http"))
            state = {"variant": VARIANT, "values": START}
            fields = {"state": json.dumps(state), "show": json.dumps(SHOWN)}
            driver.get(f"{address}&{urlencode(fields)}")
            yield driver
        finally:
            driver.quit()
            server.terminate()


def scale(driver, times):
    """Set the size of the page, and the pixels of a picture for each of it."""
    size = {"width": WIDTH, "height": HEIGHT, "deviceScaleFactor": times, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)


class Film:
    """Pictures of the page while it turns and a pointer moves over it."""

    def __init__(self, driver):
        self.driver, self.pictures, self.angle, self.place, self.held = driver, [], 0.0, (600.0, 450.0), False
        self.wait()
        fold = "for (const item of page.root.querySelectorAll('.numbers summary'))"
        fold += "if (arguments[0].includes(item.firstChild.textContent.trim().toLowerCase())) item.click();"
        self.script(fold + POINTER, FOLDED)
        self.script("page.clock.frame = () => {}; page.clock.run(true)")  # turns from picture to picture

    def script(self, text, *values):
        """Value of a script; `page` is the Explore of the page."""
        return self.driver.execute_script(f"const page = document.querySelector('.explore').explore; {text}", *values)

    def wait(self):
        """Wait until all that is shown belongs to the state."""
        done = "const found = document.querySelector('.explore').explore; return Boolean(found && found.shown) && "
        while not self.driver.execute_script(f"{done} !found.requests.busy"):
            pass

    def point(self, kind, place):
        """Move, press or release the pointer."""
        self.place = place
        event = {
            "type": kind,
            "x": place[0],
            "y": place[1],
            "button": "left",
            "buttons": int(self.held or kind == "mousePressed"),
        }
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event | {"clickCount": int(kind != "mouseMoved")})
        self.script(
            "Object.assign(document.getElementById('pointer').style, {left: `${arguments[0]}px`, "
            "top: `${arguments[1]}px`})",
            *place,
        )

    def seen(self):
        """What the page shows, when all belongs to its state."""
        self.wait()
        return Image.open(BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")

    def take(self):
        """One picture, a step of the crank after the one before."""
        self.wait()
        self.script("page.clock.turnTo(Math.round(arguments[0]))", self.angle)
        if self.script("return page.clock.running"):
            self.angle += 360.0 / TURN / RATE
        self.pictures.append(self.seen())

    def rest(self, seconds):
        """Take pictures while the pointer rests."""
        for _ in range(round(seconds * RATE)):
            self.take()

    def go(self, to, seconds):
        """Move the pointer to a place, slower at both ends."""
        count, (x, y) = round(seconds * RATE), self.place
        for number in range(1, count + 1):
            part = number / count
            part = part * part * (3.0 - 2.0 * part)
            self.point("mouseMoved", (x + part * (to[0] - x), y + part * (to[1] - y)))
            self.take()

    def press(self):
        """Press the pointer."""
        self.point("mousePressed", self.place)
        self.held = True

    def release(self):
        """Release the pointer; the crank, which stands while a point is dragged, turns on."""
        self.point("mouseReleased", self.place)
        self.held = False
        self.script("page.clock.run(true)")

    def thumb(self, path, value):
        """Place of the thumb of a slider at a number."""
        slider = "const slider = document.querySelector(`.row[title='${arguments[0]}'] [type=range]`);"
        slider += "const {x, y, width, height} = slider.getBoundingClientRect(), thumb = 16;"
        part = "(arguments[1] - slider.min) / (slider.max - slider.min)"
        return tuple(
            self.script(f"{slider} return [x + thumb / 2 + (width - thumb) * {part}, y + height / 2]", path, value)
        )

    def middle(self, selector):
        """Middle of an element."""
        box = "const box = document.querySelector(arguments[0]).getBoundingClientRect(); "
        return tuple(self.script(f"{box} return [box.x + box.width / 2, box.y + box.height / 2]", selector))


def play(film):
    """Too soft springs, then the right ones; the cam's centre moved, and moved back by Undo."""
    film.rest(1.2)
    film.go(film.thumb("spring.stiffness", START["spring.stiffness"]), 1.0)
    film.press()
    film.go(film.thumb("spring.stiffness", 805e3), 3.5)
    film.release()
    film.rest(1.2)
    x, y = film.middle("[data-handle='cam.centre.x'] .form")
    film.go((x, y), 0.9)
    film.press()
    film.go((x + 16, y - 12), 1.4)
    film.go((x - 14, y - 4), 1.6)
    film.release()
    film.rest(0.6)
    film.go(film.middle(".tools button"), 0.9)
    film.press()
    film.release()
    film.rest(2.2)


def still(film):
    """A picture for print, larger and without the pointer."""
    scale(film.driver, STILL_SCALE)
    film.script("document.getElementById('pointer').remove(); page.clock.run(false); page.clock.turnTo(60)")
    for path, value in STILL.items():
        film.script("page.set(arguments[0], arguments[1], false)", path, value)
    film.rest(1.0)  # all numbers belong to this state
    return film.seen().quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)


def saved(pictures, path):
    """Write a film as GIF, all pictures with the colours of a few, without dots that stand for others."""
    chosen = pictures[:: max(1, len(pictures) // 8)]
    sheet = Image.new("RGB", (chosen[0].width, chosen[0].height * len(chosen)))
    for number, picture in enumerate(chosen):
        sheet.paste(picture, (0, number * picture.height))
    palette = sheet.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE)
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=1000 // RATE, loop=0, optimize=True)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    with page() as driver:
        film = Film(driver)
        play(film)
        saved(film.pictures, FOLDER / "film.gif")
        still(film).save(FOLDER / "page.png", optimize=True)
