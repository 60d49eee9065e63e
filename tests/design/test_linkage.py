"""Four-bar characteristics: transmission angle, swing, chain unit; the study's formulas measured."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.design.linkage import chain_unit, chain_unit_angle, rocker_angle, swing, transmission_angle
from kinetostatics.studies.methods.papers import chain_unit_by_atan_acos
from support import multibody
from support.machines import TURN, FourBar, largest, planar, turning
from support.machines import four_bar_of as four_bar
from support.machines import swept as solved
from support.strategies import four_bars, number, reproducible

pytestmark = pytest.mark.filterwarnings("ignore:.*near a limit position:kinetostatics.errors.ConditionWarning")

# Transmission angle and swing


@pytest.mark.slow
@settings(reproducible, max_examples=20)
@given(data=st.data())
def test_transmission_angle_obeys_the_law_of_cosines(data):
    bar, _ = data.draw(four_bars("crank-rocker"))
    s = bar.solve()
    square = abs(bar.pivot - planar(s.position("A"))) ** 2
    cosine = (bar.coupler**2 + bar.rocker**2 - square) / (2 * bar.coupler * bar.rocker)
    assert_allclose(transmission_angle(s), np.arccos(cosine), rtol=0, atol=1e-13)


@pytest.mark.slow
@settings(reproducible, max_examples=15)
@given(data=st.data(), start=number(0.0, 6.28))
def test_swing_reaches_both_limit_positions(data, start):
    """Crank and coupler in line make a triangle of coupler +- crank, rocker and frame; both assemblies swing alike."""
    bar, _ = data.draw(four_bars("crank-rocker"))
    s = bar.solve()
    found, (b, h) = swing(s, start), (abs(bar.pivot), bar.rocker)
    reach = np.array([bar.coupler + bar.crank, bar.coupler - bar.crank])
    at_pivot = np.arccos((b * b + h * h - reach**2) / (2 * b * h))
    assert found.range == pytest.approx(at_pivot[0] - at_pivot[1], rel=1e-11)
    limits = s.at(np.array([found.largest_at, found.smallest_at]))
    A, B = planar(limits.position("A")), planar(limits.position("B"))
    assert_allclose(turning(A, B) / abs(A) / abs(B), 0.0, atol=1e-9)
    assert_allclose(rocker_angle(limits, start), [found.largest, found.smallest], rtol=0, atol=1e-15)
    assert found.asymmetry == abs(found.smallest) / found.largest
    assert rocker_angle(s.at(np.array([start])), start) == 0.0


# Chain unit


def test_study_and_library_angles_convert():
    """+y, +x, -y, -x, clockwise, and back."""
    clockwise = np.pi / 2 * np.arange(4)
    assert_allclose(chain_unit_angle(clockwise), [np.pi / 2, 0.0, -np.pi / 2, -np.pi])
    assert_allclose(chain_unit_angle(chain_unit_angle(TURN)), TURN)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
def test_parallel_start_has_parallel_crank_and_rocker(ratio):
    s = ks.solve(chain_unit(ratio, 1.0, 2 / 3), chain_unit_angle(0.0), crank_speed=1.0)
    assert_allclose(s.placement.links["rocker"].direction, [0.0, 1.0], atol=4e-15)
    assert_allclose(s.position("B"), [np.sqrt(1 - ratio**2), 0.0], atol=4e-15)


def test_free_start_counts_from_the_study_angle():
    """psi_0 = psi_0' - beta, from the triangle A0 B0 O2 with |A0 O2|^2 = x_O2^2 + (h + r)^2."""
    r, c, h, x = 0.075, 0.3, 0.2, 0.28
    s = ks.solve(chain_unit(r, c, h, pivot_x=x), chain_unit_angle(np.radians([0.0, 40.0])), crank_speed=-1.0)
    diagonal = np.hypot(x, h + r)
    psi_0 = np.arccos((diagonal**2 + h**2 - c**2) / (2 * diagonal * h)) - np.arctan(x / (h + r))
    along_x, along_y = s.placement.links["rocker"].direction
    assert np.arctan2(along_x, along_y)[0] == pytest.approx(psi_0, abs=1e-15)
    assert rocker_angle(s) == pytest.approx([0.0, np.arctan2(along_x, along_y)[1] - psi_0], abs=1e-15)


def test_parallel_start_equals_its_free_start():
    free, parallel = (solved(chain_unit(0.3, 1.0, 0.6, pivot_x=x)) for x in (np.sqrt(0.91), None))
    assert_allclose(free.position("B"), parallel.position("B"), rtol=0, atol=1e-15)


def test_rocker_angle_of_a_batch_equals_the_loop():
    rho = np.array([[0.1], [0.3], [0.5]])
    batch = rocker_angle(solved(chain_unit(rho, 1.0, 2 / 3)))
    for row, one in zip(batch, rho[:, 0].tolist(), strict=True):
        assert_allclose(row, rocker_angle(solved(chain_unit(one, 1.0, 2 / 3))), rtol=0, atol=1e-15)


@pytest.mark.parametrize(("crank", "words"), [(1.0, "got 1.0 m and 1.0 m"), (np.array([[0.5], [1.2]]), "1.2")])
def test_parallel_start_needs_a_long_coupler(crank, words):
    with pytest.raises(
        ks.ParameterError, match=r"(?s)coupler longer than the crank.*pivot_x for a free start"
    ) as caught:
        chain_unit(crank, 1.0, 0.5)
    assert words in str(caught.value)


# The study's formulas


def study(lengths, angle):
    """Directions and rates of coupler and rocker by the study, by the library, and by 50 digits; shape (2, N) each."""
    r, c, h, x = lengths
    gamma, psi, *rates = chain_unit_by_atan_acos(r, c, h, x, angle)
    s = ks.solve(chain_unit(r, c, h, pivot_x=x), chain_unit_angle(angle), crank_speed=1.0, on_gap="nan")
    links = [s.placement.links[name] for name in ("coupler", "rocker")]
    system = multibody.four_bar(FourBar(r, c, h, complex(x, -h), speed=1.0, acceleration=0.0))
    exact = [system.motion(one) for one in chain_unit_angle(angle)]
    names = [("coupler", "angle"), ("rocker", "angle")]
    turned = [[(found["position"][name], found["velocity"][name]) for found in exact] for name in names]
    turned = np.array(turned, dtype=float)
    return {
        "study": (np.array([np.exp(-1j * gamma), 1j * np.exp(-1j * psi)]), np.array(rates)),
        "library": (np.array([planar(link.direction) for link in links]), np.array([link.ratio for link in links])),
        "exact": (np.exp(1j * turned[..., 0]), turned[..., 1]),
    }


def wrong(found, expected):
    """Where directions or rates are off by more than rounding, even at a toggle."""
    return np.abs(found - expected) > 1e-9


CLOCKWISE = np.linspace(0.0, 2 * np.pi, 361)[:-1] + 0.001


@pytest.mark.slow
@pytest.mark.parametrize("lengths", [(0.5, 1.0, 2 / 3, np.sqrt(0.75)), (0.25, 1.0, 2 / 3, 0.93)])
def test_study_agrees_where_its_conditions_hold(lengths):
    found = study(lengths, CLOCKWISE[::5])
    for name in ("study", "library"):
        for values, expected in zip(found[name], found["exact"], strict=True):
            assert_allclose(values, expected, rtol=0, atol=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lengths", "closed", "coupler_wrong", "rocker_wrong"),
    [((0.3, 0.6, 1.0, 0.2), 360, 97, 0), ((0.9, 1.0, 2 / 3, np.sqrt(0.19)), 274, 97, 12)],
)
def test_study_fails_where_its_conditions_fail(lengths, closed, coupler_wrong, rocker_wrong):
    """Counted at 360 angles, those at which the linkage closes.

    Half a turn off: the coupler where A is right of O2, the rocker where b <= r cos(phi). The first is a crank-rocker
    whose crank turns fully, the second has a long crank. The rates have no atan and are right everywhere.
    """
    r, c, h, x = lengths
    angle = CLOCKWISE[np.isfinite(solved(chain_unit(r, c, h, pivot_x=x), chain_unit_angle(CLOCKWISE)).rate("rocker"))]
    found = study(lengths, angle)
    coupler, rocker = wrong(found["study"][0], found["exact"][0])
    assert np.array_equal(coupler, r * np.sin(angle) > x)
    assert np.array_equal(rocker, np.hypot(x, h) <= r * np.cos(angle - np.pi / 2 - np.arctan(h / x)))
    assert (angle.size, coupler.sum(), rocker.sum()) == (closed, coupler_wrong, rocker_wrong)
    assert_allclose(found["study"][0][:, coupler][0], -found["exact"][0][:, coupler][0], atol=1e-9)
    assert not np.any(wrong(found["study"][1], found["exact"][1]))
    assert not any(np.any(wrong(a, b)) for a, b in zip(found["library"], found["exact"], strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("margin", [1e-4, 1e-10])
def test_both_lose_digits_near_a_toggle(margin):
    """Both: directions eps / sqrt(margin), rates 0.1 eps / margin; acos costs the study twice what the library loses.

    At `margin` 0 crank and coupler could be stretched into one line with the frame. Worst of 40 angles around it.
    """
    r, h, x = 0.3, 2 / 3, 0.9
    b, eps = np.hypot(x, h), np.finfo(float).eps
    toggle = 1.5 * np.pi + np.arctan(h / x)
    found = study((r, (b + r) * (1 + margin) - h, h, x), toggle + np.sqrt(margin) * np.linspace(-2.0, 2.0, 40))
    for name, allowed in (("library", 2 * eps), ("study", 4 * eps)):
        directions, rates = (largest(found[name][k] - found["exact"][k]) for k in (0, 1))
        assert directions < allowed / np.sqrt(margin)
        assert rates < 0.1 * allowed / margin


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@pytest.mark.parametrize("longer", [1e2, 1e6])
def test_long_rocker_costs_the_study_digits(longer):
    """A coupler of 1 and a rocker of `longer`: the cosine from which psi comes is 1 but for 1 / longer^2."""
    found = study((0.5, 1.0, longer, np.sqrt(0.75)), CLOCKWISE[::5])
    error = {name: largest((found[name][0] - found["exact"][0])[1]) for name in ("study", "library")}
    assert error["library"] < 1e-15
    assert error["study"] > 0.1 * longer * np.finfo(float).eps


@pytest.mark.parametrize(
    ("lengths", "words"),
    [
        ((3.5, 4.0, 3.0, 1.0), "this one is a double-crank"),
        ((2.0, 2.0, 1.0, 4.0), "does not close all round"),
        ((2.0, 3.0, 3.5, 5.0), "does not close all round"),
    ],
)
def test_swing_is_refused_for_full_turns(lengths, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.linkage.swing(ks.solve(four_bar(lengths), [0.0], crank_speed=1.0, on_gap="nan"))


def test_characteristics_refuse_other_linkages():
    chain = ks.Mechanism(
        "six-bar",
        ks.Crank(0.1),
        (ks.SliderGroup(0.4), ks.RockerGroup(0.5, 0.5, (0.9, 0.5), on="B", pin="C", label="2")),
    )
    slider = ks.solve(ks.crank_slider(0.1, 0.4), [0.0], crank_speed=1.0)
    for ask in (
        lambda: ks.linkage.grashof(chain),
        lambda: ks.linkage.rocker_angle(slider),
        lambda: ks.linkage.transmission_angle(slider),
        lambda: ks.linkage.grashof(ks.four_bar(1.0, 2.0, 2.0, rocker_pivot=(0.0, 0.0))),
        lambda: ks.linkage.chain_unit("0.1", 1.0, 0.5),
    ):
        with pytest.raises(ks.ParameterError):
            ask()


def test_rocker_angle_of_one_angle_is_a_number():
    solution = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 2 / 3), np.pi / 2, crank_speed=-1.0)
    assert ks.linkage.rocker_angle(solution).shape == ()
    assert ks.linkage.rocker_angle(solution) == 0.0


@pytest.mark.slow
def test_chain_unit_optimum_keeps_its_pivot():
    """The parallel start puts the rocker's pivot where crank and coupler say, through every step."""
    case = ks.load_case("chain_unit")
    vary = {"crank_length": ("0.1 m", "0.2 m"), "coupler_length": ("0.25 m", "0.35 m")}
    found = ks.design.optimise(
        case, vary, "mean_absolute balancing_torque", limits=["largest O >= 300 N"], variant="rho-0.5"
    )
    crank, coupler = found.values["crank_length"], found.values["coupler_length"]
    pivot = found.scene.parameters["rocker_pivot.x"]
    assert pivot == pytest.approx(np.sqrt(coupler**2 - crank**2), rel=1e-14)
    assert crank != pytest.approx(0.15, rel=1e-3)
    assert ks.extremes(found.scene.solve(12), "O").largest >= 300 * (1 - 1e-9)
