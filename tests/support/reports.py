"""Reports made once for all tests of a process, and what stands in them."""

import base64
import json
import re
from functools import cache
from html import unescape

import numpy as np

import kinetostatics as ks
from kinetostatics.views.report import html
from kinetostatics.views.report.report import subject_of

COMMAND = "kinetostatics report CASE --out report.html"


@cache
def subject(case, variant=None):
    return subject_of(case, variant, command=COMMAND)


@cache
def page(case, variant=None):
    """Text of the page of a shipped case, and the data in it."""
    text = html.page(subject(case, variant))
    return text, data_of(text)


def data_of(text):
    """The data in a page, with its arrays in place, (N,) each."""

    def read(name):
        return json.loads(re.search(rf'<script type="application/json" class="{name}">(.*?)</script>', text, re.S)[1])

    arrays = read("arrays")

    def restored(value):
        if isinstance(value, list):
            return [restored(item) for item in value]
        if not isinstance(value, dict):
            return value
        if value.keys() == {"array", "kind"}:
            return np.frombuffer(base64.b64decode(arrays[value["array"]]), dtype=f"<{value['kind']}")
        return {name: restored(item) for name, item in value.items()}

    return restored(read("data"))


def words(text):
    """What a reader sees of a page: no scripts, styles and tags."""
    text = re.sub(r"<(script|style)\b.*?</\1>", " ", text, flags=re.S)
    return re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]+>", " ", text)))


def series(data, name, row):
    """Values of a quantity of a machine in the page's unit, (1 or 2, N)."""
    return data["quantities"][name]["values"][row].reshape(-1, data["counts"][row])


def plain(**options):
    """A crank-slider without a case file."""
    made = ks.crank_slider(0.1, 0.4, slider=ks.Link(mass=50.0), coupler=ks.Link(mass=5.0, centre=(0.2, 0.0)))
    return ks.Scene(made, **{"crank_speed": 10.0, "loads": ks.Gravity()} | options)


def table_of(found, row):
    """Cells of the row of a table that begins with some words."""
    return next(cells for cells in found.rows if cells[0] == row)


def near_change_points():
    """A parallelogram one of whose angles meets a change point but for rounding: reactions of 1e17 N there."""
    pivot = 0.3 * np.cos(np.radians(77.0)), 0.3 * np.sin(np.radians(77.0))
    bar = ks.Link(1.0, 0.15, 0.01)
    made = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=pivot, assembly="open", coupler=bar, rocker=ks.Link(1.0, 0.05, 0.01))
    return ks.Scene(made, 10.0, loads=[ks.Gravity()])
