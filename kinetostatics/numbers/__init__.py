"""Numbers: elementary functions, planar vectors, parameter trees, checks, units, formats and files.

May import errors.
"""
