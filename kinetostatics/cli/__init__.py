"""Command line ``kinetostatics COMMAND CASE``; it may import all folders of the package.

``--json`` prints one object: the command, the version, the case, and the results by the names and units of the Python
tables: ``variants.plain.extremes.balancing_torque.largest`` of ``run``, with its ``unit`` beside it. ``--csv`` prints
one table, ``--csv FILE`` writes it as well. Standard output then contains nothing else; progress and warnings go to
standard error, progress only on a terminal and never with ``--json``. Missing folders are made; standard error names
those made for a file.
"""

import os
import signal
import sys
import threading
import warnings
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from ..errors import HintWarning, KinetostaticsError, ParameterError
from ..numbers import files
from ..numbers.output_units import shown_in
from .options import parser
from .output import print_error, wants_csv, wants_json


class _Terminated(BaseException):
    """SIGTERM: the system asks this process to end."""


def main(arguments=None):
    """Run the command line; returns the exit status.

    0, or 2 for unusable input or a sweep whose designs all fail, 130 after Ctrl-C, 143 after SIGTERM.
    """
    status, message = 0, ""
    try:
        with _own_settings():
            if sys.stdout is None:
                raise ParameterError("standard output is closed; open it, or send it to /dev/null")
            for stream in (sys.stdout, sys.stderr):
                if hasattr(stream, "reconfigure"):
                    stream.reconfigure(errors="replace")
            options = parser().parse_args(arguments)
            if wants_json(options) and wants_csv(options):
                raise ParameterError("--json and --csv: both would be written to standard output; give --csv a FILE")
            with _telling_new_folders(options), shown_in(getattr(options, "units", None)):
                module, name = options.command
                getattr(import_module(f"{__name__}.{module}"), name)(options)
            sys.stdout.flush()
    except BrokenPipeError:
        pass
    except KinetostaticsError as error:
        status, message = 2, str(error)
    except OSError as error:
        status, message = 2, files.describe_os_error(error, "standard output")
    except MemoryError as error:
        status, message = 2, f"there is not enough memory; use fewer crank angles or designs ({error})"
    except KeyboardInterrupt:
        status, message = 130, "interrupted"
    except _Terminated:
        status, message = 143, "terminated"
    if status:
        print_error(f"kinetostatics: {message}")
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:  # a closed pipe or full disk: the interpreter must not flush again at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return status


@contextmanager
def _own_settings():
    """Print warnings without the source line, each hint once; SIGTERM raises like Ctrl-C; draw to files.

    Figures use the backend agg instead of a screen backend in MPLBACKEND.
    """
    format_before, told = warnings.formatwarning, set()
    backend_before = None if "matplotlib" in sys.modules else os.environ.get("MPLBACKEND")
    in_main_thread = threading.current_thread() is threading.main_thread()

    def words(message, category, *place):
        if not issubclass(category, UserWarning):
            return format_before(message, category, *place)
        if isinstance(message, HintWarning):
            if message.hint in told:
                return ""
            told.add(message.hint)
        return f"kinetostatics: warning: {message}\n"

    def terminate(*_):
        raise _Terminated

    warnings.formatwarning = words
    if backend_before is not None:
        os.environ["MPLBACKEND"] = "agg"
    handler_before = signal.signal(signal.SIGTERM, terminate) if in_main_thread else None
    try:
        yield
    finally:
        if in_main_thread:
            signal.signal(signal.SIGTERM, handler_before)
        if backend_before is not None:
            os.environ["MPLBACKEND"] = backend_before
        warnings.formatwarning = format_before


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
