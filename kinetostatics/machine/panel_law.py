"""A law of motion in pieces: Chebyshev polynomials on panels, with their derivatives."""

from dataclasses import dataclass

from ..numbers.panels import Panels
from .law import Law, angles
from .rises import Motion


@dataclass(frozen=True, eq=False)
class PanelLaw(Law):
    """A law of the whole turn from polynomials on panels of it."""

    panels: Panels

    @property
    def knots(self):
        return tuple(self.panels.edges[:-1].tolist())

    def __repr__(self):
        return f"<Law in {len(self.panels.coefficients)} pieces>"

    def __call__(self, phi):
        return Motion(*self.panels.at(angles(phi), 3))
