"""What all plots share: units by choice, one machine or a mapping of label to machine, machines in a drive."""

import warnings
from functools import cache

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import kinetostatics as ks
from kinetostatics.numbers.formatting import parse_heading
from kinetostatics.numbers.output_units import dimension_name
from support.every import every

UNITS = {"force": "lbf", "length": "inch", "torque": "N cm", "angle": "rad", "power": "hp", "energy": "cal"}
UNITS |= {"angular speed": "rpm", "pressure": "bar", "speed": "cm/s"}
CAM = ks.cams.Circle(0.1, (0.02, 0.0))
LAW = ks.laws.cosine(0.01, 0.05)
FRICTION = {"O": ks.PinFriction(0.02, 0.05), "guide": ks.GuideFriction(0.1)}
MOTOR = ks.drive.Motor.kloss(75e3, 9.9, synchronous_speed=10.47, overload=2.5)


@cache
def saw():
    """A cam-balanced saw with friction."""
    links = {"block": ks.Link(5.0), "coupler": ks.Link(20.0, 0.3, 0.0), "slider": ks.Link(60.0)}
    return ks.Scene(ks.cam_crank_slider(CAM, 0.8, **links), 10.0, loads=[ks.Gravity()], friction=FRICTION)


@cache
def solved():
    return saw().solve(24)


@cache
def driven():
    return ks.drive.steady(saw(), MOTOR, flywheel=50.0)


@cache
def contact(solution):
    return ks.design.contact(solution, 0.02, 0.03, 210e9, 0.3)


ALONE = (
    "acceleration_error cam_force hodographs losses lost_power mass_centres mechanism pressure_angle "
    "principal_points shaking_force torque"
)
"""Plots that need nothing but a solution."""
MACHINE = {name: getattr(ks.plots, name) for name in ALONE.split()} | {
    "contact_pressure": lambda s, **how: ks.plots.contact_pressure(each(contact, s), **how),
    "free_body": lambda s, **how: ks.plots.free_body(s, "coupler", 60, **how),
    "hodograph": lambda s, **how: ks.plots.hodograph(s, "O", **how),
    "over_turn": lambda s, **how: ks.plots.over_turn(s, "slider_position", **how),
    "shares": lambda s, **how: ks.plots.shares(s, "O", **how),
}
"""Plots of a solution."""
OTHERS = {
    "cam_curvature": lambda **how: ks.plots.cam_curvature(CAM, **how),
    "cam_pressure_angle": lambda **how: ks.plots.cam_pressure_angle(CAM, **how),
    "cam_profile": lambda **how: ks.plots.cam_profile({"a": CAM, "b": CAM}, 0.02, **how),
    "crank_speed": lambda **how: ks.plots.crank_speed(driven(), **how),
    "drive_torques": lambda **how: ks.plots.drive_torques({"one": driven(), "two": driven()}, **how),
    "energy_flow": lambda **how: ks.plots.energy_flow(driven(), **how),
    "law_motion": lambda **how: ks.plots.law_motion(LAW, **how),
    "sections": lambda **how: ks.plots.sections(
        solved().sections("coupler", ks.Bar(6e-3, 3e-4, masses=[(0.3, 20.0)])), **how
    ),
    "bearing": lambda **how: ks.plots.bearing(bearing(), **how),
    "rocking_moment": lambda **how: ks.plots.rocking_moment(planes(), **how),
}


def each(function, item):
    return {name: function(one) for name, one in item.items()} if isinstance(item, dict) else function(item)


def bearing():
    with warnings.catch_warnings(action="ignore"):
        return ks.sizing.bearing(solved(), "O", capacity=9e4, static_capacity=9e4)


def planes():
    pump = ks.Mechanism("pump", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(2.0), plane=0.1),))
    return ks.Scene(pump, 20.0).solve(24)


def axes_of(found):
    """All axes of what a plot returns."""
    return found.axes if isinstance(found, Figure) else [ax for ax in np.ravel(found) if isinstance(ax, Axes)]


def shown_units(found):
    """Units of the axes with a dimension that can be chosen, from their labels and titles."""
    texts = [text for ax in axes_of(found) for text in (ax.get_xlabel(), ax.get_ylabel())]
    return {unit for unit in (parse_heading(text)[1] for text in texts) if dimension_name(unit)}


@pytest.mark.slow
@every("name", [*MACHINE, *OTHERS])
def test_axes_have_the_units_that_are_chosen(name):
    plot = (lambda **how: MACHINE[name](solved(), **how)) if name in MACHINE else OTHERS[name]
    found = plot(units=UNITS)
    assert shown_units(found) <= set(UNITS.values())
    assert shown_units(found) or name in ("shaking_force", "cam_curvature", "acceleration_error")
    assert shown_units(plot()) <= {"m", "deg", "N", "kN", "N m", "W", "kW", "MPa", "J", "rad/s"}
    plt.close("all")


def data(ax):
    return np.concatenate([line.get_ydata() for line in ax.lines if len(line.get_ydata()) > 2])


@every(
    ("draw", "unit", "factor"),
    [
        (lambda **how: ks.plots.over_turn(solved(), "slider_position", **how), "inch", 1.0 / 0.0254),
        (lambda **how: ks.plots.hodograph(solved(), "O", **how), "lbf", 1.0 / 4.4482216152605),
        (lambda **how: ks.plots.torque(solved(), **how), "N cm", 100.0),
        (lambda **how: ks.plots.crank_speed(driven(), **how), "rpm", 30.0 / np.pi),
        (lambda **how: ks.plots.law_motion(LAW, **how)[0], "inch", 1.0 / 0.0254),
    ],
)
@pytest.mark.slow
def test_data_are_in_the_units_of_their_axis(draw, unit, factor):
    bare, chosen = draw(), draw(units=UNITS)
    assert parse_heading(chosen.get_ylabel())[1] == unit
    np.testing.assert_allclose(data(chosen), factor * data(bare), rtol=1e-12)
    plt.close("all")


@pytest.mark.slow
def test_ticks_of_a_drawing_are_in_the_unit_of_its_axes(axes):
    """Data stay in m, so that what is drawn on the same axes later fits; without units the ticks are in m again."""
    for units, factor, label in (({"length": "inch"}, 1.0 / 0.0254, "x [inch]"), (None, 1.0, "x [m]")):
        ks.plots.mechanism(solved(), ax=axes, units=units)
        axes.figure.canvas.draw()
        shown = [float(text.get_text().replace("−", "-")) for text in axes.get_xticklabels()]
        assert shown == pytest.approx(factor * axes.get_xticks(), rel=1e-5)
        assert axes.get_xlabel() == label


@pytest.mark.slow
def test_the_axis_of_crank_angles_counts_radians_if_asked_to(axes):
    ks.plots.torque(solved(), ax=axes, units={"angle": "rad"})
    axes.figure.canvas.draw()
    assert axes.get_xlabel() == "crank angle from +x, counter-clockwise [rad]"
    assert [text.get_text() for text in axes.get_xticklabels()][:7] == [*"0123456"]
    assert axes.get_xticks()[6] == pytest.approx(np.degrees(6.0))


def test_units_are_those_of_one_figure_alone():
    with pytest.raises(ks.ParameterError, match="dimension is 'forc'"):
        ks.plots.torque(solved(), units={"forc": "kN"})
    assert "units" in ks.plots.torque.__doc__
    assert ks.plots.hodograph(solved(), "O").get_xlabel() == "reaction O, x [N]"


@pytest.mark.slow
@every("name", MACHINE)
def test_every_plot_draws_one_machine_or_several(name):
    """One of them in a drive, at speeds of its own."""
    several = MACHINE[name]({"even": solved(), "driven": driven().solution})
    assert all(ax.has_data() for ax in axes_of(MACHINE[name](solved())) + axes_of(several))
    texts = " ".join(text.get_text() for ax in axes_of(several) for text in ax.findobj(plt.Text))
    assert name == "mechanism" or ("even" in texts and "driven" in texts)  # those two look alike
    plt.close("all")


def test_numbers_of_a_sketch_are_in_the_units_that_are_chosen(axes):
    ks.plots.sketch(saw().mechanism, ax=axes, units={"length": "cm", "mass": "t", "angle": "rad"})
    texts = " ".join(text.get_text() for text in axes.findobj(plt.Text))
    assert "coupler_length = 80 cm" in texts
    assert "coupler.centre = 30 cm" in texts
    assert "slider.mass = 0.06 t" in texts


@pytest.mark.slow
def test_panels_of_several_machines_go_where_they_are_told(axes):
    named = {"plain": solved(), "again": solved()}
    drawn = ks.plots.free_body(named, "coupler", 60)
    assert [ax.get_title() for ax in drawn] == [f"{name}: coupler at crank angle 60°" for name in named]
    assert ks.plots.lost_power({"alone": solved()}, ax=axes) == [axes]
    with pytest.raises(ks.ParameterError, match="lost_power: ax must be 2 Axes"):
        ks.plots.lost_power(named, ax=axes)
    with pytest.raises(ks.ParameterError, match="shares: there is nothing to draw"):
        ks.plots.shares({}, "O")
    plt.close("all")


def test_principal_points_of_a_solution_count_its_springs():
    sprung = ks.Scene(
        ks.crank_slider(0.1, 0.4, crank=ks.Link(1.0, 0.1), slider=ks.Link(1.0)),
        1.0,
        loads=ks.Spring(1e3, 0.4, mass=1.0),
    ).solve(8)
    bare, whole = (ks.plots.principal_points(item).lines[-1].get_xydata() for item in (sprung.mechanism, sprung))
    assert not np.allclose(bare, whole)
    expected = ks.principal_points(sprung.mechanism, sprung.loads).mass_centre(sprung.at(np.radians([60.0])))
    np.testing.assert_allclose(whole[0], expected[:, 0], rtol=1e-12)
