"""Curves over the crank angle and their marks."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.animation import FuncAnimation, PillowWriter

import kinetostatics as ks
from kinetostatics.casefile.starters import starter
from kinetostatics.mechanics.load_values import user_value
from kinetostatics.mechanics.quantities import values
from kinetostatics.views import figures
from kinetostatics.views.canvas import with_peaks
from support.every import every

PLOTS = {
    "torque": ks.plots.torque,
    "cam_force": ks.plots.cam_force,
    "pressure_angle": ks.plots.pressure_angle,
    "acceleration_error": ks.plots.acceleration_error,
    "hodograph": ks.plots.hodograph,
    "shaking": lambda s, ax: ks.plots.hodograph(s, "shaking_force", ax=ax),
    "mechanism": ks.plots.mechanism,
}


@pytest.fixture(scope="module")
def saw():
    case = ks.load_case("sawframe_2r63")
    return {name: case.solve(name, angles=360) for name in ("plain", "cam-circle", "cam-cosine")}


@pytest.mark.slow
@pytest.mark.parametrize("name", PLOTS)
def test_plot_returns_the_given_axes(name, saw, axes):
    open_figures = plt.get_fignums()
    assert PLOTS[name](saw["cam-circle"], ax=axes) is axes
    assert plt.get_fignums() == open_figures
    assert all("[" in label for label in (axes.get_xlabel(), axes.get_ylabel()))
    axes.figure.canvas.draw()


def test_torque_curves_hold_the_solutions_numbers(saw, axes):
    ks.plots.torque({name: saw[name] for name in ("plain", "cam-cosine")}, ax=axes)
    curves = {line.get_label(): line.get_data() for line in axes.lines if not line.get_label().startswith("_")}
    assert axes.get_ylabel() == "balancing torque [kN m]"
    for name, (degrees, curve) in curves.items():
        assert np.isin(np.degrees(saw[name].crank_angle), degrees).all()
        torque = saw[name].at(np.radians(degrees)).balancing_torque
        np.testing.assert_allclose(1000 * curve, torque, atol=1e-12 * np.abs(torque).max())
        found = ks.extremes(saw[name], "balancing_torque").value
        assert [1000 * curve.max(), 1000 * curve.min()] == pytest.approx([found.max(), found.min()], rel=1e-14)
    assert len(curves) == 2


def test_acceleration_error_is_0_or_2_percent(saw, axes):
    ks.plots.acceleration_error({name: saw[name] for name in ("cam-cosine", "cam-circle")}, ax=axes)
    exact, circle = (np.abs(line.get_ydata()).max() for line in axes.lines[:2])
    assert exact < 1e-11
    assert 2.0 < circle < 2.2


def test_hodograph_is_closed_with_equal_scales(saw, axes):
    ks.plots.hodograph(saw["plain"], "O", ax=axes, marks=90)
    x, _ = axes.lines[0].get_data()
    assert axes.get_aspect() == 1
    assert x[0] == x[-1]
    assert np.max(np.abs(x)) == pytest.approx(286.77, abs=0.01)
    assert {text.get_text() for text in axes.texts} == {"0°", "90°", "180°", "270°"}


def test_mechanism_is_drawn_where_the_solution_puts_it(saw, axes):
    ks.plots.mechanism(saw["plain"], angles=(30,), ax=axes)
    ends = saw["plain"].at(np.radians([30.0])).position("B")
    assert any(np.allclose(line.get_xydata()[-1], ends[:, 0]) for line in axes.lines if len(line.get_xdata()) == 2)


@pytest.mark.slow
def test_animation_is_saved_as_gif(saw, axes, tmp_path):
    film = ks.plots.animation(saw["cam-circle"], joints=("O", "A", "guide"), frames=4, ax=axes)
    assert isinstance(film, FuncAnimation)
    film.save(tmp_path / "saw.gif", writer=PillowWriter(fps=10))
    assert (tmp_path / "saw.gif").read_bytes().startswith(b"GIF8")


def test_hodograph_marks_stand_at_their_angles(saw, axes):
    ks.plots.hodograph(saw["plain"], "O", ax=axes, marks=90)
    marks = np.array(axes.lines[1].get_data())
    expected = saw["plain"].at(np.radians([0, 90, 180, 270])).reaction("O") / 1000
    np.testing.assert_allclose(marks, expected, rtol=1e-12)


def test_pressure_angle_is_drawn_in_degrees(saw, axes):
    ks.plots.pressure_angle(saw["cam-circle"], ax=axes)
    s = with_peaks({"": saw["cam-circle"]}, "pressure_angle")[""]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), np.degrees(s.pressure_angle))
    assert "[deg]" in axes.get_ylabel()


def test_slotted_crank_passes_through_the_block(saw, axes):
    ks.plots.mechanism(saw["cam-circle"], angles=(50,), ax=axes)
    pin = saw["cam-circle"].at(np.radians([50.0])).position("A")[:, 0]
    lines = (line.get_xydata() for line in axes.lines)
    crank = next(line for line in lines if np.allclose(line[0], 0) and len(line) == 2)
    assert np.allclose(crank[1] / np.hypot(*crank[1]), pin / np.hypot(*pin))
    assert np.hypot(*crank[1]) > np.hypot(*pin)


def test_inclined_cosine_law_has_no_error(axes):
    law = ks.cams.CosineLaw(0.3, 2.0, 0.5)
    turn = np.linspace(0, 2 * np.pi, 90)
    machine = ks.cam_crank_slider(law, law.coupler_length, guide_angle=0.5)
    ks.plots.acceleration_error(ks.solve(machine, turn, crank_speed=9.0, crank_acceleration=20.0), ax=axes)
    assert np.max(np.abs(axes.lines[0].get_ydata())) < 1e-11


def test_a_batch_is_refused_with_its_shape(axes):
    batch = ks.solve(ks.crank_slider(np.array([[0.1], [0.2]]), 0.5), [0.0, 1.0], crank_speed=1.0)
    with pytest.raises(ks.ParameterError, match=r"shape \(2, 2\)"):
        ks.plots.torque(batch, ax=axes)


def test_shorter_period_is_repeated(axes):
    twin = ks.load_case("v_twin")
    ks.plots.torque({name: twin.solve(name, 72) for name in ("plain", "firing")}, ax=axes)
    angle, torque = axes.lines[0].get_data()
    assert angle.max() > 710.0
    np.testing.assert_allclose(np.interp(360.0 + angle[:50], angle, torque), torque[:50], rtol=1e-12)


def test_coincident_marks_share_a_label(axes):
    def press(motion):
        return np.where(np.abs(np.degrees(motion.crank_angle) - 170) < 10.1, 40e3, 0.0)

    machine = ks.crank_slider(0.08, 0.4, slider=ks.Link(25))
    solution = ks.Scene(machine, 4 * np.pi, loads=ks.ProcessForce(press)).solve(360)
    ks.plots.hodograph(solution, "O", ax=axes)
    assert {text.get_text() for text in axes.texts} == {"0°, 30° … 330°", "180°"}


@pytest.mark.parametrize(("turns", "ticks"), [(1, [0, 90, 180, 270, 360]), (2, [0, 180, 360, 540, 720])])
def test_angle_axis_has_ticks_at_quarters(axes, turns, ticks):
    load = ks.ProcessForce(-100.0, period=2 * np.pi * turns)
    machine = ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0))
    ks.plots.torque(ks.Scene(machine, 10.0, loads=load).solve(48 * turns), ax=axes)
    assert list(axes.get_xticks()) == ticks
    assert axes.get_xlim() == (0, ticks[-1])


@pytest.mark.parametrize(("case", "relative"), [("chain_unit", True), ("four-bar", False)])
def test_only_a_chain_unit_has_figures_of_its_study(tmp_path, case, relative):
    if case == "four-bar":
        path = tmp_path / "bars.toml"
        path.write_text(starter("four-bar", "bars"))
        case = path
    drawn = figures.figures_of(ks.load_case(case))
    assert ("rocker_velocity" in drawn) == relative
    assert "mechanism" in drawn


@pytest.mark.slow
@pytest.mark.parametrize("angle", [0.0, 1.5707963267948966])
def test_mechanisms_fill_their_panels(angle):
    machine = ks.crank_slider(0.1, 0.4, guide_angle=angle, slider=ks.Link(1.0))
    solution = ks.Scene(machine, 10.0).solve(24)
    for draw in (figures._overview, figures._mechanisms):
        figure = draw({"a": solution, "b": solution})
        figure.draw_without_rendering()
        ax = figure.axes[0]
        shares = [
            np.ptp(data) / np.ptp(seen)
            for data, seen in ((ax.dataLim.intervalx, ax.get_xlim()), (ax.dataLim.intervaly, ax.get_ylim()))
        ]
        plt.close(figure)
        assert min(shares) > 0.6


SHAPES = {
    "tall": ks.crank_slider(0.1, 0.4, guide_angle=1.57),
    "square": ks.four_bar(0.1, 0.3, 0.3, rocker_pivot=(0.3, 0.1), coupler=ks.Link(1.0)),
    "wide": ks.crank_slider(0.1, 0.5),
}


@pytest.mark.slow
@pytest.mark.parametrize(("shape", "variants"), [(shape, 1 + place) for place, shape in enumerate(SHAPES)])
def test_overview_has_its_panels_at_any_size(shape, variants):
    solution = ks.Scene(SHAPES[shape], 10.0, loads=ks.Gravity()).solve(24)
    figure = figures._overview({str(number): solution for number in range(variants)})
    plt.close(figure)
    titles = [ax.get_title() for ax in figure.axes]
    assert len(titles) == 2 + min(variants, 2)
    assert titles[1] == "torque the drive must give"


# Curves hold the extremes that tables print, kinks and both sides of jumps, and stay as solved where none is known

PRESS = ks.crank_slider(0.1, 0.4, coupler=ks.Link(2.0, 0.2, 0.03), slider=ks.Link(3.0))
TURN = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)
TABLES = {
    "narrow peak": ks.Table([0.3, 0.41, 0.42, 0.421, 0.5], [0.0, 0.0, 5e4, 0.0, 0.0], over="travel"),
    "jump": ks.Table([0.3, 0.5], [-4e3, -4e3], over="travel", back=[0.0, 0.0]),
    "kinks": ks.Table([0.0, 1.03, 2.07, 4.0, 2 * np.pi], [0.0, 3e3, 0.0, 0.0, 0.0]),
    "nothing": 200.0,
}


def solved(force=0.0, angles=TURN):
    return ks.solve(PRESS, angles, crank_speed=5.0, loads=[ks.Gravity(), ks.ProcessForce(force)])


@every("name", TABLES)
@pytest.mark.parametrize("quantity", ["balancing_torque", "O", "slider_acceleration"])
def test_a_curve_reaches_as_far_as_the_table_says(name, quantity):
    s = solved(TABLES[name])
    found, curve = ks.extremes(s, quantity), values(with_peaks({"": s}, quantity)[""], quantity)
    assert [curve.min(), curve.max()] == pytest.approx([found.value.min(), found.value.max()], rel=1e-12)


def test_curve_points_are_its_table():
    s = with_peaks({"": solved(TABLES["narrow peak"])}, "balancing_torque")[""]
    load, dense = s.loads[1], np.linspace(0.0, 2 * np.pi, 20001)
    drawn = np.interp(dense, s.crank_angle, user_value(load, s), period=2 * np.pi)
    assert np.abs(drawn - user_value(load, s.at(dense))).max() < 1e-2 * 5e4


def test_both_sides_of_a_jump_are_drawn():
    s = with_peaks({"": solved(TABLES["jump"])}, "balancing_torque")[""]
    near = np.abs(s.crank_angle - np.pi) < 1e-12
    assert {-4e3, 0.0} <= set(user_value(s.loads[1], s)[near])


def test_curves_drawn_together_share_their_angles():
    first, second = with_peaks({"a": solved(), "b": solved(TABLES["kinks"])}, "balancing_torque").values()
    np.testing.assert_array_equal(first.crank_angle, second.crank_angle)
    assert first.crank_angle.size > TURN.size
    assert np.isin(TURN, first.crank_angle).all()


@every(("angles", "count"), [
    (np.linspace(2.0, 4.0, 11), 1), (np.linspace(-np.pi, np.pi, 37), 4), (np.linspace(0.0, 4 * np.pi, 73), 8),
    (TURN + 6.0, 4), (TURN + 2 * np.pi, 4),
])  # fmt: skip
def test_extremes_stand_wherever_the_curve_comes_by(angles, count):
    s = with_peaks({"": solved(angles=angles)}, "balancing_torque")[""]
    more = s.crank_angle[~np.isin(s.crank_angle, angles)]
    assert more.size == count
    assert angles[0] < more.min()
    assert more.max() < max(angles[-1], angles[0] + 2 * np.pi)
    places = ks.extremes(s, "balancing_torque").angle
    assert np.abs(np.mod(more, 2 * np.pi)[:, None] - places).min(axis=1).max() < 1e-9


def test_unknown_between_angles_is_kept():
    falling, one = solved(angles=TURN[::-1]), solved(angles=0.5)
    given = solved(1e3 * np.sin(TURN))
    odd = solved(lambda motion: 10.0 * motion.crank_angle)  # does not repeat after a turn
    for s in (falling, one, given, odd):
        assert with_peaks({"": s}, "O")[""] is s
