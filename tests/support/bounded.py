"""Random machines of every kind, near every singular place and of every size, and their errors beside proven bounds."""

import warnings
from typing import Any, NamedTuple

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.engines import COMPILED, NUMPY
from kinetostatics.errors import KinetostaticsError
from kinetostatics.machine.guide import Guide
from kinetostatics.mechanics.quantities import components, of_scene
from kinetostatics.numbers.parameter_tree import map_numbers
from kinetostatics.studies.methods.high_precision.enclosures import on_arb
from kinetostatics.studies.stability import PLACES

from . import chains
from .case_files import shipped
from .inclined import INCLINED

BITS = 200
FAMILIES = (
    *("chain", "plain", "four-bar", "cam", "place", "scaled", "rubbing", "shipped", "inclined"),
    *("steep", "lever", "passing", "stiff"),
)
AT_PLACES = {"place": PLACES, "inclined": INCLINED}
"""Families of few structures, whose numbers are exact."""
CASES = "sawframe_2r63", "chain_unit", "toggle_press", "mower_drive", "v_twin", "shaper", "compressor"
OVER_WORST = {
    ("sawframe_2r63", "plain"): {"double": 20, "single": 20},
    ("sawframe_2r63", "cam-cosine"): {"double": 60, "single": 60},
    ("chain_unit", "rho-0.5"): {"double": 150, "single": 250},
    ("toggle_press", "coining"): {"double": 100, "single": 100},
    ("compressor", "loaded"): {"single": 100},
    ("pumpjack", "weights"): {"double": 50},
}
"""By case and variant how many times the worst error of a turn the worst bound may be, in each precision."""
ENGINES: dict[str, Any] = {"numpy": NUMPY, "compiled": COMPILED}


class Found(NamedTuple):
    """Values evaluated, those off by more than their bound, those without one, and the worst share of a bound."""

    values: int
    wrong: list
    unbounded: int
    share: float


def over_worst(precision):
    """Rows (case, variant, most) of `OVER_WORST`."""
    return [(*names, most[precision]) for names, most in OVER_WORST.items() if precision in most]


def solution(family, seed, count=5):
    """A random solution of a family at some crank angles, or None if it has none."""
    rng = np.random.default_rng([FAMILIES.index(family), seed])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return _made(family, rng, count)
        except KinetostaticsError:
            return None


def other_numbers(solution, seed, spread=0.02):
    """A solution of the same structure, each number but those of guides off by a random part of it."""
    rng = np.random.default_rng(seed)

    def number(value):
        return value * (1.0 + spread * rng.uniform(-1, 1)) if isinstance(value, float) else value

    parts = solution.mechanism, solution.crank_speed, solution.crank_acceleration, solution.loads, solution.friction
    return _solved(*(map_numbers(part, number, {Guide: lambda own: own}) for part in parts), solution.crank_angle)


def _solved(mechanism, speed, acceleration, given, friction, angles):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ks.Scene(mechanism, speed, acceleration, given, friction).solve(angles, on_gap="nan")


def _made(family, rng, count):
    if family == "chain":
        scene, (low, *_, high) = chains.chain(int(rng.integers(1 << 30)), int(rng.integers(1, 5)))
        return scene.solve(rng.uniform(low, high, count), on_gap="nan")
    if family in AT_PLACES:
        places = AT_PLACES[family]
        place = places[rng.integers(len(places))]
        found = place.scene(place.numbers[rng.integers(len(place.numbers))])
        angles = rng.choice(found.crank_angle.ravel(), count)
        return _solved(found.mechanism, found.crank_speed, 0.0, found.loads, found.friction, angles)
    if family == "steep":
        return _steep(rng, count)
    if family == "stiff":
        return _stiff(rng, count)
    if family == "shipped":
        variants = shipped(str(rng.choice(CASES))).variants
        scene = variants[str(rng.choice(list(variants)))].scene
        return scene.solve(rng.uniform(-7, 7, count), on_gap="nan")
    if family in PASSING:
        mechanism, angles = PASSING[family](rng)
        steps = rng.choice((-1.0, 1.0), count) * 10.0 ** -rng.uniform(0.0, 17.0, count)
        return _solved(
            mechanism, rng.uniform(1, 50), rng.uniform(-50, 50), [ks.Gravity()], {}, rng.choice(angles) + steps
        )
    size, mass = (10.0 ** rng.uniform(-6, 6), 10.0 ** rng.uniform(-12, 12)) if family == "scaled" else (1.0, 1.0)
    mechanism = _mechanism("plain" if family in ("scaled", "rubbing") else family, rng, size, mass)
    made = [chains.load(rng, kind, mechanism, size) for kind in rng.choice(chains.LOAD_KINDS, 3)]
    friction = {"O": ks.PinFriction(rng.uniform(0, 0.1), 0.01 * size)} if family == "rubbing" else {}
    return ks.solve(
        mechanism,
        rng.uniform(-1, 1, count) * 10.0 ** rng.uniform(-9, 4, count),
        crank_speed=rng.uniform(-50, 50),
        crank_acceleration=rng.uniform(-50, 50),
        loads=[load for load in made if load is not None],
        friction=friction,
        on_gap="nan",
    )


def _steep(rng, count):
    """A scene with a table over travel, some rows as near to each other as may be, at angles of which some are at rows.

    None if there is no slider.
    """
    base = _made(str(rng.choice(("chain", "plain"))), rng, count)
    if not base.mechanism.guides:
        return None
    slider = str(rng.choice(list(base.mechanism.guides)))
    travel = base.mechanism.place(np.linspace(0.0, 2.0 * np.pi, 720)).travels[slider].position
    low, high = float(np.nanmin(travel)), float(np.nanmax(travel))
    x, span = rng.uniform(low, high, 6), high - low
    x = np.sort(np.concatenate([x, x[:3] + span * 10.0 ** rng.uniform(-9, -1, 3), [low - span, high + span]]))
    back = rng.uniform(-99, 99, x.size) if rng.integers(2) else None
    table = ks.Table(x, rng.uniform(-99, 99, x.size), over="travel", back=back, slider=slider)
    given = [*base.loads, ks.ProcessForce(table, slider)]
    made = _solved(base.mechanism, base.crank_speed, base.crank_acceleration, given, {}, base.crank_angle)
    kinks = np.concatenate([*table.kinks(made.dynamics), base.crank_angle])
    beside = rng.choice(kinks, count) + rng.choice((-1.0, 0.0, 1.0), count) * 10.0 ** rng.uniform(-17, -1, count)
    return _solved(base.mechanism, base.crank_speed, base.crank_acceleration, given, {}, beside)


def _stiff(rng, count):
    """A slider moved by a harmonic cam, with springs whose force along the guide grows or shrinks with the cube."""
    mean, orders = rng.uniform(0.1, 0.5), 1.0 + np.arange(rng.integers(1, 6))
    even, odd = (mean * rng.uniform(-0.3, 0.3, orders.size) / orders**2 for _ in range(2))
    cam = ks.cams.Harmonic((mean, *even), tuple(odd * rng.integers(2)), rng.uniform(-3, 3) * rng.integers(2))
    length, offset = mean * rng.uniform(1.8, 9.0), mean * rng.uniform(-0.3, 0.3) * rng.integers(2)
    bodies = {name: _body(rng) for name in ("crank", "block", "coupler", "slider")}
    machine = ks.cam_crank_slider(
        cam, length, guide_angle=rng.uniform(-3, 3) * rng.integers(2), guide_offset=offset, **bodies
    )
    speed = rng.uniform(1, 50)
    rate = machine.links["slider"].mass * speed * speed * rng.uniform(0.5, 2.0)
    springs = [
        ks.Spring(rate * rng.integers(2), length + mean * rng.uniform(-1, 1), cubic=rate * rng.uniform(-1, 2) / mean**2)
        for _ in range(rng.integers(1, 3))
    ]
    turn = rng.uniform(-4, 4, count) * 10.0 ** -rng.uniform(0, 9, count)
    return _solved(machine, speed, rng.uniform(-9, 9) * rng.integers(2), [*springs, ks.Gravity()], {}, turn)


def _body(rng, size=1.0, mass=1.0):
    return ks.Link(
        mass * rng.uniform(0.1, 9), tuple(size * rng.uniform(-1, 1, 2)), mass * size**2 * rng.uniform(0.1, 2)
    )


def _slotted(rng):
    """Slotted lever whose pivot stands anywhere, and the crank angles at which the pin is nearest and farthest."""
    crank, ahead = rng.uniform(0.1, 0.5), rng.choice((0.0, 0.5 * np.pi, rng.uniform(-3, 3)))
    away = crank * rng.choice((1.0 + 10.0 ** -rng.uniform(0, 15) * rng.choice((-1, 1)), rng.uniform(0.2, 4)))
    offset = rng.choice((0.0, rng.uniform(-1, 1) * abs(away - crank), 0.9 * crank))
    bodies = dict(zip(("crank", "lever", "block"), (_body(rng) for _ in range(3)), strict=True))
    pivot = away * np.cos(ahead), away * np.sin(ahead)
    lever = ks.slotted_lever(crank, pivot=pivot, offset=offset, assembly=int(rng.choice((-1, 1))), **bodies)
    return lever, (ahead, ahead + np.pi)


def _on_a_word(rng):
    """Linkage that passes change points, its pivot anywhere where its distance is exact, and their crank angles."""
    a, b, h, d = rng.choice([(1, 2, 1, 2), (2, 2, 1, 1), (1, 2, 2, 1), (1, 1, 1, 1), (1, 3, 2, 4), (2, 5, 4, 1)]) / 8.0
    (x, y), word = (
        ((1, 0), (0, -1), (-1, 0), (0.6, 0.8), (-0.8, 0.6))[rng.integers(5)],
        str(rng.choice(("open", "crossed"))),
    )
    pivot, ahead = (5 * d * x, 5 * d * y), np.arctan2(y, x)
    if rng.integers(2):
        bodies = dict(zip(("crank", "coupler", "rocker"), (_body(rng) for _ in range(3)), strict=True))
        made = ks.four_bar(5 * a, 5 * b, 5 * h, rocker_pivot=pivot, assembly=word, **bodies)
    else:
        bodies = dict(zip(("crank", "lever", "block"), (_body(rng) for _ in range(3)), strict=True))
        made = ks.slotted_lever(5 * a, pivot=pivot, offset=5 * (d - a), assembly=word, **bodies)
    return made, (ahead, ahead + np.pi)


PASSING = {"lever": _slotted, "passing": _on_a_word}
"""Families looked at around crank angles: mechanism and angles of a random one."""


def _mechanism(family, rng, size, mass):
    def body():
        return _body(rng, size, mass)

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


def errors(solution, names=None, engine="numpy", tight=False):
    """Every quantity of a solution, or some, by one program, beside the kernels on arb numbers."""
    from flint import arb, ctx

    known, wrong, total, unbounded, share = of_scene(solution), [], 0, 0, 0.0
    names = tuple(names or known)
    values, bounds = ENGINES[engine].with_bounds(solution.dynamics, names, tight)
    with ctx.workprec(BITS):
        exact = on_arb(arb, solution)
        for name in names:
            for value, bound, middle in zip(
                _rows(known[name], values[name]),
                _rows(known[name], bounds[name]),
                components(exact, name),
                strict=True,
            ):
                truth = [arb(part) for part in np.broadcast_to(np.asarray(middle, dtype=object), np.shape(value))]
                told = np.isfinite(value) & [part.is_finite() for part in truth]
                total += np.count_nonzero(told)
                unbounded += np.count_nonzero(told & ~np.isfinite(bound))
                for place in np.flatnonzero(told & np.isfinite(bound)):
                    error = abs(arb(float(value[place])) - truth[place]).abs_lower()
                    if not error <= arb(float(bound[place])):
                        wrong.append((name, float(solution.crank_angle[place]), float(error), float(bound[place])))
                    if bound[place] > 0:
                        share = max(share, float(error) / bound[place])
    return Found(total, wrong, unbounded, share)


def _rows(quantity, found):
    return np.asarray(found) if quantity.vector else np.reshape(np.asarray(found), (1, -1))
