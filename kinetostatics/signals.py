"""Ctrl-C and SIGTERM, deferred while code runs that would lose them."""

import signal
import threading
from contextlib import contextmanager


@contextmanager
def deferred():
    """SIGINT and SIGTERM take effect at the end of the block.

    Inside a callback from C (LLVM has some) or ``__del__`` Python prints and loses a `KeyboardInterrupt`, and the
    program goes on. Signals without a handler in Python, and threads other than the main one, are unchanged.
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
