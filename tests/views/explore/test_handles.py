"""Points that can be dragged: dragging a point puts it where the pointer is, or as near as its line allows."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.casefile.reading import shipped_cases
from kinetostatics.views.explore.handles import Points, snap_step
from kinetostatics.views.explore.session import Session
from kinetostatics.views.strokes import Shape
from support.case_files import shipped
from support.every import every, quick
from support.mirror import mirrored
from support.turning_machines import KINDS, random_machine

ANGLES, INDEX = 24, 5
STEPS = np.array([[3e-3, 2e-3], [-2e-3, 3e-3]])
"""Small moves of the pointer, over the machine's size."""
CLOSE = 1e-9
QUICK_CASES = "pumpjack", "yoke_pump", "v_twin"
LINK = ks.Link(1.0, (0.03, 0.01), 0.001)
HANGING = ks.Scene(
    ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), crank=LINK, coupler=LINK, rocker=LINK),
    10.0,
    loads=(
        ks.PointSpring(1e3, 0.1, between=(("coupler", 0.2, 0.05), (0.1, -0.2))),
        ks.PointDamper(10.0, between=("B", (0.3, 0.5))),
        ks.Force(20.0, at=("rocker", 0.1, 0.0)),
        ks.BalanceShaft(0.1, at=(-0.1, 0.05)),
    ),
)
GASSY = ks.Scene(
    ks.crank_slider(0.05, 0.2, guide=ks.Guide.through((0.0, 0.01), (1.0, 0.05)), slider=LINK),
    10.0,
    loads=(ks.Spring(1e3, 0.2), ks.GasSpring(1e-3, 2e-4, 2e5, at=0.15)),
)


def handles(solution):
    return Points(solution).side_by_side()


def numbers(scene, handle):
    return np.array([scene.parameters[path] for path in handle.paths])


def follow(scene, mistakes, title):
    """Add to a list each handle of a scene that does not follow the pointer."""
    before = scene.solve(ANGLES)
    size, found = Shape(before).size, handles(before)
    for handle in found:
        place, old = handle.position[:, INDEX], numbers(scene, handle)
        if not np.allclose(handle.measure(place, INDEX), old, rtol=0, atol=CLOSE * size):
            mistakes.append((title, handle.label, "moves where nothing is dragged"))
        for step in STEPS * size:
            pointer = place + step
            moved = scene.varied(dict(zip(handle.paths, handle.measure(pointer, INDEX), strict=True)))
            after = moved.solve(ANGLES, on_gap="nan")
            now = next(item for item in handles(after) if item.name == handle.name)
            there, new = now.position[:, INDEX], numbers(moved, handle)
            if not np.allclose(now.measure(pointer, INDEX), new, rtol=0, atol=CLOSE * size):
                mistakes.append((title, handle.label, "would go on moving at the same pointer"))
            if len(handle.paths) == 2 and handle.kind != "turn":
                if np.hypot(*(there - pointer)) > CLOSE * size:
                    mistakes.append((title, handle.label, "is not at the pointer"))
            elif handle.kind in ("joint", "point"):  # the foot of the pointer on its straight line
                if abs((there - pointer) @ (there - place)) > CLOSE * size * np.hypot(*step):
                    mistakes.append((title, handle.label, "is not nearest to the pointer"))
            elif handle.kind == "turn" or "guide" in handle.name:
                line = next(iter(moved.mechanism.guides.values()), None)
                if "guide" in handle.name and len(moved.mechanism.guides) == 1:
                    x, y = line.direction
                    if abs(x * pointer[1] - y * pointer[0] - line.guide_offset) > CLOSE * size:
                        mistakes.append((title, handle.label, "leaves the pointer beside the guide"))


@pytest.mark.slow
@pytest.mark.parametrize("case", quick(sorted(shipped_cases(), key=QUICK_CASES.__contains__, reverse=True), 3))
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_points_of_the_shipped_cases_follow_the_pointer(case):
    mistakes, seen = [], set()
    for name, variant in shipped(case).variants.items():
        scene = variant.scene
        key = tuple((handle.name, *numbers(scene, handle)) for handle in handles(scene.solve(2, on_gap="nan")))
        if key not in seen:  # variants of one geometry once
            seen.add(key)
            follow(scene, mistakes, name)
    assert mistakes == []


@pytest.mark.slow
@pytest.mark.parametrize("kind", quick(sorted(KINDS, key=lambda kind: "cam" in kind), 3))
def test_points_of_every_kind_of_machine_and_of_its_mirror_image_follow_the_pointer(kind):
    scene, mistakes = random_machine(kind), []
    follow(scene, mistakes, kind)
    follow(mirrored(scene), mistakes, f"mirrored {kind}")
    assert mistakes == []


@pytest.mark.slow
@every("scene", [HANGING, GASSY])
def test_places_of_loads_follow_the_pointer(scene):
    mistakes = []
    follow(scene, mistakes, "scene")
    assert mistakes == []
    places = {path for path in scene.parameters if path.endswith((".x", ".y", ".along", ".across", ".at", "_position"))}
    shown = {path for handle in handles(scene.solve(4)) for path in handle.paths}
    massless = {path for path in places if scene.parameters.get(path.partition(".")[0] + ".mass") == 0}
    assert places - shown == massless - {path for path in places if path.startswith(("spring", "balance_shaft"))}


def test_the_mirror_image_has_its_points_in_the_mirror():
    ahead, back = handles(HANGING.solve(ANGLES)), handles(mirrored(HANGING).solve(ANGLES))
    for one, other in zip(ahead, back, strict=True):
        turned = np.roll(other.position[:, ::-1], 1, axis=1)
        assert one.name == other.name
        assert_allclose(one.position, turned * [[1.0], [-1.0]], rtol=0, atol=1e-12)


def test_rounding_keeps_numbers_readable_and_those_that_hardly_change():
    saw = ks.Scene(ks.crank_slider(0.3, 2.0, guide=ks.Guide.at(0.2, 0.0123456), slider=LINK), 33.5).solve(ANGLES)
    shift = next(handle for handle in handles(saw) if handle.name == "guide_offset").position[:, INDEX]
    rows = [
        ("crank_length", (0.3 + 0.004, 0.0), 0, True, 0.3),
        ("crank_length", (0.3 + 0.006, 0.0), 0, True, 0.31),
        ("crank_length", (0.3 + 0.00004, 0.0), 0, False, 0.3),
        ("crank_length", (0.312345, 0.0), 0, False, 0.3123),
        ("guide_angle", (2.0 * math.cos(0.4), 2.0 * math.sin(0.4)), 0, True, math.radians(23.0)),
        ("guide_offset", tuple(shift), INDEX, False, 0.0123456),
    ]
    assert snap_step(Shape(saw).size) == 0.01
    for name, (x, y), index, snap, expected in rows:
        assert Points(saw).dragged(name, x, y, index, snap) == {name: expected}, name


@pytest.mark.parametrize(("size", "step"), [(2.6, 0.01), (0.3, 0.002), (1.0, 0.005), (200.0, 1.0), (2e-4, 1e-6)])
def test_steps_of_lengths_suit_the_machine(size, step):
    assert snap_step(size) == step


def test_a_guide_through_two_points_stays_a_unit_vector():
    turned = Points(GASSY.solve(ANGLES)).dragged("exact.x", 0.3, 0.1, 0)
    angle = math.degrees(math.atan2(turned["exact.y"], turned["exact.x"]))
    assert angle == pytest.approx(round(angle), abs=1e-9)
    assert GASSY.varied(turned).solve(ANGLES).position("B").shape == (2, ANGLES)


def test_coincident_points_are_counted_in_order_of_importance():
    found = {handle.name: handle for handle in handles(shipped("toggle_press").variants["coining"].scene.solve(ANGLES))}
    assert found["coupler_length2"].row == 0
    assert found["slider2.centre.along"].row == 1


def test_a_point_in_a_gap_stays_and_points_with_known_starts_can_be_dragged_out_of_it():
    open_scene = ks.Scene(ks.four_bar(0.1, 0.2, 0.15, rocker_pivot=(0.5, 0.0), coupler=LINK), 10.0)
    solution = open_scene.solve(ANGLES, on_gap="nan")
    assert np.isnan(solution.position("B")).all()
    assert Points(solution).dragged("coupler.centre.along", 0.3, 0.1, 0) == {
        "coupler.centre.along": 0.03,
        "coupler.centre.across": 0.01,
    }
    assert Points(solution).dragged("rocker_pivot.x", 0.25, 0.0, 0) == {"rocker_pivot.x": 0.25, "rocker_pivot.y": 0.0}


# Requests of a page


def asked(**fields):
    """A request that drags the pivot of the pumpjack's beam, with other fields."""
    state = {"variant": "weights", "values": {}}
    return {"id": 7, "kind": "drag", "state": state, "handle": "rocker_pivot.x", "index": 0, "step": 0.02, **fields}


@pytest.fixture(scope="module")
def session():
    return Session(shipped("pumpjack"), "weights")


def test_a_drag_answers_with_the_machine_of_its_new_state(session):
    answer = session.answer(asked(x=-2.4, y=3.0, show=["O"]))
    assert answer["state"] == {"variant": "weights", "values": {"rocker_pivot.x": -2.4, "rocker_pivot.y": 3.0}}
    again = session.answer({"id": 8, "kind": "look", "state": answer["state"], "show": ["O"]})
    assert_allclose(answer["quantities"]["O"]["values"], again["quantities"]["O"]["values"], rtol=0, atol=0)
    pivot = next(item for item in answer["handles"] if item["name"] == "rocker_pivot.x")
    assert_allclose(pivot["position"], np.tile(np.float32([-2.4, 3.0]), (360, 1)))
    back = session.answer(asked(state=answer["state"], x=-2.45, y=3.1, step=0.05))
    assert back["state"]["values"] == {}  # those of the variant are not kept


def test_a_drag_into_a_gap_is_a_state_with_a_problem_and_leads_out_of_it(session):
    gap = session.answer(asked(x=-5.0, y=5.0))
    assert "cannot be assembled" in gap["problem"]
    assert gap["state"]["values"] == {"rocker_pivot.x": -5.0, "rocker_pivot.y": 5.0}
    assert "problem" not in session.answer(asked(state=gap["state"], x=-2.4, y=3.0))


@every("fields", [{"x": 1e308, "y": 0.0}, {"x": -2.4, "y": 3.0, "step": 5e-324}])
def test_numbers_too_large_to_round_leave_the_state(session, fields):
    assert session.answer(asked(**fields))["state"]["values"].get("rocker_pivot.x") is None


def test_impossible_numbers_leave_the_state(session):
    answer = session.answer(asked(handle="crank_length", x=-1.0, y=0.0))
    assert "greater than 0" in answer["problem"]
    assert answer["state"]["values"] == {}


@every(
    "fields, words",
    [
        ({"handle": "nothing", "x": 0.0, "y": 0.0}, "no point 'nothing'"),
        ({"handle": ["crank_length"], "x": 0.0, "y": 0.0}, "no point"),
        ({"x": "0", "y": 0.0}, "must be numbers"),
        ({"x": 0.0, "y": 0.0, "step": 0.0}, "must be numbers"),
        ({"x": 0.0, "y": float("nan")}, "must be numbers"),
        ({"x": 0.0, "y": 0.0, "index": True}, "must be numbers"),
        ({"x": 0.0, "y": 0.0, "count": 0}, "count must be"),
    ],
)
def test_bad_requests_get_one_sentence(session, fields, words):
    answer = session.answer(asked(**fields))
    assert words in answer["problem"]
    assert "fault of the library" not in answer["problem"]
