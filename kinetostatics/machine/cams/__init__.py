"""Cams: shapes given by functions, laws or samples, their rollers, working profiles and files for the workshop.

May import numbers and `machine.laws`.
"""
