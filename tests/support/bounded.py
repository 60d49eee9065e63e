"""Random machines of every kind, near every singular place and of every size, and their errors beside proven bounds."""

import warnings
from typing import NamedTuple

import numpy as np

import kinetostatics as ks
from kinetostatics.errors import KinetostaticsError
from kinetostatics.mechanics.quantities import components, of_scene
from kinetostatics.numbers.leaves import with_fields
from kinetostatics.studies.methods.enclosures import on_arb
from kinetostatics.studies.places import PLACES

from . import chains, loads

BITS = 200
FAMILIES = "chain", "plain", "four-bar", "cam", "place", "scaled", "rubbing"


class Found(NamedTuple):
    """Values evaluated, those off by more than their bound, those without one, and the worst share of a bound."""

    values: int
    wrong: list
    unbounded: int
    share: float


def solution(family, seed, engine="numpy"):
    """A random solution of a family at a few crank angles, or None if it has none."""
    rng = np.random.default_rng([FAMILIES.index(family), seed])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return _made(family, rng, engine)
        except KinetostaticsError:
            return None


def _made(family, rng, engine):
    if family == "chain":
        scene, angles = chains.chain(int(rng.integers(1 << 30)), int(rng.integers(1, 5)))
        return scene.solve(angles, engine=engine, on_gap="nan")
    if family == "place":
        place = PLACES[rng.integers(len(PLACES))]
        found = place.scene(place.numbers[rng.integers(len(place.numbers))])
        near = rng.choice(found.crank_angle.ravel(), 5)
        return ks.solve(
            found.mechanism,
            near,
            crank_speed=found.crank_speed,
            loads=found.loads,
            engine=engine,
            on_gap="nan",
        )
    size, mass = (10.0 ** rng.uniform(-6, 6), 10.0 ** rng.uniform(-12, 12)) if family == "scaled" else (1.0, 1.0)
    mechanism = _mechanism("plain" if family in ("scaled", "rubbing") else family, rng, size, mass)
    made = [loads.load(rng, kind, mechanism, size) for kind in rng.choice(loads.KINDS, 3)]
    friction = {"O": ks.PinFriction(rng.uniform(0, 0.1), 0.01 * size)} if family == "rubbing" else {}
    return ks.solve(
        mechanism,
        rng.uniform(-1, 1, 5) * 10.0 ** rng.uniform(-9, 4, 5),
        crank_speed=rng.uniform(-50, 50),
        crank_acceleration=rng.uniform(-50, 50),
        loads=[load for load in made if load is not None],
        friction=friction,
        engine=engine,
        on_gap="nan",
    )


def _mechanism(family, rng, size, mass):
    def body():
        return ks.Link(
            mass * rng.uniform(0.1, 9), tuple(size * rng.uniform(-1, 1, 2)), mass * size**2 * rng.uniform(0.1, 2)
        )

    crank = size * rng.uniform(0.1, 0.5)
    if family == "four-bar":
        reach = crank * rng.uniform(1.5, 4)
        return ks.four_bar(
            crank,
            reach,
            reach * rng.uniform(0.8, 1.2),
            rocker_pivot=(reach * rng.uniform(0.9, 1.1), size * rng.uniform(-0.1, 0.1)),
            assembly=int(rng.choice((-1, 1))),
            crank=body(),
            coupler=body(),
            rocker=body(),
        )
    offset = crank * rng.uniform(-0.5, 0.5) * rng.integers(2)
    common = {
        "guide_angle": rng.uniform(-3, 3) * rng.integers(2),
        "guide_offset": offset,
        "crank": body(),
        "coupler": body(),
        "slider": body(),
    }
    length = crank * rng.uniform(1.01, 5) + abs(offset)
    if family == "cam":
        cam = ks.cams.Circle(crank, tuple(crank * rng.uniform(-0.2, 0.2, 2)))
        return ks.cam_crank_slider(cam, length + 0.5 * crank, block=body(), **common)
    return ks.crank_slider(crank, length, **common)


def errors(solution, names=None):
    """Every quantity of a solution, or some, beside the kernels on arb numbers."""
    from flint import arb, ctx

    known, wrong, values, unbounded, share = of_scene(solution), [], 0, 0, 0.0
    with ctx.workprec(BITS):
        exact = on_arb(arb, with_fields(solution, engine=solution.engine))
        for name in names or known:
            own, bounds = (
                _rows(known[name], found) for found in (components(solution, name), solution.error_bound(name))
            )
            for value, bound, middle in zip(own, bounds, components(exact, name), strict=True):
                for place, truth in enumerate(np.broadcast_to(np.asarray(middle, dtype=object), np.shape(value))):
                    truth = arb(truth)
                    if not (np.isfinite(value[place]) and truth.is_finite()):
                        continue
                    error = abs(arb(float(value[place])) - truth)
                    values += 1
                    unbounded += not np.isfinite(bound[place])
                    if np.isfinite(bound[place]) and not error.abs_lower() <= arb(float(bound[place])):
                        wrong.append(
                            (name, float(solution.crank_angle[place]), float(error.mid()), float(bound[place]))
                        )
                    if bound[place] > 0:
                        share = max(share, float(error.abs_lower()) / bound[place])
    return Found(values, wrong, unbounded, share)


def _rows(quantity, found):
    return np.asarray(found) if quantity.vector else np.reshape(np.asarray(found), (1, -1))
