"""Case files: what they may hold, how they are read, and the machines built of them.

May import all rooms above: numbers to studies.
"""
