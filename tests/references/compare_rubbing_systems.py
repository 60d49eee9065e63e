"""Friction of random mechanisms of every kind against the independent equations of all bodies.

    python tests/references/compare_rubbing_systems.py [mechanisms] [scale of the coefficients]

Prints the largest relative difference of any force, friction, loss or torque, by kind.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from support.friction_machines import KINDS, differences


def main(count=200, scale=1.0):
    begun, worst = time.perf_counter(), {}
    for number in range(count):
        kind, seed = KINDS[number % len(KINDS)], 1000 + number // len(KINDS)
        worst[kind] = max(worst.get(kind, 0.0), differences(kind, seed, scale)[0])
    for kind, found in sorted(worst.items()):
        print(f"{kind:15s} {found:.2g}")
    print(f"{count} mechanisms, largest difference {max(worst.values()):.2g}, {time.perf_counter() - begun:.0f} s")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *map(float, sys.argv[2:3]))
