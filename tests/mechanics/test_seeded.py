"""Solutions on numbers with derivatives: those by the crank angle and by a length are known in closed form."""

import numpy as np

import kinetostatics as ks
from kinetostatics.mechanics.seeded import Seeded, number_of

ANGLES = np.linspace(0.1, 6.2, 7)


def seeded(mechanism, **options):
    return Seeded(ks.solve(mechanism, ANGLES, crank_speed=5.0, **options).dynamics, np.arange(ANGLES.size))


def test_of_a_crank_derivatives_are_by_the_logarithm_of_angle_and_length():
    placement = seeded(ks.crank_slider(0.3, 2.0, slider=ks.Link(5.0))).solution.placement
    x = number_of(placement.joints["A"].position[0])
    np.testing.assert_allclose(x.value, 0.3 * np.cos(ANGLES), rtol=1e-15)
    by = [row for row in x.slopes if row.any()]
    expected = -0.3 * ANGLES * np.sin(ANGLES), 0.3 * np.cos(ANGLES)
    assert len(by) == 2
    for row, right in zip(by, expected, strict=True):
        np.testing.assert_allclose(row, right, rtol=1e-14)


def test_positions_grow_with_all_lengths_together():
    """Derivatives by the logarithms of all lengths, of the load's too, add up to the position itself (Euler)."""
    made = seeded(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)))
    angle = number_of(made.solution.crank_angle).slopes
    for part in made.solution.placement.joints["B"].position:
        found = number_of(part)
        lengths = found.slopes[~angle.any(axis=1)].sum(axis=0)
        np.testing.assert_allclose(lengths, found.value, rtol=1e-13)


def test_what_is_absent_is_zero():
    assert number_of(None).value == 0.0
    assert number_of(None).slopes is None
