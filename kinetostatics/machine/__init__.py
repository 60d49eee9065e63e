"""Description of a machine: links, guides, crank, groups, cams, loads, friction pairs, and mechanisms of them.

May import errors, numbers.
"""
