"""Extremes, sweeps, tolerances, comparisons, flywheels and contacts agree with each other and with dense evaluation."""

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import component_sizes
from support.every import every
from support.pulsed_scenes import Dense, PulsedScene

TORQUE = "balancing_torque"
ENDS = ("smallest", "largest")
MEANS = ("mean", "mean_absolute", "swing")
AGREEMENT = 1e-9
"""Relative to the largest value of the quantity; of the energy of a flywheel relative to itself."""


def figures(pulsed, names, outputs):
    """Numbers of a scene by all parts of the package: rows of part, output and number."""
    scene, solution = pulsed.scene, pulsed.scene.solve(1)
    for name in names:
        for end, value in zip(ENDS, ks.extremes(solution, name).range, strict=True):
            if f"{end} {name}" in outputs:
                yield "extremes", f"{end} {name}", value
    path, column, mass = pulsed.mass
    row = ks.sweep(scene, pd.DataFrame({column: [mass]}), outputs, progress=False).iloc[0]
    assert row["failed"] == ""
    spread = {path: f"{mass!r}..{float(np.nextafter(mass, np.inf))!r} kg"}
    few = outputs[1::2]
    quantiles = ks.tolerances(scene, few, spread, count=2, progress=False).quantiles([0.5]).iloc[0]
    for part, asked, numbers in (("sweep", outputs, row.iloc[1:-1]), ("tolerances", few, quantiles)):
        yield from ((part, output, number) for output, number in zip(asked, numbers, strict=True))
    compared = ks.compare(solution, solution)
    yield "compare", f"mean_absolute {TORQUE}", compared.mean_torques[0]
    yield "compare", "largest O", compared.peak_reactions("O")[0]
    yield "flywheel", f"swing {TORQUE}", ks.drive.flywheel(scene, 0.02).energy
    if pulsed.kind == "cam":
        yield "contact", "largest contact_pressure", ks.design.contact(solution).largest_pressure.value


def disagreements(seed, count=40_000):
    """Errors of numbers against the dense evaluation where they exceed the agreement, by part and output."""
    pulsed = PulsedScene(seed)
    dense = Dense(pulsed.scene.solve(1), pulsed.edges, count)
    names = (TORQUE, "O", "contact_pressure" if pulsed.kind == "cam" else "shaking_force")
    true, sizes = {}, {}
    for name in names:
        ends = dense.ends(lambda at, name=name: component_sizes(at, name)[0])
        true |= {f"{end} {name}": value for end, value in zip(ENDS, ends, strict=True)}
        sizes[name] = max(map(abs, ends))
    true |= dict(zip((f"{mean} {TORQUE}" for mean in MEANS), dense.means(lambda at: at.balancing_torque), strict=True))
    true.pop("smallest contact_pressure", None)  # 0 where the roller changes sides, as the root of a force near 0
    wrong = {}
    for part, output, number in figures(pulsed, names, list(true)):
        size = true[output] if part == "flywheel" else sizes[output.split()[1]]
        error = (number - true[output]) / size
        if not abs(error) <= AGREEMENT:
            wrong[part, output] = float(error)
    return wrong


@pytest.mark.slow
def test_all_parts_agree():
    assert disagreements(12) == {}


@pytest.mark.slow
@every("seed", [2, 6, *range(0, 200, 9)])  # all 200 take six minutes
def test_all_parts_agree_on_many_scenes(seed):
    assert disagreements(seed) == {}
