"""Bounds on rounding errors beside true errors, by the kernels on arb numbers of 200 bits, on random machines.

    python tests/references/prove_bounds.py [values] [numpy or compiled]

Prints by family how many values were compared, how many had no bound, the largest share of its bound that an error was,
and every value that was off by more than its bound.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from support.bounded import FAMILIES, errors, solution


def main(count=1_000_000, engine="numpy"):
    begun, totals, seed = time.perf_counter(), {family: [0, 0, 0, 0.0] for family in FAMILIES}, 0
    while sum(values for values, *_ in totals.values()) < count:
        for family in FAMILIES:
            made = solution(family, seed, engine)
            if made is None:
                continue
            found = errors(made)
            total = totals[family]
            total[0] += found.values
            total[1] += found.unbounded
            total[2] += len(found.wrong)
            total[3] = max(total[3], found.share)
            for wrong in found.wrong:
                print("WRONG", family, seed, *wrong)
        seed += 1
    for family, (values, unbounded, wrong, share) in totals.items():
        print(
            f"{family:10s} {values:9d} values, {unbounded:6d} without a bound, {wrong} wrong, largest share {share:.3f}"
        )
    print(f"{seed} seeds, {time.perf_counter() - begun:.0f} s")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *sys.argv[2:3])
