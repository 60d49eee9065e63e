"""Extremes beside gaps and limit positions, and results that have lost digits."""

import re
import warnings
from functools import cache

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cycle.comparison import mean_absolute_torque
from kinetostatics.cycle.extremes import extremes_frame
from kinetostatics.mechanics import assembly, quantities
from support.every import every

GRAVITY = (ks.Gravity(),)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def four_bar(crank, coupler, rocker, frame, turn=0.0):
    pivot = frame * np.cos(turn), frame * np.sin(turn)
    links = {"coupler": ks.Link(3.0, coupler / 2, 2.0), "rocker": ks.Link(2.0, rocker / 2, 1.0)}
    return ks.four_bar(crank, coupler, rocker, rocker_pivot=pivot, **links)


def at_rest(mechanism, loads=GRAVITY, speed=5.0):
    return ks.solve(mechanism, [1.0], crank_speed=speed, loads=loads, on_gap="nan")


def silently(function, *arguments):
    """What a function returns, and what it warned of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = function(*arguments)
    return found, " ".join(str(item.message) for item in caught)


# Change points: lengths, frame, turn of the frame, and the crank angles at which it passes them, from the frame, deg

CHANGE_POINTS = {
    "4/1/3/2": ((1.0, 3.0, 2.0, 4.0), (180,)),
    "parallelogram": ((1.0, 2.0, 1.0, 2.0), (0, 180)),
    "kite": ((2.0, 2.0, 1.0, 1.0), (0, 180)),
    "rhombus": ((1.0, 1.0, 1.0, 1.0), (0, 180)),
    "deltoid": ((1.0, 2.0, 2.0, 1.0), (0,)),
}
each_change_point = pytest.mark.parametrize("name", CHANGE_POINTS)


@cache
def passing(name, turn=0.0):
    """The linkage of a name, whose pieces of a turn all tests share."""
    return at_rest(four_bar(*CHANGE_POINTS[name][0], np.radians(turn)))


def usable_samples(solution, quantity, limits):
    """Values at five thousand angles, all at least two thousandths from the limits."""
    angle = np.linspace(0.0, 2 * np.pi, 5_001)[:-1] + 1e-5
    away = np.min(np.abs(np.angle(np.exp(1j * (angle[:, None] - np.radians(limits))))), axis=1) > 2e-3
    return quantities.values(solution.at(angle[away]), quantity)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "turn"), [*((name, 0.0) for name in CHANGE_POINTS), ("4/1/3/2", 30.0), ("kite", 200.0)]
)
def test_extremes_beside_change_points_equal_samples(name, turn):
    solution, (_, places) = passing(name, turn), CHANGE_POINTS[name]
    limits = [(place + turn) % 360 for place in places]
    for quantity in ("balancing_torque", "rocker_rate", "shaking_force"):
        found, said = silently(ks.extremes, solution, quantity)
        assert "no value has a correct digit" in said
        assert all(f"{limit:g}" in said for limit in limits)
        samples = usable_samples(solution, quantity, limits)
        size = np.ptp(samples)
        assert found.range[0] == pytest.approx(samples.min(), abs=2e-2 * size)
        assert found.range[1] == pytest.approx(samples.max(), abs=2e-2 * size)
        assert sorted(np.degrees(found.left_out)) == pytest.approx(sorted(limits), abs=1e-4)


@each_change_point
def test_growing_reactions_are_infinite_and_warned(name):
    found, said = silently(ks.extremes, passing(name), "B")
    assert found.range[1] == np.inf
    assert "B grows without bound at" in said


@each_change_point
def test_mean_torque_beside_change_points_is_right(name):
    solution, (_, limits) = passing(name), CHANGE_POINTS[name]
    found, said = silently(mean_absolute_torque, solution)
    assert "no value has a correct digit" in said
    assert found == pytest.approx(np.abs(usable_samples(solution, "balancing_torque", limits)).mean(), rel=1e-2)


@pytest.mark.slow
def test_extremes_table_says_once_what_is_left_out():
    _, said = silently(extremes_frame, passing("kite"))
    assert said.count("no value has a correct digit") == 1
    assert "B grows without bound" in said


@pytest.mark.slow
def test_comparisons_name_change_points():
    solution = at_rest(four_bar(*CHANGE_POINTS["kite"][0]))
    compared = ks.compare(at_rest(SAW), solution)
    for way in (lambda: compared.torque_extremum_ratios, lambda: compared.peak_reaction_ratio("B")):
        _, said = silently(way)
        assert "no value has a correct digit" in said


@each_change_point
@pytest.mark.filterwarnings("ignore:.*near a limit position:kinetostatics.errors.ConditionWarning")
def test_tables_name_rows_without_a_digit(name):
    lengths, limits = CHANGE_POINTS[name]
    exactly = ks.solve(four_bar(*lengths), np.radians(limits), crank_speed=5.0, loads=GRAVITY, on_gap="nan")
    _, said = silently(exactly.frame)
    assert f"no correct digit in {len(limits)} of {len(limits)} rows" in said


@each_change_point
@pytest.mark.parametrize("angles", [36, 37, 360])
def test_sweeps_name_change_points_as_reason(name, angles):
    (crank, coupler, rocker, frame), limits = CHANGE_POINTS[name]

    def made(coupler):
        return ks.Scene(four_bar(crank, coupler, rocker, frame), 5.0, 0.0, GRAVITY)

    table = swept(made, {"coupler": [coupler, 1.2 * coupler]}, ["largest_absolute balancing_torque"], angles=angles)
    assert table["failed"][0].startswith("has no correct digit at crank angle")
    assert any(f"{limit:g} deg" in table["failed"][0] for limit in limits)
    assert np.isnan(table.iloc[0, 1])


def test_the_torque_of_the_four_bar_4132_is_right():
    found, _ = silently(ks.extremes, at_rest(four_bar(1.0, 3.0, 2.0, 4.0)), "balancing_torque")
    assert found.largest == pytest.approx(-48.5546, abs=1e-3)


def test_positions_at_change_points_are_right():
    found, said = silently(ks.extremes, at_rest(ks.crank_slider(1.0, 1.0)), "slider_position")
    assert found.range == pytest.approx((0.0, 2.0), abs=2e-8)
    assert not said


# Gaps


def swept(function, designs, outputs, **options):
    return ks.sweep(function, pd.DataFrame(designs), outputs, progress=False, **options)


@pytest.mark.slow
@every("coupler, guide", [(0.5, 0.0), (0.99, 77.0), (0.9999999, 0.1)])
def test_extremes_reach_the_ends_of_closed_intervals(coupler, guide):
    """Under the ends the slider stands at the foot of the crank pin, where its velocity grows without bound."""
    mechanism = ks.crank_slider(1.0, coupler, guide_angle=np.radians(guide), slider=ks.Link(1.0))
    solution = at_rest(mechanism, (), 30.0)
    position, said = silently(ks.extremes, solution, "slider_position")
    assert not said
    assert position.range == pytest.approx((-np.sqrt(1 - coupler**2), 1 + coupler), abs=1e-9)
    end = np.degrees(np.arcsin(coupler))
    for quantity in ("slider_velocity", "balancing_torque"):
        found, said = silently(ks.extremes, solution, quantity)
        assert found.range == (-np.inf, np.inf)
        assert f"{quantity} grows without bound at" in said
        apart = np.abs(np.degrees(np.angle(np.exp(1j * (found.angle - np.radians(guide + end))))))
        assert apart.min() < 1e-6


@pytest.mark.parametrize("coupler", [0.8, 0.9999999])
def test_means_over_gaps_are_refused(coupler):
    solution = at_rest(ks.crank_slider(1.0, coupler, slider=ks.Link(1.0)), ())
    half = np.degrees(np.arccos(coupler))
    with pytest.raises(ks.ParameterError, match=f"does not close for crank angles {90 - half:.6g} .. {90 + half:.6g}"):
        mean_absolute_torque(solution)


HIDDEN = {
    "slider": (lambda short: ks.crank_slider(1.0, 1.0 - short, guide_angle=np.radians(0.1), slider=ks.Link(1.0)), 90.1),
    "offset": (lambda short: ks.crank_slider(1.0, 1.5 - short, guide_offset=0.5, slider=ks.Link(1.0)), 270.0),
    "far four-bar": (lambda short: four_bar(1.0, 2.0 - short, 1.5, 2.5, 0.7), np.degrees(0.7) + 180),
    "near four-bar": (lambda short: four_bar(1.0, 1.5 - short, 3.0, 2.5, 0.703), np.degrees(0.703)),
}


@pytest.mark.slow
@every("short", [1e-5, 1e-7, 1e-9])
@every("name", HIDDEN)
def test_gaps_between_samples_are_found(name, short):
    make, place = HIDDEN[name]
    with pytest.raises(ks.AssemblyError, match="cannot be assembled all round the turn") as caught:
        assembly.require_turn(make(short))
    assert any(start <= np.radians(place) <= stop for start, stop in caught.value.intervals)
    assembly.require_turn(make(-short))
    table = swept(
        lambda short: ks.Scene(make(short), 5.0, 0.0, ()), {"short": [short, -0.1]}, ["range balancing_torque"]
    )
    assert "cannot be assembled" in table["failed"][0]
    told = re.search(r"between the crank angles, at ([\d.]+) deg", table["failed"][0])
    assert (
        float(told[1]) % 180 == pytest.approx(place % 180, abs=1e-3)
        if told
        else " of 360 crank angles" in table["failed"][0]
    )
    assert table["failed"][1] == ""


@pytest.mark.slow_start
def test_case_with_a_narrow_gap_is_refused(tmp_path):
    file = tmp_path / "narrow.toml"
    file.write_text(
        'title = "narrow"\nsource = "assumed"\nreference = "a"\n[variants.a]\nmechanism = "crank-slider"\n'
        'crank_length = "1 m"\ncoupler_length = "0.9999999 m"\nguide_angle = "0.1 deg"\ncrank_speed = "30 rad/s"\n'
        'slider = {mass = "1 kg"}\n'
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ks.ConditionWarning)
        with pytest.raises(
            ks.CaseError, match=r"variants.a: .* does not close for crank angles 90.0744 .. 90.1256 deg"
        ):
            ks.load_case(file)


# Loads that are functions

WRONG = {
    "None": (lambda motion: None, "got None"),
    "a function without return": (lambda motion: print(end=""), "got None"),
    "three values": (lambda motion: np.zeros(3), r"got shape \(3,\)"),
    "a column": (lambda motion: motion.crank_angle[:, None], r"got shape \(\d+, 1\)"),
    "both components": (lambda motion: motion.velocity("B"), r"got shape \(2, \d+\)"),
    "text": (lambda motion: "100 N", "must return its force in N"),
    "truth": (lambda motion: motion.crank_angle > 1, "must return its force in N"),
    "a dict": (lambda motion: {"force": 1.0}, "must return its force in N"),
    "complex": (lambda motion: np.exp(1j * motion.crank_angle), "must return its force in N"),
    "NaN": (lambda motion: motion.crank_angle * np.nan, "finite forces, got nan"),
    "NaN at places": (lambda motion: np.where(motion.slider_velocity > 0, np.nan, 1.0), "finite forces, got nan"),
    "a list with None": (lambda motion: [None] * motion.crank_angle.size, "must return"),
    "infinity": (lambda motion: np.full(motion.crank_angle.shape, np.inf), "finite forces, got inf"),
    "division by zero": (lambda motion: 1e3 / np.zeros(motion.crank_angle.shape), "finite forces, got inf"),
}
ways = {
    "solve": lambda s: s.balancing_torque,
    "extremes": lambda s: ks.extremes(s, "O"),
    "mean": mean_absolute_torque,
    "table": lambda s: s.frame(),
}


@pytest.mark.slow
@every("way", ways)
@every("name", WRONG)
def test_what_is_no_force_is_refused_by_name(name, way):
    function, message = WRONG[name]
    solution = ks.solve(SAW, np.linspace(0, 6, 24), crank_speed=33.5, loads=[ks.ProcessForce(function)])
    with np.errstate(all="ignore"), pytest.raises(ks.ParameterError, match=f"ProcessForce on 'slider'.*{message}"):
        ways[way](solution)


def test_a_torque_is_told_as_a_torque():
    solution = ks.solve(SAW, [0.1, 0.2], crank_speed=1.0, loads=ks.Torque(lambda motion: np.ones(7), on="coupler"))
    with pytest.raises(ks.ParameterError, match=r"Torque on 'coupler': its function must return .*torque"):
        _ = solution.balancing_torque


@pytest.mark.slow
@every("name", WRONG)
def test_sweeps_give_what_is_no_force_as_the_reason(name):
    function, _ = WRONG[name]
    made = lambda mass: ks.Scene(SAW, 33.5, 0.0, (ks.ProcessForce(function),))  # noqa: E731
    with np.errstate(all="ignore"):
        table = swept(made, {"mass": [1.0, 2.0]}, ["rms O"], angles=36)
    assert table["failed"].str.contains("ProcessForce on 'slider'").all()
    assert table.iloc[:, 1].isna().all()


def test_nan_is_no_gap():
    load = ks.ProcessForce(lambda motion: np.sqrt(motion.slider_velocity))
    solution = ks.solve(SAW, np.linspace(0, 6, 24), crank_speed=33.5, loads=[load], on_gap="nan")
    with np.errstate(all="ignore"), pytest.raises(ks.ParameterError, match=r"got nan at \d+ crank angles, the first"):
        solution.frame()


def test_nan_in_a_gap_is_none_of_the_loads():
    mechanism = ks.crank_slider(1.0, 0.8, slider=ks.Link(1.0))
    load = ks.ProcessForce(lambda motion: -3.0 * motion.slider_velocity)
    solution = ks.solve(mechanism, np.linspace(0, 6, 24), crank_speed=1.0, loads=[load], on_gap="nan")
    assert 0 < np.isnan(solution.balancing_torque).sum() < 24


REPEATING = {
    2: lambda motion: 1e4 * np.cos(motion.crank_angle / 2),
    3: lambda motion: 1e4 * np.cos(motion.crank_angle / 3),
    4: lambda motion: 1e4 * np.sin(motion.crank_angle / 4),
}


@pytest.mark.parametrize("turns", REPEATING)
def test_load_of_several_turns_names_its_period(turns):
    solution = at_rest(SAW, [ks.ProcessForce(REPEATING[turns])], 33.5)
    for way in (lambda: ks.extremes(solution, "O"), lambda: mean_absolute_torque(solution)):
        with pytest.raises(ks.ParameterError, match=rf"repeats only after {turns} turns: give period={2 * turns}\*pi"):
            way()
    with pytest.raises(ks.ParameterError, match=rf"give period={2 * turns}\*pi"):
        swept(lambda mass: ks.Scene(SAW, 33.5, 0.0, solution.loads), {"mass": [1.0]}, ["rms O"])


@pytest.mark.slow
@pytest.mark.parametrize("turns", REPEATING)
def test_extremes_means_and_sweeps_run_over_the_period(turns):
    load = ks.ProcessForce(REPEATING[turns], period=2 * np.pi * turns)
    solution = at_rest(SAW, [load], 33.5)
    assert solution.period == pytest.approx(2 * np.pi * turns)
    fine = np.linspace(0.0, solution.period, 40_001)[:-1]
    torque = solution.at(fine).balancing_torque
    found = ks.extremes(solution, "balancing_torque")
    assert found.range == pytest.approx((torque.min(), torque.max()), rel=1e-7)
    assert found.angle.max() > 2 * np.pi * (turns - 1)
    assert mean_absolute_torque(solution) == pytest.approx(np.abs(torque).mean(), rel=1e-7)
    outputs = ["largest balancing_torque", "largest_at balancing_torque", "harmonic_1 balancing_torque"]
    row = swept(lambda mass: ks.Scene(SAW, 33.5, 0.0, (load,)), {"mass": [1.0]}, outputs, angles=720).iloc[0]
    assert row.iloc[1] == pytest.approx(torque.max(), rel=1e-5)
    assert row.iloc[2] == pytest.approx(fine[torque.argmax()], abs=1e-3)
    assert row.iloc[3] == pytest.approx(2 * abs(np.mean(torque * np.exp(-1j * fine))), rel=1e-6)


def test_a_load_that_never_repeats_is_refused():
    solution = at_rest(SAW, [ks.ProcessForce(lambda motion: 1e3 * motion.crank_angle)], 33.5)
    with pytest.raises(ks.ParameterError, match="must repeat after its period of 1 turns"):
        ks.extremes(solution, "O")


# Narrow pulses and peaks


@pytest.mark.parametrize("half_width", [1.0, 0.3, 0.1, 0.03])
def test_mean_torque_sees_narrow_pulses(half_width):
    width = np.radians(half_width)

    def pulse(motion):
        return np.where(np.abs(np.mod(motion.crank_angle, 2 * np.pi) - 1.0) < width, 1e6, 0.0)

    solution = at_rest(ks.crank_slider(0.3, 2.0), [ks.ProcessForce(pulse)])
    inside = np.linspace(1.0 - width, 1.0 + width, 2001)
    expected = np.abs(solution.at((inside[1:] + inside[:-1]) / 2).balancing_torque).mean() * width / np.pi
    assert mean_absolute_torque(solution) == pytest.approx(expected, rel=1e-9)


@pytest.mark.slow
def test_unconverged_mean_says_its_accuracy():
    wild = ks.ProcessForce(lambda motion: 1e4 * np.sin(1e7 * np.sin(motion.crank_angle)))
    _, said = silently(mean_absolute_torque, at_rest(SAW, [wild]))
    assert "mean torque: it is accurate only to" in said


@pytest.mark.slow
def test_a_noisy_table_is_compared_in_bounded_time():
    rows = np.linspace(0.0, 2 * np.pi, 3600, endpoint=False)
    force = 1e4 * np.random.default_rng(0).normal(size=rows.size)
    noisy = ks.ProcessForce(lambda motion: np.interp(motion.crank_angle, rows, force, period=2 * np.pi))
    solution = at_rest(SAW, [noisy], 33.5)
    fine = (np.arange(36_000) + 0.5) * (2 * np.pi / 36_000)
    assert mean_absolute_torque(solution) == pytest.approx(np.abs(solution.at(fine).balancing_torque).mean(), rel=1e-3)
    corner = np.abs(solution.at(rows).balancing_torque).max()
    assert abs(ks.extremes(solution, "balancing_torque").largest) == pytest.approx(corner, rel=1e-4)


SHARP = (0.283648, 0.616619, 0.657347), (0.345486, -0.001611)


@pytest.mark.slow
@every("angles", [12, 37, 180, 720])
def test_sweeps_take_as_many_angles_as_peaks_need(angles):
    lengths, pivot = SHARP

    def made(mass):
        links = {"coupler": ks.Link(mass, 0.3, 0.1), "rocker": ks.Link(2.0, 0.3, 0.1)}
        return ks.Scene(ks.four_bar(*lengths, rocker_pivot=pivot, **links), 10.0, 0.0, GRAVITY)

    outputs = ["largest O", "smallest O2", "largest_absolute balancing_torque", "mean_absolute balancing_torque"]
    row = swept(made, {"mass": [3.0]}, outputs, angles=angles).iloc[0]
    solution = at_rest(made(3.0).mechanism, GRAVITY, 10.0)
    assert row["failed"] == ""
    assert row.iloc[1] == pytest.approx(ks.extremes(solution, "O").range[1], rel=1e-3)
    assert row.iloc[2] == pytest.approx(ks.extremes(solution, "O2").range[0], rel=1e-3)
    assert row.iloc[3] == pytest.approx(abs(ks.extremes(solution, "balancing_torque").largest), rel=1e-3)
    assert row.iloc[4] == pytest.approx(mean_absolute_torque(solution), rel=1e-2)


@pytest.mark.parametrize("angles", [1, 2, 3, 11])
def test_sweeps_of_too_few_angles_are_refused(angles):
    with pytest.raises(ks.ParameterError, match=f"angles must be at least 12, got {angles}"):
        swept(lambda mass: ks.Scene(SAW, 33.5, 0.0, ()), {"mass": [1.0]}, ["rms O"], angles=angles)


def test_a_peak_too_narrow_gives_no_number():
    made = lambda short: ks.Scene(ks.crank_slider(1.0, 1.0 + short, slider=ks.Link(1.0)), 30.0, 0.0, ())  # noqa: E731
    table = swept(made, {"short": [1e-9, 0.2]}, ["largest O"])
    assert "passes close to a limit position" in table["failed"][0] or "no correct digit" in table["failed"][0]
    assert np.isnan(table.iloc[0, 1])
    assert table["failed"][1] == ""


def test_never_closing_mechanism_has_no_extremes():
    found, said = silently(ks.extremes, at_rest(ks.crank_slider(1.0, 0.5, guide_offset=3.0)), "balancing_torque")
    assert len(found) == 0
    assert np.isnan(found.range).all()
    assert "balancing_torque has no value: it does not close for crank angles 0 .. 360 deg" in said


def test_period_is_common_to_all_loads():
    loads = [ks.ProcessForce(0.0, period=2 * np.pi * turns) for turns in (1, 2, 3)]
    assert at_rest(SAW, loads[:2]).period == pytest.approx(4 * np.pi)
    assert at_rest(SAW, loads).period == pytest.approx(12 * np.pi)
    assert at_rest(SAW, [ks.Spring(1.0, 0.0), ks.Gravity()]).period == pytest.approx(2 * np.pi)
    assert ks.Scene(SAW, 5.0, 0.0, tuple(loads[:2])).solve(8).crank_angle[-1] == pytest.approx(3.5 * np.pi)


# Mechanisms at and beside every place where digits vanish

BODY = ks.Link(3.0, 0.5, 2.0)
ROD = ks.Link(2.0, 0.5, 1.0)
FOLDING = {
    "rhombus": ((1, 1, 1, 1), (0.0, np.pi)),
    "kite, frame as crank": ((1, 2, 2, 1), (0.0,)),
    "kite, coupler as crank": ((1, 1, 2, 2), (np.pi,)),
    "kite, rocker as crank": ((2, 1, 2, 1), (0.0, np.pi)),
    "parallelogram": ((1, 2, 1, 2), (0.0, np.pi)),
    "crank and frame the extremes": ((1, 3, 2, 4), (np.pi,)),
    "frame shortest": ((3, 4, 2, 1), (0.0,)),
    "rocker shortest": ((2, 4, 1, 3), (np.pi,)),
    "coupler shortest": ((3, 1, 2, 4), (0.0,)),
}
DISTANCES = (0.0, 1e-8, 1e-5)


def cases():
    """A mechanism, and a crank angle at which less than four digits are left."""
    for name, ((crank, coupler, rocker, frame), angles) in FOLDING.items():
        for side in (1, -1):
            pivot = {"rocker_pivot": (float(frame), 0.0), "assembly": side}
            mechanism = ks.four_bar(float(crank), coupler, rocker, **pivot, coupler=BODY, rocker=ROD)
            for angle in angles:
                yield from ((f"{name} {side} {angle:.2g}", mechanism, angle, distance) for distance in DISTANCES)
    for tilt in (0.0, 0.7, -2.1):
        for side in (1, -1):
            guide = {"guide_angle": tilt, "assembly": side, "slider": ROD}
            mechanism = ks.crank_slider(0.3, 0.3, coupler=BODY, **guide)
            name = f"coupler as crank, tilt {tilt} {side}"
            yield from ((name, mechanism, np.pi / 2 + tilt, distance) for distance in DISTANCES)


CASES = list(cases())


@pytest.mark.slow
@every(
    ("mechanism", "angle", "distance"), [case[1:] for case in CASES], ids=[f"{case[0]} {case[3]:g}" for case in CASES]
)
def test_lost_digits_are_warned_of_with_their_number(mechanism, angle, distance):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ks.solve(mechanism, [angle + distance], crank_speed=5.0, loads=ks.Gravity())
    (text,) = (str(item.message) for item in caught if item.category is ks.ConditionWarning)
    assert int(re.search(r"about (\d+) correct digits", text)[1]) < 4
    assert "at crank angle" in text
