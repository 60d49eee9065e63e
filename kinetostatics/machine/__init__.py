"""What the machine is: links, guides, crank, groups, cams, loads, friction pairs, and mechanisms of them.

May import errors, numbers.
"""
