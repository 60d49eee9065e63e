"""`Solution.ground`: its places by name, their points and couples, quantities of the same name, and refusals."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.links import Wrench
from kinetostatics.machine.loads import Load
from support.case_files import shipped
from support.every import every
from support.scenes import Pan, with_group

ANGLES = np.linspace(0.1, 6.2, 9)
ROLLER = ks.Roller(0.05, 0.04, 210e9, 0.3)
SHOE = ks.GuideFriction(0.1, 0.2)


def saw(roller=None, friction=(), loads=()):
    cam = ks.cams.Circle(0.3, (-0.0219, 0.004))
    machine = ks.cam_crank_slider(cam, 2.0219, slider=ks.Link(600.0), block=ks.Link(30.0), roller=roller)
    return ks.solve(machine, ANGLES, crank_speed=33.5, loads=[ks.Gravity(), *loads], friction=dict(friction))


def bars(*loads, **options):
    given = {"coupler": ks.Link(2.0, 0.2, 0.1), "rocker": ks.Link(1.0, 0.1, 0.1)}
    return ks.solve(
        ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), **given), ANGLES, crank_speed=9.0, loads=loads, **options
    )


V_TWIN = ks.Mechanism(
    "V twin", ks.Crank(0.05), (ks.SliderGroup(0.2), ks.SliderGroup(0.2, ks.Guide.at(1.5), pin="C", label="2"))
)
SPRING = ks.PointSpring(900.0, 0.1, between=("B", (0.0, 0.5)))
PLACES = [
    (lambda: saw(), ["O", "cam", "guide", "motor"]),
    (lambda: bars(), ["O", "O2", "motor"]),
    (lambda: bars(SPRING, ks.PointDamper(5.0, between=((0.1, 0.2), "B")), SPRING), "point_damper"),
    (lambda: bars(SPRING, SPRING), ["O", "O2", "point_spring", "point_spring2", "motor"]),
    (lambda: bars(ks.Torque(5.0, on="rocker")), ["O", "O2", "torque", "motor"]),
    (lambda: bars(ks.Torque(5.0, on="rocker", against="coupler")), ["O", "O2", "motor"]),
    (lambda: bars(ks.TorsionDamper(5.0, on="crank", against="frame")), ["O", "O2", "torsion_damper", "motor"]),
    (lambda: bars(ks.PointForce(5.0, between=("A", "B")), ks.Force(7.0, at=(0.1, 0.0))), ["O", "O2", "motor"]),
    (
        lambda: saw(loads=[ks.ProcessForce(5.0), ks.ProcessForce(7.0, reaction="frame"), ks.Spring(9.0, 1.0)]),
        ["O", "cam", "guide", "process_force2", "spring", "motor"],
    ),
    (
        lambda: ks.solve(V_TWIN, ANGLES, crank_speed=9.0, loads=ks.Spring(10.0, 0.1, "slider2")),
        ["O", "guide", "guide2", "spring", "motor"],
    ),
]


@every("made, names", PLACES)
def test_places_by_name(made, names):
    ground = made().ground
    assert names in ground if isinstance(names, str) else list(ground) == names
    assert len(ground) == len(list(ground))
    assert "weight" not in ground


def test_fixed_pivots_and_guides_take_the_opposite_of_reactions():
    s = saw(friction={"O": ks.PinFriction(0.05, 0.04), "guide": SHOE})
    for name in ("O", "guide"):
        assert_allclose(s.ground[name].force, -s.reaction(name), rtol=1e-13)
    assert_allclose(s.ground["O"].couple, -s.friction_at("O"), rtol=1e-13)
    assert_allclose(s.ground["guide"].point, s.position("B"))
    assert_allclose(s.ground["motor"].couple, -s.balancing_torque)
    assert not s.ground["motor"].force.any()


@every("radius", [0.0, 0.05])
def test_the_cam_is_pushed_along_its_normal_at_the_contact(radius):
    s = saw(ROLLER if radius else None, loads=[ks.Spring(2e6, 1.0)])
    force, point, couple = s.ground["cam"]
    assert_allclose(np.hypot(*force), abs(s.cam_force), rtol=1e-13)
    assert not couple.any()
    outward = s.position("A") - np.array([[-0.0219], [0.004]])  # from the centre of the pitch circle
    outward = outward / np.hypot(*outward)
    assert_allclose(force, s.cam_force * outward, atol=1e-10 * np.abs(force).max())
    side = np.sign(s.cam_force)  # a ring pushes inward, a disk outward
    assert set(side) == {-1.0, 1.0}
    assert_allclose(point, s.position("A") + radius * side * outward, atol=1e-14)


def test_friction_of_the_roller_pushes_the_cam_along():
    friction = ks.RollerFriction(0.05, 0.02, 0.05)
    s, smooth = saw(friction={"cam": friction}), saw()
    force, point, _ = s.ground["cam"]
    across = smooth.ground["cam"].force / smooth.cam_force
    along = np.array([-across[1], across[0]])  # way of the roller
    assert_allclose((force * along).sum(axis=0), -s.friction_at("cam"), rtol=1e-10)
    assert_allclose(np.hypot(*(point - s.position("A"))), friction.roller_radius, rtol=1e-13)


def test_springs_and_dampers_push_at_their_feet():
    rate, free = 5e3, 1.9
    s = saw(loads=[ks.Spring(rate, free)])
    force, point, _ = s.ground["spring"]
    assert_allclose(force, [rate * (s.slider_position - free), np.zeros(9)], rtol=1e-12)
    assert_allclose(point, np.broadcast_to([[free], [0.0]], (2, 9)))
    s = bars(SPRING)
    force, point, _ = s.ground["point_spring"]
    assert_allclose(point, np.broadcast_to([[0.0], [0.5]], (2, 9)))
    to_link = s.position("B") - point
    length = np.hypot(*to_link)
    assert_allclose(force, 900.0 * (length - 0.1) / length * to_link, rtol=1e-12)
    s = bars(ks.TorsionSpring(40.0, 1.5, on="rocker"))
    _, point, couple = s.ground["torsion_spring"]
    rocker = s.position("B") - s.position("O2")
    assert_allclose(couple, 40.0 * (np.arctan2(rocker[1], rocker[0]) - 1.5), rtol=1e-12)
    assert_allclose(point, s.position("O2"))


class Wire(Load):
    """A load of the user's own, on the rocker and the frame."""

    def wrenches(self, motion):
        """On the rocker about O2, on the frame about O."""
        yield "rocker", Wrench((3.0, 4.0), 0.5)
        yield "frame", Wrench((-3.0, -4.0), -0.5 - (0.35 * 4.0 - 0.1 * 3.0))


def test_a_load_of_the_users_own_pushes_the_frame_by_its_wrench_about_o():
    s = bars(Wire())
    assert list(s.ground) == ["O", "O2", "Wire", "motor"]
    assert_allclose(s.ground.resultant, s.shaking_force, atol=1e-12 * s.largest_force_term)
    assert_allclose(s.ground.moment(), s.shaking_moment, atol=1e-12 * s.largest_force_term)


class OwnSlider(ks.SliderGroup):
    """A group of the user's own, with pairs as of another."""


def test_a_group_of_the_users_own_that_pushes_the_frame_by_no_pair_is_warned_of():
    own = ks.Mechanism("own", ks.Crank(0.1), (OwnSlider(0.4, slider=ks.Link(3.0)),))
    s = ks.solve(own, ANGLES, crank_speed=9.0, loads=ks.Gravity())
    assert list(s.ground) == ["O", "guide", "motor"]
    lacking = with_group(Pan(ks.Link(3.0, 0.05))).solve(ANGLES)
    with pytest.warns(UserWarning, match=r"on the frame lack up to 0 N and 52 N m about O. A group of your own"):
        assert list(lacking.ground) == ["O", "motor"]
    with pytest.warns(UserWarning, match="the forces on the frame lack"):
        ks.extremes(lacking, "ground O")


def test_designs_and_gaps():
    sizes = np.array([[0.2], [0.3], [0.5]])
    open_too = ks.crank_slider(sizes, 0.45, guide_offset=0.02, slider=ks.Link(6.0))
    s = ks.solve(open_too, ANGLES, crank_speed=9.0, loads=[ks.Gravity(), ks.Spring(90.0, 0.3)], on_gap="nan")
    assert 0 < np.isnan(s.ground.resultant[0, 2]).sum() < ANGLES.size
    for name, (force, point, couple) in s.ground.items():
        assert force.shape == point.shape == (2, 3, 9), name
        assert couple.shape == (3, 9), name
        assert name == "motor" or np.array_equal(np.isnan(force[0]), ~s.closed), name
    assert np.array_equal(np.isnan(s.ground.moment()), ~s.closed)
    with pytest.raises(ks.ParameterError, match="one design at a time"):
        s.ground.table()


REFUSED = [
    (ks.QuantityError, lambda s: s.ground["weight"], "place on the frame is 'weight', allowed: 'O', 'cam', 'guide'"),
    (ks.QuantityError, lambda s: s.ground["gide"], "did you mean 'guide'?"),
    (ks.QuantityError, lambda s: s.ground[0], "place on the frame is 0, allowed"),
    (ks.QuantityError, lambda s: s.ground_force("weight"), "place on the frame is 'weight'"),
    (ks.QuantityError, lambda s: ks.extremes(s, "ground motor"), "quantity is 'ground motor', allowed:"),
    (ks.QuantityError, lambda s: ks.extremes(s, "ground came"), "did you mean 'ground cam'?"),
    (ks.ParameterError, lambda s: s.ground.moment(1.0), "about must be"),
    (ks.ParameterError, lambda s: s.ground.moment((1.0, np.nan)), "about"),
    (
        ks.ParameterError,
        lambda s: ks.ProcessForce(5.0, reaction="ground"),
        "reaction is 'ground', allowed: 'outside', 'fr",
    ),
]


@every("error, call, words", REFUSED)
def test_what_is_refused(error, call, words):
    with pytest.raises(error) as caught:
        call(saw())
    assert words in str(caught.value)


def test_a_joint_may_not_be_called_ground():
    with pytest.raises(ks.ParameterError, match="ground"):
        ks.Mechanism("bars", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.1), pivot_name="ground"),))


@pytest.mark.slow
def test_the_table_has_true_extremes_of_forces_and_couples():
    s = shipped("sawframe_2r63").variants["cam-circle"].scene.solve(12)
    table = s.ground.table()
    assert list(table.index) == ["all", "O", "cam", "guide", "spring", "motor"]
    assert_allclose(table.loc["cam", "force [N]"], ks.extremes(s, "ground cam").largest)
    torque = ks.extremes(s, "balancing_torque")
    assert_allclose(abs(table.loc["motor", "couple [N m]"]), abs(torque.value).max())
    assert np.isnan(table.loc["motor", "force [N]"])
    assert np.isnan(table.loc["spring", "couple [N m]"])


@pytest.mark.slow
def test_forces_on_the_frame_are_quantities_as_others():
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    scene = shipped("sawframe_2r63").variants["cam-circle"].scene
    names = ("ground", "ground cam", "ground spring")
    s = scene.solve(ANGLES)
    program = ks.compile(scene, names)
    for name in names:
        own = s.ground_force(*name.split()[1:])
        assert_allclose(program(ANGLES)[name], own, rtol=1e-12, atol=1e-12 * np.abs(own).max())
        assert s.error_bound(f"|{name}|").max() < 1e-12 * np.abs(own).max()
    slope = program.derivatives(ANGLES, by=["spring.stiffness"])["ground spring"]["spring.stiffness"]
    spring = s.ground["spring"].force
    assert_allclose(slope[0], spring[0] / program.parameters["spring.stiffness"], rtol=1e-12, atol=1e-13)
    reduced = ks.sweep(
        lambda mass: scene, pd.DataFrame({"mass": [1.0]}), ["largest ground cam", "largest ground"], progress=False
    )
    assert_allclose(reduced["largest ground cam [N]"], ks.extremes(s, "ground cam").largest, rtol=1e-5)


def test_at_passed_change_points_they_grow_without_bound():
    kite = ks.solve(ks.four_bar(0.1, 0.1, 0.3, rocker_pivot=(0.3, 0.0), assembly="open"), ANGLES, crank_speed=9.0)
    assert all(kite.mechanism.grows(name) for name in ("O", "ground O", "ground O2", "ground"))
