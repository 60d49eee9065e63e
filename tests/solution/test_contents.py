"""What the docstring of `Solution` lists is what there is, with the bodies and units that parts declare."""

import inspect
import re

import numpy as np
import pytest

import kinetostatics as ks

TEXT = ks.Solution.__doc__
CAM = ks.cams.Circle(0.3, (-0.02, 0.0))
MACHINES = {
    "crank-slider": ks.crank_slider(0.3, 2.0),
    "cam": ks.cam_crank_slider(CAM, 2.02),
    "four-bar": ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)),
    "lever": ks.slotted_lever(0.1, pivot=(0.0, -0.2)),
    "yoke": ks.scotch_yoke(0.1),
    "cylinder": ks.Mechanism("pump", ks.Crank(0.1), (ks.CylinderGroup((1.0, 0.0)),)),
    "follower": ks.Mechanism("cam", ks.Crank(), (ks.RollerFollower(ks.laws.cosine(0.01, 0.05)),)),
}


def members():
    """Public attributes and methods of a solution."""
    own = [base for base in ks.Solution.__mro__ if base.__module__.startswith("kinetostatics")]
    names = {name for base in own for name in (*vars(base), *vars(base).get("__annotations__", ()))}
    return {name for name in names if not name.startswith("_")}


def listed():
    """Names that the docstring lists as attributes and methods."""
    lists = re.split(r"\n(?:Attributes|Methods|Notes)\n-+\n", TEXT)[1:3]
    heads = [line.partition(" : ")[0] for text in lists for line in text.splitlines() if line and line[0] != " "]
    return {name for head in heads for name in re.findall(r"(\w+)(?:\([^)]*\))?", re.sub(r"\([^)]*\)", "", head))}


def test_everything_public_is_in_the_docstring():
    notes = set(re.findall(r"`(\w+)`", TEXT))
    assert members() - listed() - notes == set()


def test_everything_that_the_docstring_lists_exists():
    assert listed() - members() == set()


def test_every_method_is_listed_with_its_arguments():
    for name, arguments in re.findall(r"(?:^|, )(\w+)\(([^)]*)\)(?=,|$)", TEXT, flags=re.MULTILINE):
        told = [part.strip() for part in arguments.split(",") if part.strip()]
        if name in members():
            assert told == list(inspect.signature(getattr(ks.Solution, name)).parameters)[1:], name


@pytest.mark.parametrize("name", MACHINES)
def test_reactions_are_listed_with_their_body(name):
    section = " ".join(TEXT[TEXT.index("A reaction acts") : TEXT.index("For groups and loads")].split())
    for joint, output in MACHINES[name].outputs.items():
        if not output.vector:
            continue
        assert f'"{joint}"' in section
        giver, _, taker = output.text.partition(" on ")
        assert output.text in section or (giver == "ground" and f"on {taker}" in section) or "from what" in output.text


@pytest.mark.parametrize("name", MACHINES)
def test_every_scalar_is_listed(name):
    scalars = [scalar for scalar, output in MACHINES[name].outputs.items() if not output.vector]
    assert scalars
    assert all(re.search(rf"\b{scalar}\b", TEXT) for scalar in scalars)


@pytest.mark.parametrize("speed", [33.5, -33.5])
def test_drive_power_is_torque_times_speed(speed):
    """A force that resists the slider: the drive gives its power, however the crank turns."""
    saw = ks.crank_slider(0.3, 2.0)
    resisting = ks.ProcessForce(lambda motion: -1e3 * np.sign(motion.slider_velocity))
    s = ks.solve(saw, np.array([1.0, 2.0, 4.0, 5.0]), crank_speed=speed, loads=resisting)
    power = s.balancing_torque * s.crank_speed
    assert (power > 0).all()
    np.testing.assert_allclose(power, 1e3 * abs(s.slider_velocity), rtol=1e-12)
    assert (np.sign(s.balancing_torque) == np.sign(speed)).all()
