"""Structural groups: slider, rocker, lever, yoke, dyad and cylinder, with their change points and dead centres.

May import numbers and the modules of `machine` that describe links, guides and the crank.
"""
