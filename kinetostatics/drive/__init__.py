"""Machines under a motor: periodic running, flywheels, run-up and coast-down.

May import errors, numbers to solution.
"""


def __getattr__(name):
    """A public name, loaded on first use; `__init__.pyi` lists them."""
    from ..numbers.lazy import public_name

    return public_name(__name__, name)


def __dir__():
    return __getattr__("__all__")
