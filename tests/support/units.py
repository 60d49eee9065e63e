"""A registry of pint's own units, made once: to read its definitions takes half a second."""

import pint

UNITS = pint.UnitRegistry()
