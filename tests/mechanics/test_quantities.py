"""Units, labels and kinds come from what groups declare, whatever a label makes of their names."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.animation import PillowWriter

import kinetostatics as ks
from kinetostatics.cycle.extremes import extremes_frame
from kinetostatics.mechanics.quantities import of_mechanism
from kinetostatics.studies.simplifications import ingredients, two_mass_coupler
from support.every import every

TURN = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)


def chain(label):
    """The README's six-bar: a four-bar whose rocker pin drives a slider."""
    return ks.Mechanism(
        "six-bar",
        ks.Crank(0.1, ks.Link(1.0, 0.05, 0.01)),
        (
            ks.RockerGroup(0.4, 0.3, (0.35, 0.1), coupler=ks.Link(2.0, 0.2, 0.03), rocker=ks.Link(2.0, 0.1, 0.02)),
            ks.SliderGroup(0.5, on="B", pin="C", label=label, coupler=ks.Link(1.0, 0.2, 0.02), slider=ks.Link(3.0)),
        ),
    )


def swinging(label=""):
    """A crank-slider with a heavy slider beside its pin, so that its guide bears a moment."""
    group = ks.SliderGroup(0.5, label=label, coupler=ks.Link(1.0, 0.2, 0.02), slider=ks.Link(3.0, (0.02, 0.05)))
    return ks.Mechanism("saw", ks.Crank(0.1), (group,))


def v_engine(second=0.5):
    groups = (
        ks.SliderGroup(0.4, ks.Guide.at(-0.5), slider=ks.Link(1.0)),
        ks.SliderGroup(0.4, ks.Guide.at(second), pin="C", label="2", slider=ks.Link(1.0)),
    )
    return ks.Mechanism("V engine", ks.Crank(0.1, ks.Link(2.0)), groups)


@pytest.mark.slow
@every("label", ["2", "_saw", "_rate", "_position", "_torque"])
def test_six_bar_guide_outputs_have_their_units(label):
    solution = ks.solve(chain(label), TURN, crank_speed=20.0, loads=ks.Gravity())
    assert {f"guide_force{label} [N]", f"guide_moment{label} [N m]"} <= set(solution.frame().columns)
    table = extremes_frame(solution)
    words = label.replace("_", " ")
    assert table.loc[f"guide force{words}", "unit"] == "N"
    assert table.loc[f"guide moment{words}", "unit"] == "N m"


def test_moment_with_label_saw_is_in_newton_metres():
    solution = ks.solve(swinging("_saw"), TURN, crank_speed=20.0)
    ax = ks.plots.over_turn(solution, "guide_moment_saw")
    assert ax.get_ylabel() == "guide moment saw [N m]"
    (line,) = [line for line in ax.lines if not line.get_label().startswith("_")]
    assert line.get_label() == "guide moment saw"
    plt.close(ax.figure)


@pytest.mark.slow
def test_comparison_uses_declared_names():
    solution = ks.solve(swinging("_saw"), TURN, crank_speed=20.0)
    rows = ks.compare(solution, solution).frame().index
    assert {"largest reaction A_saw", "largest shaking force", "largest coupler_saw inertia force"} <= set(rows)
    assert ks.needs(solution, "A_saw", 0.1).label == "reaction A_saw"


def test_needs_simplifies_links_of_a_kind_together():
    parts = ingredients(chain("2"))
    assert list(parts)[-5:-1] == ["crank", "rocker", "slider", "coupler"]
    assert [choice.name for choice in parts["coupler"]] == [
        "no coupler inertia",
        "two-mass coupler",
        "massless coupler",
    ]
    (massless,) = parts["slider"]
    bare = massless.simplify(ks.solve(chain("2"), TURN, crank_speed=20.0))
    assert bare.mechanism.links["slider2"].mass == 0


@every("on, pin", [("O", "C"), ("B", "C")])
def test_two_masses_keep_the_forces_of_a_coupler(on, pin):
    """On the frame, as a rod from O, and on the pin of a slider; the inertia of two masses is m s (l - s)."""
    rod = ks.Link(4.0, 0.3, 4.0 * 0.3 * (0.9 - 0.3))
    first = ks.SliderGroup(0.4, ks.Guide.at(0.0, 0.02), slider=ks.Link(1.0))
    second = ks.SliderGroup(0.9, ks.Guide.at(0.3, 0.1), on=on, pin=pin, label="2", coupler=rod, slider=ks.Link(2.0))
    whole = ks.Mechanism("chain", ks.Crank(0.1), (first, second))
    masses = two_mass_coupler(whole)
    assert masses.links["coupler2"].mass == 0
    one, two = (ks.solve(made, TURN, crank_speed=20.0, loads=ks.Gravity()) for made in (whole, masses))
    scale = max(np.abs(one.reaction("C")).max(), 1.0)
    assert np.max(np.abs(one.balancing_torque - two.balancing_torque)) < 1e-13 * scale
    assert np.max(np.abs(one.scalar("guide_force2") - two.scalar("guide_force2"))) < 1e-12 * scale


def test_coupler_on_a_coupler_keeps_its_mass():
    chained = chain("2")
    masses = two_mass_coupler(chained)
    total, kept = (sum(link.mass for link in made.links.values()) for made in (chained, masses))
    assert kept == pytest.approx(total, rel=1e-15)


@pytest.mark.slow
def test_counterweight_effect_covers_every_guide():
    engine = v_engine()
    balanced = ks.balancing.counterweight(engine, "crank", -0.05, ks.balancing.Counterweight(arm=-0.05))
    rows = balanced.effect(crank_speed=10.0).index
    for way in ("along", "across"):
        for slider in ("slider", "slider2"):
            assert f"largest shaking force {way} guide of {slider} [N]" in rows


def test_along_needs_parallel_guides():
    with pytest.raises(ks.ParameterError, match="guides of slider and slider2 that are not parallel"):
        ks.balancing.optimal(v_engine(), "along", crank=ks.balancing.Counterweight(arm=0.05))


@pytest.mark.slow
def test_second_group_reactions_start_at_their_joint(tmp_path):
    film = ks.plots.animation(ks.solve(chain("2"), TURN, crank_speed=20.0), joints=("B2", "guide2"), frames=2)
    film.save(tmp_path / "chain.gif", writer=PillowWriter(fps=10))
    assert (tmp_path / "chain.gif").stat().st_size
    plt.close("all")


@pytest.mark.slow
def test_shipped_quantities_have_unit_and_label():
    for name in ("sawframe_2r63", "mower_drive"):
        case = ks.load_case(name)
        for variant in case.variants.values():
            for quantity in of_mechanism(variant.mechanism).values():
                assert quantity.unit
                assert quantity.label
