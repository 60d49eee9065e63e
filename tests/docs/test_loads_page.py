"""The page on forces and loads: its cells run, its table of the motion is that of the real object, search finds it."""

import re

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.load_values import MOTION_MEMBERS
from support.every import every
from support.pages import DOCS, cells, needed, pages, text_of

pytestmark = needed
PAGE = "machines/loads.md"
OF_THE_LIBRARY = {
    *("accelerating", "apart", "as_vector", "closure", "farthest", "kind", "loads_are_given", "placement"),
    *("proportion", "sense", "shape", "spot"),
    *("friction", "gravity", "loads"),  # a motion without forces has none
}
"""Public attributes that a function has no use for."""
UNITS = {"rad": (0, 0), "1": (0, 0), "rad/s": (0, -1), "rad/s²": (0, -2), "m": (1, 0), "m/s": (1, -1), "m/s²": (1, -2)}
"""Powers of length and time."""


def rows():
    """Member, unit and shape of the table."""
    table = text_of(DOCS / PAGE).partition("| of the motion |")[2].partition("\n\n")[0]
    for line in table.splitlines()[2:]:
        names, _, unit, shape = (part.strip() for part in line.strip("|").split("|"))
        for name in re.findall(r"`([^`]*)`", names):
            yield name, unit, shape


def motion(size=1.0, time=1.0):
    """What a function is given, at lengths and times that are multiples of those of a machine."""
    seen = []

    def value(given):
        seen.append(given)
        return 0.0 * given.crank_angle

    press = ks.crank_slider(0.1 * size, 0.45 * size)
    scene = ks.Scene(press, 7.0 / time, crank_acceleration=3.0 / time**2, loads=[ks.ProcessForce(value)])
    scene.solve(8).balancing_torque  # noqa: B018 - it calls the function
    return max(seen, key=lambda given: given.crank_angle.size)


def read(given, member, size=1.0):
    place = ("coupler", 0.1 * size, 0.05 * size)
    arguments = {"point": place, "link": "coupler", "slider": "slider", "free_position": 0.4 * size}
    name, _, asked = member.rstrip(")").partition("(")
    found = getattr(given, name)
    return found(*(arguments[part] for part in asked.split(", "))) if asked else found


def test_the_table_lists_what_a_function_may_read():
    listed = [name for name, _, _ in rows()]
    assert sorted(listed) == sorted(MOTION_MEMBERS)
    public = {name for name in dir(motion()) if not name.startswith("_")}
    assert {name.partition("(")[0] for name in listed} | OF_THE_LIBRARY == public
    assert not {name.partition("(")[0] for name in listed} & OF_THE_LIBRARY


@pytest.mark.slow
@every(("member", "unit", "shape"), [row for row in rows() if row[1] not in ("", "its own")])
def test_members_have_their_units_and_shapes(member, unit, shape):
    first, larger, slower = motion(), motion(size=2.0), motion(time=2.0)
    value = read(first, member)
    wanted = {"(..., N)": (8,), "(2, ..., N)": (2, 8), "number or (..., N)": ()}[shape]
    assert np.shape(value) == wanted
    assert np.any(value != 0)
    length, time = UNITS[unit]
    np.testing.assert_allclose(read(larger, member, 2.0), 2.0**length * value, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(read(slower, member), 2.0**time * value, rtol=1e-12, atol=1e-13)


def test_the_index_has_the_force_on_the_coupler():
    """The search of the site ranks main entries of the index before titles; pages of the same title rank by letters."""
    before, heading, _ = text_of(DOCS / PAGE).partition("\n## Force on the coupler\n")
    assert heading
    assert before.rstrip().endswith("```{index} ! force on the coupler, ! force on coupler, ! coupler force\n```")
    assert [name for name, path in pages().items() if "! force on the coupler" in text_of(path)] == ["machines/loads"]


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
def test_cells_agree_with_what_is_found_by_hand(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    for code in cells(PAGE):
        exec(compile(re.sub(r"^ks\.plots.*$", "", code, flags=re.MULTILINE), "loads", "exec"), names)
    told = capsys.readouterr().out
    assert [float(value) < 1e-12 for value in re.findall(r"largest difference (\S+)", told)] == [True] * 3
    press = ks.Scene(names["press"], names["speed"], loads=[ks.ProcessForce(names["punch"])]).solve(720)
    off = abs(1.0 - np.mean(press.balancing_torque) / press.mean_torque)
    assert f"samples would be {100 * off:.1f} % off" in text_of(DOCS / PAGE)
    works = re.findall(r"work of a \w+ (\S+) J, by hand (\S+) J", told)
    assert len(works) == 4
    assert all(one == other for one, other in works)
