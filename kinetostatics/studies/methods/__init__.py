"""Methods under study: other ways to the same results, to measure the library's own against them.

May import the rooms above `studies`; no calculation of the library calls them.
"""
