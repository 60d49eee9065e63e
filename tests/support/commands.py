"""Commands with their output, commands that are refused, and commands stopped in a process of their own."""

import math
import subprocess
import sys
from contextlib import contextmanager

from kinetostatics.cli import main

TEXT = """
title = "Säge, пила, 鋸"
reference = "plain"
[common]
crank_speed = "60 rpm"
coupler_length = "2 m"
slider = { mass = "600 kg" }
[variants.plain]
mechanism = "crank-slider"
crank_length = "0.3 m"
[variants.cam]
mechanism = "cam-crank-slider"
cam = { kind = "sampled", table = "saw_precision.csv" }
"""
CAM = "\n".join(["angle [deg], radius [m]", *(f"{a}, {0.3 + 0.01 * math.cos(math.radians(a))}" for a in range(360))])
VARY = ["--vary", "slider.mass=600..700 kg:2"]


def printed_by(arguments, capsys):
    """Standard output of a command, which ends well."""
    assert main([str(item) for item in arguments]) == 0
    return capsys.readouterr().out


def refused(arguments, capsys):
    """The one error that a command ends with."""
    status = main([str(item) for item in arguments])
    captured = capsys.readouterr()
    assert (status, captured.out) == (2, "")
    assert captured.err.startswith("kinetostatics: ")
    assert "Traceback" not in captured.err
    return captured.err


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
