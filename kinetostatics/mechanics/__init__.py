"""What it does: motion, forces, where it can be assembled, principal points, quantities and their units.

May import errors, numbers, machine.
"""
