"""Recorded outputs get the gaps that they lack, and nothing where they lack none."""

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.gaping import Gaps
from kinetostatics.engines.graph import needed
from kinetostatics.engines.program import Program
from kinetostatics.engines.record import Recorder
from kinetostatics.engines.simplify import SimplifiedGraph
from support.every import every

SHORT = ks.SliderGroup(0.04, ks.Guide.at(np.pi / 2), pin="C", label="2")
VEE = ks.Mechanism("vee", ks.Crank(0.05), (ks.SliderGroup(0.2), SHORT))


def recorder():
    return Recorder(ks.Scene(VEE, 7.0).solve([0.1, 1.5], on_gap="nan").apart[0], None, SimplifiedGraph())


def values(recorder, output):
    """At a crank angle where both close, and at one where the second does not."""
    s = ks.Scene(VEE, 7.0).solve([1.0, 0.1], on_gap="nan")
    assert s.closed.tolist() == [True, False]
    numbers = s.apart[1].numbers
    return Program(None, (output,))._by_numbers(s.crank_angle, numbers, (2,))[0]


@every("output", [0.0, 2.5])
@every(
    "name, open_", [("balancing_torque", True), ("guide_force2", True), ("crank_rate", True), ("guide_force", False)]
)
def test_a_constant_is_missing_where_a_group_behind_its_quantity_is_open(output, name, open_):
    found = recorder()
    first, second = values(found, Gaps(found.graph, found.recorded).added(output, name))
    assert first == output
    assert np.isnan(second) == open_


def test_an_output_that_is_computed_from_all_behind_it_stays_as_it_is():
    found = recorder()
    (x, *_), *_ = (joint.position for joint in (found.recorded.placement.joints["C"],))
    gaps, node, count = Gaps(found.graph, found.recorded), np.ravel(x)[0], len(found.graph)
    assert gaps.added(node, "slider2_position") is node
    assert len(found.graph) == count
    whole = gaps.added(node, "balancing_torque")
    assert [part.operation for part in needed([whole])].count("root") == 2
