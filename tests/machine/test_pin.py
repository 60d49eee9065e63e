"""Pins on any link: rigid-body motion, forces and couples handed to the link, several rods on one pin, names."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kinetostatics as ks
from kinetostatics.errors import ParameterError
from support.chains import error_beside_constraints
from support.every import every, quick
from support.machines import planar
from support.strategies import reproducible

ANGLES = np.linspace(0.1, 6.2, 9)
ROD, PISTON = ks.Link(2.0, (0.2, 0.03), 0.05), ks.Link(3.0, (0.02, -0.04), 0.1)
CASTING = ks.Link(2.0, (0.05, 0.01), 0.1)


def solve(*parts, crank=None, **options):
    made = ks.Mechanism("chain", crank or ks.Crank(0.1, CASTING), parts)
    motion = {"crank_speed": 20.0, "crank_acceleration": -30.0, "loads": [ks.Gravity(9.81, -1.2)]} | options
    return ks.solve(made, ANGLES, **motion)


def test_a_pin_moves_with_its_link():
    at = 0.13 - 0.07j
    s = solve(ks.SliderGroup(0.4, coupler=ROD), ks.Pin(on="coupler", at=(at.real, at.imag)))
    arm = at * planar(np.array(s.placement.links["coupler"].direction))
    rate, change = s.rate("coupler"), s.angular_acceleration("coupler")
    for order, expected in {
        "position": planar(s.position("A")) + arm,
        "velocity": planar(s.velocity("A")) + 1j * rate * arm,
        "acceleration": planar(s.acceleration("A")) + (1j * change - rate**2) * arm,
    }.items():
        assert np.max(np.abs(planar(getattr(s, order)("C")) - expected)) < 1e-14 * np.max(np.abs(expected))


def test_a_pin_where_a_joint_is_changes_nothing():
    rod = {"coupler_length": 0.4, "coupler": ROD, "slider": PISTON}
    plain = solve(ks.SliderGroup(**rod))
    pinned = solve(ks.Pin(on="crank", at=(0.1, 0.0)), ks.SliderGroup(**rod, on="C"))
    assert np.max(np.abs(plain.balancing_torque - pinned.balancing_torque)) < 1e-15 * np.max(
        np.abs(plain.reaction("O"))
    )
    assert np.max(np.abs(plain.reaction("A") - pinned.reaction("C"))) < 1e-15 * np.max(np.abs(plain.reaction("A")))


def test_two_rods_on_one_pin_load_it_together():
    """The crank of a V bears what each bank alone makes it bear, less what it bears alone."""
    banks = [
        ks.SliderGroup(0.4, ks.Guide.at(angle), 1, ROD, PISTON, "A", pin, label)
        for angle, pin, label in ((np.pi / 4, "B", "1"), (3 * np.pi / 4, "C", "2"))
    ]
    both, crank = solve(*banks), solve()
    first, second = (solve(bank) for bank in banks)
    for name in ("O", "balancing_torque"):
        whole, *parts, bare = (
            s.reaction(name) if name == "O" else s.scalar(name) for s in (both, first, second, crank)
        )
        assert np.max(np.abs(sum(parts) - bare - whole)) < 1e-13 * np.max(np.abs(whole))
    assert np.max(np.abs(both.reaction("A2") - second.reaction("A2"))) < 1e-14 * np.max(np.abs(both.reaction("A2")))


@pytest.mark.parametrize(
    "link", quick(["crank", "coupler", "dyad1", "block", "rod", "slider", "rocker", "dyad2", "lever", "cylinder"], 5)
)
def test_any_link_bears_what_hangs_on_a_pin(link):
    parts = {
        "slider": (ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.05), 1, ROD, PISTON),),
        "rocker": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1), 1, ROD, PISTON),),
        "dyad2": (ks.Dyad(0.4, 0.3, ("A", "E"), "D", 1, ROD, PISTON),),
        "lever": (ks.LeverGroup((0.1, -0.3), lever=ROD, block=PISTON),),
        "cylinder": (ks.CylinderGroup((0.1, -0.3), rod=ROD, cylinder=PISTON),),
    }
    hung = {"crank": "slider", "coupler": "rocker", "dyad1": "dyad2", "block": "lever", "rod": "cylinder"}
    s = solve(
        ks.Pin(on="crank", at=(-0.05, 0.1), name="E"),
        *parts[hung.get(link, link)],
        ks.Pin(on=link, at=(0.06, -0.09), name="P"),
        ks.SliderGroup(0.9, ks.Guide.at(0.8, 0.05), 1, ROD, PISTON, "P", "F", "2"),
        ks.LeverGroup((0.9, 1.5), "P", 0.02, ROD, PISTON, "O3", "3"),
    )
    assert error_beside_constraints(s) < 1e-13
    assert s.power_residual < 1e-13


@pytest.mark.slow
@every("link", ["crank", "block"])
def test_slotted_crank_bears_what_hangs_on_a_pin(link):
    s = solve(
        ks.CamRoller(ks.cams.Circle(0.3, (0.05, -0.03)), PISTON),
        ks.Pin(on=link, at=(0.06, -0.09), name="P"),
        ks.SliderGroup(0.9, ks.Guide.at(0.8, 0.05), 1, ROD, PISTON, "P"),
        ks.CylinderGroup((0.9, 1.5), "A", ROD, PISTON, label="3"),
        crank=ks.Crank(None, CASTING),
    )
    assert error_beside_constraints(s) < 1e-13
    assert s.power_residual < 1e-13


@pytest.mark.slow
@reproducible
@given(offset=st.floats(-3.0, 3.0), radius=st.floats(0.02, 0.1), length=st.floats(0.25, 0.5))
def test_articulated_rod_meets_the_guide(offset, radius, length):
    """Slave rod of a master coupler: its pin turns with the master rod, its piston stays on the other bank."""
    bank = np.exp(1j * np.pi / 3)
    s = solve(
        ks.SliderGroup(0.4),
        ks.Pin(on="coupler", at=(radius * np.cos(offset), radius * np.sin(offset))),
        ks.SliderGroup(length, ks.Guide.at(np.pi / 3), on="C", pin="D", label="2"),
    )
    A = 0.1 * np.exp(1j * ANGLES)
    master = np.exp(-1j * np.arcsin(A.imag / 0.4))
    pin = (A + radius * np.exp(1j * offset) * master) / bank
    expected = pin.real + np.sqrt(length**2 - pin.imag**2)
    assert np.max(np.abs(s.travel("slider2") - expected)) < 1e-14


# What is refused


BARS = ks.RockerGroup(0.4, 0.3, (0.3, 0.1))


@every(
    "first, second, words",
    [
        (BARS, ks.Pin("couplr", (0.1, 0.0)), "link that carries joint 'C' is 'couplr', allowed: .*'crank', 'coupler'"),
        (ks.Pin("coupler", (0.1, 0.0)), BARS, "a part that adds a link must come before the parts fixed to it"),
        (ks.Pin("crank", (0.1, 0.0)), ks.Pin("crank", (0.0, 0.1)), "Pin adds joint 'C' a second time"),
        (ks.SliderGroup(0.4), ks.CylinderGroup((0.3, 0.3)), "adds reaction 'A' a second time"),
        (BARS, ks.SliderGroup(0.9, on="B", pin="B2", label="2"), "adds reaction 'B2' a second time"),
        (BARS, ks.LeverGroup((0.5, 0.5), on="B", pivot_name="B2", label="2"), "adds reaction 'B2' a second time"),
    ],
)
def test_names_that_do_not_fit_are_refused(first, second, words):
    """Pin "B2" of one group beside label "2" on "B" of another: both would be reaction "B2"."""
    with pytest.raises(ParameterError, match=words):
        ks.Mechanism("chain", ks.Crank(0.1), (first, second))


@every(
    "fields, words",
    [
        ({"at": (np.nan, 0.0)}, "at along must be finite"),
        ({"at": 0.1}, "at must be a pair"),
        ({"at": ("0.1", 0.0)}, "at along must be a number"),
        ({"on": ""}, "on must be a name"),
        ({"name": None}, "name must be a name"),
    ],
)
def test_what_no_pin_can_have_is_refused(fields, words):
    with pytest.raises(ParameterError, match=f"pin: {words}"):
        ks.Pin(**{"on": "crank", "at": (0.1, 0.0)} | fields)
