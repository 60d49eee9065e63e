"""What single precision buys: designs that share crank angles, on each engine, in both precisions.

Run by ``python -m pytest tests/benchmarks/test_single_precision.py --benchmark-only``. Engines take turns and least
times are compared.
"""

from time import perf_counter

import numpy as np
import pytest

import kinetostatics as ks

ANGLES = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
MASSES = {"slider.mass": np.linspace(500.0, 700.0, 1000)[:, None]}
ROUNDS = 15
MOST = 0.9
"""Of the time in double precision, compiled."""


@pytest.mark.parametrize("variant", ["plain", "cam-cosine"])
def test_single_precision_takes_less_time_than_double(benchmark, tell, variant):
    for name in ("numba", "jax"):
        pytest.importorskip(name)
    scene = ks.load_case("sawframe_2r63").variants[variant].scene
    programs = {
        (engine, precision): ks.compile(scene, "balancing_torque", engine=engine, precision=precision)
        for engine in ("numpy", "compiled", "jax")
        for precision in ("double", "single")
    }
    times = dict.fromkeys(programs, np.inf)
    for program in programs.values():
        program(ANGLES, MASSES)
    for _ in range(ROUNDS):
        for key, program in programs.items():
            start = perf_counter()
            program(ANGLES, MASSES)
            times[key] = min(times[key], perf_counter() - start)
    benchmark.pedantic(programs["compiled", "single"], (ANGLES, MASSES), rounds=5)
    for (engine, precision), time in times.items():
        own = programs[engine, precision]
        bound = np.max(own.error_bound(ANGLES)["balancing_torque"]) / np.max(np.abs(own(ANGLES)["balancing_torque"]))
        each = 1e9 * time / (len(ANGLES) * 1000)
        tell(f"{variant}: {engine}, {precision}, {own.device}: {each:.2f} ns a value, bound {bound:.2g}")
        benchmark.extra_info[f"{engine}, {precision} [ns]"] = each
    assert times["compiled", "single"] < MOST * times["compiled", "double"]
