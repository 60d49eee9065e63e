"""Swinging cylinders: the slotted lever turned inside out, couples about the pivot, and what is refused."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import ConditionWarning, ParameterError
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies.methods.high_precision.certified import differences, enclosure, relative_errors

R, PIVOT = 0.1, (0.05, -0.35)
ANGLES = np.linspace(0.1, 6.2, 9)
ROD, CYLINDER = ks.Link(1.5, (0.15, 0.01), 0.05), ks.Link(3.0, (0.1, -0.02), 0.04)
LOADS = [ks.Gravity(9.81, -1.2)]


def solve(*parts, angles=ANGLES, **options):
    made = ks.Mechanism("oscillating engine", ks.Crank(R), parts)
    return ks.solve(made, angles, **{"crank_speed": 20.0, "crank_acceleration": 5.0, "loads": LOADS} | options)


def test_cylinder_moves_as_a_slotted_lever():
    cylinder, lever = solve(ks.CylinderGroup(PIVOT)), solve(ks.LeverGroup(PIVOT))
    for link in ("rod", "cylinder"):
        assert np.array_equal(cylinder.rate(link), lever.rate("lever"))
        assert np.array_equal(cylinder.angular_acceleration(link), lever.angular_acceleration("lever"))
    rod, bore = (np.array(cylinder.placement.links[name].direction) for name in ("rod", "cylinder"))
    assert np.array_equal(rod, -bore)
    tip = cylinder.position("A") + cylinder.measure("cylinder_length") * rod
    assert np.max(np.abs(tip - np.array(PIVOT)[:, None])) < 1e-16


def test_its_length_is_by_the_law_of_cosines():
    d, lean = np.hypot(*PIVOT), np.arctan2(PIVOT[1], PIVOT[0])
    expected = np.sqrt(R**2 + d**2 - 2 * R * d * np.cos(ANGLES - lean))
    assert np.max(np.abs(solve(ks.CylinderGroup(PIVOT)).measure("cylinder_length") - expected)) < 1e-15


def test_a_cylinder_of_no_mass_bears_no_couple():
    s = solve(ks.CylinderGroup(PIVOT, rod=ROD))
    assert np.all(s.scalar("cylinder_moment") == 0.0)
    assert np.max(np.abs(s.scalar("cylinder_force"))) > 1.0


def test_pin_meeting_the_pivot_warns():
    with pytest.warns(ConditionWarning, match="at crank angle 0 deg .* near a limit position"):
        solve(ks.CylinderGroup((R, 0.0)), angles=np.array([0.0, 1.0]))


def test_requirement_tells_the_distances():
    group = ks.CylinderGroup(PIVOT)
    placement = ks.Mechanism("engine", ks.Crank(R), (group,)).place(ANGLES)
    words = group.requirement(placement)
    assert words.startswith("the distance from A to O2, 0.2")
    assert words.endswith("must be greater than zero")


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"pivot": "O2"}, "cylinder pivot must be a pair"),
        ({"pivot": (np.inf, 0.0)}, "cylinder pivot x must be finite"),
        ({"rod": 1.0}, "rod must be a Link"),
        ({"cylinder": 1.0}, "cylinder must be a Link"),
        ({"on": None}, "on must be a name"),
        ({"label": 2}, "label must be a name"),
    ],
)
def test_what_no_cylinder_can_have_is_refused(fields, words):
    with pytest.raises(ParameterError, match=f"cylinder group: {words}"):
        ks.CylinderGroup(**{"pivot": PIVOT} | fields)


@pytest.mark.parametrize("margin", [1e-3, 1e-6, 1e-9])
def test_pin_clearing_the_pivot_keeps_its_digits(flint, margin):
    reach = 0.3125
    group = ks.CylinderGroup((reach, 0.0), rod=ROD, cylinder=CYLINDER)
    engine = ks.Mechanism("engine", ks.Crank(reach * (1.0 - margin)), (group,))
    s = ks.solve(engine, margin * np.linspace(-2.0, 2.0, 21), crank_speed=20.0, loads=LOADS)
    for quantity in ("cylinder_rate", "O"):
        exact = enclosure(s, quantity, digits=20)
        moved = differences(enclosure(s.at(np.nextafter(s.crank_angle, 9.0)), quantity, digits=20), exact)
        assert relative_errors(components(s, quantity), exact).max() <= 5.0 * (UNIT_ROUNDOFF + moved.max())
