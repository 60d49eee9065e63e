"""Build: a validated variant made a scene, with the counterweights that balance it."""

import typing

from ..design import balancing, linkage
from ..errors import CaseError, KinetostaticsError, ParameterError
from ..machine import cams
from ..machine.builders import cam_crank_slider, crank_slider, four_bar
from ..machine.guide import Guide
from ..machine.links import Link
from ..machine.loads import TURN, Gravity, ProcessForce, Spring, Table
from ..numbers.files import read_columns
from ..solution.scene import Scene
from . import schema


def tabulated(table, folder):
    """What a validated variant has in files: cam and process force, by their keys."""
    found: dict[str, typing.Any] = {}
    cam, force = getattr(table, "cam", None), getattr(table, "process_force", None)
    if isinstance(cam, schema.SampledTable):
        found["cam"] = _from_csv(folder / cam.table, {"angle": "rad", "radius": "m"}, cams.Sampled)
    if force is not None and force.table is not None:
        found["process_force"] = Table.from_csv(folder / force.table, period=force.period or TURN)
    return found


def _from_csv(path, wanted, make):
    """What is made of columns of a file."""
    columns = read_columns(path, wanted)
    try:
        return make(*columns)
    except ParameterError as error:
        raise CaseError(path, [str(error)]) from None


def built(table, tabulated):
    """Scene of a validated variant with what it has in files, and how it was balanced, or None."""
    mechanism = _mechanism(table, tabulated)
    loads = tuple(_loads(table, tabulated))
    balanced = _balanced(mechanism, table.balancing) if table.balancing else None
    mechanism = mechanism if balanced is None else balanced.mechanism
    return Scene(mechanism, table.crank_speed, table.crank_acceleration, loads), balanced


def _mechanism(table, tabulated):
    if isinstance(table, schema.FourBarVariant | schema.ChainUnitVariant):
        lengths = table.crank_length, table.coupler_length, table.rocker_length
        links = {
            name: _link(getattr(table, name), length)
            for name, length in zip(("crank", "coupler", "rocker"), lengths, strict=True)
        }
        if isinstance(table, schema.ChainUnitVariant):
            return linkage.chain_unit(*lengths, pivot_x=table.pivot_x, assembly=table.assembly, **links)
        return four_bar(*lengths, rocker_pivot=table.rocker_pivot, assembly=table.assembly, **links)
    guide = _guide(table)
    shared = {"guide": guide, "assembly": table.assembly, "slider": _link(table.slider)}
    if isinstance(table, schema.CrankSliderVariant):
        return crank_slider(
            table.crank_length,
            table.coupler_length,
            crank=_link(table.crank, table.crank_length),
            coupler=_link(table.coupler, table.coupler_length),
            **shared,
        )
    cam = tabulated.get("cam") or _cam(table.cam, guide.guide_angle)
    length = _cam_coupler_length(table, cam)
    coupler = _link(table.coupler, length)
    return cam_crank_slider(cam, length, crank=_link(table.crank), block=_link(table.block), coupler=coupler, **shared)


def _guide(table):
    if table.guide_through is None:
        angle, offset = (0.0 if value is None else value for value in (table.guide_angle, table.guide_offset))
        return Guide.at(angle, offset)
    if table.guide_angle is not None or table.guide_offset is not None:
        raise KinetostaticsError("give either guide_through or guide_angle and guide_offset")
    return Guide.through(*table.guide_through)


def _balanced(mechanism, table):
    weights = {
        name: balancing.Counterweight(**dict(getattr(table, name)))
        for name in ("crank", "coupler", "rocker")
        if getattr(table, name) is not None
    }
    if table.method == "optimal":
        return balancing.optimal(mechanism, table.norm, phase=table.phase, weights=table.weights, **weights)
    if "crank" not in weights:
        raise KinetostaticsError(f"{table.method} balancing needs a counterweight on the crank: balancing.crank")
    if table.method == "partial" and set(weights) != {"crank"}:
        raise KinetostaticsError(
            f"balancing: partial balancing takes one counterweight, on the crank, got {', '.join(weights)}"
        )
    if table.method == "full":
        return balancing.full(mechanism, **weights)
    return balancing.partial(mechanism, table.ratio, **weights)


def _link(table, length=None):
    centre = table.centre
    if isinstance(centre, str):
        if length is None:
            raise KinetostaticsError(
                'centre "mid-length" is for links between two joints, not for slider, block or slotted crank; give a '
                "distance there"
            )
        centre = (length / 2, 0.0)
    return Link(table.mass, centre, table.inertia)


def _cam(table, guide_angle):
    if table.kind == "circle":
        return cams.Circle(table.radius, table.centre)
    return cams.CosineLaw(table.amplitude, table.mean, guide_angle)


def _cam_coupler_length(table, cam):
    if table.coupler_length is not None:
        return table.coupler_length
    if not isinstance(cam, cams.CosineLaw):
        raise KinetostaticsError("coupler_length is missing; only a cosine-law cam fixes it by itself")
    return cam.coupler_length


def _loads(table, tabulated):
    if table.gravity is not None:
        yield Gravity(table.gravity.acceleration, table.gravity.direction)
    spring, force = getattr(table, "spring", None), getattr(table, "process_force", None)
    if spring is not None:
        if isinstance(spring.stiffness, str):
            yield Spring.balancing(table.slider.mass, table.crank_speed, spring.free_position)
        else:
            yield Spring(spring.stiffness, spring.free_position)
    if "process_force" in tabulated:
        yield ProcessForce(tabulated["process_force"], period=tabulated["process_force"].period)
    elif force is not None:
        yield ProcessForce(force.force)
