"""Speed and accuracy: kernels recorded by structure and compiled, derivatives, rounding-error bounds.

May import errors, numbers, machine, mechanics.
"""
