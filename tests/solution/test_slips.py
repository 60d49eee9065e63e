"""Slips of units: numbers beyond what is usual are told by path, with what may be meant, and computed all the same."""

import warnings
from itertools import product

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.solution import parameters
from support.every import every
from support.scenes import SCENES, solve

TURN = 2.0 * np.pi * np.arange(24) / 24
ROD, RAM = ks.Link(150.0, 1.0, 20.5), ks.Link(600.0)


def saw(**changes):
    return ks.crank_slider(**{"crank_length": 0.3, "coupler_length": 2.0, "coupler": ROD, "slider": RAM} | changes)


def cam_saw(cam, **changes):
    return ks.cam_crank_slider(cam, 0.8, **changes)


def hints(mechanism=None, angle=TURN, **changes):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ks.solve(mechanism or saw(), angle, **{"crank_speed": 33.5, "on_gap": "nan"} | changes)
    return [str(item.message) for item in caught if item.category is ks.HintWarning]


def loaded(load):
    return lambda: hints(loads=load)


def rubbing(**friction):
    return lambda: hints(friction=friction)


def made(build, *given, **changes):
    return lambda: hints(build(*given, **changes))


CIRCLE = ks.cams.Circle(0.2, (-0.05, 0.0))


@pytest.mark.slow
@every(
    ("found", "words"),
    [
        (rubbing(O=ks.PinFriction(30.0, 0.05)), "friction.O.mu is 30; no surface has this much friction; is it a size"),
        (rubbing(O=ks.PinFriction(0.05, 30.0)), "friction.O.radius is 30 m, 15 times the longest link (2 m); is it in"),
        (rubbing(O=ks.PinFriction(0.05, 2.5)), "friction.O.radius is 2.5 m"),
        (rubbing(guide=ks.GuideFriction(0.1, 100.0)), "friction.guide.half_length is 100 m"),
        (rubbing(guide=ks.GuideFriction(10.0)), "friction.guide.mu is 10"),
        (
            made(saw, guide_angle=90),
            "guide_angle is 90 rad; more than a whole turn; is it in degrees? That makes 1.5708 rad",
        ),
        (made(saw, guide_angle=np.array([[0.0], [-90.0]])), "guide_angle is -90 rad"),
        (loaded(ks.Gravity(direction=-90)), "gravity.direction is -90 rad"),
        (loaded(ks.Gravity(9810.0)), "gravity.acceleration is 9810 m/s2; is it in mm/s2?"),
        (loaded(ks.Force(10.0, at="B", direction=270)), "force.direction is 270 rad"),
        (loaded(ks.Force(10.0, at=("coupler", 500, 0))), "force.at.along is 500 m, 250 times the longest link"),
        (loaded(ks.Spring(1e5, 1500.0)), "spring.free_position is 1500 m, 750 times"),
        (loaded([ks.Spring(1e5, 1.0), ks.Spring(1e5, -1500.0)]), "spring2.free_position is -1500 m"),
        (loaded(ks.PointSpring(1e3, 0.0, between=("B", (1500.0, 20.0)))), "point_spring.between.2.x is 1500 m"),
        (loaded(ks.TorsionSpring(1e3, 45.0, on="coupler")), "torsion_spring.free_angle is 45 rad"),
        (lambda: hints(crank_speed=3200.0), "the pin of the crank moves at 960 m/s, faster than in any racing engine"),
        (lambda: hints(crank_speed=320.0), "the pin of the crank moves at 96 m/s"),
        (lambda: hints(crank_speed=-3200.0), "3200 rad/s, in rpm? That makes 335.103 rad/s"),
        (lambda: hints(crank_speed=np.linspace(1.0, 3200.0, 24)), "the pin of the crank moves at 960 m/s"),
        (made(saw, crank_length=300.0, coupler_length=2000.0), "the coupler is 2000 m long; are lengths in mm?"),
        (made(saw, crank_length=0.005, coupler_length=20.0), "4000 times the crank (0.005 m); is one of them in mm?"),
        (
            made(saw, coupler=ks.Link(150.0, 1.0, 20.5e6)),
            "2.05e+07 kg m2, is 4.1e+05 times that of a uniform rod of 150 kg and 2 m; is it in kg mm2? "
            "That makes 20.5 kg m2",
        ),
        (
            made(saw, coupler=ks.Link(150.0, 1.0, np.array([[20.5], [20.5e6]]))),
            "the inertia of the coupler, 2.05e+07 kg m2, is 4.1e+05 times",
        ),
        (made(saw, coupler=ks.Link(150.0, 1.0, 20.5e-6)), "the inertia of the coupler, 2.05e-05 kg m2, is less than"),
        (made(saw, coupler=ks.Link(150.0, (0.0, 1e3), 20.5)), "coupler.centre.across is 1000 m"),
        (made(ks.four_bar, 0.1, 0.4, 0.3, rocker_pivot=(400.0, 0.0)), "rocker_pivot.x is 400 m, 1000 times"),
        (made(ks.slotted_lever, 0.1, pivot=(0.0, -300.0)), "lever_pivot.y is -300 m"),
        (made(ks.scotch_yoke, 0.1, slot_angle=90.0), "slot_angle is 90 rad"),
        (made(cam_saw, ks.cams.Circle(200.0, (-50.0, 0.0))), "cam.radius is 200 m, 250 times"),
        (made(cam_saw, ks.cams.Harmonic(cosine=(0.3, 0.01), guide_angle=90.0)), "cam.guide_angle is 90 rad"),
        (
            made(cam_saw, CIRCLE, roller=ks.Roller(0.05, 0.04, 210.0, 0.3)),
            "roller.youngs_modulus is 210 Pa; is it in GPa, or in N/mm2?",
        ),
        (
            lambda: hints(angle=720),
            "720 is used as one crank angle, 720 rad; for 720 of them over the turn give np.lin",
        ),
        (lambda: hints(angle=np.int64(100)), "for degrees np.radians(100)"),
        (lambda: hints(angle=720.0), "the crank angle 720 looks like degrees; it is used as radians"),
        (lambda: hints(angle=[30.0, 60.0]), "crank angles 30 and 60 look like degrees"),
        (lambda: hints(angle=np.radians(TURN)), "are a turn in radians, converted from degrees once more"),
        (lambda: hints(angle=np.radians(np.linspace(0, 2 * np.pi, 37))), "converted from degrees once more"),
    ],
)
def test_a_slip_of_units_is_told_by_its_path(found, words):
    assert any(words in text for text in found())


@every(
    "found",
    [
        loaded([ks.Gravity(), ks.Spring(1e5, 2.0)]),
        made(saw, guide_angle=-2.0 * np.pi),
        made(saw, guide_angle=2.0 * np.pi),
        made(saw, crank_length=0.02, crank=ks.Link(5.0, 0.0, 4000.0)),  # with the drive's inertia
        rubbing(O=ks.PinFriction(0.1, 0.5), A=ks.PinFriction(0.1, 0.4)),  # an eccentric is larger than the crank
        lambda: hints(angle=np.linspace(0.0, 4.0 * np.pi, 720)),
        lambda: hints(angle=np.linspace(0.0, 0.11, 30)),
        lambda: hints(angle=100.0),
        lambda: hints(angle=12),
        lambda: hints(angle=-100),
        lambda: hints(angle=[3.0, 90.0]),
        lambda: hints(crank_speed=-160.0),
        made(cam_saw, CIRCLE, roller=ks.Roller(0.05, 0.04, 20e6, 0.4)),  # rubber
        made(ks.four_bar, 0.04, 0.3, 0.06, rocker_pivot=(0.3, 0.0), rocker=ks.Link(0.8, 0.2, 0.03)),  # arm of a wiper
    ],
)
def test_what_is_possible_is_not(found):
    assert found() == []


def test_one_number_is_told_once():
    assert len(hints(loads=ks.Gravity(direction=-90), friction={"O": ks.PinFriction(0.05, 30.0)})) == 2


@every("name", SCENES)
def test_far_off_lengths_and_angles_are_reported(name):
    s = solve(SCENES[name], SCENES[name].mechanism.turns * [0.3])
    look, (_, leaves) = s.kind.answer(parameters.scene_plausibility_test), s.apart
    bars = [bar.length for bar in s.mechanism.bars]
    judged = [item for item in s.kind.answer(parameters.plausible_numbers) if item.usual.unit in ("m", "rad")]
    judged = [item for item in judged if leaves.numbers[item.leaf] not in bars]
    assert judged or name == "plain, weightless"
    for item, sign in product(judged, (1.0, -1.0)):
        far = list(leaves.numbers)
        far[item.leaf] = sign * (30.0 * max(bars) if item.usual.unit == "m" else 90.0)
        assert look(far)[1], item.path


@pytest.mark.slow
def test_shipped_cases_have_no_slips():
    for name in shipped_cases():
        with warnings.catch_warnings():
            warnings.simplefilter("error", ks.HintWarning)
            case = ks.load_case(name)
        for variant in case.variants.values():
            assert parameters.plausibility_hints(variant.scene.unsolved(np.zeros(1))) == (), (name, variant)


@every(
    ("ask", "words"),
    [
        (
            lambda: ks.drive.Motor.kloss(55e3, 1470.0, synchronous_speed=1500.0, overload=2.5),
            "Motor.kloss: synchronous_speed is 1500 rad/s; is it in rpm?",
        ),
        (
            lambda: ks.drive.start(
                ks.Scene(saw(), 1.0), ks.drive.Motor.constant(9e3), flywheel=1.0, from_angle=90.0, until=0.01
            ),
            "start: the crank angle 90 looks like degrees",
        ),
        (lambda: ks.solve(saw(), 0.5, crank_speed=1.0).at(720), "crank-slider: 720 is used as one crank angle"),
        (lambda: ks.solve(saw(), 0.5, crank_speed=1.0).explain("O", 90), "the crank angle 90 looks like degrees"),
        (
            lambda: ks.design.contact(
                ks.solve(cam_saw(CIRCLE, slider=RAM), 0.5, crank_speed=10.0), 0.05, 0.04, 210.0, 0.3
            ),
            "contact: youngs_modulus of the roller is 210 Pa; is it in GPa, or in N/mm2?",
        ),
    ],
)
def test_slips_are_told_where_no_scene_is_solved(ask, words):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ask()
    assert [words in str(item.message) for item in caught if item.category is ks.HintWarning] == [True]
