"""Programs by structure: recorded once for all numbers, with exact derivatives."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import code_cache, record
from kinetostatics.engines.program import program_of
from kinetostatics.machine.loads import TURN
from kinetostatics.mechanics.dynamics import Dynamics

ANGLES = np.linspace(0.1, 6.2, 7)
SIZES = np.array([[0.9], [1.0], [1.1]])


def plain(size=1.0, speed=30.0, load=None):
    saw = ks.crank_slider(0.3 * size, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0 * size))
    return ks.Scene(saw, speed, loads=(ks.Gravity(9.81 * size), *([load] if load else ())))


def cam(size=1.0, speed=30.0):
    mechanism = ks.cam_crank_slider(ks.cams.Circle(0.3 * size, (-0.02, 0.0)), 2.0, slider=ks.Link(600.0))
    return ks.Scene(mechanism, speed, loads=ks.Spring(7e5 * size, 2.0))


def four_bar(size=1.0, speed=30.0):
    return ks.Scene(
        ks.four_bar(0.1 * size, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=ks.Link(2.0 * size, 0.1, 0.1)), speed
    )


def six_bar(size=1.0, speed=30.0):
    groups = (
        ks.RockerGroup(0.4, 0.3, (0.35, 0.0)),
        ks.SliderGroup(0.5, on="B", pin="C", label="2", slider=ks.Link(size)),
    )
    return ks.Scene(ks.Mechanism("six-bar", ks.Crank(0.1), groups), speed)


@pytest.fixture
def counted(monkeypatch):
    """Counts recordings, and modules that are made of programs, which numba would compile."""
    found = {"recordings": 0, "compilations": 0}
    recorded, load = record.record, code_cache.load_module

    def record_(*given):
        found["recordings"] += 1
        return recorded(*given)

    def load_(*given, **options):
        found["compilations"] += 1
        return load(*given, **options)

    monkeypatch.setattr("kinetostatics.engines.program.record", record_)
    monkeypatch.setattr("kinetostatics.engines.code_cache.load_module", load_)
    return found


def speeds(size):
    return np.linspace(20.0, 30.0, ANGLES.size) * size


FAMILIES = {
    "plain": plain,
    "cam": cam,
    "four-bar": four_bar,
    "six-bar": six_bar,
    "crank speed over the angles": lambda size: plain(size, speeds(size)),
    "designs": lambda size: plain(SIZES * size),
    "a table over the angles": lambda size: plain(size, load=ks.ProcessForce(speeds(size))),
    "a function": lambda size: plain(size, load=ks.ProcessForce(_drag)),
    "a sampled cam": lambda size: ks.Scene(_sampled(size), 30.0),
}


def _drag(motion):
    return -5.0 * motion.slider_velocity


def _sampled(size):
    angle = np.linspace(0.0, TURN, 72, endpoint=False)
    return ks.cam_crank_slider(ks.cams.Sampled(angle, 0.3 * size + 0.01 * np.cos(angle)), 2.0, slider=ks.Link(600.0))


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
@pytest.mark.parametrize("name", FAMILIES)
def test_other_numbers_in_the_same_structure_record_and_compile_nothing(counted, interpreted, name, engine):
    first = FAMILIES[name](1.0).solve(ANGLES, engine=engine).balancing_torque
    before = dict(counted)
    second = FAMILIES[name](1.05).solve(ANGLES, engine=engine).balancing_torque
    assert counted == before
    assert not np.array_equal(first, second)
    kernels = Dynamics(*_fields(FAMILIES[name](1.05)), loads=FAMILIES[name](1.05).loads)
    assert np.allclose(second, kernels.balancing_torque, rtol=0.0, atol=1e-13 * np.abs(second).max())


def _fields(scene):
    return scene.mechanism, ANGLES, scene.crank_speed, scene.crank_acceleration


@pytest.mark.parametrize("factor", [2.0, 5.0])
def test_other_constants_of_a_function_are_seen(factor):
    """In a closure, and in what it names of its module."""

    def force(motion):
        return factor * motion.slider_velocity

    found = plain(load=ks.ProcessForce(force)).solve(ANGLES).guide_force
    kernels = Dynamics(*_fields(plain()), loads=plain(load=ks.ProcessForce(lambda m: factor * m.slider_velocity)).loads)
    wanted = kernels.scalar("guide_force")
    assert np.allclose(found, wanted, rtol=0.0, atol=1e-14 * np.abs(wanted).max())


def test_what_is_zero_is_absent_and_makes_another_structure():
    one, other = (Dynamics(*_fields(plain())), Dynamics(*_fields(cam())))
    assert one.apart[0] != other.apart[0]
    without = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 30.0)
    assert program_of(Dynamics(*_fields(without)))[0].recording.operations < program_of(one)[0].recording.operations
