"""A first look at the plain numbers of a scene, recorded once for all of its kind: most need no closer one."""

from ..machine import hints
from . import writing
from .operations import PLAIN, made
from .record import recorded
from .trace import needed


def first_look(kind):
    """Function of the numbers of a scene: all lengths over the shortest, and whether hints may be due.

    None if it cannot be recorded.
    """
    outputs = []

    def noted(value):
        outputs.append(value)
        return f"v[{len(outputs) - 1}]"

    try:
        extent, reaches, bars, bodies, arms = hints.sizes(recorded(kind.structure).mechanism)
    except (TypeError, AttributeError):
        return None
    odd = [f"not extent < {hints.FAR} * longest"] if bars else []
    odd += [f"0.0 < {noted(inertia)} < thin * {noted(mass)}" for inertia, mass in bodies]
    odd += [f"abs({noted(gap)}) <= 1e-9 * {noted(length)}" for length, gap in arms]
    source = f"""def line(numbers):
    v = sizes(0.0, 0.0, 1.0, numbers, ())
    extent, longest = {noted(extent)}, max({", ".join([*map(noted, bars), "0.0", "0.0"])})
    thin = longest * longest / {12.0 * hints.THIN}
    return extent / min({", ".join([*map(noted, reaches), "inf", "inf"])}), {" or ".join(odd) or "False"}"""
    if any(node.operation == "table" for node in needed(outputs)):
        return None
    return made(source, PLAIN | {"sizes": made(writing.line(outputs), PLAIN)})
