"""Motions that come to rest under loads which ask for the sense of rotation, and what may follow from that sense."""

import numpy as np
import pytest

import kinetostatics as ks

PRESS = ks.crank_slider(0.1, 0.35, crank=ks.Link(2.0, 0.03, 0.02), slider=ks.Link(4.0))
RUBS = {"guide": ks.GuideFriction(0.1)}
OPPOSED = {
    "table": ks.ProcessForce(ks.Table([0.2, 0.5], [-300.0] * 2, over="travel", back=[300.0] * 2)),
    "sign": ks.ProcessForce(lambda q: -300.0 * np.sign(q.slider_velocity)),
    "sense": ks.ProcessForce(lambda q: 300.0 * np.sign(q.crank_sense * np.sin(q.crank_angle))),
}
"""Laws of one force: 300 N against the motion of the slider."""


@pytest.mark.parametrize("law", OPPOSED)
@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("until", ["standstill", 0.2])
@pytest.mark.parametrize("friction", [{}, RUBS], ids=["free", "rubbing"])
def test_a_machine_stops_against_loads_that_oppose_motion(law, sense, until, friction):
    """Steps of the integration end beyond the standstill; the loads may take no speed against the sense for it."""
    scene = ks.Scene(PRESS, 1.0, loads=OPPOSED[law], friction=friction)
    motion = ks.drive.coast(scene, 0.1, from_angle=sense * 0.7, from_speed=sense * 6.0, until=until)
    assert motion.events[-1].name == "standstill"
    assert sense * motion.crank_angle[-1] == pytest.approx(0.804471 if friction else 0.806150, abs=2e-6)
    assert motion.energy_drift < 1e-12
