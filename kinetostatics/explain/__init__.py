"""Hand calculations: the steps of a result at one crank angle, with names, symbols, numbers and units.

May import errors, numbers to results; `solution` shows these pages.
"""
