"""The version of the library, for the package and what it writes."""

__version__ = "0.2.0"
