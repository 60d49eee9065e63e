"""Sums fused with a product: which, and that no zero is spoilt that symmetry makes."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.fusing import fused_sums
from kinetostatics.engines.graph import Graph, needed
from kinetostatics.engines.program import Program, program_of
from kinetostatics.engines.record import Recording


@pytest.fixture
def graph():
    return Graph()


def numbers(graph):
    """Sine and cosine of the crank angle, and some numbers of a design."""
    angle = graph.angle()
    return angle.sin(), angle.cos(), *map(graph.parameter, range(4))


def parts(total):
    found = fused_sums(needed([total])).get(total)
    return found and (found.sign, {found.one, found.other}, found.rest_sign, found.rest)


def test_a_product_goes_into_its_sum_with_the_sign_it_has(graph):
    sine, cosine, one, other, *_ = numbers(graph)
    product = sine * cosine
    assert parts(product + one) == (1, {sine, cosine}, 1, one)
    assert parts(one - product) == (-1, {sine, cosine}, 1, one)
    assert parts(product - other) == (1, {sine, cosine}, -1, other)
    assert parts(-product - other) == (-1, {sine, cosine}, -1, other)
    assert parts(sine + one) is None
    assert parts(one * other + one) is None  # once for a design


def test_of_two_products_the_one_that_is_known_later_is_fused(graph):
    sine, cosine, one, *_ = numbers(graph)
    early, late = sine * sine, (cosine + one) * cosine
    for total in (early + late, late + early):
        assert parts(total) == (1, {cosine + one, cosine}, 1, early)


def test_products_that_twins_could_make_equal_stay_rounded(graph):
    sine, cosine, one, other, third, fourth = numbers(graph)
    force, twin = one * (other * sine + one) * cosine, third * (fourth * sine - other) * cosine
    for total in (force - twin, twin + (force + one), (one - force) - (twin + cosine).held()):
        assert fused_sums([*needed([total])]).get(total) is None
    assert parts(force - sine * sine) is not None


def test_a_fused_loop_keeps_the_zero_of_twins_with_equal_numbers(graph):
    pytest.importorskip("numba")
    sine, cosine, one, other, third, fourth = numbers(graph)
    lever, twin = one * sine + other * cosine, third * sine + fourth * cosine
    outputs = lever * lever * cosine - twin * twin * cosine, lever * sine - twin * sine, lever - twin
    program = Program(Recording((), outputs, (), (), (one, other, third, fourth), (), graph))
    angles = np.linspace(0.0, 6.0, 500)
    assert not program.by_loop(angles, [0.1, 0.7, 0.1, 0.7], (), angles.shape).any()
    assert program.by_loop(angles, [0.1, 0.7, 0.1, 0.8], (), angles.shape).any(axis=-1).all()


@pytest.mark.slow
def test_a_value_is_the_same_to_the_last_bit_whatever_is_computed_with_it():
    pytest.importorskip("numba")
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, (1.0, 0.1), 20.5), slider=ks.Link(600.0))
    s = ks.solve(saw, np.linspace(0.0, 6.0, 500), crank_speed=33.5, loads=ks.Gravity(), engine="compiled")
    state, found = s.dynamics, []
    for names in (("O",), ("balancing_torque", "O", "guide_force", "kinetic_energy")):
        program, leaves = program_of(state, names)
        for made in (program, program.bounded(), program.by_parameters((0, 1))):
            rows = made.run(state, leaves, compiled=True)[: len(program.outputs)]
            found.append(program.recording.named(rows)["O"])
    assert all(np.array_equal(found[0], other) for other in found)
