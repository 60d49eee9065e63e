"""What Hertz pressure steel of a hardness bears, and the other way round."""

from ..errors import ParameterError
from ..machine.cams.profile import POSITIVE
from ..numbers import checks


def pressure_from_hardness(brinell):
    """Hertz pressure that through-hardened steel of a Brinell hardness bears 1e7 times, Pa.

    2.22 HB + 200 MPa (AGMA 2001-D04, figure 2, grade 1), for 180 to 400 HB.

    Parameters
    ----------
    brinell : float
        HB, 180 to 400.

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        The hardness is outside what the standard tells of.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> round(ks.design.pressure_from_hardness(300.0) / 1e6, 3)
    866.0
    """
    value = checks.singles("pressure_from_hardness", brinell=(brinell, "1", POSITIVE))["brinell"]
    if not 180.0 <= value <= 400.0:
        raise ParameterError(
            f"pressure_from_hardness: the standard tells of 180 to 400 HB, got {value:.6g}; give the pressure itself, "
            "for case-hardened steel about 1.5e9 Pa"
        )
    return (2.22 * value + 200.0) * 1e6


def hardness_from_pressure(pressure):
    """Brinell hardness of steel that bears a Hertz pressure in Pa: the same the other way round.

    At least 180 HB, the softest that the standard tells of; beyond 400 HB extrapolated.

    Parameters
    ----------
    pressure : float
        Pa.

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        The pressure is negative or no number.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> round(ks.design.hardness_from_pressure(866e6), 6)
    300.0
    """
    value = checks.singles("hardness_from_pressure", pressure=(pressure, "Pa", {"low": 0.0}))["pressure"]
    return max(180.0, (value / 1e6 - 200.0) / 2.22)
