"""Kernels for the code of pages, forked from one process that has imported the packages that pages need.

Each page has a kernel of its own. Start and imports of a new process would take longer than the code of most pages.
"""

import importlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PACKAGES = ("ipykernel.kernelapp", "matplotlib.pyplot", "matplotlib_inline.backend_inline", "pandas", "kinetostatics")
PATIENCE = 120.0
"""Seconds until the process that forks kernels must have started."""


def serve(path):
    """Fork a kernel for each request at a socket; the end of the kernel closes the connection."""
    kernels, pyplot, *_, ks = map(importlib.import_module, PACKAGES)
    ks.plots.torque(
        ks.Scene(ks.crank_slider(0.1, 0.3, slider=ks.Link(1.0)), 1.0).solve(12)
    )  # imports what figures need
    pyplot.close("all")
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    server = socket.socket(socket.AF_UNIX)
    server.bind(path)
    server.listen(64)
    while True:
        connection, _ = server.accept()
        request = json.loads(connection.makefile().readline())
        if os.fork() == 0:
            server.close()
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            os.chdir(request["folder"])
            os.environ.update(request["environment"])
            sys.argv = ["kernel", *request["arguments"], "--matplotlib=inline"]
            kernels.launch_new_instance()
            os._exit(0)
        connection.close()


def launch(path, *arguments):
    """Request a kernel, and wait for its end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end = time.monotonic() + PATIENCE
    while not Path(path).exists() and time.monotonic() < end:
        time.sleep(0.05)
    with socket.socket(socket.AF_UNIX) as connection:
        connection.connect(path)
        request = {"arguments": arguments, "folder": str(Path.cwd()), "environment": dict(os.environ)}
        connection.sendall(json.dumps(request).encode() + b"\n")
        while connection.recv(1):
            pass


def start(app):
    """Start the process, and make its kernels those of the name "python3"."""
    if app.config.nb_execution_mode == "off" or not hasattr(os, "fork"):
        return
    folder = Path(tempfile.mkdtemp())
    command, path = [sys.executable, __file__], str(folder / "kernels.sock")
    kernel = {"argv": [*command, "launch", path, "-f", "{connection_file}"], "display_name": "python3"}
    (folder / "kernels" / "python3").mkdir(parents=True)
    (folder / "kernels" / "python3" / "kernel.json").write_text(json.dumps(kernel | {"language": "python"}))
    os.environ["JUPYTER_PATH"] = os.pathsep.join([str(folder), os.environ.get("JUPYTER_PATH", "")])
    environment = os.environ | {"MPLBACKEND": "agg"}
    quiet = subprocess.DEVNULL
    server = subprocess.Popen([*command, "serve", path], env=environment, stdout=quiet, stderr=quiet)
    app.connect("build-finished", lambda *_: (server.kill(), server.wait(), shutil.rmtree(folder)))


def setup(app):
    """Start it before pages are read."""
    app.connect("builder-inited", start)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    {"serve": serve, "launch": launch}[sys.argv[1]](*sys.argv[2:])
