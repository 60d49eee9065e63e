"""The crank, and what is derived from it."""

from dataclasses import dataclass

import numpy as np
import pytest

import kinetostatics as ks


@dataclass(frozen=True, eq=False)
class Forgetful(ks.Crank):
    """A crank that leaves out the torque it declares."""

    def resolve(self, placement, loads, along):
        """All but the torque."""
        return super().resolve(placement, loads, along)._replace(scalars={})


def test_a_class_derived_from_the_librarys_crank_is_not_trusted_but_looked_at():
    groups = (ks.SliderGroup(2.0, slider=ks.Link(600.0)),)
    assert ks.Mechanism("own", ks.Crank(0.3), groups).trusted
    own = ks.Mechanism("own", Forgetful(0.3), groups)
    assert not own.trusted
    with pytest.raises(ks.ParameterError, match=r"Forgetful declares .*'balancing_torque', but does not resolve it"):
        ks.solve(own, np.linspace(0.0, 6.0, 8), crank_speed=30.0).balancing_torque  # noqa: B018
