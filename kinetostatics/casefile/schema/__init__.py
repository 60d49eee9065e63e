"""Schema of case files as pydantic models: keys, units, allowed values.

May import numbers, and the classes of `machine`, `drive` and `design` that its tables describe.
"""
