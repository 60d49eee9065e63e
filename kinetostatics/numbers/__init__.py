"""What every calculation is made of: elementary functions, planar vectors, leaves of parameter trees, checks, units, files.

May import errors.
"""
