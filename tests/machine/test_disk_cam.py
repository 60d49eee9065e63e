"""The cam of a follower in its own axes: the path of the roller centre, its derivatives, working curve and files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.followers import KINDS, LAW

PSI = np.linspace(0.0, 6.2, 53)
every_kind = pytest.mark.parametrize("kind", KINDS)


@every_kind
def test_the_roller_centre_is_on_it_at_each_crank_angle(kind):
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


def test_a_follower_through_o_has_the_radius_of_its_law():
    """Without offset the pitch curve is r(psi) = s(guide angle - psi)."""
    disk = ks.RollerFollower(LAW, ks.Guide.at(0.7)).disk
    s, v, a, _ = LAW(0.7 - PSI)
    assert_allclose(disk.radius(PSI), [s, -v, a], atol=1e-15)


def test_the_curvature_of_a_flat_followers_cam_is_s_and_its_second_derivative():
    follower = KINDS["flat"]()
    law = LAW(follower.disk.crank_angle(PSI))
    assert_allclose(follower.disk.curvature_radius(PSI), law.position + law.acceleration, rtol=1e-10)


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


def test_a_pitch_curve_that_does_not_go_around_is_refused():
    small = ks.RollerFollower(ks.laws.cosine(0.1, 0.101), ks.Guide.at(0.0, 0.02))
    with pytest.raises(ks.ParameterError, match="go around O once"):
        small.disk.radius(PSI)
