"""The chain unit as a case: its variants, what the command line prints and draws, and four-bars in case files."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.case_files import case_file, problems
from support.case_files import four_bar_table as table
from support.machines import assert_close

FIGURES = ("coupler_velocity", "coupler_acceleration", "rocker_velocity", "rocker_acceleration", "mechanism")
CURVES = [("coupler", 1, "w_AB", -1), ("coupler", 2, "e_AB", -1), ("rocker", 1, "w_h", 1), ("rocker", 2, "e_h", 1)]
"""Link, order of the derivative, column of the table, and its sign in the crank's sense of turning, clockwise."""
PRINTED = {
    "asymmetry |psi_min| / psi_max": ["0.904362", "(0.9)", "0.557784", "(0.56)", "0.755242"],
    "largest relative rocker speed": ["0.151009", "(0.151)", "1.14556", "(1.145)", "0.406945"],
    "amplitude ratio to rho-0.1": ["1", "6.88552", "(6.88)", "2.77431"],
    "speed ratio to rho-0.1": ["1", "7.58599", "(7.58)", "2.69483"],
}
REGIMES = {"r30-slow": (0.03, 31.4), "r30-fast": (0.03, 62.8), "r75-slow": (0.075, 31.4), "r75-fast": (0.075, 62.8)}
"""Crank, m, and speed, rad/s, of the regimes in the study's figure 2."""
FOUR_BAR = """
title = "test"
reference = "bar"
[variants.bar]
mechanism = "four-bar"
crank_speed = "60 rpm"
crank_length = "100 mm"
coupler_length = "400 mm"
rocker_length = "300 mm"
rocker_pivot = ["350 mm", "100 mm"]
assembly = -1
crank = { mass = "1 kg", centre = "mid-length", inertia = "0.01 kg m^2" }
rocker = { mass = "2 kg", centre = ["100 mm", "20 mm"], inertia = "0.05 kg m^2" }
gravity = {}
"""


@pytest.fixture(scope="module")
def case():
    return ks.load_case("chain_unit")


def test_chain_unit_case_balances_its_powers(case):
    assert list(case.variants) == ["rho-0.1", "rho-0.5", "free-start", *REGIMES, "r75-fast-chains"]
    assert case.reference == "rho-0.1"
    assert all(case.solve(name).power_residual < 1e-14 for name in case.variants)


@pytest.mark.parametrize(("name", "crank", "pivot_x"), [("rho-0.1", 0.03, None), ("free-start", 0.075, 0.28)])
def test_variant_equals_the_chain_unit_built_in_python(case, name, crank, pivot_x):
    """Uniform bars of 5 kg/m, their mass centres at mid-length."""
    lengths = {"crank": crank, "coupler": 0.3, "rocker": 0.2}
    links = {link: ks.Link(5 * length, length / 2, 5 * length**3 / 12) for link, length in lengths.items()}
    mechanism = ks.linkage.chain_unit(*lengths.values(), pivot_x=pivot_x, **links)
    found = case.solve(name, angles=90)
    by_hand = ks.solve(mechanism, found.crank_angle, crank_speed=-31.4, loads=ks.Gravity())
    assert_close(found.balancing_torque, by_hand.balancing_torque, 1e-4)
    assert_close(found.reaction("O2"), by_hand.reaction("O2"), 1e-4)
    assert_close(found.rate("rocker"), by_hand.rate("rocker"))


@pytest.mark.parametrize("name", REGIMES)
def test_regime_has_the_crank_and_speed_of_the_film(case, name):
    """Parallel start and uniform bars; twice the speed gives twice the rocker's and four times the shaking force."""
    crank, speed = REGIMES[name]
    lengths = {"crank": crank, "coupler": 0.3, "rocker": 0.2}
    links = {link: ks.Link(5 * length, length / 2, 5 * length**3 / 12) for link, length in lengths.items()}
    s = case.solve(name, angles=90)
    by_hand = ks.solve(ks.linkage.chain_unit(*lengths.values(), **links), s.crank_angle, crank_speed=-speed)
    assert_close(s.shaking_force, by_hand.shaking_force, 1e-4)
    assert_close(s.rate("rocker"), by_hand.rate("rocker"))
    slow = case.solve(name.replace("fast", "slow"), angles=90)
    assert_close(s.shaking_force * (31.4 / speed) ** 2, slow.shaking_force)


def test_chains_oppose_the_rocker_and_take_their_energy_from_the_shaft(case):
    """4 N m against the motion and 0.2 N m s, at each crank angle; idle the mean is 0."""
    turn = np.linspace(0.0, 2 * np.pi, 7200, endpoint=False)
    angle = ks.linkage.chain_unit_angle(turn)
    idle, grinding = (case.solve(name).at(angle) for name in ("r75-fast", "r75-fast-chains"))
    *_, rate = ks.papers.chain_unit_by_atan_acos(0.075, 0.3, 0.2, np.sqrt(0.09 - 0.075**2), turn)
    speed = np.abs(62.8 * rate)
    needed = 4.0 * speed + 0.2 * speed**2
    power = -62.8 * (grinding.balancing_torque - idle.balancing_torque)
    assert power == pytest.approx(needed, abs=1e-10 * needed.max())
    assert abs(np.mean(-62.8 * idle.balancing_torque)) < 1e-12 * needed.max()
    assert grinding.losses.drive == pytest.approx(np.mean(needed), rel=1e-6)


@pytest.mark.slow
def test_compare_prints_published_figures_in_brackets(capsys):
    assert main(["compare", "chain_unit"]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = {name: next(line for line in lines if line.startswith(name)) for name in PRINTED}
    assert {name: row.removeprefix(name).split() for name, row in rows.items()} == PRINTED
    assert sum(line.startswith("power balance") for line in lines) == 1


@pytest.mark.slow
def test_run_lists_reactions_and_rates_of_a_four_bar(capsys):
    assert main(["run", "chain_unit", "--variant", "free-start"]) == 0
    printed = capsys.readouterr().out
    for name in ("reaction O2 ", "coupler rate ", "rocker angular acceleration ", "power balance: "):
        assert f"\n{name}" in printed
    assert "guide" not in printed


@pytest.mark.slow
def test_plot_draws_study_figures_and_mechanism(tmp_path, capsys):
    assert main(["plot", "chain_unit", "--out", str(tmp_path), "--format", "svg"]) == 0
    written = {path.name for path in tmp_path.iterdir()}
    assert {f"chain_unit_{name}.svg" for name in FIGURES} <= written
    assert len(capsys.readouterr().out.splitlines()) == len(written)
    assert not {name for name in written if "cam" in name or "pressure" in name or "error" in name}


@pytest.mark.parametrize("rho", [0.1, 0.5])
@pytest.mark.parametrize(("link", "order", "column", "sign"), CURVES)
def test_curve_on_the_figure_equals_the_50_digit_table(case, axes, rho, link, order, column, sign):
    """Figures 5 to 12, each a link, an order and a rho; crank angle clockwise from +y."""
    solution = case.solve(f"rho-{rho}", angles=72)
    assert ks.plots.chain_unit_motion({f"rho-{rho}": solution}, link, order, ax=axes) is axes
    angle, values = axes.lines[0].get_data()
    expected = table(rho)
    apart = np.abs(angle - expected["angle_deg"][:, None])  # extremes of the curve are drawn too
    assert apart.min(axis=1).max() < 1e-12
    assert_close(values[apart.argmin(axis=1)], sign * expected[column], 1e-12)
    assert axes.get_xlabel() == "crank angle from +y, clockwise [deg]"
    assert axes.get_ylabel() == f"relative angular {'velocity' if order == 1 else 'acceleration'} of the {link} [1]"


def test_figure_counts_in_the_cranks_sense(axes):
    """The same position passed the other way has the same relative rate, and the opposite relative acceleration."""
    mechanism, angle = ks.linkage.chain_unit(0.5, 1.0, 2 / 3), np.radians(np.arange(0, 360, 5))
    for speed in (-1.0, 31.4):
        for order in (1, 2):
            ks.plots.chain_unit_motion(ks.solve(mechanism, angle, crank_speed=speed), "rocker", order, ax=axes)
    curves = [line.get_ydata() for line in axes.lines if len(line.get_xdata()) >= 72]
    assert_close(curves[2], curves[0])
    assert_close(curves[3], -curves[1])


# Four-bars in case files


def test_four_bar_case_equals_python(tmp_path):
    found = ks.load_case(case_file(tmp_path, FOUR_BAR)).solve("bar", angles=36)
    mechanism = ks.four_bar(
        0.1,
        0.4,
        0.3,
        rocker_pivot=(0.35, 0.1),
        assembly=-1,
        crank=ks.Link(1.0, 0.05, 0.01),
        rocker=ks.Link(2.0, (0.1, 0.02), 0.05),
    )
    by_hand = ks.solve(mechanism, found.crank_angle, crank_speed=2 * np.pi, loads=ks.Gravity())
    for joint in ("O", "A", "B", "O2"):
        assert_close(found.reaction(joint), by_hand.reaction(joint))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (('rocker_length = "300 mm"', ""), "variants.bar.rocker_length is missing"),
        (("rocker_length", "rocker_lenght"), "variants.bar.rocker_lenght is not a key here; did you mean 'rocker_len"),
        (('["350 mm", "100 mm"]', '"350 mm"'), "variants.bar.rocker_pivot must be a pair"),
        (('rocker_pivot = ["350 mm", "100 mm"]', ""), "variants.bar.rocker_pivot is missing"),
        (("rocker_pivot", "pivot_x"), "variants.bar.pivot_x is not a key here"),
        (("gravity", "guide_angle = '0 deg'\ngravity"), "variants.bar.guide_angle is not a key here"),
        (("gravity", "spring = {}\ngravity"), "variants.bar.spring is not a key here"),
        (("rocker = ", "slider = "), "variants.bar.slider is not a key here"),
        (("-1", "0"), "variants.bar.assembly"),
        (('"four-bar"', '"four-ba"'), "variants.bar.mechanism is 'four-ba', allowed: 'crank-slider', 'cam-crank-slid"),
    ],
)
def test_wrong_key_of_a_four_bar_is_named(tmp_path, change, words):
    assert any(line.startswith(words) for line in problems(tmp_path, FOUR_BAR.replace(*change)))


def test_open_linkage_is_reported_with_its_angles(tmp_path):
    """With a crank of 500 mm and a frame of 364 mm A comes farther from O2 than coupler and rocker reach together."""
    found = problems(tmp_path, FOUR_BAR.replace('"100 mm"\ncoupler', '"500 mm"\ncoupler'))
    assert len(found) == 1
    assert found[0].startswith("variants.bar: four-bar cannot be assembled")
    assert "between the difference and the sum of coupler and rocker lengths, 0.1 and 0.7 m" in found[0]
    closed = ks.linkage.grashof(ks.four_bar(0.5, 0.4, 0.3, rocker_pivot=(0.35, 0.1))).intervals
    ((closes, opens),) = np.degrees(closed)
    assert f"does not close for crank angles {opens - 360:.6g} .. {closes:.6g} deg" in found[0]


CHAIN_UNIT = """
title = "test"
reference = "unit"
[variants.unit]
mechanism = "chain-unit"
crank_speed = "1 rad/s"
crank_length = "100 mm"
coupler_length = "100 mm"
rocker_length = "200 mm"
"""


def test_parallel_start_without_room_needs_a_pivot(tmp_path):
    (found,) = problems(tmp_path, CHAIN_UNIT)
    assert found.startswith("variants.unit: chain unit: parallel start needs a coupler longer than the crank")
    assert "pivot_x" in found


def test_linkage_table_is_for_cases_of_four_bars_only():
    assert ks.load_case("sawframe_2r63").linkage_table() is None
