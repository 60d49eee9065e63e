"""Loads of every kind as text of a case file, each beside the same load built in Python."""

import numpy as np
import pytest

import kinetostatics as ks


def agree(found, wanted, angles=12):
    """Two scenes have the same parameters and results."""
    for path, number in wanted.parameters.items():
        assert found.parameters[path] == pytest.approx(number, rel=1e-14), path
    table, expected = found.solve(angles).frame(), wanted.solve(angles).frame()
    assert list(table.columns) == list(expected.columns)
    for name, column in expected.items():
        largest = max(
            np.abs(other).max() for key, other in expected.items() if key.split(" [")[1] == name.split(" [")[1]
        )
        np.testing.assert_allclose(table[name], column, rtol=1e-12, atol=1e-12 * largest, err_msg=name)


# Loads

FOUR_BAR = """
title = "loads"
reference = "loaded"
[variants.loaded]
mechanism = "four-bar"
crank_speed = "60 rpm"
crank_length = "0.1 m"
coupler_length = "0.4 m"
rocker_length = "0.3 m"
rocker_pivot = ["0.35 m", "0.1 m"]
coupler = { mass = "2 kg" }
"""
PUMP = """
title = "loads"
reference = "loaded"
[variants.loaded]
mechanism = "crank-slider"
crank_speed = "60 rpm"
crank_length = "0.1 m"
coupler_length = "0.4 m"
slider = { mass = "2 kg" }
"""
BY_ANGLE = "crank_angle [deg], {}\n0, 1\n90, 3\n180, 2\n270, 0\n"
BY_TRAVEL = "travel [mm], {0}, {1}\n300, 8, 2\n400, 4, 1\n500, 1, 0\n"
ANGLES, TRAVELS = np.radians([0.0, 90.0, 180.0, 270.0]), np.array([0.3, 0.4, 0.5])
LOADS = {
    "force at a joint": (FOUR_BAR, 'kind = "force"\nvalue = "2 kN"\nat = "B"', ks.Force(2000.0, at="B")),
    "force on a link, turning with another": (
        FOUR_BAR,
        'kind = "force"\nvalue = "2 kN"\nat = ["coupler", "50 cm", "-10 mm"]\ndirection = "30 deg"\nalong = "rocker"',
        ks.Force(2000.0, at=("coupler", 0.5, -0.01), direction=np.radians(30.0), along="rocker"),
    ),
    "force along a link": (
        FOUR_BAR,
        'kind = "force"\nvalue = "-9 N"\nat = ["coupler", "50 cm"]',
        ks.Force(-9.0, at=("coupler", 0.5)),
    ),
    "force by a table over the angle": (
        FOUR_BAR,
        'kind = "force"\nvalue = { file = "t.csv", period = "720 deg" }\nat = "B"',
        ks.Force(ks.Table(2 * ANGLES, [1e3, 3e3, 2e3, 0.0], period=4 * np.pi), at="B"),
        BY_ANGLE.format("force [kN]").replace("270", "540").replace("180", "360").replace("90", "180"),
    ),
    "point force": (
        FOUR_BAR,
        'kind = "point force"\nvalue = "5 kN"\nbetween = [["rocker", "0.1 m", "0 m"], ["0 m", "-0.2 m"]]',
        ks.PointForce(5e3, between=(("rocker", 0.1, 0.0), (0.0, -0.2))),
    ),
    "torque": (
        FOUR_BAR,
        'kind = "torque"\nvalue = "5 N m"\non = "rocker"\nagainst = "coupler"',
        ks.Torque(5.0, on="rocker", against="coupler"),
    ),
    "torque by a table": (
        FOUR_BAR,
        'kind = "torque"\nvalue = { file = "t.csv", over = "angle" }\non = "rocker"',
        ks.Torque(ks.Table(ANGLES, [1e3, 3e3, 2e3, 0.0]), on="rocker"),
        BY_ANGLE.format("torque [kN m]"),
    ),
    "point spring": (
        FOUR_BAR,
        'kind = "point spring"\nstiffness = "2 N/mm"\nfree_length = "10 cm"\nbetween = ["B", ["0 m", "0.5 m"]]',
        ks.PointSpring(2e3, 0.1, between=("B", (0.0, 0.5))),
    ),
    "point damper": (
        FOUR_BAR,
        'kind = "point damper"\ncoefficient = "50 N s/m"\nbetween = ["B", "O"]',
        ks.PointDamper(50.0, between=("B", "O")),
    ),
    "torsion spring": (
        FOUR_BAR,
        'kind = "torsion spring"\nstiffness = "40 N m/rad"\nfree_angle = "80 deg"\non = "rocker"\nmoment = "3 N m"',
        ks.TorsionSpring(40.0, np.radians(80.0), on="rocker", moment=3.0),
    ),
    "torsion damper": (
        FOUR_BAR,
        'kind = "torsion damper"\ncoefficient = "0.5 N m s/rad"\non = "crank"',
        ks.TorsionDamper(0.5, on="crank"),
    ),
    "cubic spring": (
        PUMP,
        'kind = "spring"\nstiffness = "2 kN/m"\nfree_position = "0.4 m"\ncubic = "-1e4 N/m^3"',
        ks.Spring(2e3, 0.4, cubic=-1e4),
    ),
    "process force": (PUMP, 'kind = "process force"\nforce = "-2 tf"', ks.ProcessForce(-19613.3)),
    "process force of four strokes": (
        PUMP,
        'kind = "process force"\nforce = { file = "t.csv", area = "10 cm^2", period = "720 deg" }',
        ks.ProcessForce(ks.Table(2 * ANGLES, [1e2, 3e2, 2e2, 0.0], period=4 * np.pi), period=4 * np.pi),
        BY_ANGLE.format("pressure [bar]").replace("270", "540").replace("180", "360").replace("90", "180"),
    ),
    "indicator diagram": (
        PUMP,
        'kind = "process force"\nforce = { file = "t.csv", area = "-10 cm^2", over = "travel" }',
        ks.ProcessForce(ks.Table(TRAVELS, [-8e3, -4e3, -1e3], over="travel", back=[-2e3, -1e3, 0.0])),
        BY_TRAVEL.format("pressure [MPa]", "pressure_back [MPa]"),
    ),
    "force by travel of a slider": (
        PUMP,
        'kind = "force"\nvalue = { file = "t.csv", slider = "slider" }\nat = "B"\ndirection = "180 deg"',
        ks.Force(
            ks.Table(TRAVELS, [8.0, 4.0, 1.0], over="travel", back=[2.0, 1.0, 0.0], slider="slider"),
            at="B",
            direction=np.pi,
        ),
        BY_TRAVEL.format("force [N]", "force_back [N]"),
    ),
}
