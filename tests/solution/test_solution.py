"""What a solution holds: quantities, contacts, contents."""

import inspect
import re

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.mechanism import Mechanism
from kinetostatics.mechanics import quantities
from support.cam_contacts import rolled, solved
from support.every import every

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def balanced_pump(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_torque_by_power_computes_no_reaction(monkeypatch):
    expected = balanced_pump().balancing_torque

    def refuse(*_):
        raise AssertionError("forces were resolved")

    monkeypatch.setattr(Mechanism, "resolve", refuse)
    np.testing.assert_allclose(balanced_pump().balancing_torque_by_power, expected, atol=1e-9)


def test_motion_and_shaking_force_compute_no_reaction(monkeypatch):
    monkeypatch.setattr(Mechanism, "resolve", None)
    solution = balanced_pump()
    assert solution.position("B").shape == solution.shaking_force.shape == (2, TURN.size)


def test_standing_mechanism_is_in_static_equilibrium():
    standing = balanced_pump(crank_speed=0.0)
    work = 150 * 9.81 * standing.at(TURN).position("coupler")[1]
    slope = np.fft.irfft(1j * np.arange(TURN.size // 2 + 1) * np.fft.rfft(work), TURN.size)
    np.testing.assert_allclose(standing.balancing_torque, slope, atol=1e-6)
    assert standing.power_residual < 1e-14


def test_power_residual_shows_a_torque_that_is_wrong(monkeypatch):
    monkeypatch.setattr(ks.Solution, "balancing_torque", property(lambda s: s.scalar("balancing_torque") + 1.0))
    solution = balanced_pump()
    assert solution.power_residual == pytest.approx(1.0 / solution.largest_torque_term, rel=1e-9)
    assert 1e-5 < solution.power_residual < 1e-4


def test_cosine_cam_warns_off_its_law():
    law = ks.cams.CosineLaw(0.3, 2.0)
    with pytest.warns(UserWarning, match=r"coupler_length 2.0 m is not the cam's 2.02"):
        ks.cam_crank_slider(law, 2.0)
    with pytest.warns(UserWarning, match="guide_offset 0.1 m is not 0"):
        ks.cam_crank_slider(law, law.coupler_length, guide_offset=0.1)


def rockers_slider(length, assembly=1):
    """A slider hung on a rocker whose pivot its guide runs through."""
    ram = ks.SliderGroup(length, ks.Guide.at(0.0, 0.1), assembly, on="B", pin="C", label="2")
    return ks.Mechanism("press", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ram))


@pytest.mark.parametrize("mechanism", [ks.crank_slider(0.1, 0.1, assembly="crossed"), rockers_slider(0.3)])
def test_slider_that_never_moves_is_warned_of(mechanism):
    with pytest.warns(
        ks.HintWarning, match=r"the slider2? stands still all over the turn: the coupler2? is as long as"
    ):
        ks.solve(mechanism, 0.3, crank_speed=1.0)


@every(
    "mechanism",
    [
        ks.crank_slider(0.1, 0.1, assembly="open"),
        ks.crank_slider(0.1, 0.1, guide_offset=0.01, assembly=-1),
        ks.crank_slider(0.1, 0.1),
        rockers_slider(0.3, -1),
        rockers_slider(0.31),
    ],
)
def test_sliders_that_move_are_not_warned_of(mechanism):
    assert mechanism.hints == ()


# Crank angles as solutions keep them


def test_a_single_crank_angle_gives_single_values():
    solution = balanced_pump(0.5)
    assert solution.balancing_torque.shape == ()
    assert solution.reaction("O").shape == (2,)
    assert solution.power_residual < 1e-14


def test_results_are_read_only_and_stay():
    turn = TURN.copy()
    solution = balanced_pump(turn)
    before = solution.guide_force.copy()
    turn[:] = 0.0
    np.testing.assert_array_equal(solution.at(TURN).guide_force, before)
    with pytest.raises(ValueError, match="read-only"):
        solution.guide_force[0] = 0.0


def test_integer_angles_do_not_truncate_results():
    np.testing.assert_array_equal(balanced_pump(np.arange(4)).rate("crank"), np.full(4, 33.5))


# A scene


TWELVE = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
SCENE = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), 10.0, 2.0, (ks.Gravity(), ks.Spring(500.0, 0.4)))


def test_a_scene_is_solved_as_its_parts_are():
    whole, parts = (
        SCENE.solve(TWELVE),
        ks.solve(SCENE.mechanism, TWELVE, crank_speed=10.0, crank_acceleration=2.0, loads=SCENE.loads),
    )
    assert np.array_equal(whole.balancing_torque, parts.balancing_torque)
    assert SCENE.solve(12).crank_angle == pytest.approx(TWELVE)


def test_the_period_is_that_of_loads_and_mechanism():
    table = ks.Table(np.pi * np.arange(4), [1.0, 2.0, 1.0, 0.0], period=4 * np.pi)
    assert SCENE.period == 2 * np.pi
    assert ks.Scene(SCENE.mechanism, 1.0, loads=(ks.ProcessForce(table, period=4 * np.pi),)).period == 4 * np.pi


# Drive and loads in a line, and tables among them


def test_scene_and_solution_print_in_a_line():
    speed = np.linspace(30.0, 40.0, TURN.size)
    scene = ks.Scene(SAW, speed, loads=[ks.Gravity(), ks.ProcessForce(speed)])
    drive = "crank_speed=<array of shape (24,)>, crank_acceleration=0.0, Gravity, ProcessForce>"
    assert repr(scene) == f"<Scene: crank-slider, {drive}"
    assert repr(scene.solve(TURN)) == f"<Solution: crank-slider, shape (24,), {drive}"
    assert repr(ks.Scene(SAW, 33.5)) == "<Scene: crank-slider, crank_speed=33.5, crank_acceleration=0.0, no loads>"


# A solution as a table


def test_frame_has_a_row_an_angle_with_units():
    table = balanced_pump().frame()
    assert len(table) == TURN.size
    assert all(name.endswith("]") for name in table.columns)
    np.testing.assert_allclose(table["crank_angle [deg]"], np.arange(0, 360, 15))
    np.testing.assert_array_equal(table["balancing_torque [N m]"], balanced_pump().balancing_torque)
    np.testing.assert_array_equal(table["reaction_O_x [N]"], balanced_pump().reaction("O")[0])


def test_frame_of_a_batch_numbers_its_designs():
    batch = ks.solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(600)), TURN, crank_speed=33.5)
    table = batch.frame()
    assert len(table) == 2 * TURN.size
    np.testing.assert_array_equal(table["design"], np.repeat([0, 1], TURN.size))
    np.testing.assert_array_equal(table["A_x [m]"], batch.position("A")[0].ravel())


def two_sliders(*labels):
    """A crank that drives a slider of each label."""
    sliders = (ks.SliderGroup(0.4, ks.Guide.at(turn), pin=f"B{turn}", label=label) for turn, label in enumerate(labels))
    return ks.solve(ks.Mechanism("engine", ks.Crank(0.1), tuple(sliders)), ANGLES_OF_SLIDERS, crank_speed=5.0)


ANGLES_OF_SLIDERS = np.linspace(0.1, 6.0, 5)


def test_frame_has_motion_of_every_slider():
    s = two_sliders("1", "2")
    table = s.frame()
    for slider in ("slider1", "slider2"):
        assert np.array_equal(table[f"{slider}_position [m]"], s.travel(slider))
        assert np.array_equal(table[f"{slider}_velocity [m/s]"], s.travel_velocity(slider))
        assert np.array_equal(table[f"{slider}_acceleration [m/s2]"], s.travel_acceleration(slider))


# Contact pressure of a solution, by name

FACE = ks.Face(0.02, 210e9, 0.3)


def test_a_pressure_is_read_by_name_and_kept():
    found = solved(machine=rolled())
    assert found.pressure() is found.contact_pressure
    assert found.pressure("contact_pressure") is found.contact_pressure


def test_that_of_a_second_follower_has_its_label():
    groups = [ks.FlatFollower(ks.laws.cosine(0.01, 0.05), face=FACE, pin=f"F{n}", label=n) for n in ("1", "2")]
    loads = [ks.Spring(k, -0.05, on=f"follower{n}") for n, k in (("1", 5e4), ("2", 2e5))]
    machine = ks.Mechanism("two cams", ks.Crank(None), tuple(groups))
    found = ks.solve(machine, 0.5, crank_speed=0.0, loads=loads)
    assert found.pressure("contact_pressure2") == pytest.approx(2 * found.pressure("contact_pressure1"), rel=1e-13)
    with pytest.raises(ks.QuantityError, match="contact is 'contact_pressure', allowed: 'contact_pressure1', 'con"):
        found.contact_pressure  # noqa: B018


def test_a_quantity_of_another_kind_is_no_pressure():
    with pytest.raises(ks.QuantityError, match="contact is 'O', allowed: 'contact_pressure'"):
        solved(machine=rolled()).pressure("O")
    with pytest.raises(ks.QuantityError, match="has no contact pressure"):
        ks.solve(ks.crank_slider(0.1, 0.4), np.zeros(2), crank_speed=1.0).contact_pressure  # noqa: B018


def test_what_is_no_name_is_no_pressure():
    with pytest.raises(ks.ParameterError, match="quantity must be a name"):
        solved(machine=rolled()).pressure([])


# What the docstring of `Solution` lists is what there is, with the bodies and units that parts declare

TEXT = inspect.getdoc(ks.Solution)
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


@every("name", MACHINES)
def test_reactions_are_listed_with_their_body(name):
    section = " ".join(TEXT[TEXT.index("A reaction acts") : TEXT.index("Your own groups and loads")].split())
    for joint, output in MACHINES[name].outputs.items():
        if not output.vector:
            continue
        assert f'"{joint}"' in section
        giver, _, taker = output.text.partition(" on ")
        assert output.text in section or (giver == "ground" and f"on {taker}" in section) or "from what" in output.text


@every("name", MACHINES)
def test_every_scalar_is_listed(name):
    scalars = [scalar for scalar, output in MACHINES[name].outputs.items() if not output.vector]
    assert scalars
    assert all(re.search(rf"\b{scalar}\b", ks.Solution.scalar.__doc__) for scalar in scalars)


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


def test_reading_a_force_lists_no_quantities():
    """For each new mechanism the list would take as long as the solution."""
    made = ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0))
    turn = ks.solve(made, np.linspace(0.0, 6.0, 8), crank_speed=33.5)
    assert turn.balancing_torque.size == turn.reaction("O").shape[1] == 8
    assert made not in quantities._known
