"""Case files written for a test, shipped cases read once, and tables of reference values."""

import json
import tomllib
from functools import cache

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases

from . import DATA


def case_file(folder, text):
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def problems(folder, text):
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(case_file(folder, text))
    assert str(caught.value).startswith(str(folder / "case.toml"))
    return caught.value.problems


def toml(value):
    """Text of a value, tables in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(item)}" for key, item in value.items()) + "}"
    return "[" + ", ".join(map(toml, value)) + "]" if isinstance(value, list) else json.dumps(value)


def written(folder, case, names, path="", text=""):
    """A shipped case with some of its variants, in the last of them another text at a path."""
    raw = tomllib.loads(shipped_cases()[case].read_text(encoding="utf-8"))
    raw = {key: raw[key] for key in ("title", "reference", "common", "variants")}
    raw["variants"] = {name: raw["variants"][name] for name in dict.fromkeys(names)}
    if path:
        *tables, key = path.split(".")
        table = raw["variants"][names[-1]]
        for name in tables:
            table = table.setdefault(name, {})
        if isinstance(table, list):
            table[("x", "y").index(key)] = text
        else:
            table[key] = text
    file = folder / "case.toml"
    file.write_text("\n".join(f"{json.dumps(key)} = {toml(value)}" for key, value in raw.items()), encoding="utf-8")
    return ks.load_case(file)


@cache
def four_bar_data(name):
    path = DATA / f"fourbar_{name}.json"
    return json.loads(path.read_text(encoding="utf-8"))


def four_bar_table(rho):
    rows = four_bar_data(f"rho{rho}")["rows"]
    return {name: np.array([row[name] for row in rows], dtype=float).T for name in rows[0]}


PLAIN = """
title = "test"
reference = "plain"
[common]
crank_speed = "320 rpm"
[common.coupler]
mass = "150 kg"
centre = "mid-length"
inertia = "20.5 kg m^2"
[common.slider]
mass = "600 kg"
[variants.plain]
mechanism = "crank-slider"
crank_length = "300 mm"
coupler_length = "2 m"
"""


BADLY_WRITTEN = {  # with what to write in its place
    "2,1": ("2.1",),
    "0,1": ("0.1",),
    "-0,5": ("-0.5",),
    "1.500,1": ("1500.1",),
    "1,500.1": ("1500.1",),
    "1,500": ("1.500", "1500"),
    "1.500.000": ("1500000",),
    "1 500": ("1.500", "1500"),
    "2 1": ("2.1",),
    "1 500,5": ("1500.5",),
    "1\u2009500": ("1500",),
    "1\u00a0500,5": ("1500.5",),
    "1'500": ("1500",),
    "1’500": ("1500",),
    "1_500": ("1500",),
    "\u22122.1": ("-2.1",),
    "\u22122,1": ("-2.1",),
    "\uff15": ("5",),
    "\u0663": ("3",),
    "2,1e3": ("2.1e3",),
}


STIFFER = """
[design.stiffer]
kind = "optimum"
variant = "cam-circle"
maximise = "ratio mean_absolute balancing_torque"
vary = { "spring.stiffness" = ["600 kN/m", "900 kN/m"] }
angles = 72
"""
FRONT = """
[design.trade]
kind = "front"
variant = "cam-circle"
minimise = ["largest_absolute cam_force", "-ratio mean_absolute balancing_torque"]
vary = { "spring.stiffness" = ["600 kN/m", "900 kN/m"], "cam.centre.x" = ["-30 mm", "-10 mm"] }
points = 2
angles = 72
"""
CUTTING = """
[variants.cutting]
mechanism = "cam-crank-slider"
coupler_length = "2.0219 m"
cam = { kind = "circle", radius = "0.3 m", centre = ["-0.0219 m", "0 m"] }
spring = { stiffness = "balance the slider", free_position = "2 m" }
process_force = { force = "-2 kN" }
"""
DUTIES = f"""{CUTTING}
[design.shared]
kind = "optimum"
duties = {{ cam-circle = 0.25, cutting = 0.75 }}
maximise = "ratio mean_absolute balancing_torque"
limits = ["cutting: largest O <= 40 kN"]
vary = {{ "spring.stiffness" = ["600 kN/m", "900 kN/m"] }}
angles = 72
"""
SAW = shipped_cases()["sawframe_2r63"].read_text(encoding="utf-8").partition("[tolerances]")[0]


def saw_with(text, folder):
    """Path of the saw's case file with more at its end."""
    path = folder / "saw.toml"
    path.write_text(f"{SAW}\n{text}", encoding="utf-8")
    return path


shipped = cache(ks.load_case)


def variant_names(case):
    """Names of the variants of a shipped case; none is built."""
    return list(tomllib.loads(shipped_cases()[case].read_text(encoding="utf-8"))["variants"])


def unlike_variants(case):
    """First variant of each kind of machine in a shipped case: groups, cams, loads, friction."""
    found = {}
    for name, variant in shipped(case).variants.items():
        scene = variant.scene
        groups = [(type(group), type(getattr(group, "cam", None))) for group in scene.mechanism.groups]
        found.setdefault((*groups, *sorted({type(load).__name__ for load in scene.loads}), *scene.friction), name)
    return list(found.values())
