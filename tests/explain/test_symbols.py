"""Symbols: what numbers of a scene and quantities are called."""

import kinetostatics as ks
from kinetostatics.explain.formats import Symbol, load_keys, path_symbol, quantity_symbol
from tests.support.every import every


@every(
    "path, text",
    [
        ("crank_length", "l_crank"),
        ("coupler_length2", "l_coupler2"),
        ("guide_angle", "beta"),
        ("guide_offset2", "e_2"),
        ("slider.mass", "m_slider"),
        ("coupler.centre.across", "b_coupler"),
        ("crank_speed", "omega"),
        ("gravity.acceleration", "g"),
        ("spring2.stiffness", "k_spring2"),
        ("rocker_pivot.x", "x_rocker_pivot"),
        ("cam.cosine.2", "cosine2_cam"),
        ("friction.A.mu", "mu_friction_A"),
        ("slot_angle", "slot_angle"),
    ],
)
def test_numbers_of_a_scene(path, text):
    assert path_symbol(path).text == text


@every(
    "quantity, text",
    [
        ("balancing_torque", "T"),
        ("guide_force2", "F_guide2"),
        ("coupler_rate", "omega_coupler"),
        ("coupler_angular_acceleration", "alpha_coupler"),
        ("slider_acceleration", "a_slider"),
        ("A_friction_loss", "P_A"),
        ("reduced_inertia", "reduced_inertia"),
    ],
)
def test_quantities(quantity, text):
    assert quantity_symbol(quantity).text == text


def test_a_symbol_as_text():
    assert Symbol("F", "x", "slider").text == "Fx_slider"
    assert Symbol("theta", owner="coupler", primes=2).text == "theta_coupler''"
    assert Symbol("w", again=2).text == "w2"
    assert Symbol("R", "x", "A pan").text == "Rx_A_pan"


def test_loads_of_a_kind_are_counted_as_in_paths():
    loads = (ks.Spring(1.0, 0.0), ks.Gravity(), ks.Spring(2.0, 0.0))
    assert load_keys(loads) == ["spring", "gravity", "spring2"]
