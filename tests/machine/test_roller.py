"""Rollers and faces as parts of a scene, and the pressure of Hertz."""

import re

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.cams import roller
from support.cam_contacts import CAM, LOADS, STEEL, rolled

ROLLER = (0.05, 0.06, *STEEL)


def test_cam_material_defaults_to_the_rollers():
    alike = ks.Roller(*ROLLER).modulus
    assert ks.Roller(*ROLLER, cam_youngs_modulus=210e9, cam_poissons_ratio=0.3).modulus == alike
    softer = ks.Roller(*ROLLER, cam_youngs_modulus=110e9)
    assert softer.modulus == pytest.approx(1.0 / (0.91 / 210e9 + 0.91 / 110e9), rel=1e-15)
    assert ks.Face(0.06, *STEEL).modulus == alike


WRONG = [
    ({"radius": 0.0}, "roller: radius must be greater than 0"),
    ({"width": -0.01}, "roller: width must be greater than 0"),
    ({"youngs_modulus": 0.0}, "roller: youngs_modulus must be greater than 0"),
    ({"poissons_ratio": -0.1}, "roller: poissons_ratio must be at least 0"),
    ({"poissons_ratio": 0.6}, "roller: poissons_ratio must be at most 0.5, got 0.6"),
    ({"cam_poissons_ratio": 30.0}, "roller: cam_poissons_ratio must be at most 0.5, got 30"),
    ({"cam_youngs_modulus": "steel"}, "cam_youngs_modulus must be a number"),
]


def test_values_that_no_roller_has_are_refused():
    given = dict(zip(("radius", "width", "youngs_modulus", "poissons_ratio"), ROLLER, strict=True))
    for change, text in WRONG:
        with pytest.raises(ks.ParameterError, match=re.escape(text)):
            ks.Roller(**given | change)
    with pytest.raises(ks.ParameterError, match="roller must be a Roller, got"):
        ks.CamRoller(CAM, roller=0.05)
    with pytest.raises(ks.ParameterError, match="face must be a Face, got"):
        ks.FlatFollower(ks.laws.cosine(0.01, 0.05), face=ks.Roller(*ROLLER))


def test_roller_numbers_have_paths():
    scene = ks.Scene(rolled(), 33.5, loads=LOADS)
    assert {path: scene.parameters[path] for path in scene.parameters if path.startswith("roller")} == dict(
        zip(("roller.radius", "roller.width", "roller.youngs_modulus", "roller.poissons_ratio"), ROLLER, strict=True)
    )
    assert scene.units["roller.youngs_modulus"] == "Pa"
    assert scene.varied({"roller.width": 0.1}).parameters["roller.width"] == 0.1
    bare = ks.Scene(rolled(None), 33.5, loads=LOADS)
    assert not any("roller" in path for path in bare.parameters)
    with pytest.raises(ks.QuantityError, match=r"no contact pressure.*give its cam a roller"):
        bare.solve(12).contact_pressure  # noqa: B018


def test_friction_radius_must_be_the_rollers():
    friction = {"cam": ks.RollerFriction(0.01, 0.02, 0.04)}
    with pytest.raises(
        ks.ParameterError, match=r"roller_radius of 'cam', 0\.04 m, must be that of the roller .* 0\.05 m"
    ):
        ks.Scene(rolled(), 33.5, loads=LOADS, friction=friction)
    friction = {"cam": ks.RollerFriction(0.01, 0.02, 0.05)}
    scene = ks.Scene(rolled(), 33.5, loads=LOADS, friction=friction)
    assert scene.solve(36).contact_pressure.shape == (36,)
    program = ks.compile(scene, "contact_pressure", engine="numpy")
    with pytest.raises(ks.ParameterError, match="must be that of the roller"):
        program(0.5, {"roller.radius": 0.06})


def test_two_contacts_of_one_name_are_refused():
    follower = ks.RollerFollower(ks.laws.cosine(0.01, 0.5), roller=ks.Roller(*ROLLER))
    with pytest.raises(ks.ParameterError, match="adds quantity 'contact_pressure' a second time"):
        ks.Mechanism("both", ks.Crank(None), (ks.CamRoller(CAM, roller=ks.Roller(*ROLLER)), follower))


# Line contact by Hertz


STEEL_PAIR = roller.contact_modulus((2.1e11, 0.3), (2.1e11, 0.3))


def test_equal_materials_have_half_a_plane_modulus():
    assert pytest.approx(2.1e11 / 0.91 / 2.0, rel=1e-14) == STEEL_PAIR


def test_pressure_ellipse_bears_the_force():
    p, b = (part(-5e3, 0.02, STEEL_PAIR, 0.015) for part in (roller.pressure, roller.half_width))
    assert 0.5 * np.pi * b * p * 0.02 == pytest.approx(5e3, rel=1e-14)
    assert p / b == pytest.approx(STEEL_PAIR / (2.0 * 0.015), rel=1e-14)


def test_roller_conforms_to_a_ring_not_a_disk():
    disk, ring = roller.relative_radius(1.0 / 0.3, 0.03, np.array([-1.0, 1.0]))
    assert 1.0 / disk == pytest.approx(1.0 / 0.03 + 1.0 / 0.27, rel=1e-14)
    assert 1.0 / ring == pytest.approx(1.0 / 0.03 - 1.0 / 0.33, rel=1e-14)
