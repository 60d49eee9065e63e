"""Forces inside straight links: a chain of point masses, published examples, laws; strength, pins, and rigidity."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.sizing import sections as strength
from support import change_points, pages
from support.case_files import shipped

SPEED, R, L, SLIDER = 33.5, 0.3, 2.0, 600.0
STEEL = {"second_moment": 8e-5, "youngs_modulus": 206e9}
LIMITS = {"ultimate": 600e6, "endurance": 200e6, "yield_strength": 355e6}
SAW = ks.Bar(6e-3, 3e-4, masses=[(1.0, 88.5)], mass=61.5, **STEEL)
ODD = ks.Bar(6e-3, 3e-4, masses=[(0.4, 20.0), (1.5, 50.0), (2.0, 5.0)], mass=60.0, **STEEL)


def machine(bar, **more):
    """The saw with a coupler that has the mass properties of a bar."""
    return ks.crank_slider(R, L, coupler=ks.Link(*bar.properties(L)), slider=ks.Link(SLIDER), **more)


def solved(bar=SAW, speed=SPEED, loads=(), angles=72):
    return ks.Scene(machine(bar), speed, loads=loads).solve(angles)


def rod(mass, crank, length, speed):
    """A uniform coupler without slider."""
    link = ks.Link(mass, length / 2, mass * length**2 / 12)
    return ks.Scene(ks.crank_slider(crank, length, coupler=link), speed).solve(72)


# An independent computation: many point masses on the coupler, accelerated one by one


class Chain:
    """Coupler of the saw as point masses, weights by `g`; forces from the slider's end, of spectral derivatives."""

    LUMPS, ANGLES = 4000, 72

    def __init__(self, bar, speed, g):
        phi = 2 * np.pi * np.arange(self.ANGLES) / self.ANGLES
        self.crank_pin = R * np.exp(1j * phi)
        self.slider_pin = R * np.cos(phi) + np.sqrt(L**2 - (R * np.sin(phi)) ** 2) + 0j
        self.x = np.concatenate([(np.arange(self.LUMPS) + 0.5) * L / self.LUMPS, [x for x, _ in bar.masses]])
        self.mass = np.concatenate([np.full(self.LUMPS, bar.mass / self.LUMPS), [m for _, m in bar.masses]])
        weight = -1j * g
        push = -self.mass[:, None] * (self.accelerations(self.x, speed) - weight)
        along = (self.slider_pin - self.crank_pin) / L
        pin = -SLIDER * self.accelerations([L], speed)[0].real + 0j  # along the guide, by the slider on the coupler
        moment = self.turning(along * self.x[:, None], push).sum(axis=0) + self.turning(along * L, pin)
        self.pin = pin - 1j * moment / (L * along.real)  # across it, so that the moment about A is zero
        self.push, self.along = push, along

    def accelerations(self, x, speed):
        """Of points of the coupler, by harmonics of their places."""
        place = self.crank_pin + np.asarray(x)[:, None] / L * (self.slider_pin - self.crank_pin)
        order = np.fft.fftfreq(self.ANGLES, 1 / self.ANGLES)
        return np.fft.ifft(-((speed * order) ** 2) * np.fft.fft(place, axis=1), axis=1)

    @staticmethod
    def turning(arm, force):
        """Moment of a force."""
        return (np.conj(arm) * force).imag

    def forces(self, section):
        """N, V and M at a section from what lies beyond it."""
        beyond = self.x > section + 1e-9
        force = self.push[beyond].sum(axis=0) + self.pin
        arms = (self.x[beyond, None] - section) * self.along
        moment = self.turning(arms, self.push[beyond]).sum(axis=0) + self.turning((L - section) * self.along, self.pin)
        local = force * np.conj(self.along)
        return local.real, -local.imag, moment


@pytest.mark.parametrize("bar", [SAW, ODD])
@pytest.mark.parametrize("speed", [SPEED, -SPEED])
def test_forces_are_those_of_a_chain_of_point_masses(bar, speed):
    found = solved(bar, speed, [ks.Gravity()]).sections("coupler", bar, at=21)
    chain = Chain(bar, speed, 9.81)
    for row, x in enumerate(found.x[1:-1], 1):
        if not np.isclose(x, [place for place, _ in bar.masses]).any():
            curves = (found.axial_force, found.shear_force, found.bending_moment)
            for own, other in zip(chain.forces(x), curves, strict=True):
                assert other[row] == pytest.approx(own, abs=3e-6 * np.abs(other).max())


@pytest.mark.slow
@pytest.mark.parametrize("bar", [SAW, ODD])
def test_extremes_are_those_of_a_fine_grid_and_above_it(bar):
    s = solved(bar, loads=[ks.Gravity()], angles=1440)
    found, fine = (
        solved(bar, loads=[ks.Gravity()], angles=3).sections("coupler", bar),
        s.sections("coupler", bar, at=201),
    )
    for name, values in (
        ("tension", fine.axial_force),
        ("compression", -fine.axial_force),
        ("shear", abs(fine.shear_force)),
        ("moment", abs(fine.bending_moment)),
    ):
        peak = getattr(found, f"largest_{name}")
        assert values.max() * (1 - 1e-12) <= peak.value <= values.max() * (1 + 2e-5)
        row, column = np.unravel_index(values.argmax(), values.shape)
        assert np.abs(np.exp(1j * peak.angle) - np.exp(1j * s.crank_angle[column])) < 0.01
        assert peak.x == pytest.approx(fine.x[row], abs=0.02)


# Published numbers


@pytest.mark.filterwarnings("ignore:.*the coupler is 100 m long:kinetostatics.HintWarning")
def test_textbook_rod_and_its_true_largest_moment():
    """M omega^2 r L/(9 sqrt 3), crank square to a rod whose other end does not accelerate: true for a long rod."""

    def formula(mass, crank, length, speed):
        return mass * speed**2 * crank * length / (9 * np.sqrt(3))

    assert round(formula(1.6, 0.1375, 0.205, 52.36), 2) == 7.93
    bar = ks.Bar(1e-4, 1e-6)
    true = rod(1.6, 0.1375, 0.205, 52.36).sections("coupler", bar).largest_moment
    assert round(true.value, 2) == 10.47
    assert round(180 - abs(180 - np.degrees(true.angle)), 2) == 43.45  # the rod is alike at 316.55 deg
    long = rod(1.6, 0.1375, 100.0, 52.36).at(np.pi / 2).sections("coupler", bar, at=1001)
    assert np.abs(long.bending_moment).max() == pytest.approx(formula(1.6, 0.1375, 100.0, 52.36), rel=1e-5)
    assert long.x[np.argmax(np.abs(long.bending_moment))] == pytest.approx(100.0 * (1 - 1 / np.sqrt(3)), abs=0.1)


def case_sections(variant, concentrated):
    """The case's coupler, or a uniform bar of the same mass instead."""
    s = shipped("sawframe_2r63").solve(variant, 72)
    link = s.mechanism.links["coupler"]
    length = 2 * link.centre[0]
    if concentrated:
        mass = 12 * link.inertia / length**2
        return s.sections("coupler", ks.Bar(6e-3, 3e-4, masses=[(length / 2, link.mass - mass)], mass=mass))
    scene = ks.Scene.of(s)
    heavy = ks.Link(link.mass, length / 2, link.mass * length**2 / 12)
    scene = ks.Scene(
        ks.crank_slider(R, length, coupler=heavy, slider=ks.Link(SLIDER)), s.crank_speed, loads=scene.loads
    )
    return scene.solve(72).sections("coupler", ks.Bar(6e-3, 3e-4))


@pytest.mark.slow
def test_couplers_of_the_saw():
    plain, circle = (case_sections(variant, True) for variant in ("plain", "cam-circle"))
    uniform = case_sections("plain", False)
    assert plain.bar.mass == pytest.approx(61.5)
    assert [round(part.largest_moment.value / 1e3, 1) for part in (plain, circle, uniform)] == [10.7, 10.8, 6.9]
    axial = [round(part.value / 1e3) for of in (plain, circle) for part in (of.largest_tension, of.largest_compression)]
    assert axial == [287, 219, 44, 50]


# Laws


@pytest.mark.parametrize("loads", [(), (ks.Gravity(),)])
def test_frictionless_pins_take_no_moment(loads):
    for link, s in (
        ("coupler", solved(ODD, loads=loads)),
        ("rocker", ks.Scene(four_bar(), 10.0, loads=loads).solve(72)),
        ("coupler", ks.Scene(four_bar(), 10.0, loads=loads).solve(72)),
    ):
        bar = ODD if s.mechanism.links[link].mass == ODD.properties(L)[0] else ks.Bar(1e-3, 1e-5)
        found = s.sections(link, bar)
        assert np.abs(found.bending_moment[[0, -1]]).max() < 1e-11 * L * np.abs(found.axial_force).max()
        assert found.largest_moment.value > 0


def four_bar():
    coupler, rocker = ks.Link(2.0, 0.2, 2.0 * 0.4**2 / 12), ks.Link(3.0, 0.15, 3.0 * 0.3**2 / 12)
    return ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), coupler=coupler, rocker=rocker)


def test_drive_bends_the_crank_at_its_bearing():
    crank = ks.Link(10.0, 0.15, 10.0 * 0.3**2 / 12)
    s = ks.Scene(ks.crank_slider(R, L, slider=ks.Link(SLIDER), crank=crank), SPEED).solve(72)
    found = s.sections("crank", ks.Bar(6e-3, 3e-4))
    assert found.bending_moment[0] == pytest.approx(-s.balancing_torque, abs=1e-9)
    assert np.abs(found.bending_moment[-1]).max() < 1e-9


def test_friction_of_pins_bends_the_bar_at_its_ends():
    friction = {"A": ks.PinFriction(0.2, 0.05), "B": ks.PinFriction(0.1, 0.04)}
    s = ks.solve(machine(SAW), np.radians(np.arange(5, 360, 10)), crank_speed=SPEED, friction=friction)
    found = s.sections("coupler", SAW)
    assert found.bending_moment[0] == pytest.approx(-s.friction_at("A"), abs=1e-8)
    assert np.abs(found.bending_moment[-1]) == pytest.approx(np.abs(s.friction_at("B")), abs=1e-8)


def test_force_on_a_bar_at_rest():
    """F a b/L under the force; half a meter from A, crank at rest at 0 deg, so the coupler lies along x."""
    press = ks.Scene(ks.crank_slider(R, L), 0.0, 0.0, (ks.Force(100.0, at=("coupler", 0.5), direction=-np.pi / 2),))
    found = press.solve([0.0]).sections("coupler", ks.Bar(1e-3, 1e-5), at=5)
    assert found.bending_moment[:, 0] == pytest.approx([0.0, 37.5, 25.0, 12.5, 0.0], abs=1e-12)
    assert found.shear_force[:, 0] == pytest.approx([75.0, 75.0, -25.0, -25.0, -25.0])
    assert found.largest_moment[:2] == pytest.approx((37.5, 0.5))  # the coupler lies across the force at 0 deg


@pytest.mark.slow
def test_forces_grow_with_the_square_of_speed_whichever_way_it_turns():
    one, two = (solved(ODD, speed).sections("coupler", ODD) for speed in (SPEED, -2 * SPEED))
    assert two.bending_moment == pytest.approx(4 * one.bending_moment, rel=1e-12, abs=1e-8)
    assert two.largest_tension == pytest.approx((4 * one.largest_tension.value, *one.largest_tension[1:]))


def test_a_scalar_angle_gives_one_curve():
    assert ks.solve(machine(SAW), 0.5, crank_speed=SPEED).sections("coupler", SAW, at=7).axial_force.shape == (7,)


def test_a_pin_between_the_ends_makes_shear_and_axial_force_jump():
    s = two_throws(across=0.0)
    found = s.sections("coupler", PLAIN, at=5)
    axis = s.placement.links["coupler"].direction
    x, y = s.reaction("C2")
    along, across = x * axis[0] + y * axis[1], y * axis[0] - x * axis[1]
    assert np.diff(found.axial_force[2:4], axis=0)[0] == pytest.approx(along, abs=1e-8)
    assert np.diff(found.shear_force[2:4], axis=0)[0] == pytest.approx(-across, abs=1e-8)
    assert np.abs(found.bending_moment[[0, -1]]).max() < 1e-9 < 1.0 < np.abs(found.bending_moment[2]).max()


@pytest.mark.slow
def test_forces_that_grow_at_a_change_point_are_infinite_with_a_warning():
    coupler, rocker = ks.Link(2.0, 0.2, 2.0 * 0.4**2 / 12), ks.Link(1.0, 0.05, 1.0 * 0.1**2 / 12)
    deltoid = ks.four_bar(0.1, 0.4, 0.1, rocker_pivot=(0.4, 0.0), assembly="open", coupler=coupler, rocker=rocker)
    found = ks.Scene(deltoid, 10.0, loads=[ks.Gravity()]).solve(7).sections("coupler", ks.Bar(1e-3, 1e-5))
    with pytest.warns(ks.ConditionWarning, match="tension in coupler grows without bound at 0, 180 deg"):
        assert found.largest_tension.value == np.inf
    with pytest.warns(ks.ConditionWarning, match="A grows without bound at 0, 180 deg"):
        assert (
            ks.sizing.pin_strength(found.solution.at(np.array([0.3])), "A", diameter=0.1, width=0.1).shear_stress
            == np.inf
        )
    assert found.largest_moment.value == pytest.approx(2.0 * (9.81 + 0.1 * 10.0**2) * 0.4 / 8)


@pytest.mark.slow
def test_change_points_make_a_pin_infinite_with_a_warning_and_leave_the_shaft_its_frequency():
    with pytest.warns(ks.ConditionWarning, match="assembly .1 keeps to its side"):
        s = ks.Scene(change_points.four_bar("deltoid", 1), 10.0).solve(24)
    with pytest.warns(ks.ConditionWarning, match="grows without bound"):
        assert ks.sizing.pin_strength(s, "A", diameter=0.1, width=0.1).shear_stress == np.inf
    between = s.moved_to((np.arange(1440) + 0.5) * 2 * np.pi / 1440).reduced_inertia.mean()
    found = strength.shaft_rigidity(s, {"length": 1.0, "polar_moment": 1e-6, "shear_modulus": 8e10})
    assert found.natural_frequency == pytest.approx(np.sqrt(8e4 / between), rel=1e-3)


# Strength


@pytest.mark.slow
def test_stress_and_fatigue_are_those_of_a_fine_grid():
    s = solved(ODD, loads=[ks.Gravity()], angles=1440)
    found, forces = ks.sizing.bar_strength(s, "coupler", ODD, **LIMITS), s.sections("coupler", ODD, at=401)
    stress = np.array([forces.axial_force / 6e-3 + side * forces.bending_moment / 3e-4 for side in (1, -1)])
    assert found.largest_stress == pytest.approx(stress.max(), rel=1e-5)
    assert found.smallest_stress == pytest.approx(stress.min(), rel=1e-5)
    low, high = stress.min(axis=-1), stress.max(axis=-1)
    use = 0.5 * (high - low) / 200e6 + np.maximum(0.5 * (high + low), 0) / 600e6
    assert found.fatigue_safety == pytest.approx(1 / use.max(), rel=1e-5)
    assert found.x == pytest.approx(forces.x[use.argmax() % 401], abs=5e-3)
    assert 1 / found.fatigue_safety == pytest.approx(found.stress_amplitude / 200e6 + max(found.mean_stress, 0) / 600e6)
    assert found.table().loc["fatigue_safety", "unit"] == "1"
    for name, values in (("tension", forces.axial_force), ("compression", -forces.axial_force)):
        assert getattr(found, f"largest_{name}") == pytest.approx(values.max(), rel=1e-5)
    for name, values in (("shear", forces.shear_force), ("moment", forces.bending_moment)):
        assert getattr(found, f"largest_{name}") == pytest.approx(np.abs(values).max(), rel=1e-5)


@pytest.mark.parametrize(
    ("second_moment", "expected"),
    [
        (2e-6, np.pi**2 * 206e9 * 2e-6 / 4),  # slender: Euler
        (8e-5, 355e6 * 6e-3 * (1 - 355e6 * 4 * 6e-3 / 8e-5 / (4 * np.pi**2 * 206e9))),  # stout: Johnson
        (355e6 * 6e-3 * 4 / (2 * np.pi**2 * 206e9), 355e6 * 6e-3 / 2),  # where both meet
    ],
)
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_buckling_by_euler_and_johnson(second_moment, expected):
    bar = ks.Bar(6e-3, 3e-4, SAW.masses, second_moment=second_moment, youngs_modulus=206e9)
    found = ks.sizing.bar_strength(solved(), "coupler", bar, **LIMITS)
    assert found.buckling_load == pytest.approx(expected, rel=1e-12)
    assert found.slenderness == pytest.approx(2.0 / np.sqrt(second_moment / 6e-3))
    assert found.buckling_safety == pytest.approx(expected / found.sections.largest_compression.value)


def test_compression_near_eulers_load_is_warned_of():
    slender = ks.Bar(6e-3, 3e-4, SAW.masses, second_moment=2e-6, youngs_modulus=206e9)
    with pytest.warns(ks.HintWarning, match="21% of Euler's load"):
        ks.sizing.bar_strength(solved(), "coupler", slender, **LIMITS)


def test_a_stress_above_the_yield_strength_is_warned_of():
    """Steady tension is safe by Goodman's line, which ends at the ultimate strength."""
    s = ks.Scene(ks.crank_slider(R, L), 1.0, 0.0, (ks.ProcessForce(2.4e6),)).solve(12)
    with pytest.warns(ks.HintWarning, match=r"stress reaches 404.6 MPa, above the yield strength of 355 MPa"):
        found = ks.sizing.bar_strength(s, "coupler", ks.Bar(6e-3, 3e-4, **STEEL), **LIMITS)
    assert found.fatigue_safety > 1.0


def test_bar_without_load_is_safe():
    """Massless and idle, so without stress."""
    s = ks.Scene(ks.crank_slider(R, L), SPEED).solve(12)
    found = ks.sizing.bar_strength(s, "coupler", ks.Bar(1.0, 1.0, **STEEL), **LIMITS)
    assert (found.fatigue_safety, found.buckling_safety, found.largest_stress) == (np.inf, np.inf, 0.0)


@pytest.mark.parametrize(("force", "mean_counts"), [(-1e5, False), (1e5, True)])
def test_mean_stress_counts_in_tension_only(force, mean_counts):
    """A massless coupler under a steady force on the slider: N = F/cos of its angle."""
    s = ks.Scene(ks.crank_slider(R, L), 1.0, 0.0, (ks.ProcessForce(force),)).solve(12)
    found = ks.sizing.bar_strength(s, "coupler", ks.Bar(6e-3, 3e-4, **STEEL), **LIMITS)
    level, steep = force / 6e-3, force / 6e-3 / np.sqrt(1 - (R / L) ** 2)
    use = abs(steep - level) / 2 / 200e6 + mean_counts * (level + steep) / 2 / 600e6
    assert found.fatigue_safety == pytest.approx(1 / use, rel=1e-9)
    assert found.mean_stress == pytest.approx((level + steep) / 2)


def test_pin():
    s = solved(angles=7200)
    found = ks.sizing.pin_strength(s, "A", diameter=0.1, width=0.12, shear_planes=1)
    force = np.hypot(*s.reaction("A")).max()
    assert found.largest_load == pytest.approx(force, rel=1e-6)
    assert found.shear_stress == pytest.approx(force / (np.pi * 0.05**2), rel=1e-6)
    assert found.bearing_stress == pytest.approx(force / 0.012, rel=1e-6)
    assert ks.sizing.pin_strength(s, "A", diameter=0.1, width=0.12).shear_stress == pytest.approx(
        found.shear_stress / 2
    )


# Rigidity


def test_frequency_of_a_uniform_bar_and_of_a_mass_in_the_middle():
    uniform = ks.Bar(6e-3, 3e-4, mass=150.0, **STEEL)
    stiffness = 8e-5 * 206e9
    found = strength.bar_rigidity(solved(uniform), "coupler", uniform)
    assert found.natural_frequency == pytest.approx(np.pi**2 * np.sqrt(stiffness / (75.0 * L**4)), rel=1e-12)
    light = ks.Bar(6e-3, 3e-4, masses=[(1.0, 150.0)], mass=0.0, **STEEL)
    found = strength.bar_rigidity(solved(light), "coupler", light)
    assert found.natural_frequency == pytest.approx(np.sqrt(48 * stiffness / L**3 / 150.0), rel=2e-5)
    assert found.order == pytest.approx(found.natural_frequency / SPEED)


def test_deflection_under_a_force_in_the_middle():
    force = ks.Force(1000.0, at=("coupler", 1.0), direction=np.pi / 2, along="coupler")
    s = ks.Scene(ks.crank_slider(R, L), 1.0, 0.0, (force,)).solve(12)
    found = strength.bar_rigidity(s, "coupler", ks.Bar(6e-3, 3e-4, **STEEL))
    assert found.deflection == pytest.approx(1000.0 * L**2 / (48 * 8e-5 * 206e9), rel=1e-12)
    assert (found.departure, found.natural_frequency) == (0.0, np.inf)


@pytest.mark.slow
def test_departure_is_the_steady_vibration_of_an_oscillator():
    """Q'' + p^2 q = p^2 w(t), started in its periodic state and integrated over a turn, comes back to it."""
    s, natural = solved(), 5.3 * SPEED

    def deflection(at):
        return np.cos(at.crank_angle) + 0.3 * np.sin(2 * at.crank_angle)

    found = strength._against_harmonics("test", s, deflection, natural)
    turn = np.linspace(0, 2 * np.pi, 20001)
    p = natural / SPEED
    states = [np.array([0.0, 0.0])]

    def rate(angle, state):
        return np.array([state[1], p * p * (np.cos(angle) + 0.3 * np.sin(2 * angle) - state[0])])

    def run(start):
        states = [np.array(start)]
        for low, high in zip(turn[:-1:10], turn[10::10], strict=False):
            step, state = high - low, states[-1]
            one = rate(low, state)
            two = rate(low + step / 2, state + step / 2 * one)
            three = rate(low + step / 2, state + step / 2 * two)
            four = rate(high, state + step * three)
            states.append(state + step / 6 * (one + 2 * two + 2 * three + four))
        return np.array(states)

    rest, first, second = (run(start) for start in ([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]))
    monodromy = np.stack([first[-1] - rest[-1], second[-1] - rest[-1]], axis=1)
    states = run(np.linalg.solve(np.eye(2) - monodromy, rest[-1]))
    still = np.cos(turn[::10]) + 0.3 * np.sin(2 * turn[::10])
    assert found.departure == pytest.approx(np.abs(states[:, 0] - still).max() / np.abs(still).max(), rel=1e-4)


def test_a_harmonic_at_resonance_departs_without_bound():
    found = strength._against_harmonics("test", solved(), lambda at: np.cos(2 * at.crank_angle), 2 * SPEED)
    assert found.departure == np.inf


def test_twist_of_a_shaft():
    s = solved(angles=3600)
    found = strength.shaft_rigidity(s, {"length": 0.5, "polar_moment": 2e-5, "shear_modulus": 79e9})
    stiffness = 79e9 * 2e-5 / 0.5
    assert found.deflection == pytest.approx(np.abs(s.balancing_torque).max() / stiffness, rel=1e-6)
    assert found.natural_frequency == pytest.approx(np.sqrt(stiffness / s.reduced_inertia.mean()), rel=1e-6)


@pytest.mark.slow
def test_needs_reports_rigidity():
    shaft = {"length": 0.5, "polar_moment": 2e-5, "shear_modulus": 79e9}
    found = ks.needs(solved(), "O", within=0.05, progress=False, bars={"coupler": SAW}, shaft=shaft)
    assert list(found.rigidity) == ["coupler", "shaft"]
    assert f"rigid coupler: error {found.rigidity['coupler'].departure:.2g}" in str(found)
    assert "Timoshenko" in found.rigidity["shaft"].table().loc["departure", "formula"]
    assert ks.needs(solved(), "O", within=0.05, progress=False).rigidity == {}


# What is refused


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"area": -1.0}, "area must be greater than 0"),
        ({"area": 0.0, "modulus": np.nan}, "area must be greater than 0, got 0.0; modulus must be finite"),
        ({"masses": 3.0}, r"masses must be pairs \(x, mass\)"),
        ({"masses": [(1.0, 2.0, 3.0)]}, r"masses must be pairs \(x, mass\)"),
        ({"masses": [(1.0, -2.0), (-1.0, 1.0)]}, "point mass 1 must be at least 0, got -2.0; x 2 must be at least 0"),
        ({"mass": np.ones((2, 1))}, "mass must be one number"),
        ({"youngs_modulus": "steel"}, "youngs_modulus must be a number"),
    ],
)
def test_wrong_bars_are_refused(given, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.Bar(**{"area": 6e-3, "modulus": 3e-4} | given)


PLAIN = ks.Bar(6e-3, 3e-4)


def gaping():
    """A crank longer than the coupler."""
    return ks.solve(ks.crank_slider(0.5, 0.4), np.array([0.1, 2.0]), crank_speed=1.0, on_gap="nan")


def far():
    """A coupler with its mass beyond B."""
    return scene(ks.crank_slider(R, L, coupler=ks.Link(1.0, 2.5)))


def two_throws(across=0.2):
    """A second coupler on a pin of the first, beside its line."""
    pin = ks.Pin(on="coupler", at=(1.0, across), name="C")
    second = ks.SliderGroup(2.0, on="C", pin="D", label="2", slider=ks.Link(100.0))
    return scene(ks.Mechanism("two", ks.Crank(R), (*ks.crank_slider(R, L).groups, pin, second)))


def scene(mechanism=None, loads=(), speed=SPEED, **more):
    return ks.Scene(mechanism or ks.crank_slider(R, L), speed, loads=loads, **more).solve(12)


@pytest.mark.parametrize(
    ("make", "bar", "message"),
    [
        (solved, "steel", "bar must be a ks.Bar"),
        (solved, ks.Bar(6e-3, 3e-4, mass=150.0), r"Its mass, 150 kg, differs by \+0 kg.*50 kg m2, by \+29.5 kg m2"),
        (solved, ks.Bar(6e-3, 3e-4, masses=[(1.2, 88.5)]), "its centre, 1.118 m from the first pin, by 0.118 m"),
        (solved, ks.Bar(6e-3, 3e-4, masses=[(1.0, 200.0)]), r"Its mass, 200 kg, differs by \+50 kg"),
        (lambda: scene(ks.crank_slider(R, L, coupler=ks.Link(1.0, (1.0, 0.1), 1 / 3))), PLAIN, "by 0.1 m"),
        (
            lambda: scene(ks.crank_slider(R, L, coupler=ks.Link(2.0, 1.5, 0.5))),
            ks.Bar(1.0, 1.0, [(2.5, 1.0)]),
            "is not",
        ),
        (lambda: scene(loads=[ks.Force(1.0, at=("coupler", 1.0, 0.2))]), PLAIN, "acts 0.2 m off its axis"),
        (lambda: scene(loads=[ks.Force(1.0, at=("coupler", 2.5))]), PLAIN, "2.5 m from the first pin, beyond"),
        (lambda: scene(loads=[ks.Torque(1.0, on="coupler")]), PLAIN, "is a couple without a place"),
        (gaping, PLAIN, "does not close"),
        (lambda: scene(ks.crank_slider(np.array([[0.2], [0.3]]), L)), PLAIN, "one design at a time"),
    ],
)
def test_wrong_links_are_refused(make, bar, message):
    with pytest.raises(ks.ParameterError, match=message):
        make().sections("coupler", bar)


@pytest.mark.parametrize(
    ("make", "link", "message"),
    [
        (scene, "slider", "has no two pins"),
        (lambda: scene(ks.slotted_lever(0.1, pivot=(0.3, 0.0))), "lever", "moves along it"),
        (two_throws, "coupler", "'C2' acts 0.2 m off its axis"),
    ],
)
def test_links_that_are_no_bars_are_refused(make, link, message):
    with pytest.raises(ks.ParameterError, match=message):
        make().sections(link, PLAIN)


def test_unknown_names_are_refused():
    with pytest.raises(ks.QuantityError, match="did you mean 'coupler'"):
        solved().sections("couplr", SAW)
    with pytest.raises(ks.QuantityError, match="allowed"):
        ks.sizing.pin_strength(solved(), "X", diameter=0.1, width=0.1)
    with pytest.raises(ks.ParameterError, match="at must be a whole number"):
        solved().sections("coupler", SAW, at=0)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ks.sizing.bar_strength(3, "coupler", SAW, **LIMITS), "solution must be a Solution"),
        (lambda: ks.sizing.bar_strength(solved(), "coupler", 3, **LIMITS), "bar must be a ks.Bar"),
        (
            lambda: ks.sizing.bar_strength(solved(), "coupler", PLAIN, **LIMITS),
            "lacks its second_moment.*youngs_modulus",
        ),
        (
            lambda: ks.sizing.bar_strength(
                solved(), "coupler", SAW, ultimate=0.0, endurance=np.nan, yield_strength=1.0
            ),
            "ultimate must be greater than 0, got 0.0; endurance must be finite",
        ),
        (lambda: ks.sizing.pin_strength(solved(), "A", diameter=-0.1, width=np.inf), "diameter must be.*width must be"),
        (lambda: ks.sizing.pin_strength(gaping(), "A", diameter=0.1, width=0.1), "does not close"),
        (lambda: PLAIN.properties(L), "Bar.properties: give the bar its mass"),
        (lambda: ks.needs(solved(), "O", progress=False, bars=[SAW]), "bars must be a dict"),
        (lambda: ks.needs(solved(), "O", progress=False, bars=np.ones(2)), "bars must be a dict"),
        (lambda: ks.needs(solved(), "O", progress=False, shaft=np.array([])), "shaft must be a dict"),
        (lambda: ks.needs(solved(), "O", progress=False, shaft={"lenght": 1.0}), "needs: shaft: number is 'lenght'"),
        (lambda: solved().sections("coupler", SAW, at=10**400), "at must be at most .* memory"),
        (lambda: ks.needs(solved(), "O", progress=False, bars={"coupler": PLAIN}), "lacks its second_moment"),
        (lambda: ks.needs(solved(), "O", progress=False, shaft={"length": 1.0}), "polar_moment must be a number"),
        (lambda: strength.bar_rigidity(solved(speed=0.0), "coupler", SAW), "needs: bars: the crank is at rest"),
        (lambda: ks.plots.sections(3), "found must be Sections"),
        (lambda: ks.plots.sections(solved().sections("coupler", SAW), ax=[1]), "ax must be 4 Axes"),
    ],
)
def test_wrong_calls_are_refused(call, message):
    with pytest.raises(ks.ParameterError, match=message):
        call()


# Figure and table


def test_figure_shows_envelopes_and_the_worst_angle():
    found = ks.sizing.bar_strength(solved(), "coupler", SAW, **LIMITS)
    four = ks.plots.sections(found)
    (moment,) = (line for line in four[2].lines if len(line.get_xdata()) == 101)
    assert np.abs(moment.get_ydata()).max() * 1e3 == pytest.approx(found.sections.largest_moment.value)
    top = max(np.max(line.get_ydata()) for line in four[3].lines)
    assert top * 1e6 == pytest.approx(found.largest_stress, rel=1e-4)
    plt.close(four[0].figure)


def test_table_and_text_name_the_peaks():
    found = solved().sections("coupler", SAW)
    value, x, angle = found.largest_moment
    assert tuple(found.table().loc["moment"]) == ("N m", value, x, pytest.approx(np.degrees(angle)))
    assert f"{value:.6g} N m at 1 m" in repr(found)


@pages.needed
@pytest.mark.slow
def test_numbers_of_the_page_are_those_of_the_library():
    names: dict = {}
    for code in pages.cells("parts/sections.md"):
        exec(code, names)
    assert names["found"].order > 20
