"""Tables of a variant: each key, part, cam and roller, and what is wrong with them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.case_chains import LOADS, PUMP, agree, rpm
from support.case_files import PLAIN, case_file, problems


def test_unknown_cam_kind_names_the_nearest(tmp_path):
    text = PLAIN + '[variants.cam]\nmechanism = "cam-crank-slider"\ncoupler_length = "2 m"\ncam = { kind = "cirkle" }\n'
    kind, radius = problems(tmp_path, text)
    assert kind.startswith("variants.cam.cam.kind is 'cirkle'")
    assert "did you mean 'circle'?" in kind
    assert radius == "variants.cam.cam.radius is missing"


ROLLED = (
    PLAIN
    + """[variants.cam]
mechanism = "cam-crank-slider"
cam = { kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }
slider = { mass = "600 kg" }
roller = { radius = "50 mm", width = "60 mm", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }
"""
)


def test_a_roller_makes_the_pressure_an_output(tmp_path):
    case = ks.load_case(case_file(tmp_path, ROLLED))
    variant = case.variant("cam")
    assert variant.units["roller.width"] == "m"
    assert variant.units["roller.youngs_modulus"] == "Pa"
    solution = variant.solve(36)
    expected = ks.design.contact(solution, 0.05, 0.06, 210e9, 0.3).pressure
    assert_allclose(solution.contact_pressure, expected, rtol=1e-13)
    table = ks.sweep(
        case,
        ks.designs.grid({"roller.width": "30..60 mm:2"}),
        ["largest contact_pressure"],
        variant="cam",
        progress=False,
    )
    narrow, wide = table["largest contact_pressure [Pa]"]
    assert_allclose(narrow / wide, np.sqrt(2.0), rtol=1e-12)


@pytest.mark.parametrize(
    ("good", "bad", "message"),
    [
        ("poissons_ratio = 0.3", "poissons_ratio = 0.7", "poissons_ratio: input should be less than or equal to 0.5"),
        ("poissons_ratio = 0.3", 'poissons_ratio = "0.3"', "poissons_ratio: input should be a valid number"),
        (
            'youngs_modulus = "210 GPa"',
            'youngs_modulus = "210 mm"',
            'youngs_modulus "mm" does not measure the same as "Pa"',
        ),
        ('width = "60 mm", ', "", "width is missing"),
        ('radius = "50 mm"', 'radius = "3 m"', "undercuts the side of its cam"),
    ],
)
def test_wrong_rollers_are_named_with_their_key(tmp_path, good, bad, message):
    (told,) = problems(
        tmp_path, ROLLED.replace(good, bad) + 'spring = { stiffness = "1.5 MN/m", free_position = "2 m" }\n'
    )
    assert told.startswith("variants.cam")
    assert message in told


# Groups and loads of a case file, made of the rules of their classes


@pytest.mark.parametrize("name", LOADS)
def test_a_load_of_each_kind_is_the_one_made_in_python(tmp_path, name):
    text, entry, load, *table = LOADS[name]
    if table:
        (tmp_path / "t.csv").write_text(table[0], encoding="utf-8")
    variant = ks.load_case(case_file(tmp_path, f"{text}[[variants.loaded.loads]]\n{entry}\n")).variant("loaded")
    agree(variant.scene, ks.Scene(variant.mechanism, rpm(60), loads=load), 9)
    assert variant.scene.period == ks.Scene(variant.mechanism, rpm(60), loads=load).period


def test_loads_of_a_kind_are_numbered_in_order(tmp_path):
    springs = '[[variants.loaded.loads]]\nkind = "spring"\nstiffness = "{} N/m"\nfree_position = "0.4 m"\n'
    own = 'spring = { stiffness = "1 N/m", free_position = "0 m" }\n'
    variant = ks.load_case(case_file(tmp_path, PUMP + own + springs.format(2) + springs.format(3))).variant("loaded")
    wanted = {"spring.stiffness": 1.0, "spring2.stiffness": 2.0, "spring3.stiffness": 3.0}
    assert {path: variant.parameters[path] for path in wanted} == wanted
    assert {path: variant.scene.parameters[path] for path in wanted} == wanted


# Variants by their mechanism


@pytest.mark.slow
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
