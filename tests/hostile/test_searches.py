"""Bad demands on designs: each ends with one error that says what is wrong and where."""

import numpy as np
import pytest

import kinetostatics as ks

PUMP = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0)
VARY = {"slider.mass": (0.5, 2.0)}
TORQUE = "mean_absolute balancing_torque"


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        (None, "vary must be a dict"),
        ({}, "vary must be a dict"),
        (["slider.mass"], "vary must be a dict"),
        ({"slider.mas": (1, 2)}, "slider.mas.*did you mean 'slider.mass'"),
        ({"slider.mass": 2.0}, "bounds of slider.mass must be"),
        ({"slider.mass": (2.0, 1.0)}, "finite and rise"),
        ({"slider.mass": (1.0, 1.0)}, "finite and rise"),
        ({"slider.mass": (1.0, np.inf)}, "finite and rise"),
        ({"slider.mass": (1.0, np.nan)}, "finite and rise"),
        ({"slider.mass": (1.0, 2.0, 3.0)}, "bounds of slider.mass"),
        ({"slider.mass": ("1 kg", "2 m")}, "bounds of slider.mass.*2 m"),
        ({"slider.mass": ("1", "2")}, "bounds of slider.mass"),
        ({"slider.mass": (None, None)}, "bounds of slider.mass"),
        ({"slider.mass": (1, 1), "crank_length": "long"}, "slider.mass.*crank_length"),
    ],
)
def test_bounds_that_are_none_are_refused(vary, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.optimise(PUMP, vary, TORQUE)


@pytest.mark.parametrize(
    ("limit", "message"),
    [
        ("largest O", "must be an output, a relation and a value"),
        ("largest O < 3 N", "must be an output, a relation and a value"),
        ("largest O <= ", "must be an output, a relation and a value"),
        ("<= 3 N", "must be a reduction and a quantity"),
        ("largest O <= 3", "has no unit"),
        ("largest O <= 3 m", "does not measure the same"),
        ("largest O <= 3 N <= 4 N", "must be an output, a relation and a value"),
        ("greatest O <= 3 N", "reductions: largest"),
        ("largest_at O <= 3 deg", "is a place, which jumps"),
        (f"ratio {TORQUE} >= 3", "needs a reference"),
        (3.0, "must be an output, a relation and a value"),
        (None, "must be an output, a relation and a value"),
    ],
)
def test_limits_of_another_form_are_refused(limit, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.optimise(PUMP, VARY, TORQUE, [limit])


def test_all_wrong_limits_are_told_at_once():
    with pytest.raises(ks.ParameterError, match=r"largest O <= 3.*greatest O"):
        ks.design.optimise(PUMP, VARY, TORQUE, ["largest O <= 3", "greatest O <= 3 N"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "give either minimise or maximise"),
        ({"minimise": TORQUE, "maximise": TORQUE}, "give either minimise or maximise"),
        ({"minimise": "torque"}, "must be a reduction and a quantity"),
        ({"minimise": "largest_at O"}, "is a place"),
        ({"minimise": f"ratio {TORQUE}"}, "needs a reference"),
        ({"minimise": TORQUE, "variant": "plain"}, "variant is for cases"),
        ({"minimise": TORQUE, "starts": 0}, "starts"),
        ({"minimise": TORQUE, "starts": 1.5}, "starts"),
        ({"minimise": TORQUE, "begin": {"crank": 1.0}}, "begin"),
        ({"minimise": TORQUE, "begin": {"slider.mass": "1 kg"}}, "begin slider.mass"),
        ({"minimise": TORQUE, "begin": {"slider.mass": np.nan}}, "begin slider.mass must be finite"),
        ({"minimise": TORQUE, "begin": 1.0}, "begin must be a dict"),
        ({"minimise": TORQUE, "engine": "fast"}, "engine"),
        ({"minimise": TORQUE, "seed": -1}, "seed must be a whole number"),
        ({"minimise": TORQUE, "seed": "x"}, "seed must be a whole number"),
        ({"minimise": TORQUE, "angles": 0}, "angles"),
        ({"minimise": TORQUE, "angles": 7}, "angles must be at least 12"),
        ({"minimise": TORQUE, "angles": 180.0}, "angles"),
        ({"minimise": TORQUE, "angles": 10**9}, "angles must be at most"),
        ({"minimise": "harmonic_99 balancing_torque", "angles": 180}, "angles must be at least 199"),
        ({"minimise": TORQUE, "limits": None}, "limits must be texts"),
        ({"minimise": TORQUE, "limits": 3.0}, "limits must be texts"),
        ({"minimise": TORQUE, "robust": 0.05}, "robust must be a Spread"),
        ({"minimise": TORQUE, "reference": "plain"}, "reference must be a Scene"),
    ],
)
def test_options_of_another_kind_are_refused(options, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.optimise(PUMP, VARY, **options)


def test_many_designs_are_no_source():
    """Their curves, two in number, would pass for the components of a vector."""
    batch = PUMP.varied({"slider.mass": np.array([[1.0], [2.0]])})
    for source, reference in ((batch, None), (PUMP, batch)):
        with pytest.raises(ks.ParameterError, match="must be one design, but has several values of slider"):
            ks.design.optimise(source, {"coupler_length": (0.1, 0.3)}, TORQUE, reference=reference)


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        ({"slider.mass": (-10.0, -5.0)}, "mass must be at least 0, got -5"),
        ({"coupler_length": (0.01, 0.02)}, "must not exceed the coupler length"),
        ({"coupler_length": (-2.0, -1.0)}, "coupler length must be greater than 0"),
    ],
)
def test_it_is_told_why_no_design_can_be_built(vary, message):
    with pytest.raises(ks.DesignError, match=f"no design that can be built .*{message}"):
        ks.design.optimise(PUMP, vary, TORQUE)


@pytest.mark.parametrize(
    ("minimise", "options", "message"),
    [
        (None, {}, "minimise must be two outputs"),
        ("largest O", {}, "minimise must be two outputs"),
        (("largest O",), {}, "minimise must be two outputs"),
        (("largest O", 5), {}, "minimise must be two outputs"),
        (("largest O", TORQUE), {"robust": None}, "option is 'robust'"),
        (("largest O", TORQUE), {"begin": {}}, "option is 'begin'"),
        (("largest O", TORQUE), {"points": 1}, "points must be at least 2"),
    ],
)
def test_fronts_of_another_form_are_refused(minimise, options, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.pareto(PUMP, VARY, minimise, **options)


@pytest.mark.parametrize("quantity", ["forces", "cam_force", "C"])
def test_absent_quantity_is_refused(quantity):
    with pytest.raises(ks.QuantityError, match=quantity):
        ks.design.optimise(PUMP, VARY, f"largest {quantity}")


@pytest.mark.parametrize("source", [None, 3, "sawframe_2r63", PUMP.mechanism, PUMP.solve(12)])
def test_what_is_no_scene_is_refused(source):
    with pytest.raises(ks.ParameterError, match="source must be a Case"):
        ks.design.optimise(source, VARY, TORQUE)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ks.design.Spread(0.0, {"slider.mass": "normal 0 % +- 1 %"}), "quantile must lie"),
        (lambda: ks.design.Spread(5, {"slider.mass": "normal 0 % +- 1 %"}), "quantile must lie"),
        (lambda: ks.design.Spread(0.05, {}), "spreads must be a dict"),
        (lambda: ks.design.Spread(0.05, None), "spreads must be a dict"),
        (lambda: ks.design.Spread(0.05, {"slider.mass": "1 %"}), "cannot read"),
        (lambda: ks.design.Spread(0.05, {"slider.mass": "normal 0 % +- 1 %"}, samples=100), "power of two"),
        (lambda: ks.design.Spread(0.05, {"slider.mass": "normal 0 % +- 1 %"}, trim=-0.1), "trim must be"),
        (lambda: ks.design.Spread(0.05, {"slider.mass": "normal 0 % +- 1 %"}, trim="3 %"), "trim must be"),
        (lambda: ks.design.Spread(0.05, {"slider.mass": "normal 0 % +- 1 %"}, samples=2**40), "up to 1048576"),
        (lambda: ks.design.Spread(0.05, {"slider.mass": "normal 0 % +- 1 %"}, seed=-1), "seed must be"),
        (lambda: ks.design.over_spread(PUMP, TORQUE, {"slider.mass": "1 %"}), "spread must be a Spread"),
        (lambda: spread({"slider.mass": "normal 0 % +- 1 %"}, count=0), "samples must be a power of two"),
        (lambda: spread({"slider.mass": "normal 0 % +- 1 %"}, count=16.0), "samples must be a power of two"),
        (lambda: spread({"slider.mas": "normal 0 % +- 1 %"}), "did you mean 'slider.mass'"),
        (lambda: spread({"slider.mass": "normal 0 m +- 1 m"}), "does not measure the same"),
        (lambda: spread({"slider.mass": "normal 0 % +- 1 %"}, damped=True, trim=0.1), "trim takes outputs"),
    ],
)
def test_spreads_of_another_form_are_refused(make, message):
    with pytest.raises(ks.ParameterError, match=message):
        make()


def spread(spreads, damped=False, count=16, **options):
    loads = [ks.TorsionDamper(0.1, on="crank")] if damped else []
    scene = ks.Scene(PUMP.mechanism, 100.0, loads=loads)
    return ks.design.over_spread(scene, TORQUE, ks.design.Spread(0.05, spreads, **options), samples=count)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"cosine": 0}, ks.ParameterError, "cosine"),
        ({"cosine": 2.5}, ks.ParameterError, "cosine"),
        ({"sine": -1}, ks.ParameterError, "sine"),
        ({"sine": True}, ks.ParameterError, "sine"),
        ({"cosine": 500}, ks.ParameterError, "cosine must be at most 64"),
        ({"starts": 0}, ks.ParameterError, "starts"),
        ({"starts": "x"}, ks.ParameterError, "starts"),
        ({"seed": -1}, ks.ParameterError, "seed"),
        ({"gravity": "no"}, ks.ParameterError, "gravity must be True or False"),
        ({"guide_offset": "20 mm"}, ks.ParameterError, "guide_offset"),
        ({"vary": 5}, ks.ParameterError, "vary must be a dict"),
        ({"minimise": "harmonic_200 balancing_torque"}, ks.ParameterError, "angles must be at least 401"),
        ({"ends": (0.3, 0.2)}, ks.DesignError, "two ends"),
        ({"ends": (-0.1, 0.2)}, ks.DesignError, "stay ahead of O"),
        ({"ends": (0.1,)}, ks.ParameterError, "ends must be"),
        ({"ends": "far"}, ks.ParameterError, "ends must be"),
        ({"vary": {"coupler_length": (0.3, 0.4)}}, ks.DesignError, "cannot make the stroke"),
        ({"coupler_spring": 1.0}, ks.ParameterError, "none acts"),
        ({"counterweight": 0.0}, ks.ParameterError, "counterweight"),
        ({"counterweight": -1.0}, ks.ParameterError, "counterweight"),
        ({"minimise": "largest"}, ks.ParameterError, "must be a reduction"),
    ],
)
def test_torque_free_cams_that_cannot_be_are_refused(options, error, message):
    with pytest.raises(error, match=message):
        ks.design.torque_free_cam(PUMP, **options)


def test_machine_without_coupler_is_refused():
    bars = ks.Scene(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=ks.Link(1.0)), 10.0)
    with pytest.raises(ks.ParameterError, match="takes a crank-slider"):
        ks.design.torque_free_cam(bars)


def test_a_massless_machine_is_refused():
    with pytest.raises(ks.DesignError, match="needs no torque to begin with"):
        ks.design.torque_free_cam(ks.Scene(ks.crank_slider(0.05, 0.2), 100.0))


@pytest.mark.parametrize("taken", ["sine", "coupler_spring"])
def test_ways_that_are_compared_cannot_be_given_to_all(taken):
    with pytest.raises(ks.ParameterError, match=f"{taken} is one of the ways compared"):
        ks.design.weight_options(PUMP, 2, **{taken: 2})


def test_weight_is_blamed_only_where_it_binds():
    saw = ks.load_case("sawframe_2r63")
    with pytest.raises(ks.DesignError) as caught:
        ks.design.torque_free_cam(saw, 2, limits="largest_absolute cam_force <= 1 N")
    assert "cam_force" in str(caught.value)
    assert "under weight" not in str(caught.value)
