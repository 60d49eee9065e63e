"""Loads by steep tables over travel: engines, designs, single angles and programs read them alike."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import COMPILED, NUMPY
from kinetostatics.engines.program import program_of
from kinetostatics.machine.loads import table_pieces
from support.enclosed import ordinary_angles, worst
from support.every import every

ROWS = [0.1, 0.13, 0.1301, 0.22, 0.2203, 0.3], [0.0, 0.0, -4e3, -4e3, 1e3, 1e3]
BACK = [0.0, 0.0, 500.0, 500.0, 0.0, 0.0]
PUMPS = {
    "level": lambda: ks.crank_slider(0.05, 0.19),
    "inclined": lambda: ks.crank_slider(0.05, 0.19, guide_angle=0.7, guide_offset=0.01),
    "through points": lambda: ks.Mechanism(
        "pump", ks.Crank(0.05), (ks.SliderGroup(0.19, ks.Guide.through((0.0, 0.01), (1.0, 0.4))),)
    ),
    "cam": lambda: ks.cam_crank_slider(ks.cams.Circle(0.05, (0.01, 0.004)), 0.19),
}


def pump(name="level", back=None):
    return ks.Scene(PUMPS[name](), 30.0, loads=[ks.ProcessForce(ks.Table(*ROWS, over="travel", back=back))])


@every("name", PUMPS)
def test_a_steep_force_keeps_to_its_errors(name, flint):
    """One rounding of the travel makes 2.5e-15 of the force, and there are several."""
    scene = pump(name, BACK)
    found = worst(scene.solve(ordinary_angles(scene, 36, 12)))["B"]
    assert found.error < 1e-13 * found.size
    assert found.error <= found.tight <= found.plain < 1e-12 * found.size
    assert found.tight < 50.0 * found.error


def test_numpy_and_loop_read_it_alike(numba):
    scene = pump(back=BACK)
    solved = scene.solve(ordinary_angles(scene, 36, 12))
    one, other = (engine.values(solved.dynamics, ("B", "balancing_torque")) for engine in (NUMPY, COMPILED))
    for name, values in one.items():
        np.testing.assert_allclose(other[name], values, rtol=0.0, atol=1e-13 * np.abs(values).max())


def test_derivatives_are_those_of_the_force():
    scene, step = pump(), 1e-9
    angles = ordinary_angles(scene, 36, 5)[36:]
    program = scene.solve(angles).dynamics
    found, leaves = program_of(program, ("guide_force",))
    place = list(leaves.numbers).index(0.19)
    slope = found.by_parameters((place,)).run(program, leaves)[1]

    def force(length):
        return ks.Scene(ks.crank_slider(0.05, length), 30.0, loads=scene.loads).solve(angles).guide_force

    differences = (force(0.19 + step) - force(0.19 - step)) / (2.0 * step)
    inside = np.abs(differences - slope) < 1e-3 * np.abs(slope).max()
    assert inside.mean() > 0.95  # but for kinks
    assert np.abs(slope).max() > 1e5


def test_designs_together_are_as_each_alone():
    lengths = np.array([[0.187], [0.19], [0.194]])
    angles = ordinary_angles(pump(), 36, 12)
    loads = pump(back=BACK).loads
    together = ks.Scene(ks.crank_slider(0.05, lengths), 30.0, loads=loads).solve(angles, engine="numpy").reaction("B")
    for place, length in enumerate(lengths[:, 0].tolist()):
        alone = ks.Scene(ks.crank_slider(0.05, length), 30.0, loads=loads).solve(angles, engine="numpy").reaction("B")
        np.testing.assert_allclose(together[:, place], alone, rtol=0.0, atol=2.0**-50 * 4e3)


def test_one_crank_angle_is_as_among_others():
    scene = pump(back=BACK)
    angles = ordinary_angles(scene, 12, 4)
    many = scene.solve(angles, engine="numpy").reaction("B")
    for place in range(0, angles.size, 5):
        np.testing.assert_allclose(scene.solve(float(angles[place])).reaction("B"), many[:, place], rtol=0, atol=4e-12)


def test_far_turns_keep_a_bound():
    scene = pump()
    s = scene.solve(ordinary_angles(scene, 36, 12) + 1600 * np.pi)
    assert np.isfinite(NUMPY.with_bounds(s.dynamics, ("B",))[1]["B"]).all()


def test_beyond_a_steep_table_it_is_an_error():
    table = ks.Table([0.15, 0.1501, 0.2], [0.0, 4e3, 4e3], over="travel")
    with pytest.raises(ks.ParameterError, match="the slider goes from"):
        ks.Scene(PUMPS["level"](), 30.0, loads=[ks.ProcessForce(table)]).solve(36).balancing_torque  # noqa: B018


def test_programs_read_it_with_the_numbers_they_are_given():
    """Zeros among them, which are no numbers of a scene."""
    scene = pump(back=BACK)
    program = ks.compile(scene, "B", parameters=("guide_offset",), engine="numpy")
    angles = ordinary_angles(scene, 36, 12)
    for values in (
        {},
        {"guide_offset": 0.004},
        {"guide_offset": 0.0, "coupler_length": 0.188},
        {"crank_length": 0.049},
    ):
        machine = ks.crank_slider(**({"crank_length": 0.05, "coupler_length": 0.19} | values))
        varied = ks.Scene(machine, 30.0, loads=scene.loads)
        expected = varied.solve(angles, engine="numpy").reaction("B")
        np.testing.assert_allclose(program(angles, values)["B"], expected, rtol=0.0, atol=1e-11)


def test_values_alone_need_no_errors_of_tables(monkeypatch):
    s = pump().solve(36)
    monkeypatch.setattr(table_pieces, "kink_bounds", None)
    assert np.isfinite(s.reaction("B")).all()
    with pytest.raises(TypeError):
        s.error_bound("B")
