"""Drawings of machines as data for a page."""

import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.movement import ARROW_REACH, FILLED_KINDS, MAX_ARROW, drawing_of, movements
from kinetostatics.views.report.report import subject_of
from kinetostatics.views.strokes import Shape, moving_surfaces
from support.reports import plain, subject


def drawn(case):
    return movements(subject(case).machines)


def points_of(stroke, count):
    """Points of a stroke in all poses, (2, K, N), as the page draws them."""
    if "shapes" in stroke:
        return stroke["shapes"].transpose(2, 1, 0)
    first = stroke["points"].T.astype(float)
    if "poses" not in stroke:
        return np.repeat(first[..., None], count, axis=2)
    x, y, angle = stroke["poses"].T.astype(float)
    turned = (first[0] + 1j * first[1])[:, None] * np.exp(1j * angle) + x + 1j * y
    return np.stack([turned.real, turned.imag])


@pytest.mark.slow
def test_strokes_are_restored_in_each_pose():
    for case in ("sawframe_2r63", "mower_drive", "shaper"):
        for machine, drawing in zip(subject(case).machines.values(), drawn(case), strict=True):
            solution = machine.solution
            shape = Shape(solution)
            wanted = [*shape.counterweights(solution), *shape.strokes(solution), *shape.ties(solution, solution.loads)]
            wanted += [*moving_surfaces(solution, solution), *shape.symbols(solution.loads, solution)]
            sent = drawing["strokes"][-len(wanted) :]
            for stroke, item in zip(wanted, sent, strict=True):
                assert item["kind"] == stroke.kind
                found = points_of(item, solution.crank_angle.size)
                np.testing.assert_allclose(found, stroke.points, atol=3e-5 * shape.size)


def test_moving_parts_are_stored_as_poses():
    strokes = drawn("sawframe_2r63")[1]["strokes"]
    kinds = {
        stroke["kind"]: "shapes" if "shapes" in stroke else "poses" if "poses" in stroke else "" for stroke in strokes
    }
    assert kinds["bar"] == "poses"
    assert kinds["curve"] == kinds["rail"] == kinds["ground"] == ""
    assert "shapes" in [next(iter(set(stroke) & {"shapes"}), "") for stroke in strokes if stroke["kind"] == "spring"]
    assert all(stroke["filled"] == (stroke["kind"] in FILLED_KINDS) for stroke in strokes)


def test_arrows_have_one_scale_for_all_machines():
    found = drawn("sawframe_2r63")
    frame, *others = [{key: drawing[key] for key in ("box", "scale", "longest")} for drawing in found]
    assert others == [frame] * len(others)
    solution = subject("sawframe_2r63").machines["plain"].solution
    largest = max(np.hypot(*solution.reaction(name)).max() for name in solution.reactions)
    size = max(Shape(machine.solution).size for machine in subject("sawframe_2r63").machines.values())
    assert np.isclose(frame["scale"] * largest, ARROW_REACH * size)
    assert np.isclose(frame["longest"], MAX_ARROW * size)


def test_small_machine_beside_large_ones_has_its_own_frame():
    widths = {}
    for drawing in drawn("mower_drives"):
        left, _, right, _ = drawing["box"]
        widths[drawing["name"]] = right - left
        solution = subject("mower_drives").machines[drawing["name"]].solution
        x = [solution.position(joint)[0] for joint in solution.mechanism.joints]
        assert np.ptp(x) > 0.3 * (right - left), drawing["name"]
    assert widths["crank-slider"] == widths["crank-rocker"] > 2.0 * widths["planetary"]


def test_box_holds_joints_and_arrow_tips():
    found = drawn("shaper")
    low, high = np.reshape(found[0]["box"], (2, 2, 1)) + [[[-1e-9]], [[1e-9]]]
    for machine in subject("shaper").machines.values():
        solution = machine.solution
        places = [solution.position(joint) for joint in solution.mechanism.joints]
        tip = solution.position(found[0]["arrows"]["A"]) + found[0]["scale"] * solution.reaction("A")
        assert all(((low <= place) & (place <= high)).all() for place in [*places, tip])


def test_arrows_stand_at_declared_joints():
    assert drawn("sawframe_2r63")[0]["arrows"] == {"A": "A", "B": "B", "guide": "B", "O": "O"}


def test_unbounded_reaction_hides_no_other():
    parallelogram = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(mass=1.0))
    with warnings.catch_warnings(action="ignore", category=ks.ConditionWarning):
        (found,) = movements(subject_of(ks.Scene(parallelogram, 10.0, loads=ks.Gravity())).machines)
    assert found["scale"] > 0.0
    assert np.isfinite(found["box"]).all()


def test_arrows_and_torque_are_the_solutions():
    solution = plain().solve(24)
    found = drawing_of(Shape(solution))
    assert list(found["forces"]) == list(solution.reactions)
    for name, vectors in found["forces"].items():
        np.testing.assert_allclose(vectors.T, solution.reaction(name), rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(found["torque"], solution.balancing_torque, rtol=1e-6)
    assert found["largest_torque"] == pytest.approx(np.abs(solution.balancing_torque).max())
    assert found["force_unit"] == {"factor": 1.0, "unit": "N"}
