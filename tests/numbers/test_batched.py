"""Arrays of designs among parameters: the shape that they have in common."""

import numpy as np
import pytest

import kinetostatics as ks


def test_one_design_has_no_shape_and_arrays_have_theirs_in_common():
    assert ks.crank_slider(0.1, 0.5).batch == ()
    assert ks.Spring(np.ones((4, 1)), 0.3).batch == (4, 1)
    assert ks.crank_slider(np.full((3, 1, 1), 0.1), 0.5, slider=ks.Link(np.ones((4, 1)))).batch == (3, 4, 1)


def test_arrays_that_do_not_fit_together_are_told_by_their_paths():
    mechanism = ks.crank_slider(np.full((3, 1), 0.1), 0.5, slider=ks.Link(np.ones((4, 1))))
    with pytest.raises(ks.ParameterError, match=r"crank_length \(3, 1\).*slider\.mass \(4, 1\)"):
        _ = mechanism.batch
