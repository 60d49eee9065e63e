"""Cams from a law of the slider: the slider follows it, the singular angles are regular, or it is refused."""

import warnings

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.every import every

laws, TURN = ks.laws, 2 * np.pi
QUARTER = np.pi / 2
REPAIR = 0.009788564699290535


def dwells(segment, **options):
    """Dwell, stroke, dwell and return, later by the phase that one coupler length needs."""
    made = [laws.dwell(2.3, 0.7), segment(2.3, 1.7, 2.6), laws.dwell(1.7, 0.6), segment(1.7, 2.3, TURN - 3.9)]
    law = laws.joined(*made, **options)
    try:
        return law if ks.cams.from_law(law) else None
    except ks.ParameterError as error:
        return law.shifted(float(str(error).split("law.shifted(")[1].split(")")[0]))


LAWS = {
    "cosine": lambda: (laws.cosine(0.3, 2.0), 0.0),
    "cosine beside the guide": lambda: (laws.cosine(0.3, 2.0, REPAIR), 0.02),
    "cycloidal": lambda: (laws.joined(laws.cycloidal(2.3, 1.7, np.pi), laws.cycloidal(1.7, 2.3, np.pi)), 0.0),
    "modified sine and dwells": lambda: (dwells(laws.modified_sine), 0.0),
    "modified trapezoid and dwells": lambda: (dwells(laws.modified_trapezoid), 0.0),
    "harmonic and dwells": lambda: (dwells(laws.harmonic, smooth="velocity"), 0.0),
    "polynomial and dwells": lambda: (dwells(laws.polynomial), 0.0),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if name.startswith(("polynomial", "modified trapezoid")) else name
        for name in LAWS
    ],
)
def test_slider_follows_the_law_at_singular_angles(name):
    """Position, velocity and acceleration through the whole mechanism, in a guide turned by 0.3 rad."""
    law, offset = LAWS[name]()
    cam = ks.cams.from_law(law, guide_angle=0.3, guide_offset=offset)
    machine = ks.cam_crank_slider(cam, cam.coupler_length, guide_angle=0.3, guide_offset=offset)
    aside = np.concatenate([[0.0], 10.0 ** -np.arange(1, 13), [0.5 - 1e-9, 0.5 + 1e-9, 0.25]])
    near = np.add.outer(cam.singular_angles, np.concatenate([aside, -aside])).ravel()
    angle = np.concatenate([np.linspace(0.0, TURN, 721) + 1e-3, near])
    solution = ks.solve(machine, angle, crank_speed=1.0)
    expected = law(angle - 0.3)
    assert_allclose(solution.slider_position, expected.position, rtol=0, atol=4e-15)
    assert_allclose(solution.slider_velocity, expected.velocity, rtol=0, atol=1e-14)
    assert_allclose(solution.slider_acceleration, expected.acceleration, rtol=0, atol=3e-14)


def test_cosine_law_is_the_closed_form():
    law, cam = ks.cams.CosineLaw(0.3, 2.0, 0.2), ks.cams.from_law(laws.cosine(0.3, 2.0), guide_angle=0.2)
    assert cam.coupler_length == pytest.approx(law.coupler_length, rel=1e-15)
    assert cam.singular_angles[0] - 0.2 == pytest.approx(law.singular_angle, abs=1e-8)
    phi = np.linspace(-7.0, 7.0, 4001)
    for found, expected in zip(cam.radius(phi), law.radius(phi), strict=True):
        assert_allclose(found, expected, rtol=0, atol=3e-14)


def test_radii_against_the_naive_root_with_60_digits():
    """Beside the guide, where no closed form exists: the signed root of L^2 - d^2 and its derivatives."""
    cam = ks.cams.from_law(laws.cosine(0.3, 2.0, REPAIR), guide_offset=0.02)

    def naive(phi):
        x = 2 + mp.mpf(0.3) * mp.cos(phi - mp.mpf(REPAIR))
        d = x * mp.sin(phi) - mp.mpf(0.02) * mp.cos(phi)
        sign = 1 if cam.near.angle < (phi + mp.pi) % (2 * mp.pi) - mp.pi < cam.far.angle else -1
        return x * mp.cos(phi) + mp.mpf(0.02) * mp.sin(phi) - sign * mp.sqrt(mp.mpf(cam.coupler_length) ** 2 - d * d)

    with mp.workdps(60):
        for phi in (0.1, 1.0, 1.3, 1.8, 2.5, 3.3, 4.2, 4.6, 5.1, 6.0):
            found = [float(part) for part in cam.radius(phi)]
            expected = [float(mp.diff(naive, mp.mpf(phi), order)) for order in (0, 1, 2)]
            assert_allclose(found, expected, rtol=0, atol=1e-11)  # the repaired phase leaves the lengths 1e-16 apart


def scene(cam, offset=0.0):
    machine = ks.cam_crank_slider(
        cam, cam.coupler_length, guide_offset=offset, slider=ks.Link(600.0), coupler=ks.Link(150.0, 1.0, 20.5)
    )
    return ks.Scene(machine, 33.5, loads=[ks.Gravity(), ks.Spring.balancing(600.0, 33.5, 2.0)])


@pytest.mark.slow
def test_programs_sweeps_and_pickles_carry_the_cam():
    import pickle

    made = scene(ks.cams.from_law(LAWS["cosine beside the guide"]()[0], guide_offset=0.02), 0.02)
    turn = np.linspace(0.0, 6.0, 9)
    torque = made.solve(turn).balancing_torque
    program = ks.compile(made, ("balancing_torque",), engine="numpy")
    assert_allclose(program(turn)["balancing_torque"], torque, rtol=1e-14)
    assert "slider.mass" in program.parameters
    assert not any(path.startswith("cam") for path in made.parameters)
    assert_allclose(pickle.loads(pickle.dumps(made)).solve(turn).balancing_torque, torque, rtol=0)
    slope = program.derivatives(turn, by=["slider.mass"])["balancing_torque"]["slider.mass"]
    change = made.varied({"slider.mass": 601.0}).solve(turn).balancing_torque - torque
    assert_allclose(slope, change, rtol=1e-7, atol=1e-9)


def test_a_mechanism_off_the_law_is_warned_of():
    cam = ks.cams.from_law(laws.cosine(0.3, 2.0, REPAIR), guide_offset=0.02)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ks.cam_crank_slider(cam, cam.coupler_length, guide_offset=0.02)
    with pytest.warns(UserWarning, match=r"will not follow the law of its cam: guide_offset 0\.0 m is not 0\.02"):
        ks.cam_crank_slider(cam, cam.coupler_length)


def test_table_cam_follows_its_spline():
    angle = np.linspace(0.0, TURN, 120, endpoint=False)
    law = laws.table(angle, 2.0 + 0.3 * np.cos(angle))
    cam = ks.cams.from_law(law)
    machine = ks.cam_crank_slider(cam, cam.coupler_length)
    turn = np.linspace(0.0, TURN, 500) + 1e-3
    assert_allclose(ks.solve(machine, turn, crank_speed=1.0).slider_acceleration, law(turn).acceleration, atol=3e-12)
    assert cam.force_error == law.force_error < 1e-4
    assert ks.cams.from_law(laws.cosine(0.3, 2.0)).force_error is None


# The coupler length with which a law has a smooth cam, and laws that have none


def test_cosine_law_off_the_guide_is_refused():
    law = laws.cosine(0.3, 2.0)
    message = (
        r"coupler would have to be 2\.019120\d+ m long at 82\.26\d+ deg .* and 2\.02487\d+ m at 278\.79\d* deg.*"
        r"later by 0\.5608 deg needs one only: law\.shifted\(0\.00978856"
    )
    with pytest.raises(ks.ParameterError, match=message) as caught:
        ks.cams.from_law(law, guide_offset=0.02)
    phase = float(str(caught.value).split("law.shifted(")[1].rstrip(")"))
    cam = ks.cams.from_law(law.shifted(phase), guide_offset=0.02)
    assert abs(cam.far.length - cam.near.length) < 1e-14
    assert 2.0191 < cam.coupler_length < 2.0249


def test_a_law_of_ones_own_is_told_how_to_shift_itself():
    own = laws.cosine(0.3, 2.0)
    with pytest.raises(ks.ParameterError, match=r"needs one only: lambda phi: law\(phi - 0\.0097"):
        ks.cams.from_law(lambda phi: own(phi), guide_offset=0.02)


@every(
    "law, message",
    [
        (laws.cosine(0.3, -2.0), "the slider must stay ahead of the roller along the guide, but is 2.02"),
        (
            laws.joined(laws.cycloidal(0.1, 2.0, np.pi), laws.cycloidal(2.0, 0.1, np.pi)),
            "the pitch curve must go around O, but its radius falls to -1.3",
        ),
        (lambda phi: phi, "must give 4 arrays"),
        (lambda phi: (phi, phi, phi, phi), "must repeat after a turn, but gives 0.5 m at 0.5 rad and 6.78"),
        (lambda phi: (phi * np.nan,) * 4, "must give finite values"),
        (laws.cycloidal(1.7, 2.3, 1.0), "angles must lie from 0 to its 1 rad"),
        (laws.Law, "must be one of ks.laws"),
        (3.0, "must be one of ks.laws"),
    ],
)
def test_what_is_no_law_of_a_slider_is_refused(law, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.cams.from_law(law)
