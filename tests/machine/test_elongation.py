"""Elongation and departure of sliders, neither of which has the rounding of the travel."""

import numpy as np

import kinetostatics as ks
from kinetostatics.studies.methods.high_precision.enclosures import on_arb
from support.case_files import shipped
from support.every import every

STRAIGHT = np.linspace(5.7, 6.28, 40)
"""Crank angles at which the toggle of the toggle press is nearly straight."""
ENDS = np.r_[-0.3:0.3:30j]
WAYS = {
    "out": (ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), ENDS),
    "offset": (ks.crank_slider(0.05, 0.2, guide_offset=0.004, slider=ks.Link(1.0)), ENDS),
    "behind": (ks.crank_slider(0.05, 0.2, assembly=-1, slider=ks.Link(1.0)), ENDS + np.pi),
    "inclined": (ks.crank_slider(0.05, 0.2, guide=ks.Guide.at(0.4), slider=ks.Link(1.0)), ENDS + 0.4),
}


def off(found, exact):
    """Largest difference of numbers from exact ones."""
    return max(abs(float(one - float(other))) for one, other in zip(exact, found, strict=True))


@every("name", [*WAYS, "toggle"])
def test_elongation_near_dead_centre_is_exact(name, flint):
    """Its error is less than half that of their difference, where it is counted from a place near the dead centre."""
    scene, turn = shipped("toggle_press").variants["idle"].scene, STRAIGHT
    if name in WAYS:
        mechanism, turn = WAYS[name]
        scene = ks.Scene(mechanism, 30.0)
    s = scene.solve(turn)
    slider = s.mechanism.slider or "slider2"
    free = float(s.travel(slider)[0])
    exact = on_arb(flint.arb, s).elongation(flint.arb(free), slider)
    assert off(s.elongation(free, slider), exact) < 0.5 * off(s.travel(slider) - free, exact)


@every("name", WAYS)
def test_departure_is_curvature_plus_elongation(name, flint):
    """On a pin of the crank, from the coupler alone."""
    mechanism, turn = WAYS[name]
    s = ks.Scene(mechanism, 30.0).solve(turn)
    (group,) = mechanism.groups
    free = group.side * 0.2
    run = on_arb(flint.arb, s)
    exact = run.mechanism.groups[0].departure(run.placement, flint.arb(free))
    by_parts = run.placement.travels["slider"].second + run.elongation(flint.arb(free))
    assert max(abs(float(one - other)) for one, other in zip(exact, by_parts, strict=True)) < 1e-50
    assert off(group.departure(s.dynamics.placement, free), exact) < 1e-17


def test_own_cam_beside_a_harmonic_one_counts():
    class Larger(ks.cams.Harmonic):
        """By a millimetre."""

        def polar(self, angle, ray):
            radius, *derivatives = super().polar(angle, ray)
            return radius + 1e-3, *derivatives

    spring = [ks.Spring(2e5, 2.0, cubic=1e7)]
    given = (0.27, -0.012, 0.024), (0.0002,)
    own, plain = (
        ks.Scene(ks.cam_crank_slider(cam, 2.01, slider=ks.Link(600.0)), 33.5, 0.0, spring).solve(36)
        for cam in (Larger(*given), ks.cams.Harmonic((0.271, *given[0][1:]), given[1]))
    )
    np.testing.assert_allclose(own.reaction("B"), plain.reaction("B"), rtol=0.0, atol=1e-13 * own.largest_force_term)
