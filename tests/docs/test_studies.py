"""Each figure of the studies is drawn, with its number on it; what pages compute is asserted when they are built."""

import re

import pytest

from support import pages

pytestmark = pages.needed
FIGURES = {
    "sawframe": {"3", "5", "6a", "6b", "7a", "7b"},
    "mower": {"2", "5a", "5b", "6a", "6b"},
    "chain_unit": {"5", "6", "7", "8", "9", "10", "11", "12"},
}


@pytest.mark.parametrize("name", ["sawframe", "mower"])
def test_study_page_draws_its_figures_and_numbers(name):
    code = "\n".join(pages.cells(f"studies/{name}.md"))
    titles = re.findall(r'set_title\(f?"figure (\w+)', code) + re.findall(r'"(\d[ab])[,:]', code)
    for letters in re.findall(r'zip\(axes, "(ab)"', code):
        titles += [f"6{letter}" for letter in letters]
    assert set(titles) >= FIGURES[name]


@pytest.mark.parametrize("name", FIGURES)
def test_a_page_asserts_what_it_shows(name):
    code = "\n".join(pages.cells(f"studies/{name}.md"))
    assert code.count("assert ") >= 2
    compile(code, name, "exec")


# Claims of the studies, one by one: ours, computed by the cells of the pages

CLAIMS = {
    "sawframe": {
        "mean dynamic coefficient 6.77": ("false", "6.08"),
        "coefficients of extrema 6.2, 7.55, 8.13, 6.42": ("false", "6.37, 5.50, 5.73, 6.60"),
        "support reaction about 12 times smaller": ("true", "12.9 times"),
        "a coupler of 2.0219 m gives the cosine law": ("true", "2.0219052 m"),
        "the profile that gives it is a circle": (
            "false",
            "2.40 mm off the study's, 1.20 mm off the best circle, R = 298.80, a = 21.91 mm",
        ),
        "figure 3: acceleration within 1 %": ("false", "2.1 % of the amplitude, 1.06 % of the range"),
        "(velocity, position within 1 %)": ("true", "0.83 %, 0.41 % of the amplitude"),
        "cam force almost 5 tf": ("false, by 2 %", "49.9 kN = 5.09 tf"),
        "the cam force acts at support O as well as at pin A": ("false", "A 49.9, O 22.3 kN"),
        "coupler's inertia force between 25 and 54 kN": ("true", "25.3 to 53.9 kN"),
        "three extrema in a cycle": ("false", "4"),
        "the coupler's inertia does the harm": ("true", "19.15 of the 19.68 kN at O"),
        "the slider can be balanced wholly": (
            "true at one speed",
            "massless coupler 0 kN at O; at 1 % more speed 2.0 %",
        ),
        "less drive power": ("true with friction", "42.8 and 13.1 kW (plain bearings), 10.7 and 7.8 kW (rolling"),
        "smoother running": ("true", "3.18 and 0.61 %"),
        "smaller foundation, less noise": (
            "false",
            "frame 252 against 287 kN, -12 %; once a turn 253.11 against 252.66 kN (252.68 with the cam of k_d 411); "
            "with springs of 300 kg 301.6 kN",
        ),
    },
    "mower": {
        "table 1": ("true", "45 of 45"),
        "largest force smaller by 22.2, 29.7, 56.7 %": ("false", "22.27, 29.81, 56.56 %"),
        "full balancing takes the whole force away": ("true", "0 of 1235 N"),
        "at several times the mass of all moving links": ("true", "48.8 kg on links of 8 kg: 6.1 times"),
        "full balancing loads the joints more": ("true at A", "O 1012 against 1236 N, A 5853 against 1161 N"),
        "case 1 asks least of the crank's counterweight, case 2 most": ("true", "69.7, 285.0, 177.3 kg mm"),
        "without offset case 1 keeps S on the guide": ("true", "a straight line of 45.1748 mm, 0.0000 mm across"),
        "without offset the chord of case 2's arc about O is square to the guide": (
            "true",
            "radius 124.54 mm = h2, chord 31.55 mm, height 1.003 mm",
        ),
        "without offset case 3 lies strictly in a square of 2 h1": (
            "true",
            "18.6860 x 18.6860 mm, 2 h1 = 18.6860 mm; with 20 mm of offset 18.863 x 18.686 mm",
        ),
        "the offset gives some more stroke and speed of the knife": (
            "true",
            "stroke 76.172 against 76.000 mm, +0.23 %; speed 2.432 against 2.407 m/s, +1.1 %",
        ),
        "its function finds the slider in any position of the guide": ("false", "within 1e-14 rad of dead centres"),
    },
    "chain_unit": {
        "asymmetry 0.9 and 0.56": ("true", "0.90436, 0.55778"),
        "amplitude 6.88 times as large": ("true", "6.88552"),
        "rocker speed 7.58 times as large": ("true", "7.58599"),
        "with the crank, rho 0.1 to 0.5, swing and asymmetry grow": (
            "true",
            "17.3, 44.0, 53.5, 97.2 degrees, eta 0.904, 0.772, 0.730, 0.558 at rho 0.1, 0.25, 0.3, 0.5",
        ),
        "longer and faster cranks take more power": ("true with a viscous load", "2.2, 8.9, 14.6, 58.6 W"),
        "equations (11)-(14), (19)-(22) give the accelerations": ("true", "of the largest"),
        "high accuracy at any time": ("true for cranks shorter than the frame", "180 degrees off at 41 % of the turn"),
    },
}


def claims(name):
    """The table of a page, by its own cells: what they import and solve, and the claims."""
    code = pages.cells(f"studies/{name}.md")
    names: dict = {}
    for cell in [code[0], *(cell for cell in code if "law = " in cell or "claims = " in cell)]:
        exec(compile(cell, name, "exec"), names)
    return names["claims"]


@pytest.mark.slow
@pytest.mark.parametrize("name", CLAIMS)
def test_each_claim_of_a_study_has_its_number(name):
    table = claims(name)
    assert list(table.index) == list(CLAIMS[name])
    for claim, (verdict, ours) in CLAIMS[name].items():
        assert table.loc[claim, "verdict"].startswith(verdict), claim
        assert ours in table.loc[claim, "ours"], claim
