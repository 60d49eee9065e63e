"""Chains of every kind of group and pin: full systems, balance of powers, and all that the library asks of groups."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import kinetostatics as ks
from kinetostatics.cycle.extremes import extremes_frame
from kinetostatics.mechanics.quantities import components, of_mechanism
from kinetostatics.studies.methods.high_precision.enclosures import enclosure
from support.chains import chain, error_beside_constraints, errors_beside_full_systems
from support.turning_machines import KINDS, random_machine

ANGLES = np.linspace(0.1, 6.2, 13)
BODY = {
    "crank": ks.Link(2.0, (0.04, 0.02), 0.03),
    "slider": ks.Link(5.0, (0.03, 0.05), 0.1),
    "block": ks.Link(0.7, (0.01, -0.02), 0.002),
    "lever": ks.Link(4.0, (0.3, 0.03), 0.2),
    "rod": ks.Link(1.5, (0.2, 0.01), 0.05),
    "cylinder": ks.Link(3.0, (0.1, -0.02), 0.04),
}


def links(*names):
    return {name: BODY[name] for name in names}


def mechanism(kind, label=""):
    """A crank with one of the groups; a dyad closes a Watt chain between the rocker and a second crank pin."""
    groups = {
        "yoke": lambda: [ks.YokeGroup(ks.Guide.at(0.4, 0.03), 1.2, **links("slider", "block"), label=label)],
        "lever": lambda: [ks.LeverGroup((0.1, -0.3), offset=0.05, **links("lever", "block"), label=label)],
        "whitworth": lambda: [ks.LeverGroup((0.02, -0.04), **links("lever", "block"), label=label)],
        "cylinder": lambda: [ks.CylinderGroup((0.3, -0.4), **links("rod", "cylinder"), label=label)],
        "dyad": lambda: [
            ks.RockerGroup(0.4, 0.3, (0.35, 0.1)),
            ks.Pin(on="rocker", at=(0.1, 0.15), name="E"),
            ks.Pin(on="crank", at=(-0.03, 0.06)),
            ks.Dyad(0.5, 0.45, ("C", "E"), dyad1=BODY["rod"], dyad2=BODY["lever"], label=label),
        ],
        "pin": lambda: [
            ks.Pin(on="crank", at=(-0.03, 0.06)),
            ks.SliderGroup(0.5, on="C", coupler=BODY["rod"], slider=BODY["slider"], label=label),
        ],
    }
    return ks.Mechanism(kind, ks.Crank(0.1, BODY["crank"]), tuple(groups[kind]()))


def scene(kind, label=""):
    made = mechanism(kind, label)
    return ks.Scene(made, 30.0, 50.0, (ks.Gravity(9.81, -1.3), *(ks.ProcessForce(35.0, on) for on in made.guides)))


every_kind = pytest.mark.parametrize("kind", ["yoke", "lever", "whitworth", "cylinder", "dyad", "pin"])


@pytest.mark.parametrize("seed", [*range(4), *(pytest.param(n, marks=pytest.mark.slow) for n in range(4, 24))])
def test_random_chains_agree_with_two_full_systems(seed):
    made, angles = chain(seed)
    s = made.solve(angles)
    errors = errors_beside_full_systems(s, 0) | {"constraints": error_beside_constraints(s)}
    assert {what: error for what, error in errors.items() if not error < 1e-12} == {}
    assert s.power_residual < 1e-13
    direct = sum(s.inertia_force(link) for link in s.mechanism.links)
    assert np.max(np.abs(s.shaking_force - direct)) < 1e-13 * np.max(np.abs(direct))


WITHOUT_FORMULA = ("sampled cam", "law cam", "roller follower", "flat follower", "swinging follower")
"""Kinds of machines whose cam or law the full systems do not know; followers have tests of their own."""
KNOWN = [kind for kind in KINDS if kind not in WITHOUT_FORMULA]


@pytest.mark.parametrize(
    ("kind", "seed"),
    [
        *((kind, 0) for kind in ("crank slider", "cosine cam", "drag link")),
        *(pytest.param(kind, seed, marks=pytest.mark.slow) for kind in KNOWN for seed in (1, 10, 20)),
    ],
)
def test_machines_of_every_kind_agree_with_two_full_systems(kind, seed):
    """Joints, mass centres and directions with their derivatives, all forces, both torques; statics is no special case.

    The two torques share no force: one follows equilibrium link by link, one the powers of all loads.
    """
    moving = random_machine(kind, seed, loads=("gravity", "spring", "process"))
    for made in (moving, replace(moving, crank_speed=0.0, crank_acceleration=0.0)):
        s = made.solve(ANGLES[seed % 10 :: 5])
        errors = errors_beside_full_systems(s, 0) | {"constraints": error_beside_constraints(s)}
        assert {what: error for what, error in errors.items() if not error < 1e-13} == {}
        assert s.power_residual < 1e-14
        for group in s.mechanism.groups:
            if isinstance(group, ks.SliderGroup):
                x, y = group.guide.direction
                found = s.scalar("guide_force" + group.label) * np.array([[-y], [x]])
                assert_allclose(s.reaction("guide" + group.label), found, rtol=1e-14, atol=0.0)


@every_kind
def test_each_group_passes_the_check_of_groups(kind):
    for group in mechanism(kind).groups:
        report = ks.check(group)
        assert report.ok, report


@pytest.mark.slow
def test_engines_find_the_same(interpreted):
    parts = (
        *mechanism("dyad").groups,
        ks.YokeGroup(ks.Guide.at(0.4, 0.03), 1.2, "D", "F", **links("slider", "block"), label="Y"),
        ks.LeverGroup((0.1, -0.6), "B", 0.05, **links("lever", "block"), pivot_name="O3", label="L"),
        ks.Pin(on="sliderY", at=(0.1, 0.2), name="I"),
        ks.CylinderGroup((0.2, 1.9), "I", **links("rod", "cylinder"), pivot_name="O4", label="C"),
    )
    made = ks.Mechanism("all", ks.Crank(0.1, BODY["crank"]), parts)
    plain, compiled = (
        ks.solve(made, ANGLES, crank_speed=30.0, crank_acceleration=50.0, loads=[ks.Gravity()], engine=engine)
        for engine in ("numpy", "compiled")
    )
    for name in of_mechanism(made):
        expected = np.array(components(plain, name))
        error = np.max(np.abs(np.array(components(compiled, name)) - expected))
        assert error <= 1e-13 * max(np.max(np.abs(expected)), 1e-9), name


@pytest.mark.slow
@every_kind
def test_derivatives_are_those_of_differences(kind):
    program = ks.compile(scene(kind), ("balancing_torque", "O"), engine="numpy")
    for path, value in program.parameters.items():
        slopes, step = program.derivatives(ANGLES, by=(path,)), 1e-5 * abs(value)
        above, below = (program(ANGLES, {path: value + sign * step}) for sign in (1, -1))
        for name, found in slopes.items():
            expected = (above[name] - below[name]) / (2 * step)
            noise = 1e-10 * np.max(np.abs(above[name])) / abs(value)
            assert np.max(np.abs(found[path] - expected)) < 1e-6 * np.max(np.abs(expected)) + noise, (path, name)


@every_kind
def test_every_group_and_pin_has_its_own_paths(kind):
    made = mechanism(kind, "2")
    program = ks.compile(ks.Scene(made, 30.0), ("O",), engine="numpy")
    wanted = {
        "yoke": {"slot_angle2", "guide_offset2", "slider2.mass", "block2.centre.along"},
        "lever": {"lever_pivot2.x", "slot_offset2", "lever2.inertia", "block2.mass"},
        "whitworth": {"lever_pivot2.y", "lever2.centre.across"},
        "cylinder": {"cylinder_pivot2.x", "rod2.mass", "cylinder2.inertia"},
        "dyad": {"dyad1_length2", "dyad2_length2", "pin_C.along", "pin_E.across", "dyad12.mass", "dyad22.inertia"},
        "pin": {"pin_C.along", "pin_C.across", "coupler2.mass"},
    }
    assert wanted[kind] <= set(program.parameters)


@pytest.mark.slow
@every_kind
def test_condition_is_small_where_nothing_is_lost(kind):
    condition = scene(kind).solve(ANGLES).condition
    assert np.all((condition >= 1.0) & (condition < 1e5))


@every_kind
def test_a_batch_of_designs_is_each_design_alone(kind):
    made = scene(kind)
    cranks = np.array([[0.09], [0.1], [0.11]])
    batch = made.varied({"crank_length": cranks}).solve(ANGLES)
    for row, crank in enumerate(cranks[:, 0]):
        alone = made.varied({"crank_length": float(crank)}).solve(ANGLES)
        assert_array_equal(batch.balancing_torque[row], alone.balancing_torque)


@pytest.mark.slow
@every_kind
def test_outputs_stand_in_frames_and_extremes(kind):
    s = scene(kind, "2").solve(ANGLES)
    columns, table = set(s.frame().columns), extremes_frame(s)
    for name, output in s.mechanism.outputs.items():
        wanted = f"reaction_{name}_x" if output.vector else name
        assert f"{wanted} [{output.unit}]" in columns
        if not output.vector:
            assert table.loc[name.replace("_", " "), "unit"] == output.unit
        assert output.text


@every_kind
def test_kernels_run_on_intervals_and_are_enclosed(kind):
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    s = scene(kind).solve(ANGLES[:3])
    found = enclosure(s, "balancing_torque")
    assert np.max(np.abs(s.balancing_torque - found.middle)) < 1e-13 * np.max(np.abs(found.middle))


@every_kind
def test_a_mechanism_is_drawn_and_has_true_extremes(kind):
    s = scene(kind).solve(ANGLES)
    ax = ks.plots.mechanism(s, angles=(30,), ax=plt.subplots()[1])
    corners = np.concatenate([line.get_xydata() for line in ax.lines if line.get_linestyle() != "None"])
    pose = s.at(np.radians([30.0]))
    for name in s.mechanism.joints:
        assert np.nanmin(np.hypot(*(corners - pose.position(name)[:, 0]).T)) < 1e-12
    plt.close("all")
    fine = scene(kind).solve(np.linspace(0, 2 * np.pi, 2001))
    largest = ks.extremes(s, "O").largest
    sampled = np.max(np.hypot(*fine.reaction("O")))
    assert sampled * (1 - 1e-12) <= largest < sampled * (1 + 1e-4)
