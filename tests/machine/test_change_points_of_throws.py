"""Change points of groups on a second throw are those on the pin of a crank turned ahead."""

import numpy as np
import pytest

import kinetostatics as ks
from support.change_points import LINKAGES, LINKS, NEAR, SIDES, SPEED, solve
from support.every import every


def thrown(group, at):
    """A group on a pin of the crank, its crank without a mass of its own."""
    return ks.Mechanism("thrown", ks.Crank(0.7), (ks.Pin("crank", at, "C"), group))


def hung(kind, assembly, on):
    if kind == "slider":
        return ks.SliderGroup(0.75, ks.Guide.at(0.4, -0.25), assembly, LINKS["coupler"], LINKS["rocker"], on=on)
    if kind == "lever":
        return ks.LeverGroup((-0.3, -0.4), on, lever=LINKS["rocker"], block=LINKS["coupler"], assembly=assembly)
    _, b, h, d = (0.5 * length for length in LINKAGES[kind])
    return ks.RockerGroup(b, h, (-0.8 * d, 0.6 * d), assembly, LINKS["coupler"], LINKS["rocker"], on=on)


@pytest.mark.slow
@every("assembly", SIDES)
@every("ahead", [(0.0, 0.5), (-0.5, 0.0), (0.3, 0.4), (-0.4, -0.3), (0.5, 0.0)])
@every("kind", [*LINKAGES, "slider", "lever"])
def test_second_throw_equals_a_crank_turned_ahead(kind, ahead, assembly):
    """Both count the crank angle from where the pin points to the pivot, or along the guide's right normal."""
    radius = LINKAGES[kind][0] * 0.5 if kind in LINKAGES else 0.5
    at = tuple(2.0 * radius * part for part in ahead)
    angles = np.array([0.3, 2.0, 5.0, 8.0, 11.0])
    group = hung(kind, assembly, "A")
    x, y = (group.guide.direction[1], -group.guide.direction[0]) if kind == "slider" else group.pivot
    own = ks.Mechanism("own", ks.Crank(radius), (group,))
    turn = np.angle(x + 1j * y) - np.angle((x + 1j * y) / complex(*at))
    made = thrown(hung(kind, assembly, "C"), at)
    assert made.passes
    assert made.turns == own.turns
    expected, found = solve(own, angles + turn), solve(made, angles)
    for values, right in (
        (found.balancing_torque, expected.balancing_torque),
        (found.reaction("C"), expected.reaction("A")),
        *((found.rate(link), expected.rate(link)) for link in made.groups[1].links),
        *((found.acceleration(name), expected.acceleration(name)) for name in list(made.groups[1].joints)[:1]),
    ):
        np.testing.assert_allclose(values, right, rtol=0, atol=1e-11 * (np.abs(right).max() + 1.0))
    both = np.sort((np.array(own.change_points) - turn) % (2 * np.pi))
    np.testing.assert_allclose(made.change_points, both, atol=1e-14)


@pytest.mark.parametrize("assembly", SIDES)
@pytest.mark.parametrize("name", ["parallelogram", "kite", "deltoid", "rhombus", "near"])
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_second_throw_is_as_exact_as_the_first(name, assembly):
    """The whole turned by a quarter: crank angles near the change point stay as fine as they can be."""
    a, b, h, d = map(float, LINKAGES[name])
    links = {link: LINKS[link] for link in ("coupler", "rocker")}
    own = ks.Mechanism("own", ks.Crank(a), (ks.RockerGroup(b, h, (d, 0.0), assembly, **links),))
    made = thrown(ks.RockerGroup(b, h, (0.0, d), assembly, on="C", **links), (0.0, a))
    expected, found = (solve(item, np.array(NEAR), loads=()) for item in (own, made))
    np.testing.assert_allclose(found.balancing_torque, expected.balancing_torque, rtol=1e-12)
    np.testing.assert_allclose(found.angular_acceleration("coupler"), expected.angular_acceleration("coupler"), 1e-12)
    (x, y), (along, across) = expected.reaction("O2"), found.reaction("O2")
    assert np.all(np.maximum(abs(along + y), abs(across - x)) < 1e-12 * np.maximum(abs(x), abs(y)))


def test_program_keeps_the_radius_of_the_pin():
    made = thrown(hung("parallelogram", "open", "C"), (0.4, 0.3))
    found = ks.compile(ks.Scene(made, SPEED, loads=ks.Gravity()), "balancing_torque", engine="numpy")
    with pytest.raises(ks.ParameterError, match="another kind"):
        found(0.3, {"pin_C.along": 0.41})
    with pytest.raises(ks.ParameterError, match=r"no derivative by pin_C.across"):
        found.derivatives(0.3, "pin_C.across")
    assert "pin_C.along" not in found.derivatives(0.3)["balancing_torque"]
    other = thrown(hung("parallelogram", "open", "C"), (0.5, 0.0))
    values = found(0.3, {"pin_C.along": 0.5, "pin_C.across": 0.0})["balancing_torque"]
    np.testing.assert_allclose(values, ks.Scene(other, SPEED, loads=ks.Gravity()).solve(0.3).balancing_torque)


@pytest.mark.parametrize("at", [(0.0, 0.625), (0.375, 0.5), (-0.625, 0.0)])
def test_second_throw_enclosures_hold(at):
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    from kinetostatics.studies.methods.high_precision.certified import certified

    rockers = ks.RockerGroup(1.875, 1.25, (-1.5, 2.0), "crossed", LINKS["coupler"], LINKS["rocker"], on="C")
    made = thrown(rockers, at)
    found = certified(solve(made, np.array([0.3, 4.0, 9.0])), "balancing_torque")
    assert found.agreement < 1e-25


@pytest.mark.parametrize("at", [(0.0, 0.0), (0.5, 0.0)])
def test_other_pins_have_no_change_points(at):
    if any(at):
        groups = (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ks.Pin("coupler", at), hung("deltoid", "open", "C"))
    else:
        groups = (ks.Pin("crank", at), hung("deltoid", "open", "C"))
    with pytest.raises(ks.ParameterError, match="but it hangs on 'C'; give"):
        ks.Mechanism("chain", ks.Crank(0.1), groups)
