"""Build: a validated variant made a scene, with the counterweights that balance it."""

from typing import Any

from ..design import balancing, linkage
from ..errors import CaseError, KinetostaticsError, ParameterError
from ..machine.builders import cam_crank_slider, crank_slider, four_bar, scotch_yoke, slotted_lever
from ..machine.cams import cams
from ..machine.loads import TURN, Gravity, ProcessForce, Spring, Table, value_of
from ..numbers.files import read_columns
from ..solution.scene import Scene
from . import chain, parameters, schema
from .pieces import all_of, cam_of, friction_of, guide_of, link_of, roller_of


def tabulated(table, folder):
    """What a validated variant has in files, by the keys that lead there: cams, and values of loads."""
    found = list(parameters.files(table))
    return all_of(
        (keys, lambda part=part, keys=keys, name=name: _read(folder / name, part, table, keys))
        for keys, part, name in found
    )


def without(table, wrong):
    """A validated variant without what could not be read at some keys, or None, as without its cam."""
    values: dict[Any, Any] = {
        keys: 0.0 for keys in wrong if isinstance(parameters.value(table, keys), schema.ValuesTable)
    }
    values |= {keys: None for keys in wrong if isinstance(parameters.value(table, keys), schema.ProcessForceTable)}
    values |= {keys[:1]: None for keys in wrong if isinstance(parameters.value(table, keys), schema.TorqueTable)}
    return None if len(values) < len(set(wrong)) else parameters.with_values(table, values)


def _read(path, part, table, keys):
    """Cam, motor or values in a file that a part of a table names."""
    if isinstance(part, schema.TorqueTable):
        columns = read_columns(path, {"speed": "rad/s", "torque": "N m"})
        try:
            return part.of(*columns)
        except ParameterError as error:
            raise CaseError(path, [str(error)]) from None
    if isinstance(part, schema.SampledTable):
        angle, radius = read_columns(path, {"angle": "rad", "radius": "m"})
        try:
            return cams.Sampled(angle, radius, part.noise)
        except ParameterError as error:
            raise CaseError(path, [str(error)]) from None
    period = part.period or TURN
    if isinstance(part, schema.ValuesTable):
        unit = parameters.unit(table, keys)
        return Table.from_csv(path, unit, part.area, period, part.slider, over=part.over)
    return Table.from_csv(path, period=period)


def built(table, tabulated):
    """Scene of a validated variant with what it has in files, and how it was balanced, or None."""
    mechanism = _mechanism(table, tabulated)
    balanced = _balanced(mechanism, table.balancing) if table.balancing else None
    mechanism = mechanism if balanced is None else balanced.mechanism
    loads = (*_loads(table, tabulated), *chain.loads(table, tabulated, mechanism))
    friction = friction_of(table.friction, mechanism)
    return Scene(mechanism, table.crank_speed, table.crank_acceleration, loads, friction, sense=table.sense), balanced


def require_values(table, solution):
    """Raise an error where a table over travel does not reach as far as its slider."""
    own = len(solution.loads) - len(table.loads)
    read = [(number - own, value_of(item)) for number, item in enumerate(solution.loads)]
    all_of(
        (("loads", number) if number >= 0 else ("process_force",), lambda value=value: value(solution))
        for number, value in read
        if isinstance(value, Table)
    )


def _mechanism(table, tabulated):
    if isinstance(table, schema.ChainVariant):
        return chain.chain(table, tabulated)
    if isinstance(table, schema.FourBarVariant | schema.ChainUnitVariant):
        lengths = table.crank_length, table.coupler_length, table.rocker_length
        links = {
            name: link_of(getattr(table, name), length)
            for name, length in zip(("crank", "coupler", "rocker"), lengths, strict=True)
        }
        if isinstance(table, schema.ChainUnitVariant):
            return linkage.chain_unit(*lengths, pivot_x=table.pivot_x, assembly=table.assembly, **links)
        return four_bar(*lengths, rocker_pivot=table.rocker_pivot, assembly=table.assembly, **links)
    if isinstance(table, schema.CamVariant):
        return _cam_crank_slider(table, tabulated.get(("cam",)))
    crank = link_of(table.crank, table.crank_length)
    if isinstance(table, schema.SlottedLeverVariant):
        links = {"crank": crank, "lever": link_of(table.lever), "block": link_of(table.block)}
        line = {"pivot": table.lever_pivot, "offset": table.slot_offset}
        return slotted_lever(table.crank_length, **line, assembly=table.assembly, **links)
    shared = {"guide": guide_of(table), "slider": link_of(table.slider), "crank": crank}
    if isinstance(table, schema.ScotchYokeVariant):
        return scotch_yoke(table.crank_length, slot_angle=table.slot_angle, block=link_of(table.block), **shared)
    coupler = link_of(table.coupler, table.coupler_length)
    return crank_slider(table.crank_length, table.coupler_length, assembly=table.assembly, coupler=coupler, **shared)


def _cam_crank_slider(table, read):
    guide = guide_of(table)
    cam = cam_of(table.cam, read, guide.guide_angle)
    length = _cam_coupler_length(table, cam)
    links = {name: link_of(getattr(table, name)) for name in ("crank", "block", "slider")}
    coupler = link_of(table.coupler, length)
    others = {"assembly": table.assembly, "roller": roller_of(table.roller)}
    return cam_crank_slider(cam, length, guide=guide, coupler=coupler, **links, **others)


def _cam_coupler_length(table, cam):
    if table.coupler_length is not None:
        return table.coupler_length
    if not isinstance(cam, cams.CosineLaw):
        raise KinetostaticsError("coupler_length is missing; only a cosine-law cam fixes it by itself")
    return cam.coupler_length


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


def _loads(table, tabulated):
    """Loads that have a table of their own."""
    if table.gravity is not None:
        yield Gravity(table.gravity.acceleration, table.gravity.direction)
    spring, force = getattr(table, "spring", None), getattr(table, "process_force", None)
    if spring is not None:
        stiffness = spring.stiffness
        if isinstance(stiffness, str):
            try:
                stiffness = Spring.balancing(table.slider.mass, table.crank_speed, spring.free_position).stiffness
            except ParameterError as error:
                raise ParameterError(f"spring.stiffness: {error}") from None
        yield Spring(stiffness, spring.free_position, cubic=spring.cubic)
    if force is not None:
        read = tabulated.get(("process_force",)) or tabulated.get(("process_force", "force"))
        yield ProcessForce(force.force if read is None else read)
