"""Hostile followers and torque-balancing cams: each is refused at once, in words, or works."""

import math

import numpy as np
import pytest

import kinetostatics as ks

LAW = ks.laws.cosine(0.02, 0.08)
NUMBERS = ("text", None, [1.0], math.nan, math.inf, -math.inf, 1e300, -1.0, 0.0, 1j, object())
KINDS = (
    lambda **given: ks.RollerFollower(**{"cam": LAW} | given),
    lambda **given: ks.FlatFollower(**{"cam": LAW} | given),
    lambda **given: ks.SwingingFollower(**{"cam": LAW, "arm_length": 0.1, "pivot": (0.12, 0.0)} | given),
)
LAWS = (*NUMBERS, LAW(0.0), ks.laws.dwell, ks.cams.CosineLaw(0.3, 2.0), lambda: None, lambda phi: None, print)


@pytest.fixture(scope="module")
def drive():
    return ks.load_case("chain_unit").variants["rho-0.1"].scene


@pytest.mark.parametrize("number", range(len(KINDS)))
@pytest.mark.parametrize("law", LAWS, ids=range(len(LAWS)))
def test_what_is_no_law_is_refused(number, law):
    with pytest.raises(ks.ParameterError, match="cam"):
        KINDS[number](cam=law)


@pytest.mark.parametrize("value", [part for part in NUMBERS if part != "text"], ids=range(len(NUMBERS) - 1))
@pytest.mark.parametrize("name", ["pin", "label"])
def test_names_must_be_texts(name, value):
    for kind in KINDS:
        with pytest.raises(ks.ParameterError, match=f"{name} must be a name"):
            kind(**{name: value})


@pytest.mark.parametrize("value", NUMBERS, ids=range(len(NUMBERS)))
@pytest.mark.parametrize("name", ["mass", "travel", "stiffness", "base_radius", "pressure_angle", "roller_radius"])
def test_torque_cam_numbers_are_checked(drive, name, value):
    given = {"mass": 0.3, "travel": 0.012, name: value}
    if value is None and name in ("stiffness", "base_radius", "roller_radius"):
        return
    with pytest.raises(ks.ParameterError):
        ks.design.torque_balancing_cam(drive, **given)


def machines(drive):
    gapped = ks.four_bar(0.3, 0.2, 0.3, rocker_pivot=(0.35, 0.0), rocker=ks.Link(1.0, (0.1, 0.0)))
    mechanism, table = drive.mechanism, np.linspace(1.0, 2.0, 720)[:, None]
    return {
        "gaps": (ks.Scene(gapped, 10.0), "close|assembled|intervals"),
        "batch": (ks.Scene(ks.crank_slider(0.1, table, slider=ks.Link(1.0)), 10.0), "one design at a time"),
        "speeds": (ks.Scene(mechanism, table), "one constant speed"),
        "noise": (
            ks.Scene(mechanism, 10.0, loads=ks.Torque(lambda m: np.sin(1e7 * m.crank_angle), on="rocker")),
            "not smooth between finitely many kinks",
        ),
        "taken": (ks.design.torque_balancing_cam(drive, mass=0.3, travel=0.012).scene, "even as it is|a second time"),
    }


@pytest.mark.parametrize("name", ["gaps", "batch", "speeds", "noise", "taken"])
def test_machines_that_no_cam_balances_are_refused(drive, name):
    scene, text = machines(drive)[name]
    with pytest.raises(ks.KinetostaticsError, match=text):
        ks.design.torque_balancing_cam(scene, mass=0.3, travel=0.012)
