"""Studies of models and methods: needs, precision, stability; they return data.

May import errors, numbers to sweeps.
"""
