"""Chains whose constraint equations are solved, and the error of a method against the library."""

import numpy as np

import kinetostatics as ks
from kinetostatics.mechanics import quantities
from support.machines import KINDS, LINKS, Machine, largest

TURN = np.linspace(0.2, 0.2 + 2 * np.pi, 72, endpoint=False)
HEAVY = ks.Link(2.0, (0.07, -0.03), 0.04)
FOUR_BAR = ks.RockerGroup(0.4, 0.3, (0.35, 0.05), -1, HEAVY, HEAVY)
SLIDER = {"coupler": HEAVY, "slider": ks.Link(5.0, (0.04, 0.02), 0.3)}
CHAINS = {
    "four-bar": (FOUR_BAR,),
    "six-bar": (FOUR_BAR, ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.05), on="B", pin="C", label="2", **SLIDER)),
    "V engine": (
        ks.SliderGroup(0.4, ks.Guide.at(0.8), **SLIDER),
        ks.SliderGroup(0.5, ks.Guide.at(2.3, 0.02), -1, pin="C", label="2", **SLIDER),
    ),
}


def drag(motion):
    return -20.0 * motion.slider_velocity


def solved(name, angle=TURN, speed=12.0, acceleration=-30.0):
    """A mechanism in which every link has mass, under loads of every kind it can bear."""
    if name in KINDS:
        return Machine(name, assembly=-1).solve(
            angle,
            [ks.Gravity(9.81, -1.2), ks.Spring(500.0, 0.8), ks.ProcessForce(40.0), ks.ProcessForce(drag)],
            crank_speed=speed,
            crank_acceleration=acceleration,
        )
    mechanism = ks.Mechanism(name, ks.Crank(0.1, ks.Link(*LINKS["crank"])), CHAINS[name])
    sliders = [link for link in mechanism.links if link.startswith("slider")]
    loads = [kind for on in sliders for kind in (ks.Spring(300.0, 0.4, on), ks.ProcessForce(25.0, on))]
    return ks.solve(mechanism, angle, crank_speed=speed, crank_acceleration=acceleration, loads=[ks.Gravity(), *loads])


def error(s, name, found):
    """Largest error of a quantity, relative to its largest value."""
    exact = quantities.components(s, name)
    assert np.shape(found) == np.shape(exact)
    return float(largest(np.subtract(found, exact)) / (largest(exact) or 1.0))
