"""Followers: laws, motion, contact forces, and the disks they run on."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.followers.follower import path_curvature
from support.every import every
from support.followers import ANGLES, BODY, KINDS, LAW, SWING, scene


@pytest.mark.slow
@every("kind", [name for name in KINDS if "flat" not in name])
def test_roller_path_bends_as_the_pitch_curve(kind):
    follower = KINDS[kind]()
    joint = scene(follower).solve(ANGLES).placement.joints["R"]
    place = follower.disk.curve(ANGLES)[0]
    assert_allclose(1.0 / path_curvature(joint), follower.disk.curvature_radius(np.angle(place)), rtol=1e-11)


def test_follower_names_its_link_and_contact():
    roller, face = ks.Roller(0.01, 0.02, 210e9, 0.3), ks.Face(0.02, 210e9, 0.3)
    made = (ks.RollerFollower(LAW, roller=roller), ks.FlatFollower(LAW, label="2", face=face))
    for follower, moved, pressed in zip(made, ("follower", "follower2"), (roller, face), strict=True):
        assert tuple(follower.links) == (moved,)
        assert follower.pressed is pressed
        assert moved in follower.outputs["contact_force" + follower.label].text
        assert follower.contacts["contact_pressure" + follower.label].body is pressed
    assert ks.RollerFollower(LAW).contacts == {}


# What a follower takes as its law


def test_a_group_made_again_keeps_its_law():
    follower = ks.RollerFollower(LAW)
    assert ks.RollerFollower(follower.cam).cam is follower.cam


WRONG = {
    "a number": (0.1, "must be one of ks.laws"),
    "a cam": (ks.cams.Circle(0.1), "must be one of ks.laws"),
    "not periodic": (lambda phi: (0.1 + phi, 1 + 0 * phi, 0 * phi, 0 * phi), "must repeat after a turn"),
    "failing": (lambda phi: phi + None, "it fails with"),
}


@every("kind", [ks.RollerFollower, ks.FlatFollower])
@every("name", WRONG)
def test_what_is_no_law_is_refused(name, kind):
    law, text = WRONG[name]
    with pytest.raises(ks.ParameterError, match=text):
        kind(law)


# What followers on a guide share


every_face = every("kind", [ks.RollerFollower, ks.FlatFollower])


@every_face
def test_the_follower_moves_by_the_law(kind):
    s = scene(kind(LAW, ks.Guide.at(0.4, 0.01), BODY)).solve(ANGLES)
    law = LAW(ANGLES)
    assert_allclose(s.travel("follower"), law.position, rtol=1e-15)
    assert_allclose(s.travel_velocity("follower"), 12.0 * law.velocity, rtol=1e-14)
    assert_allclose(s.travel_acceleration("follower"), 144.0 * law.acceleration - 30.0 * law.velocity, rtol=1e-13)


@every_face
def test_torque_is_of_spring_and_inertia(kind):
    law = LAW(ANGLES)
    expected = (2.0 * 144.0 * law.acceleration + 5e3 * (law.position - 0.01)) * law.velocity
    for offset in (0.0, 0.02):
        follower = kind(LAW, ks.Guide.at(0.4, offset), BODY)
        machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
        s = ks.solve(machine, ANGLES, crank_speed=12.0, loads=ks.Spring(5e3, 0.01, on="follower"))
        assert_allclose(s.balancing_torque, expected, rtol=1e-13)


# Roller followers on a cam that turns


def test_the_pressure_angle_is_the_textbooks():
    """Norton: tan = (v - offset) / (sqrt(base^2 - offset^2) + lift), offset to the side that the cam turns to."""
    follower = KINDS["roller, offset"]()
    s = scene(follower).solve(ANGLES)
    law = LAW(ANGLES)
    expected = np.arctan((law.velocity + 0.013) / law.position)
    assert_allclose(s.measure("pressure_angle_1"), expected, rtol=1e-14)


def test_contact_force_is_normal_to_pitch_curve():
    follower = KINDS["roller, offset"]()
    s = scene(follower).solve(ANGLES)
    centre, first, _ = follower.disk.curve(ANGLES)
    normal = 1j * first / np.abs(first) * np.exp(1j * ANGLES)
    on_follower = s.scalar("contact_force_1") * normal
    torque = (np.conj(centre * np.exp(1j * ANGLES)) * on_follower).imag
    alone = scene(follower).mechanism.crank
    bare = ks.Scene(ks.Mechanism("bars", alone, s.mechanism.groups[:1]), 12.0, -30.0, s.loads[:2]).solve(ANGLES)
    assert_allclose(s.balancing_torque - bare.balancing_torque, torque, rtol=1e-11)


def test_offset_trades_pressure_angles():
    peaks = []
    for offset in (-0.01, 0.01):
        follower = ks.RollerFollower(LAW, ks.Guide.at(0.0, offset))
        angle = ks.solve(
            ks.Mechanism("cam drive", ks.Crank(None), (follower,)), np.linspace(0, 6.28, 720), crank_speed=1.0
        )
        peaks.append((angle.measure("pressure_angle").max(), -angle.measure("pressure_angle").min()))
    assert peaks[0][0] < peaks[0][1]
    assert_allclose(peaks[0], peaks[1][::-1], rtol=1e-4)


def test_two_followers_stand_side_by_side():
    pair = (KINDS["roller"](), ks.RollerFollower(LAW, ks.Guide.at(2.0), pin="S", label="_2"))
    s = ks.solve(ks.Mechanism("cam drive", ks.Crank(None), pair), ANGLES, crank_speed=10.0)
    assert {"contact_force", "contact_force_2"} <= set(s.scalars)


# Flat followers on a cam that turns


def solved(law=LAW, offset=0.0, angles=ANGLES):
    follower = ks.FlatFollower(law, ks.Guide.at(2.0, offset), ks.Link(2.0))
    machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    return ks.solve(machine, angles, crank_speed=12.0, loads=ks.Spring(5e3, 0.0, on="follower"))


def test_the_contact_is_as_far_aside_as_the_velocity():
    s = solved()
    assert_allclose(s.measure("contact_place"), -LAW(ANGLES).velocity, rtol=1e-15)
    assert_allclose(s.measure("curvature_radius"), LAW(ANGLES).position + LAW(ANGLES).acceleration, rtol=1e-15)


def test_guide_bears_the_contact_moment():
    for offset in (0.0, 0.01):
        s = solved(offset=offset)
        lever = s.measure("contact_place") - offset
        assert_allclose(s.scalar("guide_moment"), lever * s.scalar("contact_force"), rtol=1e-13)
        assert_allclose(s.scalar("guide_force"), 0.0, atol=1e-12)


def test_no_side_force_whatever_the_pressure():
    assert_allclose(
        solved().scalar("contact_force"), 2.0 * 144.0 * LAW(ANGLES).acceleration + 5e3 * LAW(ANGLES).position
    )


# Swinging followers on a cam that turns


both_sides = every("kind", ["swinging", "swinging, other side"])


@both_sides
def test_arm_stands_at_the_angle_of_the_law(kind):
    follower = KINDS[kind]()
    s = scene(follower).solve(ANGLES)
    pivot = complex(*follower.pivot)
    x, y = s.position(follower.pin)
    angle = np.angle((x + 1j * y - pivot) / -pivot)
    assert_allclose(-follower.assembly * angle, SWING(ANGLES).position, rtol=1e-13)


@both_sides
def test_pressure_angle_is_normal_to_path(kind):
    follower = KINDS[kind]()
    s = scene(follower).solve(ANGLES)
    _, first, _ = follower.disk.curve(ANGLES)
    normal = 1j * first / np.abs(first) * np.exp(1j * ANGLES)
    x, y = s.velocity(follower.pin)
    way = (x + 1j * y) / np.hypot(x, y)
    expected = np.arccos(np.abs((np.conj(way) * normal).real))
    assert_allclose(s.measure("pressure_angle" + follower.label), expected, rtol=1e-9)


@both_sides
def test_moments_about_the_pivot_balance(kind):
    """The contact force on the arm, through the roller centre, and a couple on it."""
    follower = KINDS[kind]()
    bare = type(follower)(follower.cam, 0.1, follower.pivot, follower.assembly)
    machine = ks.Mechanism("cam drive", ks.Crank(None), (bare,))
    s = ks.solve(machine, ANGLES, crank_speed=12.0, loads=ks.Torque(follower.assembly * 30.0, on="arm"))
    assert np.all(s.scalar("contact_force") > 0)
    _, first, _ = follower.disk.curve(ANGLES)
    force = s.scalar("contact_force") * 1j * first / np.abs(first) * np.exp(1j * ANGLES)
    x, y = s.position("R")
    arm = x + 1j * y - complex(*follower.pivot)
    assert_allclose((np.conj(arm) * force).imag, -follower.assembly * 30.0, rtol=1e-12)
    assert_allclose(s.reaction("Q"), [-force.real, -force.imag], rtol=1e-11)


def three_lobes(phi):
    c, s = 0.01 * np.cos(3 * phi), 0.01 * np.sin(3 * phi)
    return 0.05 + c, -3 * s, -9 * c, 27 * s


@every(
    "follower, words",
    [
        (
            ks.RollerFollower(ks.laws.cosine(0.02, 0.01)),
            r"ahead of O along its guide, but its coordinate falls to -0\.0",
        ),
        (ks.FlatFollower(three_lobes), r"convex, but its radius of curvature s \+ s'' falls to -0\.03 m"),
        (
            ks.SwingingFollower(ks.laws.cosine(0.3, 0.2), 0.1, (0.12, 0.03)),
            "must stay on its side of the line from O to Q",
        ),
    ],
)
def test_a_follower_that_no_cam_can_move_is_refused(follower, words):
    with pytest.raises(ks.AssemblyError, match=words):
        ks.solve(ks.Mechanism("cam drive", ks.Crank(None), (follower,)), np.linspace(0, 6, 90), crank_speed=1.0)


IMPOSSIBLE = {
    "pivot at O": ({"pivot": (0.0, 0.0)}, "must not be at O"),
    "no length": ({"arm_length": 0.0}, "arm length must be greater than 0"),
    "side": ({"assembly": 2}, "assembly must be"),
    "law": ({"cam": 0.3}, "must be one of ks.laws"),
}


@every("name", IMPOSSIBLE)
def test_what_no_follower_can_have_is_refused(name):
    given, text = IMPOSSIBLE[name]
    with pytest.raises(ks.ParameterError, match=text):
        ks.SwingingFollower(**{"cam": SWING, "arm_length": 0.1, "pivot": (0.12, 0.0)} | given)


# The cam of a follower in its own axes


PSI = np.linspace(0.0, 6.2, 53)
every_kind = every("kind", KINDS)


@every_kind
def test_roller_centre_is_on_the_disk_curve(kind):
    """Seen from the crank: as placed in a mechanism, turned back by the crank angle."""
    follower = KINDS[kind]()
    phi = follower.disk.crank_angle(PSI)
    placed = ks.Mechanism("cam drive", ks.Crank(None), (follower,)).place(phi)
    x, y = placed.joints[follower.pin].position
    if kind.startswith("flat"):  # from the middle of the face to the contact
        travel, along = placed.travels[next(iter(follower.links))], complex(*follower.guide.direction)
        x, y = (complex_ := along * (travel.position - 1j * travel.first)).real, complex_.imag
    expected = (x + 1j * y) * np.exp(-1j * phi)
    radius = follower.disk.radius(PSI)[0]
    assert_allclose(radius * np.exp(1j * PSI), expected, rtol=1e-12)


@every_kind
def test_its_derivatives_are_those_of_its_radius(kind):
    disk, step = KINDS[kind]().disk, 2.0**-7
    places = np.arange(-4, 5)
    radius = np.array([disk.radius(PSI + step * place)[0] for place in places])
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
    _, first, second = disk.radius(PSI)
    assert_allclose(first, weights @ radius / step, atol=1e-12)
    slopes = np.array([disk.radius(PSI + step * place)[1] for place in places])
    assert_allclose(second, weights @ slopes / step, atol=1e-12)


def test_follower_through_o_has_the_laws_radius():
    """Without offset the pitch curve is r(psi) = s(guide angle - psi)."""
    disk = ks.RollerFollower(LAW, ks.Guide.at(0.7)).disk
    s, v, a, _ = LAW(0.7 - PSI)
    assert_allclose(disk.radius(PSI), [s, -v, a], atol=1e-15)


def test_flat_follower_curvature_is_s_and_s2():
    follower = KINDS["flat"]()
    law = LAW(follower.disk.crank_angle(PSI))
    assert_allclose(follower.disk.curvature_radius(PSI), law.position + law.acceleration, rtol=1e-10)


@pytest.mark.slow
def test_it_is_made_for_the_workshop(tmp_path):
    disk = KINDS["roller, offset"]().disk
    made = disk.profile(0.01, 90)
    assert_allclose(np.hypot(*(made.pitch - made.surface)), 0.01, rtol=1e-12)
    disk.export(tmp_path / "cam.csv", roller_radius=0.01, points=36)
    disk.export(tmp_path / "turned.csv", roller_radius=0.01, points=36, clockwise=False)
    texts = [(tmp_path / name).read_text() for name in ("cam.csv", "turned.csv")]
    assert ["the roller goes around clockwise" in text for text in texts] == [True, False]
    assert len((tmp_path / "cam.csv").read_text().splitlines()) > 36
    with pytest.raises(ks.ParameterError, match="roller"):
        disk.profile(0.2, 90)


@pytest.mark.slow
def test_a_flat_face_touches_the_pitch_curve_itself(tmp_path):
    """The face at s(phi) is a tangent of the cam: in axes of the crank n . surface reaches s, and nowhere more."""
    follower = ks.FlatFollower(LAW, ks.Guide.at(0.3))
    follower.disk.export(tmp_path / "cam.csv", points=720, cutter_radius=0.01)
    follower.disk.export(tmp_path / "cam.svg")
    heading, *rows = [row for row in (tmp_path / "cam.csv").read_text().splitlines() if row[0] != "#"]
    assert heading.startswith("angle [deg], radius [mm], surface_x [mm], surface_y [mm], cutter_x [mm]")
    assert "pressure" not in heading
    made = np.array([row.split(", ") for row in rows], dtype=float).T
    normal = np.array([np.cos(0.3 - ANGLES), np.sin(0.3 - ANGLES)])
    assert_allclose((normal.T @ made[2:4]).max(axis=1), 1e3 * LAW(ANGLES).position, rtol=1e-5)
    assert_allclose((normal.T @ made[4:6]).max(axis=1), 1e3 * LAW(ANGLES).position + 10.0, rtol=1e-5)
    assert "flat face" in (tmp_path / "cam.svg").read_text()
    for call in (lambda: follower.disk.profile(0.01, 90), lambda: follower.disk.export("cam.csv", roller_radius=0.01)):
        with pytest.raises(ks.ParameterError, match="flat face, which touches the pitch curve itself"):
            call()
    with pytest.raises(ks.ParameterError, match="roller_radius must be"):
        ks.RollerFollower(LAW).disk.export(tmp_path / "cam.csv")


def test_pitch_curve_must_go_around_o():
    small = ks.RollerFollower(ks.laws.cosine(0.1, 0.101), ks.Guide.at(0.0, 0.02))
    with pytest.raises(ks.ParameterError, match="go around O once"):
        small.disk.radius(PSI)


@every_kind
def test_followers_are_placed_where_they_are_found(kind):
    follower = KINDS[kind]()
    mechanism = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    placed, again = mechanism.place(ANGLES), mechanism.place(ANGLES)
    follower.follow(again, placed.joints)
    for name in follower.guides:
        assert_allclose(again.travels[name], placed.travels[name], atol=1e-16)
    for name in () if follower.guides else follower.links:
        assert_allclose(again.links[name].ratio, placed.links[name].ratio, atol=1e-14)
        assert_allclose(again.links[name].ratio_slope, placed.links[name].ratio_slope, atol=1e-14)
