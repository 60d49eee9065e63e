"""Where a group cannot be assembled nothing has a value that hangs on it or carries its forces; all else has one."""

from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import KERNELS
from kinetostatics.mechanics.quantities import of_scene
from support.every import every

BODY, NONE = ks.Link(1.0, 0.02, 0.004), ks.Link()
AROUND = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)


def short_slider(on, body, **options):
    return ks.SliderGroup(on=on, pin="C", label="2", coupler=body, slider=body, **options)


def vee(inner, outer):
    """Two cylinders on one crank, of which the second has too short a rod."""
    second = short_slider("A", outer, coupler_length=0.04, guide=ks.Guide.at(np.pi / 2))
    return ks.SliderGroup(0.2, coupler=inner, slider=inner), second


def yoke(inner, outer):
    """A yoke, which always closes and has no root, beside the same cylinder."""
    second = short_slider("A", outer, coupler_length=0.04, guide=ks.Guide.at(np.pi / 2))
    return ks.YokeGroup(slider=inner, block=inner), second


def on_the_rocker(inner, outer):
    """A four-bar whose rocker carries a slider with too short a rod."""
    four_bar = ks.RockerGroup(0.2, 0.15, (0.2, 0.0), coupler=inner, rocker=inner)
    slider = short_slider("D", outer, coupler_length=0.12, guide=ks.Guide.at(0.0, 0.2))
    return four_bar, ks.Pin("rocker", (0.1, 0.02), "D"), slider


def on_the_lever(inner, outer):
    """A lever that its block leaves, and a slider on it with a rod that is always long enough."""
    lever = ks.LeverGroup((0.0, -0.08), offset=0.04, lever=inner, block=inner)
    return lever, ks.Pin("lever", (0.2, 0.0), "D"), short_slider("D", outer, coupler_length=1.0)


def lever(inner, outer):
    """A lever alone, none of whose joints moves."""
    return (ks.LeverGroup((0.0, -0.08), offset=0.04, lever=inner, block=inner),)


RATES = ("_rate", "_angular_acceleration")
TRAVELS = ("_position", "_velocity", "_acceleration")
SLIDER = [*(f"slider{end}" for end in (*RATES, *TRAVELS)), *(f"coupler{end}" for end in RATES)]
GUIDED = ["A", "guide", "guide_force", "guide_moment"]
STAYING = {
    vee: {*SLIDER, *GUIDED, "B"},
    yoke: {*SLIDER[:5], *GUIDED, "slot_force", "slot_moment", *(f"block{end}" for end in RATES)},
    on_the_rocker: {f"{link}{end}" for link in ("coupler", "rocker") for end in RATES},
    on_the_lever: set(),
    lever: set(),
}
"""What still has a value where the machine cannot be assembled, by machine."""


def made(machine, inner=BODY, outer=BODY, loads=()):
    return ks.Scene(ks.Mechanism(machine.__name__, ks.Crank(0.05, BODY), machine(inner, outer)), 7.0, 3.0, loads)


def computed(scene, angles):
    """Values of every quantity by each way there is, by what it is called, and what of each way is asked."""
    names = tuple(of_scene(scene))
    s, single = (scene.solve(given, on_gap="nan") for given in (angles, angles.astype(np.float32)))
    yield "solution", {name: of_scene(s)[name].read(s) for name in names}
    yield "kernels", KERNELS.values(s.dynamics, names)
    yield "kernels in single precision", {name: of_scene(single)[name].read(single) for name in names}
    program = ks.compile(scene, names, engine="numpy")
    yield "program", program(angles)
    yield "bounds", program.error_bound(angles)
    yield "program in single precision", ks.compile(scene, names, engine="numpy", precision="single")(angles)


@pytest.mark.slow
@every("machine", STAYING, ids=lambda machine: machine.__name__)
@every("inner, outer, loads", [(BODY, BODY, (ks.Gravity(),)), (BODY, NONE, ()), (NONE, NONE, (ks.Gravity(),))])
@pytest.mark.filterwarnings("ignore:crank angles are in single precision")
def test_dependents_of_a_gap_have_no_value(machine, inner, outer, loads):
    scene = made(machine, inner, outer, loads)
    s = scene.solve(AROUND, on_gap="nan")
    open_ = np.any([margin < 0.0 for margin in s.closure], axis=0)
    assert 0 < open_.sum() < AROUND.size
    np.testing.assert_array_equal(s.closed, ~open_)
    for way, found in computed(scene, AROUND):
        for name, values in found.items():
            finite = np.isfinite(values).reshape(-1, AROUND.size).all(axis=0)
            assert finite[~open_].all(), (way, name)
            assert (finite[open_] == (name in STAYING[machine])).all(), (way, name)


@pytest.mark.slow
def test_a_compiled_loop_has_the_gaps_of_numpy(numba):
    scene = made(yoke, NONE, NONE)
    names = tuple(of_scene(scene))
    found, expected = (ks.compile(scene, names, engine=engine)(AROUND) for engine in ("compiled", "numpy"))
    for name in names:
        np.testing.assert_array_equal(np.isnan(found[name]), np.isnan(expected[name]), name)


def test_groups_beside_a_gap_keep_their_values():
    inner, outer = vee(BODY, BODY)
    both, alone = (
        ks.Scene(ks.Mechanism("engine", ks.Crank(0.05, BODY), groups), 7.0, 3.0, ks.Gravity()).solve(
            AROUND, on_gap="nan"
        )
        for groups in ((inner, outer), (inner,))
    )
    for name in STAYING[vee]:
        np.testing.assert_array_equal(of_scene(both)[name].read(both), of_scene(alone)[name].read(alone))


@every("machine", [vee, on_the_rocker], ids=lambda machine: machine.__name__)
def test_friction_has_the_gaps_of_its_forces(machine):
    """Of the first group a cylinder's joint stays beside the other's gap, a rocker's that carries it does not."""
    pin = ks.PinFriction(0.1, 0.01)
    s = replace(made(machine), friction={"O": pin, "A": pin, "C": pin}).solve(AROUND, on_gap="nan")
    for name, stays in (("A", machine is vee), ("C", False), ("O", False)):
        for found in (s.friction_at(name), s.friction_loss_at(name)):
            np.testing.assert_array_equal(np.isfinite(found), s.closed | stays)
    np.testing.assert_array_equal(np.isfinite(s.friction_loss), s.closed)


@pytest.mark.slow
def test_jax_derivatives_are_finite_outside_gaps(double):
    """Beside a gap nothing of it comes into what is differentiated."""
    mechanism = made(vee, outer=NONE).mechanism
    closed = ks.solve(mechanism, AROUND, crank_speed=7.0, on_gap="nan").closed

    def torques(speed):
        s = ks.solve(mechanism, double.numpy.asarray(AROUND), crank_speed=speed, on_gap="nan")
        return s.balancing_torque_by_power

    slope = np.asarray(double.jacfwd(torques)(7.0))
    np.testing.assert_allclose(slope[closed], 2.0 / 7.0 * np.asarray(torques(7.0))[closed], rtol=0.0, atol=1e-16)
    assert np.isnan(np.asarray(torques(7.0))[~closed]).all()
