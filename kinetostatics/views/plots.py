"""Figures by matplotlib; none is shown, and no global setting changes.

Every function draws on `ax` (new axes by default) and returns these Axes, unless it names another result. `solutions`
is one `Solution` or a mapping of label to `Solution`. Where a figure shows one machine only, a mapping gets a panel for
each, and the result is a list of Axes. ``units={"force": "kN", "length": "mm"}`` chooses units, as of `in_units`. A
quantity that the mechanism lacks raises `QuantityError`, a batch of designs `ParameterError`.
"""

from . import (
    animations,
    cams,
    curves,
    drawings,
    drives,
    figures,
    forces,
    sizing_bearings,
    sizing_mount,
    sizing_play,
    sizing_sections,
    sizing_springs,
    sketches,
)
from . import hodographs as force_curves
from . import mass_centres as centres
from .axis_units import one_panel_each, with_units
from .charts import error_by_distance, model_ladder, sweep_map, work_precision

acceleration_error = with_units(curves.acceleration_error)
animation = with_units(animations.animation)
bearing = with_units(sizing_bearings.bearing)
before_and_after = with_units(figures.before_and_after)
cam_curvature = with_units(cams.cam_curvature)
cam_force = with_units(curves.cam_force)
cam_pressure_angle = with_units(cams.cam_pressure_angle)
cam_profile = with_units(one_panel_each(cams.cam_profile, 5.2, 4.6, 3))
chain_unit_motion = with_units(curves.chain_unit_motion)
contact_loss = with_units(sizing_play.contact_loss)
contact_pressure = with_units(cams.contact_pressure)
crank_speed = with_units(drives.crank_speed)
drive_torques = with_units(one_panel_each(drives.drive_torques, 6.4, 3.6))
energy_flow = with_units(drives.energy_flow)
free_body = with_units(one_panel_each(forces.free_body, 5.2, 4.8, 2))
front = with_units(figures.front)
helical_spring = with_units(sizing_springs.helical_spring)
hodograph = with_units(force_curves.hodograph)
hodographs = with_units(force_curves.hodographs)
law_motion = with_units(cams.law_motion)
losses = with_units(drives.losses)
lost_power = with_units(one_panel_each(drives.lost_power, 6.4, 3.2))
mass_centres = with_units(centres.mass_centres)
mechanism = with_units(drawings.mechanism)
mount = with_units(sizing_mount.mount)
over_turn = with_units(curves.over_turn)
pressure_angle = with_units(curves.pressure_angle)
principal_points = with_units(one_panel_each(centres.principal_points, 5.2, 4.6, 2))
rocking_moment = with_units(force_curves.rocking_moment)
sections = with_units(sizing_sections.sections)
shaking_force = with_units(curves.shaking_force)
shares = with_units(one_panel_each(forces.shares, 7.0, 4.2, pad=22.0))
sketch = with_units(one_panel_each(sketches.sketch, 6.4, 3.6))
torque = with_units(curves.torque)
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
