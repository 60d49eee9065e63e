"""Designs as one batch: the same numbers whoever comes with them."""

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
from support.every import every
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import assert_equal, sweep


def test_plain_function_is_called_a_design():
    found = sweep(factories.by_plain_numbers, DESIGNS, OUTPUTS, angles=36)
    pd.testing.assert_frame_equal(found, sweep(factories.pump, DESIGNS, OUTPUTS, angles=36), rtol=1e-14)


def test_a_batch_of_another_shape_is_refused():
    made = lambda crank, mass: factories.pump(np.full((3, 1), 0.1), 1.0)  # noqa: E731
    found = sweep(made, DESIGNS[:2], OUTPUTS, angles=36)
    assert found[FAILED].str.contains("arrays must have the shape (designs, 1)", regex=False).all()


@pytest.mark.slow
def test_as_many_designs_as_angles_is_no_batch():
    pump = ks.crank_slider(0.1, 0.4, coupler=ks.Link(1.0, 0.2, 0.01), slider=ks.Link(2.0))

    def made(shape):
        return lambda acceleration: ks.Scene(pump, 30.0, np.reshape(acceleration, shape))

    designs = pd.DataFrame({"acceleration": np.linspace(100.0, 300.0, MIN_ANGLES_PER_TURN)})
    column, flat = (sweep(made(shape), designs, "largest O", angles=MIN_ANGLES_PER_TURN) for shape in ((-1, 1), -1))
    assert flat["largest O [N]"].to_numpy() == pytest.approx(column["largest O [N]"].to_numpy(), rel=1e-12)


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
            largest, smallest, extent, *others = (
                found.loc[row, next(column for column in found if column.startswith(f"{kind} {name} "))]
                for kind in OF_SPIKES
            )
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
    monkeypatch.setattr(chunk, "Parted", None)
    scene, names = of_smooth_curve(1100, around), ("balancing_torque", "O")
    outputs = [f"{kind} {name}" for name in names for kind in ("largest", "mean_absolute", "rms")]
    found = sweep(scene, pd.DataFrame({"crank_length": [0.04, 0.05]}), outputs, angles=angles)
    assert found[FAILED].tolist() == ["", ""]
    for name in names:
        largest, *others = (found.loc[1, next(c for c in found if c.startswith(f"{kind} {name} "))] for kind in KINDS)
        low, high = spikes.ends(scene, name)
        assert largest == pytest.approx(high, abs=1e-5 * max(high, -low))
        assert others == pytest.approx(spikes.means(scene, name), rel=2e-5)


KINDS = ("largest", "mean_absolute", "rms")


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
    names = ("balancing_torque", "B", "guide_force")
    outputs = [f"{kind} {name}" for name in names for kind in ("largest", "smallest")]
    found = sweep(scene, pd.DataFrame({"crank_length": [0.04, 0.05]}), outputs, angles=angles).iloc[1, 1:-1]
    at = scene.solve(36)
    truth = [end for name in names for end in reversed(ks.extremes(at, name).range)]
    np.testing.assert_allclose(found.to_numpy(dtype=float), truth, rtol=1e-6)


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
    outputs = [f"{end} {name}" for name in ("O", "B", "balancing_torque") for end in ("smallest", "largest")]
    found = sweep(scene, pd.DataFrame({"crank_length": [0.04, 0.043, 0.05]}), outputs)
    at = scene.solve(36)
    truth = [end for name in ("O", "B", "balancing_torque") for end in ks.extremes(at, name).range]
    np.testing.assert_allclose(found.iloc[2, 1:-1].to_numpy(dtype=float), truth, rtol=1e-6)


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
            values = component_sizes(chunk.solution_of(scene, at.ravel()), name)[0].reshape(at.shape)
            least, size = min(least, values.min()), max(size, values.max())
            near = np.argsort(values.min(axis=1))[:20]
            place = np.clip(values[near].argmin(axis=1), 1, 3)
            low, high = at[near, place - 1], at[near, place + 1]
        assert number == pytest.approx(least, abs=3e-8 * size)
