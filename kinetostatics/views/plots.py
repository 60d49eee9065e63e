"""Figures by matplotlib; none is shown, and no global setting changes.

Every function draws on `ax` (new axes by default) and returns these Axes, unless it names another result. `solutions`
is one `Solution` or a mapping of label to `Solution`. Where a figure shows one machine only, a mapping gets a panel for
each, and the result is a list of Axes. Drawings, hodographs and cams have equal scales on both axes.
``units={"force": "kN", "length": "mm"}`` chooses units, as of `in_units`. A quantity that the mechanism lacks raises
`QuantityError`, a batch of designs `ParameterError`.
"""

from .animations import animation
from .cams import cam_curvature, cam_pressure_angle, cam_profile, contact_pressure, law_motion
from .charts import error_by_distance, model_ladder, sweep_map, work_precision
from .curves import acceleration_error, cam_force, chain_unit_motion, over_turn, pressure_angle, shaking_force, torque
from .drawings import mechanism
from .drives import crank_speed, drive_torques, energy_flow, losses, lost_power
from .figures import before_and_after, front
from .forces import free_body, shares
from .hodographs import hodograph, hodographs, rocking_moment
from .mass_centres import mass_centres, principal_points
from .sizing import bearing, contact_loss, helical_spring, mount, sections
from .sketches import sketch

__all__ = [
    "acceleration_error",
    "animation",
    "bearing",
    "before_and_after",
    "cam_curvature",
    "cam_force",
    "cam_pressure_angle",
    "cam_profile",
    "chain_unit_motion",
    "contact_loss",
    "contact_pressure",
    "crank_speed",
    "drive_torques",
    "energy_flow",
    "error_by_distance",
    "free_body",
    "front",
    "helical_spring",
    "hodograph",
    "hodographs",
    "law_motion",
    "losses",
    "lost_power",
    "mass_centres",
    "mechanism",
    "model_ladder",
    "mount",
    "over_turn",
    "pressure_angle",
    "principal_points",
    "rocking_moment",
    "sections",
    "shaking_force",
    "shares",
    "sketch",
    "sweep_map",
    "torque",
    "work_precision",
]


def __dir__():
    return __all__
