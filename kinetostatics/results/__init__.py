"""What is read off values over the turn: extremes, means, reductions, comparison, tables.

May import errors, numbers, machine, mechanics, engines.
"""
