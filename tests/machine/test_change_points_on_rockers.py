"""Four-bars that pass change points on the rocker of another one: double parallelograms, N-four-bars, rocked ones."""

from functools import cache

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies.methods.high_precision import certified
from support import multibody
from support.every import every

BODY = (1.5, (0.2, 0.05), 0.1)
LINK = ks.Link(*BODY)
INNER = {
    "parallelogram": (1.0, 1.5, 1.0, (1.5, 0.0), "open"),
    "antiparallelogram": (1.0, 1.5, 1.0, (1.5, 0.0), "crossed"),
    "long antiparallelogram": (1.0, 0.7, 1.0, (0.0, 0.7), "crossed"),
    "rhombus": (1.0, 1.0, 1.0, (1.0, 0.0), "open"),
    "crank-rocker": (0.5, 1.5, 1.0, (1.25, 0.25), 1),
    "other crank-rocker": (0.5, 1.5, 1.0, (-1.25, 0.25), -1),
    "drag link": (1.0, 1.25, 1.0, (0.25, 0.125), -1),
}
"""Crank, coupler, rocker, pivot and assembly of the four-bar on the crank."""
OUTER = {
    "parallelogram": (1.25, 1.0, 1.25, "open"),
    "antiparallelogram": (1.25, 1.0, 1.25, "crossed"),
    "short antiparallelogram": (0.75, 1.0, 0.75, "crossed"),
    "rhombus": (1.0, 1.0, 1.0, "open"),
    "open kite": (1.0, 1.5, 1.5, "open"),
    "deltoid": (1.75, 1.75, 1.0, "open"),
    "crossed deltoid": (1.75, 1.75, 1.0, "crossed"),
    "far": (1.5, 2.0, 2.5, "open"),
    "near": (2.5, 2.0, 1.5, "crossed"),
}
"""Coupler, rocker, ground, in crank lengths of 1 m, and assembly of the one on its rocker."""
PAIRS = [(list(INNER)[(place + k) % len(INNER)], outer) for place, outer in enumerate(OUTER) for k in (0, 3)]
"""Each outer four-bar on the rockers of two inner ones, and each inner one under two or more."""
UP = 1j
WAYS = {"crank-rocker": UP, "other crank-rocker": UP}
"""Direction from the rocker's pivot to that of the outer one, or back, where the rocker only swings; else 0.4 rad."""


@cache
def chain(inner, outer, way=np.exp(0.4j), **more):
    a, b, h, pivot, assembly = INNER[inner]
    b2, h2, d, word = OUTER[outer]
    way = WAYS.get(inner, way) * (-1.0 if outer == "far" and inner in WAYS else 1.0)
    place = complex(*pivot) + d * h * way
    groups = (
        ks.RockerGroup(b, h, pivot, assembly, LINK, LINK),
        ks.RockerGroup(b2 * h, h2 * h, (place.real, place.imag), word, LINK, LINK, "B", "C", "O3", label="2", **more),
    )
    return ks.Mechanism("bars on a rocker", ks.Crank(a, LINK), groups)


def solved(mechanism, angles, **others):
    drive = {"crank_speed": 3.0, "crank_acceleration": 1.5, "loads": [ks.Gravity()]} | others
    return ks.solve(mechanism, angles, **drive)


def complex_of(pair):
    return pair[0] + 1j * pair[1]


@pytest.mark.slow
@every("inner, outer", PAIRS)
def test_bars_keep_their_lengths_and_joints_run_on_without_kinks(inner, outer):
    """Over all turns: rates are those of central differences, through change points too."""
    made = chain(inner, outer)
    turn = np.linspace(0.0, 2 * np.pi * made.turns, 700)
    turn = np.sort(
        np.concatenate([turn, *(np.add.outer(made.change_points, 2 * np.pi * k).ravel() for k in range(made.turns))])
    )
    s = solved(made, turn, crank_speed=1.0, crank_acceleration=0.0)
    more, less = (solved(made, turn + way * 1e-4, crank_speed=1.0, crank_acceleration=0.0) for way in (1, -1))
    for bar in made.bars:
        assert np.abs(np.abs(complex_of(s.position(bar.end) - s.position(bar.start))) - bar.length).max() < 1e-14
    for value, rate in ((lambda s: s.position("C"), s.velocity("C")), (lambda s: s.velocity("C"), s.acceleration("C"))):
        slope = (value(more) - value(less)) / 2e-4
        assert np.abs(slope - rate).max() < 1e-5 * np.abs(rate).max()
    for link in ("coupler2", "rocker2"):
        slope = (more.rate(link) - less.rate(link)) / 2e-4
        rate = s.angular_acceleration(link)
        assert np.abs(slope - rate).max() < 1e-5 * (np.abs(rate).max() + 1.0)


@pytest.mark.slow
@every("inner, outer", PAIRS)
def test_motion_repeats_after_its_turns(inner, outer):
    made, turn = chain(inner, outer), np.linspace(0.1, 6.0, 40)
    first, again = (solved(made, turn + angle).position("C") for angle in (0.0, 2 * np.pi * made.turns))
    assert np.abs(first - again).max() < 1e-12
    half = solved(made, turn + np.pi * made.turns).position("C")
    assert made.turns == 1 or np.abs(first - half).max() > 0.1


@pytest.mark.slow
@every("inner, outer", PAIRS)
def test_change_points_are_where_the_side_of_the_pin_changes(inner, outer):
    made = chain(inner, outer)
    turn = np.linspace(0.0, 2 * np.pi, 5000) + 0.05
    s, found = solved(made, turn), np.array(made.change_points)
    B, C, O3 = (complex_of(s.position(name)) for name in ("B", "C", "O3"))
    side = np.sign(np.imag(np.conj(O3 - B) * (C - B)))
    changes = turn[:-1][side[1:] != side[:-1]] % (2 * np.pi)
    assert changes.size
    for angle in changes:
        assert np.abs(np.exp(1j * found) - np.exp(1j * angle)).min() < 2e-3


@pytest.mark.slow
@every("inner, outer", [("drag link", "far"), ("crank-rocker", "antiparallelogram"), ("rhombus", "deltoid")])
def test_joints_do_not_jump_over_a_dense_turn(inner, outer):
    made = chain(inner, outer)
    s = solved(made, np.linspace(0.0, 2 * np.pi * made.turns, 4001), crank_speed=1.0)
    for name in made.joints:
        step = np.hypot(*np.diff(s.position(name)))
        assert step.max() <= 1.01 * np.hypot(*s.velocity(name)).max() * 2 * np.pi * made.turns / 4000
        assert np.abs(s.position(name)[:, 0] - s.position(name)[:, -1]).max() < 1e-13


# Forces, by Newton-Euler equations of all bodies


def system(made, angle):
    """The chain as a system of bodies; the sides on which pins stand are looked up at the angle."""
    s, bodies, poses, joints = solved(made, angle), {}, {}, {}
    ends = {"O": lambda phi: mp.mpc(0), "A": lambda phi: mp.mpf(made.crank.length) * mp.expj(phi)}
    inner = {"A": "crank", "B": "rocker"}
    for group in made.groups:
        on, pin, pivot = group.on, group.pin, mp.mpc(*group.pivot)
        to_pin, to_pivot = (complex_of(s.position(name) - s.position(on)) for name in (pin, group.pivot_name))
        side = np.sign(np.imag(np.conj(to_pivot) * to_pin))
        lengths = mp.mpf(group.coupler_length), mp.mpf(group.rocker_length)
        start = ends[on]
        end = lambda phi, given=(start, *lengths, pivot, side): multibody.circles_meet(  # noqa: E731
            given[0](phi), given[1], given[3], given[2], given[4]
        )
        fixed = lambda phi, pivot=pivot: pivot  # noqa: E731
        ends |= {pin: end, group.pivot_name: fixed}
        coupler, rocker = group.links
        for name, (first, last), size in zip(group.links, ((start, end), (fixed, end)), lengths, strict=True):
            bodies[name] = multibody.Body(*BODY)
            poses[name] = first, lambda phi, given=(first, last, size): (given[1](phi) - given[0](phi)) / given[2]
        joints |= {
            on + group.label: multibody.Pin(coupler, inner[on], start),
            pin: multibody.Pin(rocker, coupler, end),
            group.pivot_name: multibody.Pin(rocker, None, fixed),
        }
    bodies["crank"], poses["crank"] = multibody.Body(*BODY), (ends["O"], mp.expj)
    joints["O"] = multibody.Pin("crank", None, ends["O"])
    return multibody.System(bodies, poses, joints, 3.0, 1.5, mp.mpc(0, -9.81), digits=60), s


def errors(made, angle):
    """Errors of reactions and torque, relative to the largest force that stays finite at the change points."""
    bodies, s = system(made, angle)
    found = bodies.solve(angle)
    size = max(abs(found["A"]), abs(found["shaking_force"]), 1.0)
    return {name: abs(complex_of(s.reaction(name)) - found[name]) / size for name in bodies.joints} | {
        "torque": abs(float(s.balancing_torque) - found["balancing_torque"]) / size
    }


@pytest.mark.slow
@every("inner, outer", PAIRS[::2])
def test_forces_obey_newton(inner, outer):
    assert max(errors(chain(inner, outer), 1.234).values()) < 1e-11


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("inner", ["crank-rocker", "drag link"])
@every("outer", ["antiparallelogram", "near"])
def test_forces_on_the_other_bars_stay_right_beside_change_points(inner, outer):
    """Torque and forces of the inner bars lose no digit, those that grow the digits by which they do."""
    made = chain(inner, outer, UP)
    for away in (1e-3, 1e-6, -1e-9):
        found = errors(made, made.change_points[0] + away)
        finite = {name: found.pop(name) for name in ("O", "A", "B", "torque")}
        assert max(finite.values()) < 1e-11
        assert max(found.values()) < 1e-15 / away**2


def test_double_parallelogram_translates():
    """Three uprights turn as one and both level bars stay level: a locomotive's wheels; torque in closed form."""
    bar = ks.Link(2.0, 0.5, 2.0 / 12)
    groups = (
        ks.RockerGroup(1.5, 1.0, (1.5, 0.0), "open", ks.Link(3.0, 0.6), bar),
        ks.RockerGroup(0.7, 1.0, (2.2, 0.0), "open", ks.Link(1.0, 0.2), bar, "B", "C", "O3", label="2"),
    )
    made = ks.Mechanism("double parallelogram", ks.Crank(1.0, bar), groups)
    turn = np.linspace(-7.0, 7.0, 201)
    for speed in (3.0, -3.0):
        s = solved(made, turn, crank_speed=speed)
        for link in ("coupler", "coupler2"):
            assert not s.rate(link).any()
            assert not s.angular_acceleration(link).any()
        for link in ("rocker", "rocker2"):
            assert np.array_equal(s.rate(link), np.full(201, speed))
        torque = (3 * 2.0 / 3 + 3.0 + 1.0) * 1.5 + (3 * 2.0 * 0.5 + 4.0) * 9.81 * np.cos(turn)
        assert np.allclose(s.balancing_torque, torque, rtol=0, atol=1e-13 * 70.0)
    assert made.change_points == (0.0, np.pi)


@pytest.mark.slow
def test_forces_grow_at_the_outer_bars_alone():
    made = chain("crank-rocker", "antiparallelogram")
    assert {name for name in ("O", "A", "B", "O2", "B2", "C", "O3", "ground") if made.grows(name)} == {
        "O2",
        "B2",
        "C",
        "O3",
        "ground",
    }
    s = solved(made, np.array(made.change_points[:1]))
    with pytest.warns(ks.ConditionWarning, match="C is .* at a change point that the mechanism passes"):
        assert np.abs(s.reaction("C")).max() > 1e14
    assert np.isfinite(s.reaction("A")).all()
    assert np.isfinite(ks.extremes(s, "A").range).all()
    with pytest.warns(ks.ConditionWarning, match="O2 grows without bound"):
        assert np.isinf(ks.extremes(s, "O2").range[1])


def test_two_change_points_at_once():
    """Forces are infinite in a crank angle that meets both; of the sum of two at O2 nothing is known."""
    s = solved(chain("parallelogram", "parallelogram", 1.0 + 0j), np.array([0.0, 1.0]))
    with pytest.warns(ks.ConditionWarning):
        forces = {name: s.reaction(name)[:, 0] for name in s.reactions}
    assert {name for name, force in forces.items() if np.isnan(force).any()} == {"O2"}
    assert {name for name, force in forces.items() if np.isinf(force).any()} == {"O", "A", "B", "B2", "C", "O3"}
    assert np.isfinite(s.balancing_torque).all()


# Engines, designs, case files


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow)])
def test_programs_and_derivatives(engine):
    scene = ks.Scene(chain("drag link", "near"), 3.0, 1.5, [ks.Gravity()], {"O3": ks.PinFriction(0.1, 0.05)})
    program = ks.compile(scene, ("balancing_torque", "A", "C"), engine=engine)
    turn, path = np.linspace(0.3, 9.0, 12), "rocker2.mass"
    s = scene.solve(turn)
    for name, value in program(turn).items():
        expected = s.balancing_torque if name == "balancing_torque" else s.reaction(name)
        assert np.allclose(value, expected, rtol=0, atol=1e-11 * np.abs(expected).max())
    slope = program.derivatives(turn, by=path)["balancing_torque"][path]
    more, less = (scene.varied({path: 1.5 + way * 1e-3}).solve(turn).balancing_torque for way in (1, -1))
    assert np.allclose(slope, (more - less) / 2e-3, rtol=0, atol=1e-9 * np.abs(slope).max())
    for length in ("rocker_length", "coupler_length2", "rocker_pivot2.x", "rocker_pivot.y"):
        with pytest.raises(ks.ParameterError, match="with any other length it would be of another kind"):
            program.derivatives(turn, by=length)
    with pytest.raises(ks.ParameterError, match="another kind"):
        program(turn, {"coupler_length2": 2.6})


@pytest.mark.slow
@every("inner, outer", [pair for pair in PAIRS[::2] if "long" not in pair[0]])
def test_independent_formulas_confirm_30_digits(flint, inner, outer):
    s = solved(chain(inner, outer, UP), np.array([0.3, 2.0, 7.9]))
    for quantity in ("balancing_torque", "A", "C"):
        assert certified.certified(s, quantity).agreement < 1e-30


@pytest.mark.slow
def test_bounds_cover_the_independent_path(flint):
    s = solved(chain("crank-rocker", "antiparallelogram", UP), np.array([0.3, 2.0]))
    (exact,) = certified.certified(s, "balancing_torque").middle
    assert (np.abs(s.balancing_torque - exact) <= s.error_bound("balancing_torque")).all()


def test_designs_of_a_batch():
    lengths = np.array([[1.25], [1.5]])
    groups = (
        ks.RockerGroup(1.5, 1.0, (1.5, 0.0), "open", LINK, LINK),
        ks.RockerGroup(lengths, 1.0, (1.5 + lengths, 0.0), "crossed", LINK, LINK, "B", "C", "O3", label="2"),
    )
    together = solved(ks.Mechanism("bars", ks.Crank(1.0, LINK), groups), np.linspace(0.1, 6.0, 9)).balancing_torque
    for row, length in enumerate(lengths[:, 0].tolist()):
        outer = ks.RockerGroup(length, 1.0, (1.5 + length, 0.0), "crossed", LINK, LINK, "B", "C", "O3", label="2")
        alone = ks.Mechanism("bars", ks.Crank(1.0, LINK), (groups[0], outer))
        assert np.allclose(together[row], solved(alone, np.linspace(0.1, 6.0, 9)).balancing_torque, rtol=1e-13)


CASE = """
title = "Wheels"
reference = "wheels"
[variants.wheels]
mechanism = "chain"
crank_speed = "60 rpm"
crank_length = "1 m"
gravity = {}
[[variants.wheels.groups]]
kind = "rocker"
coupler_length = "1.5 m"
rocker_length = "1 m"
pivot = ["1.5 m", "0 m"]
assembly = "open"
coupler = { mass = "3 kg", centre = "mid-length" }
[[variants.wheels.groups]]
kind = "rocker"
on = "B"
pin = "C"
pivot_name = "O3"
label = "2"
coupler_length = "0.7 m"
rocker_length = "1 m"
pivot = ["2.2 m", "0 m"]
assembly = "open"
"""


def test_case_file(tmp_path):
    path = tmp_path / "wheels.toml"
    path.write_text(CASE)
    s = ks.load_case(path).solve("wheels", 36)
    assert s.mechanism.groups[1].passage == "parallel 0 1 0 rocker"
    assert np.array_equal(s.rate("rocker2"), s.rate("rocker"))
    path.write_text(CASE.replace('on = "B"', 'on = "O2"'))
    with pytest.raises(ks.CaseError, match="or of a rocker, but it is attached to 'O2'; give"):
        ks.load_case(path)


# What cannot be passed


def _made(inner, **outer):
    a, *rest = inner
    given = {"coupler_length": 1.5, "rocker_length": 1.0, "pivot": (3.0, 0.0), "assembly": "open"} | outer
    names = {"on": "B", "pin": "C", "pivot_name": "O3", "label": "2"} | {k: given.pop(k) for k in ("on",) if k in given}
    return ks.Mechanism("bars", ks.Crank(a), (ks.RockerGroup(*rest), ks.RockerGroup(**given, **names)))


WRONG = {
    "a joint that is not there": (
        lambda: _made((1.0, 1.5, 1.0, (1.5, 0.0)), on="X"),
        "or of a rocker, but it is attached to 'X'",
    ),
    "a fixed joint": (
        lambda: _made((1.0, 1.5, 1.0, (1.5, 0.0)), on="O2"),
        "or of a rocker, but it is attached to 'O2'",
    ),
    "a rocker that stands": (
        lambda: _made((1.0, 1.0, 1.0, (1.0, 0.0), "crossed"), pivot=(2.5, 0.0)),
        "the rocker stands still",
    ),
    "one of two turns": (
        lambda: (
            _made((1.0, 3.0, 1.0, (3.0, 0.0), "open"))
            and _made((1.0, 3.0, 2.0, (4.0, 0.0), "open"), rocker_length=2.0, pivot=(5.5, 0.0))
        ),
        "does not repeat its motion after a turn",
    ),
    "one that does not close": (
        lambda: _made((1.0, 1.0, 1.0, (1.5, 0.0), 1)),
        "does not repeat its motion after a turn",
    ),
    "a slider": (
        lambda: ks.Mechanism(
            "bars",
            ks.Crank(1.0),
            (ks.RockerGroup(1.5, 1.0, (1.5, 0.0)), ks.SliderGroup(1.0, assembly="open", on="B", pin="C", label="2")),
        ),
        "for a group on a pin of the crank at a constant radius, but it is attached to 'B'",
    ),
    "designs of several kinds": (
        lambda: _made((1.0, 1.5, 1.0, (1.5, 0.0), "open"), coupler_length=np.array([[1.5], [1.6]])),
        "must be of one kind",
    ),
}


@every("name", WRONG)
def test_what_cannot_be_passed_is_refused(name):
    make, words = WRONG[name]
    with pytest.raises(ks.ParameterError, match=words) as caught:
        make()
    assert type(caught.value) is ks.ParameterError


def test_bars_without_change_points_keep_their_side():
    made = chain("drag link", "parallelogram")
    outer = ks.RockerGroup(1.3, 1.25, made.groups[1].pivot, "crossed", on="B", pin="C", pivot_name="O3", label="2")
    chosen = ks.RockerGroup(1.3, 1.25, made.groups[1].pivot, -1, on="B", pin="C", pivot_name="O3", label="2")
    both = [ks.Mechanism("bars", made.crank, (made.groups[0], group)) for group in (outer, chosen)]
    first, second = (solved(item, np.linspace(0.0, 6.0, 20), on_gap="nan").position("C") for item in both)
    assert np.array_equal(first, second, equal_nan=True)
    assert not both[0].passes
