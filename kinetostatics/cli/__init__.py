"""The command line: ``kinetostatics run | compare | drive | plot | report | sweep | design CASE``, and others.

options
    What may be written on the line.
commands, comparing, driving, sweeping, designing, reporting
    What each command does.
printed
    Tables and words for people, as wide as the terminal.
machine
    JSON and CSV for other programs.

``--json`` prints one object: the command, the version, the case, and what the command found, by the names and with the
units of the Python tables: ``variants.plain.extremes.balancing_torque.largest`` of ``run``, in the ``unit`` beside it.
``--csv`` prints one table, ``--csv FILE`` writes it beside what is printed. Nothing else is on standard output then;
progress and warnings go to standard error, progress only on a terminal and never with ``--json``. Folders are made
where they are missing, whatever the option that names them or a file in them; of those for a file standard error tells.
"""

import os
import signal
import sys
import threading
import warnings
from contextlib import contextmanager
from pathlib import Path

from ..errors import HintWarning, KinetostaticsError, ParameterError
from ..numbers import files
from . import machine
from .options import parser
from .output import print_error


class _Terminated(BaseException):
    """The system asks this process to end."""


def main(arguments=None):
    """Run the command line; returns the exit status.

    0, or 2 for input that cannot be used, or where every design of a sweep fails, 130 if it was interrupted (Ctrl-C),
    143 if it was told to end (SIGTERM).
    """
    status, message = 0, ""
    try:
        with _ending_in_order(), _warning_in_plain_words(), _drawing_to_files():
            _require_output()
            options = parser().parse_args(arguments)
            machine.require_one_output(options)
            with _telling_new_folders(options):
                options.command(options)
            sys.stdout.flush()
    except BrokenPipeError:
        pass
    except KinetostaticsError as error:
        status, message = 2, str(error)
    except OSError as error:
        status, message = 2, files.describe_os_error(error, "standard output")
    except MemoryError as error:
        status, message = 2, f"there is not enough memory; take fewer crank angles or designs ({error})"
    except KeyboardInterrupt:
        status, message = 130, "interrupted"
    except _Terminated:
        status, message = 143, "terminated"
    if status:
        print_error(f"kinetostatics: {message}")
    _drop_what_cannot_be_written()
    return status


@contextmanager
def _warning_in_plain_words():
    """A warning meant for the user is told without the line of the library that gives it.

    A hint is told once: where the case is read, and not of its mechanism again when that is solved.
    """
    before = warnings.formatwarning
    told: set[str] = set()

    def words(message, category, *place):
        if not issubclass(category, UserWarning):
            return before(message, category, *place)
        if isinstance(message, HintWarning):
            if message.hint in told:
                return ""
            told.add(message.hint)
        return f"kinetostatics: warning: {message}\n"

    warnings.formatwarning = words
    try:
        yield
    finally:
        warnings.formatwarning = before


@contextmanager
def _ending_in_order():
    """SIGTERM, like Ctrl-C, ends the block as an error does; only the main thread can see to that."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def terminate(*_):
        raise _Terminated

    before = signal.signal(signal.SIGTERM, terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextmanager
def _drawing_to_files():
    """Figures are files, so no backend for a screen is loaded, whatever MPLBACKEND names."""
    before = os.environ.get("MPLBACKEND")
    if before is None or "matplotlib" in sys.modules:
        yield
        return
    os.environ["MPLBACKEND"] = "agg"
    try:
        yield
    finally:
        os.environ["MPLBACKEND"] = before


WRITTEN = ("csv", "name", "out", "pdf", "plot")
"""Options that name a file or a folder to be written."""


@contextmanager
def _telling_new_folders(options):
    """Tell which folders the block makes for files, the outermost of each; one that is asked for is no news."""
    given = [Path(path).absolute() for option in WRITTEN if (path := getattr(options, option, None))]
    missing = [(path, place) for path in given for place in path.parents if not os.path.lexists(place)]
    yield
    outermost = {path: place for path, place in missing if place.exists() and not path.is_dir()}
    for place in dict.fromkeys(outermost.values()):
        print_error(f"made folder {place}")


def _require_output():
    """What is printed has somewhere to go, in letters that it has."""
    if sys.stdout is None:
        raise ParameterError("standard output is closed; open it, or send it to /dev/null")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def _drop_what_cannot_be_written():
    """So that the interpreter does not try again when it ends: the pipe is closed, or the disk full."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
