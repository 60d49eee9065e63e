"""Optimisation of a scene in a process of its own, so that the page answers while it runs.

The process imports the library afresh and reads a task from its standard input. It ends when that pipe closes, so also
when the server is killed. Its answers are lines of JSON.
"""

import contextlib
import json
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
import traceback
import warnings
from typing import Any, NamedTuple

from ...design.constraints import parse_output
from ...design.optimisation import optimise
from ...design.search import LIMIT_TOLERANCE
from ...errors import KinetostaticsError
from ...numbers import checks
from ...numbers.formatting import number, parse_heading, pretty_unit
from ..canvas import display_unit

REPORT_INTERVAL = 0.1
"""Least time between two reports of the process, s."""
END_TIME = 5.0
"""Time in which a cancelled process must end, s; then it is killed."""
NICENESS = 10
"""Lower priority of the process, so that drags are answered first."""
GOALS = ("minimise", "maximise")
COMMAND = (
    "import sys, pickle; sys.path[:] = pickle.load(sys.stdin.buffer); "
    f"from {__name__} import work; work(sys.stdin.buffer)"
)
"""Program of the process: modules are found where the caller finds them."""


class SearchTask(NamedTuple):
    """Arguments of `ks.design.optimise`: `goal` is "minimise" or "maximise", `output` a text."""

    scene: Any
    vary: dict[str, tuple[float, float]]
    goal: str
    output: str
    limits: tuple[str, ...] = ()
    reference: Any = None

    def run(self, progress):
        """The `Found` of the search."""
        goal = {self.goal: self.output}
        return optimise(self.scene, self.vary, **goal, limits=self.limits, reference=self.reference, progress=progress)


class Search:
    """A running search.

    Messages are dicts. Those with "step" have the number of steps and the best design so far. The last one has the
    "values" of the result, a "problem" as a sentence, or "cancelled".
    """

    def __init__(self, task: SearchTask):
        from cloudpickle import dumps

        self._messages: queue.SimpleQueue[dict] = queue.SimpleQueue()
        self._cancelled = self.ended = False
        self._process: Any = subprocess.Popen(
            [sys.executable, "-c", COMMAND], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        given = pickle.dumps(sys.path) + dumps(task)
        threading.Thread(target=self._listen, args=(given,), daemon=True).start()

    @property
    def process_id(self):
        """Number of the process for the operating system."""
        return self._process.pid

    def _listen(self, given):
        """Send the task, then read messages until the process ends."""
        last: dict = {}
        with contextlib.suppress(OSError, ValueError), self._process as process:  # it may end at any time
            process.stdin.write(given)
            process.stdin.flush()
            for line in process.stdout:
                last = json.loads(line)
                self._messages.put(last)
        code = self._process.wait()
        if self._cancelled:
            self._messages.put({"cancelled": True})
        elif not {"values", "problem"} & last.keys():
            how = f"by signal {-code}" if code < 0 else f"with code {code}"
            self._messages.put({"problem": f"the process of the search ended {how}; start the search again"})

    def next(self):
        """The next message, None if there is none yet; `ended` is true after the last one."""
        try:
            found = self._messages.get_nowait()
        except queue.Empty:
            return None
        self.ended = "step" not in found
        return found

    def cancel(self):
        """End the process, at once."""
        self._cancelled = True
        if self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(END_TIME)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()


def answers(session, request):
    """Messages of the search of a request, one a step; None while there is none. Closing it ends the process."""
    reference = request.get("reference")
    wrong = {path: ends for path, ends in request["vary"].items() if not isinstance(ends, list) or len(ends) != 2}
    checks.require(
        "explore",
        checks.choice("goal", request["goal"], GOALS),
        *(f"{path} must vary between [low, high], got {checks.shown(ends)}" for path, ends in wrong.items()),
    )
    task = SearchTask(
        session.scene(request["state"]),
        {path: tuple(ends) for path, ends in request["vary"].items()},
        request["goal"],
        request["output"],
        tuple(request.get("limits", ())),
        None if reference is None else session.scene(reference),
    )
    search = session.search = Search(task)
    try:
        while not search.ended:
            yield search.next()
    finally:
        search.cancel()


def cancel(session, request):
    """End the search of a session, if one runs."""
    if session.search is not None:
        session.search.cancel()
    return {}


class _Reporter:
    """Best design so far of the steps of a search, reported at intervals."""

    def __init__(self, task, send):
        self.task, self.send, self.count, self.best, self.sent = task, send, 0, None, 0.0
        _, self.unit = parse_heading(parse_output(task.output, task.scene).column)

    def __call__(self, step):
        self.count += 1
        sign = 1.0 if self.task.goal == "minimise" else -1.0
        rank = (step.missed, 0.0) if step.missed > LIMIT_TOLERANCE else (0.0, sign * step.goal)
        if self.best is None or rank < self.best[0]:
            self.best = rank, step
        if time.monotonic() - self.sent >= REPORT_INTERVAL:
            self.sent, best = time.monotonic(), self.best[1]
            kept = best.missed <= LIMIT_TOLERANCE
            factor, unit = display_unit(self.unit, [[best.goal]])
            goal = {"goal": number(factor * best.goal), "unit": pretty_unit(unit)}
            self.send({"step": self.count, "best": best.values, "kept": kept} | goal)


def work(given):
    """The process: run the task that it is given, and write messages; it ends when its input closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server decides
    out = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what a user's function prints is no message

    def send(message):
        out.write(json.dumps(message) + "\n")
        out.flush()

    def end_with_server():
        given.read()
        os._exit(1)

    if hasattr(os, "nice"):
        os.nice(NICENESS)
    try:
        task = pickle.load(given)
        threading.Thread(target=end_with_server, daemon=True).start()
        with warnings.catch_warnings(record=True) as caught:
            found = result(task.run(_Reporter(task, send)))
        send(found | {"notes": list(dict.fromkeys(str(item.message) for item in caught))})
    except KinetostaticsError as error:
        send({"problem": str(error)})
    except Exception as error:
        traceback.print_exc()
        send({"problem": f"the search failed: {type(error).__name__}: {error}"})


def result(found):
    """Message of a `Found`: values in SI, and the outputs before and after as texts with units."""
    rows = []
    for heading, row in found.report().iterrows():
        name, unit = parse_heading(heading)
        factor, shown = display_unit(unit, [[row["before"], row["after"]]])
        before, after = (number(factor * row[column]) for column in ("before", "after"))
        rows.append({"output": name, "unit": pretty_unit(shown), "before": before, "after": after})
    return {"values": found.values, "goal": found.goal, "active": found.active, "rows": rows}
