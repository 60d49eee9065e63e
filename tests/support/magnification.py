"""The true magnification of errors, by the package's kernels on arb numbers at 80 digits and central differences.

The sum over all lengths and the crank angle p of |p dq/dp|, over the largest term of q. A term is a size in the worst
direction: of a link's rates what the fastest joint of its group gives over its length, of reactions the largest load on
a link, of the torque the largest load times the fastest point of its group.
"""

from dataclasses import replace

import numpy as np
import pytest

from kinetostatics import Gravity, Link, Spring
from kinetostatics.machine.guide import Guide
from kinetostatics.machine.links import arm, first_at
from kinetostatics.numbers.parameter_tree import map_numbers, replace_unchecked
from kinetostatics.studies.methods.high_precision.enclosures import on_arb

flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

BITS = 270
STEP = "1e-30"


def truly_magnified(solution):
    """Largest true magnification at each crank angle of a solution, and the largest error by that of a rounding."""
    with flint.ctx.workprec(BITS):
        run, step = on_arb(flint.arb, replace(solution, loads=())), flint.arb(STEP)
        run = replace(run, loads=map_numbers(solution.loads, lambda value: flint.arb(float(value))))
        exact = quantities(run)
        changes = dict.fromkeys(exact, 0.0)
        for number in range(lengths(run) + 1):
            more, less = (quantities(changed(run, number, 1 + sign * step)) for sign in (1, -1))
            for name in exact:
                slopes = [(b - a) / (2 * step) for a, b in zip(less[name], more[name], strict=True)]
                changes[name] = changes[name] + magnitude(slopes)
        found = quantities(solution)
        errors = {name: magnitude([a - b for a, b in zip(found[name], exact[name], strict=True)]) for name in exact}
        sizes = {name: magnitude(parts) for name, parts in exact.items()}
        terms = terms_of(run, sizes)
    shares = [np.broadcast_to([changes[name], errors[name]] / terms[name], (2, *solution.shape)) for name in exact]
    return np.max(shares, axis=0)


def changed(run, which, factor):
    """The solution with one of its lengths, or last the crank angle, times a factor."""
    count = -1

    def number(value):
        nonlocal count
        count += 1
        return value * factor if count == which else value

    def link(own):
        return replace_unchecked(own, centre=map_numbers(own.centre, number, {flint.arb: number}))

    def guide(line):
        return replace_unchecked(line, guide_offset=map_numbers(line.guide_offset, number, {flint.arb: number}))

    def spring(own):
        return replace_unchecked(own, free_position=number(own.free_position))

    special = {Link: link, Guide: guide, Spring: spring, Gravity: lambda own: own, flint.arb: number}
    mechanism, loads = (map_numbers(item, number, special) for item in (run.mechanism, run.loads))
    return replace(run, mechanism=mechanism, loads=loads, crank_angle=number(run.crank_angle))


def lengths(run):
    """How many lengths there are."""
    count = []
    special = {Link: lambda own: map_numbers(own.centre, count.append, {flint.arb: count.append})}
    special |= {Guide: lambda line: map_numbers(line.guide_offset, count.append, {flint.arb: count.append})}
    map_numbers(run.mechanism, count.append, special | {flint.arb: count.append})
    return len(count) + sum(isinstance(item, Spring) for item in run.loads)


def turning(run):
    """Links that turn, but for crank and block."""
    return {
        name: link
        for name, link in run.placement.links.items()
        if name not in ("crank", "block") and link.ratio is not None
    }


def quantities(run):
    """Rates, reactions and torque by kind and name, each a list of components."""
    rates = {("rate", name): [link.ratio] for name, link in turning(run).items()}
    slopes = {("slope", name): [link.ratio_slope] for name, link in turning(run).items()}
    forces = getattr(run, "dynamics", run).resolved
    reactions = {("reaction", name): list(parts) for name, parts in forces.reactions.items()}
    scalars = {
        ("reaction", name): [forces.scalars[name]] for name in ("cam_force", "slot_force") if name in forces.scalars
    }
    return rates | slopes | reactions | scalars | {("torque", ""): [run.balancing_torque]}


def magnitude(parts):
    """Length of a vector of numbers of any kind, in double precision; None is no vector."""
    parts = [0.0 if part is None else np.asarray(part) for part in parts or [None]]
    return np.sqrt(sum(np.asarray(part, dtype=object).astype(float) ** 2 for part in parts))


def terms_of(run, sizes):
    """Largest term of each quantity."""
    placement, found, forces, torques = run.placement, {}, [], []
    for part in (run.mechanism.crank, *run.mechanism.groups):
        joints = [placement.joints[name] for bar in part.bars for name in (bar.start, bar.end)]
        speed, acceleration = (
            np.max(np.broadcast_arrays(0.0, *(magnitude(getattr(joint, name)) for joint in joints)), axis=0)
            for name in ("first", "second")
        )
        for bar in part.bars:
            if bar.link in turning(run):
                length = magnitude([bar.length])
                rate = np.maximum(sizes["rate", bar.link], speed / length)
                found["rate", bar.link] = rate
                found["slope", bar.link] = np.max([sizes["slope", bar.link], rate**2, acceleration / length], axis=0)
        for name in part.links:
            link, wrench, body = placement.links[name], run.link_loads[name], run.mechanism.links[name].body
            centre = magnitude(first_at(link, arm(link.direction, body.along, body.across)))
            forces.append(magnitude(wrench.force))
            turned = magnitude([wrench.moment]) * magnitude([link.ratio])
            torques.append(forces[-1] * np.maximum(speed, centre) + turned)
            if "slider" in name and name in run.pushes:
                forces.append(magnitude([run.pushes[name]]))
                torques.append(forces[-1] * speed)
    largest = {
        "reaction": np.max(np.broadcast_arrays(*forces), axis=0),
        "torque": np.max(np.broadcast_arrays(*torques), axis=0),
    }
    return {name: found[name] if name in found else largest[name[0]] for name in sizes}
