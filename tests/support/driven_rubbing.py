"""Machines that rub under their motor, a saw and a pump, and the saw's running to many digits."""

import json

import kinetostatics as ks

from . import DATA

REFERENCE = json.loads((DATA / "driven_rubbing_sawframe.json").read_text(encoding="utf-8"))
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
PINS = {name: ks.PinFriction(0.05, 0.06) for name in ("O", "A", "B")}
RUBBING = ks.Scene(SAW, 1.0, loads=ks.Gravity(), friction={**PINS, "guide": ks.GuideFriction(0.1)})
PUMP = ks.Scene(
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
