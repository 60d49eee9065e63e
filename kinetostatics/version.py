"""The version of the library, for the package and the files it writes."""

__version__ = "0.2.0"
