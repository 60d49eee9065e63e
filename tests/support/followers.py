"""Followers of every kind on a loaded four-bar, for tests of their motion and forces."""

import numpy as np

import kinetostatics as ks

LAW = ks.laws.cosine(0.02, 0.08, 0.3)
SWING = ks.laws.cosine(0.15, 0.6, 0.3)
BODY = ks.Link(2.0, (0.01, 0.02), 0.04)
ANGLES = np.array([-2.0, 0.1, 0.7, 2.4, 4.0])
KINDS = {
    "roller": lambda law=LAW: ks.RollerFollower(law, ks.Guide.at(0.7), BODY),
    "roller, offset": lambda law=LAW: ks.RollerFollower(law, ks.Guide.at(-1.1, 0.013), BODY, label="_1"),
    "roller, level": lambda law=LAW: ks.RollerFollower(law, ks.Guide.at(0.0, -0.01), BODY),
    "flat": lambda law=LAW: ks.FlatFollower(law, ks.Guide.at(2.0, 0.013), BODY),
    "flat, level": lambda law=LAW: ks.FlatFollower(law, ks.Guide.at(0.0), BODY, pin="F", label="_1"),
    "swinging": lambda law=SWING: ks.SwingingFollower(law, 0.1, (0.12, 0.03), 1, BODY),
    "swinging, other side": lambda law=SWING: ks.SwingingFollower(law, 0.1, (-0.12, 0.05), -1, BODY, label="_1"),
}


def scene(follower, speed=12.0, acceleration=-30.0):
    """A four-bar with a follower on its crank, mass everywhere, and loads on each part."""
    rocker = ks.RockerGroup(0.4, 0.3, (0.35, 0.1), 1, ks.Link(1.0, (0.2, 0.01), 0.02), ks.Link(0.7, (0.1, 0.0), 0.01))
    crank = ks.Crank(0.1, ks.Link(1.5, (0.04, 0.02), 0.03))
    (link,) = follower.links
    loads = [ks.Gravity(9.81, -1.2), ks.Torque(5.0, on="rocker"), ks.Force(7.0, at=(link, 0.03, -0.02), direction=0.4)]
    if link in follower.guides:
        loads += [ks.Spring(5e3, 0.01, link), ks.ProcessForce(-40.0, link)]
    else:
        loads += [ks.TorsionSpring(60.0, 0.2, on=link)]
    mechanism = ks.Mechanism("cam drive", crank, (rocker, follower))
    return ks.Scene(mechanism, speed, acceleration, tuple(loads))
