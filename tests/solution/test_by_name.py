"""Quantities by name: ``s[name]``, the list of names, and suggestions for names that are wrong."""

import copy
import pickle

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from support.every import every

CASE = ks.load_case("sawframe_2r63")
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
SCENE = ks.Scene(SAW, 33.5, loads=[ks.Gravity()], friction={"guide": ks.GuideFriction(0.1)})


@pytest.fixture(scope="module")
def s():
    return SCENE.solve(8)


@pytest.fixture(scope="module")
def run():
    return ks.drive.steady(SCENE, None, flywheel=2000.0)


MACHINES = {
    "cam": lambda: CASE.solve("cam-circle", 8),
    "chain": lambda: ks.load_case("chain_unit").solve("rho-0.1", 8),
    "friction": lambda: SCENE.solve(8),
    "planes": lambda: ks.Scene(
        ks.Mechanism("pump", ks.Crank(0.05, bearings=(-0.1, 0.3)), (ks.SliderGroup(0.2, plane=0.1),)), 9.0
    ).solve(8),
    "designs": lambda: ks.solve(ks.crank_slider(np.array([[0.3], [0.2]]), 2.0), np.arange(8.0), crank_speed=1.0),
}


@pytest.mark.slow
@every("name", MACHINES)
def test_every_listed_name_has_values_and_every_column_a_name(name):
    s = MACHINES[name]()
    assert len(set(s.quantities)) == len(s.quantities)
    assert all(s[one].shape in (s.shape, (2, *s.shape), (8,)) for one in s.quantities)
    for heading, column in s.frame().drop(columns="design", errors="ignore").items():
        np.testing.assert_array_equal(np.broadcast_to(s[heading], s.shape).ravel(), column)
        bare = heading.partition(" [")[0]
        assert (heading in s.quantities) != (bare in s.quantities)


@every(
    "name, read",
    [
        ("guide_force", lambda s: s.guide_force),
        ("O", lambda s: s.reaction("O")),
        ("|O|", lambda s: np.sqrt(s.reaction("O")[0] ** 2 + s.reaction("O")[1] ** 2)),
        ("reaction_O_y", lambda s: s.reaction("O")[1]),
        ("reaction_O_y [N]", lambda s: s.reaction("O")[1]),
        ("B_x [m]", lambda s: s.position("B")[0]),
        ("crank_angle [deg]", lambda s: np.degrees(s.crank_angle)),
        ("slider_position", lambda s: s.slider_position),
        ("slider_position [m]", lambda s: s.slider_position),
        ("coupler_rate", lambda s: s.rate("coupler")),
        ("ground guide", lambda s: s.ground["guide"].force),
        ("guide_friction_loss", lambda s: s.friction_loss_at("guide")),
        ("kinetic_energy", lambda s: s.kinetic_energy),
    ],
)
def test_a_name_reads_as_its_attribute_or_method(s, name, read):
    np.testing.assert_array_equal(s[name], read(s))


@pytest.mark.slow
def test_a_running_has_names_of_its_drive_and_of_its_solution(run):
    assert {"motor_torque", "time", "guide_force", "B_x [m]"} < set(run.quantities)
    assert all(run[name] is not None for name in run.quantities)
    np.testing.assert_array_equal(run["crank_speed"], run.speed)
    np.testing.assert_array_equal(run["kinetic_energy"], run.frame()["kinetic_energy [J]"])
    np.testing.assert_array_equal(run["O"], run.solution.reaction("O"))


@every("call, kind", [(lambda s: s["no"], KeyError), (lambda s: s.ground["no"], KeyError), (list, TypeError)])
def test_a_lookup_fails_as_in_a_dict(s, call, kind):
    with pytest.raises(kind):
        call(s)


def test_the_error_keeps_its_text(s):
    with pytest.raises(ks.QuantityError, match="use one at a time") as caught:
        s["O", "A"], s[["O", "A"]]
    error = caught.value
    assert str(error) == error.args[0] == str(pickle.loads(pickle.dumps(error))) == str(copy.copy(error))
    assert s.ground.get("no") is None


SUGGESTED = [
    ("s['guide_forse']", "guide_force"),
    ("s['torque']", "balancing_torque"),
    ("s['B_x']", "B_x [m]"),
    ("s['crank_angle']", "crank_angle [deg]"),
    ("s['ground gide']", "ground guide"),
    ("run['motor_torqe']", "motor_torque"),
    ("run['guide_forse']", "guide_force"),
    ("s.reaction('gide')", "guide"),
    ("s.reaction('O', at='lft')", "left"),
    ("s.scalar('guide_forse')", "guide_force"),
    ("s.measure('guide_forse')", "guide_force"),
    ("s.position('slidr')", "slider"),
    ("s.velocity(('couplr', 0.1, 0.0))", "coupler"),
    ("s.acceleration('conrod')", "coupler"),
    ("s.rate('couplr')", "coupler"),
    ("s.angular_acceleration('couplr')", "coupler"),
    ("s.travel('slidr')", "slider"),
    ("s.elongation(0.0, 'slidr')", "slider"),
    ("s.inertia_force('couplr')", "coupler"),
    ("s.ground['gide']", "guide"),
    ("s.ground_force('gide')", "guide"),
    ("s.friction_at('gide')", "guide"),
    ("s.friction_loss_at('gide')", "guide"),
    ("s.pin_load('AA')", "A"),
    ("s.shares('guide_forse')", "guide_force"),
    ("s.sections('couplr', bar=ks.Bar(6e-3, 3e-4, mass=61.5))", "coupler"),
    ("s.explain('guide_forse', 1.0)", "guide_force"),
    ("s.condition_of('guide_forse')", "guide_force"),
    ("s.error_bound('|guid|')", "guide"),
    ("s.uncertainty('guide_forse', {'crank_length': 1e-5})", "guide_force"),
    ("s.uncertainty('O', {'crank_lenght': 1e-5})", "crank_length"),
    ("ks.extremes(s, 'guide_forse')", "guide_force"),
    ("ks.compare(s, s).peak_reactions('gide')", "guide"),
    ("ks.compare(s, s).inertia_force_range('couplr')", "coupler"),
    ("ks.plots.over_turn({'saw': s}, 'guide_forse')", "guide_force"),
    ("ks.plots.hodograph(s, 'gide')", "guide"),
    ("ks.plots.hodograph(s, 'O', on='couplr')", "coupler"),
    ("ks.plots.free_body(s, 'couplr', 1.0)", "coupler"),
    ("ks.plots.shares(s, 'guide_forse')", "guide_force"),
    ("ks.plots.animation(s, joints=['BB'], frames=3)", "B"),
    ("ks.plots.shaking_force(s, by='directon')", "direction"),
    ("ks.plots.acceleration_error(s, slider='slidr')", "slider"),
    (
        "ks.plots.sweep_map(pd.DataFrame({'crank_length [m]': [0.3], 'x': 1}), 'crank_length', 'x')",
        "crank_length [m]",
    ),
    ("ks.sizing.bearing(s, 'OO', capacity=1e5, static_capacity=1e5)", "O"),
    ("ks.needs(s, 'guide_forse')", "guide_force"),
    ("ks.tolerances(SCENE, ['largest O'], {'crank_lenght': 'normal 0.3 m +- 1 mm'})", "crank_length"),
    ("SCENE.varied({'crank_lenght': 0.31})", "crank_length"),
    ("SCENE.solve(9, engine='compild')", "compiled"),
    ("ks.compile(SCENE, ('guide_forse',))", "guide_force"),
    ("ks.compile(SCENE, ('O',), parameters=('crank_lenght',))", "crank_length"),
    ("swept('largest guide_forse')", "guide_force"),
    ("swept('largst guide_force')", "largest guide_force"),
    ("swept('mean_torque')", "mean balancing_torque"),
    ("swept('mean_power')", "mean balancing_torque"),
    ("swept('largest O', 'crank_lenght')", "crank_length"),
    ("ks.design.optimise(SCENE, {'crank_lenght': (0.2, 0.3)}, 'largest O')", "crank_length"),
    ("ks.design.optimise(SCENE, {'crank_length': (0.2, 0.3)}, 'largest gide')", "guide"),
    ("CASE.variants['cam-circel']", "cam-circle"),
    ("CASE.solve('cam-circel', 9)", "cam-circle"),
    ("CASE.compare('plain', 'cam-circel')", "cam-circle"),
    ("CASE.variants['plain'].varied({'slider.mas': 1.0})", "slider.mass"),
    ("ks.load_case('sawframe_2r36')", "sawframe_2r63"),
]


def swept(output, path="crank_length"):
    return ks.sweep(SCENE, pd.DataFrame({path: [0.3]}), [output], progress=False)


@pytest.mark.slow
@every("call, meant", SUGGESTED)
def test_a_wrong_name_is_answered_by_the_nearest(s, run, call, meant):
    with pytest.raises(ks.KinetostaticsError) as caught:
        eval(call, globals() | {"s": s, "run": run})
    plt.close("all")
    assert f"did you mean {meant!r}?" in str(caught.value)
