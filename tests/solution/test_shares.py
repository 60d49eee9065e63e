"""Who causes a force: shares add up, the saw's printed shares, effects of leaving out with friction, refusals."""

from dataclasses import dataclass

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.cycle.kinks import has_sign_changes
from kinetostatics.mechanics.quantities import components
from kinetostatics.solution.shares import machines_without, sources_alone
from support import chains, followers, friction_machines
from support.case_files import shipped, unlike_variants
from support.every import every
from support.machines import largest
from support.scenes import BATCH, OWN, PASSING, SCENES

SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
ANGLES = np.linspace(0.05, 6.3, 16)
ROUNDING = 1e-13


def saw(*loads, angles=8, **parts):
    return ks.Scene(SAW, 33.5, loads=[ks.Gravity(), *loads], **parts).solve(angles)


def misfit(solution, more=()):
    """Largest difference of a force from the sum of its sources alone, relative to the largest of these."""
    alone, worst = sources_alone(solution).values(), {}
    for name in (*solution.mechanism.outputs, *more):
        parts = np.array([components(source, name) for source in alone])
        size = max(np.abs(parts).max(initial=0.0), largest(components(solution, name)))
        worst[name] = np.abs(parts.sum(axis=0) - components(solution, name)).max() / (size or 1.0)
    return max(worst.values())


@pytest.mark.slow
@every("name", ["plain, everything", "circle cam, everything", "six-bar"])
def test_sources_add_up_to_every_force(name):
    whole = ("shaking_force", "shaking_moment", "load_torque", "balancing_torque_by_power")
    assert misfit(SCENES[name].solve(ANGLES), whole if name == "plain, everything" else ()) < ROUNDING


@pytest.mark.slow
@every("seed", range(2))
def test_sources_add_up_on_random_chains(seed):
    scene, angles = chains.chain(seed)
    assert misfit(scene.solve(angles)) < 10.0 * ROUNDING


@pytest.mark.slow
@every("kind", ["roller", "flat", "swinging"])
def test_sources_add_up_on_followers(kind):
    assert misfit(followers.scene(followers.KINDS[kind]()).solve(ANGLES)) < ROUNDING


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_inertia_and_weight_of_springs_are_their_own():
    loads = ks.Spring(5e5, 2.0, mass=100.0), ks.Spring(1e5, 2.1, mass=50.0), ks.GasSpring(0.01, 0.01, 2e6, at=2.0)
    assert misfit(saw(*loads).at(ANGLES), ("shaking_force", "shaking_moment")) < ROUNDING
    assert list(sources_alone(saw(*loads)))[-3:] == [
        "Spring on 'slider'",
        "Spring on 'slider' #2",
        "GasSpring on 'slider'",
    ]


@pytest.mark.slow
@every("case", [case for case in shipped_cases() if "friction" not in case])
def test_shares_add_up_to_the_peak_in_every_shipped_machine(case):
    for variant in unlike_variants(case):
        solution = shipped(case).solve(variant)
        if has_sign_changes(solution):
            continue
        assert misfit(solution.at(ANGLES)) < 10.0 * ROUNDING
        for quantity in ("O", "balancing_torque", "shaking_force"):
            found = solution.shares(quantity)
            assert abs(found.rest) < ROUNDING * max(abs(row.peak) for row in found.rows)
            peak = abs(ks.extremes(solution, quantity).largest)
            assert abs(found.total.value) == pytest.approx(peak, rel=1e-9, abs=1e-9)
            assert found.note == ""


PRINTED = {
    "O": (19_680, {"inertia of coupler": (19_148, 19_150), "weight of coupler": (531, 736)}, 107_136),
    "cam_force": (54_852, {"inertia of coupler": (54_845, 54_849), "weight of coupler": (7, -738)}, 202_129),
    "balancing_torque": (5_578, {"inertia of coupler": (5_430, 5_430), "weight of coupler": (149, -237)}, 30_319),
}
"""Of the cosine variant of the saw: peak, share and peak alone by source, and the peak of slider or spring alone."""


@pytest.mark.slow
@every("quantity", PRINTED)
def test_coupler_makes_the_peaks_of_the_balanced_saw(quantity):
    total, sources, alone = PRINTED[quantity]
    found = shipped("sawframe_2r63").solve("cam-cosine").shares(quantity)
    assert round(found.total.value) == total
    for source, (share, peak) in sources.items():
        assert (round(found[source].value), round(found[source].peak)) == (share, peak)
    slider, spring = found["inertia of slider"], found["Spring on 'slider'"]
    assert (round(slider.peak), round(abs(spring.peak))) == (alone, alone)
    assert slider.value == pytest.approx(-spring.value, rel=1e-9)
    assert found["weight of slider"][1:3] == (0.0, 0.0)
    assert abs(found.rest) < 1e-9


def test_means_are_those_of_samples():
    s = saw(ks.Spring(5e5, 2.0))
    found = s.shares("balancing_torque")
    turn = s.at(np.linspace(0.0, 2 * np.pi, 4096, endpoint=False))
    for name, source in sources_alone(turn).items():
        assert found[name].rms == pytest.approx(np.sqrt(np.mean(source.balancing_torque**2)), rel=1e-9, abs=1e-9)
    assert found.total.rms == pytest.approx(np.sqrt(np.mean(turn.balancing_torque**2)), rel=1e-9)


def test_share_of_a_vector_is_its_projection_on_the_total():
    s = saw(ks.Force(9e4, at="B", direction=2.0))
    found = s.shares("|A|")
    assert found.quantity == "A"
    at = s.at(found.total.angle)
    along = at.reaction("A") / np.hypot(*at.reaction("A"))
    for name, source in sources_alone(at).items():
        assert found[name].value == pytest.approx(along @ source.reaction("A"), rel=1e-12, abs=1e-6)


def test_loads_of_one_title_are_numbered():
    rows = saw(ks.Torque(3.0, on="crank"), ks.Torque(5.0, on="crank")).shares("balancing_torque").rows
    assert [(row.source, row.peak) for row in rows[-2:]] == [
        ("Torque on 'crank'", -3.0),
        ("Torque on 'crank' #2", -5.0),
    ]
    assert np.isnan(rows[-1].angle)


def test_table_and_text_have_every_source_and_the_total():
    found = saw().shares("O")
    table = found.frame()
    assert list(table.columns) == ["share [N]", "of total [%]", "peak [N]", "peak at [deg]", "rms [N]"]
    assert table["share [N]"].iloc[:-1].sum() == pytest.approx(table.loc["total", "share [N]"])
    assert table["of total [%]"].iloc[:-1].sum() == pytest.approx(100.0)
    assert [line.split("  ")[0] for line in str(found).splitlines()] == ["source", *table.index]
    assert "note" not in table.attrs


# With friction


RUBBING = {"guide": ks.GuideFriction(0.1), "A": ks.PinFriction(0.05, 0.1)}


@pytest.mark.slow
def test_with_friction_rows_are_effects_of_leaving_out():
    s = saw(ks.ProcessForce(-2e4), friction=RUBBING, angles=720)
    found = s.shares("O")
    assert not found.superposed
    assert [row.source for row in found.rows][-2:] == ["friction guide", "friction A"]
    assert "effect of leaving out [N]" in found.frame().columns
    assert "each row is the force of the whole machine less that without its source" in found.frame().attrs["note"]
    assert abs(found.rest) > 1.0
    without = {
        "friction guide": saw(ks.ProcessForce(-2e4), friction={"A": RUBBING["A"]}, angles=720),
        "ProcessForce on 'slider'": saw(friction=RUBBING, angles=720),
    }
    for source, other in without.items():
        sampled = np.hypot(*(s.reaction("O") - other.reaction("O"))).max()
        assert sampled <= found[source].peak * (1.0 + 1e-12)
        assert sampled > 0.99 * found[source].peak


@pytest.mark.slow
def test_a_load_given_twice_is_left_out_once():
    spring = ks.Spring(5e5, 2.0)
    s = saw(spring, spring, friction=RUBBING)
    without = saw(spring, friction=RUBBING).reaction("O")
    for source in ("Spring on 'slider'", "Spring on 'slider' #2"):
        assert machines_without(s)[source].at(s.crank_angle).reaction("O") == pytest.approx(without, rel=1e-9)


@pytest.mark.slow
def test_leaving_out_inertia_keeps_weight():
    s = saw(friction=RUBBING)
    heavy = ks.Force(600 * 9.81, at=("slider", 0.0, 0.0), direction=-np.pi / 2)
    massless = SAW.with_link("slider", ks.Link())
    resting = ks.Scene(massless, 33.5, loads=[ks.Gravity(), heavy], friction=RUBBING).solve(s.crank_angle)
    other = machines_without(s)["inertia of slider"].at(s.crank_angle)
    assert other.guide_force == pytest.approx(resting.guide_force, rel=1e-10)


@pytest.mark.slow
@every("kind", friction_machines.KINDS)
def test_without_any_friction_left_effects_are_shares(kind):
    scene = friction_machines.Drawn(kind, 3, 0.5).scene
    plain = ks.Scene(scene.mechanism, scene.crank_speed, scene.crank_acceleration, scene.loads)
    solution = plain.solve(np.array([0.4, 2.0, 4.0]), on_gap="nan")
    alone, without = sources_alone(solution), machines_without(solution)
    assert alone.keys() == without.keys()
    for source, other in without.items():
        effect = solution.reaction("O") - other.at(solution.crank_angle).reaction("O")
        size = largest(solution.reaction("O"))
        np.testing.assert_allclose(effect, alone[source].reaction("O"), atol=1e-11 * size, rtol=0.0)


# Bad input


OPEN = ks.solve(ks.crank_slider(1.0, 0.5, guide_offset=0.2, slider=ks.Link(1.0)), ANGLES, crank_speed=1.0, on_gap="nan")
IDLE = ks.solve(ks.crank_slider(0.3, 2.0), 0.1, crank_speed=1.0)


@every(
    "solution, quantity, error, message",
    [
        (saw(), "0", ks.QuantityError, "quantity is '0', allowed: 'balancing_torque'"),
        (saw(), 3, ks.ParameterError, "quantity must be a name"),
        (saw(), "slider_velocity", ks.QuantityError, "slider_velocity is not linear in masses and loads; forces and"),
        (saw(), "kinetic_energy", ks.QuantityError, "which are balancing_torque, .*, load_torque"),
        (saw(), "|ground O|", ks.QuantityError, "ground O is a force on the frame, .*: balancing_torque"),
        (saw(), "ground", ks.QuantityError, "ground is a force on the frame"),
        (saw(), "|guide_force|", ks.QuantityError, "only vectors have"),
        (BATCH, "O", ks.ParameterError, "shares works on one design at a time"),
        (OPEN, "O", ks.ParameterError, "does not close for crank angles"),
        (IDLE, "O", ks.ParameterError, "shares: O is 0 all over the period"),
        (PASSING, "A", ks.ParameterError, "A grows without bound at crank angle"),
    ],
)
@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning", "ignore::kinetostatics.ConditionWarning")
def test_bad_input_is_refused(solution, quantity, error, message):
    with pytest.raises(error, match=message):
        solution.shares(quantity)


@dataclass(frozen=True)
class Drag:
    """A load of the user's own."""

    on: str = "slider"

    def push(self, motion):
        """Force that grows with the square of the speed."""
        return -40.0 * motion.slider_velocity * abs(motion.slider_velocity)


def test_loads_of_the_users_own_have_a_share():
    found = saw(Drag()).shares("balancing_torque")
    assert abs(found.rest) < 1e-9
    assert found["Drag on 'slider'"].rms > 0.0


def test_own_group_that_needs_mass_is_refused():
    with pytest.raises(ks.ParameterError, match="fails if only inertia of crank acts"):
        OWN["group"][0].solve(8).shares("O")


def test_unknown_source_is_refused_with_those_there():
    with pytest.raises(ks.QuantityError, match=r"source is 'coupler', allowed: 'inertia of coupler', .*'total'"):
        saw().shares("O")["coupler"]
