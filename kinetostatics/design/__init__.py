"""Better machines: static balancing, counterweights, four-bar classes.

May import all rooms above: numbers to solution.
"""
