"""What users hold goes from process to process, and can be copied, without a change."""

import copy
import pickle
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics import errors
from kinetostatics.engines import numba_backend
from kinetostatics.numbers.lazy import cached_property
from support.every import every

WAYS = {
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "deep copy": copy.deepcopy,
    "copy": copy.copy,
}
ONE_MESSAGE = {
    name: kind("what is wrong")
    for name, kind in vars(errors).items()
    if isinstance(kind, type) and kind.__module__ == errors.__name__ and name not in ("AssemblyError", "CaseError")
}
ERRORS = ONE_MESSAGE | {
    "ParameterError": errors.ParameterError("mass must be positive", designs=np.array([True, False])),
    "AssemblyError": errors.AssemblyError("a gap", [(0.5, 1.0)]),
    "CaseError": errors.CaseError(Path("saw.toml"), ["one", "two"]),
}


@every("way", WAYS)
@every("name", ERRORS)
def test_errors_come_back_with_message_and_attributes(name, way):
    error = ERRORS[name]
    found = WAYS[way](error)
    assert type(found) is type(error)
    assert (str(found), found.args) == (str(error), error.args)
    assert repr(vars(found)) == repr(vars(error))


def test_an_error_keeps_what_was_noted_on_it():
    error = errors.CaseError("saw.toml", ["one"])
    error.add_note("in design 3")
    assert pickle.loads(pickle.dumps(error)).__notes__ == ["in design 3"]


CRANK_SLIDER = ks.crank_slider(0.1, 0.4)
CASES = ("sawframe_2r63", "chain_unit", "mower_drive")


@cache
def held(name):
    """Something that users hold, used once so that it keeps what it has found."""
    saw = ks.load_case("sawframe_2r63")
    plain = saw.solve("plain", 36)
    made = {
        "extremes": lambda: ks.extremes(plain, "O"),
        "comparison": lambda: saw.compare("plain", "cam-circle"),
        "tolerances": lambda: ks.tolerances(
            saw, "rms O", {"slider.mass": "1..2 kg"}, count=2, progress=False, variant="plain", angles=12
        ),
        "needs": lambda: ks.needs(plain, "O", within=0.05),
        "principal points": lambda: ks.principal_points(plain.mechanism),
        "link": lambda: ks.Link(1.0, (0.1, 0.2), 3.0),
        "guide": lambda: ks.Guide.at(0.3, 0.1),
        "loads": lambda: [ks.Gravity(), ks.Spring(1.0, 2.0), ks.ProcessForce(np.ones(36))],
        "sampled cam": lambda: ks.cams.Sampled(plain.crank_angle, 0.3 + 0.01 * np.cos(plain.crank_angle)),
        "swing": lambda: ks.linkage.swing(ks.load_case("chain_unit").solve("rho-0.5")),
        "compiled solution": lambda: ks.solve(
            plain.mechanism, plain.crank_angle, crank_speed=plain.crank_speed, engine="compiled"
        ),
    }
    found = made[name]()
    assert name != "comparison" or found.mean_torque_ratio > 1
    return found


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", CASES)
def test_cases_are_pickled_with_results(name, way):
    case = ks.load_case(name)
    found = WAYS[way](case)
    assert (found.title, found.path, list(found.variants)) == (case.title, case.path, list(case.variants))
    assert found.tolerances == case.tolerances
    for variant in case.variants:
        np.testing.assert_array_equal(
            found.solve(variant, 36).balancing_torque, case.solve(variant, 36).balancing_torque
        )
    with pytest.raises(TypeError):
        found.variants["plain"] = None


@pytest.mark.parametrize("way", WAYS)
def test_solutions_are_pickled_with_results(way):
    solution = ks.load_case("chain_unit").solve("rho-0.5", 36)
    torque = solution.balancing_torque
    found = WAYS[way](solution)
    np.testing.assert_array_equal(found.balancing_torque, torque)
    np.testing.assert_array_equal(found.reaction("O"), solution.reaction("O"))
    np.testing.assert_array_equal(WAYS[way](solution.mechanism).crank.length, solution.mechanism.crank.length)


HELD = [
    "extremes", "comparison", "needs", "tolerances", "principal points", "link", "guide", "loads", "sampled cam",
    "swing", *(["compiled solution"] if numba_backend.numba_available() else []),
]  # fmt: skip


@pytest.mark.slow
@every("way", WAYS)
@every("name", HELD)
def test_what_users_hold_comes_back(name, way):
    thing = held(name)
    found = WAYS[way](thing)
    assert type(found) is type(thing)
    assert set(getattr(found, "__dict__", {})) == set(getattr(thing, "__dict__", {}))
    if name != "loads":
        assert str(found) == str(thing)


def test_a_case_with_a_table_of_forces_comes_back(tmp_path):
    (tmp_path / "force.csv").write_text("crank_angle [deg], force [N]\n0, 1\n180, 3\n360, 1\n", encoding="utf-8")
    (tmp_path / "ram.toml").write_text(
        'title = "ram"\nreference = "a"\n[variants.a]\nmechanism = "crank-slider"\ncrank_speed = "60 rpm"\n'
        'crank_length = "0.1 m"\ncoupler_length = "0.4 m"\nprocess_force = { table = "force.csv" }\n',
        encoding="utf-8",
    )
    case = ks.load_case(tmp_path / "ram.toml")
    found = pickle.loads(pickle.dumps(case))
    np.testing.assert_array_equal(found.solve("a", 36).balancing_torque, case.solve("a", 36).balancing_torque)
    assert case.files == [tmp_path / "ram.toml", tmp_path / "force.csv"]


@pytest.mark.slow
@every("name", list(ks.shipped_cases()))
def test_a_machine_whose_tables_were_read_goes_to_another_process(name):
    """A drawing reads them; a sweep by workers sends the scene."""
    tables = [key for key, value in vars(type(CRANK_SLIDER)).items() if isinstance(value, cached_property)]
    for variant in ks.load_case(name).variants.values():
        for table in tables:
            getattr(variant.mechanism, table)
        assert len(pickle.loads(pickle.dumps(variant.scene)).mechanism.groups) == len(variant.mechanism.groups)
