"""Graphs and recordings: kernels run once for each structure; branches on values are refused."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import code_cache, record
from kinetostatics.engines.graph import Node, needed
from kinetostatics.engines.program import Program, program_of
from kinetostatics.engines.record import Gaps, Recorder
from kinetostatics.engines.simplify import SimplifiedGraph
from kinetostatics.machine.loads import TURN
from support.every import every
from support.scenes import SCENES, six_bar


def test_recorded_numbers_have_no_value():
    recorded = []
    force = ks.ProcessForce(lambda motion: recorded.append(motion.travel()[0]) or motion.travel())
    program_of(ks.solve(SCENES["plain"].mechanism, [0.1], crank_speed=1.0, loads=force).dynamics, ("A",))
    node = next(value for value in recorded if isinstance(value, Node))
    for look in (bool, float, int, lambda x: x == 0, lambda x: x != 0, lambda x: x > 0, lambda x: x <= 0.0):
        with pytest.raises(TypeError, match="is unknown while recording"):
            look(node)
    with pytest.raises(TypeError, match="only squares"):
        node**3


# Recordings

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
    "six-bar": lambda size: ks.Scene(six_bar(size), 30.0),
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
def test_other_numbers_of_a_structure_record_nothing(counted, interpreted, name, engine):
    first = FAMILIES[name](1.0).solve(ANGLES, engine=engine).balancing_torque
    before = dict(counted)
    second = FAMILIES[name](1.05).solve(ANGLES, engine=engine).balancing_torque
    assert counted == before
    assert not np.array_equal(first, second)
    kernels = FAMILIES[name](1.05).dynamics(ANGLES)
    assert np.allclose(second, kernels.balancing_torque, rtol=0.0, atol=1e-13 * np.abs(second).max())


@pytest.mark.parametrize("factor", [2.0, 5.0])
def test_other_constants_of_a_function_are_seen(factor):
    """In a closure, and in what it names of its module."""

    def force(motion):
        return factor * motion.slider_velocity

    found = plain(load=ks.ProcessForce(force)).solve(ANGLES).guide_force
    kernels = plain(load=ks.ProcessForce(lambda m: factor * m.slider_velocity)).dynamics(ANGLES)
    wanted = kernels.scalar("guide_force")
    assert np.allclose(found, wanted, rtol=0.0, atol=1e-14 * np.abs(wanted).max())


def test_a_zero_is_absent_and_makes_another_structure():
    massless = plain().mechanism.with_link("coupler", ks.Link())
    one, other = (ks.Scene(made, 30.0).dynamics(ANGLES) for made in (plain().mechanism, massless))
    assert one.apart[0] != other.apart[0]
    assert program_of(other)[0].recording.operations < program_of(one)[0].recording.operations


SHORT = ks.SliderGroup(0.04, ks.Guide.at(np.pi / 2), pin="C", label="2")
VEE = ks.Mechanism("vee", ks.Crank(0.05), (ks.SliderGroup(0.2), SHORT))


def recorder():
    return Recorder(ks.Scene(VEE, 7.0).solve([0.1, 1.5], on_gap="nan").apart[0], None, SimplifiedGraph())


def values(recorder, output):
    """At a crank angle where both close, and at one where the second does not."""
    s = ks.Scene(VEE, 7.0).solve([1.0, 0.1], on_gap="nan")
    assert s.closed.tolist() == [True, False]
    numbers = s.apart[1].numbers
    return Program(None, (output,))._by_numbers(s.crank_angle, numbers, (2,))[0]


@pytest.mark.slow
@every("output", [0.0, 2.5])
@every(
    "name, open_", [("balancing_torque", True), ("guide_force2", True), ("crank_rate", True), ("guide_force", False)]
)
def test_a_constant_is_nan_where_its_group_is_open(output, name, open_):
    found = recorder()
    first, second = values(found, Gaps(found.graph, found.recorded).added(output, name))
    assert first == output
    assert np.isnan(second) == open_


def test_an_output_that_needs_everything_is_unchanged():
    found = recorder()
    (x, *_), *_ = (joint.position for joint in (found.recorded.placement.joints["C"],))
    gaps, node, count = Gaps(found.graph, found.recorded), np.ravel(x)[0], len(found.graph)
    assert gaps.added(node, "slider2_position") is node
    assert len(found.graph) == count
    whole = gaps.added(node, "balancing_torque")
    assert [part.operation for part in needed([whole])].count("root") == 2
