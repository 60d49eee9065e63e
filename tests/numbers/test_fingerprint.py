"""Code of the user's is told by all that it refers to: other constants never meet an old program."""

import types
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import KERNELS
from kinetostatics.numbers.fingerprint import class_key, key_of

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
