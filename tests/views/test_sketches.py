"""Dimensioned sketches: every length of a machine once, with its name and value, and no text on another."""

import re
from itertools import combinations

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.text import Text
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.casefile.reading import shipped_cases
from kinetostatics.machine.dimensions import Angle, Radius, Span
from kinetostatics.mechanics.motion import Motion
from kinetostatics.numbers.paths import places_by_path
from support.case_files import shipped
from support.every import every
from support.turning_machines import KINDS, random_machine

LENGTHS = {"m": ("mm", 1e3), "rad": ("°", 180.0 / np.pi)}
LINKS = {"crank": ks.Link(4.0, -0.012), "coupler": ks.Link(1.0, (0.06, 0.012)), "slider": ks.Link(1.2)}
PUMP = ks.crank_slider(0.05, 0.2, guide=ks.Guide.at(0.3, 0.03), **LINKS)
CRANK_ANGLE = "crank angle"


def numbers_of(ax):
    """Path, value and unit of every number written on axes."""
    text = "\n".join(text.get_text() for text in ax.texts)
    text = re.sub(r"(\S+)\.centre = \((\S+), (\S+)\) mm", r"\1.centre.along = \2 mm\n\1.centre.across = \3 mm", text)
    text = re.sub(r"\.centre = ", ".centre.along = ", text)
    lines = [line for line in re.split(",   |\n", text) if "=" in line]
    return [re.fullmatch(r"(.+) = (\S+?) ?(mm|°|kg)", line).groups() for line in lines]


def overlapping(ax):
    """Pairs of texts whose boxes overlap."""
    ax.figure.draw_without_rendering()
    renderer = ax.figure.canvas.get_renderer()
    boxes = {text: Text.get_window_extent(text, renderer) for text in ax.texts if text.get_text()}
    return [(a.get_text(), b.get_text()) for a, b in combinations(boxes, 2) if boxes[a].overlaps(boxes[b])]


def check(machine):
    """All numbers of a machine are on its sketch once, and no texts overlap."""
    ax = ks.plots.sketch(machine)
    shown = numbers_of(ax)
    assert overlapping(ax) == []
    plt.close(ax.figure)
    mechanism = getattr(machine, "mechanism", machine)
    for path, place in places_by_path(mechanism).items():
        value = float(place.value(mechanism))
        found = [(text, unit) for name, text, unit in shown if name == path]
        if place.rule.unit in LENGTHS and value != 0.0:
            unit, factor = LENGTHS[place.rule.unit]
            massless = path.split(".")[0] in mechanism.links and not mechanism.links[path.split(".")[0]].mass
            assert len(found) == (0 if massless else 1), path
            for text, shown_unit in found:
                assert shown_unit == unit
                assert_allclose(float(text), factor * value, rtol=1e-5)


@pytest.mark.slow
@every("name", sorted(shipped_cases()))
def test_every_length_of_a_shipped_machine_stands_once_on_its_sketch(name):
    case = shipped(name)
    for variant in {tuple(places_by_path(item.mechanism)): item for item in case.variants.values()}.values():
        check(variant)


@pytest.mark.slow
@every("kind", KINDS)
def test_every_length_of_every_kind_of_machine_stands_once_on_its_sketch(kind):
    check(random_machine(kind, loads=()))


@pytest.mark.slow
def test_a_sketch_shows_all_lengths_and_masses_of_an_offset_crank_slider():
    check(PUMP)


@pytest.mark.slow
@every("kind", KINDS)
def test_declared_dimensions_measure_what_they_say(kind):
    mechanism = random_machine(kind, loads=()).mechanism
    motion = Motion(mechanism, np.array([0.7]), 1.0, 0.0)
    parts = {("crank",): mechanism.crank} | {("groups", row): part for row, part in enumerate(mechanism.groups)}
    values = {place.steps: place.value(mechanism) for place in places_by_path(mechanism).values()}
    spans = 0
    for steps, part in parts.items():
        for inner, dimension in part.dimensions.items():
            value = values.get((*steps, *inner))
            if value is None:
                continue
            assert isinstance(dimension, Span | Angle | Radius)
            if isinstance(dimension, Span):
                start, end = (np.reshape(motion.position(point), (2, -1))[:, 0] for point in dimension[:2])
                length = np.hypot(*(end - start)) if dimension.along is None else np.dot(end - start, dimension.along)
                assert_allclose(abs(length), abs(value), rtol=1e-9, atol=1e-12)
                spans += 1
    assert spans or kind in ("roller follower", "flat follower")


def test_lengths_that_a_group_does_not_declare_stand_below():
    class Rod(ks.SliderGroup):
        dimensions = {}  # noqa: RUF012

    ax = ks.plots.sketch(ks.Mechanism("own", ks.Crank(0.1), (Rod(0.3),)))
    assert ax.texts[-1].get_text() == "coupler_length = 300 mm"
    plt.close(ax.figure)


def test_without_dimensions_only_joints_are_named(axes):
    ks.plots.sketch(PUMP, dimensions=False, ax=axes)
    assert {text.get_text() for text in axes.texts} == {"O", "A", "B"}
    assert not axes.axison


def test_the_default_angle_is_one_that_can_be_assembled(axes):
    rockers = ks.four_bar(0.3, 0.4, 0.3, rocker_pivot=(0.65, 0.0))
    ks.plots.sketch(rockers, ax=axes)
    (angle,) = (float(value) for name, value, _ in numbers_of(axes) if name == CRANK_ANGLE)
    assert np.isfinite(ks.solve(rockers, np.radians([angle]), crank_speed=1.0).position("B")).all()


@every(
    ("machine", "message"),
    [
        (3.0, "machine must be a Mechanism or a Scene"),
        ({}, "there is nothing to draw"),
        (ks.crank_slider(np.array([[0.1], [0.2]]), 0.5), "plots show one design"),
        (ks.crank_slider(0.1, 0.5, guide_offset=1.0), "crank-slider does not close at crank angle 40 deg"),
    ],
)
def test_what_is_no_machine_of_one_design_is_refused(machine, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.plots.sketch(machine)
