"""Results to many digits: interval enclosures, closed forms and running to 30 digits and more.

May import the rooms above `studies` and `studies.methods.method`.
"""
