"""Search for a flywheel: of machines whose fluctuation is known, too light to run, and never even enough."""

from types import SimpleNamespace

import pytest

from kinetostatics.drive.search import LIGHTEST, flywheel_for
from kinetostatics.errors import DriveError


def machine(least=0.0, own=0.5, floor=0.0):
    """Running whose fluctuation is 1 / (own + flywheel), and which needs some flywheel to run at all."""

    def running_with(inertia):
        if inertia < least:
            raise DriveError("it stalls")
        return SimpleNamespace(fluctuation=max(1.0 / (own + inertia), floor))

    return running_with


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize("least", [0.0, 3.0])
def test_the_flywheel_found_has_the_fluctuation_wherever_the_search_begins(unit, least):
    inertia, running = flywheel_for(0.02, machine(least), unit)
    assert inertia == pytest.approx(49.5, rel=1e-12)
    assert running.fluctuation == pytest.approx(0.02, rel=1e-12)


def test_where_any_flywheel_with_which_it_runs_is_even_enough_the_lightest_is_given():
    inertia, running = flywheel_for(0.5, machine(least=3.0, own=60.0), 8.0)
    assert inertia == pytest.approx(3.0, rel=1e-12)
    assert running.fluctuation < 0.5
    tiny, _ = flywheel_for(0.5, machine(least=1e-9, own=60.0), 8.0)
    assert tiny < 2 * LIGHTEST * 8.0


def test_a_fluctuation_that_no_flywheel_brings_down_is_refused():
    with pytest.raises(DriveError, match=r"flywheel: even \S+ kg m2 do not bring the fluctuation to 0\.02"):
        flywheel_for(0.02, machine(floor=0.1), 1.0)
