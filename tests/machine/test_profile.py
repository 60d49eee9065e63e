"""Cam profiles, their roller, and files for the workshop."""

import re
import sys
import xml.etree.ElementTree as ET

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial import cKDTree

import kinetostatics as ks
from kinetostatics.machine.cams import roller
from kinetostatics.numbers.files import read_columns
from support.cam_contacts import CAM, LOADS, STEEL, rolled
from support.every import every, quick

TURN = 2 * np.pi
ANGLES = np.linspace(0.0, TURN, 97)
DEGREES = np.radians(np.arange(360))
LOBES = ks.cams.Sampled(DEGREES, 0.1 + 0.012 * np.cos(3 * DEGREES) + 0.02 * np.cos(DEGREES))
"""Three lobes with a hollow on the far side."""
LAW = ks.cams.CosineLaw(0.3, 2.0, 0.3)
CAMS = {"law": LAW, "lobes": LOBES, "from a law": ks.cams.from_law(ks.laws.cosine(0.3, 2.0))}


@every("side, radius", [("disk", 0.17), ("ring", 0.23)])
def test_the_working_curve_of_a_circle_is_a_circle(side, radius):
    made = ks.cams.Circle(0.2, (0.03, -0.02)).profile(0.03, ANGLES, side)
    assert_allclose(np.hypot(made.surface[0] - 0.03, made.surface[1] + 0.02), radius, rtol=1e-14)
    assert_allclose(made.curvature_radius, radius if side == "disk" else -radius, rtol=1e-12)
    assert_allclose(np.hypot(*made.normal), 1.0, rtol=1e-15)


@every("name", CAMS)
def test_angle_and_curvature_equal_those_of_points(name):
    """By derivatives of the points x(phi), y(phi) with complex numbers, not by the formulas of polar curves."""
    cam = CAMS[name]
    made = cam.profile(0.02, ANGLES)
    r, slope, second = cam.radius(ANGLES)
    turn = np.exp(1j * ANGLES)
    velocity, bend = (slope + 1j * r) * turn, (second - r + 2j * slope) * turn
    normal = -1j * velocity / np.abs(velocity)
    assert_allclose(made.pressure_angle, np.angle(turn / normal), rtol=0, atol=1e-14)
    pitch = np.abs(velocity) ** 3 / (np.conj(velocity) * bend).imag
    assert_allclose(made.curvature_radius, pitch - 0.02, rtol=1e-10)
    assert_allclose(made.surface[0] + 1j * made.surface[1], r * turn - 0.02 * normal, rtol=0, atol=1e-16)


def test_curvature_of_the_cosine_law_against_40_digits():
    """Of the surface itself: points with 40 digits, differentiated there."""
    made = LAW.profile(0.05, [0.4, 2.0, 5.0])
    root, c0 = LAW._quadratic, LAW._cosine

    def pitch(phi):
        c = mp.cos(phi - mp.mpf(0.3))
        square, p, q = (mp.mpf(float(part)) for part in root)
        x = mp.mpf(2.0) + mp.mpf(0.3) * c
        return (x * c - (c - mp.mpf(float(c0))) * mp.sqrt((square * c + p) * c + q)) * mp.expjpi(phi / mp.pi)

    def surface(phi):
        velocity = mp.diff(pitch, phi)
        return pitch(phi) + mp.mpf(0.05) * 1j * velocity / abs(velocity)

    with mp.workdps(40):
        for phi, found in zip(made.crank_angle, made.curvature_radius, strict=True):
            first, second = (mp.diff(surface, mp.mpf(float(phi)), order) for order in (1, 2))
            assert found == pytest.approx(float(abs(first) ** 3 / mp.im(mp.conj(first) * second)), rel=1e-10)


@pytest.mark.slow
@every("side", ["disk", "ring"])
@every("name", CAMS)
def test_the_roller_touches_the_cam_and_never_cuts_it(name, side):
    """The nearest point of a fine pitch curve is a roller's radius from each surface point, none is nearer."""
    cam = CAMS[name]
    made, fine = cam.profile(0.02, 200, side), cam.profile(0.02, 40_000, side)
    distance, _ = cKDTree(fine.pitch.T).query(made.surface.T)
    assert_allclose(distance, 0.02, rtol=0, atol=1e-8)


@pytest.mark.slow
@every("side", ["disk", "ring"])
def test_other_cutter_cuts_the_same_curve(side):
    """It touches the surface where the roller does, its centre a cutter's radius away from it."""
    made = LOBES.profile(0.02, 400, side)
    for radius in (0.005, 0.02, 0.04):
        path = made.cutter_path(radius)
        assert_allclose(np.hypot(*(path - made.surface)), radius, rtol=1e-14)
        distance, _ = cKDTree(LOBES.profile(0.02, 20_000, side).surface.T).query(path.T)
        assert_allclose(distance, radius, rtol=0, atol=1e-7)
    assert_allclose(made.cutter_path(0.02), made.pitch, rtol=0, atol=1e-16)


@pytest.mark.slow
def test_extremes_lie_between_the_samples():
    """Of an eccentric circle: its largest pressure angle is asin(e / a), at right angles to the centre."""
    cam = ks.cams.Circle(0.2, (0.03, 0.0))
    peak = cam.profile(0.01, 8).largest_pressure_angle
    assert peak.value == pytest.approx(np.arcsin(0.03 / 0.2), rel=1e-14)
    lobes = LOBES.profile(0.01, 8)
    fine = 1.0 / LOBES.profile(0.01, 200_000).curvature_radius
    assert lobes.smallest_curvature_radius.value == pytest.approx(1.0 / fine.max(), rel=1e-9)
    assert lobes.smallest_hollow.value == pytest.approx(1.0 / fine.min(), rel=1e-9)


def test_disk_is_undercut_beyond_its_curvature():
    largest = LOBES.profile(0.01, 8).largest_roller_radius
    assert LOBES.profile(0.999 * largest, 8).smallest_curvature_radius.value == pytest.approx(0.001 * largest, rel=1e-6)
    message = (
        r"cam profile: a roller of radius 0\.0\S+ m undercuts the disk. The pitch curve bends with a radius of "
        r"0\.05\S+ m at crank angle \S+ deg \(too sharp from .* deg.*\); the roller's must be less"
    )
    with pytest.raises(ks.ParameterError, match=message):
        LOBES.profile(1.001 * largest, 8)


def test_ring_is_undercut_where_hollow():
    largest = LOBES.profile(0.01, 8, "ring").largest_roller_radius
    hollow = -LOBES.curvature_radius(np.pi)
    assert largest == pytest.approx(hollow, rel=1e-6)
    with pytest.raises(ks.ParameterError, match=r"undercuts the ring. .* at crank angle 180 deg"):
        LOBES.profile(1.01 * largest, 8, "ring")
    assert LAW.profile(0.2, 8, "ring").largest_roller_radius == np.inf


def test_cutter_reaching_another_part_is_refused():
    """A ring of two bulbs, each wider than the neck between them: 0.11 m on both sides of O."""
    made = ks.cams.Harmonic((0.3, 0.0, 0.2)).profile(0.01, 3600, "ring")
    assert made.smallest_hollow.value < -0.2
    for radius in (0.09, 0.109):
        distance, _ = cKDTree(made.surface.T).query(made.cutter_path(radius).T)
        assert_allclose(distance.min(), radius, rtol=1e-9)
    for radius in (0.111, 0.15, 0.2):
        with pytest.raises(ks.ParameterError, match=r"cuts into another part of the ring. .* take a smaller"):
            made.cutter_path(radius)


def test_roller_reaching_another_part_is_refused():
    """A lobe that widens outward from a narrow neck: the roller fits every bend of it, but cuts through the neck."""
    angle = np.linspace(-np.pi, np.pi, 1440, endpoint=False)
    neck = ks.cams.Sampled(angle, 0.03 + 0.27 / (1.0 + (angle / 0.45) ** 8))
    made = neck.profile(0.02, 8)
    assert made.largest_roller_radius > 0.024
    with pytest.raises(ks.ParameterError, match=r"radius 0\.024 m cuts into another part of the disk. .* 0\.0228"):
        neck.profile(0.024, 8)
    with pytest.raises(ks.ParameterError, match=r"radius 0\.12 m covers O, as its centre comes as near as 0\.1 m"):
        ks.cams.Circle(0.2, (0.1, 0.0)).profile(0.12, 8)


def test_cutter_larger_than_the_hollow_is_refused():
    made = LOBES.profile(0.02, 8)
    made.cutter_path(-0.999 * made.smallest_hollow.value)
    with pytest.raises(ks.ParameterError, match=r"not fit into the hollow of the disk at crank angle 180 deg, whose"):
        made.cutter_path(-1.001 * made.smallest_hollow.value)


def test_limits_name_what_exceeds_them():
    made = LOBES.profile(0.02, 8)
    assert made.exceeded(pressure_angle=np.radians(40.0), curvature_radius=0.01) == ()
    first, second = made.exceeded(pressure_angle=np.radians(20.0), curvature_radius=0.05)
    assert first.startswith("the pressure angle reaches 29.1")
    assert first.endswith("more than 20")
    assert second.startswith("the working curve is as sharp as 0.03")
    assert second.endswith("less than 0.05")


@pytest.mark.slow
@every("name", CAMS)
@every("degrees", [3.0, 20.0, 35.0])
def test_base_circle_gives_the_largest_angle(name, degrees):
    """The cam of the same rise on that base circle, sampled anew, has that pressure angle as its largest."""
    cam = CAMS[name]
    base = cam.base_radius(np.radians(degrees))
    radius, slope, _ = cam.radius(np.linspace(0.0, TURN, 100_001))
    moved = radius - radius.min() + base
    assert np.degrees(np.max(np.arctan(np.abs(slope) / moved))) == pytest.approx(degrees, rel=1e-7)


# What the workshop is given

CUT_CAM = ks.cams.CosineLaw(0.3, 2.0)
GIVEN = {"roller_radius": 0.05, "cutter_radius": 0.02, "points": 500}
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}


@pytest.mark.slow
@every("units", UNITS)
def test_a_dxf_read_back_gives_the_same_points(tmp_path, units):
    ezdxf = pytest.importorskip("ezdxf")
    CUT_CAM.export(tmp_path / "cam.dxf", units=units, **GIVEN)
    drawing = ezdxf.readfile(tmp_path / "cam.dxf")
    made = CUT_CAM.profile(0.05, 500)
    for layer, points in (("PITCH", made.pitch), ("SURFACE", made.surface), ("CUTTER", made.cutter_path(0.02))):
        (line,) = drawing.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
        assert line.closed
        assert_allclose(
            UNITS[units] * np.array([point[:2] for point in line.get_points()]).T, points, rtol=0, atol=1e-15
        )
    assert drawing.units == {"mm": 4, "cm": 5, "m": 6, "in": 1}[units]
    texts = [text.dxf.text for text in drawing.modelspace().query("TEXT")]
    assert any("roller goes around counter-clockwise" in text for text in texts)
    assert "0" in texts


@pytest.mark.parametrize("units", quick(UNITS, 2))
def test_csv_gives_back_points_and_cam(tmp_path, units):
    CUT_CAM.export(tmp_path / "cam.csv", units=units, **GIVEN)
    names = dict.fromkeys(("roller_x", "roller_y", "surface_x", "surface_y", "cutter_x", "cutter_y", "radius"), "m")
    columns = dict(zip(names, read_columns(tmp_path / "cam.csv", names), strict=True))
    made = CUT_CAM.profile(0.05, 500)
    for name, points in (("roller", made.pitch), ("surface", made.surface), ("cutter", made.cutter_path(0.02))):
        assert_allclose([columns[f"{name}_x"], columns[f"{name}_y"]], points, rtol=0, atol=0.501e-9)  # to 1e-6 mm
    again = ks.cams.Sampled.from_csv(tmp_path / "cam.csv")
    assert_allclose(again.radius(0.123)[2], CUT_CAM.radius(0.123)[2], atol=1e-9)
    rows = [row.split(", ") for row in (tmp_path / "cam.csv").read_text().splitlines() if row[0].isdecimal()]
    decimals = {"mm": 6, "cm": 7, "m": 9, "in": 8}[units]
    assert max(len(cell.partition(".")[2]) for row in rows for cell in row[2:]) <= decimals


def test_csv_has_the_numbers_of_the_drawing(tmp_path):
    """26.5, not 26.499999999999996: of a circle about O all radii and the whole degrees."""
    ks.cams.Circle(0.0265).export(tmp_path / "cam.csv", roller_radius=0.005, points=360)
    rows = [row.split(", ") for row in (tmp_path / "cam.csv").read_text().splitlines() if row[0].isdecimal()]
    assert [row[:2] for row in rows] == [[f"{angle}", "26.5"] for angle in range(360)]


def test_a_measured_cam_states_the_error_of_the_forces(tmp_path):
    angle = np.radians(np.arange(360))
    cam = ks.cams.Sampled(angle, np.round(CUT_CAM.radius(angle)[0], 6), noise=0.29e-6)
    for ending in ("csv", "svg"):
        cam.export(tmp_path / f"cam.{ending}", roller_radius=0.05, points=60)
        assert "forces are uncertain by 0.0004" in (tmp_path / f"cam.{ending}").read_text(encoding="utf-8")


def test_what_cannot_be_cut_leaves_the_file_as_it_was(tmp_path):
    for name in ("cam.svg", "cam.csv"):
        (tmp_path / name).write_text("as it was")
        for wrong in ({"roller_radius": 0.4}, {"roller_radius": 0.05, "side": "ring", "cutter_radius": 0.4}):
            with pytest.raises(ks.ParameterError, match=r"undercuts|does not fit"):
                CUT_CAM.export(tmp_path / name, points=60, **wrong)
        assert (tmp_path / name).read_text() == "as it was"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cam.csv", "cam.svg"]


def test_a_dxf_without_ezdxf_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(ks.KinetostaticsError, match=r'pip install "kinetostatics\[workshop\]"'):
        CUT_CAM.export(tmp_path / "cam.dxf", roller_radius=0.05, points=60)
    assert not list(tmp_path.iterdir())


# Drawings of cams


def svg_of(cam, folder, **options):
    cam.export(folder / "cam.svg", **GIVEN, **options)
    return ET.parse(folder / "cam.svg").getroot(), {"svg": "http://www.w3.org/2000/svg"}


@every("side", ["disk", "ring"])
def test_drawing_is_one_to_one(tmp_path, side):
    root, space = svg_of(CUT_CAM, tmp_path, side=side)
    left, top, width, height = map(float, root.get("viewBox").split())
    assert root.get("width") == f"{width:.6g}mm"
    assert root.get("height") == f"{height:.6g}mm"
    path = root.find("svg:path[@id='surface']", space).get("d")
    points = np.array(re.findall(r"(\S+) (\S+)(?= [LZ])", path), dtype=float).T * [[1e-3], [-1e-3]]
    made = CUT_CAM.profile(0.05, 500, side)
    assert_allclose(points, made.surface, rtol=0, atol=1e-9)
    for x, y in 1e3 * made.surface.T:
        assert left < x < left + width
        assert top < -y < top + height


def test_drawing_has_dimensions_and_rotation_mark(tmp_path):
    root, space = svg_of(CUT_CAM, tmp_path, clockwise=True)
    texts = [item.text for item in root.findall("svg:text", space)]
    for expected in ("0° zero mark", "roller goes clockwise", "500 mm", "roller ⌀ 100 mm"):
        assert expected in texts
    assert "smallest R 278.095 mm at 0°" in texts
    assert "largest R 321.905 mm at 180°" in texts


# Rollers and faces as parts of a scene, and the pressure of Hertz

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


def test_pressure_ellipse_bears_the_force():
    assert pytest.approx(2.1e11 / 0.91 / 2.0, rel=1e-14) == STEEL_PAIR  # half the plane modulus of one of them
    p, b = (part(-5e3, 0.02, STEEL_PAIR, 0.015) for part in (roller.pressure, roller.half_width))
    assert 0.5 * np.pi * b * p * 0.02 == pytest.approx(5e3, rel=1e-14)
    assert p / b == pytest.approx(STEEL_PAIR / (2.0 * 0.015), rel=1e-14)


def test_roller_conforms_to_a_ring_not_a_disk():
    disk, ring = roller.relative_radius(1.0 / 0.3, 0.03, np.array([-1.0, 1.0]))
    assert 1.0 / disk == pytest.approx(1.0 / 0.03 + 1.0 / 0.27, rel=1e-14)
    assert 1.0 / ring == pytest.approx(1.0 / 0.03 - 1.0 / 0.33, rel=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize("rise", quick([ks.laws.cycloidal, ks.laws.harmonic, ks.laws.polynomial], 1))
def test_a_rise_of_a_tenth_of_a_degree_is_seen(rise):
    """Against 200 000 points of the pitch curve by the law alone, in the axes of the cam, as complex numbers."""
    height, width = 1e-7, np.radians(0.1)
    back = ks.laws.cycloidal(0.08 + height, 0.08, 1.5)
    dwells = ks.laws.dwell(0.08 + height, 1.0), ks.laws.dwell(0.08, TURN - 2.5 - width)
    law = ks.laws.joined(rise(0.08, 0.08 + height, width), dwells[0], back, dwells[1], smooth="velocity")
    phi = np.linspace(1e-12, width - 1e-12, 200_001)
    s, v, a, _ = law(phi)
    velocity, bend = v - 1j * s, a - 2j * v - s
    sharpest = np.max(-(np.conj(velocity) * bend).imag / np.abs(velocity) ** 3)
    assert 1.0 / sharpest < 0.03  # of a pitch curve of 80 mm
    made = ks.RollerFollower(law).disk.profile(0.005, 8)
    assert made.largest_roller_radius == pytest.approx(1.0 / sharpest, rel=1e-9)
    assert made.smallest_curvature_radius.value == pytest.approx(1.0 / sharpest - 0.005, rel=1e-9)
    assert made.largest_pressure_angle.value == pytest.approx(np.max(np.arctan(np.abs(v) / s)), rel=1e-9)
    with pytest.raises(ks.ParameterError, match="undercuts the disk"):
        ks.RollerFollower(law).disk.profile(0.03, 8)


@pytest.mark.slow
def test_a_smooth_bump_between_the_samples_is_seen():
    """The jerk of a 4-5-6-7 polynomial starts and ends with 0, so nothing jumps where its segments join."""
    width, height = np.radians(0.06), 1e-6
    bump = (ks.laws.polynomial(*ends, width, "4-5-6-7") for ends in ((0.08, 0.08 + height), (0.08 + height, 0.08)))
    law = ks.laws.joined(ks.laws.dwell(0.08, 1.0), *bump, ks.laws.dwell(0.08, TURN - 1.0 - 2.0 * width))
    follower = ks.RollerFollower(law, follower=ks.Link(2.0))
    steepest = height / width * law.segments[1].coefficients.velocity
    place = 1.0 + width / 2.0
    assert law(place).velocity == pytest.approx(steepest, rel=1e-12)
    peak = follower.disk.profile(1e-5, 8).largest_pressure_angle
    assert peak.value == pytest.approx(np.arctan(steepest / law(place).position), rel=1e-6)
    solution = ks.solve(ks.Mechanism("bump", ks.Crank(None), (follower,)), 0.0, crank_speed=10.0)
    assert ks.extremes(solution, "pressure_angle").largest == pytest.approx(peak.value, rel=1e-12)
