"""Sawing and mowing: forces over the stroke of a slider that are constant while it cuts."""

import importlib.util
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.design import case_text
from kinetostatics.errors import NotGivenError
from kinetostatics.mechanics import free_body
from kinetostatics.studies.methods.global_system import newton
from kinetostatics.studies.methods.high_precision.certified import certified
from support import mirror
from support.case_files import case_file, problems
from support.every import every
from support.machines import largest

TURN = np.linspace(0.05, 0.05 + 2 * np.pi, 90, endpoint=False)
CUT = {"kerf": 3.2e-3, "height": 0.25, "saws": 8, "feed_per_stroke": 0.02, "resistance": 50e6}
WORK = 50e6 * 8 * 3.2e-3 * 0.25 * 0.02
"""Of a cutting stroke, J: K times the volume of wood."""
LINKS = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)}
CROP = ks.Mowing(600.0, pitch=0.0762, start=0.026, end=0.060)
COSINE = ks.cams.CosineLaw(0.3, 2.0)
SAMPLES = np.radians(np.arange(0.0, 360.0, 0.5))
FRAMES = {
    "centric": ks.crank_slider(0.3, 2.0, **LINKS),
    "offset": ks.crank_slider(0.3, 1.0, guide_offset=0.2, guide_angle=0.5, **LINKS),
    "behind": ks.crank_slider(0.3, 1.0, guide_offset=-0.2, guide_angle=2.5, assembly=-1, **LINKS),
    "cam": ks.cam_crank_slider(COSINE, COSINE.coupler_length, **LINKS),
    "yoke": ks.scotch_yoke(0.3, slider=ks.Link(600.0)),
    "sampled cam": ks.cam_crank_slider(
        ks.cams.Sampled(SAMPLES, COSINE.radius(SAMPLES)[0]), COSINE.coupler_length, **LINKS
    ),
}


def sawing(**changes):
    return ks.Sawing(**CUT | changes)


def scene(frame="offset", speed=33.5, loads=None, **changes):
    return ks.Scene(FRAMES[frame], speed, loads=[ks.Gravity(), loads or sawing(**changes)])


def travelled(s):
    """Coordinates of the dead centres, by extremes of the travel."""
    found = ks.extremes(s, "slider_position").value
    return found.max(), found.min()


# The saw


@pytest.mark.slow
@every("frame", FRAMES)
@every("speed", (33.5, -33.5))
@every("cuts", ("toward crank", "away"))
def test_power_is_the_mean_force_times_stroke_times_strokes_a_second(frame, speed, cuts):
    s = scene(frame, speed, cuts=cuts).solve(7)
    assert s.losses.drive == pytest.approx(WORK * abs(speed) / (2 * np.pi), rel=2e-14)


@pytest.mark.slow
@every("frame", ("centric", "offset", "behind", "cam"))
@every("speed", (33.5, -33.5))
@every("cuts", ("toward crank", "away"))
def test_force_acts_against_the_motion_on_the_cutting_stroke_alone(frame, speed, cuts):
    s = scene(frame, speed, cuts=cuts).solve(TURN)
    leaving = s.slider_velocity * np.sign(s.slider_position) > 0
    high, low = travelled(s)
    expected = np.where(leaving == (cuts == "away"), -np.sign(s.slider_velocity) * WORK / (high - low), 0.0)
    np.testing.assert_allclose(s.loads[1].push(s), expected, rtol=1e-12)


@pytest.mark.slow
@every("speed", (33.5, -33.5))
def test_without_thrust_it_is_a_process_force_over_travel(speed):
    s = scene(speed=speed).solve(TURN)
    low, high = sorted(s.loads[1].stroke(s))
    force, rest = np.full(2, WORK / (high - low)), np.zeros(2)
    table = ks.Table([low - 1e-3, high + 1e-3], rest, over="travel", back=force)
    other = scene(speed=speed, loads=ks.ProcessForce(table, reaction="frame")).solve(TURN)
    one, two = mirror.values_of(s), mirror.values_of(other)
    for name, (values, _) in one.items():
        np.testing.assert_allclose(values, two[name][0], atol=1e-12 * max(largest(values), 1e-3))
    for name in ("balancing_torque", "guide_force"):
        assert ks.extremes(s, name).range == pytest.approx(ks.extremes(other, name).range, rel=1e-13)
    np.testing.assert_allclose(s.ground["sawing"].force, other.ground["process_force"].force, rtol=1e-13, atol=1e-9)


def equilibrium(item, speed, offset, angle, load):
    """Reactions at O, A, B, of the guide, and torque by equations of all bodies: an offset crank-slider by hand.

    In axes along the guide, of a massless crank r, a coupler l with its centre at half length, and a slider.
    """
    r, length, mass, inertia, heavy = 0.3, 1.0, 150.0, 20.5, 600.0
    phi = item - angle
    x, y = r * np.cos(phi), r * np.sin(phi)
    h = offset - y  # from A across to the guide
    w = np.sqrt(length**2 - h**2)
    spin = -x / w  # of the coupler over the crank speed, h = l sin(beta), h' = -x
    spin_rate = (y + h * spin**2) / w
    coordinate, second = x + w, -x - h * spin_rate - w * spin**2
    middle = np.array([x + 0.5 * w, y + 0.5 * h])
    to_middle = np.array([-x - 0.5 * (h * spin_rate + w * spin**2), -y + 0.5 * (w * spin_rate - h * spin**2)])
    along, across, arm = load(coordinate, -y - h * spin)
    gravity = 9.81 * np.array([-np.sin(angle), -np.cos(angle)])  # weight acts along -y of the frame
    rows, right = np.zeros((9, 9)), np.zeros(9)  # O, A on coupler, B on slider, guide, its moment, torque
    pull = mass * (speed**2 * to_middle - gravity)
    rows[0, [0, 2]], rows[1, [1, 3]] = (1, -1), (1, -1)
    rows[2, [2, 3, 8]] = y, -x, 1  # moments about O on the crank, which carries -A at its pin
    rows[3, [2, 4]], rows[4, [3, 5]] = (1, -1), (1, -1)
    right[3:5] = pull
    a, b = np.array([x, y]) - middle, np.array([coordinate, offset]) - middle
    rows[5, 2:6] = -a[1], a[0], b[1], -b[0]
    right[5] = inertia * speed**2 * spin_rate
    rows[6, 4], rows[7, [5, 6]], rows[8, 7] = 1, (1, 1), 1
    right[6] = heavy * (speed**2 * second - gravity[0]) - along
    right[7] = -heavy * gravity[1] - across
    right[8] = -arm * across
    return np.linalg.solve(rows, right)


@pytest.mark.slow
@every("speed", (33.5, -33.5))
@every("cuts", ("toward crank", "away"))
@every("angle", (0.0, 0.5))
def test_every_reaction_by_equations_of_all_bodies(speed, cuts, angle):
    """Against Newton and Euler for each body; thrust and its arm from the place where the log stands."""
    offset, thrust, overhang = 0.2, 0.3, 0.15
    high, low = np.sqrt(1.3**2 - offset**2), np.sqrt(0.7**2 - offset**2)
    force = WORK / (high - low)

    def load(coordinate, rate):
        leaving = speed * rate > 0
        on = leaving == (cuts == "away")
        return -np.sign(speed * rate) * force * on, thrust * force * on, 0.5 * (high + low) + overhang - coordinate

    frame = ks.crank_slider(
        0.3,
        1.0,
        guide_offset=offset,
        guide_angle=angle,
        **{**LINKS, "coupler": replace(LINKS["coupler"], centre=(0.5, 0.0))},
    )
    item = sawing(cuts=cuts, thrust=thrust, overhang=overhang)
    s = ks.solve(frame, TURN, crank_speed=speed, loads=[ks.Gravity(), item])
    found = np.array([equilibrium(phi, speed, offset, angle, load) for phi in TURN]).T
    turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    mine = [*(turned @ s.reaction("O")), *(turned @ s.reaction("A")), *(turned @ s.reaction("B"))]
    mine += [s.guide_force, s.guide_moment, s.balancing_torque]
    for one, two in zip(found, mine, strict=True):
        np.testing.assert_allclose(two, one, rtol=0, atol=1e-11 * np.abs(found).max())


def test_frame_takes_log_and_thrust():
    """Sum of the forces on the frame is shaking force and weight, also about O: cut and thrust are inner forces."""
    s = scene(thrust=0.4, overhang=0.1).solve(TURN)
    weight = np.array([[0.0], [-9.81 * 750.0]])
    np.testing.assert_allclose(s.ground.resultant - weight, s.shaking_force, atol=1e-9 * largest(s.shaking_force))
    arms = [s.position(name)[0] * link.mass for name, link in s.mechanism.links.items()]
    moment = s.shaking_moment - 9.81 * sum(arms)
    np.testing.assert_allclose(s.ground.moment((0.0, 0.0)), moment, atol=1e-9 * largest(moment))
    outside = scene(thrust=0.4, reaction="outside").solve(TURN)
    assert ("sawing" in s.ground, "sawing" in outside.ground) == (True, False)


@every("item", ({"thrust": 0.3, "overhang": 0.1}, {"cuts": "away"}))
def test_mirrored_machine_gives_mirrored_forces(item):
    found = mirror.solved(scene("offset", loads=sawing(**item)))
    assert max(found.values()) < 1e-12


@every("name", ("guide_force", "guide_moment", "balancing_torque"))
def test_extremes_know_the_jumps_at_the_dead_centres(name):
    """Both limits at a jump are found, which samples nearly reach."""
    found = ks.extremes(scene(thrust=0.5).solve(7), name)
    program = ks.compile(scene(thrust=0.5), name, engine="numpy")
    dead = scene().loads[1].jump_angles(scene().solve(7))[0]
    beside = [dead - 1e-7, dead + 1e-7, TURN, np.radians(np.arange(0.0, 360.0, 0.1))]
    values = program(np.concatenate(beside))[name]
    low, high = found.value.min(), found.value.max()
    assert (low, high) == pytest.approx((values.min(), values.max()), abs=2e-5 * (high - low))
    assert low <= values.min()
    assert high >= values.max()


@pytest.mark.slow
@every("q", ("balancing_torque", "guide_moment"))
@every("path", ("crank_length", "coupler_length", "guide_offset", "sawing.kerf", "sawing.resistance", "sawing.thrust"))
def test_derivatives_include_that_of_the_stroke(q, path):
    program = ks.compile(scene(thrust=0.2, overhang=0.1), q, engine="numpy")
    at, value = np.array([0.9, 2.0, 4.4, 5.3]), program.parameters[path]
    step = 1e-5 * value
    before, after = (program(at, {path: value + way * step})[q] for way in (-1, 1))
    found = program.derivatives(at, path)[q][path]
    np.testing.assert_allclose(found, (after - before) / (2 * step), atol=1e-8 * max(largest(found), 1.0))


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow)])
def test_program_at_other_lengths_is_the_other_machine(engine):
    program = ks.compile(scene(thrust=0.2), ("balancing_torque", "guide_moment"), engine=engine)
    longer = ks.crank_slider(0.35, 1.0, guide_offset=0.2, guide_angle=0.5, **LINKS)
    other = ks.solve(longer, TURN, crank_speed=33.5, loads=[ks.Gravity(), sawing(thrust=0.2)], engine="numpy")
    found = program(TURN, {"crank_length": 0.35})
    bound = program.error_bound(TURN, {"crank_length": 0.35})
    for name, values in found.items():
        off = np.abs(values - other.scalar(name))
        assert largest(bound[name]) < 1e-8
        assert np.all(off <= bound[name] + other.error_bound(name))


def test_batch_and_sweep_have_their_own_strokes():
    lengths = np.array([0.25, 0.3, 0.4])
    frames = ks.crank_slider(lengths[:, None], 1.0, **LINKS)
    s = ks.solve(frames, TURN, crank_speed=33.5, loads=sawing())
    table = ks.sweep(
        ks.Scene(ks.crank_slider(0.3, 1.0, **LINKS), 33.5, loads=sawing()),
        pd.DataFrame({"crank_length": lengths}),
        ["largest guide_force"],
        progress=False,
    )
    for place, length in enumerate(lengths):
        alone = ks.solve(ks.crank_slider(length, 1.0, **LINKS), TURN, crank_speed=33.5, loads=sawing())
        np.testing.assert_allclose(s.balancing_torque[place], alone.balancing_torque, rtol=1e-12, atol=1e-9)
        one = ks.extremes(alone, "guide_force").value.max()
        assert table["largest guide_force [N]"][place] == pytest.approx(one, rel=1e-12)


def test_batch_over_two_axes():
    radius, length = np.array([0.25, 0.3])[:, None, None], np.array([1.0, 1.5, 2.0])[None, :, None]
    s = ks.solve(ks.crank_slider(radius, length, **LINKS), TURN, crank_speed=33.5, loads=sawing())
    assert s.balancing_torque.shape == (2, 3, TURN.size)
    alone = ks.solve(ks.crank_slider(0.3, 1.5, **LINKS), TURN, crank_speed=33.5, loads=sawing())
    np.testing.assert_allclose(s.balancing_torque[1, 1], alone.balancing_torque, rtol=1e-12, atol=1e-9)


def test_thrust_adds_to_the_friction_of_the_guide():
    """Of a yoke the guide takes the thrust alone: mu of it is lost on the cutting stroke."""
    frame, guide = ks.scotch_yoke(0.3, slider=ks.Link(600.0)), {"guide": ks.GuideFriction(0.1)}
    s = ks.Scene(frame, 33.5, loads=sawing(thrust=0.5), friction=guide).solve(7)
    assert s.losses.friction["guide"] == pytest.approx(0.1 * 0.5 * WORK * 33.5 / (2 * np.pi), rel=1e-10)
    assert s.losses.drive == pytest.approx((1.0 + 0.05) * WORK * 33.5 / (2 * np.pi), rel=1e-10)


def test_resistance_may_follow_the_chip():
    """Of the thickness D t / S; recorded where it is arithmetic, else read beforehand."""
    plain = scene("centric", resistance=50e6 * (1.0 + 0.02 * 0.025 / 0.6 / 1e-3)).solve(TURN)
    for law in (lambda chip: 50e6 * (1.0 + chip / 1e-3), lambda chip: np.interp(chip, [0.0, 1e-3], [50e6, 100e6])):
        s = scene("centric", resistance=law, pitch=0.025).solve(TURN)
        np.testing.assert_allclose(s.balancing_torque, plain.balancing_torque, rtol=1e-12)
        assert s.losses.drive == pytest.approx(plain.losses.drive, rel=1e-13)
    with pytest.raises(ks.ParameterError, match=r"must return its resistance in Pa"):
        scene(resistance=lambda chip: "hard", pitch=0.025).solve(TURN).balancing_torque  # noqa: B018
    with pytest.raises(ks.ParameterError, match=r"must not be negative, got -1000000.0"):
        scene(resistance=lambda chip: -1e6, pitch=0.025).solve(TURN).balancing_torque  # noqa: B018


def test_drive_gives_the_work_of_each_stroke():
    motor = ks.drive.Motor.kloss(160e3, 26.2, synchronous_speed=27.2, overload=2.2)
    run = ks.drive.steady(scene("centric"), motor, flywheel=900.0)
    assert run.energy_per_turn == pytest.approx(WORK, rel=1e-9)
    motion = ks.drive.coast(ks.Scene(FRAMES["centric"], 1.0, loads=sawing()), 900.0, 0.4, 12.0, until="standstill")
    assert motion.energy_drift < 1e-8
    assert motion.events[-1].name == "standstill"


# The mower


def test_knife_cuts_where_the_edges_of_section_and_finger_meet():
    """Against the edges themselves: a section, 76 mm wide at its foot and 16 at its tip, between fingers 76.2 apart."""
    pitch, foot, tip = 0.0762, (0.076 + 0.024) / 2, (0.016 + 0.0164) / 2
    knife = ks.crank_slider(0.0381, 0.4, guide_offset=0.02, slider=ks.Link(4.0))
    for speed in (60.0, -60.0):
        crop = ks.Mowing(600.0, pitch=pitch, start=pitch - foot, end=pitch - tip)
        s = ks.solve(knife, np.linspace(0.0, 2 * np.pi, 721), crank_speed=speed, loads=crop)
        high, low = travelled(s)
        left = 0.5 * (high + low - pitch)  # the finger at one side, the next one a pitch on
        height = np.linspace(0.0, 1.0, 2001)[:, None]
        half = foot + (tip - foot) * height  # half widths of section and finger at a height
        ahead = np.where(s.slider_velocity > 0, left + pitch - s.slider_position, s.slider_position - left)
        gap = ahead - half
        meets = (gap.min(axis=0) < 0) & (gap.max(axis=0) > 0)
        np.testing.assert_array_equal(crop.push(s) != 0, meets)
        assert np.all(crop.push(s) * s.slider_velocity <= 0)
        assert 0.2 < meets.mean() < 0.4


@pytest.mark.slow
@every("speed", (60.0, -60.0))
@every("radius", (0.038, 0.0762))
@every("offset", (0.0, -0.02))
def test_power_of_the_knife_by_its_cutting_travel(speed, radius, offset):
    knife = ks.crank_slider(radius, 0.4, guide_offset=offset, slider=ks.Link(4.0))
    s = ks.solve(knife, 0.0, crank_speed=speed, loads=CROP)
    low, high = sorted(CROP.stroke(s))
    half, middle = 0.5 * (high - low), np.arange(-3, 4)[:, None] * 0.0762
    parts = middle + np.array([-0.0381 + CROP.start, -0.0381 + CROP.end])
    travel = 2 * np.clip(parts, -half, half).dot([-1.0, 1.0]).sum()
    assert s.losses.drive == pytest.approx(600.0 * travel * abs(speed) / (2 * np.pi), rel=2e-13)
    assert travel > 0.06


def test_a_narrow_cut_keeps_its_digits():
    narrow = ks.Mowing(600.0, pitch=0.0762, start=0.0381, end=0.0381 + 1e-11)
    s = ks.Scene(ks.crank_slider(0.038, 0.3), 60.0, loads=[narrow]).solve(90)
    assert s.losses.drive == pytest.approx(600.0 * 2e-11 * 60.0 / (2.0 * np.pi), rel=1e-4)


def test_jumps_of_many_knives_are_those_of_each():
    pitch = np.array([0.05, 0.0762, 0.1])[:, None]
    crop = ks.Mowing(600.0, pitch=pitch, start=0.01, end=0.04)
    knife = ks.crank_slider(0.038, 0.4, slider=ks.Link(4.0))
    every_row = crop.jump_angles(ks.solve(knife, 0.1, crank_speed=60.0, loads=crop))
    for row, own in zip(every_row, pitch.ravel(), strict=True):
        alone = ks.Mowing(600.0, pitch=own, start=0.01, end=0.04)
        one = alone.jump_angles(ks.solve(knife, 0.1, crank_speed=60.0, loads=alone))[0]
        np.testing.assert_allclose(np.sort(row[~np.isnan(row)]), np.sort(one), atol=1e-10)


def test_mirrored_mower():
    knife = ks.crank_slider(0.038, 0.4, guide_offset=0.02, slider=ks.Link(4.0))
    assert max(mirror.solved(ks.Scene(knife, 60.0, loads=CROP)).values()) < 1e-12


# In case files, hand calculations and free bodies


def test_case_file(tmp_path):
    text = """
title = "Knife"
reference = "knife"
[variants.knife]
mechanism = "crank-slider"
crank_speed = "60 rad/s"
crank_length = "38 mm"
coupler_length = "400 mm"
slider = { mass = "4 kg" }
[[variants.knife.loads]]
kind = "mowing"
force = "600 N"
pitch = "76.2 mm"
start = "26 mm"
end = "60 mm"
[[variants.knife.loads]]
kind = "sawing"
kerf = "3.2 mm"
height = "250 mm"
saws = 8
feed_per_stroke = "20 mm"
resistance = "50 MPa"
cuts = "away"
thrust = -0.1
reaction = "outside"
"""
    variant = ks.load_case(case_file(tmp_path, text)).variant("knife")
    knife = ks.crank_slider(0.038, 0.4, slider=ks.Link(4.0))
    written = ks.Scene(knife, 60.0, loads=[CROP, sawing(cuts="away", thrust=-0.1, reaction="outside")])
    s, same = variant.scene.solve(TURN), written.solve(TURN)
    np.testing.assert_allclose(s.balancing_torque, same.balancing_torque, rtol=1e-13)
    np.testing.assert_allclose(s.guide_force, same.guide_force, atol=1e-9)
    path = case_text.write_case(tmp_path / "again.toml", "Knife", {"one": written})
    again = ks.load_case(path).variant("one").scene.solve(TURN)
    np.testing.assert_array_equal(again.balancing_torque, same.balancing_torque)


@every("key, value, words", (("pitch", '"0 mm"', "greater than 0"), ("cuts", '"up"', "allowed: 'toward crank'")))
def test_wrong_texts_are_refused_in_place(tmp_path, key, value, words):
    kind = {"pitch": "mowing", "cuts": "sawing"}[key]
    text = f"""
title = "Saw"
reference = "one"
[variants.one]
mechanism = "crank-slider"
crank_speed = "60 rad/s"
crank_length = "38 mm"
coupler_length = "400 mm"
[[variants.one.loads]]
kind = "{kind}"
{key} = {value}
"""
    assert any(f"{key}" in problem and words in problem for problem in problems(tmp_path, text))


def test_studies_refuse_what_they_cannot_compute():
    s = scene().solve(np.array([1.0, 5.0]))
    with pytest.raises(NotGivenError, match="no independent formula for a Sawing"):
        newton.NEWTON_METHODS[0].prepare(s, "O", 3)()
    if importlib.util.find_spec("flint"):
        with pytest.raises(NotGivenError, match="needs plain lengths"):
            certified(s, "balancing_torque")


def test_hand_calculation_names_stroke_and_work():
    told = str(scene(thrust=0.2).solve(TURN).explain("guide_moment", 1.0))
    for words in ("coordinate of the far dead centre", "work of the cutting stroke", "moment of sawing on the slider"):
        assert words in told
    knife = ks.Scene(ks.crank_slider(0.038, 0.4, slider=ks.Link(4.0)), 60.0, loads=CROP).solve(TURN)
    assert "sine of the phase of a section after the start of its cut" in str(knife.explain("guide_force", 1.0))


def test_free_body_of_the_slider_is_in_balance():
    s = scene(thrust=0.3, overhang=0.2).solve(np.array([2.0]))
    own = [item for item in free_body.free_body(s.dynamics, "slider") if item.name == "Sawing on 'slider'"]
    along = s.mechanism.guides["slider"].direction
    total = np.sum([np.array(item.force).ravel() for item in own], axis=0)
    force = s.loads[1].push(s)[0]
    np.testing.assert_allclose(total, force * np.array(along) + 0.3 * abs(force) * np.array([-along[1], along[0]]))


# Rest, gaps and hostile values


@every("item", (sawing(thrust=0.2), CROP))
def test_at_rest_it_opposes_the_motion_about_to_begin(item):
    frame = FRAMES["offset"]
    with pytest.raises(ks.ParameterError, match="acts against the motion, but crank_speed and crank_acceleration are"):
        ks.solve(frame, 1.0, crank_speed=0.0, loads=item)
    for sense in (1.0, -1.0):
        moving, starting, told = (
            item.push(ks.Scene(frame, speed, alpha, [item], sense=way).solve(TURN))
            for speed, alpha, way in ((5.0 * sense, 0.0, None), (0.0, sense, None), (0.0, 0.0, sense))
        )
        np.testing.assert_array_equal(moving, starting)
        np.testing.assert_array_equal(moving, told)


@every("item", (sawing(thrust=0.2), CROP))
def test_a_machine_that_does_not_close_all_round_has_no_stroke_and_no_force(item):
    open_one = ks.crank_slider(0.3, np.array([[0.25], [1.0]]), **LINKS)
    s = ks.solve(open_one, TURN, crank_speed=1.0, loads=item, on_gap="nan")
    assert np.isnan(item.push(s)[0]).all()
    alone = ks.solve(ks.crank_slider(0.3, 1.0, **LINKS), TURN, crank_speed=1.0, loads=item)
    np.testing.assert_allclose(item.push(s)[1], item.push(alone), rtol=1e-12)


@pytest.mark.slow
def test_no_stroke_no_force():
    short = ks.crank_slider(0.3, 0.25, **LINKS)
    with pytest.raises(ks.AssemblyError):
        ks.solve(short, TURN, crank_speed=1.0, loads=sawing())
    assert np.isnan(ks.solve(short, [0.1], crank_speed=1.0, loads=sawing(), on_gap="nan").balancing_torque).all()
    for item in (sawing(), CROP):
        s = ks.solve(short, [0.1], crank_speed=1.0, loads=item, on_gap="nan")
        values = ks.compile(ks.Scene(short, 1.0, loads=item), "balancing_torque", engine="numpy")(0.1)
        assert np.isnan([*s.balancing_torque, values["balancing_torque"]]).all()
        with pytest.warns(ks.ConditionWarning, match="no value"):
            assert np.isnan(ks.extremes(s, "balancing_torque").range).all()
        with pytest.raises(ks.ParameterError, match="does not close"):
            s.losses  # noqa: B018
    twice = ks.Mechanism(
        "two strokes a turn",
        ks.Crank(0.1),
        (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ks.SliderGroup(0.5, ks.Guide.at(1.3, 0.2), on="B", pin="C", label="2")),
    )
    with pytest.raises(ks.ParameterError, match="changes its direction 4 times"):
        ks.solve(twice, TURN, crank_speed=1.0, loads=sawing(on="slider2")).balancing_torque  # noqa: B018


@every("item", (sawing(on="follower"), replace(CROP, on="follower")))
def test_no_cut_of_a_follower_that_dwells(item):
    rise, fall = ks.laws.cycloidal(0.1, 0.18, 1.5), ks.laws.cycloidal(0.18, 0.1, 2 * np.pi - 2.5)
    law = ks.laws.joined(rise, ks.laws.dwell(0.18, 1.0), fall)
    cam = ks.Mechanism("cam", ks.Crank(0.1), (ks.RollerFollower(law, ks.Guide.at(0.0), ks.Link(2.0)),))
    with pytest.raises(ks.ParameterError, match="'follower' of cam stands still on a part of the turn"):
        ks.solve(cam, TURN, crank_speed=10.0, loads=item).balancing_torque  # noqa: B018


def test_a_knife_passes_so_many_fingers():
    fine = replace(CROP, pitch=1e-6, start=3e-7, end=8e-7)
    s = ks.solve(ks.crank_slider(0.038, 0.4, slider=ks.Link(4.0)), 7, crank_speed=60.0, loads=fine)
    with pytest.raises(ks.ParameterError, match=r"its stroke has 7\.6e\+04 times the pitch; at most 1000 are"):
        s.losses  # noqa: B018


SAWS = {
    "kerf": (-1e-3, "kerf must be at least 0"),
    "height": (np.nan, "height must be finite"),
    "saws": ("8", "saws must be a number"),
    "feed_per_stroke": (None, "feed_per_stroke must be a number"),
    "resistance": (-1.0, "resistance must be at least 0"),
    "cuts": ("up", "cuts"),
    "thrust": (np.inf, "thrust must be finite"),
    "overhang": (True, "overhang must be a number"),
    "pitch": (0.02, "pitch is for a resistance that is a function"),
    "on": (3, "on must be a name"),
    "reaction": ("log", "reaction"),
}
ODD = {
    "function without pitch": ({"resistance": lambda chip: 5e7}, "needs the pitch of the teeth"),
    "table": ({"resistance": ks.Table([0.0, 1.0], [1.0, 2.0], over="travel")}, "got a Table"),
}
KNIVES = {
    "start after end": ({"start": 0.07}, "start must be less than end"),
    "end beyond the pitch": ({"end": 0.08}, "end at most the pitch"),
    "no pitch": ({"pitch": 0.0}, "pitch must be greater than 0"),
    "negative": ({"force": -1.0}, "force must be at least 0"),
    "function": ({"force": lambda motion: 1.0}, "force must be a number"),
}


@every("name", SAWS)
def test_wrong_values_of_saws_are_refused(name):
    value, words = SAWS[name]
    with pytest.raises(ks.ParameterError, match=words):
        sawing(**{name: value})


@every("name", ODD)
def test_values_of_saws_that_do_not_go_together(name):
    changes, words = ODD[name]
    with pytest.raises(ks.ParameterError, match=words):
        sawing(**changes)


@every("name", KNIVES)
def test_wrong_values_of_knives_are_refused(name):
    changes, words = KNIVES[name]
    with pytest.raises(ks.ParameterError, match=words):
        ks.Mowing(**{"force": 600.0, "pitch": 0.0762, "start": 0.026, "end": 0.06} | changes)


@every("item", (ks.Sawing(**CUT, on="frame"), replace(CROP, on="knife")))
def test_a_slider_that_is_not_there(item):
    with pytest.raises(ks.ParameterError, match="allowed: 'slider'"):
        ks.Scene(FRAMES["offset"], 1.0, loads=item)


def test_units_that_look_wrong_are_asked_about():
    with pytest.warns(ks.HintWarning, match=r"sawing.kerf is 3.2 m; is it in mm"):
        scene(kerf=3.2).solve(3)
    with pytest.warns(ks.HintWarning, match=r"sawing.resistance is 50 Pa"):
        scene(resistance=50.0).solve(3)
