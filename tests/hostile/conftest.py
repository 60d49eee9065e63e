"""Hostile input ends: within ten seconds of computing and a gigabyte, whatever is handed in."""

import resource
import sys
from dataclasses import replace

import pytest

import kinetostatics as ks
from kinetostatics.sweeps import designs
from support.commands import CAM, TEXT
from support.every import limited

SECONDS = 10
BYTES = 10**9


def _memory():
    """Largest memory this process has held, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


@pytest.fixture(scope="session", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    ks.load_case("sawframe_2r63")
    designs.distributions({"a": "0..1 m"})
    pump = ks.Scene(ks.crank_slider(0.1, 0.35, slider=ks.Link(5.0)), 1.0)
    ks.drive.steady(pump, None, 1.0)
    ks.drive.coast(replace(pump, friction={"guide": ks.GuideFriction(0.1)}), 1.0, 0.3, 1.0, until=1e-3)


@pytest.fixture(autouse=True)
def soon_and_small(request):
    """Stops a test, or an input of it, after ten seconds, and fails it for taking a gigabyte.

    One that is marked `slow` or `slow_start` has a minute.
    """
    held = _memory()
    patient = any(map(request.node.get_closest_marker, ("slow", "slow_start")))
    with limited(60 if patient else SECONDS):
        yield
    assert _memory() - held < BYTES


@pytest.fixture
def saw(tmp_path):
    """A case with a table of its own; both must be as they were at the end, with nothing else beside them."""
    case, table = tmp_path / "saw.toml", tmp_path / "saw_precision.csv"
    case.write_text(TEXT, encoding="utf-8")
    table.write_text(CAM, encoding="utf-8")
    yield case
    assert case.read_text(encoding="utf-8") == TEXT
    assert table.read_text(encoding="utf-8") == CAM
    assert not [path for path in tmp_path.rglob("*") if path.name.startswith(".")]


@pytest.fixture
def idle(monkeypatch):
    """Nothing may be solved once the case is read; what is wrong must be seen before."""

    def work(*_, **options):
        raise AssertionError("work began")

    monkeypatch.setattr("kinetostatics.casefile.case.Case.solve", lambda case, name, *_: work(case.variant(name)))
    monkeypatch.setattr("kinetostatics.sweeps.sweeps.dry_run", work)
    monkeypatch.setattr("kinetostatics.studies.stability.study", work)
