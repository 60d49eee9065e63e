"""Designs in case files that are wrong: each named with its key, what is allowed, and all at once."""

import pytest

import kinetostatics as ks
from support.case_files import saw_with

INTRO = '[design.one]\nkind = "optimum"\nvariant = "cam-circle"\n'
VARY = 'vary = { "spring.stiffness" = ["600 kN/m", "900 kN/m"] }\n'
AIM = 'minimise = "largest O"\n'
CAM = '[design.one]\nkind = "torque-free-cam"\nvariant = "cam-cosine"\n'
SPREADS = '"slider.mass" = "normal 0 % +- 1 %"'
WRONG_DESIGNS = {
    "no table": ("[design]\none = 3\n", "design.one must be a table of keys and values, found 3"),
    "no kind": ("[design.one]\n", "design.one.kind is missing; allowed: 'optimum', 'torque-free-cam', 'front'"),
    "kind misspelt": (
        f"{INTRO}{VARY}{AIM}".replace("optimum", "optimun"),
        "design.one.kind is 'optimun', allowed: 'optimum'",
    ),
    "key misspelt": (f"{INTRO}{VARY}{AIM}limit = []\n", "design.one.limit is not a key here; did you mean 'limits'?"),
    "key of another kind": (f"{INTRO}{VARY}{AIM}cosine = 3\n", "design.one.cosine is not a key here"),
    "nothing varies": (f"{INTRO}{AIM}", "design.one.vary is missing"),
    "no aim": (f"{INTRO}{VARY}", "design.one needs either minimise or maximise"),
    "variant not there": (
        f'[design.one]\nkind = "optimum"\nvariant = "cam-circl"\n{VARY}{AIM}',
        "design.one.variant is 'cam-circl', allowed: 'plain', 'cam-circle', 'cam-cosine'; did you mean 'cam-circle'?",
    ),
    "reference not there": (f'{INTRO}{VARY}{AIM}reference = "plane"\n', "design.one.reference is 'plane', allowed"),
    "variant is itself": (
        '[design.cam-circle]\nkind = "torque-free-cam"\nvariant = "cam-circle"\n',
        "design.cam-circle.variant is what it is to find: give another",
    ),
    "number not there": (
        f'{INTRO}{AIM}vary = {{ "spring.stifness" = ["6 N/m", "9 N/m"] }}\n',
        "design.one.vary: parameter is 'spring.stifness', allowed",
    ),
    "bounds fall": (
        f'{INTRO}{AIM}vary = {{ "spring.stiffness" = ["9 N/m", "6 N/m"] }}\n',
        "design.one.vary: bounds of spring.stiffness must be (low, high), got ('9 N/m', '6 N/m'): they must be finite",
    ),
    "bounds of another unit": (
        f'{INTRO}{AIM}vary = {{ "spring.stiffness" = ["9 N", "60 N"] }}\n',
        '"N" does not measure the same as "N/m"',
    ),
    "output misspelt": (f'{INTRO}{VARY}minimise = "largest Q"\n', "design.one.minimise: cam-balanced crank-slider: "),
    "output a place": (
        f'{INTRO}{VARY}minimise = "largest_at O"\n',
        "design.one.minimise: output 'largest_at O' is a pl",
    ),
    "limit of no form": (
        f'{INTRO}{VARY}{AIM}limits = ["largest O < 3 kN"]\n',
        "design.one.limits[1]: limit 'largest O < 3 kN' must be an output, a relation and a value",
    ),
    "limit of another unit": (
        f'{INTRO}{VARY}{AIM}limits = ["mean O <= 3 kN", "largest O <= 3 m"]\n',
        'design.one.limits[2]: limit \'largest O <= 3 m\': "m" does not measure the same as "N"',
    ),
    "no counterweight": (f'{CAM}counterweight = "0 kg"\n', "design.one: counterweight must be greater than 0, got 0.0"),
    "limits a text": (
        f'{INTRO}{VARY}{AIM}limits = "largest O <= 3 kN"\n',
        "design.one.limits: input should be a valid t",
    ),
    "ratio to what the reference has not": (
        f'{INTRO}{VARY}maximise = "ratio largest cam_force"\n',
        "design.one.maximise: crank-slider: quantity is 'cam_force', allowed",
    ),
    "starts none": (f"{INTRO}{VARY}{AIM}starts = 0\n", "design.one.starts: input should be greater than or equal to 1"),
    "starts a million": (f"{INTRO}{VARY}{AIM}starts = 1000000\n", "design.one.starts: input should be less than or"),
    "seed below 0": (f"{INTRO}{VARY}{AIM}seed = -1\n", "design.one.seed: input should be greater than or equal to 0"),
    "angles few": (f"{INTRO}{VARY}{AIM}angles = 3\n", "design.one.angles: input should be greater than or equal to 12"),
    "harmonics none": (f"{CAM}cosine = 0\n", "design.one.cosine: input should be greater than or equal to 1, found 0"),
    "harmonics half": (f"{CAM}sine = 2.5\n", "design.one.sine: input should be a valid integer"),
    "ends one": (f'{CAM}ends = ["1.7 m"]\n', "design.one.ends must be a pair"),
    "ends without unit": (f"{CAM}ends = [1.7, 2.3]\n", "design.one.ends must be text of a number and a unit"),
    "counterweight below 0": (f'{CAM}counterweight = "-3 kg"\n', "design.one.counterweight must be at least 0 kg"),
    "coupler spring on the wrong side": (
        f'{CAM}coupler_spring = "90 deg"\n',
        "design.one: coupler_spring, a free angle, must be negative, got 1.5708 rad",
    ),
    "quantile beyond 1": (
        f"{CAM}robust = {{ quantile = 2.0, spreads = {{ {SPREADS} }} }}\n",
        "design.one.robust is no spread: quantile must lie between 0 and 1, got 2.0",
    ),
    "spread of what is not there": (
        f'{CAM}robust = {{ quantile = 0.1, spreads = {{ "slider.mas" = "normal 0 % +- 1 %" }} }}\n',
        "design.one.robust.spreads: parameter is 'slider.mas', allowed",
    ),
    "spread of no form": (
        f'{CAM}robust = {{ quantile = 0.1, spreads = {{ "slider.mass" = "1 %" }} }}\n',
        "design.one.robust is no spread: cannot read '1 %' for slider.mass",
    ),
    "front of one": (f'[design.one]\nkind = "front"\n{VARY}minimise = ["largest O"]\n', "design.one.minimise: "),
}


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    ks.load_case("sawframe_2r63")


@pytest.mark.parametrize("name", WRONG_DESIGNS)
def test_a_wrong_design_is_told_with_its_key(tmp_path, name):
    text, message = WRONG_DESIGNS[name]
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(saw_with(text, tmp_path))
    assert len(caught.value.problems) == 1
    assert message in caught.value.problems[0]


def test_problems_of_all_designs_are_told_at_once(tmp_path):
    some = ("kind misspelt", "number not there", "limit of no form", "harmonics none", "quantile beyond 1")
    text = "".join(
        WRONG_DESIGNS[name][0].replace("[design.one", f"[design.{place}")
        for place, name in zip("abcde", some, strict=True)
    )
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(saw_with(text, tmp_path))
    assert [problem.split(".")[1][0] for problem in caught.value.problems] == list("abcde")
