"""A line of TOML for each key: the first value of shipped cases, or of those below, that the key takes."""

import json
import re
import tomllib
import typing
from functools import cache
from pathlib import Path
from typing import Any

import pydantic

from kinetostatics.casefile.schema.meanings import word_of

from .sections import flattened

ROOT = Path(__file__).parents[3]
LONGEST = 64
"""Letters of an example."""
BY_KEY: dict[str, list[Any]] = {
    "against": ["coupler"],
    "about": [["0 mm", "-20 mm"]],
    "along": ["coupler"],
    "assembly": [1],
    "reaction": ["frame"],
    "at": ["B", ["0.2 m", "0.05 m"]],
    "between": [["B", ["1 m", "0 m"]]],
    "cubic": ["1 MN/m^3", ["0 N/m^3", "50 MN/m^3"]],
    "cosine": [["300 mm", "-2 mm"]],
    "duties": [{"idle": 0.2, "cut": 0.8}],
    "ends": [["1.7 m", "2.3 m"]],
    "figures": [{"torque": "6a"}],
    "file": ["values.csv"],
    "free_position": ["2 m"],
    "guide_offset": ["-20 mm"],
    "guide_through": [[["0 mm", "-20 mm"], ["300 mm", "-20 mm"]]],
    "inertia": ["0.9 kg m^2"],
    "lever_pivot": [["0 mm", "-240 mm"]],
    "maximise": ["ratio mean_absolute balancing_torque"],
    "minimise": ["largest O", ["mean_absolute balancing_torque", "largest O"]],
    "noise": ["0.01 mm"],
    "note": ["Read from figure 6."],
    "crank": [{"mass": "25 kg"}, {"arm": "-80 mm"}],
    "coupler": [{"mass": "38 kg", "centre": "160 mm"}],
    "slider": [{"mass": "120 kg"}, "slider2"],
    "block": [{"mass": "2 kg"}],
    "rocker": [{"mass": "30 kg", "centre": "mid-length"}, {"arm": "-80 mm"}],
    "lever": [{"mass": "25 kg", "centre": "230 mm"}],
    "rolling_arm": ["0.5 mm"],
    "roller follower.cam": [{"kind": "cosine", "amplitude": "5 mm", "mean": "45 mm"}],
    "flat follower.cam": [{"kind": "cosine", "amplitude": "5 mm", "mean": "45 mm"}],
    "swinging follower.cam": [{"kind": "table", "table": "law.csv"}],
    "follower": [{"mass": "0.5 kg"}],
    "arm": [{"mass": "0.5 kg"}],
    "position": ["40 mm"],
    "start": ["40 mm"],
    "end": ["50 mm"],
    "powers": ["4-5-6-7", [3, 4, 5]],
    "rod": [{"mass": "0.5 kg", "centre": "80 mm"}],
    "cylinder": [{"mass": "2 kg", "centre": "60 mm"}],
    "spring": [{"stiffness": "700 kN/m", "free_position": "2 m"}],
    "process_force": [{"force": "-500 N"}],
    "gravity": [{}],
    "friction": [{"O": {"mu": 0.05, "radius": "30 mm"}}],
    "on": ["A", ["B", "C"]],
    "pin.on": ["coupler"],
    "pin.name": ["C"],
    "dyad.pin": ["D"],
    "dyad1": [{"mass": "2 kg", "centre": "200 mm"}],
    "dyad2": [{"mass": "2 kg", "centre": "200 mm"}],
    "spring.on": ["slider"],
    "process force.on": ["slider2"],
    "gas spring.on": ["slider"],
    "gas spring.at": ["250 mm"],
    "gas spring.pressure": ["6 bar"],
    "ambient": ["1 bar"],
    "cuts": ["toward crank"],
    "mowing.end": ["60 mm"],
    "exponent": [1.4],
    "feed_per_stroke": ["20 mm"],
    "height": ["250 mm"],
    "kerf": ["3.2 mm"],
    "mowing.force": ["600 N"],
    "mowing.on": ["slider"],
    "opposing": [True],
    "overhang": ["0.1 m"],
    "pitch": ["76.2 mm"],
    "resistance": ["50 MPa"],
    "sawing.on": ["slider"],
    "saws": [8],
    "mowing.start": ["26 mm"],
    "thrust": [0.2],
    "volume": ["0.5 l"],
    "torque.on": ["rocker"],
    "torsion spring.on": ["rocker"],
    "torsion damper.on": ["rocker"],
    "pivot": [["0 mm", "-240 mm"]],
    "pivot_name": ["O3"],
    "points": [9],
    "bearings": [["-400 mm", "400 mm"]],
    "couple_unbalance": [["0.1 kg m^2", "0 kg m^2"]],
    "poissons_ratio": [0.3],
    "radius": ["300 mm"],
    "ratio": ["across", {"mean |balancing torque|": "6.77"}],
    "seed": [1],
    "sine": [4, ["0.5 mm"]],
    "source": ["drawing 4711"],
    "speed": ["1475 rpm", ["0 rpm", "1500 rpm"]],
    "spreads": [{"coupler_length": "normal 0 mm +- 0.1 mm"}],
    "starts": [8],
    "stiffness": ["700 kN/m"],
    "table": ["values.csv"],
    "title": ["Crank press"],
    "tolerances": [{"slider.mass": "588..612 kg"}],
    "torque": ["90 N m", ["90 N m", "0 N m"]],
    "trim": [0.01],
    "value": ["-500 N", "-20 N m", {"largest cam force": "49 kN"}],
    "vary": [{"slider.mass": ["500 kg", "600 kg"]}],
    "weights": [[1.0, 0.1]],
    "where": ["table 1"],
    "zero": ["TDC"],
    "sense": [-1],
}
"""Values tried before those of shipped cases, the first that a key takes is its example."""
HEADINGS = {
    "common": "[common]",
    "variants": "[variants.plain]",
    "published": "[published]",
    "design": "[design.best]",
    "groups": "[[common.groups]]",
    "loads": "[[common.loads]]",
    "balancing": "[variants.best.balancing]",
    "roller": "[common.roller]",
    "face": "[common.groups.face]",
    "segments": "[[common.groups.cam.segments]]",
    "linkage": '[published.linkage."psi max [deg]"]',
    "motor": "[common.drive.motor]",
    "drive": "[common.drive]",
    "robust": "[design.best.robust]",
    "sizing": "[sizing.main_bearing]",
}
"""What tables begin with that are too long for a line."""
BY_UNIT = (
    "100 mm",
    "80 cm^2",
    "30 deg",
    "2 kg",
    "0.01 kg m^2",
    "300 rpm",
    "5 rad/s^2",
    "9.81 m/s^2",
    "-500 N",
    "90 N m",
    "20 kN/m",
    "10 N m/rad",
    "50 N s/m",
    "2 N m s",
    "55 kW",
    "210 GPa",
)
"""Values tried where no shipped case has a key."""
BY_TYPE = (True, 0.5, 8, 1, 720, 0.3)


def example(model, name, field):
    """A line that a case may have: the heading of a table, or the first value that the key takes, as TOML."""
    if name in HEADINGS:
        return HEADINGS[name]
    annotation = field.annotation
    for said in field.metadata:
        annotation = typing.Annotated[annotation, said]
    reads = pydantic.TypeAdapter(annotation)
    words = [typing.get_args(kind)[0] for kind, _ in flattened(field.annotation) if is_literal(kind)]
    given = (*BY_KEY.get(f"{word_of(model)}.{name}", ()), *BY_KEY.get(name, ()))
    for value in (*words, *given, *written().get(name, ()), *BY_UNIT, *BY_TYPE):
        line = f"{name} = {toml(value)}"
        if len(line) <= LONGEST and takes_it(reads, value):
            return line
    return ""


def is_literal(kind):
    """Whether a type is one of some words."""
    return typing.get_origin(kind) is typing.Literal


def takes_it(reads, value):
    """Whether a value is one that a key takes."""
    try:
        reads.validate_python(value)
    except pydantic.ValidationError:
        return False
    return True


@cache
def written():
    """Every value that shipped cases and starters have, by key."""
    found: dict[str, list[Any]] = {}
    files = [*sorted((ROOT / "kinetostatics/casefile/starters").glob("*.toml")), *sorted(ROOT.glob("cases/*.toml"))]
    for path in files:
        collect(tomllib.loads(path.read_text(encoding="utf-8")), found)
    return found


def collect(value, found):
    """Add the values of a table, and of tables within it, to those found."""
    for item in value if isinstance(value, list) else []:
        collect(item, found)
    for key, item in value.items() if isinstance(value, dict) else []:
        found.setdefault(key, []).append(item)
        collect(item, found)


def toml(value):
    """A value as TOML has it."""
    if isinstance(value, dict):
        return (
            "{}" if not value else "{ " + ", ".join(f"{bare(key)} = {toml(part)}" for key, part in value.items()) + " }"
        )
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def bare(key):
    """A key as TOML has it."""
    return key if re.fullmatch(r"[\w-]+", key) else json.dumps(key)
