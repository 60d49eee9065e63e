"""What fewer divisions and fused sums are worth: time of the compiled loop beside errors of torque and reactions.

    python tests/benchmarks/chart_of_rules.py

For some structures, with the arithmetic as the kernels have it and with reciprocals shared (`SimplifiedGraph`), each
with every operation rounded and with fused sums: operations at each crank angle, ns an angle over 64 designs that
share crank angles, least of many calls in turns, and the largest error at 36 angles beside arb of 200 bits, relative to
the quantity's largest, in 1e-16.
"""

import sys
from itertools import product
from pathlib import Path
from time import perf_counter

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

import kinetostatics as ks
from kinetostatics.engines import numba_backend, record
from kinetostatics.engines.codegen import loop_source
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.program import Program
from kinetostatics.engines.simplify import SimplifiedGraph
from kinetostatics.studies.methods.enclosures import enclosure

STRUCTURES = (
    ("sawframe_2r63", "plain"),
    ("sawframe_2r63", "cam-circle"),
    ("sawframe_2r63", "cam-cosine"),
    ("chain_unit", "rho-0.5"),
    ("mower_drive", "full"),
    ("toggle_press", "idle"),
)
DESIGNS, ANGLES = 64, 360


def main():
    for case, variant in STRUCTURES:
        scene = ks.load_case(case).variants[variant].scene
        few = scene.solve(scene.period * (np.arange(36) + 0.06) / 36)
        names = "balancing_torque", *few.reactions
        exact = [row for name in names for row in enclosure(few, name).exact]
        rivals = []
        for graph, fuse in product((Graph, SimplifiedGraph), (False, True)):
            record.LeanGraph = graph
            made = Program(record.record(few.dynamics.apart[0], names))
            made.loop = numba_backend.load_compiled(loop_source(made.outputs, fuse)).loop
            rivals.append((made, fuse, *of_turn(made, scene)))
        times = least([run for *_, run in rivals]) / (DESIGNS * ANGLES) * 1e9
        for (made, fuse, lean, _), spent in zip(rivals, times, strict=True):
            error = largest_error(made, few, exact)
            ways = f"{'reciprocals' if lean else 'as written':11s} {'fused' if fuse else 'rounded':7s}"
            print(f"{case:14s} {variant:10s} {ways} {made.recording.operations:4d} {spent:6.2f} ns {error:6.1f}")


def of_turn(made, scene):
    """Whether reciprocals are shared, and a function that runs designs with crank angles in common."""
    state = scene.solve(ANGLES).dynamics
    leaves, angle = state.apart[1], np.array(state.crank_angle, ndmin=2)
    parameters = np.repeat(numba_backend.parameter_table(leaves.numbers, ()), DESIGNS, axis=0)
    rows = numba_backend.row_table(made.rows(state, leaves), state.shape)
    results = np.empty((DESIGNS, len(made.outputs), ANGLES))
    given = (angle, *numba_backend.compiled_sines(angle), parameters, rows, results)
    return isinstance(made.recording.graph, SimplifiedGraph), lambda: made.loop(*given)


def least(rivals):
    best = np.full(len(rivals), np.inf)
    for _, (place, rival) in product(range(300), enumerate(rivals)):
        start = perf_counter()
        rival()
        best[place] = min(best[place], perf_counter() - start)
    return best


def largest_error(made, solution, exact):
    from flint import arb

    found = made.run(solution.dynamics, solution.dynamics.apart[1], compiled=True)
    size = np.abs(found).max(axis=1)
    errors = [
        max(abs(float(truth - arb(value))) for truth, value in zip(row, values, strict=True))
        for row, values in zip(exact, found.tolist(), strict=True)
    ]
    return max(error / whole for error, whole in zip(errors, size, strict=True) if whole > 1e-9 * size.max()) * 1e16


if __name__ == "__main__":
    main()
