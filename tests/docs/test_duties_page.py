"""The page on duties: its cells run, and its numbers are those of the machines that they make."""

import re
from functools import cache

import numpy as np
import pytest

import kinetostatics as ks
from support.pages import CELL, DOCS, needed, text_of

pytestmark = [
    pytest.mark.slow,
    needed,
    pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning", "ignore::kinetostatics.ConditionWarning"),
]
PAGE = DOCS / "machines" / "duties.md"


@cache
def run():
    """Names that the cells of the page make."""
    names: dict = {}
    for _, code in CELL.findall(text_of(PAGE)):
        exec(compile(code, "duties", "exec"), names)
    return names


def test_numbers_of_the_page_are_those_of_its_machines():
    text, names = text_of(PAGE), run()
    mains, start, found = names["mains"], names["start"], names["found"]
    plain, circle, free, best = (
        mains[f"{name}, cut"] for name in ("plain", "circular cam", "torque-free idling", "both duties")
    )
    saved = mains["plain, idle"] - mains["torque-free idling, idle"]
    words = re.sub(r"(?<=\d) (?=\d{3}\b)", "", " ".join(text.split()))
    for told in (
        f"takes {plain:.0f} J from the mains",
        f"torque-free cam for idling takes {free:.0f} J",
        f"saves {plain - free:.0f} J when it cuts, and {saved:.0f} J when it idles",
        f"work of the cut, {names['force'] * 0.6:.0f} J",
        f"of the study saves {plain - circle:.0f} J",
        f"takes {best:.0f} J, {100 * (1 - best / free):.1f} % less",
        f"idling {mains['both duties, idle']:.0f} J, "
        f"{100 * (1 - mains['both duties, idle'] / mains['torque-free idling, idle']):.1f} % less",
        f"idles at {names['runs']['both duties, idle'].mean_speed * 30 / np.pi:.1f} rpm",
        f"{start['both duties'] / 1e3:.0f} kN m to start instead of {start['torque-free idling'] / 1e3:.1f} kN m",
        f"brings {100 * (plain - free) / (plain - best):.1f} % of the saving",
    ):
        assert told in words, told
    speeds = np.linspace(0.0, 34.0, 3401)
    breakdown = names["motor"].torque_at_crank(speeds).max()
    assert f"{breakdown / 1e3:.1f} kN m at the crank" in words
    assert min(torque for name, torque in start.items() if name != "plain") > breakdown
    assert abs(found.values["crank.centre.along"]) < 0.001
    assert found.active == ("start: largest_absolute balancing_torque <= 40000 N m",)
    for duty in ("idle", "cut"):
        assert ks.extremes(found.scene[duty].solve(90), "O").largest <= 12e3
    energies = [
        ks.drive.steady(found.scene["cut"].varied({"crank.inertia": inertia}), names["motor"]).air_gap_energy_per_turn
        for inertia in (250.0, 4000.0)
    ]
    assert np.ptp(energies) < 1e-3 * best


def test_the_mean_torque_leads_to_the_least_mains_energy():
    """Around the page's design no spring takes less from the mains, up to 0.1 %, where the start is as easy."""
    found, motor = run()["found"], run()["motor"]

    def mains(change):
        values = {path: found.values[path] * (1 + by) for path, by in change.items()}
        runs = [ks.drive.steady(found.scene[duty].varied(values), motor) for duty in ("idle", "cut")]
        return np.dot([0.2, 0.8], [run.air_gap_energy_per_turn for run in runs])

    best = mains({})
    for change in ({"spring.stiffness": -0.01}, {"cam.cosine.1": 0.02}, {"cam.cosine.1": -0.02}):
        assert mains(change) > best * (1 - 1e-3)
