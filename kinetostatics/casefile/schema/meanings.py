"""Meanings of the keys of a case file, in one sentence each: for its reference, and for forms that change a table.

Tables with fields of their own have the texts below these fields; groups and loads have `MEANINGS`.
"""

import ast
import inspect
import re
import typing
from functools import cache
from itertools import pairwise
from textwrap import dedent

from .parts import MADE_OF

MEANINGS = {
    "guide_angle": "Direction of the guide, from +x.",
    "guide_offset": "Distance of the guide from O, to the left of its direction.",
    "guide_through": "Two points on the guide, instead of angle and offset.",
    "label": "Appended to the names of its links and forces, to distinguish groups of one kind.",
    "on": "Joint that the group is connected to.",
    "pin": "Name of the joint that it adds.",
    "pivot": "Fixed pivot.",
    "pivot_name": "Name of the joint at the pivot.",
    "coupler": "Mass properties of the coupler, from the joint `on` toward `pin`.",
    "coupler_length": "From the joint `on` to `pin`.",
    "slider": "Mass properties of the slider, from `pin` along the guide.",
    "block": "Mass properties of the block, from its pin along the slot.",
    "roller": "Size and material of the roller, for its contact pressure.",
    "stiffness": "Of the spring.",
    "against": "Link with the opposite torque; by default the frame.",
    "between": "Two points; at most one of them fixed.",
    # groups
    "slider.assembly": "1: slider ahead of the inner joint along the guide, -1: behind; the words pass change points.",
    "rocker.rocker_length": "From the pivot to `pin`.",
    "rocker.assembly": "1: `pin` left of the direction from inner joint to pivot; the words pass change points.",
    "rocker.rocker": "Mass properties of the rocker, from the pivot toward `pin`.",
    "lever.offset": "Of the slot's axis to the left of the pivot.",
    "lever.lever": "Mass properties of the lever, from the pivot along the slot.",
    "lever.assembly": "1: the slot points to the block, -1: away from it; the words pass change points.",
    "cylinder.rod": "Mass properties of the rod, from its pin toward the pivot.",
    "cylinder.cylinder": "Mass properties of the cylinder, from the pivot toward the rod's pin.",
    "yoke.slot_angle": "From the guide's direction.",
    "dyad.length1": "From the first of both joints to `pin`.",
    "dyad.length2": "From the second of both joints to `pin`.",
    "dyad.on": "Both joints that the dyad connects.",
    "dyad.assembly": "1: `pin` left of the direction from the first joint to the second, -1: right.",
    "dyad.dyad1": "Mass properties of the first link, from its joint toward `pin`.",
    "dyad.dyad2": "Mass properties of the second link, from its joint toward `pin`.",
    "pin.on": 'Link that it is fixed to, or "frame".',
    "pin.at": "From the link's reference joint along it and across it; on the frame x and y from O.",
    "pin.name": "Name of the joint that it adds.",
    "cam roller.cam": "The path of the roller centre A about O.",
    "cam roller.block": "Mass properties of block and roller, from A along the crank.",
    "roller follower.cam": "Law: coordinate of the roller centre along the guide, from the foot of O.",
    "flat follower.cam": "Law: distance of the face from O along the guide.",
    "swinging follower.cam": "Law: angle at the pivot from the direction to O to the roller centre.",
    "flat follower.face": "Width and material of the face, for its contact pressure.",
    "follower": "Mass properties of the follower, from `pin` along the guide; loads act on it by its name.",
    "swinging follower.arm_length": "From the pivot to the roller centre.",
    "swinging follower.arm": "Mass properties of the arm, from the pivot toward the roller centre.",
    "swinging follower.assembly": "1: the roller centre left of the direction from O to the pivot, -1: right.",
    # loads
    "spring.stiffness": 'Of all springs; "balance the slider": its mass times crank speed squared at their end.',
    "spring.free_position": "Coordinate of the slider's pin along its guide at which the springs are free.",
    "spring.on": "Slider that it acts on.",
    "spring.cubic": "Coefficient of the cube of the elongation in the force.",
    "spring.mass": "Of all springs together: a third moves with the slider, half of it shakes the frame.",
    "gas spring.area": "Of the piston.",
    "gas spring.volume": "Of the gas where the slider is at `at`.",
    "gas spring.pressure": "Absolute pressure of the gas there.",
    "gas spring.at": "Coordinate of the slider's pin along its guide at which volume and pressure are given.",
    "gas spring.side": "Direction in which the gas pushes the slider: 1 along its guide, -1 against it.",
    "gas spring.exponent": "Polytropic exponent: 1 isothermal, 1.4 adiabatic for air.",
    "gas spring.ambient": "Absolute pressure on the other side of the piston.",
    "gas spring.on": "Slider that it acts on.",
    "process force.force": "Positive in the direction of the slider's guide; or a file of values.",
    "process force.on": "Slider that it acts on.",
    "sawing.kerf": "Width of the cut of one saw.",
    "sawing.height": "Height of the cut; for a round log its mean over the saws.",
    "sawing.saws": "Number of saws in the log.",
    "sawing.feed_per_stroke": "Advance of the log per cutting stroke.",
    "sawing.resistance": "Specific cutting resistance: work per volume of the cut.",
    "sawing.cuts": 'Stroke on which it cuts: "toward crank" or "away".',
    "sawing.thrust": "Force of the log across the guide, to its left, as a fraction of the cutting force.",
    "sawing.overhang": "Distance of the log from the slider's pin at mid-stroke, along the guide.",
    "sawing.on": "Slider with the saws.",
    "mowing.force": "Of all sections together while they cut.",
    "mowing.pitch": "Distance between two fingers.",
    "mowing.start": "Distance of a section from the finger behind it, where the cut begins.",
    "mowing.end": "Distance of a section from the finger behind it, where the cut ends.",
    "mowing.on": "Slider that is the knife.",
    "torque.opposing": "true: the constant value acts against the angular velocity of `on` relative to `against`.",
    "force.value": "The force; or a file of values.",
    "force.at": "Point where it acts.",
    "force.direction": "From +x, or from the axis of the link `along`.",
    "force.along": "Link with which the direction rotates.",
    "point force.value": "Positive pushes the points apart; or a file of values.",
    "point spring.free_length": "Of the spring.",
    "point damper.coefficient": "Of the damper, along the line of the points.",
    "torque.value": "Counter-clockwise on the link; or a file of values.",
    "torque.on": "Link that it acts on.",
    "balance shaft.unbalance": "Mass times the distance of its centre from the axis.",
    "balance shaft.ratio": "Turns of the shaft per turn of the crank, negative if opposite.",
    "balance shaft.phase": "Angle of the unbalance from +x at crank angle 0.",
    "balance shaft.at": "Axis of the shaft.",
    "balance shaft.inertia": "Of the whole shaft with its unbalance, about the axis.",
    "balance shaft.mass": "Of the whole shaft with its unbalance: its weight on the bearing.",
    "balance shaft.plane": "Position along the crankshaft; it affects the rocking moment only.",
    "torsion spring.free_angle": "Angle of the link at which it is free, from +x or from the axis of `against`.",
    "torsion spring.on": "Link that it acts on.",
    "torsion spring.moment": "An additional constant couple.",
    "torsion damper.coefficient": "Of the damper.",
    "torsion damper.on": "Link that it acts on.",
}
"""Meaning of the keys of groups and loads, by kind and key, or by key alone."""


def word_of(model):
    """The kind of a group or load, as in its tables; "" for other tables."""
    return typing.get_args(model.model_fields["kind"].annotation)[0] if model in MADE_OF else ""


def about(model):
    """First sentence on a table."""
    if model in MADE_OF:
        return (inspect.getdoc(MADE_OF[model]) or "").partition("\n\n")[0]
    return vars(model).get("__doc__") or ""


@cache
def meaning(model, name):
    """Meaning of a key of a table; "" if it has no text."""
    if model in MADE_OF:
        if name == "kind":
            return "Which kind it is."
        known = MEANINGS.get(f"{word_of(model)}.{name}") or MEANINGS.get(name)
        return known or _parameter(MADE_OF[model], name)
    owners = [base for base in model.__mro__ if name in vars(base).get("__annotations__", ())]
    text = model.model_fields[name].description or (_texts_below(owners[0]).get(name, "") if owners else "")
    return text[:1].upper() + text[1:].removesuffix(".") + "." if text else ""


def _parameter(kind, name):
    """Text on a parameter in the docstring of a class."""
    text = re.search(rf"^{name} : .*\n((?:    .*(?:\n|\Z))+)", inspect.getdoc(kind) or "", flags=re.MULTILINE)
    return " ".join(text[1].split()) if text else ""


@cache
def _texts_below(model):
    """Texts below the fields of a class."""
    tree: typing.Any = ast.parse(dedent(inspect.getsource(model)))
    return {
        field.target.id: text.value.value
        for field, text in pairwise(tree.body[0].body)
        if isinstance(field, ast.AnnAssign)
        and isinstance(field.target, ast.Name)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
        and isinstance(text.value.value, str)
    }
