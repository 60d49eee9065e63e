"""Tables over the crank angle with a zero and a sense: indicator diagrams in degrees after top dead centre."""

import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import dead_centres
from support.every import every
from support.machines import largest
from support.mirror import mirrored

AFTER_TDC = np.radians([0.0, 15.0, 40.0, 90.0, 180.0, 270.0])
GAS = [-5e3, -9e3, -4e3, -1e3, 0.0, -1e3]
ANGLES = np.linspace(0.05, 6.2, 60)
MACHINES = {
    "upright": ks.crank_slider(0.05, 0.2, guide_angle=np.pi / 2, slider=ks.Link(1.0)),
    "offset": ks.crank_slider(0.05, 0.2, guide_angle=0.4, guide_offset=0.01, slider=ks.Link(1.0)),
    "guide towards the crank": ks.crank_slider(0.05, 0.2, guide_angle=0.4, assembly=-1, slider=ks.Link(1.0)),
    "yoke": ks.Mechanism("yoke", ks.Crank(0.05), (ks.YokeGroup(ks.Guide.at(0.7), slot_angle=1.2),)),
}


def scene(mechanism, zero="TDC", sense=1, speed=100.0, x=AFTER_TDC, **options):
    table = ks.Table(x, GAS, zero=zero, sense=sense, **options)
    return ks.Scene(mechanism, speed, loads=ks.ProcessForce(table))


def stops(mechanism):
    """Crank angles of the far and the near dead centre."""
    found = ks.extremes(ks.Scene(mechanism, 1.0).solve(8), "slider_position")
    by_size = sorted(zip(found.value * mechanism.place(0.0).travels["slider"].position, found.angle, strict=True))
    return {"TDC": by_size[-1][1], "BDC": by_size[0][1]}


@pytest.mark.slow
@every("name", [name for name in MACHINES if name != "yoke"])
@every("zero", ["TDC", "BDC"])
@every("sense", [1, -1])
def test_the_table_begins_at_the_dead_centre(name, zero, sense):
    machine, angle = MACHINES[name], stops(MACHINES[name])[zero]
    found = scene(machine, zero, sense, 100.0 * sense).solve(ANGLES)
    by_hand = np.interp(sense * (ANGLES - angle), AFTER_TDC, GAS, period=2 * np.pi)
    by_angle = scene(machine, angle, sense, 100.0 * sense).solve(ANGLES)
    assert largest(found.loads[0].value_now(found) - by_hand) < 1e-7 * 9e3  # an extreme is at 1e-9 rad
    assert largest(found.balancing_torque - by_angle.balancing_torque) < 1e-7 * largest(found.balancing_torque)


@every("offset", [0.0, 1e-15, -1e-15, 1e-3, -1e-3, 0.04])
@every("zero, guide_angle", [("TDC", 0.0), ("BDC", np.pi)])
def test_a_four_stroke_table_begins_in_the_turn_of_the_dead_centre_near_zero(zero, guide_angle, offset):
    machine = ks.crank_slider(0.05, 0.2, guide_angle=guide_angle, guide_offset=offset)
    s = scene(machine, zero, period=4 * np.pi, x=2.0 * AFTER_TDC).solve(8)
    (table,) = (load.value_now for load in s.loads)
    assert abs(table.of("slider").zero_angle(s)) < 0.3  # not a turn later
    assert (
        largest(table(s) - np.interp(s.crank_angle, 2.0 * AFTER_TDC, GAS, period=4 * np.pi)) < 2.5e3
    )  # not another peak


@every("zero", [0.3, "0.3 rad", f"{np.degrees(0.3)} deg", np.float64(0.3)])
@every("sense", [1, -1])
def test_an_angle_shifts_the_rows(zero, sense):
    table = ks.Table(AFTER_TDC, GAS, zero=zero, sense=sense)
    s = ks.solve(MACHINES["upright"], ANGLES, crank_speed=1.0, loads=ks.ProcessForce(table))
    by_hand = np.interp(sense * (ANGLES - 0.3), AFTER_TDC, GAS, period=2 * np.pi)
    assert largest(table(s) - by_hand) < 1e-11
    assert np.all(np.diff(table.x) > 0)


@every("name", MACHINES)
def test_the_recorded_program_agrees(name):
    assert_program_agrees(scene(MACHINES[name]), "numpy")


@pytest.mark.slow
def test_the_compiled_program_agrees():
    pytest.importorskip("numba")
    assert_program_agrees(scene(MACHINES["offset"]), None)


def assert_program_agrees(given, engine):
    program = ks.compile(given, ("balancing_torque", "O"), engine=engine)
    found, s = program(ANGLES), given.solve(ANGLES)
    assert largest(found["balancing_torque"] - s.balancing_torque) < 1e-12 * largest(s.balancing_torque)
    assert largest(found["O"] - s.reaction("O")) < 1e-12 * largest(s.reaction("O"))


@every("path", ["crank_length", "coupler_length", "guide_offset", "guide_angle"])
def test_the_zero_follows_the_lengths(path):
    """Exact derivatives against differences of scenes that were made anew."""
    given, step = scene(MACHINES["offset"]), 1e-6
    exact = ks.compile(given, "balancing_torque", engine="numpy").derivatives(ANGLES, path)["balancing_torque"][path]
    value = given.parameters[path]
    above, below = (given.varied({path: value + k * step}).solve(ANGLES).balancing_torque for k in (1, -1))
    assert largest(exact - (above - below) / (2 * step)) < 1e-7 * largest(exact)
    moved = given.varied({path: np.array([[value], [value + 0.01]])}).solve(ANGLES).balancing_torque
    alone = given.varied({path: value + 0.01}).solve(ANGLES).balancing_torque
    assert largest(moved[1] - alone) < 1e-13 * largest(alone)


@every("name", MACHINES)
@every("speed", [100.0, -100.0])
def test_a_mirrored_engine_has_mirrored_forces(name, speed):
    """The diagram runs after top dead centre in the sense of rotation."""
    given = scene(MACHINES[name], sense=int(np.sign(speed)), speed=speed)
    other = mirrored(given)
    one, two = given.solve(ANGLES), other.solve(-ANGLES)
    assert largest(two.balancing_torque + one.balancing_torque) < 1e-12 * largest(one.balancing_torque)
    assert largest(two.reaction("O") - one.reaction("O") * [[1.0], [-1.0]]) < 1e-12 * largest(one.reaction("O"))


def test_both_senses_of_rotation_do_the_same_work():
    def work(sense):
        return scene(MACHINES["upright"], sense=sense, speed=100.0 * sense).solve(36).energy_per_turn

    assert work(-1) == pytest.approx(work(1), rel=1e-13)
    assert abs(work(1)) > 10.0


def test_four_strokes_run_over_two_turns():
    x = np.radians([0.0, 15.0, 90.0, 180.0, 360.0, 540.0])
    given = scene(MACHINES["upright"], x=x, period=4 * np.pi)
    s = given.solve(ANGLES + 2 * np.pi)
    assert s.period == 4 * np.pi
    by_hand = np.interp(ANGLES + 1.5 * np.pi, x, GAS, period=4 * np.pi)
    assert largest(s.loads[0].value_now(s) - by_hand) < 1e-9


@every("name", ["upright", "offset"])
def test_extremes_know_the_kinks(name):
    """The axial force of a massless rod under gas alone is that of the table."""
    machine = MACHINES[name].with_link("slider", ks.Link())
    s = scene(machine).solve(8)
    found = ks.extremes(s, lambda at: at.loads[0].value_now(at))
    assert found.range == pytest.approx((-9e3, 0.0), rel=1e-12, abs=1e-9)
    peak = found.angle[np.argmin(found.value)]
    assert peak == pytest.approx((stops(machine)["TDC"] + np.radians(15.0)) % (2 * np.pi), abs=1e-8)
    kinks, jumps = s.loads[0].value_now.kinks(s)
    assert kinks.size == AFTER_TDC.size
    assert jumps.size == 0


def test_kinks_of_a_batch_shift_with_each_design():
    given = scene(MACHINES["offset"]).varied({"guide_angle": np.array([[0.1], [0.5]])})
    s = given.solve(ANGLES)
    angles, _, _ = s.loads[0].value_now.bends(s, 0.0)
    zero = dead_centres(s, "slider")[0][0]
    assert largest(np.exp(1j * (angles - zero)) - np.exp(1j * np.roll(AFTER_TDC, -1))) < 1e-12


@pytest.mark.slow
def test_a_sweep_moves_the_zero_with_the_guide():
    designs = ks.designs.grid({"guide_angle": "0..90 deg:4"})
    found = ks.sweep(scene(MACHINES["upright"]), designs, ["largest balancing_torque"], progress=False)
    torques = found["largest balancing_torque [N m]"]
    assert np.ptp(torques) < 1e-9 * torques.max()


def test_bounds_cover_the_shift():
    """In line, top dead centre is the angle of the guide: the same table by that angle."""
    rows = np.pi / 2 + AFTER_TDC + 2 * np.pi * np.array([[-3], [0], [7]])
    angles = np.concatenate([ANGLES, *(np.ravel(rows + off) for off in (0.0, 1e-15, -1e-15, 1e-13, -4e-13))])
    one, two = (scene(MACHINES["upright"], zero).solve(angles) for zero in ("TDC", np.pi / 2))
    off = np.abs(one.balancing_torque - two.balancing_torque)
    assert np.all(off <= one.error_bound("balancing_torque") + two.error_bound("balancing_torque"))
    within = one.at(ANGLES)
    assert largest(within.error_bound("balancing_torque", tight=True)) < 1e-13 * largest(within.balancing_torque)


BANKS = ks.SliderGroup(0.2), ks.SliderGroup(0.2, ks.Guide.at(1.5), pin="C", label="2")
V_TWIN = ks.Mechanism("V", ks.Crank(0.05), BANKS)
FOUR_BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
SHORT = ks.crank_slider(0.05, 0.04, guide_offset=0.02)
TABLE = ks.Table(AFTER_TDC, GAS, zero="TDC")


def test_each_slider_has_its_own_dead_centre():
    loads = [ks.ProcessForce(TABLE, "slider"), ks.ProcessForce(TABLE, "slider2")]
    s = ks.solve(V_TWIN, ANGLES, crank_speed=1.0, loads=loads)
    one, two = (item.value_now(s) for item in s.loads)
    assert largest(one - np.interp(ANGLES, AFTER_TDC, GAS, period=2 * np.pi)) < 1e-9
    assert largest(two - np.interp(ANGLES - 1.5, AFTER_TDC, GAS, period=2 * np.pi)) < 1e-9


@every(
    "mechanism, load, message",
    [
        (FOUR_BAR, ks.Force(TABLE, at="B"), "table from its TDC: the mechanism has no slider"),
        (V_TWIN, ks.Torque(TABLE, on="crank"), "has sliders 'slider', 'slider2': choose one, slider="),
        (V_TWIN, ks.Torque(ks.Table(AFTER_TDC, GAS, zero="TDC", slider="ram"), on="crank"), "'ram'"),
        (SHORT, ks.ProcessForce(TABLE), "crank-slider does not close at all crank angles, so 'slider' has no TDC"),
        (
            ks.cam_crank_slider(ks.cams.Harmonic((0.3, 0.0, 0.0, 0.25)), 2.0),
            ks.ProcessForce(TABLE),
            "needs a slider that goes to and fro",
        ),
    ],
)
def test_a_dead_centre_that_is_not_there_is_refused(mechanism, load, message):
    with pytest.raises(ks.ParameterError, match=message):
        _ = ks.Scene(mechanism, 1.0, loads=load).solve(0.1).balancing_torque


@every(
    "options, message",
    [
        ({"zero": "top"}, "zero must be text of a number and a unit.*\"90 deg\"; or write 'TDC' or 'BDC'"),
        ({"zero": "3 mm"}, "zero .*does not measure the same as"),
        ({"zero": np.array([[0.1], [0.2]])}, "zero must be one angle, not an array"),
        ({"zero": float("nan")}, "zero must be finite"),
        ({"sense": 0}, r"sense must be \+1 or -1, got 0"),
        ({"slider": "slider"}, 'slider is for a table over="travel", or one with zero="TDC" or "BDC"'),
        ({"over": "travel", "zero": "TDC"}, 'zero is for a table over="angle"'),
        ({"over": "travel", "sense": -1}, 'sense is for a table over="angle"'),
    ],
)
def test_what_is_no_zero_or_sense_is_refused(options, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.Table(AFTER_TDC, GAS, **options)


# Hints


@every(
    "options, speed, message",
    [
        ({}, 100.0, "-9000 N at 15 deg, is 75 deg from the dead centres of 'slider', TDC at 90 deg.*zero=\"TDC\""),
        ({"zero": 0.0}, 100.0, None),
        ({"zero": "TDC"}, 100.0, None),
        ({"zero": "BDC"}, 100.0, None),
        ({"zero": "TDC", "sense": -1}, -100.0, None),
        ({"zero": "TDC"}, -100.0, r"sense=\+1, but the crank turns at -100 rad/s, so it is read backwards.*sense=-1"),
        ({"zero": "TDC", "sense": -1}, 100.0, "read backwards"),
    ],
)
def test_a_peak_far_from_the_dead_centres_gives_a_hint(options, speed, message):
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        ks.solve(
            MACHINES["upright"], 1.0, crank_speed=speed, loads=ks.ProcessForce(ks.Table(AFTER_TDC, GAS, **options))
        )
    texts = [str(one.message) for one in given]
    assert len(texts) == (message is not None)
    if message is not None:
        with pytest.warns(ks.HintWarning, match=message):
            warnings.warn(given[0].message, stacklevel=1)


@every("angle", [0.0, np.pi, np.radians(15.0), np.radians(-40.0)])
def test_a_peak_near_a_dead_centre_gives_no_hint(angle):
    table = ks.Table(AFTER_TDC, GAS)
    machine = ks.crank_slider(0.05, 0.2, guide_angle=angle)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ks.solve(machine, 1.0, crank_speed=10.0, loads=ks.ProcessForce(table))


def test_the_follower_of_a_cam_gives_no_hint():
    follower = ks.RollerFollower(ks.laws.cosine(0.01, 0.05), ks.Guide.at(np.pi / 2), ks.Link(2.0))
    pulse = ks.ProcessForce(ks.Table([0.0, 1.4, 1.5, 1.6, 4.0], [0.0, 0.0, 500.0, 0.0, 0.0]), on="follower")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ks.solve(ks.Mechanism("cam", ks.Crank(None), (follower,)), 1.0, crank_speed=10.0, loads=pulse)


def test_a_hint_has_round_dead_centres():
    table = ks.Table(AFTER_TDC + np.pi / 2, GAS)
    with pytest.warns(ks.HintWarning, match="TDC at 180 deg and BDC at 0 deg"):
        ks.solve(ks.crank_slider(0.05, 0.2, guide_angle=np.pi), 1.0, crank_speed=10.0, loads=ks.ProcessForce(table))


def test_in_a_batch_one_design_suffices_for_a_hint():
    machine = MACHINES["upright"]
    batch = ks.Scene(machine, 1.0, loads=ks.ProcessForce(ks.Table(AFTER_TDC, GAS)))
    with pytest.warns(ks.HintWarning, match="is 75 deg from"):
        batch.varied({"guide_angle": np.array([[0.0], [np.pi / 2]])}).solve(8)
