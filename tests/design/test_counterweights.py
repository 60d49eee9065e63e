"""Counterweights: masses, arms and limits, the link with its counterweight, and what they did elsewhere."""

import functools
import re

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.balancing import Counterweight, counterweight, full, optimal, partial
from kinetostatics.design.counterweights import balancing_table
from support.balanced import (
    CAM,
    FOUR_BAR,
    HEAVY,
    INCLINED,
    ROUNDING,
    SKEW,
    along_and_across,
    mower,
    solved,
    unbalance,
)
from support.case_files import shipped
from support.every import every
from support.machines import largest

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""Bodies drawn at random have any inertia."""


def test_mass_and_arm_give_the_same_counterweight():
    by_mass = partial(INCLINED, "overall", crank=Counterweight(mass=6.0))
    by_arm = partial(INCLINED, "overall", crank=Counterweight(arm=-0.11))
    np.testing.assert_allclose(unbalance(by_mass), unbalance(by_arm), rtol=1e-14)
    assert by_mass.counterweights["crank"][0] == 6.0
    assert np.hypot(*by_arm.counterweights["crank"][1]) == pytest.approx(0.11, rel=1e-14)
    forces = [solved(item.mechanism).shaking_force for item in (by_mass, by_arm)]
    np.testing.assert_allclose(*forces, rtol=0, atol=ROUNDING * largest(forces[0]))


@pytest.mark.parametrize("given", [{"arm": -0.09}, {"mass": 40.0}])
def test_whole_link_agrees_with_its_counterweight(given):
    """Designing the link anew with its total mass or centre, or adding to it what is missing."""
    whole = partial(INCLINED, "overall", crank=Counterweight(**given, whole_link=True))
    link = whole.mechanism.links["crank"]
    assert link.mass == pytest.approx(given.get("mass", link.mass), rel=1e-15)
    assert np.hypot(*link.centre) == pytest.approx(abs(given.get("arm", np.hypot(*link.centre))), rel=1e-14)
    added = partial(INCLINED, "overall", crank=Counterweight(mass=link.mass - 3.0)).mechanism.links["crank"]
    assert (added.mass, added.inertia) == pytest.approx((link.mass, link.inertia), rel=1e-13)
    assert added.centre == pytest.approx(link.centre, rel=1e-13)


@pytest.mark.parametrize(("mechanism", "link"), [(SKEW, "coupler"), (FOUR_BAR, "rocker"), (CAM, "block")])
def test_link_with_counterweight_moves_as_two_bodies(mechanism, link):
    """Inertia by parallel axes: torque and shaking moment are those of the bare mechanism and of a point mass alone."""
    whole = counterweight(mechanism, link, (-0.4, 0.3), Counterweight(mass=2.5))
    alone = mechanism
    for name in mechanism.links:
        alone = alone.with_link(name, ks.Link(2.5, (-0.16, 0.12)) if name == link else ks.Link())
    together, *apart = (solved(item, 9.0, -40.0) for item in (whole.mechanism, mechanism, alone))
    for name in ("balancing_torque", "balancing_torque_by_power", "shaking_moment", "shaking_force"):
        expected = sum(getattr(s, name) for s in apart)
        assert largest(getattr(together, name) - expected) < ROUNDING * largest(expected), name
        assert largest(getattr(apart[1], name)) > 1e-3 * largest(expected)


def test_nothing_is_added_where_nothing_is_needed():
    once = partial(mower(), 0.5, crank=Counterweight(arm=-0.035)).mechanism
    assert largest(unbalance(partial(once, 0.5, crank=HEAVY))) < 1e-16


# Report and effect


def test_report_has_masses_arms_and_unbalances():
    found = full(SKEW, crank=Counterweight(mass=20.0), coupler=Counterweight(mass=30.0))
    report = found.report()
    assert list(report.index) == ["crank", "coupler"]
    assert all(re.search(r"\[(m|kg|kg m|deg)\]$", name) for name in report.columns)
    assert np.all(np.isfinite(report))
    masses = [ks.principal_points(item).mass for item in (found.bare, found.mechanism)]
    assert found.added_mass == pytest.approx(masses[1] - masses[0]) == report["counterweight mass [kg]"].sum()
    for name, row in report.iterrows():
        bare, new, change = SKEW.links[name], found.mechanism.links[name], unbalance(found, name)
        np.testing.assert_allclose(new.mass * np.array(new.centre), bare.mass * np.array(bare.centre) + change)
        assert row["counterweight unbalance [kg m]"] == pytest.approx(np.hypot(*change))
        assert row["counterweight mass [kg]"] * row["counterweight arm [m]"] == pytest.approx(-np.hypot(*change))
        assert row["counterweight phase [deg]"] == pytest.approx(np.degrees(np.arctan2(*change[::-1])))
        assert row["link mass after [kg]"] - row["link mass before [kg]"] == row["counterweight mass [kg]"]
        assert row["link unbalance after [kg m]"] == pytest.approx(new.mass * np.hypot(*new.centre))
        assert row["link centre after [m]"] == pytest.approx(-np.hypot(*new.centre))
        assert row["modulus h [m]"] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.slow
@pytest.mark.parametrize("found", [partial(SKEW, crank=HEAVY), full(FOUR_BAR, crank=HEAVY, rocker=HEAVY)])
def test_effect_gives_true_extremes_before_and_after(found):
    drive = {"crank_speed": 10.0, "crank_acceleration": 20.0, "loads": ks.Gravity()}
    effect = found.effect(**drive)
    assert np.all(np.isfinite(effect))
    assert list(effect.columns) == ["before", "after", "change [%]"]
    for column, mechanism in (("before", found.bare), ("after", found.mechanism)):
        s = ks.solve(mechanism, 0.0, **drive)
        expected = {
            "mass of links [kg]": sum(link.mass for link in mechanism.links.values()),
            "largest shaking force [N]": ks.extremes(s, "shaking_force").range[1],
            "largest shaking force along guide [N]": abs(ks.extremes(s, lambda s: along_and_across(s)[0]).largest),
            "largest shaking force across guide [N]": abs(ks.extremes(s, lambda s: along_and_across(s)[1]).largest),
            "largest shaking moment [N m]": abs(ks.extremes(s, "shaking_moment").largest),
            "largest balancing torque [N m]": abs(ks.extremes(s, "balancing_torque").largest),
        } | {f"largest reaction {joint} [N]": ks.extremes(s, joint).largest for joint in s.reactions}
        assert dict(effect[column]) == pytest.approx(expected, rel=1e-12, abs=1e-11)
    np.testing.assert_allclose(1 + effect["change [%]"] / 100, effect["after"] / effect["before"], atol=1e-12)


# Limits

NEEDED = 0.209 / 3
"""Unbalance, kg m, of the counterweight on the mower's crank that leaves no force across the guide."""


@every(
    ("weight", "message"),
    [
        ({"arm": -0.035, "largest_mass": 1.5}, "crank: the counterweight needs 1.99048 kg, exceeds .* mass 1.5 kg"),
        ({"mass": 1.0, "largest_arm": 0.05}, "crank: the counterweight needs 0.0696667 m, exceeds .* arm 0.05 m"),
        ({"mass": 1.0, "keep_out": 0.08}, "crank: the counterweight needs 0.0696667 m, lies inside .* 0.08 m"),
        ({"mass": 1.0, "largest_arm": NEEDED * (1 - 1e-9)}, "0.0696667 m, exceeds the largest arm 0.0696667 m"),
        ({"mass": 1.0, "keep_out": NEEDED * (1 + 1e-9)}, "0.0696667 m, lies inside the keep-out radius 0.0696667 m"),
        ({"arm": -0.02, "whole_link": True, "largest_mass": 1.5}, "needs 1.53333 kg, exceeds .* mass 1.5 kg"),
        (
            {"arm": -0.06, "whole_link": True},
            "would have 0.844444 kg, less than the 1 kg of the bare link.* choose a shorter arm",
        ),
        ({"mass": 1.0, "whole_link": True}, "would have 1 kg, less than the 1 kg of the bare link.* or a larger mass"),
    ],
)
def test_impossible_limit_is_refused_with_numbers(weight, message):
    with pytest.raises(ks.ParameterError, match=message):
        partial(mower(), "across", crank=Counterweight(**weight))


@pytest.mark.parametrize("slack", [-1e-15, 0.0, 1e-15, 1e-13])
def test_a_limit_just_met_is_kept(slack):
    """Rounding decides on neither side of it."""
    for weight in (
        Counterweight(arm=-0.035, largest_mass=NEEDED / 0.035 * (1 + slack)),
        Counterweight(mass=1.0, largest_arm=NEEDED * (1 + slack)),
        Counterweight(mass=1.0, keep_out=NEEDED * (1 + slack)),
    ):
        assert unbalance(partial(mower(), "across", crank=weight))[0] == pytest.approx(-NEEDED, rel=1e-14)


@pytest.mark.parametrize("whole_link", [False, True])
def test_wrong_sided_arm_is_refused_with_the_right_one(whole_link):
    with pytest.raises(ks.ParameterError, match=r"other side of the joint: arm -0.035 m$") as caught:
        partial(mower(), "overall", crank=Counterweight(arm=0.035, whole_link=whole_link))
    remedy = Counterweight(arm=float(re.findall(r"arm (\S+) m$", str(caught.value))[0]), whole_link=whole_link)
    assert partial(mower(), "overall", crank=remedy).ratio == pytest.approx(0.5)


def test_no_counterweight_or_batch_is_refused():
    batch = ks.crank_slider(np.array([[0.03], [0.04]]), 0.3, slider=ks.Link(1.0))
    for ask in (
        lambda: partial(mower(), 0.5, crank=3.0),
        lambda: full(mower(), crank=None, coupler=Counterweight(arm=-0.1)),
        lambda: optimal(mower(), crank=0.05),
        lambda: optimal(mower(), crank=Counterweight(arm=0.03, whole_link=True)),
        lambda: partial(batch, 0.5, crank=Counterweight(arm=-0.03)),
    ):
        with pytest.raises(ks.ParameterError):
            ask()


def test_crank_counterweight_leaves_the_rest_unchanged():
    found = ks.balancing.partial(
        ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0)), crank=HEAVY
    )
    change = found.effect(crank_speed=62.8)["change [%]"]
    for row in ("reaction A [N]", "reaction B [N]", "reaction guide [N]", "balancing torque [N m]"):
        assert str(change[f"largest {row}"]) == "0.0"
    assert abs(change["largest reaction O [N]"]) > 1.0


# The table of balanced variants


@pytest.fixture(scope="module")
def mower_table():
    """The first balanced variant of the mower drive: name, report, solution, and a function that makes the table."""
    case = shipped("mower_drive")
    name = next(name for name, variant in case.variants.items() if variant.balanced is not None)
    balanced, before, after = case.variants[name].balanced, case.solve(case.reference, 36), case.solve(name, 36)
    return name, balanced.report(), after, functools.partial(balancing_table, before, {name: (balanced, after)})


def test_rows_are_those_of_the_report_in_millimetres(mower_table):
    name, report, _, table = mower_table
    for link, row in report.iterrows():
        column = table()[f"{name} {link}"]
        assert column["counterweight arm [mm]"] == pytest.approx(1e3 * row["counterweight arm [m]"], abs=1e-8)
        assert column["counterweight mass [kg]"] == pytest.approx(row["counterweight mass [kg]"], abs=1e-8)


def test_the_largest_force_is_the_true_extreme(mower_table):
    *_, after, table = mower_table
    first = table(sampling=np.radians(5.0)).iloc[:, 0]
    largest = ks.extremes(after, "shaking_force").range[1]
    assert first["largest |F| [N]"] == pytest.approx(largest, rel=1e-9)
    assert first["largest |F| on the study's grid [N]"] <= largest * (1 + 1e-12)
    assert "largest |F| on the study's grid [N]" not in table().index
