"""Speed of the motor over the crank angle, for a case with a drive."""

import numpy as np

from ...drive.steady_running import steady
from ...errors import ParameterError
from ...numbers.formatting import pretty_unit
from .fields import shown_unit

COUNT = 360
"""Crank angles of a period."""


def motor_of(session, state):
    """Motor of a variant and its flywheel, kg m2; None and 0.0 without a drive."""
    variant = session.case.variants[state.get("variant", session.first)] if session.case else None
    return (None, 0.0) if variant is None or variant.motor is None else (variant.motor, variant.flywheel)


def running(session, request):
    """Steady running of a state, then of the reference."""
    for name in ("state", "reference"):
        if (state := request.get(name)) is not None:
            yield {"running": name} | motor_speed(session, state)


def motor_speed(session, state):
    """Speed of the motor in steady running, a curve as those of `look`, with its crank angles and period, degrees."""
    motor, flywheel = motor_of(session, state)
    if motor is None:
        raise ParameterError(f"explore: variant {state.get('variant', session.first)!r} has no drive")
    run = steady(session.scene(state), motor, flywheel, angles=COUNT)
    factor, unit = shown_unit("rad/s")
    shown = {"label": "motor speed", "unit": pretty_unit(unit), "factor": factor, "vector": False}
    return {
        "angle": np.degrees(run.crank_angle),
        "period": float(np.degrees(2.0 * np.pi * run.turns)),
        "quantities": {"motor speed": shown | {"values": np.array(run.motor_speed)}},
    }
