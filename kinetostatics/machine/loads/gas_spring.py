"""Gas enclosed between the frame and a slider: pressure p V^n = const over its piston area.

Let s be the slider's coordinate along its guide, s0 the position of the given volume V0 and absolute pressure p0, A the
piston area. The gas pushes in the direction d = +1 or -1:

    V = V0 + d A (s - s0)        force = d A (p - p_a)        p = p0 exp(n L),  L = log(V0 / V)

for a piston that moves in the direction of the gas force enlarges the volume; p_a is the pressure on the other side of
the piston. Its work is the integral of the force: the potential energy, zero at s0, is

    p0 V0 ((V0/V)^(n-1) - 1) / (n - 1) + p_a (V - V0)  =  p0 V0 L integral of exp((n-1) L t) dt + p_a (V - V0)

The integral from 0 to 1 by Gauss's rule has no singular case at n = 1 (isothermal), where it is 1.
"""

from dataclasses import KW_ONLY, dataclass
from typing import Annotated, Any

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import exp, log
from ...numbers.planar import minus, plus, product
from ..links import present
from .load import Symbol, angles_text
from .slider import SliderLoad

_nodes, _weights = np.polynomial.legendre.leggauss(16)
POLYTROPIC_RULE = tuple(zip((0.5 * (1.0 + _nodes)).tolist(), (0.5 * _weights).tolist(), strict=True))
"""Places in (0, 1) and weights; exact to 2e-15 for (V0/V)^(n-1) from e^-20 to e^20."""
PRESSURES = checks.PlausibleRange(1e12, "is it in bar?", 1e5, 1e3)
"""Plausible absolute pressures, Pa."""
MAX_EXPONENT = 3.0
"""Largest exponent n; helium and argon have 1.67, dense gases up to 2."""
TERMS = {
    "_volume.volume": ("V", "volume of the gas"),
    "_compression.ratio": ("L", "logarithm of the compression V0/V"),
    "pressure_at.found": ("p", "absolute pressure of the gas"),
}


@dataclass(frozen=True, eq=False)
class GasSpring(SliderLoad):
    """Gas spring on a slider: enclosed gas that follows p V^n = const and pushes along the guide.

    Parameters
    ----------
    area : float or array
        Piston area, m2.
    volume : float or array
        Gas volume at the slider position `at`, including dead volume, m3.
    pressure : float or array
        Absolute pressure of the gas there, Pa.
    at : float or array
        Coordinate of the slider along its guide (B . guide direction) at which volume and pressure are given, m.
    side : +1 or -1
        Direction in which the gas pushes the slider: +1 along the guide, -1 against it. It expands in that direction.
    exponent : float or array
        Polytropic exponent n: 1 isothermal, 1.4 adiabatic for air; from 1 to 3.
    ambient : float or array
        Absolute pressure on the other side of the piston, Pa.
    on : str
        Slider on which it acts.

    Raises
    ------
    ParameterError
        A value is not a finite number, or out of its range. When a scene is made, the slider is unknown; when it is
        solved: no gas volume is left at some crank angles, which the message lists.

    Warns
    -----
    HintWarning
        The pressure is below the ambient pressure (is it a gauge pressure?), or looks like bar.

    Notes
    -----
    The force is (pressure - ambient) times the area. Potential energy, J, 0 at `at`:
    ``p0 V0 / (n - 1) * ((V0 / V)**(n - 1) - 1) + ambient * (V - V0)``; the gas does no net work over a turn.

    Examples
    --------
    >>> import math
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> gas = ks.GasSpring(area=2e-3, volume=4e-4, pressure=1e6, at=0.15, side=-1)  # pushes the slider back
    >>> s = ks.solve(pump, math.pi, crank_speed=0.0, loads=gas)
    >>> print(f"{gas.push(s):.1f} N, {s.potential_energy:.3f} J")
    -1797.4 N, 0.000 J
    """

    area: Annotated[
        Any, checks.Number("m**2", low=0.0, strict=True, usual=checks.PlausibleRange(10.0, "is it in mm2?", 1e-6))
    ]
    volume: Annotated[
        Any, checks.Number("m**3", low=0.0, strict=True, usual=checks.PlausibleRange(10.0, "is it in litres?", 1e-3))
    ]
    pressure: Annotated[Any, checks.Number("Pa", low=0.0, strict=True, usual=PRESSURES)]
    _: KW_ONLY
    at: Annotated[Any, checks.Number("m")]
    side: Annotated[int, checks.Sign()] = 1
    exponent: Annotated[Any, checks.Number("1", low=1.0)] = 1.3
    ambient: Annotated[Any, checks.Number("Pa", low=0.0, usual=PRESSURES)] = 101325.0
    on: str = "slider"

    PATH, LENGTHS, REFUSES = "gas_spring", ("at",), True

    def _exponent_problems(self):
        """Sentence if no gas has the exponent."""
        if checks.has_known_values(self.exponent) and np.any(np.asarray(self.exponent) > MAX_EXPONENT):
            yield f"exponent must be at most {MAX_EXPONENT:g}, got {checks.shown(self.exponent)}"

    RULES = checks.Rules("gas spring", _exponent_problems)

    def push(self, motion):
        """Force on the slider along the guide, N."""
        gauge = minus(self.pressure_at(motion), present(self.ambient))
        return self.side * self.area * gauge

    def pressure_at(self, motion):
        """Absolute pressure of the gas, Pa."""
        ratio = self._compression(motion)
        found = self.pressure * exp(self.exponent * ratio)
        return found

    def potential(self, motion):
        """Potential energy of the gas and of the ambient pressure, J; 0 where the slider is at `at`."""
        ratio = self._compression(motion)
        steep = (self.exponent - 1.0) * ratio
        mean = sum(weight * exp(place * steep) for place, weight in POLYTROPIC_RULE)
        change = self.side * self.area * motion.elongation(self.at, self.on)
        return plus(self.pressure * self.volume * ratio * mean, product(present(self.ambient), change))

    def _compression(self, motion):
        """Logarithm of the volume at `at` over the volume."""
        volume = self._volume(motion)
        ratio = -log(volume / self.volume)
        return ratio

    def _volume(self, motion):
        """Volume of the gas, m3."""
        volume = self.volume + self.side * self.area * motion.elongation(self.at, self.on)
        return volume

    def refusals(self, motion):
        """Sentence on the crank angles without gas volume."""
        volume = self._volume(motion)
        if not isinstance(volume, float | np.ndarray) or not checks.has_known_values(volume):
            return
        volume = np.asarray(volume, dtype=float)
        with np.errstate(invalid="ignore"):
            gone = volume <= 0.0
        if gone.any():
            worst = np.unravel_index(np.nanargmin(volume), volume.shape)
            given, area, at, left = (
                np.broadcast_to(part, gone.shape)[worst] for part in (self.volume, self.area, self.at, volume)
            )
            yield checks.Problem(
                f"{self.title}: no volume is left {angles_text(motion, gone)}. Its {given:.6g} m3 at {at:.6g} m end at "
                f"{at - self.side * given / area:.6g} m, but the slider goes on by up to {-left / area:.6g} m. Give "
                "more volume or less area, or the other side",
                gone,
            )

    def signs(self, motion):
        """Symbol of a gas spring along the guide."""
        joint = motion.mechanism.references[self.on]
        yield Symbol("damper", motion.position(joint), slider=self.on, sense=-float(self.side))
