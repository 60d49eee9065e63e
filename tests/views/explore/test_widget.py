"""The widget of a notebook answers messages as a server does, without a browser."""

import asyncio
import sys

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.explore import widget

pytest.importorskip("anywidget")
CASE = "sawframe_2r63"
LOOK = {"id": 2, "kind": "look", "show": ["balancing_torque"], "count": 36}


def asked(shown, page, request=None):
    """Answers to a request of a page: pairs of header and buffers."""
    sent = []
    shown.send = lambda content, buffers=None: sent.append((content, buffers))
    content = {"page": page} if request is None else {"page": page, "request": request}
    shown._handle_msg({"content": {"data": {"method": "custom", "content": content}}, "buffers": []})
    assert all(content["page"] == page for content, _ in sent)
    return [(content["answer"], buffers) for content, buffers in sent]


def test_answers_carry_arrays_beside_their_header():
    shown = ks.explore(CASE, variant="plain")
    state = {"variant": "plain", "values": {"slider.mass": 620.0}}
    [(answer, buffers)] = asked(shown, "one", LOOK | {"state": state})
    torque = answer["quantities"]["balancing_torque"]["values"]
    wanted = ks.load_case(CASE).variants["plain"].scene.varied({"slider.mass": 620.0}).solve(36).balancing_torque
    values = np.frombuffer(buffers[torque["array"]], torque["kind"])
    assert np.allclose(values, wanted, rtol=1e-12, atol=1e-9 * np.max(np.abs(wanted)))
    assert answer["state"] == state


def test_mistakes_are_answered_in_words():
    [(answer, _)] = asked(ks.explore(CASE), "one", LOOK | {"state": {"variant": "plian", "values": {}}})
    assert "plian" in answer["problem"]


def test_the_scene_is_the_one_that_is_shown():
    shown = ks.explore(CASE, variant="cam-circle")
    assert shown.state == {"variant": "cam-circle", "values": {}}
    shown.state = {"variant": "cam-circle", "values": {"slider.mass": 620}}
    assert shown.scene.parameters["slider.mass"] == 620.0
    assert ks.explore(shown.scene).scene.parameters == shown.scene.parameters


def test_each_page_of_a_widget_has_a_session_of_its_own():
    shown = ks.explore(CASE)
    for page in ("one", "two"):
        asked(shown, page, {"id": 1, "kind": "open"})
    sessions = [conversation.session for conversation in shown._conversations.values()]
    assert sessions[0] is not sessions[1]
    asked(shown, "one")
    assert list(shown._conversations) == ["two"]
    shown.close()
    assert not shown._conversations


def test_numbers_come_in_the_units_of_the_widget():
    shown = ks.explore(CASE, units={"force": "lbf"})
    request = {"id": 1, "kind": "look", "show": ["O"], "count": 4, "state": shown.state}
    [(answer, _)] = asked(shown, "one", request)
    assert answer["quantities"]["O"]["unit"] == "lbf"


def test_cases_are_saved_in_the_folder_of_the_widget(tmp_path):
    shown = ks.explore(CASE, variant="plain", folder=tmp_path)
    state = {"variant": "plain", "values": {"slider.mass": 620}}
    [(answer, _)] = asked(shown, "one", {"id": 1, "kind": "save", "state": state, "name": "heavy"})
    assert answer["saved"] == "heavy.toml"
    saved = ks.load_case(tmp_path / "heavy.toml")
    assert [item.scene.parameters["slider.mass"] for item in saved.variants.values()] == [600.0, 620.0]


def test_parts_come_while_other_requests_are_answered():
    async def ask():
        shown, found = ks.explore(CASE), []
        shown.send = lambda content, buffers=None: found.append(content["answer"]["kind"])
        reference = {"variant": "plain", "values": {}}
        for request in (
            {"id": 1, "kind": "ask", "state": shown.state, "reference": reference, "show": ["O"]},
            {"id": 2, "kind": "describe", "state": shown.state},
        ):
            shown._receive(shown, {"page": "one", "request": request}, [])
        before = list(found)
        while len(asyncio.all_tasks()) > 1:
            await asyncio.sleep(0.01)
        return before, found

    before, found = asyncio.run(ask())
    assert before == ["describe"]
    assert set(found[1:]) == {"ask"}


def test_without_anywidget_the_command_that_installs_it_is_given(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    widget.widget_class.cache_clear()
    with pytest.raises(ks.MissingLibraryError, match=r'pip install "kinetostatics\[explore\]"'):
        ks.explore(CASE)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"what": "no_such_case"}, "no_such_case"),
        ({"what": CASE, "variant": "plian"}, "plian"),
        ({"what": CASE, "units": {"force": "m"}}, "force"),
        ({"what": 3}, "case"),
    ],
)
def test_what_cannot_be_shown_is_refused_at_once(arguments, message):
    with pytest.raises(ks.KinetostaticsError, match=message):
        ks.explore(**arguments)
