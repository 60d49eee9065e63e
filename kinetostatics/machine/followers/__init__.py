"""Followers of a cam on the crank: roller, flat-faced and swinging, as groups of the mechanism.

May import numbers, `machine.laws`, `machine.cams` and `machine.groups`.
"""
