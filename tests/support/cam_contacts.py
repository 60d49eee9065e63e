"""A sawframe whose cam carries a roller, and the contact of the two."""

import kinetostatics as ks

from .machines import ANGLES

CAM = ks.cams.CosineLaw(0.3, 2.0)
STEEL = (210e9, 0.3)


def rolled(roller=(0.05, 0.06, *STEEL)):
    """The sawframe with a roller as a part of it, by its numbers; None: without."""
    links = {"block": ks.Link(20.0), "coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)}
    return ks.cam_crank_slider(CAM, CAM.coupler_length, **links, roller=roller and ks.Roller(*roller))


SAW = rolled(None)
LOADS = [ks.Gravity(), ks.Spring.balancing(600.0, 33.5, 2.0)]


def solved(speed=33.5, loads=LOADS, machine=SAW, angles=ANGLES, **options):
    return ks.solve(machine, angles, crank_speed=speed, loads=loads, **options)


def contact(solution=None, **options):
    return ks.design.contact(solution or solved(), 0.05, 0.06, *STEEL, **options)
