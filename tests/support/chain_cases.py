"""Case files of chains, each beside the same chain built in Python."""

from pathlib import Path

import numpy as np

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
