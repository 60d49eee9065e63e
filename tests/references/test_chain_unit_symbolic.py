"""Proof with SymPy that the study's formulas of the chain unit and the library's equal each other, for all lengths.

The library's kernel and the study's formulas are called as they are, on rational functions instead of numbers: lengths
r, c, h, b, the pivot's x, sine s and cosine k of the crank angle phi counted clockwise from the frame line, a = |A O2|
and S, four times the area of the triangle A B O2. Four polynomials tie them: s^2 + k^2 = 1, x^2 + h^2 = b^2, the law of
cosines for a^2 and Heron's formula for S^2. Their leading terms S^2, a^2, s^2, x^2 have no common factor, so an
expression is zero wherever they hold if, and only if, its numerator leaves no remainder on division by them.
"""

from types import SimpleNamespace

import pytest
from sympy import QQ
from sympy.polys.fields import field
from sympy.polys.orderings import lex

from kinetostatics.machine.groups import rocker
from kinetostatics.machine.links import Joint
from kinetostatics.studies.methods import papers

pytestmark = pytest.mark.slow

FIELD, S, a, s, k, x, r, c, h, b = field("S, a, s, k, x, r, c, h, b", QQ, lex)
HERON = (a + c + h) * (a + c - h) * (a - c + h) * (c + h - a)
RELATIONS = [
    relation.numer
    for relation in (S**2 - HERON, a**2 - (r**2 + b**2 - 2 * r * b * k), s**2 + k**2 - FIELD.one, x**2 + h**2 - b**2)
]


def vanishes(expression):
    """Whether an expression is zero, exactly, for every linkage and crank angle."""
    assert expression.denom.rem(RELATIONS), "the denominator is zero everywhere"
    return not expression.numer.rem(RELATIONS)


def root(expression):
    """Square root of an expression that equals a^2 or S^2."""
    return next(found for found in (a, S) if vanishes(expression - found**2))


def slope(expression):
    """Derivative by phi."""
    a_slope = r * b * s / a
    return (
        expression.diff(s) * k
        - expression.diff(k) * s
        + expression.diff(a) * a_slope
        + expression.diff(S) * HERON.diff(a) * a_slope / (2 * S)
    )


@pytest.fixture(params=[1, -1], ids=["left", "right"], scope="module")
def placed(request):
    """The library's kernel with its square root replaced, for both assemblies.

    The library counts angles the other way round, so the derivative by its crank angle is minus that by phi.
    """
    A = (r * k, -r * s)
    joint = Joint(A, (-slope(A[0]), -slope(A[1])), (-A[0], -A[1]))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rocker, "sqrt", root)
        patch.setattr(rocker, "clamped_sqrt", lambda square, unit: root(square))
        patch.setattr(rocker, "guarded_divisor", lambda root, unit: root)
        patch.setattr(rocker, "offset_from_zero", lambda distance, unit: distance)
        return joint, rocker.place(joint, c, h, (b, FIELD.zero), request.param), request.param


@pytest.fixture(scope="module")
def study_rates():
    """Rates of coupler and rocker by the study's formulas; its angles, by atan and acos, are left out."""
    functions = {
        "pi": 0,
        "hypot": lambda x, y: b,
        "cos": lambda phi: k,
        "sin": lambda phi: s,
        "sqrt": root,
        "arctan": lambda ratio: 0,
        "arccos": lambda ratio: 0,
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(papers, "np", SimpleNamespace(**functions))
        return dict(zip(("coupler", "rocker"), papers.chain_unit_by_atan_acos(r, c, h, b, 0)[2:], strict=True))


def test_printed_accelerations_are_those_of_the_left_assembly(placed, monkeypatch):
    """Equations (11)-(14), (19)-(22); phi_0 has the sine x / b and the cosine -h / b, and phi is angle 0 less it."""
    _, found, assembly = placed
    functions = {
        "pi": 2,  # so that phi is -1, apart from the angle 0 itself
        "hypot": lambda x, y: b,
        "cos": lambda angle: k if angle else (-k * h - s * x) / b,
        "sin": lambda angle: s if angle else (k * x - s * h) / b,
        "sqrt": root,
        "arctan": lambda ratio: 0,
    }
    monkeypatch.setattr(papers, "np", SimpleNamespace(**functions))
    for link, printed in zip(("coupler", "rocker"), papers.chain_unit_accelerations(r, c, h, x, 0), strict=True):
        assert vanishes(printed + getattr(found, link).ratio_slope) == (assembly == 1)


def test_directions_are_unit_vectors_closing_the_loop(placed):
    joint, found, _ = placed
    q, p = found.coupler.direction, found.rocker.direction
    assert vanishes(q[0] ** 2 + q[1] ** 2 - FIELD.one)
    assert vanishes(p[0] ** 2 + p[1] ** 2 - FIELD.one)
    for number, pivot in enumerate((b, FIELD.zero)):
        assert vanishes(joint.position[number] + c * q[number] - h * p[number] - pivot)
        assert vanishes(found.pin.position[number] - pivot - h * p[number])


@pytest.mark.parametrize("link", ["coupler", "rocker"])
def test_rates_are_slopes_of_directions(placed, link):
    found = getattr(placed[1], link)
    x, y = found.direction
    assert vanishes(x * slope(y) - y * slope(x) + found.ratio)
    assert vanishes(slope(found.ratio) + found.ratio_slope)


def test_pin_motion_is_the_slope_of_its_position(placed):
    pin = placed[1].pin
    for number in (0, 1):
        assert vanishes(slope(pin.position[number]) + pin.first[number])
        assert vanishes(slope(pin.first[number]) + pin.second[number])


def test_divisor_is_the_sine_of_the_transmission_angle(placed):
    _, found, _ = placed
    (sine, _), q, p = found.divisor, found.coupler.direction, found.rocker.direction
    assert vanishes(sine**2 - found.closure)
    assert vanishes(p[0] * q[1] - p[1] * q[0] + sine)


@pytest.mark.parametrize("link", ["coupler", "rocker"])
def test_study_rates_hold_in_the_left_assembly(placed, study_rates, link):
    """Two components, one for the turning of A-O2 and one for the opening of the triangle on it."""
    _, found, assembly = placed
    assert vanishes(study_rates[link] - getattr(found, link).ratio) == (assembly == 1)


@pytest.mark.parametrize("link", ["coupler", "rocker"])
def test_study_accelerations_hold_in_left_assembly(placed, study_rates, link):
    """The study differentiates its rates once more by the crank angle."""
    _, found, assembly = placed
    assert vanishes(slope(study_rates[link]) + getattr(found, link).ratio_slope) == (assembly == 1)


@pytest.mark.parametrize("wrong", [s**2 - k**2 - FIELD.one, S - a, S**2 - HERON + r, slope(a) - r * s])
def test_what_is_not_zero_leaves_a_remainder(wrong):
    assert not vanishes(wrong)


def test_slopes_keep_the_relations():
    """The derivative of each relation is zero, or `slope` would not be one."""
    for relation in RELATIONS:
        assert vanishes(slope(FIELD(relation)))
