"""Better machines: counterweights, four-bars, cams without drive torque, optimisation under limits.

May import errors, numbers to drive.
"""


def __getattr__(name):
    """A public name, loaded on first use; `__init__.pyi` lists them."""
    from ..numbers.lazy import public_name

    return public_name(__name__, name)


def __dir__():
    return __getattr__("__all__")
