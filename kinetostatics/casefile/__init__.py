"""Case files: their schema, reading them, and the machines they describe.

May import errors, numbers to studies.
"""
