"""Loss of contact in a joint with play: effective mass, the journal's motion, its flights, and what is refused."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.interpolate import CubicSpline

import kinetostatics as ks
from kinetostatics.sizing.play import SCREEN, effective_mass
from support.case_files import shipped

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.errors.HintWarning")
R, L, COUPLER, SLIDER = 0.05, 0.2, ks.Link(1.0, (0.08, 0.01), 0.01), ks.Link(2.0)


def pump(coupler=COUPLER, slider=SLIDER, speed=100.0, **more):
    return ks.solve(ks.crank_slider(R, L, coupler=coupler, slider=slider), 0.0, crank_speed=speed, **more)


def saw(variant, crank=None):
    at = shipped("sawframe_2r63").solve(variant, 8)
    made = at.mechanism if crank is None else at.mechanism.with_link("crank", crank)
    return ks.solve(made, 8, crank_speed=at.crank_speed, loads=at.loads)


# Effective mass


def opened_at(joint, angle):
    """Mass matrix of a relative motion at a joint of the pump by Lagrange: derivatives by complex steps."""
    ways = []
    for dx, dy in ((1e-30j, 0.0), (0.0, 1e-30j)):
        x, y, end, gap = R * np.cos(angle), R * np.sin(angle), 0.0, 0.0
        if joint == "A":
            x, y = x + dx, y + dy
        else:  # the slider's pin stands at (dx, dy) from the coupler's end
            end, gap = -dy, dx
        sine = (end - y) / L
        cosine = np.sqrt(1.0 - sine * sine)
        a, b = COUPLER.centre
        centre = x + a * cosine - b * sine, y + a * sine + b * cosine
        ways.append(np.imag([*centre, np.arctan(sine / cosine), x + L * cosine + gap]) / 1e-30)
    return np.array(ways) @ np.diag([COUPLER.mass, COUPLER.mass, COUPLER.inertia, SLIDER.mass]) @ np.array(ways).T


@pytest.mark.parametrize("joint", ["A", "B"])
def test_effective_mass_is_that_of_the_opened_chain(joint):
    at = pump().at(np.array([0.3, 2.0, 4.4]))
    expected = np.stack([opened_at(joint, angle) for angle in at.crank_angle], axis=-1)
    np.testing.assert_allclose(effective_mass(at, joint), expected, rtol=1e-12)


def test_effective_mass_at_a_pin_of_a_four_bar_adds_the_mobility_of_both_rods():
    """Each rod yields l^2 / I along its normal, I about its other end."""
    rods = {"coupler": ks.Link(2.0, 0.1, 0.03), "rocker": ks.Link(3.0, (0.1, 0.02), 0.05)}
    bar = ks.four_bar(0.05, 0.25, 0.2, rocker_pivot=(0.25, 0.0), **rods)
    at = ks.solve(bar, np.array([0.4, 3.0]), crank_speed=1.0)
    lengths = {"coupler": 0.25, "rocker": 0.2}
    mobility = 0.0
    for name, rod in rods.items():
        x, y = at.placement.links[name].direction
        inertia = rod.inertia + rod.mass * np.hypot(*rod.centre) ** 2
        mobility = mobility + lengths[name] ** 2 / inertia * np.array([[y * y, -x * y], [-x * y, x * x]])
    expected = np.moveaxis(np.linalg.inv(np.moveaxis(mobility, -1, 0)), 0, -1)
    np.testing.assert_allclose(effective_mass(at, "B"), expected, rtol=1e-11)


def test_springs_add_a_third_of_their_mass_to_the_slider():
    at = np.array([0.5])
    sprung = pump(loads=ks.Spring(1e3, 0.2, mass=0.9)).at(at)
    heavier = pump(slider=ks.Link(SLIDER.mass + 0.3)).at(at)
    np.testing.assert_allclose(effective_mass(sprung, "A"), effective_mass(heavier, "A"), rtol=1e-12)


# Motion of the journal


@pytest.mark.slow
@pytest.mark.parametrize(("damping", "clearance", "error"), [(0.1, 5e-5, 1e-5), (0.0, 1e-5, 0.01)])
def test_the_journal_solves_the_pendulum_by_collocation(damping, clearance, error):
    """Boundary-value problem by forces and masses of the solution itself; damping matters little to a slow journal."""
    at = saw("cam-circle")
    found = ks.sizing.contact_loss(at, "A", clearance, damping=0.1)
    angle = np.linspace(0.0, 2.0 * np.pi, 1441)
    here = at.at(angle)
    mass = clearance * float(np.mean(at.crank_speed)) ** 2 * effective_mass(here, "A")
    values = np.array([*-here.reaction("A"), mass[0, 0], mass[0, 1], mass[1, 1]])
    values[:, -1] = values[:, 0]
    known = CubicSpline(angle, values, axis=1, bc_type="periodic")

    def forces(angle):
        x, y, xx, xy, yy = known(angle)
        return np.array([x, y]), np.array([[xx, xy], [xy, yy]])

    def parts(angle, turned):
        e = np.array([np.cos(turned), np.sin(turned)])
        t = np.array([-e[1], e[0]])
        force, mass = forces(angle)
        pairs = (np.einsum("aN,abN,bN->N", u, mass, v) for u, v in ((e, e), (e, t), (t, t)))
        return (force * e).sum(axis=0), (force * t).sum(axis=0), *pairs

    def slopes(angle, y):
        _, across, _, mixed, tangential = parts(angle, y[0])
        force, slope = (known(angle, order)[0] + 1j * known(angle, order)[1] for order in (0, 1))
        turning, natural = (slope / force).imag, np.sqrt(np.abs(force) / tangential)
        fading = 1.0 + (turning / natural) ** 2
        slowed = 2.0 * damping * natural * (y[1] - turning) / fading
        return np.array([y[1], (across + mixed * y[1] ** 2) / tangential - slowed])

    direction = np.unwrap(np.arctan2(*forces(angle)[0][::-1]))
    turns = direction[-1] - direction[0]
    guess = np.array([direction, np.gradient(direction, angle)])
    ends = lambda a, b: np.array([b[0] - a[0] - turns, b[1] - a[1]])  # noqa: E731
    solved = solve_bvp(slopes, ends, angle, guess, tol=1e-5, max_nodes=100_000)
    assert solved.success
    turned, rate = solved.sol(found.angle)
    radial, across, ee, et, tt = parts(found.angle, turned)
    normal = radial + ee * rate**2 - et * (across + et * rate**2) / tt
    np.testing.assert_allclose(found.normal, normal, atol=error * found.force.max())


@pytest.mark.slow
def test_a_slow_journal_lags_in_proportion_to_play():
    """C M_tt theta'' = |F| sin d to first order; so d and N - |F| grow with c."""
    one, two = (ks.sizing.contact_loss(saw("cam-circle", ks.Link(100.0, 0.15)), "O", c) for c in (1e-6, 2e-6))
    assert np.abs(one.lag).max() < 0.01
    np.testing.assert_allclose(two.lag, 2.0 * one.lag, atol=0.02 * np.abs(two.lag).max())
    more = two.normal - two.force
    np.testing.assert_allclose(more, 2.0 * (one.normal - one.force), atol=0.02 * np.abs(more).max())


def test_a_plain_reversal_lands_by_the_cubic_law():
    """A massless coupler presses the slider along one line: F = F' t crosses 2 c in (12 m c / F')^(1/3)."""
    at = pump(coupler=ks.Link(), slider=ks.Link(2.0))
    clearance = 1e-10
    found = ks.sizing.contact_loss(at, "B", clearance)
    assert found.index == np.inf == found.earles_wu
    assert len(found.reversals) == len(found.flights) == 2
    for start, flight in zip(found.reversals, found.flights, strict=True):
        assert np.hypot(*at.at(start).reaction("B")) < 1e-9 * found.force.max()
        step = 1e-6
        growth = np.hypot(*(at.at(start + step).reaction("B") - at.at(start - step).reaction("B"))) / (2 * step) * 100.0
        mass = effective_mass(at.at(np.array([start])), "B")[..., 0].trace()
        time = (12.0 * mass * clearance / growth) ** (1 / 3)
        assert flight.stop - flight.start == pytest.approx(100.0 * time, rel=0.01)
        assert flight.speed == pytest.approx(growth * time**2 / (2.0 * mass), rel=0.01)
        assert flight.energy == pytest.approx(0.5 * mass * flight.speed**2, rel=0.01)


# The saw


@pytest.mark.slow
def test_the_saw():
    """The plain saw turns its force at O fast, a massless crank lets it reverse, a heavy crank keeps it on one side."""
    plain = ks.sizing.contact_loss(saw("plain"), "O", 1e-4)
    assert plain.earles_wu == pytest.approx(5.7396, abs=1e-4)
    assert plain.index == pytest.approx(1.587, abs=1e-3)
    assert plain.least_normal < 0.0 < plain.impact_energy
    assert not plain.reversals
    light = ks.sizing.contact_loss(saw("cam-circle"), "O", 1e-4)
    np.testing.assert_allclose(np.degrees(light.reversals), [93.04, 181.35, 266.99, 358.73], atol=0.005)
    assert light.index == np.inf
    heavy = ks.sizing.contact_loss(saw("cam-circle", ks.Link(100.0, 0.15)), "O", 1e-4)
    assert heavy.earles_wu == pytest.approx(1.10, abs=0.005)
    assert heavy.least_force == pytest.approx(15.9e3, abs=50.0)
    assert heavy.flights == heavy.reversals == ()
    assert heavy.impact_energy == 0.0 < heavy.least_normal


@pytest.mark.slow
def test_rate_of_turning_by_differences():
    """Earles and Wu's index from reactions a little apart, at the angle where it is largest."""
    at = saw("plain")
    found = ks.sizing.contact_loss(at, "A", 1e-5)
    angle = found.angle[np.argmax(found.index_curve)] + np.array([-1e-4, 0.0, 1e-4])
    force = at.at(angle).reaction("A")
    rate = (np.arctan2(*force[::-1, 2]) - np.arctan2(*force[::-1, 0])) / 2e-4
    expected = abs(rate * float(at.crank_speed)) / np.sqrt(np.hypot(*force[:, 1]))
    assert found.earles_wu == pytest.approx(expected, rel=1e-4)


# Laws


@pytest.mark.slow
def test_both_senses_and_other_masses_and_speeds():
    found = ks.sizing.contact_loss(pump(), "B", 2e-5, damping=0.1)
    assert found.flights
    back = ks.sizing.contact_loss(pump(coupler=ks.Link(1.0, (0.08, -0.01), 0.01), speed=-100.0), "B", 2e-5, damping=0.1)
    heavy = ks.sizing.contact_loss(pump(ks.Link(3.0, (0.08, 0.01), 0.03), ks.Link(6.0)), "B", 2e-5, damping=0.1)
    fast = ks.sizing.contact_loss(pump(speed=200.0), "B", 2e-5, damping=0.1)
    for other, speed, energy in ((back, 1.0, 1.0), (heavy, 1.0, 3.0), (fast, 2.0, 4.0)):
        assert other.index == pytest.approx(found.index, rel=1e-6)
        assert other.lost_angle == pytest.approx(found.lost_angle, rel=1e-4)
        assert other.impact_speed == pytest.approx(speed * found.impact_speed, rel=1e-4)
        assert other.impact_energy == pytest.approx(energy * found.impact_energy, rel=1e-4)
    starts = np.mod(-np.array([flight.start for flight in back.flights]), 2.0 * np.pi)
    np.testing.assert_allclose(np.sort(starts), np.sort([flight.start for flight in found.flights]), atol=1e-5)


def test_a_large_force_that_reverses_knocks_harder_than_a_small_one():
    small, large = (
        ks.sizing.contact_loss(pump(coupler=ks.Link(), slider=ks.Link(2.0), speed=speed), "B", 1e-5)
        for speed in (10.0, 1000.0)
    )
    assert small.index == large.index == np.inf
    assert large.impact_energy == pytest.approx(1e4 * small.impact_energy, rel=1e-4)


# What is told and refused


def test_it_says_that_it_is_a_screen_and_warns_of_reversals_alone():
    with pytest.warns(ks.HintWarning) as warned:
        found = ks.sizing.contact_loss(pump(coupler=ks.Link()), "B", 1e-5)
    (reversals,) = (str(item.message) for item in warned)
    assert "B passes through zero at 76.7, 283.3 deg" in reversals
    assert found.notes[0] == SCREEN
    assert found.notes[1] in reversals
    assert SCREEN in repr(found)
    assert SCREEN in found.table().attrs["notes"]
    assert list(found.table().index) == list(found.ROWS)


TWO = ks.Link(np.array([[1.0], [2.0]]))
OPEN = ks.crank_slider(0.3, 0.2, slider=SLIDER)
REFUSED = {
    "no play": (pump, "B", {"clearance": 0.0}, "clearance must be greater than 0"),
    "negative play": (pump, "B", {"clearance": -1e-4}, "clearance must be greater than 0"),
    "NaN": (pump, "B", {"clearance": np.nan}, "clearance must be finite"),
    "both": (pump, "B", {"clearance": 0.0, "damping": 0.0}, "clearance .*; damping must be greater than 0"),
    "tiny play": (pump, "B", {"clearance": 2e-9}, "swings .* times in a period, more than the 3000"),
    "guide": (pump, "guide", {}, "joint is 'guide', allowed: 'O', 'A', 'B'"),
    "unknown": (pump, "C", {}, "joint is 'C', allowed"),
    "no mass": (lambda: pump(ks.Link(), ks.Link(), loads=ks.ProcessForce(9.0)), "B", {}, "no mass on either side"),
    "no force": (lambda: pump(ks.Link(), ks.Link()), "B", {}, "'B' carries no force"),
    "rest": (lambda: pump(speed=0.0, loads=ks.Gravity()), "B", {}, "crank_speed must not be 0"),
    "gaps": (lambda: ks.solve(OPEN, 0.0, crank_speed=9.0, on_gap="nan"), "B", {}, "does not close"),
    "batch": (lambda: pump(slider=TWO), "B", {}, "one design at a time"),
    "change points": (
        lambda: ks.solve(ks.crank_slider(0.2, 0.2, assembly="open", slider=SLIDER), 0.1, crank_speed=9.0),
        "B",
        {},
        "grows without bound",
    ),
    "no solution": (lambda: "s", "B", {}, "solution must be a Solution"),
}


@pytest.mark.parametrize(("solution", "joint", "numbers", "message"), REFUSED.values(), ids=REFUSED)
def test_what_is_refused(solution, joint, numbers, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.contact_loss(solution(), joint, **{"clearance": 1e-4} | numbers)


def test_a_journal_that_swings_fast_lies_in_the_force():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 50.0), slider=ks.Link(600.0))
    s = ks.solve(saw, 0.0, crank_speed=33.5)
    with pytest.warns(ks.HintWarning, match="swings 1.4e.06 times in a period: it counts as aligned with the force"):
        found = ks.sizing.contact_loss(s, "B", 1e-12)
    assert (found.flights, found.least_normal) == ((), found.least_force)
    assert found.index == pytest.approx(found.earles_wu * np.sqrt(found.effective_mass * 1e-12), rel=1e-4)


def test_motion_that_cannot_be_followed_is_refused(monkeypatch):
    monkeypatch.setattr("kinetostatics.sizing.play.MAX_EVALUATIONS", 200)
    with pytest.raises(ks.ParameterError, match=r"motion cannot be computed at .* deg"):
        ks.sizing.contact_loss(pump(), "B", 1e-5)


@pytest.mark.slow
def test_play_without_landing_is_refused():
    with pytest.raises(ks.ParameterError, match="does not land within a period"):
        ks.sizing.contact_loss(pump(coupler=ks.Link()), "B", 100.0)


# The figure


@pytest.mark.slow
@pytest.mark.parametrize("coupler", [COUPLER, ks.Link()])
def test_the_figure_shows_forces_index_and_flights(coupler):
    found = ks.sizing.contact_loss(pump(coupler=coupler), "B", 1e-5, damping=0.5)
    ax = ks.plots.contact_loss(found)
    assert [line.get_label() for line in ax.lines[:2]] == ["|F| without play", "normal force N"]
    assert len(ax.patches) == 3 * len(found.flights)
    with pytest.raises(ks.ParameterError, match="must be a ContactLoss"):
        ks.plots.contact_loss("B")
