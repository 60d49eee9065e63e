"""What every cam has from its radius: pressure angle and curvature, against closed forms of curves."""

import numpy as np
import pytest

from kinetostatics.machine.cam import Cam

PHI = np.linspace(0.1, 6.0, 7)


class Spiral(Cam):
    """Radius e^(k phi): the same pressure angle everywhere."""

    def polar(self, angle, ray):
        """Radius, and its derivatives."""
        r = np.exp(0.3 * angle)
        return r, 0.3 * r, 0.09 * r


class Round(Cam):
    """A circle about O."""

    def polar(self, angle, ray):
        """Radius, and its derivatives."""
        return 2.0 + 0.0 * angle, 0.0 * angle, 0.0 * angle


class Line(Cam):
    """The straight line x = 1."""

    def polar(self, angle, ray):
        """Radius, and its derivatives."""
        x, y = ray
        return 1.0 / x, y / x**2, (1.0 + y**2) / x**3


def test_a_logarithmic_spiral_has_one_pressure_angle_and_its_known_curvature():
    assert Spiral().pressure_angle(PHI) == pytest.approx(np.full(7, np.arctan(0.3)), rel=1e-14)
    assert Spiral().curvature_radius(PHI) == pytest.approx(np.exp(0.3 * PHI) * np.sqrt(1.09), rel=1e-14)


def test_a_circle_is_as_curved_everywhere_and_a_line_nowhere():
    assert Round().curvature_radius([0.0, 1.0]).tolist() == [2.0, 2.0]
    assert abs(1.0 / Line().curvature_radius(0.4)) < 1e-14


def test_a_cam_without_its_one_method_says_so():
    with pytest.raises(TypeError, match="Cam must define polar"):
        Cam().radius(0.0)
