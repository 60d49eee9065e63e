"""A first look at the plain numbers of a scene, recorded once for all of its kind: most need no closer one."""

from ..machine import hints
from ..machine.links import present
from ..numbers.checks.usual import FAR
from .codegen import line_source
from .graph import needed
from .operations import PLAIN, compile_line
from .record import recorded_scene


def plausibility_test(kind, judged=()):
    """Function of the numbers of a scene: all lengths over the shortest, and whether hints may be due.

    None if it cannot be recorded. What is usual of some of its numbers is `judged`, pairs of leaf and `checks.Usual`.
    """
    outputs = []

    def noted(value):
        outputs.append(value)
        return f"v[{len(outputs) - 1}]"

    try:
        scene = recorded_scene(kind.structure)
        extent, reaches, bars, bodies, turning, arms = hints.sizes(scene.mechanism)
    except (TypeError, AttributeError):
        return None
    odd = [_unusual(f"numbers[{leaf}]", usual) for leaf, usual in judged if bars or not usual.in_links]
    odd += [f"not extent < {FAR} * longest"] if bars else []
    odd += [f"longest > {hints.LONGEST}", f"longest > {hints.SLENDER} * shortest"] if bars else []
    odd += [f"{noted(inertia)} > {hints.THICK} * {noted(mass)} * {noted(long)} ** 2" for inertia, mass, long in turning]
    if present(scene.crank_speed) is not None and scene.mechanism.crank.length is not None:
        odd += [f"abs({noted(scene.crank_speed)}) * {noted(scene.mechanism.crank.length)} > {hints.FASTEST}"]
    odd += [f"0.0 < {noted(inertia)} < thin * {noted(mass)}" for inertia, mass in bodies]
    odd += ["True" for _ in hints.beside_rods(scene.mechanism, scene.loads)]
    odd += [f"abs({noted(gap)}) <= 1e-9 * {noted(length)}" for length, gap in arms]
    source = f"""def line(numbers):
    v = sizes(0.0, 0.0, 1.0, numbers, ())
    extent, longest = {noted(extent)}, max({", ".join([*map(noted, bars), "0.0", "0.0"])})
    shortest = min({", ".join([*map(noted, reaches), "inf", "inf"])})
    thin = longest * longest / {12.0 * hints.THIN}
    return extent / shortest, {" or ".join(odd) or "False"}"""
    if any(node.operation == "table" for node in needed(outputs)):
        return None
    return compile_line(source, PLAIN | {"sizes": compile_line(line_source(outputs), PLAIN)})


def _unusual(number, usual):
    """Condition, as a source, under which a number is none that is usual."""
    most, least = (f"{limit!r}{' * longest' * usual.in_links}" for limit in (usual.most, usual.least))
    too_large = f"not -{most} <= {number} <= {most}"
    return f"{too_large} or abs({number}) < {least}" if usual.least else too_large
