"""Contact pressure of a solution, by name."""

import numpy as np
import pytest

import kinetostatics as ks
from support.cam_contacts import rolled, solved

FACE = ks.Face(0.02, 210e9, 0.3)


def test_a_pressure_is_read_by_name_and_kept():
    found = solved(machine=rolled())
    assert found.pressure() is found.contact_pressure
    assert found.pressure("contact_pressure") is found.contact_pressure


def test_that_of_a_second_follower_has_its_label():
    groups = [ks.FlatFollower(ks.laws.cosine(0.01, 0.05), face=FACE, pin=f"F{n}", label=n) for n in ("1", "2")]
    loads = [ks.Spring(k, -0.05, on=f"follower{n}") for n, k in (("1", 5e4), ("2", 2e5))]
    machine = ks.Mechanism("two cams", ks.Crank(None), tuple(groups))
    found = ks.solve(machine, 0.5, crank_speed=0.0, loads=loads)
    assert found.pressure("contact_pressure2") == pytest.approx(2 * found.pressure("contact_pressure1"), rel=1e-13)
    with pytest.raises(ks.QuantityError, match="contact is 'contact_pressure', allowed: 'contact_pressure1', 'con"):
        found.contact_pressure  # noqa: B018


def test_a_quantity_of_another_kind_is_no_pressure():
    with pytest.raises(ks.QuantityError, match="contact is 'O', allowed: 'contact_pressure'"):
        solved(machine=rolled()).pressure("O")
    with pytest.raises(ks.QuantityError, match="has no contact pressure"):
        ks.solve(ks.crank_slider(0.1, 0.4), np.zeros(2), crank_speed=1.0).contact_pressure  # noqa: B018


def test_what_is_no_name_is_no_pressure():
    with pytest.raises(ks.ParameterError, match="quantity must be a name"):
        solved(machine=rolled()).pressure([])
