"""Suggestions come from declared synonyms, and from spelling where there are none."""

import pytest

import kinetostatics as ks
from kinetostatics.numbers.checks.messages import SYNONYMS, nearest
from kinetostatics.results.reductions import FOUND
from support.every import every

SCENE = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
FOUR_BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.4, 0.0))
QUANTITIES = ("balancing_torque", "guide_force", "load_torque", "slider_position", "A", "B", "O")


def test_synonyms_are_of_words_that_the_library_has():
    made = SCENE.mechanism, FOUR_BAR
    known = {"compiled", "numpy", "jax", *FOUND, *SCENE.parameters, *QUANTITIES, *ks.__all__, "slider_velocity"}
    known |= {"slider_acceleration"}.union(*(mechanism.links for mechanism in made))
    assert SYNONYMS.keys() <= known


@every(
    ("word", "allowed", "meant"),
    [
        ("numba", ("numpy", "compiled"), "compiled"),
        ("NumPy", ("numpy", "compiled"), "numpy"),
        ("torque", QUANTITIES, "balancing_torque"),
        ("max O", QUANTITIES, "O"),
        ("piston_pin", QUANTITIES, "B"),
        ("o", QUANTITIES, "O"),
        ("|O|", QUANTITIES, "O"),
        ("crank_length (mm)", ("crank_length", "coupler_length"), "crank_length"),
        ("crank_length [mm]", ("crank_length", "coupler_length"), "crank_length"),
        ("rod.mass", tuple(SCENE.parameters), "coupler.mass"),
        ("rod2.mass", ("coupler.mass", "coupler2.mass"), "coupler2.mass"),
        ("rpm", tuple(SCENE.parameters), "crank_speed"),
        ("max", FOUND, "largest"),
        ("argmax", FOUND, "largest_at"),
        ("larges", FOUND, "largest"),
        ("zzz", FOUND, None),
        (3, FOUND, None),
        ("", FOUND, None),
    ],
)
def test_what_is_meant_is_found(word, allowed, meant):
    assert nearest(word, allowed) == meant


@every(
    ("wrong", "told"),
    [
        (lambda: SCENE.solve(3, engine="numba"), "did you mean 'compiled'"),
        (lambda: ks.extremes(SCENE.solve(3), "torque"), "did you mean 'balancing_torque'"),
        (lambda: ks.extremes(SCENE.solve(3), "max O"), "did you mean 'O'"),
        (lambda: SCENE.varied({"rod_length (mm)": 3.0}), "did you mean 'coupler_length'"),
        (lambda: ks.design.optimise(SCENE, vary={"crank_length": (0.2, 0.4)}, minimise="max O"), "mean 'largest O'"),
        (
            lambda: ks.design.optimise(SCENE, vary={"crank_length": (0.2, 0.4)}, minimise="ratio peak O"),
            "mean 'ratio largest O'",
        ),
    ],
)
def test_errors_ask_for_what_is_meant(wrong, told):
    with pytest.raises(ks.KinetostaticsError) as caught:
        wrong()
    assert told in str(caught.value)
