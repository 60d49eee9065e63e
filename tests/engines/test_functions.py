"""Functions keep to what bounds take for granted of them, and bounds of what vanishes as linkages fold vanish too."""

from fractions import Fraction

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import loops, programs
from kinetostatics.engines.compiled import available
from kinetostatics.engines.error_bounds import OWN, SMALL_TURN, Error, ErrorBounds, tight_bounds
from kinetostatics.engines.trace import Graph
from kinetostatics.numbers.elementary import APART, UNIT, UNSEEN, apart, sign, total
from support import bounded
from support.every import every

OTHER = {"sin": "cos", "cos": "sin"}
WAYS = {
    "running": lambda graph, output, inputs=None: ErrorBounds(graph, inputs).of([output])[0],
    "tight": lambda graph, output, inputs=None: tight_bounds(graph, inputs, [output])[0],
}


def bound_of(way, graph, output, angle, *values):
    return programs.Program(None, [WAYS[way](graph, output)])._by_numbers(np.array([angle]), values, (1,))[0, 0]


@every("function, exact", [("sin", "sin"), ("cos", "cos"), ("arctan", "atan")])
def test_elementary_functions_of_numpy_and_of_compiled_loops_keep_to_their_ulp(flint, function, exact):
    random = np.random.default_rng(1)
    angles = np.concatenate(
        [random.uniform(-7, 7, 400), random.uniform(-1, 1, 400) * 10.0 ** random.uniform(-12, 6, 400)]
    )
    found = [getattr(np, function)(angles)]
    if available() and function != "arctan":
        found.append(loops.turn(angles[None])[function == "cos"][0])
    with flint.ctx.workprec(200):
        truth = [getattr(flint.arb(float(angle)), exact)() for angle in angles]
        error = [float(abs((flint.arb(float(v)) - t) / t)) for own in found for v, t in zip(own, truth, strict=True)]
    assert max(error) <= OWN.ulp.get(function, OWN.ulp["atan"]) * UNIT


@every("function", OTHER)
def test_a_sine_or_cosine_is_a_sign_where_the_other_is_small(function):
    random = np.random.default_rng(2)
    folds = (np.arange(-3000, 3000) + 0.5 * (function == "sin")) * np.pi
    angles = [folds, folds + random.choice([-1, 1], 6000) * 10.0 ** -random.uniform(8, 17, 6000)]
    angles = np.concatenate([*angles, 10.0 ** -np.arange(8.2, 320) if function == "cos" else []])
    turns = [(np.sin(angles), np.cos(angles))]
    if available():
        turns.append([part[0] for part in loops.turn(angles[None])])
    for turn in turns:
        own, other = turn if function == "sin" else turn[::-1]
        small = np.abs(other) < SMALL_TURN
        assert np.count_nonzero(small) > 6000
        assert np.all(np.abs(own[small]) == 1.0)


@every("way", WAYS)
@every("function", OTHER)
@every("side", [1.0, -1.0])
def test_one_less_a_sine_or_cosine_is_bounded_as_the_square_of_the_other_is_small(way, function, side):
    for distance in (1e-12, 1e-9, 3e-8, 1e-4):
        graph = Graph()
        part = sign(graph.parameter(0)) * getattr(graph.angle(), function)()
        angle = {"sin": 0.5 * np.pi, "cos": 0.0}[function] + (np.pi if side < 0.0 else 0.0) + distance
        other = getattr(np, OTHER[function])(angle)
        for output in (part - side, side - part, part + -side):
            bound = bound_of(way, graph, output, angle, 0.3)
            assert 0.5 * other * other * (distance < SMALL_TURN) <= bound < 8.0 * min(other * other, UNIT)


@every("way", WAYS)
def test_a_sign_that_may_be_the_other_is_no_known_one(way):
    graph = Graph()
    given, other = graph.parameter(0), graph.parameter(1)
    angle, values = 1e-9, (0.1 + 0.2, 0.3)
    for unsure in ((given + 1.0) - (other + 1.0), graph.angle() - other):
        folded = sign(unsure) * graph.angle().cos() - 1.0
        assert not bound_of(way, graph, folded, angle, *values) < UNIT
    for sure in (given + 1e-300, given - other):  # one rounding turns no sign
        assert bound_of(way, graph, sign(sure) * graph.angle().cos() - 1.0, angle, *values) < 1e-17


@every("way", WAYS)
def test_a_total_of_given_numbers_that_loses_nothing_is_exact(way):
    """As where lengths fall in line: an error of their sum would count beside what is however small."""
    graph = Graph()
    parts = [graph.parameter(place) for place in range(5)]
    for values, least in (([0.5, 0.2, -0.5, -0.2, 0.0], 1e-290), ([0.1, 0.2, -0.3, 1e-40, 1e-60], 1e-46)):
        exact = sum(map(Fraction, values))
        off = abs(Fraction(total(*values)) - exact)
        bound = Fraction(bound_of(way, graph, total(*parts) * graph.angle(), 1.0, *values))
        assert off <= bound <= 9 * UNIT * abs(exact) + Fraction(least)


@pytest.mark.slow
@every("family, seed", [("place", 70019), ("place", 70138), ("inclined", 70017), ("inclined", 70115)])
@every("tight", [False, True])
def test_what_is_moved_off_zero_to_have_a_direction_is_in_bounds(flint, family, seed, tight):
    """Where linkages fold, 4e-121 of their lengths make 6e-93 of an acceleration that is truly none."""
    assert bounded.errors(bounded.solution(family, seed, 8), tight=tight).wrong == []


@every("way", WAYS)
def test_what_is_moved_by_a_share_of_lengths_is_in_bounds(way):
    graph = Graph()
    moved = apart(0.5 * graph.angle(), graph.parameter(0) + graph.parameter(1))
    assert bound_of(way, graph, moved, 0.0, 3.0, 4.0) >= APART * 7.0


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("angle", [1e-100, 1e-121, 1e-150, -1e-150, 1e-300])
def test_however_near_to_a_change_point_bounds_hold_or_are_infinite(flint, angle):
    links = {name: ks.Link(1.0, (0.15, 0.0), 0.01) for name in ("crank", "coupler", "rocker")}
    for assembly in (1, "open", "crossed"):
        rhombus = ks.four_bar(0.3, 0.3, 0.3, rocker_pivot=(0.3, 0.0), assembly=assembly, **links)
        s = ks.solve(rhombus, [angle, 2.0 * angle], crank_speed=3.0, loads=[ks.Gravity()], on_gap="nan")
        assert bounded.errors(s).wrong == []


@every("way", WAYS)
@every("given", [-1e-130, -0.9 * APART * UNSEEN])
def test_a_sign_that_is_turned_by_what_moves_it_off_zero_is_no_known_one(way, given):
    """Along an axis a pivot so near to O is taken to lie on its other side."""
    graph = Graph()
    folded = sign(apart(graph.parameter(0), UNSEEN)) * graph.angle().cos() - 1.0
    assert not bound_of(way, graph, folded, 1e-9, given) < 1.0
    assert bound_of(way, graph, folded, 1e-9, 0.3) < 1e-17


@every("way", WAYS)
def test_a_sign_of_what_is_no_exact_number_is_known_only_where_its_error_cannot_turn_it(way):
    graph = Graph()
    given = graph.parameter(0)
    inputs = {given: lambda bounds: Error(4.0, None)}
    folded = sign(given - 0.3) * graph.angle().cos() - 1.0
    for value, is_known in ((0.3 + 2.0**-54, False), (0.3 + 1e-9, True)):
        found = programs.Program(None, [WAYS[way](graph, folded, inputs)])._by_numbers(np.array([1e-9]), [value], (1,))[0, 0]
        assert (found < 1e-17) == is_known
