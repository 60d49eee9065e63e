"""Motions that come to rest under loads which ask for the sense of rotation, and what may follow from that sense."""

import numpy as np
import pytest

import kinetostatics as ks
from support.mirror import mirrored
from support.turning_machines import ANGLES, turning_scene

PRESS = ks.crank_slider(0.1, 0.35, crank=ks.Link(2.0, 0.03, 0.02), slider=ks.Link(4.0))
RUBS = {"guide": ks.GuideFriction(0.1)}
OPPOSED = {
    "table": ks.ProcessForce(ks.Table([0.2, 0.5], [-300.0] * 2, over="travel", back=[300.0] * 2)),
    "sign": ks.ProcessForce(lambda q: -300.0 * np.sign(q.slider_velocity)),
    "sense": ks.ProcessForce(lambda q: 300.0 * np.sign(q.crank_sense * np.sin(q.crank_angle))),
}
"""Laws of one force: 300 N against the motion of the slider."""


@pytest.mark.slow
@pytest.mark.parametrize("law", OPPOSED)
@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("until", ["standstill", 0.2])
@pytest.mark.parametrize("friction", [{}, RUBS], ids=["free", "rubbing"])
def test_machine_stops_against_opposing_loads(law, sense, until, friction):
    """Steps of the integration end beyond the standstill; the loads may take no speed against the sense for it."""
    scene = ks.Scene(PRESS, 1.0, loads=OPPOSED[law], friction=friction)
    motion = ks.drive.coast(scene, 0.1, from_angle=sense * 0.7, from_speed=sense * 6.0, until=until)
    assert motion.events[-1].name == "standstill"
    assert sense * motion.crank_angle[-1] == pytest.approx(0.804471 if friction else 0.806150, abs=2e-6)
    assert motion.energy_drift < 1e-12


# What a program is told of the sense

WORK = ks.ProcessForce(ks.Table([0.2, 0.5], [-100.0] * 2, over="travel", back=[30.0, 0.0]))


@pytest.mark.slow
@pytest.mark.parametrize("drive", ["crank_speed", "crank_acceleration"])
@pytest.mark.parametrize("friction", [{}, RUBS], ids=["free", "rubbing"])
def test_jax_differentiates_with_a_given_sense(drive, friction):
    """While JAX traces a speed its value is not known, so nothing is said of rest."""
    jax = pytest.importorskip("jax")

    def torque(value, angle):
        motion = {"crank_speed": 2.0, "crank_acceleration": 1.0, drive: value}
        return ks.solve(PRESS, angle, loads=WORK, friction=friction, **motion).balancing_torque.sum()

    with jax.enable_x64(True):
        slope = jax.grad(torque)(2.0, jax.numpy.array([0.5]))
    between = (torque(2.001, np.array([0.5])) - torque(1.999, np.array([0.5]))) / 0.002
    assert float(slope) == pytest.approx(between, rel=1e-8)


@pytest.mark.slow
def test_a_speed_of_jax_that_is_known_is_looked_at():
    jax = pytest.importorskip("jax")
    with pytest.raises(ks.ParameterError, match=r"give sense=\+1 or sense=-1"):
        _ = ks.solve(PRESS, jax.numpy.array([0.5]), crank_speed=jax.numpy.array(0.0), loads=WORK).balancing_torque
    with pytest.raises(ks.ParameterError, match="sense is for a crank at rest"):
        ks.solve(PRESS, jax.numpy.array([0.5]), crank_speed=jax.numpy.array(3.0), sense=-1, loads=WORK)


DERIVED = {
    "uncertainty": lambda scene: scene.solve(9).uncertainty("balancing_torque", {"sense": 0.1}),
    "program": lambda scene: ks.compile(scene, "balancing_torque").derivatives(0.5, "sense"),
}


@pytest.mark.parametrize("name", DERIVED)
def test_nothing_is_derived_by_the_sense(name):
    """It is one of two; a slope between them was told: 0.29 N m a unit of it."""
    scene = ks.Scene(PRESS, 0.0, loads=WORK, friction=RUBS, sense=-1)
    with pytest.raises(ks.ParameterError, match=r"no derivative by sense: it is \+1 or -1 and nothing between"):
        DERIVED[name](scene)
    slopes = ks.compile(scene, "balancing_torque").derivatives(0.5)["balancing_torque"]
    assert "slider.mass" in slopes
    assert "sense" not in slopes


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("kind", ["crank slider", "lever", "roller follower", "two sliders"])
def test_machine_at_rest_equals_one_that_creeps(kind, sense):
    turning = turning_scene(kind, 60, friction=True)
    rest = ks.Scene(turning.mechanism, 0.0, 0.0, turning.loads, turning.friction, sense=sense)
    creeping = ks.Scene(turning.mechanism, sense * 1e-12, 0.0, turning.loads, turning.friction)
    torque = rest.solve(ANGLES).balancing_torque
    close = 1e-9 * np.abs(torque).max()
    assert creeping.solve(ANGLES).balancing_torque == pytest.approx(torque, abs=close)
    assert mirrored(rest).solve(-ANGLES).balancing_torque == pytest.approx(-torque, abs=close)


@pytest.mark.parametrize("loads", [(), (ks.ProcessForce(ks.Table([0.2, 0.5], [-100.0] * 2, "travel", [100.0] * 2)),)])
def test_machine_at_rest_from_the_start_is_solved(loads):
    scene = ks.Scene(PRESS, 1.0, loads=[ks.Gravity(), *loads], friction={"O": ks.PinFriction(0.5, 0.3)})
    motion = ks.drive.coast(scene, 0.06, from_angle=1.4, until=2.0)
    assert motion.events[-1].name == "standstill"
    assert np.all(np.abs(motion.solution.crank_sense) == 1.0)
    assert np.isfinite(motion.solution.balancing_torque).all()
    assert motion.energy_drift == 0.0
