"""Ctrl-C and SIGTERM, deferred while code runs that would lose them."""

import signal
import threading
from contextlib import contextmanager


@contextmanager
def deferred():
    """SIGINT and SIGTERM take effect when the block ends, not inside it.

    Python raises `KeyboardInterrupt` wherever it stands. In a callback from C (LLVM makes some) or in ``__del__`` an
    exception is printed and lost, and the program goes on. Signals without a handler in Python stay as they are, and
    so does everything in threads besides the main one, which receive no signals.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    pending: dict[signal.Signals, None] = {}
    handlers = {
        number: handler for number in (signal.SIGINT, signal.SIGTERM) if callable(handler := signal.getsignal(number))
    }
    for number in handlers:
        signal.signal(number, lambda number, _: pending.setdefault(signal.Signals(number)))
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number in pending:
            signal.raise_signal(number)
