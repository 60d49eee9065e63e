"""Work against precision: errors of known orders, nothing nearer than ours, and files that two runs compare by."""

import platform
import sys
from functools import partial
from importlib.metadata import version

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics import cli
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.studies import precision
from kinetostatics.studies.methods import structures
from kinetostatics.studies.methods.global_system import newton
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from kinetostatics.studies.methods.kane import equations
from kinetostatics.studies.methods.method import Method
from kinetostatics.studies.precision import METHODS
from kinetostatics.views import charts
from support.case_files import shipped
from support.studied import FEW, torque_study

pytestmark = pytest.mark.slow

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

KINDS = [
    ("sawframe_2r63", "plain"),
    ("sawframe_2r63", "cam-circle"),
    ("sawframe_2r63", "cam-cosine"),
    ("mower_drive", "unbalanced"),
    ("chain_unit", "rho-0.5"),
]
OURS = [method for method in METHODS if method.ours and method.precision == "double"]
OTHERS = [method for method in METHODS if not method.ours]
TIME = "time [ns/angle]"


@pytest.fixture(scope="module")
def case():
    return ks.load_case("sawframe_2r63")


@pytest.fixture(scope="module")
def torque():
    return torque_study()


# A study


def test_study_has_a_row_a_method_and_setting(torque):
    expected = [(method.name, setting) for method in FEW for setting in method.settings]
    found = list(zip(torque["method"], torque["value"].astype(object), strict=True))
    assert [(name, None if value != value else value) for name, value in found] == expected
    given = torque["not given"] == ""
    assert np.all(torque.loc[given, [TIME, "error"]] > 0)
    assert np.all(np.isfinite(torque.loc[given, [TIME, "error"]]))
    assert torque.loc[~given, [TIME, "error"]].isna().all(axis=None)
    assert list(torque.loc[~given, "value"]) == [64, 128]
    assert torque.loc[~given, "not given"].str.contains("more than the 48 given crank angles").all()


def test_ours_lie_within_5e_15_and_are_marked_as_ours(torque):
    ours = torque[torque["ours"]]
    assert list(ours["method"]) == ["ours, NumPy", "ours, torque by powers"]
    assert np.all(ours["error"] < 5e-15)


def test_single_precision_has_rows_and_device(case):
    """What is compiled has the bits of NumPy, and its own tests."""
    single = [method for method in METHODS if method.precision == "single" and "compiled" not in method.name]
    assert [method.name for method in single] == ["ours, NumPy, single precision", "ours, JAX, single precision"]
    table = precision.study(case.solve("plain", 12), methods=single, repeats=1)
    given = table[table["not given"] == ""]
    assert len(given) >= 1
    assert np.all((given["error"] > 1e-8) & (given["error"] <= given["bound"]) & (given["bound"] < 1e-5))
    assert given["device"].iloc[0] == "cpu"
    assert np.all(given["device"] != "")


# The front


def test_front_holds_the_best_in_time_and_error():
    rows = {
        "slow and exact": (50.0, 1e-16),
        "middle": (10.0, 1e-8),
        "beaten by middle": (11.0, 1e-7),
        "slower with the same error": (12.0, 1e-8),
        "coarse with the time of the fastest": (2.0, 1.0),
        "fastest": (2.0, 1e-2),
        "slow and wrong": (60.0, 10.0),
        "not given": (np.nan, np.nan),
    }
    table = pd.DataFrame([(name, *row) for name, row in rows.items()], columns=["method", TIME, "error"])
    for seed in range(5):
        front = precision.front(table.sample(frac=1.0, random_state=seed))
        assert list(front["method"]) == ["fastest", "middle", "slow and exact"]


@pytest.mark.parametrize("quantity", ["balancing_torque", "O"])
@pytest.mark.parametrize(("name", "variant"), KINDS)
def test_no_method_is_nearer_than_ours(interpreted, name, variant, quantity):
    """So whatever is faster than ours and better than 1e-6 is no nearer; how fast is measured by the benchmark.

    Integration at its finest tolerance only, what is there twice, compiled too, once; compiled programs as they are
    written.
    """
    s = shipped(name).solve(variant, 24)
    reference = enclosure(s, quantity)

    def errors(methods):
        found = {}
        for method in methods:
            for setting in method.settings[-1 if "integration" in method.name else 0 :]:
                try:
                    run = method.prepare(s, quantity, setting)
                except (ks.errors.NotGivenError, ks.errors.MissingLibraryError):
                    continue
                found[method.name, setting] = float(relative_errors(run(), reference).max())
        return found

    ours = errors(OURS)
    assert max(ours.values()) < 5e-15
    best = min(ours.values())
    others = errors(method for method in OTHERS if not method.name.endswith("compiled"))
    assert len(others) > 20
    assert {key: error for key, error in others.items() if error < best / 4 and error < best - 1e-15} == {}


@pytest.mark.parametrize(
    ("name", "variant"),
    [("shaper", "cutting"), ("pumpjack", "weights"), ("yoke_pump", "pumping"), ("v_twin", "firing")],
)
def test_general_methods_chart_tables_and_loads(name, variant):
    s = shipped(name).solve(variant, 8)
    for quantity in ("balancing_torque", "O"):
        reference = enclosure(s, quantity)
        for method in (*equations.METHODS, *newton.NEWTON_METHODS):
            found = method.prepare(s, quantity, method.settings[-1])()
            assert relative_errors(found, reference).max() < 1e-13, (method.name, quantity)


def test_kane_covers_every_shipped_mechanism():
    """But for planets: Kane's equations here know no teeth."""
    for name in shipped_cases():
        for variant in shipped(name).variants.values():
            if any(isinstance(group, ks.PlanetaryCrank) for group in variant.mechanism.groups):
                continue
            made, numbers = structures.structure(variant.mechanism)
            assert len(made.parts) == 1 + len(variant.mechanism.groups)
            assert numbers["crank_mass"] == variant.mechanism.links["crank"].mass


def test_friction_is_charted_off_its_jumps():
    names = ("ours, NumPy", "papers' formulas", "SymPy Kane, lambdified", "Newton iteration, global system")
    methods = [method for method in METHODS if method.name in names]
    solution = ks.load_case("sawframe_2r63_friction").solve("plain", 12)
    solution = solution.at(solution.crank_angle + np.pi / 12)
    table = precision.study(solution, methods=methods, repeats=1).set_index("method")
    assert table.loc["ours, NumPy", "error"] < 5e-15
    assert table.loc["Newton iteration, global system", "error"].min() < 1e-14
    assert table.loc[list(names[1:3]), "not given"].str.contains("have no friction, but the scene has some in O").all()


def test_coarse_motion_for_a_table_is_a_reason():
    (series,) = (method for method in METHODS if method.name == "harmonic series")
    table = precision.study(ks.load_case("shaper").solve("cutting", 24), methods=[series], repeats=1)
    assert table["not given"].str.contains("table over travel").any()


@pytest.mark.parametrize("error", [ks.ParameterError, ks.errors.KinetostaticsError, ValueError])
def test_unexpected_error_of_a_method_is_raised(case, error):
    def prepare(solution, quantity, setting):
        raise error("a wrong number")

    with pytest.raises(error, match="a wrong number"):
        precision.study(case.solve("plain", 4), methods=[Method("at fault", prepare)], repeats=1)


# Files and charts


@pytest.fixture
def few(monkeypatch):
    """Studies with a few methods only, each timed once."""
    monkeypatch.setattr(precision, "study", partial(precision.study, methods=FEW, repeats=1))


def test_case_study_takes_one_variant_a_kind(case):
    kinds = {name: precision.variant_of_each_kind(ks.load_case(name)) for name in ("mower_drive", "chain_unit")}
    assert precision.variant_of_each_kind(case) == ["plain", "cam-circle", "cam-cosine", "upright-optimal"]
    assert kinds == {"mower_drive": ["unbalanced"], "chain_unit": ["rho-0.1"]}


def test_case_study_rows_name_machine_and_versions(few, case, tmp_path):
    variants = ("plain", "cam-circle")
    path, *_ = precision.case_study(case, tmp_path, variants=variants, quantities=["O"], angles=16)
    table = pd.read_csv(path, keep_default_na=False, na_values={TIME: "", "error": "", "value": ""})
    assert len(table) == 2 * sum(len(method.settings) for method in FEW)
    for column, values in {"case": ["sawframe_2r63"], "variant": variants, "quantity": ["O"]}.items():
        assert set(table[column]) == set(values)
    assert set(table["angles"]) == {16}
    assert not table.duplicated(["variant", "quantity", "method", "value"]).any()
    assert [table[name].dtype for name in (TIME, "error", "value", "ours")] == [float, float, float, bool]
    (machine,), (versions,) = set(table["machine"]), set(table["versions"])
    assert platform.system() in machine
    assert "cores" in machine
    assert f"Python {platform.python_version()}" in versions
    for library in ("kinetostatics", "numpy", "scipy", "python-flint", "mpmath"):
        assert f"{library} {version(library)}" in versions
    refused = table[table["not given"] != ""]
    assert "virtual power gives only the torque of the drive" in set(refused["not given"])
    assert refused[[TIME, "error"]].isna().all(axis=None)


def test_case_chart_names_every_method(few, case, tmp_path):
    others = plt.get_fignums()
    paths = precision.case_study(case, tmp_path / "new", variants=["plain"], angles=16, page=charts.precision_page)
    assert [path.name for path in paths] == [f"sawframe_2r63_precision.{kind}" for kind in ("csv", "png", "svg")]
    assert sorted((tmp_path / "new").iterdir()) == sorted(paths)
    assert plt.imread(paths[1]).shape[0] > 500
    text = paths[2].read_text()
    for method in FEW:
        assert f"<!-- {method.name}" in text, method.name
    assert "<!-- sawframe_2r63, plain: balancing torque -->" in text
    assert "<!-- time [ns per crank angle] -->" in text
    assert plt.get_fignums() == others


# The command line


def test_command_prints_front_and_files(few, tmp_path, capsys):
    arguments = ["--variant", "plain", "--quantity", "O", "--quantity", "balancing_torque", "--angles", "16"]
    assert cli.main(["precision", "sawframe_2r63", "--out", str(tmp_path), *arguments]) == 0
    printed, told = capsys.readouterr()
    names = [f"sawframe_2r63_precision.{kind}" for kind in ("csv", "png", "svg")]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert printed.splitlines()[-3:] == [str(tmp_path / name) for name in names]
    front = printed.split("faster and more accurate")[1]
    assert "ours, NumPy" in front or "ours, torque by powers" in front
    assert "nan" not in front
    assert told.splitlines() == [method.name for method in FEW] * 2
    table = pd.read_csv(tmp_path / names[0])
    assert list(table["quantity"].unique()) == ["O", "balancing_torque"]


def test_missing_flint_is_named_and_nothing_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "flint", None)
    assert cli.main(["precision", "sawframe_2r63", "--out", str(tmp_path / "out")]) == 2
    printed, told = capsys.readouterr()
    assert printed == ""
    assert told.startswith("kinetostatics: ")
    assert told.endswith('pip install "kinetostatics[precision]"\n')
    assert not (tmp_path / "out").exists()
