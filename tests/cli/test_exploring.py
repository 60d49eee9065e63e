"""The command that serves the explore page."""

import signal
import socket
import subprocess
import sys
import webbrowser
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

pytest.importorskip("tornado")
from kinetostatics.cli import main
from kinetostatics.cli.options import MAX_PORT
from kinetostatics.views.explore import server
from support.commands import refused
from support.every import every

WRONG = {
    "no case": ([], "give a case, or --new with a mechanism to begin with"),
    "case and mechanism": (["pumpjack", "--new", "chain"], "give a case, or --new"),
    "unknown case": (["pumpjac"], "there is no file and no shipped case of this name"),
    "unknown variant": (["pumpjack", "--variant", "weight"], "did you mean 'weights'?"),
    "no folder": (["pumpjack", "--folder", __file__], f"{__file__} is no folder"),
}


@every("name", WRONG)
def test_wrong_input_ends_in_one_message(name, capsys):
    arguments, message = WRONG[name]
    assert message in refused(["explore", *arguments, "--no-browser"], capsys)


@every("port", ["-1", str(MAX_PORT + 1), "8e3", "", "1" * 50, "٣"])
def test_a_port_that_is_none_is_refused(port, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["explore", "pumpjack", f"--port={port}"])
    assert ended.value.code == 2
    assert f"must be a whole number from 0 (a free port) to {MAX_PORT}" in capsys.readouterr().err


def test_a_port_that_is_taken_is_refused(capsys):
    with socket.socket() as taken:
        taken.bind((server.ADDRESS, 0))
        taken.listen()
        port = taken.getsockname()[1]
        text = refused(["explore", "pumpjack", "--no-browser", "--port", port], capsys)
    assert f"port {port} cannot be used (Address already in use); give another one, or none for a free one" in text


@contextmanager
def exploring(*options):
    """A process that serves the page, and the address that it prints."""
    code = "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler); "  # a background ignores it
    code += "from kinetostatics.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", code, "explore", *options, "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            address, hint = (process.stdout.readline().strip() for _ in range(2))
            assert hint == "Ctrl-C ends the page", process.communicate()
            yield process, address
        finally:
            process.kill()


@pytest.mark.slow
@pytest.mark.parametrize(("number", "status", "word"), [("SIGINT", 130, "interrupted"), ("SIGTERM", 143, "terminated")])
def test_signals_end_it_quietly(number, status, word):
    with exploring("pumpjack") as (process, _):
        process.send_signal(getattr(signal, number))
        assert process.communicate(timeout=60) == ("", f"kinetostatics: {word}\n")
    assert process.returncode == status


@pytest.mark.slow
def test_a_chosen_port_is_that_of_the_address():
    with socket.socket() as free:
        free.bind((server.ADDRESS, 0))
        port = free.getsockname()[1]
    with exploring("--new", "crank-slider", "--port", str(port)) as (_, address):
        assert address.startswith(f"http://127.0.0.1:{port}/#token=")


def test_without_a_browser_it_says_so(monkeypatch):
    def fails(address):
        raise webbrowser.Error("no browser")

    closed = SimpleNamespace(is_closed=lambda: True)
    still = SimpleNamespace(is_closed=lambda: False, call_soon_threadsafe=lambda function, *given: function(*given))
    for found in (lambda address: False, fails):
        monkeypatch.setattr(webbrowser, "open", found)
        with pytest.warns(UserWarning, match="no browser could be opened; open the address in one"):
            server.open_browser("http://127.0.0.1:1/", still)
        server.open_browser("http://127.0.0.1:1/", closed)


@pytest.mark.slow
def test_the_browser_is_opened_by_a_ticket_not_the_token(monkeypatch, capsys):
    """Others on the machine see the arguments of a process."""
    opened = []

    def found(address):
        opened.append(address)
        signal.raise_signal(signal.SIGTERM)
        return True

    monkeypatch.setattr(webbrowser, "open", found)
    assert main(["explore", "pumpjack"]) == 143
    address, hint = capsys.readouterr().out.splitlines()
    assert hint == "Ctrl-C ends the page"
    assert opened[0].partition("=")[0] == address.partition("=")[0]
    assert opened[0] != address
