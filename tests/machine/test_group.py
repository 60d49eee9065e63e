"""A new kind of group in one class: what it declares is all that the rest of the library needs to know of it."""

import ast
import inspect
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.animation import PillowWriter

import kinetostatics as ks
from kinetostatics.cycle.extremes import extremes_frame
from kinetostatics.machine.group import FRAME, Declaration, Group, Output, Point
from kinetostatics.machine.links import Joint, LinkMotion, Sliding, Slot, Turning, Wrench
from kinetostatics.mechanics.principal_points import principal_points
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import cos, sin
from kinetostatics.numbers.planar import (
    dot,
    minus,
    number_or_zero,
    plus,
    rotate,
    rotate_back,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
)
from kinetostatics.solution.program import compile as compiled
from kinetostatics.solution.scene import Scene
from kinetostatics.studies.methods.global_system import newton
from kinetostatics.studies.methods.high_precision.enclosures import enclosure
from kinetostatics.studies.methods.kane import equations
from support.every import every


@dataclass(frozen=True, eq=False)
class Yoke(Group):
    """Scotch yoke (RPP): a block on joint `on` slides in the slot of a slider, at an angle to the slider's guide.

    The slider's joint is where the slot's line meets the guide; the slot pushes across itself, from the slider on the
    block.
    """

    guide: ks.Guide = ks.Guide()
    slot_angle: Any = np.pi / 2
    slider: ks.Link = ks.Link()
    block: ks.Link = ks.Link()
    on: str = "A"
    pin: str = "B"
    label: str = ""

    PATHS: ClassVar = {"guide": ""}
    LINKS: ClassVar = {"block": "on", "slider": "pin"}

    @property
    def declaration(self):
        """Parts, without the label."""
        slot = Slot("slider", self.on, angle=self.slot_angle)
        lengths = (self.guide.guide_offset,)
        return Declaration({self.pin: Point("slider")}, guides={"slider": self.guide}, slots=(slot,), lengths=lengths)

    @property
    def outputs(self):
        """Pin force, and what slot and guide bear."""
        units = {"slot_force": "N", "slot_moment": "N m", "guide_force": "N", "guide_moment": "N m"}
        pin = Output("N", True, f"on the block at {self.on}", self.on)
        return {self.called(self.on): pin} | {self.called(name): Output(unit) for name, unit in units.items()}

    def place(self, placement):
        """Slider where the slot's line meets the guide."""
        slope = cos(self.slot_angle) / sin(self.slot_angle)
        parts = [rotate_back(vector_or_zero(part), self.guide.direction) for part in placement.joints[self.on]]
        rise = [parts[0][1] - self.guide.guide_offset, parts[1][1], parts[2][1]]
        along = [part[0] - slope * up for part, up in zip(parts, rise, strict=True)]
        across = (self.guide.guide_offset, 0.0, 0.0)
        pairs = zip(along, across, strict=True)
        self.follow(placement, {self.pin: Joint(*(rotate(pair, self.guide.direction) for pair in pairs))})

    def follow(self, placement, joints):
        """Block and slider at joints that are known."""
        u, pin = self.guide.direction, joints[self.pin]
        slot = rotate((cos(self.slot_angle), sin(self.slot_angle)), u)
        block, slider = LinkMotion(placement.joints[self.on], slot, None, None), LinkMotion(pin, u, None, None)
        travel = Joint(*(dot(u, part) for part in pin))
        self.enter(placement, slot, {self.pin: pin}, {"block": block, "slider": slider}, {"slider": travel})

    def closure(self, placement):
        """Squared sine of the slot's angle."""
        return sin(self.slot_angle) ** 2 + 0.0 * placement.angle

    def requirement(self, placement):
        """Say when it closes."""
        return "the slot must not be parallel to the guide"

    def resolve(self, placement, loads, along):
        """Slider along the guide, block, slider across it."""
        (block, on), (_, applied) = self.of_links(loads), self.of_links(along)
        pin, base = (placement.joints[name].position for name in (self.on, self.pin))
        push = rotate_back(vector_or_zero(on.force), self.guide.direction)
        slot, way = -plus(push[0], applied) / sin(self.slot_angle), self.placed(placement)
        guide = cos(self.slot_angle) * slot - push[1]
        couple = minus(None, block.moment)
        moment = plus(minus(couple, on.moment), dot(subtract_vectors(pin, base), way) * slot)
        force = vector_or_zero(subtract_vectors(scale_vector(-slot, rotate(way, (0.0, 1.0))), block.force))
        return self.resolved((force,), (slot, number_or_zero(couple), guide, moment), {self.on: Wrench(force, None)})


LINKS = {
    "crank": ks.Link(2.0, (0.04, 0.02), 0.03),
    "block": ks.Link(0.7, (0.01, -0.02), 0.002),
    "slider": ks.Link(5.0, (0.03, 0.05), 0.1),
}
ANGLES = np.linspace(0.0, 2 * np.pi, 12, endpoint=False) + 0.1
SLOT, TILT, OFFSET = 1.2, 0.4, 0.03
LOADS = (ks.Gravity(9.81, -1.3), ks.Spring(800.0, 0.02), ks.ProcessForce(35.0))
QUANTITIES = ("balancing_torque", "O", "A", "slot_force", "slot_moment", "guide_force", "guide_moment")


def mechanism(label="", **changes):
    yoke = Yoke(ks.Guide.at(TILT, OFFSET), SLOT, LINKS["slider"], LINKS["block"], label=label, **changes)
    return ks.Mechanism("Scotch yoke", ks.Crank(0.1, LINKS["crank"]), (yoke,))


def scene(label=""):
    loads = (LOADS[0], *(ks.Spring(800.0, 0.02, on="slider" + label), ks.ProcessForce(35.0, on="slider" + label)))
    return Scene(mechanism(label), 30.0, 50.0, loads)


@pytest.fixture(scope="module")
def solution():
    return scene().solve(ANGLES)


def test_group_agrees_with_the_yoke_of_the_package(solution):
    """Which agrees with two full systems of equations (`tests/laws/test_chains.py`)."""
    yoke = ks.YokeGroup(ks.Guide.at(TILT, OFFSET), SLOT, slider=LINKS["slider"], block=LINKS["block"])
    other = ks.Mechanism("yoke", ks.Crank(0.1, LINKS["crank"]), (yoke,))
    known = ks.solve(other, ANGLES, crank_speed=30.0, crank_acceleration=50.0, loads=LOADS)
    for name in QUANTITIES:
        found, expected = (np.array(components(s, name)) for s in (solution, known))
        assert np.max(np.abs(found - expected)) < 1e-13 * np.max(np.abs(expected)), name


def test_its_class_takes_at_most_sixty_lines_of_code():
    source = inspect.getsource(Yoke)
    (made,) = ast.parse(source).body
    documented = made.body[0].end_lineno - made.body[0].lineno + 1
    assert sum(bool(line.strip()) for line in source.splitlines()) - documented <= 60


def test_group_passes_the_check_and_powers_balance(solution):
    report = ks.check(mechanism().groups[0])
    assert report.ok, report
    assert solution.power_residual < 1e-13


@pytest.mark.slow
def test_group_outputs_stand_in_frame_and_extremes():
    s = scene("_saw").solve(ANGLES)
    columns = set(s.frame().columns)
    assert {"guide_moment_saw [N m]", "guide_force_saw [N]", "slot_moment_saw [N m]"} <= columns
    assert {"slider_saw_position [m]", "reaction_A_saw_x [N]", "B_x [m]"} <= columns
    table = extremes_frame(s)
    assert table.loc["guide moment saw", "unit"] == "N m"
    assert table.loc["slot force saw", "unit"] == "N"


@pytest.mark.slow
@every("engine", ["numpy", "compiled"])
def test_engines_and_programs_agree_with_the_kernels(solution, engine):
    if engine == "compiled":
        pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    program = compiled(scene(), QUANTITIES, engine=engine)
    values = program(ANGLES)
    solved = ks.solve(mechanism(), ANGLES, crank_speed=30.0, crank_acceleration=50.0, loads=LOADS, engine=engine)
    for name in QUANTITIES:
        expected = solution.reaction(name) if name in ("O", "A") else solution.scalar(name)
        found = solved.reaction(name) if name in ("O", "A") else solved.scalar(name)
        scale = np.max(np.abs(expected)) + 1e-300
        assert np.max(np.abs(values[name] - expected)) <= 1e-13 * scale, name
        assert np.max(np.abs(found - expected)) <= 1e-13 * scale, name


def test_group_derivatives_equal_differences():
    program = compiled(scene(), ("balancing_torque", "guide_moment"), engine="numpy")
    paths = ("slot_angle", "guide_offset", "slider.mass", "block.centre.along", "crank_length")
    assert set(paths) <= set(program.parameters)
    slopes = program.derivatives(ANGLES, by=paths)
    for path in paths:
        value = program.parameters[path]
        step = 1e-5 * abs(value)
        above, below = (program(ANGLES, {path: value + sign * step}) for sign in (1, -1))
        for name, found in slopes.items():
            expected = (above[name] - below[name]) / (2 * step)
            assert np.max(np.abs(found[path] - expected)) < 1e-7 * np.max(np.abs(expected)) + 1e-6, (path, name)


def test_condition_is_small_where_nothing_is_lost(solution):
    assert np.all((solution.condition >= 1.0) & (solution.condition < 1e4))


@pytest.mark.slow
def test_needs_and_series_work_with_the_group():
    s = ks.solve(mechanism(), np.linspace(0, 2 * np.pi, 24, endpoint=False), crank_speed=30.0)
    found = ks.needs(s, "balancing_torque", 0.01)
    names = {made.name for made in found.alone}
    assert {"massless slider", "massless block", "massless crank", "guide through O", "one harmonic"} <= names
    series = next(made for made in found.alone if made.name == "one harmonic")
    assert series.error < 1e-13  # a Scotch yoke moves by the first harmonic
    assert str(found).startswith("balancing torque within 0.01")


def test_principal_points_find_the_shaking_force(solution):
    points = principal_points(solution.mechanism)
    assert points.mass == pytest.approx(7.7)
    direct = sum(solution.inertia_force(link) for link in LINKS)
    assert np.max(np.abs(solution.shaking_force - direct)) < 1e-13 * np.max(np.abs(direct))


@pytest.mark.slow
def test_group_is_drawn_and_animated(solution, tmp_path):
    ax = plt.subplots()[1]
    ks.plots.mechanism(solution, angles=(30,), ax=ax)
    pose = solution.at(np.radians([30.0]))
    A, B = pose.position("A")[:, 0], pose.position("B")[:, 0]
    lines = [line.get_xydata() for line in ax.lines]
    a, b = (complex(*place) for place in (A, B))
    ends = [(line @ (1.0, 1j) - a) / (b - a) for line in lines if len(line) == 2]
    assert any(np.abs(end.imag).max() < 1e-12 and np.prod(end.real) < 0 for end in ends)  # a slot through A and B
    assert any(len(line) == 1 and np.allclose(line[0], B) for line in lines)
    ks.plots.over_turn(solution, "guide_moment", ax=ax)
    assert ax.get_ylabel() == "guide moment [N m]"
    film = ks.plots.animation(scene("_saw").solve(ANGLES), joints=("O", "A_saw"), frames=3)
    film.save(tmp_path / "yoke.gif", writer=PillowWriter(fps=10))
    plt.close("all")


def test_sweeps_vary_its_numbers_by_path():
    designs = pd.DataFrame({"slot_angle": [1.0, 1.2, 1.4], "slider.mass [kg]": [5.0, 6.0, 7.0]})
    swept = ks.sweep(scene(), designs, ["largest guide_moment"], progress=False)
    assert (swept["failed"] == "").all()
    for row, (angle, mass) in enumerate(designs.to_numpy()):
        yoke = replace(
            mechanism().groups[0], slot_angle=float(angle), slider=replace(LINKS["slider"], mass=float(mass))
        )
        alone = ks.Mechanism("one", ks.Crank(0.1, LINKS["crank"]), (yoke,))
        s = ks.solve(alone, ANGLES, crank_speed=30.0, crank_acceleration=50.0, loads=LOADS)
        expected = abs(ks.extremes(s, "guide_moment").largest)
        assert swept["largest guide_moment [N m]"][row] == pytest.approx(expected, rel=1e-8)


def test_its_kernels_run_on_intervals_and_are_enclosed(solution):
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    found = enclosure(solution, "guide_moment")
    error = np.abs(solution.scalar("guide_moment") - found.middle)
    assert np.max(error) < 1e-13 * np.max(np.abs(found.middle))


class Paired(Yoke):
    """The same, telling by `pairs` what holds its links."""

    @property
    def pairs(self):
        """Pin, slot and guide."""
        slot = Sliding("block", self.on, "slider", "slot_force", "slot_moment")
        guide = Sliding("slider", self.pin, FRAME, "guide_force", "guide_moment")
        return {self.on: Turning("block", self.on), "slot": slot, "guide": guide}


@pytest.mark.slow
def test_methods_know_the_group_by_its_pairs(solution):
    own = vars(mechanism().groups[0])
    paired = replace(solution, mechanism=replace(mechanism(), groups=(Paired(**own),)))
    for name in QUANTITIES:
        for method in (*equations.METHODS, *newton.NEWTON_METHODS):
            with pytest.raises(ks.errors.NotGivenError, match="Yoke does not declare its pairs"):
                method.prepare(solution, name, method.settings[-1])
            found = method.prepare(paired, name, method.settings[-1])()
            expected = components(solution, name)
            assert np.max(np.abs(np.subtract(found, expected))) < 1e-13 * np.max(np.abs(expected)), (name, method.name)
