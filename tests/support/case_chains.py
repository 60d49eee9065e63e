"""Chains and loads as text of case files, each beside the same built in Python."""

from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks

EXAMPLES = Path(__file__).parents[1] / "casefile" / "examples"


def rpm(number):
    return number * np.pi / 30


def v_engine():
    rod = {"coupler_length": 0.15, "slider": ks.Link(0.5)}
    groups = (
        ks.SliderGroup(
            0.15,
            ks.Guide.at(np.pi / 4, 0.002),
            coupler=ks.Link(0.6, 0.075, 0.002),
            slider=ks.Link(0.5, (0.01, 0.001)),
        ),
        ks.SliderGroup(
            guide=ks.Guide.through((0.0, 0.0), (-1.0, 1.0)),
            assembly="open",
            pin="D",
            label="2",
            coupler=ks.Link(0.6, (0.05, -0.001), 0.002),
            **rod,
        ),
    )
    engine = ks.Mechanism("V-90 engine", ks.Crank(0.04, ks.Link(3.0, (-0.008, 0.001), 0.01)), groups)
    forward, back = -200.0 * np.array([30.0, 12.0, 5.0, 2.0]), -200.0 * np.array([10.0, 4.0, 1.5, 1.0])
    gas = ks.Table([0.105, 0.12, 0.15, 0.195], forward, over="travel", back=back)
    return ks.Scene(engine, rpm(1500), loads=(ks.Gravity(9.8), ks.ProcessForce(gas, on="slider2")))


def six_bar():
    groups = (
        ks.RockerGroup(
            0.4,
            0.3,
            (0.35, 0.1),
            "crossed",
            ks.Link(4.0, 0.2, 0.05),
            ks.Link(3.0, 0.15, 0.02),
            pivot_name="Q",
        ),
        ks.Pin(on="coupler", at=(0.2, -0.05), name="C"),
        ks.SliderGroup(
            0.5,
            ks.Guide.at(-np.pi / 2, 0.1),
            coupler=ks.Link(2.0, 0.25, 0.04),
            slider=ks.Link(12.0),
            on="C",
            pin="D",
            label="2",
        ),
    )
    loads = ks.Force(5000.0, at="D", direction=np.pi / 2)
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), groups), rpm(90), 2.0, loads)


def shaper():
    groups = (
        ks.LeverGroup((0.0, -0.25), offset=0.005, lever=ks.Link(8.0, 0.3, 0.4), block=ks.Link(1.0)),
        ks.Pin(on="lever", at=(0.6, 0.0), name="C"),
        ks.SliderGroup(0.3, ks.Guide.at(0.0, 0.32), assembly=-1, on="C", slider=ks.Link(20.0)),
    )
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), groups), rpm(30), loads=ks.ProcessForce(-2000.0))


def oscillating_engine():
    group = ks.CylinderGroup(
        (0.0, -0.4), rod=ks.Link(1.0, 0.1, 0.01), cylinder=ks.Link(5.0, (0.05, 0.01), 0.1), pivot_name="P"
    )
    loads = ks.PointForce(3000.0, between=(("rod", 0.0, 0.0), "P"))
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), (group,)), rpm(120), loads=loads)


def pump():
    guide = ks.Guide.at(np.radians(10.0), -0.003)
    group = ks.YokeGroup(guide, np.radians(80.0), slider=ks.Link(2.0), block=ks.Link(0.3))
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.05), (group,)), rpm(200))


def watt():
    groups = (
        ks.RockerGroup(0.4, 0.3, (0.35, 0.1)),
        ks.Pin(on="coupler", at=(0.2, 0.2), name="E"),
        ks.Pin(on="rocker", at=(0.35, -0.1), name="F"),
        ks.Dyad(
            0.35,
            0.3,
            on=("E", "F"),
            pin="G",
            assembly=-1,
            dyad1=ks.Link(1.0, 0.175),
            dyad2=ks.Link(1.5, 0.15, 0.01),
            label="W",
        ),
    )
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), groups), rpm(60))


def in_line_engine():
    guide, slider = ks.Guide.at(0.0), ks.Link(0.5)
    groups = (
        ks.SliderGroup(0.15, guide, slider=slider),
        ks.Pin(on="crank", at=(-0.04, 0.0), name="C"),
        ks.SliderGroup(0.15, guide, on="C", pin="D", label="2", slider=slider),
    )
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.04), groups), rpm(1500))


def cam_chain():
    law, length = ks.cams.CosineLaw(0.3, 2.0, np.radians(20.0)), 2.0219051771
    groups = (
        ks.CamRoller(law, ks.Link(20.0, -0.01)),
        ks.SliderGroup(
            length,
            ks.Guide.at(np.radians(20.0)),
            coupler=ks.Link(150.0, length / 2, 20.5),
            slider=ks.Link(600.0),
        ),
    )
    spring = ks.Spring.balancing(600.0, rpm(320), 2.0)
    return ks.Scene(ks.Mechanism("chain", ks.Crank(None, ks.Link(3.0)), groups), rpm(320), loads=spring)


IN_PYTHON = {
    "slider": v_engine,
    "rocker": six_bar,
    "lever": shaper,
    "cylinder": oscillating_engine,
    "yoke": pump,
    "dyad": watt,
    "pin": in_line_engine,
    "cam_roller": cam_chain,
}


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
