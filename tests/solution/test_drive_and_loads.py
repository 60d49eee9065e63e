"""Drive and loads in a line, and tables among them."""

import numpy as np

import kinetostatics as ks

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def test_scene_and_solution_show_themselves_in_a_line_however_long_their_tables():
    speed = np.linspace(30.0, 40.0, TURN.size)
    scene = ks.Scene(SAW, speed, loads=[ks.Gravity(), ks.ProcessForce(speed)])
    drive = "crank_speed=<array of shape (24,)>, crank_acceleration=0.0, Gravity, ProcessForce>"
    assert repr(scene) == f"<Scene: crank-slider, {drive}"
    assert repr(scene.solve(TURN)) == f"<Solution: crank-slider, shape (24,), {drive}"
    assert repr(ks.Scene(SAW, 33.5)) == "<Scene: crank-slider, crank_speed=33.5, crank_acceleration=0.0, no loads>"
