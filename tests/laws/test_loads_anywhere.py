"""Loads on any link of any chain: against the full Newton-Euler system, and by laws that every load keeps."""

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies.methods.global_system import constraints, newton
from support.chains import LOAD_KINDS, between, load
from support.machines import largest, planar
from support.scenes import six_bar

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")

ANGLES = np.linspace(0.1, 6.2, 13)
TURN = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)


def link(random):
    along, across = random.uniform(-0.1, 0.3, 2).tolist()
    return ks.Link(random.uniform(0.1, 3.0), (along, across), random.uniform(0.001, 0.1))


def rocker(random, **names):
    lengths = 0.4 + random.uniform(0, 0.1), 0.3 + random.uniform(0, 0.05)
    pivot = 0.35 + random.uniform(-0.03, 0.03), random.uniform(-0.1, 0.1)
    return ks.RockerGroup(*lengths, pivot, int(random.choice([-1, 1])), link(random), link(random), **names)


def far_rocker(random, **names):
    lengths = 1.3 + random.uniform(0, 0.1), 1.2 + random.uniform(0, 0.1)
    pivot = random.uniform(1.0, 1.1), random.uniform(-0.3, 0.3)
    return ks.RockerGroup(*lengths, pivot, int(random.choice([-1, 1])), link(random), link(random), **names)


def slider(random, **names):
    guide = ks.Guide.at(random.uniform(-3, 3), random.uniform(-0.05, 0.05))
    return ks.SliderGroup(
        0.6 + random.uniform(0, 0.2), guide, int(random.choice([-1, 1])), link(random), link(random), **names
    )


SECOND = {"on": "B", "pin": "C", "label": "2"}
CHAINS = {
    "crank-slider": ((slider, {}),),
    "four-bar": ((rocker, {}),),
    "six-bar with a slider": ((rocker, {}), (slider, SECOND)),
    "six-bar with a rocker": ((rocker, {}), (far_rocker, {**SECOND, "pivot_name": "O3"})),
    "V engine": ((slider, {}), (slider, {"pin": "C", "label": "2"})),
}


def chain(random, name):
    crank = ks.Crank(0.1, link(random))
    return ks.Mechanism(name, crank, tuple(make(random, **names) for make, names in CHAINS[name]))


def cam(random):
    links = {name: link(random) for name in ("crank", "block", "coupler", "slider")}
    return ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.01)), 2.0, **links)


def solved(random, mechanism, loads, angles=ANGLES, **options):
    """Solution at a random speed; it may not close at all of the angles."""
    options = {"crank_speed": random.uniform(3, 20), "crank_acceleration": random.uniform(-20, 20)} | options
    return ks.solve(mechanism, angles, loads=loads, **options)


def by_newton_euler(s, names):
    """Forces from the equations of all bodies at once, at the positions that the solution has."""
    model = newton.model_of(s, "O")
    links = [s.placement.links[name] for name in model.names]
    shape = s.crank_angle.shape
    x, y = (np.array([np.broadcast_to(m.joint.position[k], shape) for m in links]) for k in (0, 1))
    theta = np.array([np.broadcast_to(np.arctan2(m.direction[1], m.direction[0]), shape) for m in links])
    q = np.concatenate([x, y, theta]).T
    return {name: np.array(constraints.components(model, s, name, q)) for name in names}


@pytest.mark.slow
@pytest.mark.parametrize("kind", LOAD_KINDS)
@pytest.mark.parametrize("name", [*CHAINS, "cam"])
def test_any_load_agrees_with_the_full_system(name, kind):
    tried = 0
    for seed in range(3):
        random = np.random.default_rng([seed, LOAD_KINDS.index(kind)])
        mechanism = cam(random) if name == "cam" else chain(random, name)
        item = load(random, kind, mechanism)
        if item is None:
            continue
        try:
            s = solved(random, mechanism, [item, load(random, "Force", mechanism)])
        except ks.AssemblyError:
            continue
        tried += 1
        assert s.power_residual <= 1e-13
        for quantity, expected in by_newton_euler(s, (*s.reactions, "balancing_torque")).items():
            torque = quantity == "balancing_torque"
            found = s.balancing_torque[None] if torque else s.reaction(quantity)
            size = max(largest(expected), s.largest_torque_term if torque else s.largest_force_term)
            assert largest(found - expected) <= 1e-11 * size, (seed, quantity, item)
    assert tried or kind in ("Spring", "ProcessForce")


@pytest.mark.slow
def test_loads_superpose():
    """Two of each kind: what each adds to the forces of the bare machine makes up what all add together."""
    random = np.random.default_rng(0)
    each = [load(random, kind, six_bar()) for kind in LOAD_KINDS * 2]
    together, bare, *alone = (
        ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=loads) for loads in (each, [], *([one] for one in each))
    )
    for name in together.reactions:
        added = [s.reaction(name) - bare.reaction(name) for s in alone]
        size = max(map(largest, added))
        assert largest(bare.reaction(name) + sum(added) - together.reaction(name)) < 1e-12 * size


@pytest.mark.parametrize("engine", ["compiled", "arb"])
@pytest.mark.parametrize("kind", LOAD_KINDS)
def test_every_engine_gives_the_same_under_any_load(kind, engine):
    item = load(np.random.default_rng(3), kind, six_bar())
    s = ks.solve(six_bar(), ANGLES[::4], crank_speed=9.0, crank_acceleration=-4.0, loads=item)
    if engine == "compiled":
        pytest.importorskip("numba")
        program = ks.compile(ks.Scene(six_bar(), 9.0, -4.0, item), "balancing_torque", engine="numpy")
        found = program(ANGLES[::4])["balancing_torque"]
    else:
        pytest.importorskip("flint")
        from kinetostatics.studies.methods.high_precision.enclosures import enclosure

        (found,) = enclosure(s, "balancing_torque").middle
    assert largest(found - s.balancing_torque) < 1e-13 * max(largest(found), s.largest_torque_term)


NUMBERS = ("Spring", "PointSpring", "PointDamper", "TorsionSpring", "TorsionDamper")


def loaded():
    """The six-bar under one load of each kind, all numbers."""
    return (
        ks.Spring(300.0, 0.4, "slider2", 500.0),
        ks.GasSpring(1e-3, 2e-4, 3e5, at=0.57, side=-1, on="slider2"),
        ks.Force(40.0, at=("coupler", 0.1, 0.05), direction=0.4, along="rocker"),
        ks.PointForce(30.0, between=("C", (0.1, 0.9))),
        ks.PointSpring(200.0, 0.15, between=(("coupler2", 0.2, 0.1), (0.3, 0.8))),
        ks.PointDamper(9.0, between=("A", ("rocker", 0.1, -0.2))),
        ks.Torque(11.0, on="rocker", against="coupler2"),
        ks.TorsionSpring(25.0, 1.2, on="rocker", moment=3.0),
        ks.TorsionDamper(0.7, on="coupler", against="crank"),
    )


@pytest.mark.slow
def test_load_derivatives_equal_differences():
    scene = ks.Scene(six_bar(), 9.0, -4.0, loaded())
    program = ks.compile(scene, ("balancing_torque", "B"), engine="numpy")
    paths = [path for path in program.parameters if not path.startswith(("crank_", "gravity"))]
    assert {
        "spring.cubic",
        "gas_spring.area",
        "gas_spring.volume",
        "gas_spring.pressure",
        "gas_spring.at",
        "gas_spring.exponent",
        "gas_spring.ambient",
        "force.value",
        "force.direction",
        "force.at.along",
        "force.at.across",
        "point_force.value",
        "point_force.between.2.y",
        "point_spring.stiffness",
        "point_spring.free_length",
        "point_spring.between.1.across",
        "point_damper.coefficient",
        "torque.value",
        "torsion_spring.stiffness",
        "torsion_spring.free_angle",
        "torsion_spring.moment",
        "torsion_damper.coefficient",
    } <= set(paths)
    exact = program.derivatives(ANGLES, paths)
    for path in paths:
        value, step = program.parameters[path], 1e-5 * max(1e-2, abs(program.parameters[path]))
        above, below = (program(ANGLES, {path: value + sign * step}) for sign in (1, -1))
        for quantity in program.quantities:
            found, slope = exact[quantity][path], (above[quantity] - below[quantity]) / (2 * step)
            size = largest(above[quantity]) / max(abs(value), 1e-2)
            assert largest(found - slope) < 1e-6 * max(largest(found), 1e-3 * size), (path, quantity)


def test_mpmath_agrees_under_all_loads():
    pytest.importorskip("mpmath")
    pytest.importorskip("flint")
    from kinetostatics.studies.methods.high_precision.enclosures import enclosure
    from kinetostatics.studies.methods.high_precision.independent import independent

    table = ks.Table([0.2, 0.5, 0.9], [3.0, -2.0, 8.0], over="travel", back=[1.0, 2.0, 3.0])
    s = ks.solve(
        six_bar(), [0.7, 4.0], crank_speed=9.0, crank_acceleration=-4.0, loads=(*loaded(), ks.Force(table, at="B"))
    )
    for quantity in ("balancing_torque", "B2"):
        exact = enclosure(s, quantity).exact
        for found, expected in zip(independent(s, quantity, range(2)), exact, strict=True):
            for one, other in zip(found, expected, strict=True):
                with mp.workdps(40):
                    assert abs(one - mp.mpf(other.str(40, radius=False))) < 1e-25 * abs(one)


def test_a_second_load_of_a_kind_has_a_path_of_its_own():
    scene = ks.Scene(six_bar(), 9.0, 0.0, [ks.Force(1.0, at="B"), ks.Force(2.0, at="C"), ks.Torque(3.0, on="rocker")])
    assert scene.parameters["force2.value"] == 2.0
    assert scene.varied({"force2.value": 5.0, "torque.value": 4.0}).loads[1].value == 5.0


def test_load_designs_make_a_batch():
    import pandas as pd

    values = np.array([[10.0], [20.0], [40.0]])
    loads = [
        ks.PointSpring(values, 0.1 + values / 1e3, between=("C", (0.0, 0.9))),
        ks.Force(values, at=("rocker", 0.1)),
    ]
    together = ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=loads)
    assert together.balancing_torque.shape == (3, 13)
    alone = [ks.PointSpring(20.0, 0.12, between=("C", (0.0, 0.9))), ks.Force(20.0, at=("rocker", 0.1))]
    expected = ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=alone)
    assert largest(together.balancing_torque[1] - expected.balancing_torque) < 1e-13 * largest(
        expected.balancing_torque
    )
    scene = ks.Scene(six_bar(), 9.0, 0.0, alone)
    swept = ks.sweep(scene, pd.DataFrame({"force.value": [0.5, 20.0]}), ["largest O"], angles=360, progress=False)
    assert swept["largest O [N]"][1] == pytest.approx(ks.extremes(scene.solve(360), "O").largest, rel=1e-6)


# Energy


@pytest.mark.parametrize("free_length", [0.0, 0.2])
def test_springs_do_no_work_over_a_turn(free_length):
    random = np.random.default_rng(4)
    springs = [
        ks.PointSpring(300.0, free_length, between=between(random, six_bar(), 0.3)),
        ks.TorsionSpring(25.0, 1.2, on="rocker", moment=3.0),
        ks.Spring(300.0, 0.4, "slider2", 500.0),
    ]
    for item in springs:
        s = ks.solve(six_bar().with_link("crank", ks.Link()), TURN, crank_speed=9.0, loads=item)
        still = ks.solve(s.mechanism, TURN, crank_speed=9.0)
        torque = s.balancing_torque - still.balancing_torque
        assert abs(np.mean(torque)) < 1e-12 * largest(torque)


@pytest.mark.parametrize("seed", range(8))
def test_dampers_never_give_power(seed):
    random = np.random.default_rng(seed)
    for kind in ("PointDamper", "TorsionDamper"):
        item = load(random, kind, six_bar())
        s, still = (ks.solve(six_bar(), TURN, crank_speed=9.0, loads=loads) for loads in ([item], []))
        torque = s.balancing_torque - still.balancing_torque
        assert torque.min() > -1e-12 * s.largest_torque_term
        assert torque.max() > 0 or kind == "TorsionDamper"


def test_a_function_as_damper_is_that_damper():
    damper = ks.TorsionDamper(0.7, on="rocker", against="coupler")
    function = ks.Torque(
        lambda motion: -0.7 * (motion.rate("rocker") - motion.rate("coupler")), on="rocker", against="coupler"
    )
    one, other = (ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=item) for item in (damper, function))
    assert largest(one.reaction("O2") - other.reaction("O2")) < 1e-13 * largest(one.reaction("O2"))


# The same load said in two ways


def pairs():
    """By name: two ways to say a load on the six-bar."""
    spot, end = ("coupler", 0.1, 0.05), (0.3, 0.8)

    def toward(motion):
        return motion.position(spot) - np.array(end)[:, None]

    def angle(motion):
        x, y = motion.position("B") - motion.position("O2")
        return np.arctan2(y, x)

    return {
        "process force": (ks.ProcessForce(50.0, "slider2"), ks.Force(50.0, at="C", along="slider2")),
        "fixed direction": (ks.Force(50.0, at="C"), ks.Force(50.0, at="C", direction=0.0, along="slider2")),
        "joint and place": (ks.Force(50.0, at="A", direction=1.0), ks.Force(50.0, at=("crank", 0.1), direction=1.0)),
        "spring along the guide": (
            ks.Spring(300.0, 0.4, "slider2"),
            ks.Force(lambda motion: -300.0 * (motion.travel("slider2") - 0.4), at="C", along="slider2"),
        ),
        "cubic spring": (
            ks.Spring(0.0, 0.4, "slider2", cubic=900.0),
            ks.ProcessForce(
                lambda motion: (
                    -900.0
                    * motion.elongation(0.4, "slider2")
                    * motion.elongation(0.4, "slider2")
                    * motion.elongation(0.4, "slider2")
                ),
                "slider2",
            ),
        ),
        "spring and force between points": (
            ks.PointSpring(300.0, 0.2, between=(spot, end)),
            ks.PointForce(lambda motion: -300.0 * (np.hypot(*toward(motion)) - 0.2), between=(spot, end)),
        ),
        "torsion spring": (
            ks.TorsionSpring(25.0, 1.2, on="rocker", moment=3.0),
            ks.Torque(lambda motion: 3.0 - 25.0 * (angle(motion) - 1.2), on="rocker"),
        ),
        "torque against": (
            (ks.Torque(5.0, on="rocker"), ks.Torque(-5.0, on="coupler")),
            ks.Torque(5.0, on="rocker", against="coupler"),
        ),
        "array and function": (
            ks.Torque(np.sin(ANGLES), on="rocker"),
            ks.Torque(lambda motion: np.sin(motion.crank_angle), on="rocker"),
        ),
        "the first point and the second": (
            ks.PointSpring(300.0, 0.2, between=(spot, end)),
            ks.PointSpring(300.0, 0.2, between=(end, spot)),
        ),
        "action and reaction": (
            ks.PointSpring(300.0, 0.0, between=(spot, "C")),
            tuple(
                ks.Force(
                    lambda motion, k=k, sign=sign: -sign * 300.0 * (motion.position(spot) - motion.position("C"))[k],
                    at=at,
                    direction=turn,
                )
                for at, sign in ((spot, 1.0), ("C", -1.0))
                for k, turn in ((0, 0.0), (1, np.pi / 2))
            ),
        ),
    }


@pytest.mark.parametrize("name", pairs())
def test_a_load_said_in_two_ways_is_one_load(name):
    one, other = (ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=item) for item in pairs()[name])
    for reaction in one.reactions:
        size = max(largest(one.reaction(reaction)), one.largest_force_term)
        assert largest(one.reaction(reaction) - other.reaction(reaction)) < 1e-13 * size, reaction
    assert largest(one.balancing_torque - other.balancing_torque) < 1e-13 * one.largest_torque_term


def test_crank_force_enters_torque_and_support():
    bare = ks.crank_slider(0.1, 0.4)
    s = ks.solve(
        bare, ANGLES, crank_speed=9.0, loads=[ks.Force(50.0, at="O", direction=1.0), ks.Torque(7.0, on="crank")]
    )
    assert largest(planar(s.reaction("O")) + 50.0 * np.exp(1j)) < 1e-14 * 50
    assert largest(s.balancing_torque + 7.0) < 1e-14 * 7


def test_a_force_on_the_frame_ends_there():
    s, none = (ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=x) for x in (ks.Force(50.0, at=(0.3, 0.3)), ()))
    assert all(np.array_equal(s.reaction(name), none.reaction(name)) for name in s.reactions)
    assert np.array_equal(s.balancing_torque, none.balancing_torque)


@pytest.mark.slow
def test_loads_do_not_shake_the_frame():
    s, none = (ks.solve(six_bar(), ANGLES, crank_speed=9.0, loads=x) for x in (loaded(), ()))
    assert np.array_equal(s.shaking_force, none.shaking_force)
    assert np.array_equal(s.shaking_moment, none.shaking_moment)
