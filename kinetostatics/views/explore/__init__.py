"""Explore: the mechanism under the hand, in a browser page or a notebook."""
