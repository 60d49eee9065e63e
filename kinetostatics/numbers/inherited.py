"""What a class may still say when it derives from another: two attributes that say the same belong to one class."""


def say_together(kind, name, *others):
    """Whether the class that last gives one of `others` to a kind gives `name` beside them.

    One that is derived from it, and gives only the others anew, makes what `name` says of them untrue.

    >>> class Spring:
    ...     def push(self): ...
    ...     def rate(self): ...
    >>> class Stop(Spring):
    ...     def push(self): ...
    >>> say_together(Spring, "rate", "push"), say_together(Stop, "rate", "push")
    (True, False)
    """
    giving = (vars(one) for one in kind.__mro__ if not vars(one).keys().isdisjoint(others))
    return name in next(giving, ())
