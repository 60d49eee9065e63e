"""Tables of a report hold the library's numbers, and published ones beside them."""

import re
from functools import partial
from html import unescape

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.report import html, tables
from kinetostatics.views.report.report import Subject, subject_of
from support.reports import page, plain, subject, table_of

pytestmark = pytest.mark.slow

RUBBING = partial(subject, "sawframe_2r63_friction", "cam-cosine")


def test_glance_has_a_row_for_each_machine():
    found = tables.glance(subject("sawframe_2r63"))
    saw = ks.load_case("sawframe_2r63").compare("plain", "cam-cosine")
    cells = dict(zip(found.columns, table_of(found, "cam-cosine"), strict=True))
    assert cells["ratio of means"] == f"{saw.mean_torque_ratio:.4g} ×"
    assert float(cells["largest reaction O [N]"]) == pytest.approx(ks.extremes(saw.balanced, "O").largest, rel=1e-4)
    assert float(cells["power balance"]) < 1e-14
    assert {"power lost [W]", "mean torque [N·m]", "mean power [W]"}.isdisjoint(found.columns)  # all of them 0


def test_glance_shows_lost_power_and_means_of_the_drive():
    found, solution = tables.glance(RUBBING()), RUBBING().machines["plain"].solution
    cells = dict(zip(found.columns, table_of(found, "plain"), strict=True))
    assert cells["power lost [W]"] == cells["mean power [W]"] == f"{solution.losses.total:.5g}"
    assert cells["mean torque [N·m]"] == f"{solution.mean_torque:.5g}"


def test_extremes_state_the_resolution_of_load_functions():
    forces = {"known": -50.0, "function": lambda q: -50.0 * np.sign(q.slider_velocity)}
    scenes = {name: plain(loads=ks.ProcessForce(value)) for name, value in forces.items()}
    known, function = tables.extremes(subject_of(scenes))
    assert known.note == ""
    assert "ProcessForce on 'slider'" in function.note
    assert "every 0.05 deg" in function.note


def test_shares_of_torque_and_support_reaction_stand_for_machines_without_friction():
    found = {table.caption: table for table in tables.shares(subject("sawframe_2r63"))}
    assert list(found)[4:6] == ["cam-cosine: balancing torque", "cam-cosine: reaction O"]
    saw = ks.load_case("sawframe_2r63").solve("cam-cosine").shares("O")
    row = table_of(found["cam-cosine: reaction O"], "inertia of coupler")
    assert float(row[1]) == pytest.approx(saw["inertia of coupler"].value, rel=1e-5)
    assert tables.shares(RUBBING()) == []


def test_the_page_has_the_shares():
    pytest.importorskip("jinja2")
    assert "Who causes the peaks" in page("sawframe_2r63")[0]


def test_comparison_with_each_reference_is_one_table():
    found, upright = tables.comparisons(subject("sawframe_2r63"))
    assert upright.columns == ["", "unit", "upright-plain", "upright-circle", "upright-cosine", "upright-optimal"]
    assert found.columns == ["", "unit", "plain", "cam-circle", "cam-cosine", "published"]
    row = table_of(found, "mean |balancing torque|")
    assert row[2:] == ["23223.7", ("3819.22", "6.081 ×"), ("3426.19", "6.778 ×"), "6.77 (ratio)"]
    assert table_of(found, "largest cam force")[-1] == "almost 5 tf = 49 kN (value)"


def test_what_is_nothing_beside_the_reference_is_0():
    (found,) = tables.comparisons(subject("mower_drive", "full"))
    assert table_of(found, "largest shaking force")[3] == "0"


def test_swing_stands_with_its_published_figures():
    swing = {table.caption: table for table in tables.comparisons(subject("chain_unit"))}["Swing and transmission"]
    assert "1.14556 (1.145)" in table_of(swing, "largest relative rocker speed")


def test_one_machine_is_compared_with_nothing():
    alone = subject_of(plain())
    assert tables.comparisons(alone) == []
    assert "atio" not in tables.glance(alone).note
    pytest.importorskip("jinja2")
    text = html.page(alone).split("application/json")[0]
    assert not re.search(r"machine's name|[Rr]atio of means|data-machine=", text)


def test_report_extremes_are_the_librarys():
    made = subject("pumpjack")
    for machine, found in zip(made.machines.values(), tables.extremes(made), strict=True):
        assert found.caption == machine.name
        low, high = ks.extremes(machine.solution, "balancing_torque").range
        row = table_of(found, "balancing torque")
        assert [float(row[2]), float(row[4])] == pytest.approx([low, high], rel=1e-5)
        assert 10 <= int(row[6]) <= 15


def test_where_digits_are_lost_fewer_are_shown():
    near = ks.crank_slider(0.1, 0.4, slider=ks.Link(mass=50.0))
    spring = ks.Spring.balancing(50.0, 10.0, 0.4)
    cancelled = ks.Scene(near, 10.0, loads=spring)
    found = tables._digits(cancelled.solve(360), "B", np.array([0.0, 180.0]))
    assert found < tables._digits(plain().solve(360), "B", np.array([0.0, 180.0]))


def test_certainty_names_power_balance_and_condition():
    found = tables.certainty(RUBBING())
    assert table_of(found, "friction and reactions converged")[1:] == ["yes"] * 2
    balance = table_of(found, "power balance, relative to the largest power that flows")[1:]
    assert all(float(cell) < 1e-12 for cell in balance)
    assert " at " in table_of(found, "condition: lengths' relative errors are magnified up to")[1]


def test_rounding_bounds_are_shown():
    row = "rounding error of the torque, proven bound [N·m]"
    idle = np.max(subject("shaper").machines["idle"].solution.error_bound("balancing_torque"))
    assert idle <= float(table_of(tables.certainty(subject("shaper")), row)[2]) < 1.1 * idle
    barely = ks.Scene(ks.crank_slider(1.0, 1.0 + 1e-13, slider=ks.Link(1.0)), 1.0)  # a limit position at 90 and 270 deg
    made = subject_of({"barely": barely, "plain": plain()})
    with pytest.warns(ks.ConditionWarning):
        assert made.machines["barely"].extremes
    found = table_of(tables.certainty(made), row)[1]
    bounds = np.sort(made.machines["barely"].solution.error_bound("balancing_torque"))
    assert bounds[-3] <= float(found[0]) < 1.1 * bounds[-3]
    assert re.fullmatch(r"but .* at (90|270)°, a jump or near a limit, the largest of 2 outliers", found[1])
    rubbing = table_of(tables.certainty(RUBBING()), "rounding error of the torque, proven bound [N·m]")
    assert rubbing[1][1] == "not proven at 1 of 360 angles"


def test_torque_is_explained_for_each_machine():
    made = subject("pumpjack")
    found = tables.calculations(made, 13)
    assert list(found) == list(made.machines)
    for name, machine in made.machines.items():
        explained = machine.solution.explain("balancing_torque", machine.solution.crank_angle[13])
        assert explained.conclusion in unescape(found[name])


def test_unknown_formula_has_no_calculation(monkeypatch):
    made = subject_of({"own": plain(), "plain": plain()})

    def unknown(*_):
        raise ks.ParameterError("a group of one's own")

    monkeypatch.setattr(type(made.reference.solution), "explain", unknown)
    assert tables.calculations(made, 3) == {}


def test_losses_are_listed_with_their_sum():
    listed = tables.losses(RUBBING())
    assert [table.caption for table in listed] == list(RUBBING().machines)
    assert table_of(listed[0], "all")[2] == "100"
    assert listed[0].note.startswith("Of 42948.7 W put in")
    assert tables.losses(subject("pumpjack")) == []


def test_drive_is_told_for_machines_with_a_motor_alone():
    one = subject("sawframe_2r63")
    made = Subject("", "", {"cam-cosine": one.machines["cam-cosine"]}, "", one.case)
    runs, (first, second), reasons = tables.drive_tables(made)
    speed = float(table_of(first, "mean speed of the crank")[2])
    assert speed == pytest.approx(runs["cam-cosine"].mean_speed, rel=1e-5)
    assert table_of(second, "flywheel and rotor, largest less smallest")[1] == "J"
    assert reasons == []
    assert tables.drive_tables(subject("pumpjack")) == ({}, [], [])


def test_weak_motor_replaces_its_table(tmp_path):
    text = ks.load_case("sawframe_2r63").path.read_text(encoding="utf-8")
    weak = text.replace("[variants.plain]\n", "[variants.plain]\nfriction = { guide = { mu = 0.9 } }\n")
    weak = weak.replace('"55 kW"', '"5 W"')
    path = tmp_path / "weak.toml"
    path.write_text(weak, encoding="utf-8")
    runs, _, reasons = tables.drive_tables(subject_of(path, "plain"))
    assert runs == {}
    assert reasons[0].startswith("plain: ")


def test_inputs_are_split_into_common_and_own():
    common, apart = tables.inputs(subject("sawframe_2r63"))
    assert table_of(common, "slider.mass") == ["slider.mass", "kg", "600"]
    assert table_of(common, "gravity.acceleration") == ["gravity.acceleration", "m/s²", "9.81"]
    assert table_of(apart, "gravity.direction")[2:] == [*["-90"] * 3, *["180"] * 4]
    assert table_of(apart, "coupler_length")[:5] == ["coupler_length", "m", "2", "2.0219", "2.02191"]
    assert "crank.mass" not in [row[0] for row in common.rows]


def test_remarks_are_each_told_once():
    import warnings

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for _ in range(2):
            warnings.warn("doubtful", ks.HintWarning, stacklevel=1)
        warnings.warn("later", DeprecationWarning, stacklevel=1)
    assert html.remarks(caught) == ["doubtful"]
