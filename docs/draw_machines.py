"""The pictures of machines/index.md, a sketch of each machine: python docs/draw_machines.py [NAME ...].

Without names all are drawn, into docs/machines/pictures.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from pictures import as_svg, look

import kinetostatics as ks

FOLDER = Path(__file__).parent / "machines" / "pictures"
SIZE = (2.6, 1.7)
"""Inches."""
CASES = {
    "press": ("compressor", "loaded", 60),
    "sprung_saw": ("sawframe_2r63", "cam-circle", 50),
    "mower": ("mower_drive", "partial-1", 60),
    "mower_drives": ("mower_drives", "planetary", 40),
    "four_bar": ("chain_unit", "r75-fast-chains", 60),
    "shaper": ("shaper", "idle", 30),
    "scotch_yoke": ("yoke_pump", "idle", 50),
    "engines": ("v_twin", "plain", 70),
    "balance_shafts": ("sawframe_2r63_ways", "cam-shafts", 50),
    "chains": ("toggle_press", "idle", 90),
    "ten_machines": ("pumpjack", "weights", 40),
}
"""Case, variant and crank angle, degrees, by the name of the page."""


def machines():
    """Machine and crank angle, degrees, by the name of the page, in the order of the list of pages."""
    cylinder = ks.Mechanism("swinging cylinder", ks.Crank(0.06), (ks.CylinderGroup((0.22, -0.03)),))
    law = ks.laws.joined(
        ks.laws.cycloidal(0.06, 0.08, np.pi / 2), ks.laws.cycloidal(0.08, 0.06, np.pi / 2), ks.laws.dwell(0.06, np.pi)
    )
    roller = ks.RollerFollower(law, ks.Guide.at(0.0), roller=ks.Roller(0.012, 0.02, 210e9, 0.3))
    cam = ks.Scene(ks.Mechanism("disk cam", ks.Crank(None), (roller,)), 1.0, loads=ks.Spring(9e3, 0.03, on="follower"))
    built = {"swinging_cylinder": (cylinder, 60), "disk_cams": (cam, 60)}
    cases = {name: (ks.load_case(case).variants[variant], angle) for name, (case, variant, angle) in CASES.items()}
    return cases | built


def drawn(name):
    """A picture as SVG."""
    machine, angle = machines()[name]
    with look(name, SIZE):
        ks.plots.sketch(machine, dimensions=False, angle=angle, ax=plt.figure().subplots())
        svg = as_svg(plt.gcf())
        plt.close("all")
    return svg


if __name__ == "__main__":
    for name in sys.argv[1:] or machines():
        (FOLDER / f"{name}.svg").write_text(drawn(name), encoding="utf-8")
