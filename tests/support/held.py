"""The command line in a process of its own that stands still at a chosen place, until a signal comes."""

import subprocess
import sys
from contextlib import contextmanager

HELD = """
import signal, sys, time
from pkgutil import resolve_name
from kinetostatics.cli import main

owner, name = resolve_name(sys.argv[1]), sys.argv[2]
function = getattr(owner, name)

def held(*given, **options):
    function(*given, **options)
    print("held", flush=True)
    time.sleep(600)

signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's background ignores
setattr(owner, name, held)
sys.exit(main(sys.argv[3:]))
"""


@contextmanager
def held(owner, name, arguments, **options):
    """The process, once `owner.name` was called the first time; it is gone in the end."""
    with subprocess.Popen(
        [sys.executable, "-c", HELD, owner, name, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    ) as process:
        try:
            while (line := process.stdout.readline()) != "held\n":
                assert line, process.communicate()
            yield process
        finally:
            process.kill()
