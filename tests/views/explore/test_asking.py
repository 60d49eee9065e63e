"""Questions of a page about the machine that is shown: messages with numbers as texts, soon after the last change."""

import time

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers.formatting import number
from kinetostatics.views.explore.session import Session

SAW = "sawframe_2r63"
CIRCLE, PLAIN = {"variant": "cam-circle", "values": {}}, {"variant": "plain", "values": {}}
LATEST = 0.3
"""Seconds of the processor within which all questions are answered after the last change."""


@pytest.fixture(scope="module")
def saw():
    return Session(SAW)


def parts(session, **request):
    *found, last = session.answer({"id": 7, **request})
    assert all(part["more"] for part in found)
    assert all(part["id"] == 7 for part in found)
    assert last.get("more") is False or "problem" in last
    return found, last


@pytest.mark.slow
def test_the_table_has_numbers_of_the_state_that_it_carries(saw):
    state = CIRCLE | {"values": {"slider.mass": 620.0}}
    found, _ = parts(saw, kind="ask", state=state, reference=PLAIN, show=["O", "cam_force", "unknown"])
    assert all(part["state"] == state for part in found)
    force, cam = (part["extremes"] for part in found if "extremes" in part)
    scene, plain = saw.scene(state), saw.scene(PLAIN)
    peak = ks.extremes(scene.solve(360), "O")
    assert (force["label"], force["unit"]) == ("|reaction O|", "kN")
    assert force["largest"] == number(peak.largest / 1e3)
    compared = ks.compare(plain.solve(360), scene.solve(360))
    assert force["ratio"] == f"{compared.peak_reaction_ratio('O'):.4g}"
    assert cam["ratio"] == cam["reference"] == ""
    figures = {part["figure"]["label"]: part["figure"] for part in found if "figure" in part}
    assert figures["mean |balancing torque|"]["ratio"] == f"{compared.mean_torque_ratio:.4g}"


def test_without_a_reference_the_table_has_no_ratios(saw):
    found, _ = parts(saw, kind="ask", state=CIRCLE, reference=None, show=["O"])
    assert {next(iter({"extremes", "figure"} & part.keys())) for part in found} == {"extremes", "figure"}
    assert all((part.get("extremes") or part["figure"])["ratio"] == "" for part in found)


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"kind": "ask", "show": ["O"]}, "cannot be assembled"),
        ({"kind": "sensitivities", "output": "largest O"}, "cannot be assembled"),
        ({"kind": "tolerances", "show": ["O"]}, "cannot be assembled"),
        ({"kind": "optimise", "vary": {}, "goal": "prefer", "output": "largest O"}, "goal"),
    ],
)
def test_what_has_no_answer_says_why(saw, request_, words):
    *_, last = saw.answer({"state": PLAIN | {"values": {"coupler_length": 0.2}}, **request_})
    assert words in last["problem"]


def test_sensitivities_have_shares_and_slopes_in_shown_units(saw):
    ((found,), _) = parts(saw, kind="sensitivities", state=PLAIN, output="largest_absolute balancing_torque")
    rows = {row["path"]: row for row in found["rows"]}
    assert found["unit"] == "kN·m"
    assert rows["crank_speed"]["share"] == pytest.approx(2.0, abs=0.01)
    assert rows["crank_speed"]["slope"].endswith(" kN·m per rpm")
    assert np.isnan(rows["guide_offset"]["share"])


@pytest.mark.slow
def test_tolerances_of_the_case_are_the_default(saw):
    (first, *others), _ = parts(saw, kind="tolerances", state=CIRCLE, show=["O", "balancing_torque"])
    assert first["spreads"]["spring.stiffness"] == 7000.0
    assert [part["band"]["name"] for part in others] == ["O", "balancing_torque"]
    assert others[0]["band"]["low"].shape == (360,)
    (first, other), _ = parts(saw, kind="tolerances", state=CIRCLE, spreads={"slider.mass": 6.0}, show=["O"])
    assert first["spreads"] == {"slider.mass": 6.0}
    narrow = other["band"]["high"] - other["band"]["low"]
    assert np.all(narrow <= others[0]["band"]["high"] - others[0]["band"]["low"])


def test_without_uncertainties_there_are_no_bands():
    session = Session("pumpjack")
    found, _ = parts(session, kind="tolerances", state={"variant": "weights", "values": {}}, show=["O"])
    assert [part["spreads"] for part in found] == [{}]


# Motor speed


def speeds(session, **states):
    return list(session.answer({"id": 1, "kind": "running"} | states))


@pytest.mark.slow
def test_speed_is_that_of_steady_running_of_state_and_reference():
    session = Session(SAW)
    states = {"state": {"variant": "cam-cosine", "values": {"slider.mass": 620.0}}, "reference": {"variant": "plain"}}
    *parts, last = speeds(session, **states)
    assert [part["running"] for part in parts] == ["state", "reference"]
    assert not last["more"]
    for part, (variant, values) in zip(parts, [("cam-cosine", {"slider.mass": 620.0}), ("plain", {})], strict=True):
        own = ks.load_case(SAW).variants[variant]
        run = ks.drive.steady(own.scene.varied(values), own.motor, own.flywheel, angles=360)
        found = part["quantities"]["motor speed"]
        np.testing.assert_array_equal(found["values"], run.motor_speed)
        np.testing.assert_array_equal(part["angle"], np.degrees(run.crank_angle))
        assert (found["unit"], part["period"]) == ("rpm", 360.0)


def test_case_without_a_drive_says_so():
    session, state = Session("pumpjack"), {"variant": "weights", "values": {}}
    (answer,) = speeds(session, state=state)
    assert answer["problem"] == "explore: variant 'weights' has no drive"
    assert not session.answer({"id": 1, "kind": "describe", "state": state})["drive"]
    assert Session(SAW).answer({"id": 1, "kind": "describe", "state": CIRCLE})["drive"]


# Answers while the page goes on


@pytest.mark.slow
@pytest.mark.parametrize(("case", "variant"), [("sawframe_2r63", "cam-circle"), ("pumpjack", "weights")])
def test_questions_are_answered_soon_after_the_last_change(case, variant):
    session = Session(case, variant)
    state = {"variant": variant, "values": {}}
    known, own = session.answer({"kind": "describe", "state": state}), session.scene(state).parameters
    show = [quantity["name"] for quantity in known["quantities"]][:10]
    spreads = {path: 1e-3 * abs(value) for path, value in own.items() if value}
    reference, path = {"variant": session.case.reference_of(variant), "values": {}}, next(iter(spreads))
    times: dict[str, list[float]] = {}
    for turn in range(4):
        changed = state | {"values": {path: own[path] * (1.0 + 1e-6 * turn)}}
        for request in (
            {"kind": "ask", "reference": reference, "show": show},
            {"kind": "sensitivities", "output": "largest_absolute balancing_torque"},
            {"kind": "tolerances", "show": show, "spreads": dict(list(spreads.items())[:5])},
        ):
            begin = time.process_time()
            answers = list(session.answer({"state": changed, **request}))
            times.setdefault(request["kind"], []).append(time.process_time() - begin)
            assert not any("problem" in answer for answer in answers)
    assert {kind: min(found) for kind, found in times.items() if min(found) > LATEST} == {}


def first_step(answers):
    end = time.monotonic() + 60.0
    for answer in answers:
        if answer:
            return answer
        assert time.monotonic() < end
        time.sleep(0.02)
    return None


SEARCH = {
    "kind": "optimise",
    "state": {"variant": "cam-cosine", "values": {}},
    "vary": {"spring.stiffness": [3e5, 12e5], "spring.free_position": [1.9, 2.1], "coupler_length": [1.9, 2.2]},
    "goal": "minimise",
    "output": "largest_absolute balancing_torque",
}


@pytest.mark.slow
def test_a_search_answers_while_it_runs_and_can_be_cancelled(saw):
    answers = saw.answer({"id": 8, **SEARCH})
    assert first_step(answers)["step"] >= 1
    assert "problem" not in saw.answer({"kind": "describe", "state": CIRCLE})
    saw.answer({"kind": "cancel"})
    *_, cancelled, last = (answer for answer in answers if answer)
    assert cancelled["cancelled"]
    assert not last["more"]


@pytest.mark.slow
def test_a_search_ends_with_its_page(saw):
    answers = saw.answer({"id": 9, **SEARCH})
    first_step(answers)
    process = saw.search._process
    assert process.poll() is None
    answers.close()
    assert process.poll() is not None
