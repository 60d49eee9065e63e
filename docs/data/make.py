"""Make the reference data: ``python docs/data/make.py`` from the root, with the extras `precision` and `test`.

Shipped cases and random machines, each certified: the kernels on intervals (python-flint), confirmed at every crank
angle by a full Newton-Euler system of all bodies with formulas of its own (mpmath), and the random machines by a second
such system, of the tests, that shares nothing with the package.
"""

import argparse
import json
import shutil
import sys
import tempfile
import warnings
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "tests"))

import flint  # noqa: E402
import mpmath as mp  # noqa: E402

import kinetostatics as ks  # noqa: E402
from kinetostatics.casefile.reading import shipped_cases  # noqa: E402
from kinetostatics.machine.friction import Sliding, Turning  # noqa: E402
from kinetostatics.machine.guide import Guide  # noqa: E402
from kinetostatics.machine.loads import Load, Table  # noqa: E402
from kinetostatics.machine.loads.points import PlacePairRule, PlaceRule  # noqa: E402
from kinetostatics.machine.loads.table_pieces import WholeTurns  # noqa: E402
from kinetostatics.numbers import checks  # noqa: E402
from kinetostatics.studies.methods.high_precision.certified import certified  # noqa: E402
from support.friction_machines import Drawn  # noqa: E402

DIGITS = 17
STEPS = 4096
"""Random numbers are whole multiples of one over so many: their decimals end."""
CLOSE = 1e-14
"""Difference from the tests' system, relative to the largest force, beyond which nothing is written."""
MACHINES = {
    "slider": 3,
    "cam": 2,
    "four-bar": 2,
    "six-bar": 2,
    "coupler point": 2,
    "lever": 2,
    "cylinder": 2,
    "yoke": 2,
    "dyad": 3,
}
"""How many random machines of each kind."""


class Machine(Drawn):
    """A random machine without friction, whose numbers have decimals that end."""

    def __init__(self, kind, seed):
        super().__init__(kind, seed, scale=0.0)
        acceleration, direction = self.real(4.0, 12.0), self.real(-3.0, 3.0)
        gravity = ks.Gravity(acceleration, direction)
        self.scene = ks.Scene(self.scene.mechanism, self.speed, self.acceleration, (gravity, *self.loads))
        self.system.gravity = mp.mpf(acceleration) * mp.expj(direction)

    def real(self, low, high):
        """A number."""
        return round(super().real(low, high) * STEPS) / STEPS

    def inertia(self, mass):
        """Any moment of inertia: the data is older than the hint at those that no bar of its length has."""
        return self.real(0.001, 0.1)

    def disagreement(self, solution, found):
        """Largest difference from the tests' system at all crank angles, relative to the largest force."""
        gaps, size = [], 0.0
        for place, angle in enumerate(solution.crank_angle):
            forces, torque, *_ = self.system.forces(mp.mpf(float(angle)))
            with mp.workdps(40):
                own = {name: [mp.mpf(float(part[place])) for part in parts] for name, parts in found.items()}
                gaps.append(abs(own["balancing_torque"][0] - torque) / self.r)
                for name, force in forces.items():
                    size = max(size, float(abs(force)))
                    gaps += self._gaps(own, name, force)
        return float(max(gaps)) / size

    def _gaps(self, own, name, force):
        """Differences of what the data holds of a joint."""
        if name in own and len(own[name]) == 2 and not name.startswith(("guide", "slot", "cylinder")):
            return [abs(mp.mpc(*own[name]) - force)]
        if name == "cam":
            return [abs(own["cam_force"][0] - force)]
        head = next(head for head in ("guide", "slot", "cylinder") if name.startswith(head))
        label = name.removeprefix(head)
        couple = own.get(f"{head}_moment{label}", (mp.im(force),))[0]
        return [abs(own[f"{head}_force{label}"][0] - mp.re(force)), abs(couple - mp.im(force)) / self.r]


# What is to be written


CASES_LEFT_OUT = {"mower_drives", "sawframe_2r63_cutting", "sawframe_2r63_ways"}
"""Cases whose variants are built as those of others, have teeth, or saw."""
LEFT_OUT = {"mass": 0.0, "reaction": "outside", "opposing": False}
"""Values that loads need not name: springs without mass, forces that the frame does not take, torques as given."""


def shipped(only):
    """Folder, scene and where it comes from, of every variant of the shipped cases without friction."""
    for stem in sorted(set(shipped_cases()) - CASES_LEFT_OUT):
        if not f"cases/{stem}".startswith(only[: len(f"cases/{stem}")]):
            continue
        case = ks.load_case(stem)
        for name, variant in case.variants.items():
            folder = f"cases/{stem}-{name}"
            if folder.startswith(only) and not variant.scene.friction:
                yield folder, variant.scene, {"case": f"cases/{stem}.toml", "variant": name}, None


def drawn(only):
    """Folder, scene, where it comes from and the machine itself, of the random machines."""
    for kind, count in MACHINES.items():
        for seed in range(1, count + 1):
            folder = f"machines/{kind.replace(' ', '-')}-{seed}"
            if folder.startswith(only):
                machine = Machine(kind, seed)
                yield folder, machine.scene, {"kind": kind, "seed": seed}, machine


def write(root, folder, scene, source, machine):
    """A folder with its two files."""
    count = 12 * round(scene.period / (2 * np.pi))
    solution = scene.solve(np.arange(count) * 0.5 + 0.25)
    enclosures = {name: certified(solution, name, digits=30, checks=count) for name in scene.mechanism.outputs}
    place = root / folder
    place.mkdir(parents=True)
    names, columns = _columns(solution, enclosures)
    rows = [",".join(names), *(",".join(row) for row in zip(*columns, strict=True))]
    (place / "reactions.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    agreement = {"full system with formulas of its own": max(item.agreement for item in enclosures.values())}
    if machine is not None:
        found = {name: item.middle for name, item in enclosures.items()}
        agreement["full system of the tests"] = gap = machine.disagreement(solution, found)
        if gap > CLOSE:
            raise SystemExit(f"{folder}: differs by {gap:.2g} from the system of the tests")
    text = json.dumps(described(scene, folder, source, enclosures, agreement), indent=1, ensure_ascii=False)
    (place / "case.json").write_text(text + "\n", encoding="utf-8")


def _columns(solution, enclosures):
    """Headings and texts of all columns."""
    names, columns = ["crank_angle [rad]"], [[repr(float(angle)) for angle in solution.crank_angle]]
    for name, found in enclosures.items():
        output = solution.mechanism.outputs[name]
        for part, exact in zip((".x", ".y") if output.vector else ("",), found.exact, strict=True):
            with flint.ctx.workprec(found.bits):
                texts = [value.str(DIGITS, radius=False) for value in exact]
                radius = found.radius * (found.largest or 0.0)
                bounds = [_bound(text, value, radius) for text, value in zip(texts, exact, strict=True)]
            names += [f"{name}{part} [{output.unit}]", f"{name}{part} bound [{output.unit}]"]
            columns += [texts, bounds]
    return names, columns


def _bound(text, exact, radius):
    """By how much the true value may differ from a text, rounded up to two digits."""
    off = float((flint.arb(text) - exact).abs_upper()) + radius
    return "0" if off == 0.0 else f"{1.05 * off:.1e}"


# What a machine is, in words that machines read


def described(scene, folder, source, enclosures, agreement):
    """All that a folder says of its machine."""
    mechanism = scene.mechanism
    return {
        "name": folder,
        "source": source,
        "numbers": "IEEE binary64 values, written as the shortest decimal that is read back as each; taken exactly",
        "frame": "x to the right, y up, O at the origin; angles, torques and moments counter-clockwise positive",
        "crank_speed [rad/s]": scene.crank_speed,
        "crank_acceleration [rad/s**2]": scene.crank_acceleration,
        "period [turns]": round(scene.period / (2 * np.pi)),
        "friction": None,
        "crank": describe(mechanism.crank),
        "groups": [describe(group) for group in mechanism.groups],
        "loads": [describe(load) for load in scene.loads],
        "links": {name: {"reference joint": joint} for name, joint in mechanism.references.items()},
        "joints": {
            name: {"on": point.link, "along [m]": point.along, "across [m]": point.across}
            for name, point in mechanism.joints.items()
        },
        "reactions": {name: owned(mechanism, name) for name in enclosures},
        "certified": {
            "working precision [bit]": max(item.bits for item in enclosures.values()),
            "largest radius of an enclosure, relative to the largest value": max(
                item.radius for item in enclosures.values()
            ),
            "largest disagreement, relative to the largest value": agreement,
        },
    }


def owned(mechanism, name):
    """What a reaction acts on, from what, where, and in which unit."""
    output = mechanism.outputs[name]
    found = {"unit": output.unit, "columns": [f"{name}.x", f"{name}.y"] if output.vector else [name]}
    if name == "balancing_torque":
        return found | {"acts_on": next(iter(mechanism.crank.links)), "from": "drive", "text": output.text}
    for key, pair in mechanism.pairs.items():
        if isinstance(pair, Sliding) and name in (key, pair.force, pair.couple):
            about = {"moment_about": pair.joint} if name == pair.couple else {"at": pair.joint}
            return found | {"acts_on": pair.link, "from": pair.against, **about, "text": output.text}
        if isinstance(pair, Turning) and name == key:
            carrier = pair.against or mechanism.joints[pair.joint].link
            return found | {"acts_on": pair.link, "from": carrier, "at": pair.joint, "text": output.text}
        if name == getattr(pair, "force", None):
            return found | {"acts_on": pair.link, "from": "frame", "at": pair.joint, "text": output.text}
    raise SystemExit(f"{mechanism.name}: nothing tells what {name} acts on")


def describe(item):
    """A part as a mapping of the fields that it is made of, numbers with their units."""
    if isinstance(item, Guide):
        exact = {"guide_angle [rad]": item.angle, "direction, rounded [1]": list(item.direction)}
        through = {"direction (length does not count) [1]": list(item.direction)}
        return (through if item.angle is None else exact) | {"guide_offset [m]": item.guide_offset}
    if isinstance(item, Table):
        x = "m" if item.over == "travel" else "rad"
        back = {} if item.back is None else {"back": item.back.tolist()}
        return {"over": item.over, f"x [{x}]": item.x.tolist(), "y": item.y.tolist(), **back}
    if is_dataclass(item):
        rules = item.RULES.rules
        given = [field.name for field in fields(item) if field.init and getattr(item, field.name) is not None]
        left_out = LEFT_OUT if isinstance(item, Load) else {}
        names = [name for name in given if name not in left_out or getattr(item, name) != left_out[name]]
        return {"type": type(item).__name__} | {
            name + _unit(rules.get(name), getattr(item, name)): describe(getattr(item, name)) for name in names
        }
    return [describe(part) for part in item] if isinstance(item, tuple) else item


def _unit(rule, value):
    if isinstance(rule, WholeTurns):
        return " [rad]"
    if isinstance(rule, PlaceRule | PlacePairRule):  # by name, or in m
        return "" if isinstance(value, str) else " [m]"
    rule = rule.rule if isinstance(rule, checks.Optional | checks.OrFunction) else rule
    return f" [{rule.unit}]" if isinstance(rule, checks.Number | checks.Pair | checks.Series) else ""


def made(root, only=""):
    """Write the folders whose names begin with a text."""
    with warnings.catch_warnings(action="ignore"):
        for item in (*shipped(only), *drawn(only)):
            print(item[0], flush=True)
            write(Path(root), *item)


def main():
    """Make what is asked for on the command line, in place of what was there."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="only folders whose names begin so, such as machines/lever")
    only = parser.parse_args().only
    with tempfile.TemporaryDirectory() as root:
        made(root, only)
        for found in sorted(Path(root).glob("*/*")):
            place = HERE / found.relative_to(root)
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(found, place)


if __name__ == "__main__":
    main()
