"""Questions about methods and models: needs, precision, stability, and the methods under study; they return data.

May import all rooms above: numbers to sweeps.
"""
