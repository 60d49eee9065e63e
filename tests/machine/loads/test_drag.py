"""Torques that oppose the motion: Coulomb drag of constant magnitude."""

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.mechanics import quantities
from kinetostatics.studies.methods.global_system import newton
from support import mirror
from support.case_files import case_file
from support.every import every
from support.machines import largest

TURN = np.linspace(0.05, 0.05 + 2 * np.pi, 72, endpoint=False)
BODY = ks.Link(2.0, (0.07, -0.03), 0.04)
BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), coupler=BODY, rocker=BODY)
ARM = ks.Mechanism("arm", ks.Crank(0.3, ks.Link(3.0, (0.2, 0.0), 0.1)), ())


def drag(value=50.0, **pair):
    return ks.Torque(value, opposing=True, **({"on": "rocker"} | pair))


def scene(*loads, speed=10.0, mechanism=BAR, **more):
    return ks.Scene(mechanism, speed, loads=loads or [drag()], **more)


PAIRS = (
    {"on": "rocker"},
    {"on": "crank"},
    {"on": "coupler", "against": "rocker"},
    {"on": "coupler", "against": "crank"},
)


@every("pair", PAIRS)
@every("speed", (10.0, -10.0))
def test_it_takes_its_magnitude_times_the_relative_speed(pair, speed):
    s = scene(drag(**pair), speed=speed, mechanism=ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))).solve(TURN)
    relative = s.rate(pair["on"]) - (s.rate(pair["against"]) if "against" in pair else 0.0)
    np.testing.assert_allclose(s.balancing_torque * speed, 50.0 * np.abs(relative), rtol=1e-12)
    assert s.power_residual < 1e-13


@every("speed", (10.0, -10.0))
def test_loss_over_a_turn_is_twice_the_swing(speed):
    """Energy of a turn: 50 N m over the angle of the rocker to and fro, by its extreme directions."""
    s = scene(speed=speed).solve(7)
    arm, reach = 0.3, np.hypot(0.35, 0.1)
    ends = [np.arccos((reach**2 + arm**2 - far**2) / (2 * reach * arm)) for far in (0.3, 0.5)]
    expected = 50.0 * 2.0 * abs(ends[1] - ends[0]) * abs(speed) / (2 * np.pi)
    assert s.losses.lost == pytest.approx({"Torque on 'rocker'": expected}, rel=1e-12)
    assert s.losses.drive == pytest.approx(expected, rel=1e-10)
    assert s.efficiency == 0.0


@pytest.mark.slow
@every("speed", (10.0, -10.0))
@every("name", ("O", "A", "B", "balancing_torque"))
def test_reactions_by_the_constraint_equations_of_all_bodies(speed, name):
    s = scene(ks.Gravity(), drag(), drag(4.0, on="coupler", against="crank"), speed=speed).solve(TURN)
    (method,) = newton.NEWTON_METHODS
    exact = np.array(quantities.components(s, name))
    np.testing.assert_allclose(method.prepare(s, name, method.settings[-1])(), exact, atol=1e-11 * largest(exact))
    free = ks.Scene(BAR, speed, loads=[ks.Gravity()]).solve(TURN)
    assert largest(exact - quantities.components(free, name)) > 1.0


def test_an_arm_that_swings_for_a_moment_is_dragged():
    """Twice 0.05 rad in 0.4 rad of the crank, a dwell on all the rest."""
    cycloidal, dwell = ks.laws.cycloidal, ks.laws.dwell(0.4, 2 * np.pi - 0.4)
    law = ks.laws.joined(cycloidal(0.4, 0.45, 0.2), cycloidal(0.45, 0.4, 0.2), dwell).shifted(0.15)
    cam = ks.Mechanism("cam", ks.Crank(0.1), (ks.SwingingFollower(law, 0.1, (0.15, 0.0)),))
    s = scene(drag(on="arm"), mechanism=cam).solve(5)
    assert s.losses.drive == pytest.approx(50.0 * 0.1 * 10.0 / (2 * np.pi), rel=1e-10)


def test_extremes_take_both_limits_where_the_rocker_turns_back():
    s = scene(mechanism=ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))).solve(7)
    (angles,) = s.loads[0].jumps.angles(s)
    np.testing.assert_allclose(s.at(angles).rate("rocker"), 0.0, atol=1e-11)
    assert angles.size == 2
    found = ks.extremes(s, lambda at: at.reaction("A")[0])
    beside = s.at(np.concatenate([angles - 1e-9, angles + 1e-9])).reaction("A")[0]
    assert np.isin(np.round(beside, 3), np.round(found.value, 3)).any()
    assert found.value.max() >= beside.max() - 1e-6
    assert found.value.min() <= beside.min() + 1e-6


@pytest.mark.slow
def test_program_derivative_and_sweep():
    program = ks.compile(scene(), "balancing_torque", engine="numpy")
    values, slopes = program(TURN), program.derivatives(TURN, "torque.value")
    slope = slopes["balancing_torque"]["torque.value"]
    plain = ks.Scene(BAR, 10.0).solve(TURN).balancing_torque
    np.testing.assert_allclose(50.0 * slope + plain, values["balancing_torque"], atol=1e-12)
    assert largest(program.error_bound(TURN)["balancing_torque"]) < 1e-11
    with pytest.raises(ks.ParameterError, match="must be at least 0, got -1"):
        program(TURN, {"torque.value": -1.0})
    table = ks.sweep(scene(), pd.DataFrame({"torque.value": [0.0, 20.0]}), ["mean balancing_torque"], progress=False)
    mean = table["mean balancing_torque [N m]"]
    assert mean[0] == pytest.approx(0.0, abs=1e-12)
    assert mean[1] == pytest.approx(0.4 * scene().solve(7).losses.drive / 10.0, rel=1e-10)


@pytest.mark.slow
def test_mirrored_machine_gives_mirrored_forces():
    found = mirror.solved(scene(ks.Gravity(), drag(), drag(4.0, on="coupler", against="crank")))
    assert max(found.values()) < 1e-12


# At rest, and in drives


def test_at_rest_it_opposes_the_motion_about_to_begin():
    with pytest.raises(ks.ParameterError, match=r"Torque on 'rocker': it acts against the motion, but crank_speed and"):
        scene(speed=0.0).solve(TURN)
    for sense in (1.0, -1.0):
        moving = drag().couple(scene(speed=sense).solve(TURN))
        np.testing.assert_array_equal(drag().couple(scene(speed=0.0, sense=sense).solve(TURN)), moving)
        starting = ks.solve(BAR, TURN, crank_speed=0.0, crank_acceleration=sense, loads=[drag()])
        np.testing.assert_array_equal(drag().couple(starting), moving)


@every("speed", (4.0, -4.0))
def test_it_brings_a_crank_to_rest_when_it_has_its_energy(speed):
    still = ks.Mechanism("wheel", ks.Crank(0.3, ks.Link(3.0, 0.0, 0.5)), ())
    motion = ks.drive.coast(
        scene(drag(2.0, on="crank"), mechanism=still), from_angle=1.0, from_speed=speed, until="standstill"
    )
    assert motion.events[-1].crank_angle == pytest.approx(1.0 + np.sign(speed) * 0.5 * 0.5 * 16.0 / 2.0, rel=1e-9)
    assert motion.time[-1] == pytest.approx(0.5 * 4.0 / 2.0, rel=1e-9)


@every("value, ends", ((5.0, "standstill"), (7.0, "standstill"), (1.0, "end")))
def test_a_pendulum_sticks_where_the_drag_holds_its_weight(value, ends):
    """Weight gives 3 kg g 0.2 m = 5.9 N m at right angles: 7 N m hold it anywhere, 5 N m in a band about the bottom."""
    pendulum = scene(ks.Gravity(), drag(value, on="crank"), mechanism=ARM)
    motion = ks.drive.coast(pendulum, from_angle=0.0, until=1.2)
    assert motion.events[-1].name == ends
    angle = motion.events[-1].crank_angle
    if value == 7.0:
        assert angle == 0.0
    if value == 5.0:  # one fall: the weight's work is that of the drag
        assert 3.0 * 9.81 * 0.2 * np.sin(-angle) == pytest.approx(5.0 * -angle, rel=1e-6)
    if value == 1.0:
        assert motion.events[1].name == "reversal"


# Hostile

WRONG = {
    "negative": (lambda: drag(-5.0), "an opposing value must be at least 0, got -5.0"),
    "function": (lambda: drag(lambda motion: 5.0), "an opposing value must be a number"),
    "table": (lambda: drag(ks.Table([0.0, 2.0, 4.0, 6.2], [1.0, 2.0, 1.0, 1.0])), "an opposing value must be a number"),
    "by angle": (lambda: drag(np.ones(5)), "an opposing value must be a number"),
    "NaN": (lambda: drag(np.nan), "value must be finite"),
    "no truth": (lambda: ks.Torque(5.0, on="rocker", opposing="yes"), "opposing must be True or False, got 'yes'"),
    "a link that only shifts": (
        lambda: scene(drag(on="slider"), mechanism=ks.crank_slider(0.1, 0.3)),
        "Torque on 'slider': the link does not turn against 'frame', so there is no drag",
    ),
    "a coupler that only shifts": (
        lambda: scene(drag(on="coupler"), mechanism=ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0), assembly="open")),
        "Torque on 'coupler': the link does not turn",
    ),
    "no such link": (lambda: scene(drag(on="knife")), "on is 'knife'"),
    "itself": (lambda: scene(drag(against="rocker")), "is against the same link"),
}


@every("name", WRONG)
def test_what_is_no_drag_is_refused(name):
    make, words = WRONG[name]
    with pytest.raises(ks.ParameterError, match=words):
        make()


def test_case_file(tmp_path):
    text = """
title = "Rocker with a brake"
reference = "braked"
[variants.braked]
mechanism = "four-bar"
crank_speed = "10 rad/s"
crank_length = "100 mm"
coupler_length = "400 mm"
rocker_length = "300 mm"
rocker_pivot = ["350 mm", "100 mm"]
[[variants.braked.loads]]
kind = "torque"
value = "50 N m"
on = "rocker"
opposing = true
"""
    s = ks.load_case(case_file(tmp_path, text)).variant("braked").scene.solve(TURN)
    np.testing.assert_allclose(s.balancing_torque * 10.0, 50.0 * np.abs(s.rate("rocker")), rtol=1e-12)
