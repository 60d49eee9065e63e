"""Signals wait for the end of a block, and are delivered as their handlers say."""

import signal
import threading

import pytest

from kinetostatics.signals import deferred


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_takes_effect_when_the_block_ends(number):
    seen, done = [], []
    before = signal.signal(number, lambda *given: seen.append(given[0]))
    try:
        with deferred(), deferred():
            signal.raise_signal(number)
            signal.raise_signal(number)
            done.append(list(seen))
        assert (done, seen) == ([[]], [number])
        signal.raise_signal(number)
        assert seen == [number, number]
    finally:
        signal.signal(number, before)


def interrupted():
    with deferred():
        signal.raise_signal(signal.SIGINT)
        raise ValueError


def test_interruption_replaces_an_error():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            interrupted()
    finally:
        signal.signal(signal.SIGINT, before)


def test_other_threads_run_the_block_as_it_is():
    seen = []

    def work():
        with deferred():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGINT)]
