"""What has an answer is answered, and what has none is refused in the library's own words: never another's error."""

import os
import subprocess
import sys
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.every import each, every, quick

TURN = np.linspace(0.1, 6.2, 40)
PUMP = ks.crank_slider(0.05, 0.2, crank=ks.Link(1.0, 0.01, 0.01), slider=ks.Link(1.0))
SCENE = ks.Scene(PUMP, 100.0, loads=ks.Gravity())
SPREADS = {"slider.mass": "500..700 kg"}


def run(code, **environment):
    """Standard output and error of a fresh interpreter."""
    done = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | environment, capture_output=True, text=True, check=False
    )
    return done.stdout, done.stderr


# tables over travel that the law of a follower reads


X, Y, BACK = [0.03, 0.045, 0.07], [-100.0, -250.0, -50.0], [0.0, -10.0, -20.0]


@pytest.fixture(scope="module", params=[ks.RollerFollower, ks.FlatFollower])
def follower(request):
    table = ks.Table(X, Y, over="travel", back=BACK)
    part = request.param(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0))
    machine = ks.Mechanism("cam drive", ks.Crank(None, ks.Link(1.0)), (part,))
    return ks.solve(machine, TURN, crank_speed=10.0, loads=ks.ProcessForce(table, on="follower"))


@pytest.mark.parametrize("tight", [False, True])
def test_follower_table_bounds_hold(follower, tight):
    bounds, law = follower.error_bound("balancing_torque", tight=tight), ks.laws.cosine(0.01, 0.05)
    for angle, torque, bound in zip(TURN, follower.balancing_torque, bounds, strict=True):
        place, rate, second = (Fraction(float(part)) for part in law(angle)[:3])
        rows = list(zip(map(Fraction, X), map(Fraction, Y if rate >= 0 else BACK), strict=True))
        (x0, y0), (x1, y1) = next(pair for pair in pairwise(rows) if place <= pair[1][0])
        force = y0 + (y1 - y0) * (place - x0) / (x1 - x0)
        exact = (2 * 100 * second - force) * rate
        assert abs(Fraction(float(torque)) - exact) <= Fraction(float(bound))
        assert bound < 1e-13


def test_follower_table_has_uncertainty_and_steps(follower):
    found = follower.uncertainty("balancing_torque", {"follower.mass": 0.1})
    assert np.isfinite(found.total).all()
    assert found.rounding.max() < 1e-13
    assert float(follower.explain("balancing_torque", 1.0).value) == pytest.approx(
        float(follower.at(1.0).balancing_torque), rel=1e-14
    )
    extremes = ks.extremes(follower, "balancing_torque")
    assert np.all(extremes.error_bound < 1e-12)


# searches for designs whose sliders would leave a load table


def machine(crank=0.045, coupler=0.2, low=0.13, high=0.2481):
    made = ks.crank_slider(
        crank, coupler, guide=ks.Guide.at(0.0, 0.02), slider=ks.Link(1.0), coupler=ks.Link(0.5, 0.1, 0.001)
    )
    table = ks.Table([low, 0.2, high], [-900.0, -500.0, -100.0], over="travel", back=[0.0, 0.0, 0.0])
    return ks.Scene(made, 100.0, loads=ks.ProcessForce(table))


CRANK = {"crank_length": (0.03, 0.07)}
BOTH = CRANK | {"coupler_length": (0.18, 0.22)}
LONGEST = np.sqrt(0.2481**2 + 0.02**2) - 0.2
"""Crank with which the slider just reaches the end of the table."""


@pytest.mark.slow_start
@pytest.mark.parametrize("goal", ["range slider_position", "largest balancing_torque", "mean balancing_torque"])
def test_best_design_reaches_the_end_of_the_table(goal):
    found = ks.design.optimise(machine(), CRANK, maximise=goal)
    assert dict(found.values)["crank_length"] == pytest.approx(LONGEST, rel=1e-8)
    assert found.active == ("largest slider_position <= 0.2481 m",)
    assert np.isfinite(found.scene.solve(20_001).balancing_torque).all()


@pytest.mark.slow_start
def test_both_table_ends_limit_two_lengths():
    found = ks.design.optimise(machine(), BOTH, maximise="mean balancing_torque")
    crank, coupler = dict(found.values)["crank_length"], dict(found.values)["coupler_length"]
    assert np.sqrt((coupler + crank) ** 2 - 0.02**2) == pytest.approx(0.2481, rel=1e-8)
    assert np.sqrt((coupler - crank) ** 2 - 0.02**2) == pytest.approx(0.13, rel=1e-8)
    report = found.report()
    assert report.loc["smallest slider_position [m]", "binds"]
    assert report.loc["largest slider_position [m]", "limit"] == "<= 0.2481"


@pytest.mark.slow_start
def test_searches_from_outside_find_the_same_design():
    inside = ks.design.optimise(machine(), CRANK, maximise="mean balancing_torque")
    outside = ks.design.optimise(machine(crank=0.06), CRANK, maximise="mean balancing_torque")
    assert dict(outside.values)["crank_length"] == pytest.approx(dict(inside.values)["crank_length"], rel=1e-8)


@pytest.mark.slow
def test_every_start_over_a_table_ends():
    found = ks.design.optimise(machine(), BOTH, maximise="mean balancing_torque", starts=4)
    assert found.starts == pytest.approx([max(found.starts)] * 4, rel=1e-7)


@pytest.mark.slow
def test_a_front_of_designs_within_a_table_is_found():
    front = ks.design.pareto(machine(), BOTH, ("largest A", "-mean balancing_torque"), points=3)
    assert all(np.isfinite(design.scene.solve(7_919).balancing_torque).all() for design in front.designs)


@pytest.mark.slow
def test_limits_hold_beside_those_of_the_table():
    found = ks.design.optimise(
        machine(), BOTH, maximise="mean balancing_torque", limits=["largest slider_position <= 0.24 m"]
    )
    assert set(found.active) == {"largest slider_position <= 0.24 m", "smallest slider_position >= 0.13 m"}


@pytest.mark.slow_start
def test_unmendable_design_names_the_path():
    with pytest.raises(
        ks.DesignError, match=r"crank_length = 0\.06: table over travel.*bounds of crank_length"
    ) as told:
        ks.design.optimise(machine(crank=0.06), {"crank_length": (0.055, 0.07)}, maximise="mean balancing_torque")
    assert dict(told.value.values)["crank_length"] >= 0.055


@pytest.mark.slow
def test_robust_design_stays_within_the_table():
    spread = ks.design.Spread(0.05, {"crank_length": "normal 0 % +- 3 %"}, samples=64)
    found = ks.design.optimise(machine(), CRANK, maximise="mean balancing_torque", robust=spread)
    values = ks.design.over_spread(found.scene, "mean balancing_torque", spread, samples=64)
    assert np.isfinite(values).all()
    assert found.active == ("largest slider_position within the spread <= 0.2481 m",)
    assert dict(found.values)["crank_length"] < 0.97 * LONGEST


@pytest.mark.slow
def test_spread_that_leaves_the_table_is_named():
    spread = ks.design.Spread(0.05, {"crank_length": "normal 0 % +- 3 %"}, samples=64)
    with pytest.raises(
        ks.DesignError, match=r"whose spread of crank_length contains a machine that fails: table over travel"
    ):
        ks.design.optimise(machine(0.0475), {"slider.mass": (0.5, 2.0)}, minimise="largest A", robust=spread)


# numba that compiles nothing


@pytest.mark.slow
def test_many_angles_work_without_a_compiler():
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    out, errors = run(
        "import numpy as np, kinetostatics as ks\n"
        "pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))\n"
        "s = ks.solve(pump, np.linspace(0.0, 6.0, 1_000_000), crank_speed=100.0)\n"
        "print(f'{s.balancing_torque[500_000]:.6f}', ks.compile(ks.Scene(pump, 100.0), 'O').engine)\n"
        "try:\n    ks.solve(pump, 0.5, crank_speed=1.0, engine='compiled')\n"
        "except ks.errors.MissingLibraryError as error:\n    print(error)\n",
        NUMBA_DISABLE_JIT="1",
    )
    torque = float(ks.solve(PUMP, 3.000003, crank_speed=100.0).balancing_torque)
    assert not errors
    assert out.splitlines()[0] == f"{torque:.6f} numpy"
    assert "NUMBA_DISABLE_JIT is set: unset it" in out


@pytest.mark.slow
def test_without_a_compiler_sweeps_have_their_rows():
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    out, _ = run(
        "import kinetostatics as ks\n"
        "scene = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0)\n"
        "table = ks.sweep(scene, ks.designs.grid({'slider.mass': '1..2 kg:4000'}), ['largest O'], progress=False)\n"
        "print((table['failed'] == '').all())\n",
        NUMBA_DISABLE_JIT="1",
    )
    assert out == "True\n"


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")  # so short a coupler has too large an inertia
def test_command_with_failed_designs_reports_failure(capsys):
    assert main(["sweep", "compressor", "--vary", "coupler_length=0.01..0.02 m:3", "--angles", "24"]) == 2
    assert "all 3 designs failed: crank-slider cannot be assembled" in capsys.readouterr().err
    assert main(["sweep", "compressor", "--vary", "coupler_length=0.01..0.2 m:3", "--angles", "24"]) == 0


# groups of one's own that do less than they declare


def own(**methods):
    """A slider group of the user's own, with some methods of its own: nothing of it is taken for granted."""
    return type("Own", (ks.SliderGroup,), methods)


def placed(change):
    """A group whose place does what a slider's does, and then this to the placement."""

    def place(self, placement):
        ks.SliderGroup.place(self, placement)
        change(placement)

    return own(place=place)


def closing(found):
    """A group whose closure is found from its placement."""
    return own(closure=lambda self, placement: found(placement))


NO_PLACES = [
    (placed(lambda placement: placement.joints.pop("B")), r"a Joint for the joint 'B' into placement\.joints"),
    (
        placed(lambda placement: placement.links.pop("slider")),
        r"LinkMotion for the link 'slider' into placement\.links",
    ),
    (own(place=lambda self, placement: None), r"joint 'B'.*link 'coupler'.*link 'slider'"),
    (
        placed(lambda placement: placement.joints.update(B=(0.1, 0.2))),
        r"its place must put a Joint for the joint 'B'.*puts \(0\.1, 0\.2\)",
    ),
    (
        placed(lambda placement: placement.joints.update(B=placement.joints["Q"])),
        r"is attached to 'A', but its place uses 'Q'",
    ),
    (own(resolve=lambda self, placement, loads, along: None), r"its resolve must return a Resolved"),
]
MARGIN = r"its closure must return its margin.*"
WRONG = [
    *NO_PLACES,
    (placed(lambda placement: placement.travels.pop("slider")), r"the travel of 'slider' into placement\.travels"),
    (closing(lambda placement: np.ones(3)), rf"{MARGIN}of shape \(3,\)"),
    (closing(lambda placement: np.ones((2, 1))), rf"{MARGIN}of shape \(2, 1\)"),
    (closing(lambda placement: (1.0, 2.0)), f"{MARGIN}one value, not several"),
    (closing(lambda placement: "yes"), f"{MARGIN}a text"),
    (closing(lambda placement: placement.angle > -1.0), f"{MARGIN}truth value"),
    (closing(lambda placement: None), f"{MARGIN}got None"),
]
ALWAYS, NEVER = closing(lambda placement: 1.0), closing(lambda placement: np.full_like(placement.angle, np.nan))


def with_group(group, crank=0.05):
    return ks.Mechanism("own", ks.Crank(crank), (group(0.2, slider=ks.Link(1.0)),))


@every(("group", "message"), WRONG)
def test_incomplete_groups_are_refused_when_solved_or_checked(group, message):
    for on_gap in ("raise", "nan"):
        with pytest.raises(ks.ParameterError, match=message):
            ks.solve(with_group(group), TURN, crank_speed=10.0, on_gap=on_gap).reaction("O")
    with pytest.raises(ks.ParameterError, match=message):
        ks.check(group(0.2, slider=ks.Link(1.0)))


@every(("group", "message"), NO_PLACES)
def test_programs_of_such_groups_are_refused(group, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.compile(ks.Scene(with_group(group), 10.0), "O", engine="numpy")


def test_constant_closure_without_position_is_refused():
    within = ks.solve(with_group(ALWAYS), TURN, crank_speed=10.0)
    assert np.isfinite(within.balancing_torque).all()
    with pytest.raises(
        ks.ParameterError, match=r"negative where its place finds no position, but is 1 at \d+ crank angles"
    ):
        ks.solve(with_group(ALWAYS, 0.3), TURN, crank_speed=10.0)
    with pytest.raises(
        ks.ParameterError, match=r"negative where its place finds no position, but is 1 at \d+ crank angles"
    ):
        ks.check(ALWAYS(0.2))


def test_a_closure_that_is_no_number_is_refused():
    with pytest.raises(ks.ParameterError, match=r"its closure must be a number.*but is nan at 40"):
        ks.solve(with_group(NEVER), TURN, crank_speed=10.0)


def test_missing_requirement_names_the_group():
    with pytest.raises(ks.AssemblyError, match="the closure of Own is negative there"):
        ks.solve(with_group(own(requirement=lambda self, placement: None), 0.3), TURN, crank_speed=10.0)


# loads that do nothing where they stand


FOUR_BAR = ks.four_bar(0.1, 0.3, 0.25, rocker_pivot=(0.3, 0.0), rocker=ks.Link(2.0, 0.1, 0.02))
IDLE = {
    "pivot and fixed point": (PUMP, ks.PointDamper(50.0, between=("O", (0.1, 0.1)))),
    "place on the crank at O": (PUMP, ks.PointDamper(50.0, between=(("crank", 0.0, 0.0), (0.2, 0.2)))),
    "two pivots": (FOUR_BAR, ks.PointDamper(50.0, between=("O", "O2"))),
    "no coefficient": (PUMP, ks.PointDamper(0.0, between=("B", (0.1, 0.1)))),
    "couple on a slider": (PUMP, ks.TorsionDamper(5.0, on="slider")),
    "couple without coefficient": (PUMP, ks.TorsionDamper(0.0, on="crank")),
    "spring between pivots": (FOUR_BAR, ks.PointSpring(50.0, 0.1, between=("O", "O2"))),
    "force between pivots": (FOUR_BAR, ks.PointForce(50.0, between=("O", "O2"))),
    "force at a pivot": (FOUR_BAR, ks.Force(50.0, at="O2")),
}
"""Loads that take no torque, by what they are; those at pivots may load these."""


@pytest.mark.slow
@pytest.mark.parametrize(("mechanism", "load"), quick(IDLE.values(), 5), ids=IDLE)
def test_idle_loads_take_no_torque(mechanism, load):
    bare, loaded = ks.Scene(mechanism, 10.0), ks.Scene(mechanism, 10.0, loads=load)
    expected, found = bare.solve(TURN), loaded.solve(TURN)
    assert np.array_equal(found.balancing_torque, expected.balancing_torque)
    programs = [ks.compile(scene, "balancing_torque", engine="numpy") for scene in (bare, loaded)]
    assert np.array_equal(*(program(TURN)["balancing_torque"] for program in programs))
    for tight in (False, True):
        assert (found.error_bound("balancing_torque", tight=tight) < 1e-13).all()
    assert found.explain("balancing_torque", 0.5).value == expected.explain("balancing_torque", 0.5).value
    assert np.isfinite(found.uncertainty("balancing_torque", {"crank_length": 1e-5}).total).all()
    assert (
        ks.drive.steady(loaded, None, flywheel=5.0).mean_speed == ks.drive.steady(bare, None, flywheel=5.0).mean_speed
    )


# names, mappings, seeds and numbers of a wrong kind


ODD = [1.5, True, [], {}, object(), b"O", (), ["O", "A"], ("O",), {"O"}, np.array(["O", "A"]), float]
NAMED = (
    *("reaction", "scalar", "measure", "rate", "angular_acceleration", "inertia_force", "pin_load"),
    *("friction_at", "friction_loss_at", "travel_velocity"),
)
NO_SEEDS = ["x", 1.5, -1, True, {}, [1.5], np.nan, object()]
NO_NAMES = [None, 1, 1.5, ("a",), b"x"]
NO_PATHS = [[], {}, np.array([1.0]), {"O"}, 1.5, None]
NO_MAPPINGS = [None, 1.5, "slider.mass", ["slider.mass"], np.array([1.0, 2.0]), {"slider.mass"}]
NO_TEXTS = [1.5, -1, True, object(), float, b"O"]
DRAWN = [ks.designs.sobol, ks.designs.latin_hypercube, ks.designs.random]
SOLUTION = SCENE.solve(8)
ONE = pd.DataFrame({"slider.mass [kg]": [1.0]})


def program():
    return ks.compile(SCENE, "balancing_torque", engine="numpy")


REFUSED = [
    *each(
        ks.QuantityError,
        *((getattr(SOLUTION, name), ODD, "allowed") for name in NAMED),
        (SOLUTION.reaction, [["O", "A"], ("O", "A"), {"O", "A"}, np.array(["O", "A"])], "use one at a time"),
    ),
    *each(
        ks.errors.CaseError,
        *(
            (lambda bad, call=call: call(ks.load_case("compressor"), bad), [*NO_PATHS, ["plain"]], "variant is")
            for call in (
                ks.Case.variant,
                ks.Case.solve,
                lambda case, bad: case.compare(bad, "loaded"),
                ks.Case.comparison_table,
            )
        ),
    ),
    *each(
        ks.ParameterError,
        *((lambda bad, draw=draw: draw(SPREADS, 4, bad), NO_SEEDS, "seed must be a whole number") for draw in DRAWN),
        (
            lambda bad: ks.tolerances(
                SCENE, ["largest O"], {"slider.mass": "1..2 kg"}, count=4, seed=bad, progress=False
            ),
            [1.5],
            "seed must be a whole number",
        ),
        *((lambda bad, draw=draw: draw({bad: "1..2 kg"}, 4), NO_NAMES, "a parameter must be a name") for draw in DRAWN),
        (lambda bad: ks.designs.grid({bad: "1..2 kg:2"}), NO_NAMES, "a parameter must be a name"),
        (
            lambda bad: ks.designs.sample(SPREADS, bad),
            ["half", [["a"]], [[object()]], [[0.5], [0.5, 0.6]], lambda size: "x"],
            r"uniform must be numbers from 0 to 1, an array \(designs, 1\)",
        ),
        (
            SOLUTION.elongation,
            ["far", None, [0.1, 0.2], np.array([0.1, 0.2]), np.array(["a"]), object()],
            "free_position",
        ),
        *(
            (call, NO_MAPPINGS, "values must be a dict of path to number")
            for call in (
                SCENE.varied,
                lambda bad: ks.load_case("compressor").variants["loaded"].varied(bad),
                lambda bad: program()(0.5, bad),
                lambda bad: program().error_bound(0.5, bad),
                lambda bad: program().derivatives(0.5, None, bad),
            )
        ),
        (lambda bad: ks.compile(SCENE, bad), NO_TEXTS, "must be a name, or several in a list"),
        (lambda bad: ks.compile(SCENE, "O", bad), NO_TEXTS, "must be a name, or several in a list"),
        (lambda bad: program().derivatives(0.5, bad), NO_TEXTS, "must be a name, or several in a list"),
        (lambda bad: program().depends_on(bad), NO_PATHS, "parameter is"),
        (ks.Scene.of, [None, 1, [], {}, "O", PUMP, SCENE], "solution must be a Solution"),
        (
            lambda bad: ks.sweep(SCENE, ONE, ["largest O"], progress=bad),
            [None, 1.5, "yes", np.array([1.0, 2.0])],
            "progress must be True or False",
        ),
        (ks.two_mass_coupler, [None, SCENE, "saw", [], 1.5], "mechanism must be a Mechanism"),
    ),
]
"""Calls, what they are given, and what they say to it."""


@pytest.mark.slow
@every(("error", "call", "bad", "words"), REFUSED)
def test_values_of_a_wrong_kind_are_refused(error, call, bad, words):
    with pytest.raises(error, match=words):
        call(bad)


# more numbers than any memory holds


HUGE = {
    "doubles": np.broadcast_to(0.5, 10**11),
    "floats": np.broadcast_to(np.float32(0.5), 10**11),
    "whole numbers": np.broadcast_to(1, 10**11),
    "a grid": np.broadcast_to(0.5, (10**6, 10**6)),
}
TAKEN = {
    "solve": lambda given: ks.solve(PUMP, given, crank_speed=30.0),
    "scene": SCENE.solve,
    "at": lambda given: SCENE.solve(8).at(given),
    "program": lambda given: ks.compile(SCENE, "O", engine="numpy")(given),
    "speed": lambda given: ks.solve(PUMP, 0.5, crank_speed=given),
    "force": ks.ProcessForce,
    "table": lambda given: ks.Table(given, given),
    "cam": lambda given: ks.cams.Sampled(given, given),
    "law": ks.laws.cosine(0.01, 0.05),
    "sample": lambda given: ks.designs.sample(SPREADS, given),
}


@every("numbers", HUGE.values(), ids=HUGE)
@every("taken", TAKEN.values(), ids=TAKEN)
def test_arrays_that_no_memory_holds_are_refused(taken, numbers):
    with pytest.raises(ks.ParameterError, match=r"GB of memory|too many for one table"):
        taken(numbers)


def test_designs_times_angles_are_limited():
    many = ks.crank_slider(np.full((10**5, 1), 0.05), 0.2)
    with pytest.raises(ks.ParameterError, match="designs times crank angles must be at most"):
        ks.solve(many, np.linspace(0.0, 6.0, 10**5), crank_speed=30.0)


# a backend of matplotlib that is none


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["bogus", "module://nope"])
@pytest.mark.parametrize(
    "code", ["ks.plots", "ks.report", "ks.drive.coast(scene, 1.0, from_speed=3.0, until=0.1).plot()"]
)
def test_a_backend_that_is_none_is_named(backend, code):
    start = (
        "import kinetostatics as ks\n"
        "scene = ks.Scene(ks.crank_slider(0.05, 0.2, crank=ks.Link(1.0, 0.01, 0.1), slider=ks.Link(1.0)), 30.0)\n"
    )
    _, errors = run(f"{start}{code}\n", MPLBACKEND=backend)
    assert f"ParameterError: figures cannot be drawn, as the environment variable MPLBACKEND is '{backend}'" in errors
    assert "unset it, or set it to agg" in errors


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["bogus", "module://nope"])
def test_command_line_draws_with_any_backend(backend, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "kinetostatics", "plot", "compressor", "--out", str(tmp_path)],
        env=os.environ | {"MPLBACKEND": backend},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert any(tmp_path.iterdir())
