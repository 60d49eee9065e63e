"""Two-cylinder engines: shaking forces of reciprocating masses by harmonics, balance, and articulated rods.

The reciprocating mass m of a cylinder moves by the series (Biezeno and Grammel, *Technische Dynamik*; lambda = r / l)

    m r omega^2 (cos phi + A2 cos 2 phi - A4 cos 4 phi + ...)
    A2 = lambda + lambda^3 / 4 + 15 lambda^5 / 128 + 35 lambda^7 / 512 + ...

In a V of 90 degrees with both rods on one pin the first harmonics of both banks make a force of constant size
m r omega^2 along the crank, which a counterweight balances; the second make one across the V of
sqrt(2) m r omega^2 A2 sin(2 phi).
"""

import numpy as np
import pytest

import kinetostatics as ks
from support.machines import second_harmonic

R, ROD, MASS, SPEED = 0.05, 0.16, 1.3, 200.0
ANGLES = np.linspace(0.0, 2 * np.pi, 64, endpoint=False)
UNIT = MASS * R * SPEED**2


def engine(banks, pins=("A", "A"), crank=ks.Link(), **rods):
    """Cylinders of two banks at their angles from +x."""
    groups = [
        ks.SliderGroup(ROD, ks.Guide.at(angle), on=on, pin=f"B{label}", label=label, slider=ks.Link(MASS), **rods)
        for label, angle, on in zip(("_1", "_2"), banks, pins, strict=True)
    ]
    second = [ks.Pin(on="crank", at=(-R, 0.0))] if "C" in pins else []
    return ks.Mechanism("engine", ks.Crank(R, crank), (*second, *groups))


def shaking(made):
    s = ks.solve(made, ANGLES, crank_speed=SPEED)
    force = s.shaking_force
    return force[0] + 1j * force[1]


def harmonic(values, order):
    """Cosine and sine coefficient of a harmonic, complex as the values are."""
    return 2 * np.mean(values * np.cos(order * ANGLES)), 2 * np.mean(values * np.sin(order * ANGLES))


V90 = (np.pi / 4, 3 * np.pi / 4)


def test_the_series_is_that_of_the_books():
    ratio = 0.3
    few = ratio + ratio**3 / 4 + 15 * ratio**5 / 128 + 35 * ratio**7 / 512
    assert second_harmonic(ratio) == pytest.approx(few, rel=1e-5)


def test_first_harmonic_of_a_v_90_turns_with_crank():
    cosine, sine = harmonic(shaking(engine(V90)), 1)
    assert cosine == pytest.approx(UNIT, rel=1e-13)
    assert sine == pytest.approx(1j * UNIT, rel=1e-13)


def test_second_harmonic_of_a_v_90_is_across():
    cosine, sine = harmonic(shaking(engine(V90)), 2)
    size = np.sqrt(2) * UNIT * second_harmonic(R / ROD)
    assert abs(cosine) < 1e-13 * UNIT
    assert sine == pytest.approx(size, rel=1e-13)


def test_crank_counterweight_leaves_even_harmonics():
    balanced = shaking(engine(V90, crank=ks.Link(MASS, -R)))
    for order in (1, 3, 5):
        assert max(map(abs, harmonic(balanced, order))) < 1e-13 * UNIT
    largest = np.max(np.abs(balanced))
    assert largest < 0.5 * UNIT
    assert np.max(np.abs(shaking(engine(V90)))) > UNIT


def test_opposed_in_line_pair_has_even_harmonics():
    force = shaking(engine((0.0, 0.0), ("A", "C")))
    for order in (1, 3, 5):
        assert max(map(abs, harmonic(force, order))) < 1e-13 * UNIT
    assert harmonic(force, 2)[0] == pytest.approx(2 * UNIT * second_harmonic(R / ROD), rel=1e-13)


def test_boxer_has_no_shaking_force():
    force = shaking(engine((0.0, np.pi), ("A", "C")))
    assert np.max(np.abs(force)) < 1e-13 * UNIT


def test_two_mass_rods_balance_by_their_masses():
    """A rod with its mass centre on the line and the inertia m a b is two point masses."""
    m, a = 0.8, 0.05
    rod = ks.Link(m, a, m * a * (ROD - a))
    cosine, _ = harmonic(shaking(engine(V90, coupler=rod)), 1)
    on_pin, on_piston = m * (ROD - a) / ROD, m * a / ROD
    assert cosine == pytest.approx((2 * on_pin + on_piston + MASS) * R * SPEED**2, rel=1e-13)


def test_articulated_rod_on_the_pin_is_plain():
    """Its dead centres are where the crank is not on the bank's line: the boss leans with the master rod."""
    bank, boss = np.pi / 3, 0.03

    def slave(boss, angles=ANGLES):
        parts = (
            ks.SliderGroup(ROD),
            ks.Pin(on="coupler", at=(boss * np.cos(bank), boss * np.sin(bank))),
            ks.SliderGroup(ROD - boss, ks.Guide.at(bank), on="C", pin="D", label="2"),
        )
        return ks.solve(ks.Mechanism("radial", ks.Crank(R), parts), angles, crank_speed=1.0)

    plain = ks.solve(engine((0.0, bank)), ANGLES, crank_speed=1.0)
    assert np.max(np.abs(slave(0.0).travel("slider2") - plain.travel("slider_2"))) < 1e-15
    lean = -np.arcsin(R / ROD * np.sin(bank))  # of the master rod when the crank is on the bank's line
    ratio = -R * np.cos(bank) / (ROD * np.cos(lean))
    height, rise = boss * np.sin(lean), R + boss * ratio * np.cos(lean)  # of the boss over the bank's line
    velocity = -boss * ratio * np.sin(lean) - height * rise / np.sqrt((ROD - boss) ** 2 - height**2)
    assert slave(boss, bank).travel_velocity("slider2") == pytest.approx(velocity, rel=1e-13)
    assert abs(velocity) > 0.02 * R
