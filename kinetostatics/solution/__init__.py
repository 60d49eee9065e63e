"""What users hold: the scene, its solution, `solve` and `compile`.

May import all rooms above: numbers to results.
"""
