"""Command line ``kinetostatics COMMAND CASE``; it may import all rooms.

``--json`` prints one object: the command, the version, the case, and the results by the names and units of the Python
tables: ``variants.plain.extremes.balancing_torque.largest`` of ``run``, with its ``unit`` beside it. ``--csv`` prints
one table, ``--csv FILE`` writes it as well. Standard output then holds nothing else; progress and warnings go to
standard error, progress only on a terminal and never with ``--json``. Missing folders are made; standard error names
those made for a file.
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
    """SIGTERM: the system asks this process to end."""


def main(arguments=None):
    """Run the command line; returns the exit status.

    0, or 2 for unusable input or a sweep whose designs all fail, 130 after Ctrl-C, 143 after SIGTERM.
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
    """Print warnings for users without the source line, and each hint once."""
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
    """SIGTERM ends the block by an exception, as Ctrl-C does; in the main thread only."""
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
    """Draw to files: use the backend agg instead of one for a screen in MPLBACKEND."""
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
"""Options that name a file or folder to write."""


@contextmanager
def _telling_new_folders(options):
    """Print the outermost folders that the block makes for files; not a folder that an option names."""
    given = [Path(path).absolute() for option in WRITTEN if (path := getattr(options, option, None))]
    missing = [(path, place) for path in given for place in path.parents if not os.path.lexists(place)]
    yield
    outermost = {path: place for path, place in missing if place.exists() and not path.is_dir()}
    for place in dict.fromkeys(outermost.values()):
        print_error(f"made folder {place}")


def _require_output():
    """Require an open standard output; replace letters that it lacks."""
    if sys.stdout is None:
        raise ParameterError("standard output is closed; open it, or send it to /dev/null")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def _drop_what_cannot_be_written():
    """Drop output to a closed pipe or full disk, so that the interpreter does not flush it again at its end."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
