"""What a contact is asked with: numbers told, or those of the scene's roller."""

import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.cam_contacts import STEEL, contact, rolled, solved


def test_what_is_not_told_is_that_of_the_scene_s_own_roller():
    own = solved(machine=rolled((0.05, 0.06, *STEEL, 110e9)))
    found = ks.design.contact(own)
    assert_allclose(found.pressure, own.contact_pressure, rtol=1e-13)
    assert found.modulus == pytest.approx(1.0 / (0.91 / 210e9 + 0.91 / 110e9), rel=1e-15)
    wide = ks.design.contact(own, width=0.24)
    assert_allclose(wide.pressure, own.contact_pressure / 2, rtol=1e-13)
    with pytest.raises(ks.ParameterError, match=r"width, poissons_ratio must be told, as .* has no Roller"):
        ks.design.contact(solved(), 0.05, youngs_modulus=210e9)


def test_a_follower_is_told_how_its_pressure_is_had():
    follower = ks.Mechanism("cam drive", ks.Crank(None), (ks.RollerFollower(ks.laws.cosine(0.01, 0.05)),))
    with pytest.raises(ks.ParameterError, match="give its follower a Roller or Face, then contact_pressure is an"):
        contact(ks.solve(follower, 0.5, crank_speed=1.0))
