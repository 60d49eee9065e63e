"""Machines as one degree of freedom under their motor: a disc, and a pump."""

import kinetostatics as ks
from kinetostatics.drive.driven import Driven

MOTOR = ks.drive.Motor.linear(100.0, 50.0, transmission=2.0)
DISC = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(inertia=3.0)), ())
PUMP = ks.crank_slider(0.1, 0.4, slider=ks.Link(20.0))


def driven(mechanism=DISC, *loads, motor=MOTOR, flywheel=0.5):
    return Driven("test", ks.Scene(mechanism, 1.0, loads=loads), motor, flywheel)
