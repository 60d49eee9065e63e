"""Tables over travel where they are steep: as near to exact arithmetic as others, by whichever numbers."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import steep
from kinetostatics.engines.engines import COMPILED, NUMPY
from kinetostatics.engines.program import program_of
from kinetostatics.machine.loads import tables
from kinetostatics.studies.methods.enclosures import on_arb
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
IN_LONG = {"long numbers": steep.LONG, "two parts": False}
"""By what a travel is found where a table is steep; the first only where the platform has them."""


def pump(name="level", back=None):
    return ks.Scene(PUMPS[name](), 30.0, loads=[ks.ProcessForce(ks.Table(*ROWS, over="travel", back=back))])


@every("name, way", [(name, way) for name in PUMPS for way in IN_LONG])
def test_a_steep_force_is_known_as_well_as_a_level_one(name, way, monkeypatch, flint):
    """One rounding of the travel makes 2.5e-15 of it, and there are several."""
    monkeypatch.setattr(steep, "LONG", IN_LONG[way])
    scene = pump(name, BACK)
    found = worst(scene.solve(ordinary_angles(scene, 36, 12)))["B"]
    most = 20.0 if name == "through points" else 1.0  # its direction is rounded itself
    assert found.error < most * 3e-16 * found.size
    assert found.error <= found.tight <= found.plain < most * 3e-15 * found.size


def test_long_numbers_and_two_parts_agree_but_for_one_rounding(monkeypatch):
    scene = pump()
    angles = ordinary_angles(scene, 36, 12)
    one = scene.solve(angles, engine="numpy").reaction("B")
    monkeypatch.setattr(steep, "LONG", False)
    other = scene.solve(angles, engine="numpy").reaction("B")
    np.testing.assert_allclose(one, other, rtol=0.0, atol=2.0**-52 * 4e3)


def test_numpy_and_loop_read_it_alike(numba):
    scene = pump(back=BACK)
    solved = scene.solve(ordinary_angles(scene, 36, 12))
    one, other = (engine.values(solved.dynamics, ("B", "balancing_torque")) for engine in (NUMPY, COMPILED))
    for name, values in one.items():
        np.testing.assert_allclose(other[name], values, rtol=0.0, atol=2.0**-50 * np.abs(values).max())


def known(scene, angles):
    """Where the program reads the table by a travel of more digits."""
    state = scene.solve(angles).dynamics
    program, leaves = program_of(state, ("B",))
    return program.rows(state, leaves)[3]


def test_only_where_it_is_steep_a_travel_of_more_digits_is_found():
    scene = pump()
    angles = ordinary_angles(scene, 360, 2)
    slope = scene.loads[0].force.pieces(scene.solve(angles).dynamics)[2]
    np.testing.assert_array_equal(known(scene, angles), np.abs(slope) > 1e6)
    assert np.any(known(scene, angles))
    assert not np.any(known(scene, angles + 1600 * np.pi))
    level = ks.Scene(PUMPS["level"](), 30.0, loads=[ks.ProcessForce(ks.Table([0.1, 0.3], [0.0, 4e3], over="travel"))])
    assert not np.any(known(level, angles))


def test_where_it_is_not_steep_the_bits_are_the_same(monkeypatch):
    scene = pump(back=BACK)
    angles = ordinary_angles(scene, 36, 12)
    ways = []
    for steepness in (tables.STEEP, np.inf):
        monkeypatch.setattr(tables, "STEEP", steepness)
        ways.append((known(scene, angles), scene.solve(angles, engine="numpy").reaction("B")))
    (steeply, one), (never, other) = ways
    assert not np.any(never)
    np.testing.assert_array_equal(one[:, steeply == 0], other[:, steeply == 0])
    assert np.any(one != other)


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


@every("name, way", [(name, way) for name in PUMPS for way in IN_LONG])
def test_a_travel_of_more_digits_is_within_its_bound_and_that_is_small(name, way, flint, monkeypatch):
    """Where it is steep or not; a rounded direction of a guide is rounded as doubles are."""
    scene = pump(name)
    solved = scene.solve(ordinary_angles(scene, 36, 2))
    program, leaves = program_of(solved.dynamics, ("B",))
    (made,) = (table.compute for table in program.recording.tables)
    (read,) = (cell.cell_contents for cell in made.__closure__ if isinstance(cell.cell_contents, steep.SteepTable))
    everywhere = np.ones(solved.shape, dtype=bool)
    value, rest = (read._in_long if IN_LONG[way] else read._in_two)(everywhere, solved.dynamics, leaves)
    bound = read._off(everywhere, solved.dynamics, leaves)
    with flint.ctx.workprec(200):
        exact = on_arb(flint.arb, solved).travel("slider")
        off = [
            abs(flint.arb(float(one)) + flint.arb(float(two)) - true)
            for one, two, true in zip(value, rest, np.ravel(exact), strict=True)
        ]
        assert all(part < flint.arb(float(most)) for part, most in zip(off, bound, strict=True))
    assert np.max(bound) < (2.0**-50 if name == "through points" else 2.0**-60) * np.max(value)


def test_values_alone_find_nothing_that_only_bounds_need(monkeypatch):
    s = pump().solve(36)
    monkeypatch.setattr(steep.SteepTable, "pieces_and_errors", None)
    assert np.isfinite(s.reaction("B")).all()
    with pytest.raises(TypeError):
        s.error_bound("B")
