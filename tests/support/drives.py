"""Machines and motors for tests of drives."""

import json
import math

import numpy as np

import kinetostatics as ks
from kinetostatics.drive.one_dof import DrivenMachine
from kinetostatics.studies.methods import running

from . import DATA

DISC_MOTOR = ks.drive.Motor.linear(100.0, 50.0, transmission=2.0)
DISC = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(inertia=3.0)), ())
PUMP = ks.crank_slider(0.1, 0.4, slider=ks.Link(20.0))


def driven(mechanism=DISC, *loads, motor=DISC_MOTOR, flywheel=0.5):
    return DrivenMachine("test", ks.Scene(mechanism, 1.0, loads=loads), motor, flywheel)


REFERENCE = json.loads((DATA / "driven_sawframe.json").read_text(encoding="utf-8"))
TURN = 2 * math.pi
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
FAN = ks.Torque(lambda motion: -2.0 * motion.crank_speed * motion.crank_speed, on="crank")
CUT = ks.ProcessForce(ks.Table(np.linspace(0.0, TURN, 41)[:-1], 4e3 + 4e3 * np.sin(TURN / 40 * np.arange(40))))
IDLE = ks.Scene(SAW, 33.5, loads=ks.Gravity())
ANGLES = np.arange(24) * np.pi / 12
BY_NAME = {method.name: method for method in running.RUNNING_METHODS}


def saw(*loads):
    """The saw at 33 rad/s under its weight and more."""
    return ks.Scene(SAW, 33.0, loads=(ks.Gravity(), *loads))


FRICTION_REFERENCE = json.loads((DATA / "driven_rubbing_sawframe.json").read_text(encoding="utf-8"))
PINS = {name: ks.PinFriction(0.05, 0.06) for name in ("O", "A", "B")}
RUBBING = ks.Scene(SAW, 1.0, loads=ks.Gravity(), friction={**PINS, "guide": ks.GuideFriction(0.1)})
FRICTION_PUMP = ks.Scene(
    ks.crank_slider(0.05, 0.2, coupler=ks.Link(1.0, 0.08, 0.002), slider=ks.Link(2.0)),
    20.0,
    loads=(ks.Gravity(), ks.ProcessForce(-200.0)),
    friction={
        "O": ks.PinFriction(0.1, 0.01),
        "A": ks.PinFriction(0.1, 0.02),
        "B": ks.PinFriction(0.2, 0.01),
        "guide": ks.GuideFriction(0.15, 0.03),
    },
)
SMALL = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5, transmission=5.0)
