"""Many inputs in one test, which names all that fail: to collect a test for each costs more than to run it."""

import inspect
import reprlib
import signal
from contextlib import contextmanager
from functools import wraps
from itertools import product

import pytest

WAITING = 15
"""How much longer a test may take that waits, for others on the machine or for something that never comes."""
SHORT = reprlib.Repr()
SHORT.maxother = SHORT.maxstring = 60
_allowed = 0.0


def every(names, values, ids=None):
    """As ``pytest.mark.parametrize``, within one test: it fails once, and names each input that did and why.

    Decorators below one another give all combinations. Fixtures are those of the one test; the time to which it is
    `limited` begins anew with each input.
    """
    names = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
    rows = [[value] if len(names) == 1 else list(value) for value in values]
    labels = [ids(value) for value in values] if callable(ids) else ids and list(ids)
    axis = [
        (str(labels[place]) if labels else "-".join(map(_label, row)), dict(zip(names, row, strict=True)))
        for place, row in enumerate(rows)
    ]
    if not axis:
        raise ValueError(f"there are no inputs {', '.join(names)}")

    def taking(test):
        function, axes = getattr(test, "inputs", (test, []))
        return _of_all(function, [axis, *axes])

    return taking


def quick(rows, count):
    """Rows of ``pytest.mark.parametrize``; those after the first `count` are slow tests."""
    rows = list(rows)
    slow = (pytest.param(*(row if isinstance(row, tuple) else (row,)), marks=pytest.mark.slow) for row in rows[count:])
    return [*rows[:count], *slow]


def each(error, *rows):
    """Rows (error, call, input, words) of rows (call, inputs, words), for tests of refusals by `every`."""
    return [(error, call, given, words) for call, inputs, words in rows for given in inputs]


def told(error, call, *rows):
    """Rows (error, call, input, words) of one call and rows (input, words)."""
    return [(error, call, given, words) for given, words in rows]


def _of_all(function, axes):
    signature = inspect.signature(function)
    given = {name for axis in axes for name in axis[0][1]}

    @wraps(function)
    def test(**fixtures):
        failed, skipped, count = {}, [], 0
        for row in product(*axes):
            count += 1
            _begin_clock()
            try:
                function(**fixtures, **{name: value for _, values in row for name, value in values.items()})
            except pytest.skip.Exception as skip:
                skipped.append(skip)
            except (Exception, pytest.fail.Exception) as error:
                failed["-".join(label for label, _ in row)] = error
        if failed:
            told = "\n".join(f"{label}: {_told(error)}" for label, error in failed.items())
            first = next(iter(failed.values()))
            raise AssertionError(f"{len(failed)} of {count} inputs fail; the first is traced above\n{told}") from first
        if len(skipped) == count:
            raise skipped[0]
        assert not skipped, "an input is skipped but not all: leave it out where they are listed"

    own = [parameter for name, parameter in signature.parameters.items() if name not in given]
    test.__signature__ = signature.replace(parameters=own)
    test.inputs = function, axes
    return test


@contextmanager
def limited(seconds):
    """Stops a test, or an input of it, once, with a `TimeoutError`.

    After so many seconds of this process at work, or as much longer as `WAITING` on a busy machine.
    """
    global _allowed

    def late(*_):
        raise TimeoutError(f"took more than {seconds} s")

    before = {alarm: signal.signal(alarm, late) for alarm in (signal.SIGPROF, signal.SIGALRM)}
    _allowed = seconds
    _begin_clock()
    try:
        yield
    finally:
        _allowed = 0.0
        _begin_clock()
        for alarm, handler in before.items():
            signal.signal(alarm, handler)


def _begin_clock():
    signal.setitimer(signal.ITIMER_PROF, _allowed)
    signal.setitimer(signal.ITIMER_REAL, WAITING * _allowed)


def _label(value):
    if isinstance(value, str):
        return value if len(value) < 60 else SHORT.repr(value)
    if inspect.isfunction(value):
        return f"{value.__name__} of line {value.__code__.co_firstlineno}"
    return " ".join((value.__name__ if isinstance(value, type) else SHORT.repr(value)).split())


def _told(error):
    return f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
