"""Whatever the output takes, and whatever stops a command, it ends in a line."""

import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.commands import held


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "utf-8"])
def test_unencodable_output_is_replaced(saw, encoding, monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding, errors="strict"))
    assert main(["run", str(saw), "--variant", "plain", "--angles", "8"]) == 0
    title = raw.getvalue().decode(encoding).splitlines()[0]
    assert title == ks.load_case(saw).title.encode(encoding, "replace").decode(encoding)


def test_errors_with_unencodable_letters_are_printed(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(raw, encoding="ascii", errors="strict"))
    assert main(["run", "säge"]) == 2
    sys.stderr.flush()
    assert raw.getvalue().startswith(b"kinetostatics: s?ge: 1 problem")


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_closed_streams_cause_no_traceback(saw, stream, monkeypatch, capsys):
    monkeypatch.setattr(sys, stream, None)
    assert main(["run", str(saw), "--variant", "plan"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == (
        "kinetostatics: standard output is closed; open it, or send it to /dev/null\n" if stream == "stdout" else ""
    )


COMMAND = [sys.executable, "-m", "kinetostatics"]


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_full_disk_is_told_in_a_line(saw):
    with open("/dev/full", "w") as full:  # noqa: PTH123
        command = [*COMMAND, "run", saw, "--variant", "plain", "--angles", "8"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == "kinetostatics: standard output: No space left on device\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("how", "status", "word"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_stopped_sweep_says_so_and_leaves_no_process(saw, how, status, word):
    """The signal goes to all its processes, as from a terminal, when one part is written and others wait."""
    vary = ["--vary", "slider.mass=600..700 kg:60000", "--variant", "plain", "--angles", "48", "--output", "rms O"]
    arguments = ["sweep", saw, *vary, "--workers", "1", "--out", saw.parent / "out"]
    with held("kinetostatics.sweeps.dataset:Dataset", "keep", arguments, start_new_session=True) as process:
        os.killpg(process.pid, how)
        assert process.communicate()[1] == f"kinetostatics: {word}\n"
        assert process.returncode == status
        assert_gone(process.pid)


def assert_gone(group):
    """No process of the group is left, soon; the fixture `soon_and_small` says how soon."""
    while True:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
