"""Worst proven bound of a turn over its worst error, of torque and every reaction of every shipped case.

    python tests/references/ratios_of_bounds.py [even crank angles a turn] [angles between two kinks of a table]

Errors are against arb numbers of 200 bits; bounds and errors of vectors are magnitudes. Of each quantity: its largest
error over its largest value, the plain bound over that error, the tight one over it.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import kinetostatics as ks
from support.enclosed import ordinary_angles, worst


def main(even=3600, between=40):
    most = [0.0, 0.0]
    for case in ks.shipped_cases():
        for variant, made in ks.load_case(case).variants.items():
            angles = ordinary_angles(made.scene, even, between)
            print(f"{case} {variant}: {angles.size} angles")
            for name, found in worst(made.scene.solve(angles, on_gap="nan")).items():
                plain, tight = found.plain / found.error, found.tight / found.error
                most = [max(most[0], plain), max(most[1], tight)]
                print(f"    {name:18s} error {found.error / found.size:7.1e}  plain {plain:6.1f}  tight {tight:5.1f}")
    print(f"largest: plain {most[0]:.1f}, tight {most[1]:.1f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
