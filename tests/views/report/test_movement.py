"""Drawings as data: rigid strokes and others come back as they were, arrows have one scale."""

import numpy as np
import pytest

from kinetostatics.views.report.movement import ARROW_REACH, FILLED_KINDS, MAX_ARROW, from_base64, movements, to_base64
from kinetostatics.views.strokes import Shape
from support.reports import subject


def drawn(case):
    return movements(subject(case).machines)


def points_of(stroke, count):
    """Points of a stroke in all poses, (2, K, N), as the page draws them."""
    first = from_base64(stroke["points"]).reshape(-1, 2).T.astype(float)
    if "shapes" in stroke:
        return from_base64(stroke["shapes"]).reshape(count, -1, 2).transpose(2, 1, 0)
    if "poses" not in stroke:
        return np.repeat(first[..., None], count, axis=2)
    x, y, angle = from_base64(stroke["poses"]).reshape(count, 3).T.astype(float)
    turned = [
        first[0][:, None] * np.cos(angle) - first[1][:, None] * np.sin(angle) + x,
        first[0][:, None] * np.sin(angle) + first[1][:, None] * np.cos(angle) + y,
    ]
    return np.stack(turned)


def test_numbers_come_back_as_they_were_packed():
    values = np.array([0.1, -2.5e300, np.nan, np.inf])
    np.testing.assert_array_equal(from_base64(to_base64(values, "<f8"), "<f8"), values)


@pytest.mark.slow
def test_strokes_are_restored_in_each_pose():
    for case in ("sawframe_2r63", "mower_drive", "shaper"):
        for machine, drawing in zip(subject(case).machines.values(), drawn(case)["drawings"], strict=True):
            solution = machine.solution
            shape = Shape(solution)
            wanted = [*shape.counterweights(solution), *shape.strokes(solution), *shape.signs(solution.loads, solution)]
            sent = drawing["strokes"][-len(wanted) :]
            for stroke, item in zip(wanted, sent, strict=True):
                assert item["kind"] == stroke.kind
                found = points_of(item, solution.crank_angle.size)
                np.testing.assert_allclose(found, stroke.points, atol=3e-5 * shape.size)


def test_moving_parts_are_stored_as_poses():
    strokes = drawn("sawframe_2r63")["drawings"][1]["strokes"]
    kinds = {
        stroke["kind"]: "shapes" if "shapes" in stroke else "poses" if "poses" in stroke else "" for stroke in strokes
    }
    assert kinds["bar"] == "poses"
    assert kinds["curve"] == kinds["rail"] == kinds["ground"] == ""
    assert "shapes" in [next(iter(set(stroke) & {"shapes"}), "") for stroke in strokes if stroke["kind"] == "spring"]
    assert all(stroke["filled"] == (stroke["kind"] in FILLED_KINDS) for stroke in strokes)


def test_arrows_have_one_scale_for_all_machines():
    found = drawn("sawframe_2r63")
    shapes = [Shape(machine.solution) for machine in subject("sawframe_2r63").machines.values()]
    size = max(shape.size for shape in shapes)
    assert np.isclose(found["scale"] * found["force"], ARROW_REACH * size)
    assert np.isclose(found["longest"], MAX_ARROW * size)
    solution = subject("sawframe_2r63").machines["plain"].solution
    assert np.isclose(found["force"], max(np.hypot(*solution.reaction(name)).max() for name in solution.reactions))


def test_box_holds_joints_and_arrow_tips():
    found = drawn("shaper")
    left, low, right, high = found["box"]
    for machine in subject("shaper").machines.values():
        solution = machine.solution
        for joint, drawing in zip(["A"], found["drawings"][:1], strict=True):
            tip = solution.position(drawing["arrows"][joint]) + found["scale"] * solution.reaction(joint)
            assert (tip[0] >= left - 1e-9).all()
            assert (tip[0] <= right + 1e-9).all()
        for joint in solution.mechanism.joints:
            x, y = solution.position(joint)
            assert (x >= left - 1e-9).all()
            assert (x <= right + 1e-9).all()
            assert (y >= low - 1e-9).all()
            assert (y <= high + 1e-9).all()


def test_arrows_stand_at_declared_joints():
    assert drawn("sawframe_2r63")["drawings"][0]["arrows"] == {"A": "A", "B": "B", "guide": "B", "O": "O"}


def test_unbounded_reaction_hides_no_other():
    import warnings

    import kinetostatics as ks
    from kinetostatics.views.report.report import subject_of

    parallelogram = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(mass=1.0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ks.ConditionWarning)
        found = movements(subject_of(ks.Scene(parallelogram, 10.0, loads=ks.Gravity())).machines)
    assert np.isfinite(found["force"])
    assert np.isfinite(found["box"]).all()
