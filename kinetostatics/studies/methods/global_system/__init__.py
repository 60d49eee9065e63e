"""The global system: all coordinates and all constraints at once, by Newton iteration or integration.

May import the rooms above `studies` and `studies.methods.method`.
"""
