"""What the numbers of a scene are to a program: zeros kept, rules for several at once, lengths that shape a passage."""

import numpy as np
import pytest

import kinetostatics as ks


def test_a_wanted_number_of_an_axis_is_kept_and_has_a_derivative():
    """Along an axis a guide's direction belongs to the structure."""
    upright, inclined = (
        ks.Scene(ks.crank_slider(0.1, 3.0, guide=ks.Guide.through((0.0, 0.0), end), slider=ks.Link(1.0)), 3.0)
        for end in ((0.0, 2.0), (1e-9, 2.0))
    )
    for path in ("exact.x", "exact.y"):
        assert path in ks.compile(upright, ("O",), (path,), engine="numpy").parameters
        one, other = (
            scene.solve([0.3, 1.0]).uncertainty("balancing_torque", {path: 1e-6}) for scene in (upright, inclined)
        )
        assert np.all(one.inputs[path] > 0.0)
        np.testing.assert_allclose(one.inputs[path], other.inputs[path], rtol=1e-7)
    with pytest.raises(ks.ParameterError, match=r"exact.y is of an axis and so left out; keep it by compile"):
        ks.compile(upright, ("O",), engine="numpy")(0.3, {"exact.y": 0.9})
