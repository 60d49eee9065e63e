"""A solution as a table: rows, units, designs, and every slider in it."""

import numpy as np

import kinetostatics as ks

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_frame_has_a_row_for_each_angle_and_a_unit_in_every_column():
    table = solved().frame()
    assert len(table) == TURN.size
    assert all(name.endswith("]") for name in table.columns)
    np.testing.assert_allclose(table["crank_angle [deg]"], np.arange(0, 360, 15))
    np.testing.assert_array_equal(table["balancing_torque [N m]"], solved().balancing_torque)
    np.testing.assert_array_equal(table["reaction_O_x [N]"], solved().reaction("O")[0])


def test_frame_of_a_batch_numbers_its_designs():
    batch = ks.solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(600)), TURN, crank_speed=33.5)
    table = batch.frame()
    assert len(table) == 2 * TURN.size
    np.testing.assert_array_equal(table["design"], np.repeat([0, 1], TURN.size))
    np.testing.assert_array_equal(table["A_x [m]"], batch.position("A")[0].ravel())


def two_sliders(*labels):
    """A crank that drives a slider of each label."""
    sliders = (ks.SliderGroup(0.4, ks.Guide.at(turn), pin=f"B{turn}", label=label) for turn, label in enumerate(labels))
    return ks.solve(ks.Mechanism("engine", ks.Crank(0.1), tuple(sliders)), ANGLES_OF_SLIDERS, crank_speed=5.0)


ANGLES_OF_SLIDERS = np.linspace(0.1, 6.0, 5)


def test_the_frame_holds_travel_velocity_and_acceleration_of_every_slider_with_units():
    s = two_sliders("1", "2")
    table = s.frame()
    for slider in ("slider1", "slider2"):
        assert np.array_equal(table[f"{slider}_position [m]"], s.travel(slider))
        assert np.array_equal(table[f"{slider}_velocity [m/s]"], s.travel_velocity(slider))
        assert np.array_equal(table[f"{slider}_acceleration [m/s2]"], s.travel_acceleration(slider))
