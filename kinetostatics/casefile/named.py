"""What a case has by name, and the error of a name that it has not."""

from ..errors import CaseError
from ..numbers import checks
from ..numbers.texts import normal


class Named(dict):
    """Items of a case by name, whatever Unicode form that is written in.

    Attributes
    ----------
    kind : str
        What they are: "variant".
    path : Path
        Of the case.
    """

    def __init__(self, kind, path, items):
        super().__init__(items)
        self.kind, self.path = kind, path

    def __getitem__(self, name):
        return super().__getitem__(name) if isinstance(name, str) else self.__missing__(name)

    def __contains__(self, name):
        return isinstance(name, str) and super().__contains__(normal(name))

    def __missing__(self, name):
        if isinstance(name, str) and normal(name) != name:
            return self[normal(name)]
        raise NoSuchNameError(self.path, [checks.choice(self.kind, name, tuple(self))])


class NoSuchNameError(CaseError, KeyError):
    """A case has nothing of this name; those who look for a `KeyError` find it too."""

    __str__ = Exception.__str__
