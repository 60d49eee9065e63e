"""What a case file derives follows the numbers that vary."""

from numpy.testing import assert_allclose

from support.improved_saws import bound


def test_what_is_derived_in_the_file_follows():
    numbers = bound().scene.parameters
    assert_allclose(numbers["coupler.centre.along"], numbers["coupler_length"] / 2, rtol=1e-15)
