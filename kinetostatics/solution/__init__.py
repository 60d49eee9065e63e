"""Solutions for users: the scene, its solution, compiled programs, uncertainty of results.

May import errors, numbers to explain.
"""
