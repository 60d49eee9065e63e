"""The public door of reports."""

import shutil
import stat
import sys

import pytest

import kinetostatics as ks
from kinetostatics.errors import FileError
from kinetostatics.views.report import html
from support.every import every
from support.reports import plain, words

pytestmark = pytest.mark.slow

pytest.importorskip("jinja2")


def test_report_of_scenes_returns_its_path(tmp_path):
    path = ks.report({"press": plain()}, tmp_path / "new" / "press.html", title="Press")
    assert path == tmp_path / "new" / "press.html"
    assert "Press" in words(path.read_text(encoding="utf-8"))
    assert [item.name for item in path.parent.iterdir()] == ["press.html"]


@every("name, message", [
    ("", "is a folder"), ("report.txt", "the ending"), ("no.html/report.html", "no.html is no folder"),
    ("bad\0.html", "is no name of a file"),
])  # fmt: skip
def test_unwritable_report_is_refused_first(name, message, tmp_path, monkeypatch):
    (tmp_path / "no.html").write_text("x", encoding="utf-8")
    monkeypatch.setattr(html, "page", lambda *_: pytest.fail("work was begun"))
    with pytest.raises(ks.KinetostaticsError, match=message):
        ks.report(plain(), f"{tmp_path}/{name}")


@every("options, message", [
    ({"title": " "}, "title must be a text"), ({"title": 3}, "title must be a text"), ({"pdf": "x.html"}, "the ending"),
    ({"variant": "a"}, "variant is for case files"),
])  # fmt: skip
def test_options_that_make_no_sense_are_refused(options, message, tmp_path):
    with pytest.raises(ks.KinetostaticsError, match=message):
        ks.report(plain(), tmp_path / "x.html", **options)


@every("what", [3, None, 1.5, [1, 2], object()])
def test_what_is_neither_case_nor_scene_is_refused(what, tmp_path):
    with pytest.raises(ks.ParameterError, match="report takes a case, the name or path of one, a Scene"):
        ks.report(what, tmp_path / "x.html")


def test_the_case_file_is_not_replaced(tmp_path):
    case = tmp_path / "case.html"
    case.write_text(ks.load_case("chain_unit").path.read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(ks.ParameterError, match="is read as input and would be replaced"):
        ks.report(case, case)


def test_pdf_without_a_browser_is_refused_first(tmp_path, monkeypatch):
    monkeypatch.setattr(html, "BROWSERS", ("no-such-browser",))
    monkeypatch.setattr(html, "page", lambda *_: pytest.fail("work was begun"))
    with pytest.raises(ks.KinetostaticsError, match="none of no-such-browser is installed"):
        ks.report(plain(), tmp_path / "x.html", pdf=tmp_path / "x.pdf")


def test_what_fails_leaves_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "x.html"
    path.write_text("before", encoding="utf-8")
    monkeypatch.setattr(html, "page", lambda *_: sys.exit(3))
    with pytest.raises(SystemExit):
        ks.report(plain(), path)
    assert path.read_text(encoding="utf-8") == "before"
    assert [item.name for item in tmp_path.iterdir()] == ["x.html"]


@every(
    "path, pdf", [(None, None), (3, None), (b"x.html", None), (["x.html"], None), ("x.html", 3), ("x.html", b"y.pdf")]
)
def test_what_is_no_name_of_a_file_is_refused(path, pdf):
    with pytest.raises(ks.ParameterError, match="is no name of a file"):
        ks.report(plain(), path, pdf=pdf)


def test_without_jinja_it_is_said_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    monkeypatch.setattr(html, "page", lambda *_: pytest.fail("work was begun"))
    with pytest.raises(ks.MissingLibraryError, match=r'pip install "kinetostatics\[report\]"'):
        ks.report(plain(), tmp_path / "x.html")


def test_letters_that_no_file_can_hold_are_replaced(tmp_path):
    path = ks.report(plain(), tmp_path / "x.html", title="saw \udcff", command="kinetostatics report \udcff.toml")
    assert "saw ?" in words(path.read_text(encoding="utf-8"))


# Printing


def a_browser(folder, monkeypatch, script):
    path = folder / "chromium"
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(shutil, "which", lambda name: str(path) if name == "chromium" else None)
    page = folder / "page.html"
    page.write_text("<p>page", encoding="utf-8")
    return page


def test_missing_browsers_are_listed(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(
        ks.KinetostaticsError, match=r"none of chromium, .* is installed: install one, or open the report"
    ):
        html.browser()


def test_what_the_browser_prints_is_the_pdf(tmp_path, monkeypatch):
    place = "--print-to-pdf="
    write = f'for word in "$@"; do case $word in {place}*) printf "%%PDF-1.4 x" > "${{word#{place}}}";; esac; done'
    page = a_browser(tmp_path, monkeypatch, write)
    html.print_page(page, tmp_path / "page.pdf")
    assert (tmp_path / "page.pdf").read_bytes() == b"%PDF-1.4 x"


def test_failed_browser_is_reported(tmp_path, monkeypatch):
    page = a_browser(tmp_path, monkeypatch, "echo no display here >&2; exit 7")
    with pytest.raises(FileError, match="ended with status 7 and without a PDF: no display here"):
        html.print_page(page, tmp_path / "page.pdf")
    assert not (tmp_path / "page.pdf").exists()


def test_a_browser_that_does_not_end_is_given_up(tmp_path, monkeypatch):
    page = a_browser(tmp_path, monkeypatch, "exec sleep 30")
    monkeypatch.setattr(html, "BROWSER_TIMEOUT", 0.2)
    with pytest.raises(FileError, match="could not print the report"):
        html.print_page(page, tmp_path / "page.pdf")
