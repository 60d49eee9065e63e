"""Cams and followers with impossible input."""

import math
from functools import partial

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.no_numbers import BAD

laws, TURN = ks.laws, 2 * np.pi
CAM = ks.cams.CosineLaw(0.3, 2.0)
DEGREES = np.radians(np.arange(360))
RADII = CAM.radius(DEGREES)[0]
SAW = ks.cam_crank_slider(CAM, CAM.coupler_length, slider=ks.Link(600.0))
SOLUTION = ks.solve(SAW, DEGREES, crank_speed=30.0)
PLAIN = ks.solve(ks.crank_slider(0.1, 0.3), DEGREES, crank_speed=30.0)

NO_NUMBERS = [None, [], lambda: 1, *(value for value, _ in BAD.values())]
"""What is no single finite number."""
NOT_POSITIVE = [0.0, -0.1, -0, np.float64(-1e-300)]

FIELDS = {
    "cosine amplitude": (lambda x: laws.cosine(x, 2.0), "amplitude", True),
    "cosine mean": (lambda x: laws.cosine(0.3, x), "mean", False),
    "cosine phase": (lambda x: laws.cosine(0.3, 2.0, x), "phase", False),
    "shifted": (lambda x: laws.cosine(0.3, 2.0).shifted(x), "phase", False),
    "dwell position": (lambda x: laws.dwell(x, 1.0), "position", False),
    "dwell angle": (lambda x: laws.dwell(1.0, x), "angle", True),
    "harmonic start": (lambda x: laws.harmonic(x, 1.0, 1.0), "start", False),
    "cycloidal end": (lambda x: laws.cycloidal(0.0, x, 1.0), "end", False),
    "modified sine angle": (lambda x: laws.modified_sine(0.0, 1.0, x), "angle", True),
    "modified trapezoid angle": (lambda x: laws.modified_trapezoid(0.0, 1.0, x), "angle", True),
    "polynomial start": (lambda x: laws.polynomial(x, 1.0, 1.0), "start", False),
    "from_law guide_angle": (lambda x: ks.cams.from_law(laws.cosine(0.3, 2.0), guide_angle=x), "guide_angle", False),
    "from_law guide_offset": (lambda x: ks.cams.from_law(laws.cosine(0.3, 2.0), guide_offset=x), "guide_offset", False),
    "profile roller": (lambda x: CAM.profile(x, 8), "roller_radius", True),
    "cutter": (lambda x: CAM.profile(0.05, 8).cutter_path(x), "cutter_radius", True),
    "base pressure angle": (CAM.base_radius, "pressure_angle", True),
    "contact roller": (lambda x: ks.design.contact(SOLUTION, x, 0.06, 210e9, 0.3), "roller_radius", True),
    "contact width": (lambda x: ks.design.contact(SOLUTION, 0.05, x, 210e9, 0.3), "width", True),
    "contact modulus": (
        lambda x: ks.design.contact(SOLUTION, 0.05, 0.06, (210e9, x), 0.3),
        "youngs_modulus of the cam",
        True,
    ),
    "contact ratio": (
        lambda x: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, (x, 0.3)),
        "poissons_ratio of the roller",
        False,
    ),
    "contact mass": (
        lambda x: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, roller_mass=x),
        "roller_mass",
        False,
    ),
    "contact exponent": (
        lambda x: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, life_exponent=x),
        "life_exponent",
        True,
    ),
    "contact limit": (
        lambda x: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, limits={"pressure": x}),
        "limit 'pressure'",
        True,
    ),
    "spring mass": (lambda x: ks.design.spring_surge(SOLUTION, x), "spring_mass", True),
    "brinell": (ks.design.pressure_from_hardness, "brinell", True),
}


@pytest.mark.slow
@every("value", NO_NUMBERS, ids=[f"{n}-{type(x).__name__}" for n, x in enumerate(NO_NUMBERS)])
@every("field", FIELDS)
def test_non_numbers_are_refused_by_field(field, value):
    make, name, _ = FIELDS[field]
    with pytest.raises(ks.ParameterError, match=f"{name} must"):
        make(value)


@every("value", NOT_POSITIVE, ids=repr)
@every("field", [field for field, (_, _, positive) in FIELDS.items() if positive])
def test_what_must_be_greater_than_zero_is(field, value):
    make, name, _ = FIELDS[field]
    with pytest.raises(ks.ParameterError, match=f"{name} must"):
        make(value)


@every(
    ("make", "message"),
    [
        (lambda: laws.cycloidal(0.0, 1.0, 7.0), "angle must be less than 6.28"),
        (lambda: laws.dwell(0.0, 1e9), "angle must be less than 6.28"),
        (lambda: laws.polynomial(0, 1, 1, powers="5-6"), "powers must be '3-4-5' or '4-5-6-7', or two or more"),
        (lambda: laws.polynomial(0, 1, 1, powers=(3,)), "powers must be"),
        (lambda: laws.polynomial(0, 1, 1, powers=(5, 4, 3)), "powers must be"),
        (lambda: laws.polynomial(0, 1, 1, powers=(3, 3, 4)), "powers must be"),
        (lambda: laws.polynomial(0, 1, 1, powers=(1, 2)), "powers must be"),
        (lambda: laws.polynomial(0, 1, 1, powers=(3, 4.5)), "powers must be"),
        (lambda: laws.polynomial(0, 1, 1, powers=(3, 400)), "powers must be"),
        (lambda: laws.polynomial(0, 1, 1, powers=None), "powers must be"),
        (lambda: laws.joined(), "no segments"),
        (lambda: laws.joined(None), "segment 1 must be made by ks.laws, got None"),
        (lambda: laws.joined(laws.cosine(1, 2)), "segment 1 must be made by ks.laws"),
        (lambda: laws.joined(laws.dwell(1, TURN), smooth="jerk"), "smooth is 'jerk', allowed"),
        (lambda: laws.joined(laws.dwell(1, TURN), smooth=[]), "smooth is"),
        (lambda: laws.joined(*[laws.dwell(1, 1.0)] * 7), "must fill a turn"),
        (lambda: laws.cycloidal(0, 1, 1.0)(1.5), "angles must lie from 0 to its 1 rad, got 1.5"),
        (lambda: laws.cycloidal(0, 1, 1.0)(-0.5), "angles must lie from 0"),
        (lambda: laws.table(DEGREES, RADII[:-1]), "angle and position must be 1-D, of one length"),
        (lambda: laws.table(DEGREES[:5], RADII[:5]), "at least 8 points are needed, got 5"),
        (lambda: laws.table(DEGREES[::-1], RADII), "angles must rise, but row 2"),
        (lambda: laws.table(np.arange(360.0), RADII), "angles must stay within one turn"),
        (lambda: laws.table(DEGREES[:200], RADII[:200]), "must cover the turn, but leaves a gap"),
        (lambda: laws.table(DEGREES, RADII * np.nan), "position must be finite"),
        (lambda: laws.table("angle", RADII), "angle must be a number or an array"),
        (lambda: laws.table(DEGREES, RADII, noise=-1e-6), "noise must be greater than 0"),
        (lambda: laws.table(DEGREES, RADII, noise="1 um"), "noise must be a number"),
        (lambda: ks.cams.Sampled(DEGREES, RADII, noise=0.0), "noise must be greater than 0"),
        (lambda: ks.cams.Sampled(DEGREES, RADII, noise=[1e-6] * 360), "noise must be"),
        (lambda: ks.cams.from_law(None), "law must be one of ks.laws"),
        (lambda: ks.cams.from_law("cosine"), "law must be one of ks.laws"),
        (lambda: ks.cams.from_law(np.cos), "law must give 4 arrays, position to jerk, got 3"),
        (lambda: ks.cams.from_law(lambda phi: ("a", "b", "c", "d")), "it fails with: could not convert"),
        (lambda: ks.cams.from_law(lambda: 1), "it fails with"),
        (lambda: ks.cams.from_law(lambda phi: (2 + 0 * phi, 0, 0)), "got 3"),
        (lambda: ks.cams.from_law(laws.cosine(0.3, 2.0), 2.5), "with a coupler of 2.021905177 m only"),
        (lambda: ks.cams.from_law(laws.cosine(0.3, 2.0), -2.0), "coupler_length must be greater than 0"),
        (lambda: ks.cams.from_law(laws.cosine(0.3, 2.0), guide_offset=5.0), "no smooth cam makes this law"),
        (lambda: ks.cams.from_law(laws.cosine(1e-9, 1e-9, 1.0)), "no smooth cam makes this law"),
        (lambda: CAM.profile(0.05, 8, side="inside"), "side is 'inside', allowed: 'disk', 'ring'"),
        (lambda: CAM.profile(0.05, 8, side=None), "side is None"),
        (lambda: CAM.profile(0.05, 0), "angle must be a whole number of at least 1"),
        (lambda: CAM.profile(0.05, -3), "angle must be a whole number"),
        (lambda: CAM.profile(0.05, 10**12), "angle must be at most"),
        (lambda: CAM.profile(0.05, "all"), "angle must be"),
        (lambda: CAM.profile(0.05, [0.1, np.nan]), "angle must be finite"),
        (lambda: CAM.profile(0.3, 8), "undercuts the disk"),
        (lambda: CAM.profile(1e6, 8), "undercuts the disk"),
        (lambda: CAM.profile(0.05, 8).exceeded(pressure_angle=-1), "pressure_angle must be greater than 0"),
        (lambda: CAM.profile(0.05, 8).exceeded(curvature_radius="x"), "curvature_radius must be"),
        (lambda: CAM.base_radius(2.0), "pressure_angle must be less than 1.57"),
        (lambda: ks.design.contact(None, 0.05, 0.06, 210e9, 0.3), "solution must be a Solution"),
        (lambda: ks.design.contact(SAW, 0.05, 0.06, 210e9, 0.3), "solution must be a Solution"),
        (lambda: ks.design.contact(PLAIN, 0.05, 0.06, 210e9, 0.3), "contact: a crank-slider has no cam; contact needs"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.7), "poissons_ratio of the roller must be less"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, -0.1), "poissons_ratio of the roller must be at least"),
        (lambda: ks.design.contact(SOLUTION, 0.5, 0.06, 210e9, 0.3), "undercuts the disk"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, limits=5), "limits must be a dict"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, limits={"presure": 1}), "did you mean 'pressure'"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, limits={3: 1}), "limit is 3"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, limits={"life": 1e4}), "takes the load_rating"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, load_rating=-1.0), "load_rating must be"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3, roller_inertia=-1.0), "roller_inertia must be"),
        (lambda: ks.design.contact(SOLUTION, 0.05, 0.06, 210e9, 0.3).life, "takes its load_rating"),
        (lambda: ks.design.lift_off_speed(None), "solution must be a Solution"),
        (lambda: ks.design.lift_off_speed(PLAIN), "needs a mechanism with a CamRoller"),
        (lambda: ks.design.starting_torque("saw"), "solution must be a Solution"),
        (lambda: ks.design.spring_surge(SOLUTION, 1.0), "needs a solution with one Spring"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(make, message):
    with pytest.raises(ks.ParameterError, match=message):
        make()


@pytest.mark.slow_start  # matplotlib
@every(
    ("make", "message"),
    [
        (lambda: ks.plots.cam_profile(None, 0.05), "must be one of ks.cams"),
        (lambda: ks.plots.cam_profile(CAM, 0.5), "undercuts"),
        (lambda: ks.plots.cam_profile(CAM, 0.05, angles=["a"]), "angles must be"),
        (lambda: ks.plots.cam_curvature({"a": CAM, "b": 3}), "b must be one of ks.cams, got 3"),
        (lambda: ks.plots.cam_curvature({}), "nothing to draw"),
        (lambda: ks.plots.cam_curvature(CAM, -1.0), "roller_radius must be greater than 0"),
        (lambda: ks.plots.cam_pressure_angle(CAM, "wide"), "largest must be"),
        (lambda: ks.plots.contact_pressure(SOLUTION), "must be a Contact"),
        (lambda: ks.plots.law_motion(3), "must be a law"),
        (lambda: ks.plots.law_motion(laws.cosine(1, 2), ax=[1, 2]), "ax must be 4 Axes"),
    ],
)
def test_impossible_drawings_are_refused(make, message):
    with pytest.raises(ks.ParameterError, match=message):
        make()


@pytest.mark.parametrize("shape", [(3, 1), (2, 3, 1)])
def test_batches_of_designs_are_refused(shape):
    batch = ks.solve(SAW, DEGREES, crank_speed=np.full(shape, 30.0))
    for call in (
        partial(ks.design.contact, batch, 0.05, 0.06, 210e9, 0.3),
        partial(ks.design.lift_off_speed, batch),
        partial(ks.design.starting_torque, batch),
    ):
        with pytest.raises(ks.ParameterError, match="works on one design at a time"):
            call()


EXPORTS = [
    ({"path": "cam.txt"}, "ending"),
    ({"path": "cam"}, "ending"),
    ({"path": "cam.DXF.bak"}, "ending"),
    ({"path": "."}, "is a folder"),
    ({"path": "cam\0.svg"}, "is no name of a file"),
    ({"path": None}, "path must be the name of a file"),
    ({"path": 3}, "path must be the name of a file"),
    ({"points": 7}, "points must be from 8 to 100000, got 7"),
    ({"points": 10**9}, "points must be from 8 to 100000"),
    ({"points": 60.0}, "points must be a whole number"),
    ({"points": True}, "points must be a whole number"),
    ({"units": "ft"}, "units is 'ft', allowed: 'mm', 'cm', 'm', 'in'"),
    ({"units": 1}, "units is 1"),
    ({"side": "left"}, "side is 'left'"),
    ({"clockwise": "yes"}, "clockwise must be True or False"),
    ({"cutter_radius": 0.0}, "cutter_radius must be greater than 0"),
    ({"cutter_radius": np.nan}, "cutter_radius must be"),
    ({"roller_radius": "50 mm"}, "roller_radius must be"),
    ({"roller_radius": 0.3}, "undercuts the disk"),
]


@pytest.mark.parametrize(("wrong", "message"), EXPORTS)
def test_impossible_exports_write_nothing(tmp_path, monkeypatch, wrong, message):
    monkeypatch.chdir(tmp_path)
    given = {"path": "cam.svg", "roller_radius": 0.05, "points": 60} | wrong
    with pytest.raises((ks.ParameterError, ks.KinetostaticsError), match=message):
        CAM.export(given.pop("path"), **given)
    assert not list(tmp_path.iterdir())


def test_all_that_is_wrong_with_a_call_is_said_at_once():
    with pytest.raises(ks.ParameterError) as caught:
        CAM.export(3, roller_radius=-1.0, points=2, units="ft", side="left")
    for word in ("roller_radius", "points", "units", "side", "path"):
        assert word in str(caught.value)
    with pytest.raises(ks.ParameterError, match=r"amplitude must .*; mean must .*; phase must"):
        laws.cosine(-1.0, "x", None)


def of_cosine(velocity=1.0, acceleration=1.0, jerk=1.0):
    """A law whose derivatives are what they should be, times factors."""

    def law(phi):
        even, odd = 0.3 * np.cos(phi), 0.3 * np.sin(phi)
        return 2.0 + even, -velocity * odd, -acceleration * even, jerk * odd

    return law


@pytest.mark.parametrize(
    ("factors", "message"),
    [
        ({"velocity": -1.0}, "position changes by .* while its velocity"),
        ({"velocity": np.pi / 180}, "position changes by .* while its velocity"),
        ({"acceleration": -1.0}, "velocity changes by .* while its acceleration"),
        ({"jerk": 0.0}, "acceleration changes by .* while its jerk"),
    ],
)
def test_a_law_whose_derivatives_are_others_is_refused(factors, message):
    assert ks.cams.from_law(of_cosine()).coupler_length > 2.0
    with pytest.raises(ks.ParameterError, match=message):
        ks.cams.from_law(of_cosine(**factors))


def test_a_law_that_fails_is_refused():
    with pytest.raises(ks.ParameterError, match="fails with: division by zero"):
        ks.cams.from_law(lambda phi: 1 / 0)


def test_shifted_law_is_given_its_phase():
    rise, back = laws.cycloidal(1.7, 2.3, np.pi), laws.cycloidal(2.3, 1.7, np.pi)
    law = laws.joined(rise, back)
    with pytest.raises(ks.ParameterError, match=r"farthest near 0 deg .* at 180") as caught:
        ks.cams.from_law(law)
    phase = float(str(caught.value).split("law.shifted(")[1].rstrip(")"))
    assert ks.cams.from_law(law.shifted(phase)).coupler_length > 2.0


@pytest.mark.parametrize("angle", ["a", [1.0, "b"], {}])
def test_law_angles_must_be_numbers(angle):
    with pytest.raises(ks.ParameterError, match="crank angles must be numbers"):
        laws.cosine(0.3, 2.0)(angle)


# Hostile followers and torque-balancing cams

LAW = ks.laws.cosine(0.02, 0.08)
NUMBERS = ("text", None, [1.0], math.nan, math.inf, -math.inf, 1e300, -1.0, 0.0, 1j, object())
KINDS = (
    lambda **given: ks.RollerFollower(**{"cam": LAW} | given),
    lambda **given: ks.FlatFollower(**{"cam": LAW} | given),
    lambda **given: ks.SwingingFollower(**{"cam": LAW, "arm_length": 0.1, "pivot": (0.12, 0.0)} | given),
)
LAWS = (*NUMBERS, LAW(0.0), ks.laws.dwell, ks.cams.CosineLaw(0.3, 2.0), lambda: None, lambda phi: None, print)


@pytest.fixture(scope="module")
def drive():
    return ks.load_case("chain_unit").variants["rho-0.1"].scene


@every("number", range(len(KINDS)))
@every("law", LAWS, ids=range(len(LAWS)))
def test_what_is_no_law_is_refused(number, law):
    with pytest.raises(ks.ParameterError, match="cam"):
        KINDS[number](cam=law)


@every("value", [part for part in NUMBERS if part != "text"], ids=range(len(NUMBERS) - 1))
@every("name", ["pin", "label"])
def test_names_must_be_texts(name, value):
    for kind in KINDS:
        with pytest.raises(ks.ParameterError, match=f"{name} must be a name"):
            kind(**{name: value})


@pytest.mark.parametrize("value", NUMBERS, ids=range(len(NUMBERS)))
@pytest.mark.parametrize("name", ["mass", "travel", "stiffness", "base_radius", "pressure_angle", "roller_radius"])
def test_torque_cam_numbers_are_checked(drive, name, value):
    given = {"mass": 0.3, "travel": 0.012, name: value}
    if value is None and name in ("stiffness", "base_radius", "roller_radius"):
        return
    with pytest.raises(ks.ParameterError):
        ks.design.torque_balancing_cam(drive, **given)


def machines(drive):
    gapped = ks.four_bar(0.3, 0.2, 0.3, rocker_pivot=(0.35, 0.0), rocker=ks.Link(1.0, (0.1, 0.0)))
    mechanism, table = drive.mechanism, np.linspace(1.0, 2.0, 720)[:, None]
    return {
        "gaps": (ks.Scene(gapped, 10.0), "close|assembled|intervals"),
        "batch": (ks.Scene(ks.crank_slider(0.1, table, slider=ks.Link(1.0)), 10.0), "one design at a time"),
        "speeds": (ks.Scene(mechanism, table), "one constant speed"),
        "noise": (
            ks.Scene(mechanism, 10.0, loads=ks.Torque(lambda m: np.sin(1e7 * m.crank_angle), on="rocker")),
            "not smooth between finitely many kinks",
        ),
        "taken": (ks.design.torque_balancing_cam(drive, mass=0.3, travel=0.012).scene, "already even|a second time"),
    }


@pytest.mark.filterwarnings("ignore:.*changes between its samples:kinetostatics.HintWarning")
@pytest.mark.parametrize("name", ["gaps", "batch", "speeds", "noise", "taken"])
def test_machines_that_no_cam_balances_are_refused(drive, name):
    scene, text = machines(drive)[name]
    with pytest.raises(ks.KinetostaticsError, match=text):
        ks.design.torque_balancing_cam(scene, mass=0.3, travel=0.012)
