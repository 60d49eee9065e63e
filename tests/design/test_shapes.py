"""Which everyday mechanism it is, read off its bars whatever they are called."""

import kinetostatics as ks
from kinetostatics.design import shapes

FOUR_BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
PUMP = ks.crank_slider(0.1, 0.4)
V = ks.Mechanism("V", ks.Crank(0.1), (ks.SliderGroup(0.4), ks.SliderGroup(0.5, ks.Guide.at(1.0), pin="C", label="2")))
SIX_BAR = ks.Mechanism("six", FOUR_BAR.crank, (*FOUR_BAR.groups, ks.SliderGroup(0.6, on="B", pin="C", label="2")))


def test_a_four_bar_is_known_with_its_pivot_and_nothing_else_is_one():
    found = shapes.four_bar(FOUR_BAR)
    assert [bar.link for bar in found[:3]] == ["crank", "coupler", "rocker"]
    assert found.pivot == (0.35, 0.1)
    assert [shapes.four_bar(item) for item in (PUMP, V, SIX_BAR)] == [None] * 3


def test_crank_sliders_are_those_whose_coupler_hangs_on_the_crank():
    assert [item.slider for item in shapes.crank_sliders(PUMP)] == ["slider"]
    assert [item.slider for item in shapes.crank_sliders(V)] == ["slider", "slider2"]
    assert shapes.crank_sliders(SIX_BAR) == ()
