"""Functions of the crank angle over a period: extremes, means, reductions, losses, comparison.

May import errors, numbers, machine, mechanics, engines.
"""
