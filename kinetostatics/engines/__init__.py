"""How fast and how sure: kernels recorded once a structure, run as NumPy lines or compiled loops; derivatives.

May import errors, numbers, machine, mechanics.
"""
