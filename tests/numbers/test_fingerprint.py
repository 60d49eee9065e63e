"""Fingerprints of designs and of user code."""

import functools
import subprocess
import sys
import types
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import KERNELS
from kinetostatics.numbers.fingerprint import class_key, digest, key_of
from support.every import every

BASE = """
from dataclasses import dataclass
from functools import cache, partial, wraps

import numpy as np

MASS = 1.0
TABLE = np.array([1.0, 2.0])
SHAPES = {"a": (1.0, 2.0)}

def helper(x):
    return x * MASS

def function(crank, factor=2.0, *, offset=0.5):
    # a word
    return helper(crank) * factor + offset + TABLE[0] + SHAPES["a"][1]

def recursive(crank):
    return recursive(crank - 1) if crank > 0 else other(crank)

def other(crank):
    return recursive(crank) + 3.0

def inner(crank):
    return [(lambda y: y * 4.0)(x) for x in crank]

def made(factor):
    def closure(crank):
        return crank * factor + helper(crank)
    return closure

def decorated(call):
    @wraps(call)
    def wrapper(*given):
        return call(*given) * 5.0
    return wrapper

@decorated
def wrapped(crank):
    return crank + 6.0

@cache
def cached(crank):
    return crank + 7.0

class Made:
    scale = 8.0

    def __init__(self, factor=9.0):
        self.factor = factor

    def __call__(self, crank):
        return crank * self.factor * self.scale * self.twice

    @property
    def twice(self):
        return 10.0

    def method(self, crank):
        return self.factor

    @staticmethod
    def static(crank):
        return 11.0

class Heir(Made):
    pass

class Slotted:
    __slots__ = ("factor",)

    def __init__(self):
        self.factor = 12.0

    def __call__(self, crank):
        return crank

@dataclass(frozen=True)
class Frozen:
    law: object = lambda x: x + 13.0
    factor: float = 14.0

    def __call__(self, crank):
        return self.law(crank)

items = {
    "function": function,
    "recursive": recursive,
    "inner": inner,
    "closure": made(15.0),
    "partial": partial(function, factor=16.0),
    "partial of partial": partial(partial(function, 17.0), offset=18.0),
    "partial of a closure": partial(made(19.0)),
    "wrapped": wrapped,
    "cached": cached,
    "object": Made(),
    "method": Made(20.0).method,
    "static": Made.static,
    "heir": Heir(),
    "slotted": Slotted(),
    "frozen": Frozen(),
    "array": partial(function, np.arange(3000.0)),
    "set": partial(function, {21.0, 22.0, "b"}),
}
"""


def items(text=BASE):
    module = types.ModuleType("users_own")
    exec(text, module.__dict__)
    return module.items


CHANGES = [
    ("MASS = 1.0", "MASS = 1.1", "function, partial, partial of partial, closure"),
    ("[1.0, 2.0]", "[1.5, 2.0]", "function, partial"),
    ('"a": (1.0, 2.0)', '"a": (1.0, 2.5)', "function, partial"),
    ("return x * MASS", "return x + MASS", "function, partial, partial of partial, closure, partial of a closure"),
    ("factor=2.0", "factor=2.5", "function, partial"),
    ("offset=0.5", "offset=0.6", "function, partial, array"),
    ("crank - 1", "crank - 2", "recursive"),
    ("+ 3.0", "+ 3.5", "recursive"),
    ("y * 4.0", "y * 4.5", "inner"),
    ("* 5.0", "* 5.5", "wrapped"),
    ("+ 6.0", "+ 6.5", "wrapped"),
    ("+ 7.0", "+ 7.5", "cached"),
    ("8.0", "8.5", "object, heir"),
    ("9.0", "9.5", "object, heir"),
    ("return 10.0", "return 10.5", "object, heir"),
    ("return 11.0", "return 11.5", "static, object"),
    ("self.factor\n", "-self.factor\n", "method, object"),
    ("12.0", "12.5", "slotted"),
    ("13.0", "13.5", "frozen"),
    ("14.0", "14.5", "frozen"),
    ("15.0", "15.5", "closure"),
    ("16.0", "16.5", "partial"),
    ("17.0", "17.5", "partial of partial"),
    ("18.0", "18.5", "partial of partial"),
    ("19.0", "19.5", "partial of a closure"),
    ("20.0", "20.5", "method"),
    ("arange(3000.0)", "arange(3000.0) + (np.arange(3000) == 1500)", "array"),
    ("22.0", "22.5", "set"),
]


@pytest.mark.slow
@every(("before", "after", "names"), CHANGES)
def test_a_change_is_seen_wherever_it_is(before, after, names):
    assert before in BASE
    one, other = items(), items(BASE.replace(before, after))
    for name in names.split(", "):
        assert digest(one[name]) != digest(other[name]), name


@every("name", items())
def test_what_does_the_same_is_the_same(name):
    """Elsewhere in its file, with other comments, and another object each time."""
    assert digest(items()[name]) == digest(items("\n\n" + BASE.replace("# a word", "# another"))[name])


def test_each_is_another():
    told = [digest(item) for item in items().values()]
    assert len(set(told)) == len(told)


@pytest.mark.slow
def test_function_key_is_the_same_in_every_session(tmp_path):
    (tmp_path / "users_own.py").write_text(BASE, encoding="utf-8")
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import users_own;"
        "from kinetostatics.numbers.fingerprint import digest;"
        "print(*map(digest, users_own.items.values()))"
    )
    found = {subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout for _ in range(2)}
    assert found == {" ".join(map(digest, items().values())).encode() + b"\n"}


def test_objects_that_hold_themselves_come_to_an_end():
    held: list = [1.0]
    held.append(held)
    other: list = [2.0]
    other.append(other)
    one, two = (functools.partial(max, item) for item in (held, other))
    assert digest(one) == digest(functools.partial(max, held)) != digest(two)


def test_hand_made_variants_differ_by_every_number():
    def made(mass, law=np.sin):
        loads = (ks.ProcessForce(lambda motion: law(motion.crank_angle)),)
        return ks.Scene(ks.crank_slider(np.full((2000, 1), 0.3), 2.0, slider=ks.Link(mass)), 10.0, 0.0, loads)

    masses = np.linspace(1.0, 2.0, 2000)[:, None]
    changed = masses + 1e-9 * (np.arange(2000) == 1000)[:, None]
    assert digest(made(masses)) == digest(made(masses.copy())) != digest(made(changed))
    assert digest(made(1.0)) != digest(made(1.0, np.cos))


def test_functions_of_libraries_are_told_by_name():
    assert digest(np.sin) != digest(np.cos)
    assert digest(np.mean) != digest(np.median)
    assert digest(len) != digest(max)
    assert digest(Path.exists) != digest(Path.is_dir)


# Code of the user's is told by all that it refers to

ANGLES = np.linspace(0.0, 6.0, 20)
GAIN = 1.0
MODULE = types.ModuleType("gains")


class Gains:
    gain = 1.0


class Kept:
    gain = 1.0

    def law(self, motion):
        """Force whose gain may change."""
        return self.gain * motion.slider_velocity


def nested(motion):
    inner = lambda speed: GAIN * speed  # noqa: E731
    return inner(motion.slider_velocity)


def by_class(motion):
    return Gains.gain * motion.slider_velocity


def by_module(motion):
    return MODULE.gain * motion.slider_velocity


def by_attribute(motion):
    return by_attribute.gain * motion.slider_velocity


def recursive(motion, depth=3):
    return GAIN * motion.slider_velocity if depth == 0 else recursive(motion, depth - 1)


def named(motion):
    return GAIN * motion.slider_velocity


@dataclass(frozen=True, eq=False)
class ByGlobal:
    on: str = "slider"

    def push(self, motion):
        """Force, N."""
        return named(motion)


@dataclass(frozen=True, eq=False)
class ByClassConstant:
    on: str = "slider"
    gain = 1.0

    def push(self, motion):
        """Force, N."""
        return self.gain * motion.slider_velocity


class ByTable(ByClassConstant):
    gains = {"all": 1.0}  # noqa: RUF012 - what users write

    def push(self, motion):
        """Force, N."""
        return self.gains["all"] * motion.slider_velocity


@dataclass(frozen=True, eq=False)
class Structural:
    law: Any = field(metadata={"structural": True})
    on: str = "slider"

    def push(self, motion):
        """Force, N."""
        return self.law(motion)


WAYS = {
    "function within a function": (lambda: ks.ProcessForce(nested), "{module}.GAIN"),
    "recursive function": (lambda: ks.ProcessForce(recursive), "{module}.GAIN"),
    "class constant": (lambda: ks.ProcessForce(by_class), "{module}.Gains.gain"),
    "module": (lambda: ks.ProcessForce(by_module), "{module}.MODULE.gain"),
    "attribute of the function": (lambda: ks.ProcessForce(by_attribute), "{module}.by_attribute.gain"),
    "global in a method": (ByGlobal, "{module}.GAIN"),
    "constant of a load's class": (ByClassConstant, "{module}.ByClassConstant.gain"),
    "table of a load's class": (ByTable, "{module}.ByTable.gains"),
    "function in a structural field": (lambda: Structural(named), "{module}.GAIN"),
}


@pytest.mark.parametrize("name", WAYS)
def test_changed_constants_are_seen(name, monkeypatch):
    load, place = WAYS[name]
    found = []
    for gain in (1.0, 500.0):
        value = {"all": gain} if name.startswith("table") else gain
        monkeypatch.setattr(place.format(module=__name__), value, raising=False)
        pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
        solution = ks.solve(pump, ANGLES, crank_speed=100.0, loads=load())
        kernels = KERNELS.values(solution.dynamics, ("balancing_torque",))["balancing_torque"]
        assert np.allclose(solution.balancing_torque, kernels, rtol=1e-12, atol=1e-12)
        found.append(kernels)
    assert np.abs(found[1] - found[0]).max() > 1.0


def test_what_may_change_unseen_has_no_key():
    held = [1.0]
    assert key_of(lambda: held) is None
    assert key_of(lambda late=held: late) is None
    assert key_of(lambda get=held.__getitem__: get(0)) is None
    assert key_of(lambda law=np.poly1d([1.0, 2.0]): law(0)) is None
    assert key_of(lambda law=Kept().law: law(0)) is None
    assert key_of(lambda: GAIN) is not None


@pytest.mark.parametrize("kind", [ByGlobal, ByClassConstant, ByTable, Structural])
def test_ordinary_classes_have_a_key(kind):
    assert class_key(kind, (kind,)) is not None
    assert class_key(kind, (kind,)) == class_key(kind, (kind,))
