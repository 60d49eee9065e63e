"""Case files with designs to be found."""

from kinetostatics.casefile.case import shipped_cases

STIFFER = """
[design.stiffer]
kind = "optimum"
variant = "cam-circle"
maximise = "ratio mean_absolute balancing_torque"
vary = { "spring.stiffness" = ["600 kN/m", "900 kN/m"] }
angles = 72
"""
FRONT = """
[design.trade]
kind = "front"
variant = "cam-circle"
minimise = ["largest_absolute cam_force", "-ratio mean_absolute balancing_torque"]
vary = { "spring.stiffness" = ["600 kN/m", "900 kN/m"], "cam.centre.x" = ["-30 mm", "-10 mm"] }
points = 2
angles = 72
"""
SAW = shipped_cases()["sawframe_2r63"].read_text(encoding="utf-8").partition("[tolerances]")[0]


def saw_with(text, folder):
    """Path of the saw's case file with more at its end."""
    path = folder / "saw.toml"
    path.write_text(f"{SAW}\n{text}", encoding="utf-8")
    return path
