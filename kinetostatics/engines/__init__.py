"""How fast and how sure: kernels recorded once a structure, run by NumPy, numba or JAX; derivatives, bounds on errors.

May import errors, numbers, machine, mechanics.
"""
