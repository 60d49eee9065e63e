"""Many designs: tables of designs, sweeps, workers, datasets, tolerances.

May import errors, numbers to sizing.
"""
