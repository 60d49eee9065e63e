"""Bounds on the errors of single precision and of JAX beside true errors, on random machines.

    python tests/references/prove_bounds_elsewhere.py [values]
    python tests/references/prove_bounds_elsewhere.py shipped

Prints by family and engine how many values were compared, how many had no bound, the largest share of its bound that an
error was, and every value that was off by more than its bound. Of shipped cases every quantity in single precision is
put beside that in double, whose own bound is added.
"""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

import kinetostatics as ks
from kinetostatics.engines.jax_backend import Backend
from kinetostatics.engines.program import program_of
from kinetostatics.mechanics.quantities import of_scene
from support.bounded import FAMILIES, solution
from support.elsewhere import errors, exact_values

NUMPY, DOUBLE, JAX = Backend("numpy", "single"), Backend("numpy"), (Backend("jax", "single"), Backend("jax", "double"))
EACH = 5
"""Of so many machines one is run by JAX, which compiles each anew; loops give the bits of NumPy, as a test shows."""


def main(count=10_000):
    begun, totals, seed = time.perf_counter(), {}, 0
    while sum(found[0] for found in totals.values()) < count:
        for family in FAMILIES:
            made = solution(family, seed)
            if made is None:
                continue
            for backend, found in errors(made, exact_values(made), (NUMPY, *(() if seed % EACH else JAX))).items():
                total = totals.setdefault((family, backend), [0, 0, 0, 0.0])
                for place in range(2):
                    total[place] += (found.values, found.unbounded)[place]
                total[2] += len(found.wrong)
                total[3] = max(total[3], found.share)
                for wrong in found.wrong:
                    print("WRONG", family, seed, backend.engine, backend.precision, *wrong)
        seed += 1
    for (family, backend), (values, unbounded, wrong, share) in totals.items():
        print(
            f"{family:9s} {backend.engine:6s} {backend.precision:6s} {values:9d} values, {unbounded:6d} without a "
            f"bound, {wrong} wrong, largest share {share:.3f}"
        )
    print(f"{seed} seeds, {time.perf_counter() - begun:.0f} s")


def shipped():
    angles = np.linspace(0.013, 2 * np.pi, 360)
    for name in ks.shipped_cases():
        for variant, made in ks.load_case(name).variants.items():
            s = made.scene.solve(angles, on_gap="nan")
            program, leaves = program_of(s.dynamics, tuple(of_scene(s)))
            exact, own = (backend.run(program, s.dynamics, leaves) for backend in (DOUBLE, NUMPY))
            finer, bound = (backend.bounds(program, s.dynamics, leaves) for backend in (DOUBLE, NUMPY))
            given, error = np.isfinite(exact), np.abs(own - exact)
            wrong, unbounded = given & ~(error <= bound + finer), given & np.isinf(bound)
            print(f"{name} {variant}: {given.sum()} values, {unbounded.sum()} without a bound, {wrong.sum()} wrong")


if __name__ == "__main__":
    shipped() if sys.argv[1:] == ["shipped"] else main(*map(int, sys.argv[1:2]))
