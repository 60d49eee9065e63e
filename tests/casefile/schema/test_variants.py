"""Variants by their mechanism: every key reaches it."""

import numpy as np

import kinetostatics as ks
from support.case_files import case_file


def test_every_key_of_a_variant_reaches_the_mechanism(tmp_path):
    text = """
title = "all keys"
reference = "a"
[variants.a]
mechanism = "cam-crank-slider"
crank_speed = "-100 rpm"
crank_acceleration = "7 rad/s^2"
guide_angle = "20 deg"
guide_offset = "15 mm"
assembly = -1
coupler_length = "1.4 m"
cam = { kind = "circle", radius = "200 mm", centre = ["-20 mm", "10 mm"] }
crank = { mass = "3 kg", centre = ["80 mm", "5 mm"], inertia = "0.2 kg m^2" }
block = { mass = "2 kg", centre = "-12 mm", inertia = "0.01 kg m^2" }
coupler = { mass = "9 kg", centre = "mid-length", inertia = "1.5 kg m^2" }
slider = { mass = "20 kg", centre = ["30 mm", "-40 mm"] }
gravity = { acceleration = "9.8 m/s^2", direction = "200 deg" }
spring = { stiffness = "4 kN/m", free_position = "-1.2 m" }
process_force = { force = "-250 N" }
[variants.b]
mechanism = "cam-crank-slider"
crank_speed = "100 rpm"
guide_angle = "20 deg"
cam = { kind = "cosine-law", amplitude = "200 mm", mean = "1.4 m" }
slider = { mass = "20 kg" }
spring = { stiffness = "balance the slider", free_position = "1.4 m" }
[variants.c]
mechanism = "crank-slider"
crank_speed = "100 rpm"
guide_through = [["0 m", "50 mm"], ["1 m", "150 mm"]]
crank_length = "200 mm"
coupler_length = "1.4 m"
crank = { mass = "3 kg", centre = "mid-length" }
"""
    case = ks.load_case(case_file(tmp_path, text))
    speed = 100 * np.pi / 30
    turn = 2 * np.pi * np.arange(16) / 16
    a = ks.solve(
        ks.cam_crank_slider(
            ks.cams.Circle(0.2, (-0.02, 0.01)),
            1.4,
            guide_angle=np.radians(20.0),
            guide_offset=0.015,
            assembly=-1,
            crank=ks.Link(3.0, (0.08, 0.005), 0.2),
            block=ks.Link(2.0, -0.012, 0.01),
            coupler=ks.Link(9.0, 0.7, 1.5),
            slider=ks.Link(20.0, (0.03, -0.04)),
        ),
        turn,
        crank_speed=-speed,
        crank_acceleration=7.0,
        loads=[ks.Gravity(9.8, np.radians(200.0)), ks.Spring(4000.0, -1.2), ks.ProcessForce(-250.0)],
    )
    law = ks.cams.CosineLaw(0.2, 1.4, np.radians(20.0))
    b = ks.solve(
        ks.cam_crank_slider(law, law.coupler_length, guide_angle=np.radians(20.0), slider=ks.Link(20.0)),
        turn,
        crank_speed=speed,
        loads=[ks.Spring.balancing(20.0, speed, 1.4)],
    )
    guide = ks.Guide.through((0.0, 0.05), (1.0, 0.15))
    c = ks.solve(ks.crank_slider(0.2, 1.4, guide=guide, crank=ks.Link(3.0, 0.1)), turn, crank_speed=speed)
    for name, expected in {"a": a, "b": b, "c": c}.items():
        found = case.solve(name, angles=16).frame()
        np.testing.assert_allclose(found, expected.frame(), rtol=1e-12, atol=1e-9)
