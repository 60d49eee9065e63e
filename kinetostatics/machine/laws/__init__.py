"""Laws of motion of a follower: standard curves and segments joined to a period.

May import numbers.
"""
