"""Truncated series and simplifications."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies import needs as ingredients
from kinetostatics.studies import simplifications
from kinetostatics.studies.simplifications import two_mass_coupler, up_to_harmonic
from support.studied import MECHANISMS, TURN, alone, change, cranked, solved


@pytest.fixture
def few_models(monkeypatch):
    """Of combinations, for tests of simplifications alone."""
    monkeypatch.setattr(ingredients, "MAX_MODELS", 10)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_series_has_the_first_harmonics(order):
    full = solved(cranked(guide_offset=0.05))
    series = up_to_harmonic(order, full)
    spectrum = np.fft.rfft(full.slider_acceleration)
    spectrum[order + 1 :] = 0.0
    expected = np.fft.irfft(spectrum, n=TURN.size)
    assert np.max(np.abs(series.slider_acceleration - expected)) < 1e-12 * np.max(np.abs(expected))


@pytest.mark.slow
@pytest.mark.parametrize("name", MECHANISMS)
def test_the_series_error_falls_with_the_order(few_models, name):
    full = solved(MECHANISMS[name])
    errors = [change(up_to_harmonic(order, full), full, "O") for order in (1, 2, 4, 8, 16)]
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > 1e-2
    assert errors[-1] < 1e-5
    found = alone(ks.needs(full, "O"))
    assert [found[name].error for name in ("one harmonic", "two harmonics")] == pytest.approx(errors[:2])


# What a scene is made of, and each part of it left out or put more simply


@pytest.mark.slow
def test_every_present_ingredient_is_offered(few_models):
    mechanism = cranked(guide_angle=0.3, guide_offset=0.05)
    loads = [ks.Gravity(), ks.Spring(1e3, 1.0), ks.ProcessForce(20.0), ks.Force(5.0, at="B")]
    loads += [ks.GasSpring(1e-3, 1e-3, 2e5, at=1.0), ks.BalanceShaft(0.1)]
    loads += [ks.Mowing(9.0, pitch=0.1, start=0.03, end=0.06)]
    loads += [ks.Sawing(kerf=0.003, height=0.1, saws=1, feed_per_stroke=0.01, resistance=1e6)]
    loads += [kind(5.0, on="coupler") for kind in (ks.Torque, ks.TorsionSpring, ks.TorsionDamper)]
    loads += [kind(5.0, between=("A", (3.0, 3.0))) for kind in (ks.PointForce, ks.PointSpring, ks.PointDamper)]
    rubbing = {"O": ks.PinFriction(0.1, 0.01), "guide": ks.GuideFriction(0.1)}
    everything = alone(ks.needs(solved(mechanism, loads, crank_acceleration=50.0, friction=rubbing), "O"))
    offered = simplifications.ingredients(mechanism).values()
    assert set(everything) == {choice.name for choices in offered for choice in choices}
    bare = ks.crank_slider(0.2, 1.3, slider=ks.Link(5.0))
    assert set(alone(ks.needs(solved(bare, ()), "O"))) == {"massless slider", "two harmonics", "one harmonic"}
    rocking = alone(ks.needs(solved(MECHANISMS["four-bar"]), "O"))
    assert {"no rocker inertia", "massless rocker"} < set(rocking)
    assert "massless block" in alone(ks.needs(solved(MECHANISMS["cam"]), "O"))


# Simplified models


@pytest.mark.parametrize("name", MECHANISMS)
def test_two_masses_have_the_product_inertia(name):
    """Mass m and centre at s along the length l are kept; the moment of inertia becomes m s (l - s)."""
    mechanism = MECHANISMS[name]
    bar = ks.Link(4.0, (0.5, 0.0), 4.0 * 0.5 * (1.3 - 0.5))
    same = solved(mechanism.with_link("coupler", bar), crank_acceleration=-40.0)
    masses = solved(two_mass_coupler(mechanism), crank_acceleration=-40.0)
    assert masses.mechanism.links["coupler"].mass == 0
    total, kept = (sum(link.mass for link in made.links.values()) for made in (mechanism, masses.mechanism))
    assert kept == pytest.approx(total, rel=1e-15)
    for quantity in ("balancing_torque", "O", "shaking_force", "shaking_moment"):
        assert change(masses, same, quantity) < 1e-14, quantity
    assert change(masses, solved(mechanism, crank_acceleration=-40.0), "balancing_torque") > 1e-3


def test_massless_coupler_has_no_two_masses():
    assert two_mass_coupler(ks.crank_slider(0.2, 1.3, slider=ks.Link(5.0))) is None


@pytest.mark.parametrize(("name", "output"), [("crank-slider", "slider"), ("cam", "slider"), ("four-bar", "rocker")])
def test_massless_link_carries_its_coupler_share(name, output):
    made = solved(MECHANISMS[name])
    for choices in simplifications.ingredients(made.mechanism).values():
        for choice in choices:
            if choice.name in (f"massless {output}", "two-mass coupler"):
                made = choice.simplify(made)
    assert made.mechanism.links[output].mass == pytest.approx(4.0 * 0.5 / 1.3)


# What cannot be simplified

BEYOND = {"before A": -0.2, "behind B": 1.5}


@pytest.mark.slow
@pytest.mark.parametrize("place", BEYOND)
def test_outer_coupler_mass_is_no_two_masses(place):
    """One of them would be negative; all else is tried."""
    found = ks.needs(solved(cranked(coupler=ks.Link(4.0, (BEYOND[place], 0.06), 0.3))), "O")
    why = found.left_out["two-mass coupler"]
    assert why == (
        f"the mass centre of the coupler, {BEYOND[place]} m along its 1.3 m, is beyond its joints, so one of two "
        "masses at them would be negative"
    )
    assert f"two-mass coupler left out: {why}" in str(found)
    assert {"massless coupler", "no coupler inertia", "one harmonic"} <= set(alone(found))
    assert "two-mass coupler" not in alone(found)


@pytest.mark.slow
@pytest.mark.parametrize("place", [0.0, 1.3])
def test_coupler_mass_at_a_joint_is_two_masses(place):
    found = ks.needs(solved(cranked(coupler=ks.Link(4.0, place, 0.3))), "O")
    assert "two-mass coupler" in alone(found)
    assert found.left_out == {}
