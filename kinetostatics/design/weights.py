"""What carries the coupler's weight where a symmetric cam cannot, and what each way costs."""

import numpy as np

from ..machine.loads import Gravity
from ..numbers import checks
from .cam_start import parts_of
from .problem import chosen, scene_of
from .torque_free import TORQUE, torque_free_cam

LEAST_SQUARES = f"rms {TORQUE}"
QUARTER = np.pi / 2


def weight_options(source, cosine=8, *, variant=None, reference=None, counterweight=None, **options):
    """Torque-free cams under weight, each carrying it in another way, and its price: a row for each.

    Parameters
    ----------
    source, variant, reference, options
        As for `torque_free_cam`.
    cosine : int
        Harmonics; as many sine terms where these are taken.
    counterweight : float, optional
        Mass on the crank, kg; that of the coupler unless told.

    Returns
    -------
    pandas.DataFrame
        "symmetric", "sine terms", "coupler spring" (its couple goes through the slider to the guide) and
        "counterweight" (with sine terms; its centrifugal force goes to O), with the outputs of their reports; "bound"
        is of the symmetric cam.

    Raises
    ------
    ParameterError
        The source is neither a case nor a scene, or no crank-slider.
    DesignError
        The machine has no masses.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> table = ks.design.weight_options(ks.load_case("sawframe_2r63"), cosine=2)
    >>> print(table["ratio mean_absolute balancing_torque [1]"].round().to_string())
    symmetric         160.0
    sine terms        235.0
    coupler spring    463.0
    counterweight     462.0
    """
    import pandas as pd

    taken = [name for name in ("sine", "coupler_spring") if name in options]
    mass = checks.Optional(checks.Number("kg", low=0.0, strict=True))
    wrong = (f"{name} is one of the ways compared, so it cannot be given" for name in taken)
    counterweight = checks.examined(
        "weight_options", {"counterweight": mass}, {"counterweight": counterweight}, *wrong
    )["counterweight"]
    given, compared = chosen(source, variant, reference)
    scene = scene_of(given)
    group, _ = parts_of(scene)
    pulls = [
        item.acceleration * np.sin(item.direction - group.guide.guide_angle)
        for item in scene.loads
        if isinstance(item, Gravity)
    ]
    mass = group.coupler.mass if counterweight is None else counterweight
    ways = {
        "symmetric": {},
        "sine terms": {"sine": cosine},
        "coupler spring": {"coupler_spring": float(np.copysign(QUARTER, sum(pulls)))},
        "counterweight": {"counterweight": mass, "sine": cosine},
    }
    rows = {}
    for name, way in ways.items():
        found = torque_free_cam(given, cosine, reference=compared, **({"minimise": LEAST_SQUARES} | options | way))
        rows[name] = found.report()["after"].to_dict() | {"bound": found.bound if name == "symmetric" else np.inf}
    return pd.DataFrame.from_dict(rows, orient="index")
