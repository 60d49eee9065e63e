"""The page stands alone, says what it was made from, and takes any text for what it is."""

import re

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.report import html
from kinetostatics.views.report.report import subject_of
from support.reports import COMMAND, data_of, page, plain, subject, words

pytestmark = pytest.mark.slow

pytest.importorskip("jinja2")
HOSTILE = "</script><script>alert(1)</script> \"quoted\" 'n' & <b>x</b> {{ 7*7 }} $$x$$ @y{0} Säge пила 鋸 שלום"


def test_page_is_self_contained():
    text, _ = page("pumpjack")
    assert "default-src 'none'" in text
    beside = re.sub(r"<script>.*?</script>", "", text, flags=re.S)
    assert not re.search(r"""\b(src|href|action|poster)\s*=\s*["']?(?!["'#]|data:)""", beside)
    assert set(re.findall(r'href="(.)', beside)) == {"#", "d"}
    assert "url(" not in re.search(r"<style>(.*?)</style>", text, re.S)[1]
    assert len(text.encode()) < 6e6


def test_page_has_no_empty_section():
    seen = words(page("pumpjack")[0])
    headings = "At a glance", "In motion", "Values at crank angle", "Figures", "Comparison", "Extremes", "Certainty"
    assert [heading for heading in (*headings, "Inputs") if heading not in seen] == []
    assert 'id="friction"' not in page("pumpjack")[0]
    assert 'id="drive"' not in page("pumpjack")[0]


def test_page_names_version_command_and_sources():
    made, seen = subject("pumpjack"), words(page("pumpjack")[0])
    assert f"kinetostatics {ks.__version__}" in seen
    assert COMMAND in seen
    assert made.case.source in seen
    assert "# assumed: P" in seen
    assert made.files[1][1][:16] in seen


def test_hostile_names_are_shown_as_text():
    scenes = {HOSTILE: plain(), "plain": plain(crank_speed=20.0)}
    told = []
    text = html.page(subject_of(scenes, title=HOSTILE), told.append)
    assert (told[0], told[-1], len(told)) == ("movement", "page", html.PROGRESS_STEPS)
    assert "<script>alert" not in text
    assert "<b>x" not in text
    assert words(text).count(HOSTILE) >= 5
    assert data_of(text)["drawings"][0]["name"] == HOSTILE


def test_a_hostile_case_file_stands_as_text(tmp_path):
    case = tmp_path / "hostile.toml"
    case.write_text(
        f"""title = '''{HOSTILE}'''\nsource = '''{HOSTILE}'''\nreference = "</script>"\n[variants."</script>"]
mechanism = "chain"\nname = "<img src=x onerror=alert(1)>"\ncrank_speed = "60 rpm"\ncrank_length = "0.3 m"
[[variants."</script>".groups]]\nkind = "slider"\ncoupler_length = "2 m"\npin = "<i>"\nlabel = "__proto__"
slider = {{ mass = "600 kg" }}\n# <script>alert(2)</script>\n""",
        encoding="utf-8",
    )
    text = html.page(subject_of(case))
    assert "<script>alert" not in text
    assert "<img src=x" not in text
    assert "<i>" not in text
    assert HOSTILE in words(text)


def test_warnings_stand_as_remarks():
    toggle = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(1.0, 0.05))
    seen = words(html.page(subject_of(ks.Scene(toggle, 10.0, loads=ks.Gravity()))))
    assert "Remarks" in seen
    assert "grows without bound at 0, 180 deg" in seen


def test_first_angle_has_the_largest_torque():
    solution = subject("pumpjack").reference.solution
    data = page("pumpjack")[1]
    assert data["start"] == np.argmax(np.abs(solution.balancing_torque))
    assert data["sense"] == -1


def test_machines_of_the_same_torque_are_named():
    scenes = {"one": plain(), "two": plain(), "three": plain(crank_speed=11.0)}
    assert html._same_torque_text(subject_of(scenes)).endswith("same torque: one and two.")


def test_a_crank_that_stands_still_is_reported_too():
    seen = words(html.page(subject_of(plain(crank_speed=0.0))))
    assert "turns a minute" not in seen
    assert "At a glance" in seen


def test_published_figures_tell_where_they_are_printed():
    assert html._published(subject("mower_drive"))[0].startswith("Published figures: table 1 of A. V. Kotov")
    assert html._published(subject("pumpjack")) == []
