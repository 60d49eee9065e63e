"""References to many digits: interval enclosures, independent formulas and exact running.

May import the rooms above `studies`, and other modules of `studies.methods`.
"""
