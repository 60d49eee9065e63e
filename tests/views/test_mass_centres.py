"""Drawing of principal points: places of H and S by hand, the contour of the vectors, and refusals."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from support.chains import chain
from support.every import every

MASSES = {"crank": ks.Link(1.0, 0.019), "coupler": ks.Link(2.0, 0.1), "slider": ks.Link(5.0)}
BARE = ks.crank_slider(0.038, 0.3, guide_offset=-0.02, **MASSES)
OVERALL = ks.balancing.partial(BARE, "overall", crank=ks.Counterweight(arm=-0.035)).mechanism
FULL = ks.balancing.full(BARE, crank=ks.Counterweight(arm=-0.05), coupler=ks.Counterweight(arm=-0.055)).mechanism
CLOSE = 1e-14


def marked(ax):
    """Places of labels H1, H2 ... and S."""
    texts = ((text.get_text(), text.xy) for text in ax.texts if text.get_text()[0] in "HS")
    return {name: np.array(place) for names, place in texts for name in names.split(", ")}


def curve(ax, text):
    (line,) = (line for line in ax.lines if line.get_label() == text)
    return np.array(line.get_data())


def test_principal_points_of_the_mower_by_hand(axes):
    """h1 = (m1 L_OS1 + (m2 + m3) L_OA) / m along the crank, h2 = (m2 L_AS2 + m3 L_AB) / m along the coupler."""
    assert ks.plots.principal_points(BARE, 60, ax=axes) is axes
    crank = np.array([np.cos(np.pi / 3), np.sin(np.pi / 3)])
    A, y = 0.038 * crank, -0.02
    B = np.array([A[0] + np.sqrt(0.09 - (y - A[1]) ** 2), y])
    coupler = (B - A) / 0.3
    h1, h2 = (1.0 * 0.019 + 7.0 * 0.038) / 8.0 * crank, (2.0 * 0.1 + 5.0 * 0.3) / 8.0 * coupler
    expected = {"H1": h1, "H2": A + h2, "H3": B, "S": h1 + h2}
    found = marked(axes)
    assert list(found) == list(expected)
    for name, place in expected.items():
        np.testing.assert_allclose(found[name], place, rtol=0, atol=CLOSE, err_msg=name)
    corners = curve(axes, "contour of the vectors h").T
    np.testing.assert_allclose(corners, [[0.0, 0.0], h1, h1 + h2], rtol=0, atol=CLOSE)


def test_paths_before_and_after_counterweights(axes):
    ks.plots.principal_points(OVERALL, 60, before=BARE, ax=axes)
    for text, mechanism in (("path of S", OVERALL), ("path of S before", BARE)):
        s = ks.solve(mechanism, np.radians(np.arange(721) / 2), crank_speed=1.0)
        masses = {name: link.mass for name, link in mechanism.links.items()}
        centre = sum(mass * s.position(name) for name, mass in masses.items()) / sum(masses.values())
        np.testing.assert_allclose(curve(axes, text), centre, rtol=0, atol=CLOSE)


def test_full_balancing_puts_the_points_on_the_joints(axes):
    ks.plots.principal_points(FULL, 60, ax=axes)
    s, found = ks.solve(FULL, [np.pi / 3], crank_speed=1.0), marked(axes)
    for name, joint in {"H1": "O", "H2": "A", "H3": "B", "S": "O"}.items():
        np.testing.assert_allclose(found[name], s.position(joint)[:, 0], rtol=0, atol=CLOSE)
    assert np.abs(curve(axes, "path of S")).max() < CLOSE


@pytest.mark.parametrize("seed", range(3))
def test_contour_of_random_chains_ends_at_the_mass_centre(seed, axes):
    scene, angles = chain(seed)
    s = ks.solve(scene.mechanism, angles[1:2], crank_speed=1.0)
    ks.plots.principal_points(scene.mechanism, np.degrees(angles[1]), ax=axes)
    masses = {name: link.mass for name, link in scene.mechanism.links.items()}
    centre = sum(mass * s.position(name)[:, 0] for name, mass in masses.items()) / sum(masses.values())
    np.testing.assert_allclose(marked(axes)["S"], centre, rtol=1e-12, atol=1e-13)
    assert len(marked(axes)) == 1 + sum(mass > 0 for mass in masses.values())


@every(
    ("given", "error", "words"),
    [
        ((3,), ks.ParameterError, "mechanism must be a Mechanism"),
        ((BARE, 60, 3), ks.ParameterError, "before must be a Mechanism"),
        ((BARE, "60"), ks.ParameterError, "angle"),
        ((BARE, np.nan), ks.ParameterError, "angle"),
        ((ks.crank_slider(0.038, 0.3), 60), ks.ParameterError, "has no mass and so no mass centre"),
        ((ks.crank_slider(np.array([[0.03], [0.04]]), 0.3, slider=ks.Link(1.0)), 60), ks.ParameterError, "one design"),
        (
            (ks.crank_slider(0.2, 0.3, guide_offset=0.15, slider=ks.Link(1.0)), 280),
            ks.AssemblyError,
            "cannot be assembled",
        ),
    ],
)
def test_wrong_arguments_are_refused(given, error, words):
    with pytest.raises(error, match=words):
        ks.plots.principal_points(*given)
    plt.close("all")


def test_machine_open_at_other_angles_is_drawn(axes):
    machine = ks.crank_slider(0.2, 0.3, guide_offset=0.15, slider=ks.Link(1.0))
    path = curve(ks.plots.principal_points(machine, 40, ax=axes), "path of S")
    assert np.isnan(path).any()
    assert np.isfinite(path).any()
