"""Tables by crank angle and travel: what they give to any load, their derivatives, kinks and jumps, and CSV files."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.machines import largest
from support.scenes import six_bar

PUMP = ks.crank_slider(0.05, 0.2)
X = [0.15, 0.21, 0.25]
DIAGRAM = ks.Table(X, [-900.0, -400.0, -100.0], over="travel", back=[-1500.0, -700.0, -800.0])
ANGLES = np.linspace(0.05, 6.2, 40)


def solved(table, angles=ANGLES, speed=100.0, **options):
    return ks.solve(PUMP, angles, crank_speed=speed, loads=ks.ProcessForce(table), **options)


@every("speed", [100.0, -100.0])
def test_diagram_follows_the_current_stroke(speed):
    s = solved(DIAGRAM, speed=speed)
    forward, back = (np.interp(s.slider_position, X, values) for values in (DIAGRAM.y, DIAGRAM.back))
    expected = np.where(s.slider_velocity < 0, back, forward)
    assert largest(s.reaction("B")[0] - -expected) < 1e-12 * 1500
    assert s.power_residual < 1e-14


def test_extreme_is_on_its_side_of_a_jump():
    """Mass and weight are absent, so the axial force of the rod is that of the diagram."""

    def axial(solution):
        return solution.reaction("B")[0]

    found = ks.extremes(solved(DIAGRAM, [1.0]), axial)
    assert found.range == pytest.approx((100.0, 1500.0), rel=1e-12)
    peak = found.angle[np.argmax(found.value)]
    assert peak == pytest.approx(np.pi, abs=1e-6)
    assert found.value[np.abs(found.angle) < 1e-6] == pytest.approx([800.0], rel=1e-9)


def test_mean_torque_is_the_work_of_both_strokes():
    by_hand = sum(np.trapezoid(np.abs(values), X) for values in (DIAGRAM.y, DIAGRAM.back)) / (2 * np.pi)
    s = solved(DIAGRAM)
    assert ks.compare(s, s).mean_torques[0] == pytest.approx(by_hand, rel=1e-13)


def test_derivatives_go_through_the_travel_of_a_table():
    program = ks.compile(ks.Scene(PUMP, 100.0, 0.0, ks.ProcessForce(DIAGRAM)), "balancing_torque", engine="numpy")
    angles, step = ANGLES[(ANGLES > 0.3) & (np.abs(ANGLES - np.pi) > 0.3)], 1e-7
    exact = program.derivatives(angles, "crank_length")["balancing_torque"]["crank_length"]
    above, below = (program(angles, {"crank_length": 0.05 + k * step})["balancing_torque"] for k in (0, -1))
    assert largest(exact - (above - below) / step) < 1e-4 * largest(exact)


@pytest.mark.slow
@every("over", ["angle", "travel"])
def test_any_load_takes_a_table(over):
    x, y = ([0.0, 2.0, 4.0], [1.0, 5.0, 2.0]) if over == "angle" else ([-2.0, 0.5, 2.0], [1.0, 5.0, 2.0])
    table = ks.Table(x, y, over=over)
    for item in (
        ks.Force(table, at=("coupler", 0.1), direction=0.3),
        ks.Torque(table, on="rocker"),
        ks.PointForce(table, between=("B", (0.1, 0.9))),
    ):
        s = ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=item)
        place = ANGLES if over == "angle" else s.travel("slider2")
        values = np.interp(place, x, y, period=2 * np.pi if over == "angle" else None)
        fixed = {item.VALUE: values}
        from dataclasses import replace

        other = ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=replace(item, **fixed))
        assert largest(s.balancing_torque - other.balancing_torque) < 1e-13 * s.largest_torque_term
        assert s.condition.shape == ANGLES.shape
        assert len(ks.extremes(s, "balancing_torque"))


def test_a_four_stroke_table_gives_a_force_its_period():
    table = ks.Table(np.radians([0, 180, 360, 540]), [0.0, 5.0, 0.0, 0.0], period=4 * np.pi)
    s = ks.solve(six_bar(), [1.0], crank_speed=9.0, loads=ks.Force(table, at="B"))
    assert s.period == 4 * np.pi
    assert not np.allclose(s.at(1.0).balancing_torque, s.at(1.0 + 2 * np.pi).balancing_torque)


def test_travel_beyond_the_table_names_both_ranges():
    table = ks.Table([0.15, 0.24], [1.0, 2.0], over="travel")
    with pytest.raises(ks.ParameterError, match=r"slider goes from 0.15\d* to 0.249\d* m.* from 0.15 to 0.24 m.*deg"):
        _ = solved(table).balancing_torque


def test_table_names_one_of_two_sliders():
    engine = ks.Mechanism("V", ks.Crank(0.05), (ks.SliderGroup(0.2), ks.SliderGroup(0.2, pin="C", label="2")))
    table = ks.Table(X, [1.0, 2.0, 3.0], over="travel")
    with pytest.raises(ks.ParameterError, match="sliders 'slider', 'slider2': choose one"):
        ks.Scene(engine, 1.0, 0.0, ks.Torque(table, on="crank"))
    with pytest.raises(ks.ParameterError, match="table over travel: slider is 'slider3', allowed: 'slider'"):
        ks.Scene(engine, 1.0, 0.0, ks.Torque(ks.Table(X, X, over="travel", slider="slider3"), on="crank"))
    with pytest.raises(ks.ParameterError, match="the mechanism has no slider"):
        ks.Scene(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), 1.0, 0.0, ks.Torque(table, on="crank"))
    s = ks.solve(engine, [1.0], crank_speed=1.0, loads=ks.ProcessForce(table, on="slider2"))
    assert s.reaction("C")[0, 0] == pytest.approx(-np.interp(s.travel("slider2")[0], X, [1.0, 2.0, 3.0]))


# From files


def written(folder, text):
    path = folder / "table.csv"
    path.write_text(text)
    return path


def test_indicator_diagram_is_times_the_area(tmp_path):
    text = "travel [mm], pressure [bar], pressure_back [MPa]\n150, 9, 1.5\n210, 4, 0.7\n250, 1, 0.8\n"
    table = ks.Table.from_csv(written(tmp_path, text), area=-1e-3)
    assert table.x == pytest.approx(X)
    assert table.y == pytest.approx(DIAGRAM.y)
    assert table.back == pytest.approx(DIAGRAM.back)


def two_turns(back):
    """A slider on a rocker whose branch closes after two turns, under a table over its travel; and the table."""
    bars = ks.RockerGroup(0.3, 0.2, (0.4, 0.0), "open")
    ram = ks.SliderGroup(0.7, ks.Guide.at(0.3, 0.05), on="B", pin="C", label="2")
    mechanism = ks.Mechanism("two turns", ks.Crank(0.1), (bars, ram))
    travel = ks.Scene(mechanism, 1.0).solve(720).travel("slider2")
    rows = np.linspace(travel.min() - 0.01, travel.max() + 0.01, 9)
    force = np.array([0.0, 50, -20, 80, 10, 0, 90, -60, 30])
    table = ks.Table(rows, force, over="travel", back=force[::-1] if back else None)
    return ks.Scene(mechanism, 1.0, 0.0, ks.ProcessForce(table, "slider2")), table


@pytest.mark.slow
@every("back", [False, True])
def test_second_turn_of_a_branch_is_known(back):
    """Work and peaks of both turns, beside values at many crank angles by hand."""
    scene, table = two_turns(back)
    s = scene.solve(40_000)
    x, v = s.travel("slider2"), s.travel_velocity("slider2")
    torque = -v * np.where(
        v < 0, np.interp(x, table.x, table.y[::-1] if back else table.y), np.interp(x, table.x, table.y)
    )
    rounded = np.spacing(x.max()) * np.max(np.abs(np.diff(table.y) / np.diff(table.x))) * largest(v)
    assert largest(s.balancing_torque - torque) < 2 * rounded  # by hand it is read at a rounded travel
    assert np.allclose(ks.extremes(s, "balancing_torque").range, (torque.min(), torque.max()), rtol=1e-3)
    mean, _ = ks.compare(s, s).mean_torques
    assert mean == pytest.approx(np.abs(torque).mean(), rel=1e-6)


def test_kinks_lie_in_both_turns_of_a_branch():
    scene, table = two_turns(back=True)
    kinks, jumps = table.kinks(scene.solve(4))
    x = scene.mechanism.place(kinks).travels["slider2"].position
    assert largest(np.min(np.abs(x[jumps.size :, None] - table.x), axis=1)) < 1e-12
    assert (kinks < 2 * np.pi).any()
    assert (kinks > 2 * np.pi).any()
    assert jumps.size == 4


# JAX


PHASES = np.linspace(0.3, 6.0, 12)
TABLES = {
    "angle": ks.Table(PHASES, 100.0 * np.sin(3.0 * PHASES)),
    "travel": ks.Table(X, DIAGRAM.y, over="travel"),
    "both strokes": DIAGRAM,
}
MANY = np.linspace(-7.0, 14.0, 60)


def torque(table, angles, length=0.2, speed=100.0):
    pump = ks.crank_slider(0.05, length, coupler=ks.Link(0.5, 0.1, 0.001), slider=ks.Link(1.0))
    loads = [ks.ProcessForce(table), ks.Gravity()]
    return ks.solve(pump, angles, crank_speed=speed, loads=loads, on_gap="nan").balancing_torque


@pytest.mark.slow
@pytest.mark.slow_start
@every("name, speed", [*((name, 100.0) for name in TABLES), ("both strokes", -100.0)])
def test_jax_reads_tables_as_numpy_does(double, name, speed):
    expected = torque(TABLES[name], MANY, speed=speed)
    for run in (double.jit(torque, static_argnums=0), torque):
        found = run(TABLES[name], double.numpy.asarray(MANY), 0.2, speed)
        assert found.dtype == "float64"
        assert largest(np.asarray(found) - expected) <= 1e-13 * largest(expected)


@pytest.mark.slow
@pytest.mark.slow_start
@every("name", TABLES)
def test_jax_gradients_equal_the_recorded_ones(double, name):
    pump = ks.crank_slider(0.05, 0.2, coupler=ks.Link(0.5, 0.1, 0.001), slider=ks.Link(1.0))
    scene = ks.Scene(pump, 100.0, loads=[ks.ProcessForce(TABLES[name]), ks.Gravity()])
    program = ks.compile(scene, "balancing_torque", engine="numpy")
    expected = program.derivatives(MANY, ["coupler_length", "crank_speed"])["balancing_torque"]
    slopes = double.jit(double.jacfwd(torque, argnums=(2, 3)), static_argnums=0)(TABLES[name], MANY, 0.2, 100.0)
    for path, found in zip(expected, slopes, strict=True):
        assert largest(np.asarray(found) - expected[path]) <= 1e-13 * largest(expected[path]), path


@pytest.mark.slow
def test_beyond_a_table_over_travel_jax_gives_nan(double):
    traced = double.jit(torque, static_argnums=0)
    found = np.asarray(traced(DIAGRAM, MANY, 0.24, 100.0))
    travel = 0.05 * np.cos(MANY) + np.sqrt(0.24**2 - 0.05**2 * np.sin(MANY) ** 2)
    assert np.array_equal(np.isnan(found), travel > 0.25 * (1 + 1e-9))
    with pytest.raises(ks.ParameterError, match="Beyond it at"):
        torque(DIAGRAM, MANY, 0.24)


@pytest.mark.slow
def test_traced_rows_are_refused_with_a_remedy(double):
    def of_values(values):
        return torque(ks.Table(X, values, over="travel"), MANY).sum()

    for run in (double.jit(of_values), double.grad(of_values)):
        with pytest.raises(ks.ParameterError, match=r"rows have no values yet.*numbers of the mechanism"):
            run(np.array([1.0, 2.0, 3.0]))


# Rows of a table read from a file


@every(
    "text, options, words",
    [
        ("crank_angle [deg], force [kN]\n0, 1\n120, 2\n240, 3\n", {}, None),
        ("crank angle [deg], force [kN]\n0, 1\n120, 2\n240, 3\n", {}, None),
        ("# bench 3, 12 May\ncrank_angle [deg], force [kN]\n0, 1\n120, 2\n240, 3\n", {}, None),
        ("crank_angle [rad], torque [N mm]\n0, 1\n2, 2\n4, 3\n", {"unit": "N m"}, None),
        ("travel [mm], pressure [bar]\n0, 1\n1, 2\n", {}, "no column 'force'"),
        ("travel [mm], pressure [kN]\n0, 1\n1, 2\n", {"area": 1.0}, "pressure"),
        ("travel [deg], force [kN]\n0, 1\n1, 2\n", {}, "travel"),
        ("angle [deg], force [kN]\n0, 1\n1, 2\n", {}, "no column 'crank_angle'"),
        ("travel [mm], force [kN]\n1, 1\n1, 2\n", {}, "travel must rise.* for a jump give two travels close together"),
        ("travel [mm], force [kN]\n1, 1\n2, 2\n1, 3\n3, 1\n", {}, "travel must rise.* give the stroke back"),
        ("travel [mm], force [kN]\n1, 1\n", {}, "at least 2 rows"),
        ("travel [mm], force [kN], back [kN]\n1, 1, 5\n2, 1, 5\n", {}, "'back' would not be read.*force_back"),
        ("travel [mm], force [kN], Force back [kN]\n1, 1, 5\n2, 1, 5\n3, 1, 5\n", {}, None),
        ("travel [mm], force [kN], force_return [kN]\n1, 1, 5\n2, 1, 5\n", {}, "'force_return' would not be read"),
        (
            "travel [mm], force [kN], force_bak [kN]\n1, 1, 5\n2, 1, 5\n",
            {},
            "'force_bak' would not be read.*force_back",
        ),
        ("travel [mm], pressure [bar], force_back [kN]\n1, 1, 5\n2, 1, 5\n", {"area": 1.0}, "pressure_back"),
        ("crank_angle [deg], force [N], force_back [N]\n0, 1, 5\n120, 2, 5\n240, 3, 5\n", {}, "over travel"),
        ("travel [m], force [N], pressure [Pa], pressure_back [Pa]\n1, 1, 5, 5\n2, 1, 5, 5\n3, 1, 5, 5\n", {}, None),
    ],
)
def test_csv_tables_are_read_or_refused(tmp_path, text, options, words):
    path = written(tmp_path, text)
    if words is None:
        assert ks.Table.from_csv(path, **options).y.size == 3
        return
    with pytest.raises(ks.CaseError, match=words) as caught:
        ks.Table.from_csv(path, **options)
    assert "table.csv" in str(caught.value)
