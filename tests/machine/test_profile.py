"""Working curves of cams: against circles, envelopes and curvature by other formulas; what cannot be cut is refused."""

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial import cKDTree

import kinetostatics as ks

TURN = 2 * np.pi
ANGLES = np.linspace(0.0, TURN, 97)
DEGREES = np.radians(np.arange(360))
LOBES = ks.cams.Sampled(DEGREES, 0.1 + 0.012 * np.cos(3 * DEGREES) + 0.02 * np.cos(DEGREES))
"""Three lobes with a hollow on the far side."""
LAW = ks.cams.CosineLaw(0.3, 2.0, 0.3)
CAMS = {"law": LAW, "lobes": LOBES, "from a law": ks.cams.from_law(ks.laws.cosine(0.3, 2.0))}


@pytest.mark.parametrize(("side", "radius"), [("disk", 0.17), ("ring", 0.23)])
def test_the_working_curve_of_a_circle_is_a_circle(side, radius):
    made = ks.cams.Circle(0.2, (0.03, -0.02)).profile(0.03, ANGLES, side)
    assert_allclose(np.hypot(made.surface[0] - 0.03, made.surface[1] + 0.02), radius, rtol=1e-14)
    assert_allclose(made.curvature_radius, radius if side == "disk" else -radius, rtol=1e-12)
    assert_allclose(np.hypot(*made.normal), 1.0, rtol=1e-15)


@pytest.mark.parametrize("name", CAMS)
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


@pytest.mark.parametrize("side", ["disk", "ring"])
@pytest.mark.parametrize("name", CAMS)
def test_the_roller_touches_the_cam_and_never_cuts_it(name, side):
    """The nearest point of a fine pitch curve is a roller's radius from each surface point, none is nearer."""
    cam = CAMS[name]
    made, fine = cam.profile(0.02, 200, side), cam.profile(0.02, 40_000, side)
    distance, _ = cKDTree(fine.pitch.T).query(made.surface.T)
    assert_allclose(distance, 0.02, rtol=0, atol=1e-8)


@pytest.mark.parametrize("side", ["disk", "ring"])
def test_other_cutter_cuts_the_same_curve(side):
    """It touches the surface where the roller does, its centre a cutter's radius away from it."""
    made = LOBES.profile(0.02, 400, side)
    for radius in (0.005, 0.02, 0.04):
        path = made.cutter_path(radius)
        assert_allclose(np.hypot(*(path - made.surface)), radius, rtol=1e-14)
        distance, _ = cKDTree(LOBES.profile(0.02, 20_000, side).surface.T).query(path.T)
        assert_allclose(distance, radius, rtol=0, atol=1e-7)
    assert_allclose(made.cutter_path(0.02), made.pitch, rtol=0, atol=1e-16)


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
        r"cam profile: a roller of radius 0\.0\S+ m undercuts the disk: the pitch curve bends with a radius of "
        r"0\.05\S+ m at crank angle \S+ deg \(too sharp from .* deg.*\); the roller's must be less"
    )
    with pytest.raises(ks.ParameterError, match=message):
        LOBES.profile(1.001 * largest, 8)


def test_ring_is_undercut_where_hollow():
    largest = LOBES.profile(0.01, 8, "ring").largest_roller_radius
    hollow = -LOBES.curvature_radius(np.pi)
    assert largest == pytest.approx(hollow, rel=1e-6)
    with pytest.raises(ks.ParameterError, match=r"undercuts the ring: .* at crank angle 180 deg"):
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
        with pytest.raises(ks.ParameterError, match=r"cuts into another part of the ring: .* take a smaller"):
            made.cutter_path(radius)


def test_roller_reaching_another_part_is_refused():
    """A lobe that widens outward from a narrow neck: the roller fits every bend of it, but cuts through the neck."""
    angle = np.linspace(-np.pi, np.pi, 1440, endpoint=False)
    neck = ks.cams.Sampled(angle, 0.03 + 0.27 / (1.0 + (angle / 0.45) ** 8))
    made = neck.profile(0.02, 8)
    assert made.largest_roller_radius > 0.024
    with pytest.raises(
        ks.ParameterError, match=r"radius 0\.024 m cuts into another part of the disk: .* as near as 0\.0228"
    ):
        neck.profile(0.024, 8)


def test_a_roller_that_covers_the_crank_is_refused():
    with pytest.raises(ks.ParameterError, match=r"radius 0\.12 m covers O, as its centre comes as near as 0\.1 m"):
        ks.cams.Circle(0.2, (0.1, 0.0)).profile(0.12, 8)


def test_cutter_larger_than_the_hollow_is_refused():
    hollow = LOBES.profile(0.02, 8).smallest_hollow
    LOBES.profile(0.02, 8).cutter_path(-0.999 * hollow.value)
    with pytest.raises(
        ks.ParameterError, match=r"does not fit into the hollow of the disk at crank angle 180 deg, whose"
    ):
        LOBES.profile(0.02, 8).cutter_path(-1.001 * hollow.value)


def test_limits_name_what_exceeds_them():
    made = LOBES.profile(0.02, 8)
    assert made.exceeded(pressure_angle=np.radians(40.0), curvature_radius=0.01) == ()
    first, second = made.exceeded(pressure_angle=np.radians(20.0), curvature_radius=0.05)
    assert first.startswith("the pressure angle reaches 29.1")
    assert first.endswith("more than 20")
    assert second.startswith("the working curve is as sharp as 0.03")
    assert second.endswith("less than 0.05")


@pytest.mark.parametrize("name", CAMS)
@pytest.mark.parametrize("degrees", [3.0, 20.0, 35.0])
def test_base_circle_gives_the_largest_angle(name, degrees):
    """The cam of the same rise on that base circle, sampled anew, has that pressure angle as its largest."""
    cam = CAMS[name]
    base = cam.base_radius(np.radians(degrees))
    radius, slope, _ = cam.radius(np.linspace(0.0, TURN, 100_001))
    moved = radius - radius.min() + base
    assert np.degrees(np.max(np.arctan(np.abs(slope) / moved))) == pytest.approx(degrees, rel=1e-7)
