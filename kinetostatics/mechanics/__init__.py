"""What the machine does: motion, forces, friction, assembly, principal points, quantities and units.

May import errors, numbers, machine.
"""
