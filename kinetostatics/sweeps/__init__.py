"""Many designs: tables of designs, the sweep, its workers and datasets, tolerances.

May import all rooms above: numbers to design.
"""
