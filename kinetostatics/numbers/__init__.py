"""What every calculation is made of: elementary functions, planar vectors, parameter trees, checks, units, files.

May import errors.
"""
