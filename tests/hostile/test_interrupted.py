"""Ctrl-C and SIGTERM end a command and a call at any time, with a line and their own status."""

import os
import signal
import subprocess
import sys

import pytest

LINES = {signal.SIGINT: (130, "kinetostatics: interrupted\n"), signal.SIGTERM: (143, "kinetostatics: terminated\n")}

WHILE_COMPILED = """
import os, runpy, signal, sys
from llvmlite.binding.executionengine import ExecutionEngine

number = int(sys.argv.pop(1))
found = ExecutionEngine._find_module_ptr

def stopped(*given):
    os.kill(os.getpid(), number)
    return found(*given)

signal.signal(signal.SIGINT, signal.default_int_handler)
ExecutionEngine._find_module_ptr = stopped
"""
"""A signal in a function that LLVM calls while machine code is made."""
MODULE = "runpy.run_module('kinetostatics', run_name='__main__', alter_sys=True)\n"
CALL = """
import kinetostatics as ks

saw = ks.crank_slider(0.3, 2.0, slider=ks.Link(6.0))

def torque():
    return ks.solve(saw, [0.001 * step for step in range(50_000)], crank_speed=3.0, engine="compiled").balancing_torque

try:
    torque()
except KeyboardInterrupt:
    ExecutionEngine._find_module_ptr = found
    print("stopped", len(torque()))
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", LINES)
def test_command_stops_while_compiling(number, saw, numba, tmp_path):
    arguments = ["sweep", saw, "--vary", "slider.mass=600..700 kg:4000", "--variant", "plain", "--output", "rms O"]
    assert ended(WHILE_COMPILED + MODULE, int(number), *arguments, cache=tmp_path) == (*LINES[number], "")


@pytest.mark.slow
def test_interrupted_compilation_can_be_repeated(numba, tmp_path):
    assert ended(WHILE_COMPILED + CALL, int(signal.SIGINT), cache=tmp_path) == (0, "", "stopped 50000\n")


WHILE_LOADED = """
import os, runpy, signal, sys

place = sys.argv.pop(1)

class Stopping:
    def find_spec(self, name, path=None, target=None):
        if name == place:
            os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Stopping())
"""
"""Ctrl-C at the import of a module."""
SCRIPT = "from kinetostatics.__main__ import main; sys.exit(main())"
"""What the installed ``kinetostatics`` does."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("module", "start"),
    [
        *((module, MODULE) for module in ("kinetostatics.cli", "numpy._core._multiarray_umath", "tomllib")),
        *((module, SCRIPT) for module in ("numpy", "kinetostatics.cli.commands")),
    ],
)
def test_command_stops_while_loading_libraries(module, start):
    assert ended(WHILE_LOADED + start, module, "list") == (*LINES[signal.SIGINT], "")


def ended(code, *arguments, cache=None):
    """Status, standard error and standard output of a program."""
    environment = os.environ | ({"KINETOSTATICS_CACHE": str(cache / "programs")} if cache else {})
    command = [sys.executable, "-c", code, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, timeout=60)
    return done.returncode, done.stderr, done.stdout
