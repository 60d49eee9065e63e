"""The command that writes reports."""

import stat

import pytest

from kinetostatics.cli import main
from kinetostatics.views.report import html
from support.reports import words

pytestmark = pytest.mark.slow

pytest.importorskip("jinja2")


def test_the_command_writes_the_page_and_tells_of_it(tmp_path, capsys):
    path = tmp_path / "pump.html"
    assert main(["report", "yoke_pump", "--variant", "idle", "--out", str(path)]) == 0
    assert capsys.readouterr().out == f"wrote {path}; open it in a browser\n"
    assert f"kinetostatics report yoke_pump --out {path} --variant idle" in words(path.read_text(encoding="utf-8"))


def test_the_command_prints_to_a_pdf_and_tells_of_both(tmp_path, capsys, monkeypatch):
    browser = tmp_path / "browser"
    place = "--print-to-pdf="
    write = f'for word in "$@"; do case $word in {place}*) printf "%%PDF-1.4 x" > "${{word#{place}}}";; esac; done'
    browser.write_text(f"#!/bin/sh\n{write}\n", encoding="utf-8")
    browser.chmod(browser.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(html, "BROWSERS", (str(browser),))
    page, pdf = tmp_path / "x.html", tmp_path / "x.pdf"
    assert main(["report", "yoke_pump", "--variant", "pumping", "--out", str(page), "--pdf", str(pdf)]) == 0
    assert capsys.readouterr().out == f"wrote {page}; open it in a browser\nwrote {pdf}\n"
    assert pdf.read_bytes().startswith(b"%PDF")


def test_what_is_wrong_ends_in_one_line(tmp_path, capsys):
    assert main(["report", "yoke_pumpp", "--out", str(tmp_path / "x.html")]) == 2
    assert main(["report", "yoke_pump", "--out", str(tmp_path)]) == 2
    assert main(["report", "yoke_pump", "--variant", "idel", "--out", str(tmp_path / "x.html")]) == 2
    told = capsys.readouterr().err
    assert "there is no file and no shipped case of this name" in told
    assert f"{tmp_path} is a folder; give the name of a file in it" in told
    assert "idle" in told
    assert list(tmp_path.iterdir()) == []
