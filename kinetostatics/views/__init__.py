"""Pictures: plots of solutions, charts, drawings, figures of cases, reports.

May import errors, numbers to casefile.
"""
