"""Bad loads: one clear error of the library's own, whatever is wrong."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.scenes import six_bar

NO_NUMBERS = {
    "text": "3 N",
    "nan": float("nan"),
    "infinite": float("inf"),
    "truth": True,
    "complex": 1j,
    "none": None,
    "huge": 1e200,
    "list in list": [[1.0], [2.0, 3.0]],
    "dict": {"a": 1},
}
MAKERS = {
    "Force.value": lambda bad: ks.Force(bad, at="B"),
    "Force.direction": lambda bad: ks.Force(1.0, at="B", direction=bad),
    "Force.at along": lambda bad: ks.Force(1.0, at=("coupler", bad)),
    "Force.at y": lambda bad: ks.Force(1.0, at=(0.1, bad)),
    "Torque.value": lambda bad: ks.Torque(bad, on="crank"),
    "PointForce.value": lambda bad: ks.PointForce(bad, between=("A", "B")),
    "PointSpring.stiffness": lambda bad: ks.PointSpring(bad, between=("A", "O2")),
    "PointSpring.free_length": lambda bad: ks.PointSpring(1.0, bad, between=("A", "O2")),
    "PointSpring.between": lambda bad: ks.PointSpring(1.0, between=("A", (bad, 0.0))),
    "PointDamper.coefficient": lambda bad: ks.PointDamper(bad, between=("A", "O2")),
    "TorsionSpring.stiffness": lambda bad: ks.TorsionSpring(bad, on="rocker"),
    "TorsionSpring.free_angle": lambda bad: ks.TorsionSpring(1.0, bad, on="rocker"),
    "TorsionSpring.moment": lambda bad: ks.TorsionSpring(1.0, on="rocker", moment=bad),
    "TorsionDamper.coefficient": lambda bad: ks.TorsionDamper(bad, on="rocker"),
    "Spring.cubic": lambda bad: ks.Spring(1.0, 0.0, cubic=bad),
}


NO_NUMBER_CASES = [
    (field, what) for field in MAKERS for what in NO_NUMBERS if (field, what) != ("PointSpring.between", "text")
]
"""("3 N", 0.0) is a place on a link called "3 N", which no mechanism has."""


@every(("field", "what"), NO_NUMBER_CASES)
def test_load_numbers_are_refused_by_field(field, what):
    name = field.partition(".")[2].partition(" ")[0]
    with pytest.raises(ks.ParameterError, match=name):
        MAKERS[field](NO_NUMBERS[what])


@pytest.mark.parametrize(
    "field", [name for name in MAKERS if "stiffness" in name or "coefficient" in name or "length" in name]
)
def test_negative_stiffness_and_damping_are_refused(field):
    with pytest.raises(ks.ParameterError, match="at least 0"):
        MAKERS[field](-1.0)


PLACES = {
    "number": 3.0,
    "nothing": (),
    "one number": (1.0,),
    "three numbers": (1.0, 2.0, 3.0),
    "two names": ("A", "B"),
    "four": ("coupler", 1.0, 2.0, 3.0),
    "name last": (1.0, "coupler"),
    "empty": "",
    "lines": "A\nB",
    "none": None,
    "bytes": b"B",
}


@every("what", PLACES)
def test_wrong_points_name_the_allowed_forms(what):
    for make in (lambda at: ks.Force(1.0, at=at), lambda at: ks.PointForce(1.0, between=("A", at))):
        with pytest.raises(ks.ParameterError, match=r"(at|between 2) must be a"):
            make(PLACES[what])


@every("what", ["AB", ("A",), ("A", "B", "C"), None, 3.0, {"A": "B"}])
def test_what_is_no_pair_of_points_is_refused(what):
    with pytest.raises(ks.ParameterError, match="between must be a pair of points"):
        ks.PointDamper(1.0, between=what)


MISPLACED = {
    "joint": (lambda: ks.Force(1.0, at="b"), r"Force: at is 'b', allowed: 'O', 'A', 'B', 'O2', 'C'"),
    "link as joint": (lambda: ks.Force(1.0, at="coupler"), r'name a place on it, \("coupler", along, across\)'),
    "link of a place": (lambda: ks.Force(1.0, at=("cupler", 0.1)), "did you mean 'coupler'"),
    "axis": (lambda: ks.Force(1.0, at="B", along="slider"), "Force: along is 'slider', allowed: .*'slider2'"),
    "torque": (lambda: ks.Torque(1.0, on="B"), "Torque: on is 'B', allowed: 'crank'"),
    "torque against": (lambda: ks.Torque(1.0, on="crank", against="x"), "against is 'x', allowed: .*'frame'"),
    "torque on itself": (lambda: ks.Torque(1.0, on="crank", against="crank"), "against the same link"),
    "spring": (lambda: ks.TorsionSpring(1.0, on="rocker2"), "did you mean 'rocker'"),
    "damper": (lambda: ks.TorsionDamper(1.0, on="rocker", against="rocker"), "against the same link"),
    "point": (lambda: ks.PointSpring(1.0, between=("B", "D")), "PointSpring: between 2 is 'D'"),
    "one link": (lambda: ks.PointForce(1.0, between=("B", ("rocker", 0.1))), "both points are of the rocker"),
    "frame": (lambda: ks.PointDamper(1.0, between=((0.0, 0.1), (1.0, 1.0))), "both points are fixed to the frame"),
    "slider": (lambda: ks.Spring(1.0, 0.0, cubic=3.0), "Spring: on is 'slider', allowed: 'slider2'"),
    "a class": (lambda: ks.Torque, "loads must be Gravity, Spring"),
}


@every("what", MISPLACED)
def test_a_load_on_what_is_not_there_names_what_is(what):
    make, words = MISPLACED[what]
    with pytest.raises(ks.ParameterError, match=words):
        ks.Scene(six_bar(), 1.0, 0.0, make())


def test_all_loads_that_are_wrong_are_told_at_once():
    with pytest.raises(ks.ParameterError, match=r"at is 'X'.*on is 'Y'"):
        ks.Scene(six_bar(), 1.0, 0.0, [ks.Force(1.0, at="X"), ks.Torque(1.0, on="Y")])


FORCES = {
    "reaction": lambda motion: motion.reaction("O")[0],
    "torque": lambda motion: motion.balancing_torque,
    "power": lambda motion: motion.balancing_torque_by_power,
    "inertia": lambda motion: motion.inertia_force("rocker")[0],
}


@every("what", FORCES)
@every("kind", ["Force", "Torque", "ProcessForce"])
def test_load_reading_a_force_learns_what_it_may_read(kind, what):
    item = {
        "Force": lambda: ks.Force(FORCES[what], at="B"),
        "Torque": lambda: ks.Torque(FORCES[what], on="rocker"),
        "ProcessForce": lambda: ks.ProcessForce(FORCES[what], "slider2"),
    }[kind]()
    with pytest.raises(ks.ParameterError, match=r"which it has not: .* it may ask for crank_angle, .*velocity"):
        _ = ks.solve(six_bar(), [0.1, 0.2], crank_speed=1.0, loads=item).balancing_torque


RETURNED = {
    "text": lambda motion: "3",
    "none": lambda motion: None,
    "nan": lambda motion: np.full(motion.shape, np.nan),
    "other length": lambda motion: np.ones(7),
    "complex": lambda motion: 1j * motion.crank_angle,
}


@pytest.mark.parametrize("what", RETURNED)
def test_what_a_function_returns_is_looked_at(what):
    with pytest.raises(ks.ParameterError, match=r"Torque on 'rocker': its function must return .*torque"):
        _ = ks.solve(
            six_bar(), [0.1, 0.2], crank_speed=1.0, loads=ks.Torque(RETURNED[what], on="rocker")
        ).balancing_torque


TABLES = {
    "over": (lambda: ks.Table([0, 1], [0, 1], over="time"), "over is 'time', allowed: 'angle', 'travel'"),
    "lengths": (lambda: ks.Table([0, 1, 2], [0, 1], over="travel"), "of one length"),
    "back": (lambda: ks.Table([0, 1, 2], [0, 1, 2], back=[0, 1, 2]), "back is for a table over"),
    "back of another length": (lambda: ks.Table([0, 1], [0, 1], over="travel", back=[0]), "of one length"),
    "period": (lambda: ks.Table([0, 1, 2], [0, 1, 2], period=3.0), "2 pi or a whole multiple"),
    "huge period": (lambda: ks.Table([0, 1, 2], [0, 1, 2], period=10**400), "2 pi or a whole multiple"),
    "period of travel": (lambda: ks.Table([0, 1], [0, 1], over="travel", period=4 * np.pi), "one turn"),
    "nan": (lambda: ks.Table([0, np.nan, 2], [0, 1, 2]), "x must be finite"),
    "text": (lambda: ks.Table("abc", [0, 1, 2]), "x must be"),
    "slider": (lambda: ks.Table([0, 2, 4], [0, 1, 2], slider="slider"), "slider is for a table"),
    "to and fro": (lambda: ks.Table([0, 1, 0.5], [0, 1, 2], over="travel"), "travel must rise"),
    "one row": (lambda: ks.Table([0], [0], over="travel"), "at least 2 rows"),
    "no rows": (lambda: ks.Table([], []), "holds nothing"),
}


@every("what", TABLES)
def test_bad_tables_are_refused(what):
    make, words = TABLES[what]
    with pytest.raises(ks.ParameterError, match=words):
        make()


def test_arrays_over_other_angles_are_refused():
    with pytest.raises(ks.ParameterError, match="do not fit"):
        ks.solve(six_bar(), [0.1, 0.2], crank_speed=1.0, loads=ks.Torque(np.ones(7), on="rocker"))
    s = ks.solve(six_bar(), [0.1, 0.2], crank_speed=1.0, loads=ks.Torque(np.ones(2), on="rocker"))
    with pytest.raises(ks.ParameterError, match="Torque is a table over the crank angles given"):
        s.at(0.3)


@pytest.mark.parametrize("angles", [[0.1], [0.1, 0.2], np.linspace(0.0, 6.0, 50)], ids=len)
def test_single_value_array_is_a_constant(angles):
    one, plain = (
        ks.solve(six_bar(), angles, crank_speed=1.0, loads=ks.Torque(value, on="rocker"))
        for value in (np.array([3.0]), 3.0)
    )
    assert np.array_equal(one.balancing_torque, plain.balancing_torque)
    assert np.array_equal(one.reaction("O"), plain.reaction("O"))
