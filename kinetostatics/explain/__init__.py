"""Hand calculations: the steps of a result at one crank angle, with symbols, numbers and units.

May import errors, numbers to cycle.
"""
