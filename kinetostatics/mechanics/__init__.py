"""Mechanics of a machine: motion, forces, friction, assembly, principal points, quantities and units.

May import errors, numbers, machine.
"""
