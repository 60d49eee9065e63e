"""The sawframe study's dynamic coefficients: what its equations give to the letter, and what right mechanics gives.

The study prints n_d = 6.2, 7.55, 8.13, 6.42, k_d = 6.77, a support reaction about 12 times smaller, almost 5 tf on the
cam and a coupler inertia force of 25 to 54 kN. Its equation for the slot force has a minus where the equilibrium of
the block has a plus, and it takes springs to cancel the slider's inertia exactly, which with the circular cam they do
nearly.
"""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import components, magnitude
from kinetostatics.studies.methods import papers
from kinetostatics.studies.precision import METHODS
from support.case_files import shipped
from support.every import every

CASE = shipped("sawframe_2r63")
PLAIN, CIRCLE, COSINE = (CASE.solve(name) for name in ("plain", "cam-circle", "cam-cosine"))
SLIDER = CASE.variant("cam-circle").mechanism.links["slider"].mass
CANCELLED = ks.solve(
    CIRCLE.mechanism,
    CIRCLE.crank_angle,
    crank_speed=CIRCLE.crank_speed,
    loads=[ks.Gravity(), ks.ProcessForce(lambda motion: SLIDER * motion.slider_acceleration)],
)
"""Right mechanics by the library itself, a force of minus the slider's inertia in place of the spring."""
PUBLISHED = {"n_d": [6.2, 7.55, 8.13, 6.42], "k_d": 6.77, "O": 12.0}
BY_PAPERS = papers.by_the_papers(papers.exactly_cancelled(CIRCLE))
COLUMNS = {
    "as printed": (papers.as_printed(CIRCLE), [6.178, 7.544, 8.131, 6.381], 6.724, 12.43, 53.87),
    "right sign": (BY_PAPERS, [7.099, 6.0, 6.317, 7.42], 6.629, 14.29, 53.87),
    "right sign, by the library": (CANCELLED, [7.099, 6.0, 6.317, 7.42], 6.629, 14.29, 53.87),
    "linear spring": (CIRCLE, [6.367, 5.498, 5.727, 6.598], 6.081, 12.87, 49.93),
    "linear spring, by the papers' formulas": (
        papers.by_the_papers(CIRCLE), [6.367, 5.498, 5.727, 6.598], 6.081, 12.87, 49.93,
    ),
}  # fmt: skip


def difference(s):
    """Largest difference of the torques by equilibrium and by powers, N m."""
    return np.max(np.abs(s.balancing_torque - s.balancing_torque_by_power))


@pytest.mark.parametrize("column", [name for name in COLUMNS if name != "as printed"])
def test_right_sign_balances_powers_to_rounding(column):
    assert difference(COLUMNS[column][0]) < 1e-10


def test_printed_sign_fails_by_1176_newton_metres():
    s, *_ = COLUMNS["as printed"]
    assert difference(s.at(np.radians(np.arange(0, 360, 0.1)))) == pytest.approx(1176, abs=1)


def test_block_balances_with_the_right_sign_only():
    """Forces on the block from coupler, cam and slotted crank; the cam's normal leans back by the pressure angle."""

    def unbalanced(s):
        ray, normal = (np.exp(1j * angle) for angle in (s.crank_angle, s.crank_angle - s.pressure_angle))
        from_coupler = -(s.reaction("A")[0] + 1j * s.reaction("A")[1])
        return np.max(np.abs(from_coupler - s.cam_force * normal + 1j * s.slot_force * ray))

    assert unbalanced(CANCELLED) < 1e-9
    assert unbalanced(COLUMNS["right sign"][0]) < 1e-9
    assert unbalanced(COLUMNS["as printed"][0]) > 2e3


@every("quantity", ["balancing_torque", "cam_force", "slot_force", "O", "A", "B", "guide"])
def test_exact_cancellation_equals_the_papers(quantity):
    ours, theirs = (np.array(components(s, quantity)) for s in (CANCELLED, COLUMNS["right sign"][0]))
    np.testing.assert_allclose(theirs, ours, rtol=0, atol=1e-13 * CIRCLE.largest_force_term)


def test_sign_changes_slot_force_and_its_effects():
    printed = COLUMNS["as printed"][0]
    for quantity in ("cam_force", "A", "B", "guide", "slider_acceleration"):
        np.testing.assert_allclose(components(printed, quantity), components(CANCELLED, quantity), rtol=1e-9, atol=1e-7)
    assert np.max(np.abs(printed.slot_force - CANCELLED.slot_force)) > 3e3


@pytest.mark.slow
def test_case_file_has_the_published_coefficients():
    table = CASE.comparison_table("cam-circle")
    rows = [f"torque extremum {number}" for number in range(1, 5)]
    assert list(table.loc[rows, "published"]) == [f"{value} (ratio)" for value in PUBLISHED["n_d"]]
    assert "cam-circle" in CASE.published.note
    assert "wrong sign" in CASE.published.note
    assert "coincidence" in CASE.published.note


def test_printed_method_is_studied_apart():
    assert papers.AS_PRINTED in METHODS
    assert papers.AS_PRINTED not in papers.METHODS
    assert "wrong sign" in papers.AS_PRINTED.name
    assert papers.AS_PRINTED.name not in ks.stability.METHOD_SETTINGS


@pytest.mark.parametrize("quantity", ["balancing_torque", "O"])
def test_printed_method_gives_the_printed_solution(quantity):
    found = papers.AS_PRINTED.prepare(CIRCLE, quantity, None)()
    np.testing.assert_array_equal(found, components(papers.as_printed(CIRCLE), quantity))
    found, right = np.asarray(found), np.asarray(components(CIRCLE, quantity))
    assert np.abs(found - right).max() == pytest.approx(0.3 * np.abs(right).max(), rel=0.02)


# Formulas as the studies print them


@pytest.mark.slow
@pytest.mark.parametrize("column", COLUMNS)
def test_coefficients_of_each_reading_of_the_study(column):
    s, extremum_ratios, mean_ratio, reaction_ratio, cam_force = COLUMNS[column]
    found = ks.compare(PLAIN, s)
    np.testing.assert_allclose(found.torque_extremum_ratios, extremum_ratios, rtol=0, atol=5.1e-4)
    assert found.mean_torque_ratio == pytest.approx(mean_ratio, abs=5.1e-4)
    assert found.peak_reaction_ratio("O") == pytest.approx(reaction_ratio, abs=5.1e-3)
    assert found.cam_force_range()[1][1] == pytest.approx(1e3 * cam_force, abs=5.1)


@pytest.mark.slow
def test_printed_extrema_lie_at_their_angles():
    found = ks.extremes(COLUMNS["as printed"][0], "balancing_torque")
    np.testing.assert_allclose(np.degrees(found.angle), [48, 137, 224, 311], atol=0.6)
    assert CIRCLE.at(np.zeros(1)).slider_position[0] == pytest.approx(ks.extremes(CIRCLE, "slider_position").largest)


@pytest.mark.slow
def test_published_figures_follow_the_printed_sign():
    def errors(s):
        found = ks.compare(PLAIN, s)
        pairs = zip(
            [*found.torque_extremum_ratios, found.mean_torque_ratio], [*PUBLISHED["n_d"], PUBLISHED["k_d"]], strict=True
        )
        return [abs(ratio / printed - 1) for ratio, printed in pairs]

    assert max(errors(COLUMNS["as printed"][0])) < 0.007
    assert ks.compare(PLAIN, COLUMNS["as printed"][0]).peak_reaction_ratio("O") == pytest.approx(
        PUBLISHED["O"], abs=0.5
    )
    for right in (CANCELLED, CIRCLE, COSINE):
        assert max(errors(right)[:4]) > 0.18


@pytest.mark.slow
@pytest.mark.parametrize("column", ["as printed", "right sign", "linear spring"])
def test_coupler_inertia_force_has_four_extrema(column):
    """The study counts three: its fourth lies at 0 = 360 degrees, on the edge of the chart."""
    found = ks.extremes(COLUMNS[column][0], lambda s: magnitude(s.inertia_force("coupler")))
    angles = (np.degrees(found.angle) + 1) % 360 - 1
    np.testing.assert_allclose(np.sort(angles), [0, 90.1, 180, 269.9], atol=0.05)
    np.testing.assert_allclose(found.range, [25.33e3, 53.86e3], atol=5.1)
