"""Stability: every failure that the table names is counted here; none of ours, at any place."""

from collections import Counter
from dataclasses import replace
from functools import partial

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics import cli
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies import stability
from kinetostatics.studies.methods.method import Method
from kinetostatics.studies.precision import METHODS
from kinetostatics.views import charts
from support.every import every

pytestmark = pytest.mark.slow

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

NEWTON, KANE, PAPERS = "Newton iteration, global system", "SymPy Kane, lambdified", "papers' formulas"
SINGLE, SERIES, MASSES = "float32 crank angles", "harmonic series", "two-mass coupler"
SECOND, FOURTH = "differences, 2nd order", "differences, 4th order"
COARSE = {SINGLE: ["lost"], SECOND: ["lost"], FOURTH: ["lost"], SERIES: ["lost"], MASSES: ["lost"]}
"""What never has all digits of a force."""
LIMIT = COARSE | {SECOND: ["lost", "nan"], FOURTH: ["lost", "nan"], SERIES: []}
"""Differences reach over the limit; a series needs a mechanism that closes all around."""
FAILURES = {
    "dead centres, inclined guide": {PAPERS: ["flipped"], SINGLE: ["lost"], SERIES: ["lost"]},
    "limit position": LIMIT,
    "coupler barely long enough": COARSE | {NEWTON: ["given up"]},
    "singular angle of the cosine cam": COARSE | {PAPERS: ["lost", "nan"], KANE: ["lost", "nan"]},
    "pressure angle toward 90 deg": COARSE | {NEWTON: ["lost"]},
    "four-bar toggle": LIMIT,
    "four-bar change point": COARSE | {PAPERS: ["nan"], KANE: ["nan"], NEWTON: ["given up"]},
    "four-bar that only just turns": COARSE,
    "slotted lever that only just turns": {SINGLE: ["lost"]},
    "rhombus": COARSE | {PAPERS: ["nan"], NEWTON: ["flipped"], MASSES: []},
    "kite": COARSE | {NEWTON: ["given up"]},
    "kite, A passing O2": COARSE | {PAPERS: ["nan"], NEWTON: ["raised"]},
    "parallelogram, folded": COARSE | {NEWTON: ["given up"]},
    "coupler as long as the crank": COARSE | {KANE: ["nan"], NEWTON: ["given up"], MASSES: []},
    "size": COARSE,
    "unequal masses": COARSE,
    "many turns": COARSE | {NEWTON: ["lost"]},
    "nearly balanced": COARSE,
}
"""What other methods do at each place."""
CHANCY = {
    ("dead centres, inclined guide", PAPERS, "lost"),
    ("coupler barely long enough", SINGLE, "nan"),
    ("coupler barely long enough", KANE, "nan"),
    ("coupler barely long enough", SECOND, "nan"),
    ("coupler barely long enough", FOURTH, "nan"),
    ("four-bar toggle", SINGLE, "nan"),
    ("four-bar toggle", KANE, "nan"),
    ("four-bar change point", SINGLE, "nan"),
    ("four-bar change point", NEWTON, "raised"),
    ("four-bar change point", NEWTON, "flipped"),
    ("rhombus", SINGLE, "nan"),
    ("rhombus", SERIES, "nan"),
    ("rhombus", KANE, "nan"),
    ("rhombus", NEWTON, "given up"),
    ("rhombus", NEWTON, "raised"),
    ("kite", SINGLE, "nan"),
    ("kite, A passing O2", KANE, "nan"),
    ("kite, A passing O2", SINGLE, "nan"),
    ("parallelogram, folded", SINGLE, "nan"),
    ("parallelogram, folded", KANE, "nan"),
    ("parallelogram, folded", NEWTON, "flipped"),
    ("many turns", NEWTON, "given up"),
    ("nearly balanced", PAPERS, "lost"),
    ("nearly balanced", KANE, "lost"),
}
"""What a few angles or one number decide, by their rounding: neither demanded nor wondered at."""
WORDS = {"lost": "loses digits", "flipped": "flips assembly", "nan": "NaN", "given up": "gives up", "raised": "raises"}
EXPECTED = [(place, method, how) for place, row in FAILURES.items() for method, ways in row.items() for how in ways]
HARMLESS = ("dead centres, inclined guide", "singular angle of the cosine cam", "size", "unequal masses", "many turns")
"""Places that hurt methods, not the problem."""
ELSEWHERE = ("nearly balanced",)
"""Places where other numbers than the crank angle decide."""
DRAWN = ("condition x rounding", "one rounding of the crank angle", "proven bound of ours")
"""Lines of a chart besides those of methods."""
DIGITS = 0.05
"""Largest share of a result that one rounding of the crank angle may make, so that it has digits."""


@pytest.fixture(scope="module")
def table():
    """The study at every other number of each place."""
    return stability.study([replace(place, numbers=place.numbers[::2]) for place in stability.PLACES])


@pytest.fixture(scope="module")
def summary(table):
    return stability.summary(table).set_index(["place", "method"])


def scene(distance):
    """An ordinary plain crank-slider, whatever the distance."""
    return stability.PLACES[0].scene(0.1 + distance)


# Ours


def test_our_methods_keep_digits_at_every_place(table):
    ours = table[table["ours"]]
    assert set(ours["method"]) == {"ours, NumPy", "ours, compiled", "ours, torque by powers"}
    assert set(ours["place"]) == {place.name for place in stability.PLACES}
    given = ours[ours["not given"] == ""]
    assert len(given) > 100
    assert not given[["lost", "flipped", "nan"]].any(axis=None)
    assert set(ours["raised"]) == {""}
    assert np.all(given["error"] <= given["condition"] * 2.0**-53)


@every("place", [place for place in FAILURES if place not in ELSEWHERE])
def test_floats_are_exact_and_the_angle_rounded_once(table, place):
    rows = table[table["ours"] & (table["place"] == place) & (table["not given"] == "")]
    rows = rows[rows["angle rounding"] < DIGITS]
    assert len(rows) >= 4
    assert np.all(rows["error"] <= 30 * (UNIT_ROUNDOFF + rows["angle rounding"]))


@every(
    "place",
    [
        "four-bar change point",
        "four-bar that only just turns",
        "slotted lever that only just turns",
        "coupler barely long enough",
        "coupler as long as the crank",
        "rhombus",
        "kite",
        "kite, A passing O2",
        "parallelogram, folded",
    ],
)
def test_no_digit_is_lost_at_change_points(table, place):
    rows = table[table["ours"] & (table["place"] == place) & (table["not given"] == "")]
    assert np.all(rows["error"] < 5e-15)
    assert np.all(rows.loc[rows["number"] > 1e-16, "bound"] < 3e-13)
    assert rows["condition"].max() > 1e20


def test_angle_rounding_moves_the_result_by_a_step():
    place = next(place for place in stability.PLACES if place.name == "four-bar toggle")
    (row,) = stability.study([replace(place, numbers=(1e-3,))], METHODS[:1]).to_dict("records")
    solution = place.scene(1e-3)
    step = 1e-9
    after, before = (solution.at(solution.crank_angle + sign * step).reaction("O") for sign in (1, -1))
    slope = (after - before) / (2 * step)
    moved = np.hypot(*slope) * np.spacing(solution.crank_angle) / 2
    assert row["angle rounding"] == pytest.approx(moved.max() / np.hypot(*solution.reaction("O")).max(), rel=1e-2)
    beyond = stability.study([replace(place, numbers=(1e-17,))], METHODS[:1])
    assert beyond["angle rounding"].between(0.01, np.inf).all()


def test_our_methods_answer_everywhere(table):
    refused = table[table["ours"] & (table["not given"] != "")]
    assert set(refused["method"]) <= {"ours, torque by powers"}
    assert not set(refused["quantity"]) & {"balancing_torque"}


@pytest.mark.parametrize("place", HARMLESS)
def test_our_methods_are_exact_where_harmless(table, place):
    ours = table[table["ours"] & (table["place"] == place) & (table["not given"] == "")]
    assert np.all(ours["condition"] < 2e3)
    assert np.all(ours["error"] < 2e-15)


@pytest.mark.parametrize("place", [place for place in FAILURES if place not in HARMLESS])
def test_condition_grows_toward_hard_places(table, place):
    rows = table[(table["place"] == place) & (table["method"] == "ours, NumPy")].sort_values("number")
    conditions = rows["condition"].to_numpy()
    assert np.all(conditions[:-1] >= conditions[1:])
    assert conditions[0] > 1e13
    assert conditions[-1] < 1e10


# The others


@every(("place", "method", "how"), EXPECTED)
def test_failures_of_other_methods_are_reproduced(summary, place, method, how):
    row = summary.loc[(place, method)]
    assert 0 < row[how] <= row["of angles"]
    assert WORDS[how] in row["does"]


def test_no_other_failure_is_in_the_table(summary):
    found = {(*index, how) for index, row in summary.iterrows() for how in WORDS if row[how]}
    assert found - CHANCY == set(EXPECTED)


def test_verdict_is_exact_or_as_near_as_condition(summary):
    fine = summary[(summary[list(WORDS)] == 0).all(axis=1)]
    assert set(fine["does"]) == {"exact", "as near as the condition allows", "does not give it"}
    exact = fine[fine["does"] == "exact"]
    assert np.all(exact["worst error"] < 1e-12)
    assert {"ours, NumPy", "ours, compiled"} <= set(exact.reset_index()["method"])
    assert np.all(fine.loc[fine["does"] == "as near as the condition allows", "condition there"] > 1e3)
    assert fine.loc[fine["does"] == "does not give it", "worst error"].isna().all()


def test_papers_formulas_land_on_the_wrong_side(table):
    """Rounding decides on which angles within 1e-13 rad of the dead centres, never beyond."""
    rows = table[(table["place"] == "dead centres, inclined guide") & (table["method"] == PAPERS)]
    wrong = rows[rows["flipped"] > 0]
    assert np.all(wrong["number"] < 1e-12)
    assert wrong["error"].max() == pytest.approx(2 * 2.2 / (2.2 + 0.3), abs=1e-9)
    assert np.all(rows.loc[rows["number"] > 1e-12, "error"] < 1e-15)


def test_single_precision_fails_at_a_million_radians(table):
    rows = table[(table["place"] == "many turns") & (table["method"] == SINGLE)].set_index("number")
    assert rows.loc[1.0, "error"] < 1e-6
    assert rows.loc[1e6, "error"] > 1e-2


# How failures are counted


def planted(way):
    """A method that the study knows by name but that goes another way."""
    return Method(MASSES, lambda solution, quantity, setting: partial(way, solution, quantity))


def flipped(solution, quantity):
    (group,) = solution.mechanism.groups
    mechanism = replace(solution.mechanism, groups=(replace(group, assembly=-group.assembly),))
    return components(replace(solution, mechanism=mechanism), quantity)


def at_first_three(change):
    def way(solution, quantity):
        (values,) = components(solution, quantity)
        return (np.where(np.arange(values.size) < 3, change(values), values),)

    return way


def refuses(solution, quantity):
    raise ks.errors.NotGivenError("not in the mood")


def fails(solution, quantity):
    raise ZeroDivisionError("no pivot")


PLANTED = {
    "exact": (components, {}, "exact"),
    "one in 1e12 wrong": (at_first_three(lambda values: values * (1 + 1e-12)), {"lost": 3}, "loses digits"),
    "other assembly": (flipped, {"flipped": 400}, "flips assembly"),
    "NaN": (at_first_three(lambda values: values * np.nan), {"nan": 3}, "NaN"),
    "infinite": (at_first_three(lambda values: values * np.inf), {"nan": 3}, "NaN"),
    "raises": (fails, {"raised": 1}, "raises"),
    "refuses": (refuses, {}, "does not give it"),
}


@pytest.mark.parametrize("name", PLANTED)
def test_planted_failure_is_counted_as_what_it_is(name):
    way, counts, verdict = PLANTED[name]
    place = stability.Place("anywhere", "number [1]", (0.0,), scene, "slider_position")
    table = stability.study([place], [planted(way)])
    (row,) = stability.summary(table).to_dict("records")
    assert {how: row[how] for how in WORDS if row[how]} == counts
    assert verdict in row["does"]
    assert ("ZeroDivisionError: no pivot" in set(table["raised"])) == (name == "raises")
    assert ("not in the mood" in set(table["not given"])) == (name == "refuses")


def test_method_that_gives_up_is_not_called_exact():
    def sometimes(solution, quantity):
        return refuses(solution, quantity) if np.ptp(solution.crank_angle) > 3.5 else components(solution, quantity)

    place = stability.Place("anywhere", "number [1]", (0.0, 0.5), scene, "slider_position")
    (row,) = stability.summary(stability.study([place], [planted(sometimes)])).to_dict("records")
    assert row["given up"] == 1
    assert "gives up" in row["does"]


# Files and charts


@pytest.fixture
def two_places(monkeypatch):
    """Two places with three numbers each, and three methods."""
    places = [replace(place, numbers=place.numbers[-3:]) for place in stability.PLACES[:2]]
    methods = [method for method in METHODS if method.name in ("ours, NumPy", SINGLE, SECOND)]
    monkeypatch.setattr(stability, "study", partial(stability.study, methods=methods))
    monkeypatch.setattr(stability, "write", partial(stability.write, places=places))
    return places


def test_command_writes_rows_summary_and_chart(two_places, tmp_path, capsys):
    folder = tmp_path / "new"
    assert cli.main(["stability", "--out", str(folder)]) == 0
    names = ["stability.csv", "stability_summary.csv", "stability.png", "stability.svg"]
    printed, told = capsys.readouterr()
    assert printed.splitlines()[-4:] == [str(folder / name) for name in names]
    assert sorted(path.name for path in folder.iterdir()) == sorted(names)
    assert told.splitlines() == [place.name for place in two_places]
    rows, summary = (pd.read_csv(folder / name) for name in names[:2])
    assert len(rows) == 2 * 3 * 3
    assert not rows.duplicated(["place", "number", "method"]).any()
    assert len(summary) == 2 * 3
    for table in (rows, summary):
        assert table["machine"].nunique() == table["versions"].nunique() == 1
        assert table["versions"].str.contains(f"numpy {np.__version__}").all()
    for method, of_method in summary.groupby("method"):
        line = next(line for line in printed.splitlines() if line.startswith(method))
        told = [int(count) for count in line.removeprefix(method).split()]
        counts = Counter(text for does in of_method["does"] for text in does.split(", "))
        assert sorted(count for count in told if count) == sorted(counts.values()), method
    assert plt.imread(folder / "stability.png").shape[0] > 500
    text = (folder / "stability.svg").read_text()
    for name in ("ours, NumPy", SINGLE, SECOND, "condition x rounding", *(place.name for place in two_places)):
        assert f"<!-- {name} -->" in text, name


def test_failed_writing_ends_with_status_2(two_places, tmp_path, monkeypatch, capsys):
    def disk_full(self, path, **_):
        raise OSError("disk full")

    monkeypatch.setattr(pd.DataFrame, "to_csv", disk_full)
    assert cli.main(["stability", "--out", str(tmp_path)]) == 2
    assert "disk full" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("place", stability.PLACES[::4], ids=lambda place: place.name)
def test_place_chart_has_units_and_the_condition(table, place):
    rows = table[table["place"] == place.name]
    figure, ax = plt.subplots()
    assert charts.error_by_distance(rows, ax=ax) is ax
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert ax.get_xlabel() == place.axis
    assert ax.get_xlabel().endswith(("[rad]", "[1]", "[radii]"))
    assert ax.get_ylabel().startswith("error of ")
    assert ax.get_ylabel().endswith("[1]")
    lines = {line.get_label(): line for line in ax.lines}
    given = rows[rows["not given"] == ""]
    assert set(lines) == {*given["method"], *DRAWN}
    assert lines["one rounding of the crank angle"].get_linestyle() == "-."
    dashed = [name for name, line in lines.items() if line.get_linestyle() == "--"]
    assert dashed == ["condition x rounding"]
    limit = rows.drop_duplicates("number").set_index("number")["condition"] * 2.0**-53
    x, y = lines["condition x rounding"].get_data()
    np.testing.assert_allclose(y, np.clip(limit[x], 1e-17, 1e3))
    x, y = lines["ours, NumPy"].get_data()
    assert np.all(y <= 100 * np.clip(limit[x], 1e-17, 1e3))
    plt.close(figure)


def test_ours_are_the_lower_envelope(table):
    """No other method is nearer than ours by more than thirty roundings of the problem itself."""
    left = table[(table["condition"] * UNIT_ROUNDOFF < 1) & table["error"].notna()]
    others = left[~left["ours"]].groupby(["place", "number"])["error"].min()
    ours = left[left["ours"]].groupby(["place", "number"])["error"].max()
    rounding = left.groupby(["place", "number"])["condition"].first() * UNIT_ROUNDOFF
    assert (ours <= np.maximum(others, 30 * rounding)).all()
    assert len(ours) > 20
