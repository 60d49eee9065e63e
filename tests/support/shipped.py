"""Shipped cases, each read and balanced once for all tests of a process that only look at it."""

from functools import cache

import kinetostatics as ks

shipped = cache(ks.load_case)
