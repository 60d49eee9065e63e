"""Printing: by the browser found, with a clear error where there is none or it fails."""

import shutil
import stat

import pytest

import kinetostatics as ks
from kinetostatics.errors import FileError
from kinetostatics.views.report import printing


def a_browser(folder, monkeypatch, script):
    path = folder / "chromium"
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(shutil, "which", lambda name: str(path) if name == "chromium" else None)
    page = folder / "page.html"
    page.write_text("<p>page", encoding="utf-8")
    return page


def test_without_a_browser_it_is_said_which_were_looked_for(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(ks.KinetostaticsError, match=r"none of chromium, .* is found: install one, or open the report"):
        printing.browser()


def test_what_the_browser_prints_is_the_pdf(tmp_path, monkeypatch):
    place = "--print-to-pdf="
    write = f'for word in "$@"; do case $word in {place}*) printf "%%PDF-1.4 x" > "${{word#{place}}}";; esac; done'
    page = a_browser(tmp_path, monkeypatch, write)
    printing.print_page(page, tmp_path / "page.pdf")
    assert (tmp_path / "page.pdf").read_bytes() == b"%PDF-1.4 x"


def test_a_browser_that_prints_nothing_is_told_with_what_it_said(tmp_path, monkeypatch):
    page = a_browser(tmp_path, monkeypatch, "echo no display here >&2; exit 7")
    with pytest.raises(FileError, match="ended with status 7 and without a PDF: no display here"):
        printing.print_page(page, tmp_path / "page.pdf")
    assert not (tmp_path / "page.pdf").exists()


def test_a_browser_that_does_not_end_is_given_up(tmp_path, monkeypatch):
    page = a_browser(tmp_path, monkeypatch, "exec sleep 30")
    monkeypatch.setattr(printing, "PATIENCE", 0.2)
    with pytest.raises(FileError, match="could not print the report"):
        printing.print_page(page, tmp_path / "page.pdf")
