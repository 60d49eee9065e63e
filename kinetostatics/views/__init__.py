"""Pictures: plots of solutions, charts of studies, drawings, figures of cases.

May import all rooms above: numbers to casefile.
"""
