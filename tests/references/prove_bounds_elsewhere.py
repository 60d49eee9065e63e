"""Bounds on the errors of single precision and of JAX beside true errors, on random machines.

    python tests/references/prove_bounds_elsewhere.py [values]

Prints by family and engine how many values were compared, how many had no bound, the largest share of its bound that an
error was, and every value that was off by more than its bound.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from kinetostatics.engines.backends import Backend
from support.bounded import FAMILIES, solution
from support.elsewhere import errors, exact_values

NUMPY, JAX = Backend("numpy", "single"), (Backend("jax", "single"), Backend("jax", "double"))
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


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
