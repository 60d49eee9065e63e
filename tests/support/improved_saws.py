"""Designs of the sawframe with a circular cam that several tests look at."""

from functools import cache

import kinetostatics as ks
from support.case_files import shipped

SAW = shipped("sawframe_2r63")
CIRCLE = SAW.variant("cam-circle")
ENDS = ("smallest slider_position = 1.7 m", "largest slider_position = 2.3 m")
SPRING = {"spring.stiffness": ("500 kN/m", "900 kN/m")}
CAM = SPRING | {
    "cam.centre.x": ("-30 mm", "-10 mm"),
    "cam.radius": (0.2, 0.4),
    "coupler_length": (1.9, 2.1),
    "spring.free_position": (1.9, 2.1),
}
RATIO, TORQUE = "ratio mean_absolute balancing_torque", "mean_absolute balancing_torque"
FRONT_OF = {"spring.stiffness": (6e5, 9e5), "cam.centre.x": (-0.03, -0.01)}
FORCE = "largest_absolute cam_force"


@cache
def bound():
    """Least cam force with the ends of the stroke kept, and a gain of 50 or more."""
    return ks.design.optimise(SAW, CAM, FORCE, [*ENDS, f"{RATIO} >= 50", "largest O <= 15 kN"], variant="cam-circle")


@cache
def front():
    """Cam force against the gain."""
    return ks.design.pareto(SAW, FRONT_OF, (FORCE, f"-{RATIO}"), variant="cam-circle", points=4, angles=180)
