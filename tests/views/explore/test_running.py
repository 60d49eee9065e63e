"""Motor speed on the explore page."""

import numpy as np

import kinetostatics as ks
from kinetostatics.views.explore.session import Session

CASE, VARIANT = "sawframe_2r63", "cam-cosine"


def asked(session, **states):
    return list(session.answer({"id": 1, "kind": "running"} | states))


def test_speed_is_that_of_steady_running_of_state_and_reference():
    session = Session(CASE)
    states = {"state": {"variant": VARIANT, "values": {"slider.mass": 620.0}}, "reference": {"variant": "plain"}}
    *parts, last = asked(session, **states)
    assert [part["running"] for part in parts] == ["state", "reference"]
    assert not last["more"]
    for part, (variant, values) in zip(parts, [(VARIANT, {"slider.mass": 620.0}), ("plain", {})], strict=True):
        own = ks.load_case(CASE).variants[variant]
        run = ks.drive.steady(own.scene.varied(values), own.motor, own.flywheel, angles=360)
        found = part["quantities"]["motor speed"]
        np.testing.assert_array_equal(found["values"], run.motor_speed)
        np.testing.assert_array_equal(part["angle"], np.degrees(run.crank_angle))
        assert (found["unit"], part["period"]) == ("rpm", 360.0)


def test_case_without_a_drive_says_so():
    session, state = Session("pumpjack"), {"variant": "weights", "values": {}}
    (answer,) = asked(session, state=state)
    assert answer["problem"] == "explore: variant 'weights' has no drive"
    assert not session.answer({"id": 1, "kind": "describe", "state": state})["drive"]
    assert Session(CASE).answer({"id": 1, "kind": "describe", "state": {"variant": VARIANT, "values": {}}})["drive"]
