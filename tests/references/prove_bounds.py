"""Bounds on rounding errors beside true errors, by the kernels on arb numbers of 200 bits, on random machines.

    python tests/references/prove_bounds.py [values] [numpy, compiled, tight or tight-compiled] [first seed]

Each component of each quantity at each crank angle is a value. Every structure is recorded once and run with several
sets of numbers at many angles; compiled, only so many structures that compiling does not take all the time. Prints by
family how many values were compared, how many had no bound, the largest share of its bound that an error was, and
every value that was off by more than its bound.
"""

import sys
import time
from contextlib import suppress
from itertools import chain, count, cycle, islice
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from kinetostatics.errors import KinetostaticsError
from support.bounded import AT_PLACES, FAMILIES, errors, other_numbers, solution

ANGLES = 40
SETS = 12
"""Sets of numbers that a structure runs with at a time."""
COMPILED = 2
"""Structures of a family that are compiled, for their torque and reactions."""
NAMES = {
    "numpy": lambda made: None,
    "compiled": lambda made: ("balancing_torque", *made.reactions),
    "tight": lambda made: ("balancing_torque", "shaking_moment", "O"),
    "tight-compiled": lambda made: ("balancing_torque", "O"),
}
"""Quantities compared; None is all there are."""


def solutions(family, kind, first):
    """Solutions of a family without end from a seed on, each structure with several sets of numbers."""
    bases = (base for seed in count(first) if (base := solution(family, seed, ANGLES)) is not None)
    numbers, few = count(first), []
    if "compiled" in kind and family not in AT_PLACES:  # places have few structures, and exact numbers
        few = list(islice(bases, COMPILED))
        yield from few
        sets = cycle(few)
    else:
        sets = chain.from_iterable([base] * SETS for base in bases)
    last = None
    for base in sets:
        with suppress(KinetostaticsError):
            made = base if last is not base and not few else other_numbers(base, next(numbers))
            last = base
            yield made


def main(most=1_000_000, kind="numpy", first=0):
    begun, totals = time.perf_counter(), {family: [0, 0, 0, 0.0] for family in FAMILIES}
    every = {family: solutions(family, kind, first) for family in FAMILIES}
    skipped, told = 0, most // 10
    while sum(values for values, *_ in totals.values()) < most:
        family = min(totals, key=lambda family: totals[family][0])
        try:
            made = next(every[family])
            found = errors(made, NAMES[kind](made), "compiled" if "compiled" in kind else "numpy", "tight" in kind)
        except KinetostaticsError as refusal:
            skipped += 1
            if skipped < 10:
                print("skipped", family, refusal)
            continue
        total = totals[family]
        total[0] += found.values
        total[1] += found.unbounded
        total[2] += len(found.wrong)
        total[3] = max(total[3], found.share)
        for wrong in found.wrong:
            print("WRONG", family, *wrong, flush=True)
        if sum(values for values, *_ in totals.values()) >= told:
            told += most // 10
            show(totals, skipped, begun)
    show(totals, skipped, begun)


def show(totals, skipped, begun):
    for family, (values, unbounded, wrong, share) in totals.items():
        print(
            f"{family:10s} {values:9d} values, {unbounded:6d} without a bound, {wrong} wrong, largest share {share:.3f}"
        )
    print(f"{skipped} skipped, {time.perf_counter() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *sys.argv[2:3], *map(int, sys.argv[3:4]))
