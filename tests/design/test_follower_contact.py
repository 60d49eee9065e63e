"""Contact of followers with their disk cams: pressure, lift-off, pressure angle, curvature, undercutting."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.every import every
from support.followers import KINDS, scene

STEEL = (210e9, 0.3)
MODULUS = 210e9 / (2.0 * (1.0 - 0.3**2))
ANGLES = np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False)
MASS, STIFFNESS, FREE, SPEED = 0.4, 4e3, 0.01, 60.0
RADIUS, ECCENTRICITY, ROLLER = 0.03, 0.006, 0.012
LOWEST = RADIUS + ROLLER


def on_eccentric(phi):
    """Roller centre on a circular cam of a radius about a point beside O, and its three derivatives."""
    e, sine, cosine = ECCENTRICITY, np.sin(phi), np.cos(phi)
    u, w, twice = np.sqrt(LOWEST**2 - (e * sine) ** 2), sine * cosine, np.cos(2.0 * phi)
    first = -(e**2) * w / u
    second = -(e**2) * twice / u + e**2 * w * first / u**2
    third = 4.0 * e**2 * w / u + 2.0 * e**2 * twice * first / u**2 + e**2 * w * (second / u**2 - 2.0 * first**2 / u**3)
    return e * cosine + u, -e * sine + first, -e * cosine + second, e * sine + third


def machine(follower, speed=SPEED, angles=ANGLES, stiffness=STIFFNESS):
    drive = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    return ks.solve(drive, angles, crank_speed=speed, loads=ks.Spring(stiffness, FREE, on="follower"))


def pushed(law, speed=SPEED):
    """Force along the guide by hand: spring and inertia."""
    position, _, second, _ = law(ANGLES)
    return STIFFNESS * (position - FREE) + MASS * second * speed**2


@pytest.mark.slow
@every("speed", [SPEED, -SPEED, 20.0])
def test_roller_on_an_eccentric_circle_presses_as_by_hand(speed):
    """Two cylinders of constant radii; the force leans by the pressure angle, sin = e sin(phi) / (r + R)."""
    found = ks.design.contact(
        machine(ks.RollerFollower(on_eccentric, follower=ks.Link(MASS)), speed), ROLLER, 0.015, *STEEL
    )
    lean = np.arcsin(ECCENTRICITY * np.sin(ANGLES) / LOWEST)
    force = pushed(on_eccentric, speed) / np.cos(lean)
    radius = RADIUS * ROLLER / LOWEST
    assert_allclose(found.contact_force, force, rtol=1e-12)
    assert_allclose(np.abs(found.pressure_angle), np.abs(lean), atol=1e-15)
    assert_allclose(found.curvature_radius, RADIUS, rtol=1e-12)
    assert_allclose(found.relative_radius, radius, rtol=1e-12)
    assert_allclose(found.pressure, np.sqrt(force * MODULUS / (np.pi * 0.015 * radius)), rtol=1e-12)
    assert_allclose(found.half_width, 2.0 * force / (np.pi * 0.015 * found.pressure), rtol=1e-12)
    assert found.smallest_radius.value == pytest.approx(RADIUS, rel=1e-12)
    assert found.largest_pressure_angle.value == pytest.approx(np.arcsin(ECCENTRICITY / LOWEST), rel=1e-12)
    assert (found.sides, found.changes, found.lifted) == (("disk",), (), ())


def test_a_flat_face_on_an_eccentric_circle_presses_as_by_hand():
    """With s = r + e cos(phi) the radius s + s'' is r all the way."""
    law = ks.laws.cosine(ECCENTRICITY, RADIUS)
    found = ks.design.contact(machine(ks.FlatFollower(law, follower=ks.Link(MASS))), None, 0.015, *STEEL)
    force = pushed(law)
    assert_allclose(found.contact_force, force, rtol=1e-12)
    assert_allclose(found.relative_radius, RADIUS, rtol=1e-12)
    assert_allclose(found.pressure, np.sqrt(force * MODULUS / (np.pi * 0.015 * RADIUS)), rtol=1e-12)
    peak = STIFFNESS * (RADIUS + ECCENTRICITY - FREE) - MASS * ECCENTRICITY * SPEED**2  # at 0 deg
    assert found.largest_pressure.value == pytest.approx(found.pressure.max(), rel=1e-12)
    assert found.contact_force.max() == pytest.approx(peak, rel=1e-12)
    assert (found.sides, found.lifted) == (("disk",), ())
    assert "flat face" in repr(found)


def test_pressure_between_angles_and_limits():
    few = machine(ks.RollerFollower(on_eccentric, follower=ks.Link(MASS)), angles=np.array([1.0]))
    limits = {"pressure": 1e6, "pressure_angle": 0.05, "curvature_radius": 0.05, "lift_off_speed": 1e4}
    found = ks.design.contact(few, ROLLER, 0.015, *STEEL, limits={**limits, "starting_torque": 1e-3})
    fine = ks.design.contact(few.at(np.linspace(0.0, 2 * np.pi, 3601)), ROLLER, 0.015, *STEEL)
    assert found.largest_pressure.value == pytest.approx(fine.pressure.max(), rel=1e-9)
    starts = (
        "Hertz pressure: ",
        "torque to start: ",
        "pressure angle: 8.2",
        "radius of curvature of the cam: 0.03 m",
        "speed of",
    )
    assert [text for text, start in zip(found.exceeded, starts, strict=True) if not text.startswith(start)] == []
    assert found.frame()["pressure [Pa]"].tolist() == found.pressure.tolist()


@pytest.mark.slow
def test_a_weak_spring_lifts_off_and_the_face_then_has_no_pressure():
    """Flat: m e omega^2 cos(phi) = k (r + e cos(phi) - free) at the ends."""
    law, weak = ks.laws.cosine(ECCENTRICITY, RADIUS), 300.0
    found = ks.design.contact(
        machine(ks.FlatFollower(law, follower=ks.Link(MASS)), stiffness=weak), None, 0.015, *STEEL
    )
    half = np.arccos(weak * (RADIUS - FREE) / (ECCENTRICITY * (MASS * SPEED**2 - weak)))
    ((start, stop),) = found.lifted
    assert (start, stop) == pytest.approx((-half, half), rel=1e-9)
    assert np.array_equal(np.isnan(found.pressure), found.contact_force < 0.0)
    assert np.isfinite(found.largest_pressure.value)
    least = np.sqrt(weak * (RADIUS + ECCENTRICITY - FREE) / (MASS * ECCENTRICITY))
    assert found.lift_off_speed == pytest.approx(least, rel=1e-9)
    assert "lift-off" in repr(found)
    axes = ks.plots.contact_pressure({"weak": found}, units={"pressure": "MPa"})
    assert axes.get_ylabel() == "Hertz pressure [MPa]"
    axes.figure.clear()


def test_a_face_that_is_pulled_off_at_rest_has_no_speed_of_lift_off():
    law, pulled = ks.laws.cosine(ECCENTRICITY, RADIUS), ks.Spring(STIFFNESS, 10.0 * RADIUS, on="follower")
    cam = ks.Mechanism("cam", ks.Crank(None), (ks.FlatFollower(law, follower=ks.Link(MASS)),))
    found = ks.design.contact(ks.solve(cam, ANGLES, crank_speed=SPEED, loads=pulled), None, 0.015, *STEEL)
    assert found.lifted == ((0.0, 2.0 * np.pi),)
    assert found.lift_off_speed == 0.0


@pytest.mark.slow
@every("name", list(KINDS))
def test_contact_is_that_of_the_scene_with_the_body_in_it(name):
    """Of every kind of follower, with loads on each part, both ways round; named if there are several."""
    bare = KINDS[name]()
    body = ks.Face(0.02, *STEEL) if bare.BODY == "face" else ks.Roller(0.008, 0.02, *STEEL)
    own = KINDS[name]()
    object.__setattr__(own, bare.BODY, body)
    numbers = () if bare.BODY == "face" else (0.008,)
    for speed in (12.0, -12.0):
        s, given = (scene(part, speed).solve(ANGLES) for part in (own, bare))
        link = s.mechanism.groups[-1].led[0].link
        expected = s.pressure(f"contact_pressure{own.label}")
        for found in (
            ks.design.contact(s, follower=link),
            ks.design.contact(given, *numbers or (None,), 0.02, *STEEL),
        ):
            assert_allclose(found.pressure, expected, rtol=1e-12)
            assert_allclose(found.contact_force, s.scalar(f"contact_force{own.label}"), rtol=1e-12)


@pytest.mark.slow
def test_a_mirrored_machine_has_the_same_contact():
    """Guide, law and offset mirrored, the shaft turned the other way."""

    def back(phi):
        position, first, second, third = on_eccentric(-phi)
        return position, -first, second, -third

    one, other = (
        ks.design.contact(
            machine(
                ks.RollerFollower(law, ks.Guide.at(side * 0.7, side * 0.004), ks.Link(MASS)),
                side * SPEED,
                side * ANGLES,
            ),
            0.006,
            0.015,
            *STEEL,
        )
        for law, side in ((on_eccentric, 1.0), (back, -1.0))
    )
    assert_allclose(other.pressure, one.pressure, rtol=1e-12)
    assert_allclose(other.pressure_angle, -one.pressure_angle, rtol=1e-9, atol=1e-15)
    assert other.smallest_radius.value == pytest.approx(one.smallest_radius.value, rel=1e-12)
    assert other.lift_off_speed == pytest.approx(one.lift_off_speed, rel=1e-9)
    assert other.starting_torque.value == pytest.approx(one.starting_torque.value, rel=1e-9)


BARE = ks.RollerFollower(ks.laws.cosine(0.01, 0.05))
FLAT = ks.FlatFollower(ks.laws.cosine(0.01, 0.05))
LOBED = ks.RollerFollower(
    lambda phi: tuple(
        0.05 * (order == 0) + 0.005 * 3**order * np.cos(3.0 * phi - 0.3 + 0.5 * np.pi * order) for order in range(4)
    )
)
TWO = (BARE, ks.RollerFollower(ks.laws.cosine(0.01, 0.05), pin="S", label="_2"))


@every(
    ("followers", "given", "message"),
    [
        (
            (BARE,),
            {},
            "contact: roller_radius, width, .*, poissons_ratio must be given, since the follower has no Roller",
        ),
        ((FLAT,), {}, "contact: width, youngs_modulus, poissons_ratio must be given, since the follower has no Face"),
        ((FLAT,), {"roller_radius": 0.01}, "contact: the follower has a flat face, so it takes no roller_radius"),
        ((BARE,), {"load_rating": 1e4, "roller_mass": 10 / 3}, "takes no roller_mass, load_rating"),
        (
            (BARE,),
            {"load_rating": 1e4, "roller_mass": 1.0},
            "contact: load and life of a roller are .*takes no roller_mass, load_rating",
        ),
        ((BARE,), {"limits": {"pin_load": 1e3}}, "contact: load and life of a roller .* takes no pin_load"),
        ((BARE,), {"limits": {"presure": 1e3}}, "did you mean 'pressure'"),
        (
            (BARE,),
            {"roller_radius": 0.045},
            "cam profile: a roller of radius 0.045 m covers O",
        ),
        (
            (LOBED,),
            {"roller_radius": 0.035},
            r"a roller of radius 0.035 m undercuts the disk. .* of 0.03025 m at crank angle (5.7|125.7|245.7)",
        ),
        (TWO, {}, "contact: a cam drive has several followers; choose one as follower: 'follower', 'follower_2'"),
        (TWO, {"follower": "follower2"}, "did you mean 'follower_2'"),
    ],
)
def test_what_cannot_be_computed_is_refused_with_the_reason_first(followers, given, message):
    drive = ks.Mechanism("cam drive", ks.Crank(None), followers)
    springs = [ks.Spring(5e3, 0.0, on=group.moved) for group in drive.groups]
    s = ks.solve(drive, ANGLES, crank_speed=1.0, loads=springs)
    numbers = {} if "must be given" in message else {"width": 0.02, "youngs_modulus": 210e9, "poissons_ratio": 0.3}
    radius = {"roller_radius": 0.01} if numbers and followers[0] is not FLAT else {}
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.contact(s, **radius | numbers | given)
