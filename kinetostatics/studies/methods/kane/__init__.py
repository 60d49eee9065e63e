"""Kane's method: equations of motion and forces by generalised speeds.

May import the rooms above `studies` and `studies.methods.method`.
"""
