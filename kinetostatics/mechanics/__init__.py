"""Mechanics of a scene: motion, forces, friction, assembly, principal points, quantities and their units.

May import errors, numbers, machine.
"""
