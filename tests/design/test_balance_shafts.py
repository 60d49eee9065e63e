"""Shafts that cancel harmonics of the shaking force: exact, whatever the machine, and what is left."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

ROUNDING = 1e-11
LINKS = {
    "crank": ks.Link(2.0, (0.03, 0.01), 0.02),
    "coupler": ks.Link(1.0, (0.1, 0.01), 0.01),
    "slider": ks.Link(4.0),
}


def slider_crank(**changes):
    return ks.crank_slider(0.1, 0.35, **LINKS | changes)


def v_twin(angle=np.pi / 2):
    first = ks.SliderGroup(0.2, coupler=ks.Link(0.6, 0.07, 1e-3), slider=ks.Link(0.5))
    second = ks.SliderGroup(0.2, ks.Guide.at(angle), slider=ks.Link(0.5), pin="C", label="2")
    return ks.Mechanism("V twin", ks.Crank(0.05, ks.Link(1.0, -0.01)), (first, second))


MACHINES = {
    "centric": slider_crank(),
    "offset": slider_crank(guide_offset=0.05),
    "inclined": slider_crank(guide_angle=1.1, guide_offset=-0.04),
    "V twin": v_twin(),
    "V twin of 60 degrees": v_twin(np.pi / 3),
    "four-bar": ks.four_bar(
        0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=ks.Link(3.0, 0.1), coupler=ks.Link(2.0, 0.2)
    ),
    "yoke": ks.scotch_yoke(0.1, slider=ks.Link(3.0), block=ks.Link(0.4)),
    "cam": ks.cam_crank_slider(ks.cams.Circle(0.1, (-0.01, 0.0)), 0.4, block=ks.Link(1.0), slider=ks.Link(4.0)),
}


def harmonics(scene, count=2048):
    """Largest value of each harmonic, N, by a Fourier transform of the solution's shaking force."""
    x, y = scene.solve(count).shaking_force
    terms = np.fft.fft(x + 1j * y) / count
    return np.abs(terms[1 : count // 2]) + np.abs(terms[: count // 2 : -1])


@pytest.mark.slow
@every("speed", [30.0, -30.0])
@every("name", MACHINES)
def test_harmonics_cancel_to_rounding_and_others_stay(name, speed):
    found = ks.balancing.shafts(ks.Scene(MACHINES[name], speed))
    before, after = harmonics(found.bare), harmonics(found.scene)
    assert np.all(after[:2] < ROUNDING * before.max())
    assert np.allclose(after[2:], before[2:], rtol=0.0, atol=ROUNDING * before.max())
    table = found.table()
    assert np.allclose(table["before [N]"].to_numpy(), before[:6], rtol=0.0, atol=ROUNDING * before.max())
    assert np.allclose(table["after [N]"].to_numpy(), after[:6], rtol=0.0, atol=ROUNDING * before.max())


def test_unbalances_are_those_of_the_series_of_the_slider():
    """Mass m at the pin of a crank r, rod l: m r / 2 each way, and the second harmonic by its Fourier coefficient."""
    m, r, rod = 4.0, 0.1, 0.35
    phi = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    second = 2.0 * np.mean(np.sqrt(rod * rod - (r * np.sin(phi)) ** 2) * np.cos(2.0 * phi))
    found = ks.balancing.shafts(ks.Scene(ks.crank_slider(r, rod, slider=ks.Link(m)), 10.0))
    assert [shaft.ratio for shaft in found.shafts] == [1.0, -1.0, 2.0, -2.0]
    expected = [0.5 * m * r, 0.5 * m * r, 0.5 * m * second, 0.5 * m * second]
    assert [shaft.unbalance for shaft in found.shafts] == pytest.approx(expected, rel=1e-12)
    assert np.abs([shaft.phase for shaft in found.shafts]) == pytest.approx(np.pi)


@pytest.mark.slow
def test_lanchesters_shafts_of_a_four_in_line():
    """Its second harmonic, 4 m r / lambda along the cylinders nearly, is all that shafts take: the first is zero."""
    parts = []
    for number, angle in enumerate(np.radians([0, 180, 180, 0])):
        at = 0.05 * np.cos(angle), 0.05 * np.sin(angle)
        parts.append(ks.Pin(on="crank", at=at, name=f"P{number}"))
        parts.append(ks.SliderGroup(0.2, slider=ks.Link(2.0), on=f"P{number}", pin=f"B{number}", label=str(number)))
    engine = ks.Scene(ks.Mechanism("four in line", ks.Crank(None), tuple(parts)), 200.0)
    places = {2.0: (0.0, 0.1), -2.0: (0.0, -0.1)}
    found = ks.balancing.shafts(engine, at=places)
    assert {shaft.ratio: shaft.at for shaft in found.shafts} == places
    (unbalance, same) = (4 * shaft.unbalance for shaft in found.shafts)
    assert unbalance == pytest.approx(same) == pytest.approx(4 * 2.0 * 0.05 * 0.25 / 2, rel=0.02)
    largest = [ks.extremes(scene.solve(90), "shaking_force").largest for scene in (engine, found.scene)]
    assert largest[1] < 0.02 * largest[0]


@pytest.mark.slow
@every("name", ["offset", "inclined", "V twin", "cam"])
def test_a_counterweight_on_the_crank_takes_the_forward_circle(name):
    scene = ks.Scene(MACHINES[name], 30.0)
    found = ks.balancing.shafts(scene, (1,), crank=ks.Counterweight(arm=0.08))
    assert [shaft.ratio for shaft in found.shafts] == [-1.0]
    (_, alone) = ks.balancing.shafts(scene, (1,)).shafts
    assert found.shafts[0].unbalance == pytest.approx(alone.unbalance, rel=1e-11)
    before, after = harmonics(scene), harmonics(found.scene)
    assert after[0] < ROUNDING * before.max()
    assert found.balanced.mechanism is found.scene.mechanism
    assert found.balanced.added_mass > 0.0


def test_what_has_no_circle_has_no_shaft():
    assert not ks.balancing.shafts(ks.Scene(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), 30.0), (2, 3)).shafts
    turned = ks.Scene(ks.crank_slider(0.1, 0.35, crank=ks.Link(2.0, 0.05)), 30.0)
    (shaft,) = ks.balancing.shafts(turned, (1, 2)).shafts
    assert (shaft.ratio, shaft.unbalance) == (1.0, pytest.approx(0.1))
    assert not ks.balancing.shafts(ks.balancing.shafts(turned).scene).shafts


def test_springs_with_mass_count_and_solutions_do_too():
    scene = ks.Scene(
        slider_crank(), 30.0, 20.0, [ks.Gravity(), ks.Spring(2000.0, 0.3, mass=0.1), ks.ProcessForce(-50.0)]
    )
    found = ks.balancing.shafts(scene.solve(5), range(1, 4))
    assert found.scene.loads[:3] == scene.loads
    still = ks.Scene(found.scene.mechanism, 30.0, loads=found.scene.loads)
    assert np.all(harmonics(still)[:3] < ROUNDING * harmonics(ks.Scene(scene.mechanism, 30.0)).max())


def test_half_harmonics_of_a_motion_of_two_turns():
    """The branch through a change point repeats after two turns; it has harmonics of half a turn."""
    bars = ks.four_bar(0.1, 0.3, 0.3, rocker_pivot=(0.1, 0.0), assembly="crossed", rocker=ks.Link(3.0, 0.1))
    assert bars.turns == 2
    found = ks.balancing.shafts(ks.Scene(bars, 30.0), (0.5, 1.5))
    assert {abs(shaft.ratio) for shaft in found.shafts} == {0.5, 1.5}
    before, after = harmonics(found.bare), harmonics(found.scene)
    assert np.all(after[[0, 2]] < ROUNDING * before.max())
    assert np.all(before[[0, 2]] > 1e-3 * before.max())


REFUSED = {
    "no scene": (lambda s: ks.balancing.shafts(s.mechanism), "scene must be a Scene"),
    "one number": (lambda s: ks.balancing.shafts(s, 2), "must be a sequence such as"),
    "none": (lambda s: ks.balancing.shafts(s, ()), "must be a sequence such as"),
    "array without axis": (lambda s: ks.balancing.shafts(s, np.array(1)), "must be a sequence such as"),
    "ragged": (lambda s: ks.balancing.shafts(s, [(1, 2), 3]), "must be a number"),
    "a zero": (lambda s: ks.balancing.shafts(s, (0, 1)), "must not be 0"),
    "negative": (lambda s: ks.balancing.shafts(s, (-1,)), "must be positive"),
    "twice": (lambda s: ks.balancing.shafts(s, (1, 2, 1.0)), "each once"),
    "irrational": (lambda s: ks.balancing.shafts(s, (np.pi,)), "denominator of at most 24"),
    "of no turn": (lambda s: ks.balancing.shafts(s, (1, 0.5)), r"no harmonics \[0.5\]: it repeats after 1 turn of"),
    "text": (lambda s: ks.balancing.shafts(s, ("first",)), "must be a number"),
    "place": (lambda s: ks.balancing.shafts(s, at=(0.1,)), "at must be a pair"),
    "ratio of a place": (lambda s: ks.balancing.shafts(s, at={3: (0.0, 0.0)}), "at has ratios that no shaft has"),
    "weight": (lambda s: ks.balancing.shafts(s, crank=0.5), "must be a Counterweight"),
    "limits": (
        lambda s: ks.balancing.shafts(s, crank=ks.Counterweight(arm=0.01, largest_mass=0.1)),
        "exceeds the largest mass",
    ),
    "designs": (
        lambda s: ks.balancing.shafts(s.varied({"slider.mass": np.array([[1.0], [2.0]])})),
        "single|batch|design",
    ),
}


@every("name", REFUSED)
def test_refusals(name):
    call, words = REFUSED[name]
    with pytest.raises(ks.ParameterError, match=words):
        call(ks.Scene(slider_crank(), 30.0))


def test_gaps():
    with pytest.raises(ks.ParameterError, match=r"balance shafts: crank-slider .*close"):
        ks.balancing.shafts(ks.Scene(ks.crank_slider(0.3, 0.2, slider=ks.Link(1.0)), 30.0))
