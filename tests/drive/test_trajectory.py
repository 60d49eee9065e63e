"""Motion over time: a disc that a constant torque brakes, at any time within it."""

import pytest

import kinetostatics as ks

DISC = ks.Scene(
    ks.Mechanism("disc", ks.Crank(0.1, ks.Link(inertia=3.0)), ()), 1.0, loads=(ks.Torque(-6.0, on="crank"),)
)


@pytest.fixture(scope="module")
def coasting():
    return ks.drive.coast(DISC, 1.0, from_speed=3.0, until="standstill")


def test_it_ends_at_the_standstill_with_the_energy_spent(coasting):
    last = coasting.events[-1]
    assert (last.name, last.time, last.crank_angle) == ("standstill", pytest.approx(2.0), pytest.approx(3.0))
    assert coasting.kinetic_energy == pytest.approx(2.0 * coasting.speed**2, rel=1e-12)
    assert coasting.energy_drift < 1e-9 * 18.0
    assert "standstill" in repr(coasting)


def test_the_table_has_a_row_for_each_time(coasting):
    table = coasting.at(5).frame()
    assert table["time [s]"].tolist() == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0])
    assert table["load_torque [N m]"].tolist() == pytest.approx([6.0] * 5)


def test_times_beyond_the_motion_are_refused(coasting):
    with pytest.raises(ks.ParameterError, match="time must lie between 0 and 2 s"):
        coasting.at([0.0, 2.5])
