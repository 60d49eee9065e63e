"""Planetary crank: straight path of its pin, tooth and bearing forces, balance of its machine."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

ARM = 0.019
TURN = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
KNIFE = ks.Link(4.6, (0.01, 0.003), 0.1)
CRANK, PLANET, BLOCK = ks.Link(1.1, (0.006, -0.001), 2e-4), ks.Link(0.8, (0.004, 0.002), 3e-4), ks.Link(0.1)


def drive(radius=ARM, line=0.0, crank=CRANK, planet=PLANET, block=BLOCK, knife=KNIFE, pressure_angle=np.radians(20.0)):
    group = ks.PlanetaryCrank(radius, line, pressure_angle, planet=planet)
    yoke = ks.YokeGroup(ks.Guide.at(line), on="P", slider=knife, block=block)
    return ks.Mechanism("mower drive", ks.Crank(ARM, crank), (group, yoke))


@every("line", [0.0, 0.7, 2.5, -1.2])
def test_pin_runs_straight(line):
    s = ks.solve(drive(line=line), TURN, crank_speed=3.0, crank_acceleration=1.0)
    x, y = s.position("P")
    place = np.exp(-1j * line) * (x + 1j * y) / ARM
    assert np.abs(place - 2.0 * np.cos(TURN - line)).max() < 1e-15
    assert s.slider_velocity == pytest.approx(-6.0 * ARM * np.sin(TURN - line), abs=1e-15)
    assert s.rate("planet") == pytest.approx(-3.0)


def test_pin_at_another_radius_runs_on_an_ellipse():
    x, y = ks.solve(drive(radius=0.4 * ARM), TURN, crank_speed=3.0).position("P") / ARM
    assert (x / 1.4) ** 2 + (y / 0.6) ** 2 == pytest.approx(1.0, rel=1e-14)


def column_of(unknown, centres):
    """Column of one unknown: (body, unit force, its place, unit couple) of each body that it acts on."""
    column = np.zeros(3 * len(centres))
    for body, force, place, couple in unknown:
        arm = place - centres[body]
        column[3 * body : 3 * body + 3] += force.real, force.imag, (arm.conjugate() * force).imag + couple
    return column


def newton_euler(made, line, speed, acceleration, gravity, push, pressure_angle):
    """Forces of the whole machine at each angle of `TURN` from all bodies' equations; no formula of the package.

    Mass centres are trigonometric polynomials of the crank angle, differentiated by their Fourier series.
    """
    radius = made.groups[0].radius
    way, ray = np.exp(1j * line), np.exp(1j * TURN)
    axis = ARM * ray
    pin = axis + radius * way**2 / ray
    foot = (pin / way).real * way
    bodies = [
        (made.links["crank"], 0.0 * ray, ray, 1.0),
        (made.links["planet"], axis, way**2 / ray, -1.0),
        (made.links["block"], pin, 1j * way + 0.0 * ray, 0.0),
        (made.links["slider"], foot, way + 0.0 * ray, 0.0),
    ]
    order = 1j * np.fft.fftfreq(TURN.size, 1.0 / TURN.size)
    found = []
    for at in range(TURN.size):
        centres, right = [], []
        for link, place, direction, ratio in bodies:
            centre = place + complex(*link.centre) * direction
            series = np.fft.fft(centre)
            first, second = np.fft.ifft(order * series)[at], np.fft.ifft(order**2 * series)[at]
            inertial = link.mass * (speed**2 * second + acceleration * first) - link.mass * gravity
            applied = push * way if link is made.links["slider"] else 0.0
            centres.append(centre[at])
            moment = ((foot[at] - centre[at]).conjugate() * applied).imag
            right += [
                (inertial - applied).real,
                (inertial - applied).imag,
                link.inertia * ratio * acceleration - moment,
            ]
        for side in (1.0, -1.0):
            teeth = (1j - side * np.tan(pressure_angle)) * ray[at]
            actions = [
                *([(0, unit, 0.0, 0.0)] for unit in (1.0 + 0j, 1j)),
                *([(1, unit, axis[at], 0.0), (0, -unit, axis[at], 0.0)] for unit in (1.0 + 0j, 1j)),
                [(1, teeth, 2.0 * axis[at], 0.0)],
                *([(2, unit, pin[at], 0.0), (1, -unit, pin[at], 0.0)] for unit in (1.0 + 0j, 1j)),
                [(2, -way, pin[at], 0.0), (3, way, pin[at], 0.0)],
                [(2, 0j, pin[at], 1.0), (3, 0j, pin[at], -1.0)],
                [(3, 1j * way, foot[at], 0.0)],
                [(3, 0j, foot[at], 1.0)],
                [(0, 0j, 0.0, 1.0)],
            ]
            columns = [column_of(unknown, centres) for unknown in actions]
            forces = np.linalg.solve(np.array(columns).T, right)
            if forces[4] * side >= 0.0:
                break
        found.append([*forces[:5], *(forces[4] * part for part in (teeth.real, teeth.imag)), *forces[5:]])
    return np.array(found).T


@pytest.mark.slow
@every("speed", [60.0, -60.0])
@every("radius", [ARM, 0.5 * ARM])
@every("line, push, acceleration", [(0.0, 0.0, 0.0), (0.4, -300.0, 40.0), (2.5, 200.0, -500.0)])
def test_forces_are_those_of_all_bodies_equations(speed, radius, line, push, acceleration):
    made, pressure = drive(radius, line, pressure_angle=0.4), 0.4
    loads = [ks.Gravity(), ks.ProcessForce(push)]
    s = ks.solve(made, TURN, crank_speed=speed, crank_acceleration=acceleration, loads=loads)
    expected = newton_euler(made, line, speed, acceleration, -9.81j, push, pressure)
    ours = [*s.reaction("O"), *s.reaction("A"), s.scalar("tooth_force"), *s.reaction("mesh"), *s.reaction("P")]
    ours += [*map(s.scalar, ("slot_force", "slot_moment", "guide_force", "guide_moment", "balancing_torque"))]
    sizes = np.abs(expected).max(axis=1)
    units = np.where(np.isin(np.arange(14), [10, 12, 13]), ARM, 1.0) * sizes.max()
    assert np.all(np.abs(np.array(ours) - expected).max(axis=1) <= 1e-12 * units)
    assert s.power_residual < 1e-13


def test_teeth_push_the_planet_off_the_ring_with_either_flank():
    s = ks.solve(drive(), TURN, crank_speed=60.0)
    radial = (s.reaction("mesh") * s.position("A")).sum(axis=0) / ARM
    assert radial == pytest.approx(-np.abs(s.scalar("tooth_force")) * np.tan(np.radians(20.0)), rel=1e-12)
    assert np.ptp(np.sign(s.scalar("tooth_force"))) == 2.0


def balanced_drive():
    """Mass of knife and planet at the planet's axis by a weight on the planet, and all of it at O by one on the arm."""
    knife, block = ks.Link(4.6), ks.Link(0.1)
    planet = ks.Link(0.8, 0.003, 3e-4).joined(6.0, (-(4.7 * ARM + 0.8 * 0.003) / 6.0, 0.0))
    mass = planet.mass + knife.mass + block.mass
    crank = ks.Link(1.1, 0.006, 2e-4).joined(15.0, (-(mass * ARM + 1.1 * 0.006) / 15.0, 0.0))
    return drive(crank=crank, planet=planet, knife=knife, block=block)


@every("speed", [60.0, -60.0])
def test_two_counterweights_balance_the_straight_drive_whole(speed):
    """The study's claim: force and torque vanish, as knife and block are a rod that turns with the planet."""
    plain = ks.solve(drive(knife=ks.Link(4.6)), TURN, crank_speed=speed)
    s = ks.solve(balanced_drive(), TURN, crank_speed=speed)
    assert np.abs(s.shaking_force).max() < 1e-14 * np.abs(plain.shaking_force).max()
    assert np.abs(s.balancing_torque).max() < 1e-14 * np.abs(plain.balancing_torque).max()


@pytest.mark.slow
def test_extremes_see_the_change_of_flank():
    found = ks.extremes(ks.Scene(drive(), 60.0, loads=[ks.Gravity()]).solve(90), "A")
    fine = ks.solve(drive(), np.linspace(0, 2 * np.pi, 200_001), crank_speed=60.0, loads=ks.Gravity())
    size = np.hypot(*fine.reaction("A"))
    assert found.largest == pytest.approx(size.max(), rel=1e-8)
    assert found.largest >= size.max() * (1.0 - 1e-12)
    signs = np.flatnonzero(np.diff(np.sign(fine.scalar("tooth_force"))))
    assert any(np.abs(np.asarray(found.angle) - fine.crank_angle[at]).min() < 1e-4 for at in signs)


@pytest.mark.slow
def test_compiled_values_and_derivatives_agree():
    scene = ks.Scene(drive(line=0.4), 60.0, loads=[ks.Gravity(), ks.ProcessForce(-100.0)])
    names = ("O", "A", "mesh", "tooth_force", "balancing_torque")
    slow, fast = (ks.compile(scene, names, engine=engine) for engine in ("numpy", "compiled"))
    at = TURN + 0.01
    ours, theirs = slow(at), fast(at)
    for name in names:
        assert ours[name] == pytest.approx(theirs[name], rel=1e-12, abs=1e-10)
    paths, step = ("planet_radius", "planet.mass", "pressure_angle"), 1e-6
    exact = slow.derivatives(at, paths)
    for path in paths:
        value = scene.parameters[path]
        one, other = (slow(at, {path: value + side * step}) for side in (1.0, -1.0))
        for name in names:
            slope = (one[name] - other[name]) / (2.0 * step)
            assert exact[name][path] == pytest.approx(slope, rel=1e-6, abs=1e-6 * np.abs(slope).max() + 1e-6)


@every(
    "options, words",
    [
        ({"radius": 0.0}, "radius must be greater than 0"),
        ({"radius": np.nan}, "radius"),
        ({"radius": "a"}, "radius"),
        ({"radius": ARM, "pressure_angle": -0.1}, "pressure_angle must be at least 0"),
        ({"radius": ARM, "pressure_angle": 20.0}, "pressure_angle must be less than pi/2, as 20 degrees, got 20 rad"),
        ({"radius": ARM, "planet": 1.0}, "planet must be a Link"),
        ({"radius": ARM, "line_angle": np.inf}, "line_angle"),
    ],
)
def test_what_no_planet_can_have_is_refused(options, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.PlanetaryCrank(**options)


def test_a_planet_hangs_on_the_crank():
    bars = ks.RockerGroup(0.4, 0.3, (0.35, 0.1))
    with pytest.raises(ks.ParameterError, match="it is attached to 'B', but a planet needs a pin of the crank"):
        ks.Mechanism("two", ks.Crank(0.1), (bars, ks.PlanetaryCrank(0.1, on="B")))
    with pytest.raises(ks.ParameterError, match="a planet needs a pin of the crank"):
        ks.check(ks.PlanetaryCrank(0.1))


def test_teeth_take_no_friction():
    with pytest.raises(ks.ParameterError, match="friction: joint is 'mesh', allowed: 'O', 'A', 'P'"):
        ks.solve(drive(), 0.0, crank_speed=1.0, friction={"mesh": ks.PinFriction(0.1, 0.01)})


def scene(speed=60.0, loads=(ks.ProcessForce(-100.0), ks.Gravity()), **options):
    return ks.Scene(drive(**options), speed, loads=loads)


def test_a_mirrored_machine_has_mirrored_forces():
    """Mirrored in the x axis: angles, turning and places across change their sign."""
    crank, planet, knife = (
        ks.Link(each.mass, each.centre * np.array([1, -1]), each.inertia) for each in (CRANK, PLANET, KNIFE)
    )
    s = scene(line=0.4, loads=[ks.ProcessForce(-100.0)]).solve(TURN)
    mirrored = scene(-60.0, [ks.ProcessForce(-100.0)], line=-0.4, crank=crank, planet=planet, knife=knife).solve(-TURN)
    for name in ("O", "A", "mesh"):
        x, y = mirrored.reaction(name)
        assert np.array([x, -y]) == pytest.approx(s.reaction(name), rel=1e-12, abs=1e-9)
    for name in ("tooth_force", "balancing_torque", "guide_force"):
        assert -mirrored.scalar(name) == pytest.approx(s.scalar(name), rel=1e-12, abs=1e-9)


def test_ground_forces_with_teeth_balance_inertia_weight_and_push():
    s = scene().solve(TURN)
    total = s.shaking_force + np.array([[-100.0], [-9.81 * sum(link.mass for link in s.mechanism.links.values())]])
    assert s.ground.resultant == pytest.approx(total, rel=1e-12, abs=1e-9)
    assert s.ground["mesh"].point == pytest.approx(2.0 * s.position("A"))
    assert s.ground["mesh"].force == pytest.approx(-s.reaction("mesh"))


def test_proven_bounds_hold_at_change_of_flank_too():
    s = ks.Scene(drive(crank=ks.Link(), planet=ks.Link(), block=ks.Link(), knife=ks.Link(4.6)), 60.0).solve(4)
    for name in ("tooth_force", "|mesh|", "|O|", "balancing_torque"):
        assert np.all(s.error_bound(name) < 1e-11)


@pytest.mark.slow
def test_shares_leave_out_sources_as_teeth_are_not_linear():
    s = scene().solve(90)
    shares = s.shares("mesh")
    assert "thrust of teeth is not linear" in shares.note
    peak = shares.total.value
    assert peak == pytest.approx(ks.extremes(s, "mesh").largest, rel=1e-9)


def test_coasting_machine_keeps_its_energy():
    run = ks.drive.coast(scene(loads=()), flywheel=0.02, from_speed=60.0, until=0.2)
    assert run.kinetic_energy == pytest.approx(run.kinetic_energy[0], rel=1e-8)
    assert np.ptp(run.speed) > 1.0


def test_a_sweep_over_designs_agrees_with_each_alone():
    radii = np.array([[0.9], [1.0], [1.1]]) * ARM
    s = ks.solve(drive(radius=radii), TURN, crank_speed=60.0)
    for place, radius in enumerate(radii.ravel()):
        alone = ks.solve(drive(radius=float(radius)), TURN, crank_speed=60.0)
        assert s.reaction("mesh")[:, place] == pytest.approx(alone.reaction("mesh"), rel=1e-13, abs=1e-10)


def test_friction_of_its_pins_takes_power():
    friction = {"O": ks.PinFriction(0.1, 0.01), "A": ks.PinFriction(0.1, 0.01), "P": ks.PinFriction(0.1, 0.01)}
    s = ks.solve(drive(), TURN, crank_speed=60.0, friction=friction)
    plain = ks.solve(drive(), TURN, crank_speed=60.0)
    assert np.all(s.friction_loss > 0.0)
    assert np.mean(s.balancing_torque - plain.balancing_torque) * 60.0 == pytest.approx(
        np.mean(s.friction_loss), rel=1e-9
    )
