"""Scenes taken apart: the structure, and the leaves that it has."""

import kinetostatics as ks
from kinetostatics.numbers.leaves import Leaves
from kinetostatics.numbers.structures import taken_apart


def parts(item):
    """Structure and leaves of an item."""
    leaves = Leaves()
    return taken_apart(item, leaves), leaves


def saw(mass=600.0, length=2.0, inertia=0.0):
    """A plain sawframe."""
    return ks.crank_slider(0.3, length, slider=ks.Link(mass, inertia=inertia))
