"""Searches in a process of their own: results of the library's optimiser, live steps, and no process left behind."""

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.views.explore.searching import Search, SearchTask

pytestmark = pytest.mark.slow
SAW = ks.load_case("sawframe_2r63")
CIRCLE = SAW.variants["cam-circle"].scene
VARY = {"spring.stiffness": (6e5, 9e5), "cam.centre.x": (-0.03, -0.01)}
BALANCED = SearchTask(CIRCLE, VARY, "minimise", "rms balancing_torque")
QUICK = BALANCED._replace(vary={"spring.stiffness": (6e5, 9e5)})
LONG = SearchTask(
    SAW.variants["cam-cosine"].scene,
    {
        path: (0.5 * value, 1.5 * value)
        for path, value in SAW.variants["cam-cosine"].scene.parameters.items()
        if value > 0
    },
    "minimise",
    "largest_absolute balancing_torque",
)
PATIENCE = 60.0
"""Seconds for a process on a busy machine."""


def messages(search):
    end, found = time.monotonic() + PATIENCE, []
    while not search.ended:
        assert time.monotonic() < end, "the search does not end"
        message = search.next()
        if message is None:
            time.sleep(0.02)
        else:
            found.append(message)
    return found


def first_step(search):
    end = time.monotonic() + PATIENCE
    while (message := search.next()) is None:
        assert time.monotonic() < end, "the search does not begin"
        time.sleep(0.02)
    assert "step" in message, message
    return message


def alive(process_id):
    """Whether a process runs; one that ended is no longer there, or a zombie that nobody has waited for."""
    try:
        status = Path(f"/proc/{process_id}/stat").read_text()
        return status.rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def wait_for_end(process_id):
    end = time.monotonic() + PATIENCE
    while alive(process_id) and time.monotonic() < end:
        time.sleep(0.02)
    return not alive(process_id)


def test_result_is_that_of_the_library():
    *steps, last = messages(Search(BALANCED))
    found = ks.design.optimise(CIRCLE, VARY, "rms balancing_torque")
    assert last["values"] == found.values
    assert last["goal"] == found.goal
    assert last["active"] == list(found.active)
    (row,) = last["rows"]
    assert row["output"] == "rms balancing_torque"
    assert float(row["after"]) < float(row["before"])
    assert steps
    assert all(step.keys() == {"step", "goal", "unit", "best", "kept"} for step in steps)
    goals = [float(step["goal"]) for step in steps]
    assert goals == sorted(goals, reverse=True)
    assert VARY.keys() == steps[0]["best"].keys()


def test_limits_and_a_reference_are_kept():
    task = QUICK._replace(
        goal="maximise", output="ratio mean_absolute balancing_torque", limits=("largest O <= 15 kN",)
    )
    task = task._replace(reference=SAW.variants["plain"].scene)
    *_, last = messages(Search(task))
    found = ks.design.optimise(CIRCLE, task.vary, maximise=task.output, limits=task.limits, reference=task.reference)
    assert last["values"] == found.values
    assert last["active"] == list(found.active)


@pytest.mark.parametrize(
    ("task", "words"),
    [
        (QUICK._replace(output="largest Q"), "allowed"),
        (QUICK._replace(limits=("largest O <= 1 N",)), "no design that keeps all limits"),
        (BALANCED._replace(vary={"spring.stiffness": (9e5, 6e5)}), "rise"),
        (QUICK._replace(goal="prefer"), "TypeError"),
    ],
)
def test_a_search_that_fails_says_why(task, words):
    *_, last = messages(Search(task))
    assert words in last["problem"]


def test_cancel_leaves_no_process():
    search = Search(LONG)
    first_step(search)
    assert alive(search.process_id)
    search.cancel()
    assert not alive(search.process_id)
    assert messages(search)[-1] == {"cancelled": True}
    search.cancel()


def test_a_search_cancelled_at_once_leaves_no_process():
    search = Search(LONG)
    search.cancel()
    assert not alive(search.process_id)
    assert messages(search)[-1] == {"cancelled": True}


def test_a_killed_process_gives_words():
    search = Search(LONG)
    first_step(search)
    os.kill(search.process_id, signal.SIGKILL)
    assert f"signal {signal.SIGKILL.value}" in messages(search)[-1]["problem"]


SERVER = """
import pickle, sys, time
from kinetostatics.views.explore.searching import Search
if __name__ != "__main__":
    raise SystemExit("the script ran again")
search = Search(pickle.load(open(sys.argv[1], "rb")))
while search.next() is None:
    time.sleep(0.02)
print(search.process_id, flush=True)
time.sleep(600)
"""


def test_a_killed_server_leaves_no_process(tmp_path):
    (tmp_path / "task").write_bytes(pickle.dumps(LONG))
    script = tmp_path / "server.py"
    script.write_text(SERVER)
    command = [sys.executable, str(script), str(tmp_path / "task")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        searching = int(server.stdout.readline())
        assert alive(searching)
        server.kill()
    assert wait_for_end(searching)
