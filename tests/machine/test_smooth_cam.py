"""The coupler length with which a law has a smooth cam, and laws that have none."""

import numpy as np
import pytest

import kinetostatics as ks

laws = ks.laws


def test_a_cosine_law_beside_the_guide_is_refused_with_both_lengths_and_the_phase_that_repairs_it():
    law = laws.cosine(0.3, 2.0)
    message = (
        r"coupler would have to be 2\.019120\d+ m long at 82\.26\d+ deg .* and 2\.02487\d+ m at 278\.79\d* deg.*"
        r"later by 0\.5608 deg needs one only: law\.shifted\(0\.00978856"
    )
    with pytest.raises(ks.ParameterError, match=message) as caught:
        ks.cams.from_law(law, guide_offset=0.02)
    phase = float(str(caught.value).split("law.shifted(")[1].rstrip(")"))
    cam = ks.cams.from_law(law.shifted(phase), guide_offset=0.02)
    assert abs(cam.far.length - cam.near.length) < 1e-14
    assert 2.0191 < cam.coupler_length < 2.0249


def test_a_law_of_ones_own_is_told_how_to_shift_itself():
    own = laws.cosine(0.3, 2.0)
    with pytest.raises(ks.ParameterError, match=r"needs one only: lambda phi: law\(phi - 0\.0097"):
        ks.cams.from_law(lambda phi: own(phi), guide_offset=0.02)


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (laws.cosine(0.3, -2.0), "the slider must stay ahead of the roller along the guide, but is 2.02"),
        (
            laws.joined(laws.cycloidal(0.1, 2.0, np.pi), laws.cycloidal(2.0, 0.1, np.pi)),
            "the pitch curve must go around O, but its radius falls to -1.3",
        ),
        (lambda phi: phi, "must give 4 arrays"),
        (lambda phi: (phi, phi, phi, phi), "must repeat after a turn, but gives 0.5 m at 0.5 rad and 6.78"),
        (lambda phi: (phi * np.nan,) * 4, "must give finite values"),
        (laws.cycloidal(1.7, 2.3, 1.0), "angles must lie from 0 to its 1 rad"),
        (laws.Law, "must be one of ks.laws"),
        (3.0, "must be one of ks.laws"),
    ],
)
def test_what_is_no_law_of_a_slider_is_refused(law, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.cams.from_law(law)
