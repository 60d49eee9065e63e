"""Designs of one structure computed together, in chunks."""

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import component_sizes
from kinetostatics.sweeps import chunk
from kinetostatics.sweeps.chunk import MIN_ANGLES_PER_TURN
from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support import sweeping as spikes
from support.case_files import shipped
from support.every import every
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, sweep


def test_failing_rows_keep_their_reasons():
    designs = pd.DataFrame(
        {
            "coupler_length [m]": [2.0, -1.0, 0.25, 2.0, 2.0, 2.0, 0.31],
            "slider.mass [kg]": [600.0, 600.0, 600.0, -5.0, np.nan, 600.0, 600.0],
            "crank_speed": [33.0, 33.0, 33.0, 33.0, 33.0, np.nan, 33.0],
        }
    )
    found = sweep(SAW, designs, OUTPUTS, variant="plain", angles=36)
    assert found[FAILED].tolist() == [
        "",
        "slider group: coupler length must be greater than 0, got -1.0",
        "crank-slider cannot be assembled at 66 of 180 crank angles; change the lengths",
        "Link: mass must be at least 0, got -5.0",
        "Link: mass must be finite, got nan",
        "scene: crank_speed must be finite, got nan",
        "",
    ]
    assert np.isnan(found.iloc[:, 3:5]).all(axis=1).tolist() == [False, True, True, True, True, True, False]
    good = sweep(SAW, designs.iloc[[0, 6]], OUTPUTS, variant="plain", angles=36)
    assert_equal(found.iloc[[0, 6]], good)


def test_reasons_of_cams_tell_the_numbers_of_their_row():
    designs = pd.DataFrame({"cam.mean [m]": [2.0, 0.2, 0.1], "cam.amplitude [m]": [0.3, 0.3, 0.15]})
    found = sweep(SAW, designs, OUTPUTS, variant="cam-cosine", angles=36)[FAILED].tolist()
    assert found[0] == ""
    assert "got mean 0.2 m and amplitude 0.3 m" in found[1]
    assert "got mean 0.1 m and amplitude 0.15 m" in found[2]
    found = sweep(SAW, pd.DataFrame({"cam.centre.x": [0.0, 0.4]}), OUTPUTS, variant="cam-circle", angles=36)[FAILED]
    assert found[0] == ""
    assert "its centre is 0.4 m from O and its radius 0.3 m" in found[1]


def test_a_failing_reference_is_told_apart():
    reference = ks.Scene(ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0)), 1.0, 0.0, ())
    found = sweep(factories.pump, DESIGNS[:2].assign(mass=[-1, 1]), ["rms O", "ratio rms O"], reference=reference)
    assert found[FAILED][0] == "Link: mass must be at least 0, got -1.0"
    assert found[FAILED][1].startswith("reference: crank-slider cannot be assembled at 134 of 360")
    assert found.iloc[:, 2:4].isna().all(axis=None)


def test_a_ratio_of_nothing_to_nothing_is_told():
    found = sweep(factories.pump, DESIGNS[:2].assign(mass=[0, 1]), ["ratio rms B"], reference=factories.pump(0.1, 0.0))
    assert found[FAILED].tolist() == ["ratio rms B is not a number, as for 0 / 0", ""]
    assert found.iloc[1, 2] == 0.0


def test_errors_of_a_function_stay_with_their_rows():
    designs = DESIGNS.assign(mass=DESIGNS["mass"].to_numpy()[::-1])
    found = sweep(factories.picky, designs, OUTPUTS, angles=36)
    wrong = (designs["crank [mm]"] < 300) & (designs["mass"] > 5)
    assert (found[FAILED] != "").tolist() == wrong.tolist()
    assert found[FAILED][3] == "a crank of 0.13 m does not carry 8.4 kg"
    assert_equal(found[~wrong], sweep(factories.pump, designs[~wrong], OUTPUTS, angles=36))


def test_when_all_designs_fail_all_say_why():
    found = sweep(factories.pump, DESIGNS.assign(mass=-1.0), OUTPUTS, angles=36)
    assert found[FAILED].eq("Link: mass must be at least 0, got -1.0").all()
    assert found.iloc[:, 2:4].isna().all(axis=None)


@pytest.mark.slow
def test_the_hundredth_design_impossible_among_many():
    designs = ks.designs.random({"coupler_length": "1.8..2.2 m", "slider.mass": "500..700 kg"}, 5000)
    designs.loc[::100, "slider.mass [kg]"] = -1.0
    designs.loc[1::100, "coupler_length [m]"] = 0.25
    found = sweep(SAW, designs, OUTPUTS, variant="plain", angles=12)
    assert found[FAILED].ne("").sum() == 100
    assert found.loc[::100, FAILED].str.startswith("Link: mass").all()
    assert found.loc[1::100, FAILED].str.startswith("crank-slider cannot be assembled").all()


@pytest.mark.slow
@every("case, variant", [("shaper", "idle"), ("mower_drive_optimal", "cam-robust"), ("sawframe_2r63", "cam-circle")])
def test_few_angles_give_right_numbers(case, variant):
    """Each output alone: what one needs in crank angles helps the others."""
    scene = shipped(case).variant(variant).scene
    designs = pd.DataFrame({"crank_speed": [scene.parameters["crank_speed"]]})
    for reduction in ("largest", "smallest", "range", "mean_absolute", "rms"):
        for name in ("balancing_torque", "O" if case != "shaper" else "A"):
            fine, *fewer = (sweep(scene, designs, [f"{reduction} {name}"], angles=n) for n in (5760, 13, 72, 180))
            for few in fewer:
                assert few.iloc[0, 1] == pytest.approx(fine.iloc[0, 1], rel=1e-3), (reduction, name)


def rippled(crank):
    """A pump with a rubbing guide, whose load ripples by 2e-4 sixteen thousand times a turn."""
    made = ks.crank_slider(crank, 0.2, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0))
    push = ks.ProcessForce(lambda motion: 1e3 * (1.0 + 2e-4 * np.sin(1e5 * motion.crank_angle)))
    return ks.Scene(made, 30.0, loads=push, friction={"guide": ks.GuideFriction(0.2)})


@pytest.mark.slow
def test_unresolved_pieces_are_reported():
    """Both are halved to the same pieces, so that they agree tells nothing."""
    found = sweep(rippled, pd.DataFrame({"crank": [0.05, 0.06]}), ["largest B", "mean B"])
    assert found[FAILED].str.startswith("largest B is not resolved by").all()


def balanced(crank, mass, offset):
    """A crank whose counterweight balances the coupler's mass at its pin, but for rounding."""
    own, coupler = ks.Link(2.0, -0.5 * crank * mass, 0.01), ks.Link(mass, 0.0, 0.0)
    return ks.Scene(
        ks.crank_slider(crank, 0.2, guide_offset=offset, crank=own, coupler=coupler), 30.0, 0.0, ks.Gravity()
    )


def of_nothing(count=40):
    rng = np.random.default_rng(0)
    ranges = {"crank": (0.02, 0.08), "mass": (0.5, 3.0), "offset": (-0.05, 0.05)}
    return pd.DataFrame({name: rng.uniform(*ends, count) for name, ends in ranges.items()})


@pytest.mark.slow
@every("reduction", ["range", "mean", "rms", "swing", "harmonic_2", "largest_at"])
def test_no_design_fails_by_rounding_of_what_is_zero(reduction):
    designs = of_nothing()
    size = sweep(balanced, designs, ["largest A"])["largest A [N]"]
    found = sweep(balanced, designs, [f"{reduction} balancing_torque", "largest A"])
    assert (found[FAILED] == "").all()
    if reduction != "largest_at":
        assert (found.iloc[:, 3].abs() < 1e-13 * size).all()
    np.testing.assert_array_equal(found["largest A [N]"], size)


def test_functions_may_change_their_arrays():
    def changing(crank, mass):
        crank *= 2.0
        return factories.pump(crank, mass)

    outputs = ["largest O", "harmonic_2 O"]
    doubled = DESIGNS.assign(**{"crank [mm]": 2.0 * DESIGNS["crank [mm]"]})
    found, expected = sweep(changing, DESIGNS, outputs), sweep(factories.pump, doubled, outputs)
    pd.testing.assert_frame_equal(found.iloc[:, 2:], expected.iloc[:, 2:], rtol=1e-12)


def test_sweep_over_nothing_has_one_design():
    found = sweep(SAW, pd.DataFrame(index=range(3)), OUTPUTS, variant="plain", angles=180)
    alone = sweep(SAW, pd.DataFrame({"crank_length": [0.3]}), OUTPUTS, variant="plain", angles=180)
    assert_equal(found, pd.concat([alone.iloc[:, 1:]] * 3, ignore_index=True))


# Designs as one batch


def test_plain_function_is_called_a_design():
    found = sweep(factories.by_plain_numbers, DESIGNS, OUTPUTS, angles=36)
    pd.testing.assert_frame_equal(found, sweep(factories.pump, DESIGNS, OUTPUTS, angles=36), rtol=1e-14)


def test_a_batch_of_another_shape_is_refused():
    made = lambda crank, mass: factories.pump(np.full((3, 1), 0.1), 1.0)  # noqa: E731
    found = sweep(made, DESIGNS[:2], OUTPUTS, angles=36)
    assert found[FAILED].str.contains("arrays need the shape (designs, 1)", regex=False).all()


@pytest.mark.slow
def test_as_many_designs_as_angles_is_no_batch():
    pump = ks.crank_slider(0.1, 0.4, coupler=ks.Link(1.0, 0.2, 0.01), slider=ks.Link(2.0))

    def made(shape):
        return lambda acceleration: ks.Scene(pump, 30.0, np.reshape(acceleration, shape))

    designs = pd.DataFrame({"acceleration": np.linspace(100.0, 300.0, MIN_ANGLES_PER_TURN)})
    column, flat = (sweep(made(shape), designs, "largest O", angles=MIN_ANGLES_PER_TURN) for shape in ((-1, 1), -1))
    assert flat["largest O [N]"].to_numpy() == pytest.approx(column["largest O [N]"].to_numpy(), rel=1e-12)


def numbers(found, row, kinds, name):
    """Reductions of a quantity in a row of a table."""
    return (found.loc[row, next(column for column in found if column.startswith(f"{kind} {name} "))] for kind in kinds)


def assert_true_ends(scene, names, lengths, **options):
    """Smallest and largest values of the last crank length, the scene's own, are those of `extremes`."""
    outputs = [f"{end} {name}" for name in names for end in ("smallest", "largest")]
    found = sweep(scene, pd.DataFrame({"crank_length": lengths}), outputs, **options)
    truth = [end for name in names for end in ks.extremes(scene.solve(36), name).range]
    np.testing.assert_allclose(found.iloc[-1, 1:-1].to_numpy(dtype=float), truth, rtol=1e-6)


KINDS = ("largest", "mean_absolute", "rms")
OF_SPIKES = ["largest", "smallest", "range", "mean_absolute", "rms"]


@pytest.mark.slow
@every("seed, angles", [(seed, (12, 13, 360)[seed % 3]) for seed in range(6)])
def test_no_spike_of_a_table_is_missed(seed, angles):
    scene, names = spikes.spiky(seed), ("balancing_torque", "O")
    length = scene.parameters["crank_length"]
    designs = pd.DataFrame({"crank_length": [0.97 * length, length]})
    outputs = [f"{kind} {name}" for name in names for kind in OF_SPIKES]
    found = sweep(scene, designs, outputs, angles=angles)
    assert found[FAILED].tolist() == ["", ""]
    for row, length in enumerate(designs["crank_length"]):
        own = scene.varied({"crank_length": length})
        for name in names:
            (low, high), means = spikes.ends(own, name), spikes.means(own, name)
            largest, smallest, extent, *others = numbers(found, row, OF_SPIKES, name)
            size = max(abs(low), abs(high))
            assert largest == pytest.approx(high, abs=1e-7 * size)
            assert low - 2e-3 * size < smallest <= low + 1e-7 * size  # few angles stand where a reaction is least
            assert extent == pytest.approx(largest - smallest, abs=1e-12 * size)
            assert others == pytest.approx(means, rel=1e-5)


@pytest.mark.slow
@every("angles", [13, 360, 361])
def test_steep_pump_force_has_its_largest_torque(angles):
    found = sweep(steep_pump, pd.DataFrame({"crank": [0.04, 0.05]}), ["largest balancing_torque"], angles=angles)
    scene = steep_pump(0.05)
    truth = ks.extremes(scene.solve(36), "balancing_torque").range[1]
    assert spikes.ends(scene, "balancing_torque")[1] == pytest.approx(truth, rel=1e-12)
    assert found.iloc[1, 1] == pytest.approx(truth, rel=1e-9)


def steep_pump(crank):
    rows = [0.1, 0.1999, 0.2, 0.2001, 0.3], [0.0, 0.0, -4e3, 0.0, 0.0]
    force = ks.ProcessForce(ks.Table(*rows, over="travel"))
    return ks.Scene(ks.crank_slider(crank, 0.19, slider=ks.Link(1.0)), 30.0, loads=[force])


def of_smooth_curve(count, around=True):
    """A pump whose force is given in so many rows of a smooth curve, by crank angle or travel."""
    if around:
        x = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
        table = ks.Table(x, 2e3 * np.exp(1.5 * np.cos(x - 0.7) - 1.5) + 300.0 * np.sin(3.0 * x))
    else:
        x = np.linspace(0.12, 0.26, count)
        table = ks.Table(x, -4e3 * (0.02 / (0.28 - x)) ** 1.3, over="travel")
    rod = ks.Link(1.0, 0.1, 0.01)
    pump = ks.crank_slider(0.05, 0.19, guide_offset=0.003, crank=rod, coupler=rod, slider=ks.Link(1.0))
    return ks.Scene(pump, 30.0, loads=[ks.ProcessForce(table), ks.Gravity()])


@pytest.mark.slow
@every("around", [True, False])
@every("angles", [12, 360])
def test_fine_smooth_rows_are_swept_as_one(monkeypatch, around, angles):
    monkeypatch.setattr(chunk, "PiecewiseTurns", None)
    scene, names = of_smooth_curve(1100, around), ("balancing_torque", "O")
    outputs = [f"{kind} {name}" for name in names for kind in KINDS]
    found = sweep(scene, pd.DataFrame({"crank_length": [0.04, 0.05]}), outputs, angles=angles)
    assert found[FAILED].tolist() == ["", ""]
    for name in names:
        largest, *others = numbers(found, 1, KINDS, name)
        low, high = spikes.ends(scene, name)
        assert largest == pytest.approx(high, abs=1e-5 * max(high, -low))
        assert others == pytest.approx(spikes.means(scene, name), rel=2e-5)


@pytest.mark.slow
def test_unresolved_rows_are_taken_one_by_one():
    designs = pd.DataFrame({"slider.mass": [2.021, 1.396], "guide_offset": [-0.003, -0.001]})
    designs = designs.assign(crank_length=[0.043, 0.038], crank_speed=[38.019, 38.316])
    found = sweep(of_smooth_curve(700), designs, ["smallest B"])
    assert found[FAILED].tolist() == ["", ""]
    own = of_smooth_curve(700).varied(designs.iloc[1].to_dict())
    assert found.iloc[1, 4] == pytest.approx(ks.extremes(own.solve(36), "B").range[0], rel=1e-3)


@pytest.mark.slow
@every("angles", [13, 360])
def test_jumps_of_friction_are_seen_from_both_sides(angles):
    friction = {"guide": ks.GuideFriction(0.15), "B": ks.PinFriction(0.1, 0.02)}
    saw = ks.crank_slider(0.05, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0))
    scene = ks.Scene(saw, 20.0, loads=[ks.Gravity()], friction=friction)
    assert_true_ends(scene, ("balancing_torque", "B", "guide_force"), [0.04, 0.05], angles=angles)


@pytest.mark.slow
@every(
    "angle, back, rubs", [(15, True, False), (120, True, True), (30, False, True), (-90, True, True), (45, True, False)]
)
def test_dead_centre_jumps_make_no_peaks(angle, back, rubs):
    """Guides stand at whole parts of the turn, so stops meet its even parts; strokes and friction jump at the same."""
    pump = ks.crank_slider(0.05, 0.2, guide_angle=np.radians(angle), coupler=ks.Link(1.0, 0.1), slider=ks.Link(2.0))
    table = ks.Table([0.1, 0.3], [300.0, -200.0], over="travel", back=[-100.0, 500.0] if back else None)
    friction = {"guide": ks.GuideFriction(0.2), "O": ks.PinFriction(0.1, 0.01)} if rubs else {}
    scene = ks.Scene(pump, 30.0, loads=[ks.ProcessForce(table)], friction=friction)
    assert_true_ends(scene, ("O", "B", "balancing_torque"), [0.04, 0.043, 0.05])


def test_a_slider_that_leaves_its_table_is_still_told():
    found = sweep(steep_pump, pd.DataFrame({"crank": [0.05, 0.12, 0.04]}), ["largest O", "rms O"])
    assert found[FAILED][[0, 2]].tolist() == ["", ""]
    assert found[FAILED][1].startswith("table over travel: the slider goes from 0.07")


@pytest.mark.slow
@every("engine", ["numpy", "compiled"])
def test_grouping_of_designs_does_not_matter(engine, numba):
    scene = spikes.spiky(1)
    length = scene.parameters["crank_length"]
    designs = pd.DataFrame({"crank_length": np.linspace(0.9 * length, length, 9)})
    outputs = ["harmonic_2 O", "mean O", "rms O", "smallest_at O", "largest balancing_torque", "swing balancing_torque"]
    alone, some, together = (sweep(scene, designs, outputs, chunk=chunk, engine=engine) for chunk in (1, 4, 9))
    assert_equal(alone, together)
    assert_equal(some, together)


def followed(mass):
    """A follower whose acceleration jumps, by a cosine of acceleration between rests."""
    rise, back = ks.laws.harmonic(0.05, 0.07, 2.0), ks.laws.harmonic(0.07, 0.05, 1.5)
    rest = ks.laws.dwell(0.05, 2 * np.pi - 4.5)
    law = ks.laws.joined(rise, ks.laws.dwell(0.07, 1.0), back, rest, smooth="velocity")
    follower = ks.RollerFollower(law, follower=ks.Link(mass))
    return ks.Scene(ks.Mechanism("valve", ks.Crank(None), (follower,)), 100.0, loads=[ks.Gravity()])


def test_laws_of_cams_are_parted_where_they_jump():
    """Peaks of the force stand just beside the jumps of the acceleration, where no even sample does."""
    found = sweep(followed, pd.DataFrame({"mass": [1.0, 2.0]}), ["largest contact_force", "smallest contact_force"])
    at = followed(2.0).solve(np.array([1e-12, 2.0 - 1e-12, 3.0 + 1e-12, 4.5 - 1e-12])).scalar("contact_force")
    assert found[FAILED].tolist() == ["", ""]
    assert found.iloc[1, 1] == pytest.approx(at.max(), rel=1e-9)
    assert found.iloc[1, 2] == pytest.approx(at.min(), rel=1e-9)


@pytest.mark.slow
@every("seed", range(6))
def test_near_zero_reactions_are_resolved(seed):
    """Where |R| is sqrt(a^2 + b^2 t^2), friction bends within a / b; nobody tells where that is."""
    rng = np.random.default_rng([3, seed])
    saw = ks.crank_slider(
        0.1, 0.4, guide_offset=rng.uniform(0, 0.03), coupler=ks.Link(5.0, 0.1, 0.1), slider=ks.Link(20.0)
    )
    friction = {name: ks.PinFriction(rng.uniform(0.05, 0.2), 0.02) for name in "OAB"}
    push = ks.ProcessForce(rng.uniform(-1.0, 1.0) * 20.0 * 20.0**2 * 0.1)
    scene = ks.Scene(saw, 20.0, loads=[ks.Gravity(), push], friction=friction)
    names = ("O", "A", "B", "friction_loss")
    found = sweep(scene, pd.DataFrame({"crank_speed": [15.0, 20.0]}), [f"smallest {name}" for name in names])
    assert found[FAILED].tolist() == ["", ""]
    angle = np.linspace(0.0, 2 * np.pi, 7201)[:, None] + np.zeros(1)
    for name, number in zip(names, found.iloc[1, 1:-1], strict=True):
        low, high, least, size = angle[:-1, 0], angle[1:, 0], np.inf, 0.0
        for _ in range(14):
            at = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, 5)
            values = component_sizes(chunk.unchecked_turn(scene, at.ravel()), name)[0].reshape(at.shape)
            least, size = min(least, values.min()), max(size, values.max())
            near = np.argsort(values.min(axis=1))[:20]
            place = np.clip(values[near].argmin(axis=1), 1, 3)
            low, high = at[near, place - 1], at[near, place + 1]
        assert number == pytest.approx(least, abs=3e-8 * size)
