"""What it is: links, guide, cams, crank, groups, loads, the mechanism made of them, and its builders.

May import errors, numbers.
"""
