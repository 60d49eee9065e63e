"""Friction of random mechanisms of every kind against both independent full systems.

    python tests/references/compare_rubbing_systems.py [mechanisms] [scale of the coefficients]

Prints the largest relative difference of any force, friction, loss or torque, by kind and system.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from support import multipliers
from support.rubbing_machines import KINDS, by_newton, differences


def main(count=200, scale=1.0):
    begun, worst = time.perf_counter(), {}
    for number in range(count):
        kind, seed = KINDS[number % len(KINDS)], 1000 + number // len(KINDS)
        for solver in (by_newton, multipliers.solved):
            found, _ = differences(kind, seed, scale, solver=solver)
            key = kind, "Newton" if solver is by_newton else "multipliers"
            worst[key] = max(worst.get(key, 0.0), found)
    for (kind, system), found in sorted(worst.items()):
        print(f"{kind:15s} {system:12s} {found:.2g}")
    print(f"{count} mechanisms, largest difference {max(worst.values()):.2g}, {time.perf_counter() - begun:.0f} s")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *map(float, sys.argv[2:3]))
