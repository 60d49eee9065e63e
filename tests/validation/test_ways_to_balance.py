"""The ways to balance the log frame saw: torque, support reaction and frame force of each, and what finds them."""

import numpy as np
import pytest

import kinetostatics as ks

CASE = ks.load_case("sawframe_2r63_ways")
WAYS = {  # k_d, largest O [kN] and frame force [kN], by independent scripts (spectral derivatives, own Newton-Euler)
    "plain": "1.000 287 287",
    "counterweight": "1.00 143 134.8",
    "counterweight-shaft": "1.000 148 34.5",
    "pin-springs": "4.73 34 287",
    "slider-springs": "5.40 85 287",
    "tuned-springs": "9.98 47 287",
    "circle": "6.08 22 252",
    "cam": "411 0.75 253",
    "cam-shafts": "22.15e3 142.9 0.57",
    "twin": "0.50 1.5 0.0",
    "upright-circle": "6.116 21 252",
    "upright-tuned-springs": "10.05 47 287",
    "upright-cam": "52.9e3 0.0026 253",
    "upright-counterweight-shaft": "1.009 136 34.5",
    "upright-cam-shafts": "52.7e3 142.9 0.57",
}
FOUND = {  # by this library's searches: k_d, frame force [kN]
    "tuned-gas-springs": (31.13, 287),
    "upright-tuned-gas-springs": (31.44, 287),
    "cam-counterweight": (89.5, 118),
    "upright-cam-counterweight": (5.279e4, 118),
}


def figures(name):
    """Gain against the plain saw of the same layout, largest O and largest frame force, kN."""
    turn = CASE.solve(name)
    gain = ks.compare(CASE.solve(CASE.reference_of(name)), turn).mean_torque_ratio
    return float(gain), *(ks.extremes(turn, quantity).largest / 1e3 for quantity in ("O", "shaking_force"))


@pytest.mark.parametrize("name", WAYS)
def test_gain_support_and_frame(name):
    for found, text in zip(figures(name), WAYS[name].split(), strict=True):
        number, _, power = text.partition("e")
        half_a_digit = 0.5 * 10.0 ** (int(power or 0) - len(number.partition(".")[2]))
        assert found == pytest.approx(float(text), abs=1.001 * half_a_digit)


@pytest.mark.parametrize("name", FOUND)
def test_found_ways(name):
    gain, _, frame = figures(name)
    assert gain == pytest.approx(FOUND[name][0], rel=5e-4)
    assert frame == pytest.approx(FOUND[name][1], rel=2e-3)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_longer_springs_at_the_pin():
    scene = CASE.variants["pin-springs"].scene
    springs = [ks.PointSpring(c, 50.0, between=("A", at)) for c, at in ((842e3, (50.0, 0.0)), (52e3, (0.0, 50.0)))]
    turn = ks.Scene(scene.mechanism, scene.crank_speed, loads=[ks.Gravity(), *springs]).solve(720)
    assert ks.compare(CASE.solve("plain"), turn).mean_torque_ratio == pytest.approx(4.70, abs=0.005)
    assert ks.extremes(turn, "O").largest == pytest.approx(34.2e3, abs=50.0)


# Shafts

SPEED, ANGLES = 320 * np.pi / 30, np.linspace(0.0, 2.0 * np.pi, 512, endpoint=False)


def slope(values):
    """Derivative of a periodic function by the crank angle, by its Fourier series."""
    orders = 1j * np.fft.fftfreq(len(values), 1.0 / len(values))
    found = np.fft.ifft(orders * np.fft.fft(values))
    return found if np.iscomplexobj(values) else found.real


def by_itself(scene, weight):
    """Force on the frame, its moment about O, and torque, from the geometry of the masses and the energy."""
    radius, rod = np.full(ANGLES.shape, 0.3), 2.0
    if hasattr(scene.mechanism.groups[0], "cam"):
        radius = sum(a * np.cos(k * ANGLES) for k, a in enumerate(scene.mechanism.groups[0].cam.cosine))
        rod = scene.parameters["coupler_length"]
    pin = radius * np.exp(1j * ANGLES)
    end = pin.real + np.sqrt(rod**2 - pin.imag**2)
    middle, turned = 0.5 * (pin + end), -np.arcsin(pin.imag / rod)
    heavy = [(150.0, middle), (600.0, end + 0j), (scene.parameters["crank.mass"], -0.3 * np.exp(1j * ANGLES))]
    forces = [(place, -mass * SPEED**2 * slope(slope(place))) for mass, place in heavy]
    static = sum(mass * place for mass, place in heavy)
    for item in scene.loads:
        if isinstance(item, ks.BalanceShaft):
            circle = item.unbalance * np.exp(1j * (item.ratio * ANGLES + item.phase))
            forces.append((complex(*item.at), -(SPEED**2) * slope(slope(circle))))
            static = static + circle
    moment = sum((np.conj(place) * force).imag for place, force in forces)
    moment = moment - 20.5 * SPEED**2 * slope(slope(turned))
    energy = 0.5 * SPEED**2 * sum(mass * np.abs(slope(place)) ** 2 for mass, place in heavy[:2])
    energy = energy + 0.5 * 20.5 * SPEED**2 * slope(turned) ** 2 - (np.conj(weight) * static).real
    for spring in (item for item in scene.loads if isinstance(item, ks.Spring)):
        energy = energy + 0.5 * spring.stiffness * (end - spring.free_position) ** 2
    return sum(force for _, force in forces), moment, slope(energy)


@pytest.mark.parametrize(
    "name", ["counterweight-shaft", "cam-shafts", "upright-counterweight-shaft", "upright-cam-shafts"]
)
def test_force_moment_and_torque_with_shafts(name):
    scene = CASE.variants[name].scene
    s = scene.solve(ANGLES)
    force, moment, torque = by_itself(scene, complex(*s.gravity))
    assert np.allclose(s.shaking_force[0] + 1j * s.shaking_force[1], force, rtol=0.0, atol=1e-3)
    assert np.allclose(s.shaking_moment, moment, rtol=0.0, atol=1e-3)
    assert np.allclose(s.balancing_torque, torque, rtol=0.0, atol=1e-2)


def test_counterweight_and_shaft_cancel_the_first_harmonic():
    found = ks.balancing.shafts(CASE.variants["plain"].scene, (1,), crank=ks.Counterweight(arm=-0.3))
    scene = CASE.variants["counterweight-shaft"].scene
    (shaft,) = found.shafts
    assert found.balanced.added_mass == pytest.approx(scene.parameters["crank.mass"], rel=1e-12)
    assert (shaft.ratio, shaft.unbalance) == (
        -1.0,
        pytest.approx(scene.parameters["balance_shaft.unbalance"], rel=1e-12),
    )


@pytest.mark.parametrize("layout", ["", "upright-"])
def test_force_moment_and_torque_below_two_per_cent(layout):
    """The aim of Arakelian and Briot, of the plain machine's largest values."""
    plain, turn = (CASE.solve(f"{layout}{name}") for name in ("plain", "cam-shafts"))
    shares = {"shaking_force": 0.002, "shaking_moment": 0.0122, "balancing_torque": 6.1e-5}
    for quantity, share in shares.items():
        assert abs(ks.extremes(turn, quantity).largest) < share * abs(ks.extremes(plain, quantity).largest)


def test_shafts_of_the_cam_are_those_of_the_formula():
    scene = CASE.variants["cam-shafts"].scene
    bare = ks.Scene(scene.mechanism.with_link("crank", ks.Link()), scene.crank_speed, loads=scene.loads[:2])
    found = ks.balancing.shafts(bare, crank=ks.Counterweight(arm=-0.3))
    assert found.balanced.added_mass == pytest.approx(scene.parameters["crank.mass"], rel=1e-8)
    kept = [item for item in scene.loads if isinstance(item, ks.BalanceShaft)]
    for shaft, own in zip(found.shafts, kept, strict=True):
        assert (shaft.ratio, shaft.unbalance) == (own.ratio, pytest.approx(own.unbalance, abs=1e-6))
    placed = CASE.designs["placed-shafts"].find()
    assert placed.values["balance_shaft.at.x"] == pytest.approx(kept[0].at[0], abs=1e-4)


def test_counterweight_has_the_least_frame_force():
    scene = CASE.variants["counterweight"].scene
    found = ks.design.optimise(scene, {"crank.mass": (0.0, 900.0)}, "largest shaking_force")
    assert found.values["crank.mass"] == pytest.approx(451.0, abs=1.0)


def test_pins_of_twins_carry_what_one_saw_carries():
    twin = CASE.solve("twin")
    assert [round(ks.extremes(twin, joint).largest / 1e3, 1) for joint in ("A", "C2")] == [286.8, 286.8]
    moments = [ks.extremes(turn, "shaking_moment").range[1] for turn in (twin, CASE.solve("plain"))]
    assert moments[0] == pytest.approx(2 * moments[1], rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tuned-springs", "upright-tuned-springs", "tuned-gas-springs", "upright-cam"])
def test_searches_find_what_the_file_holds(name):
    found, kept = CASE.designs[name].find().scene, CASE.variants[name].scene
    mean = [np.abs(scene.solve(720).balancing_torque).mean() for scene in (found, kept)]
    assert mean[0] <= mean[1] * (1 + 1e-6)
    assert mean[0] == pytest.approx(mean[1], rel=1e-4)
