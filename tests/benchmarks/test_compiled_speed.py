"""How fast compiled: the sawframe, all reactions and torque, in one call and in sweeps, against C, SymPy and Dask.

Run by ``python -m pytest tests/benchmarks --benchmark-only``. Rivals take turns within one run and least times are
compared, so that a machine that has other work now and then spoils neither ratios nor limits; limits are those of the
plain sawframe's requirement, figures are printed and kept in the benchmark's `extra_info`.
"""

import ctypes
import shutil
import subprocess
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.engines.program import program_of
from kinetostatics.studies.methods.kane import equations
from support.case_files import shipped
from support.speed import (
    CENTRE,
    COUPLER,
    COUPLER_INERTIA,
    COUPLER_MASS,
    CRANK,
    GRAVITY,
    SLIDER_MASS,
    SPEED,
    assert_same,
    run,
    seconds,
    turn,
)

SAW = shipped("sawframe_2r63")
FORCES = ("O", "A", "B", "guide_force", "guide_moment", "balancing_torque")
CAM_FORCES = (*FORCES, "cam_force", "slot_force")
NONE = np.empty((0, 1, 360))
BLOCK = 64
"""Designs whose results, 1.5 MB, do not leave the cache."""
DESIGN = np.array([SPEED, CRANK, COUPLER, CENTRE, COUPLER_MASS, COUPLER_INERTIA, SLIDER_MASS, GRAVITY])
"""The plain sawframe as the C program takes it."""
VARIED = {
    "plain": {"crank_length": "0.25..0.35 m", "slider.mass": "500..700 kg"},
    "cam-circle": {"spring.stiffness": "600..900 kN/m", "cam.centre.x": "-30..-10 mm"},
    "cam-cosine": {"spring.stiffness": "600..900 kN/m", "slider.mass": "500..700 kg"},
}
OUTPUTS = ("largest O", "mean_absolute balancing_torque", "range guide_force")
MANY = 100_000

pytestmark = pytest.mark.skipif(not numba_backend.numba_available(), reason="numba is not installed (extra: fast)")


@pytest.fixture
def one_core(monkeypatch):
    """One core, and sines computed in each call, as C does, though the crank angles are those of the last."""
    monkeypatch.setattr(numba_backend, "core_count", lambda: 1)
    monkeypatch.setattr(numba_backend, "compiled_sines", numba_backend.compiled_sines.__wrapped__)


@pytest.fixture(scope="module")
def c(tmp_path_factory):
    """The C program as a library, each division where it stands, and with them taken together; products fused."""
    gcc = shutil.which("gcc")
    if gcc is None:
        pytest.skip("gcc is not installed")

    def library(*options):
        source, built = Path(__file__).parent / "crank_slider.c", tmp_path_factory.mktemp("c") / "crank_slider.so"
        # without the second option a root's error number keeps gcc from vectorising
        options = ["-O3", "-fno-math-errno", "-march=native", "-fPIC", "-shared", *options]
        subprocess.run([gcc, *options, source, "-o", built, "-lm"], check=True)
        return ctypes.CDLL(str(built))

    return library(), library("-DRECIPROCAL")


def called(function, *arguments):
    """Function that calls one of C with arrays and numbers."""
    given = [
        ctypes.c_void_p(item.ctypes.data) if isinstance(item, np.ndarray) else ctypes.c_long(item) for item in arguments
    ]
    return partial(function, *given)


def of_cam(numbers):
    """A design with a circular cam as the C program takes it, (design, balance), from those of its program."""
    radius, offset, coupler, mass, centre, inertia, slider, speed, gravity, _, stiffness, free = numbers
    return [speed, radius, coupler, centre, mass, inertia, slider, gravity], [radius, offset, stiffness, free]


def program(variant, forces=FORCES):
    """Program of a variant, and its numbers."""
    made, leaves = program_of(SAW.solve(variant, 8).dynamics, tuple(forces))
    return made, leaves.numbers


def one_design(angles):
    """Function that computes the plain variant, (outputs, N)."""
    made, numbers = program("plain")
    return partial(made.by_loop, angles, numbers, [], angles.shape)


def shared(made, numbers, designs=BLOCK):
    """Function that computes designs with crank angles in common, and the sines and cosines it takes."""
    angle = turn(360)[None].copy()
    sine, cosine = numba_backend.compiled_sines(angle)
    parameters = np.repeat(numba_backend.parameter_table(numbers, ()), designs, axis=0)

    def run():
        results = np.empty((designs, len(made.outputs), 360))
        numba_backend.run_loop(made.loop, angle, sine, cosine, parameters, NONE, results)
        return results.swapaxes(0, 1)

    return run, sine, cosine


def test_one_turn_takes_12_us_near_c(benchmark, tell, one_core, c):
    rows, few = np.empty((9, 360)), turn(360)
    ours, plain_c = one_design(few), called(c[0].turn, DESIGN, 360, few, rows)
    by_kane = [equations.all_forces(SAW.solve("plain", count)) for count in (360, 3600)]
    plain_c()
    found = benchmark(ours)
    assert_same(found, rows)
    named = by_kane[0]()
    assert_same(found, [row for name in FORCES for row in named[name]])

    spent, in_c, theirs, more, theirs_more = seconds(ours, plain_c, by_kane[0], one_design(turn(3600)), by_kane[1])
    benchmark.extra_info.update(us=spent * 1e6, times_c=spent / in_c, sympy_times=theirs / spent)
    tell(
        f"360 angles in a call: {spent * 1e6:.1f} us, {spent / in_c:.2f} times as long as C, {in_c * 1e6:.1f} us;"
        f" SymPy Kane {theirs * 1e6:.0f} us, {theirs / spent:.1f} times as long, at 3600 angles"
        f" {theirs_more / more:.1f} times"
    )
    assert spent <= 12e-6
    assert spent <= 1.6 * in_c
    assert theirs >= 5 * spent
    assert theirs_more > more


def test_long_turn_takes_30_ns_an_angle(benchmark, tell, one_core, c):
    angles = turn(MANY)
    rows = np.empty((9, angles.size))
    ours, plain_c = one_design(angles), called(c[0].turn, DESIGN, angles.size, angles, rows)
    plain_c()
    assert_same(benchmark(ours), rows)
    spent, in_c = seconds(ours, plain_c) / angles.size * 1e9
    benchmark.extra_info.update(ns_an_angle=spent, times_c=spent / in_c)
    tell(f"{MANY} angles: {spent:.1f} ns each, {spent / in_c:.2f} times as long as C, {in_c:.1f} ns")
    assert spent <= 30
    assert spent <= 1.6 * in_c


def test_designs_take_12_ns_an_angle(benchmark, tell, one_core, c):
    ours, sine, cosine = shared(*program("plain"))
    rows = np.empty((BLOCK, 9, 360))
    plain_c, fewer_divisions = (
        called(library.sweep, np.repeat(DESIGN[None], BLOCK, axis=0), BLOCK, 360, sine, cosine, rows) for library in c
    )
    plain_c()
    assert_same(benchmark(ours).swapaxes(0, 1)[-1], rows[-1])
    spent, in_c, fewer = seconds(ours, plain_c, fewer_divisions) / (BLOCK * 360) * 1e9
    benchmark.extra_info.update(ns_an_angle=spent, times_c=spent / in_c, times_c_by_reciprocals=spent / fewer)
    tell(
        f"{BLOCK} designs x 360 angles in common: {spent:.2f} ns an angle, {spent / in_c:.2f} times as long as C,"
        f" {in_c:.2f} ns; the best C, which multiplies by reciprocals, {fewer:.2f} ns: {spent / fewer:.2f} times"
    )
    assert spent <= 12
    assert spent <= 1.3 * fewer


def test_cam_is_near_the_best_c_with_one(benchmark, tell, one_core, c):
    """Which takes twice as long as that without one: as many operations more, among them a root and a quotient."""
    (plain, sine, cosine), *cams = (
        shared(*program(*pair)) for pair in (("plain", FORCES), ("cam-circle", CAM_FORCES), ("cam-cosine", CAM_FORCES))
    )
    rows, more = np.empty((BLOCK, 9, 360)), np.empty((BLOCK, 11, 360))
    given, balance = (np.repeat([part], BLOCK, axis=0) for part in of_cam(program("cam-circle", CAM_FORCES)[1]))
    one = np.repeat(DESIGN[None], BLOCK, axis=0)
    best_c = called(c[1].sweep, one, BLOCK, 360, sine, cosine, rows)
    best_cam = called(c[1].sweep_balanced, given, balance, BLOCK, 360, sine, cosine, more)
    best_cam()
    assert_same(benchmark(cams[0][0]).swapaxes(0, 1)[-1], more[-1])
    times = seconds(best_c, best_cam, plain, *(cam for cam, *_ in cams)) / (BLOCK * 360) * 1e9
    in_c, cam_in_c, ours, circle, cosine_law = times
    benchmark.extra_info.update(circle=circle / cam_in_c, cosine=cosine_law / in_c)
    tell(
        f"cam-balanced, ns an angle: circle {circle:.2f}, {circle / cam_in_c:.2f} times the best C, {cam_in_c:.2f};"
        f" without a cam {ours:.2f} and {in_c:.2f}, so that it takes {circle / ours:.2f} times plain, in C"
        f" {cam_in_c / in_c:.2f}; cosine law {cosine_law:.2f}, {cosine_law / ours:.2f} times plain"
    )
    assert circle <= 1.2 * cam_in_c
    assert circle <= 2.4 * in_c
    assert cosine_law <= 3.5 * in_c


def swept(variant, designs, **options):
    """Table of the three outputs, and the time it takes, s."""
    start = perf_counter()
    table = ks.sweep(SAW, designs, OUTPUTS, variant=variant, progress=False, **options)
    return table, perf_counter() - start


def bare(designs):
    """Time of the loop alone over designs of the plain variant, in blocks as a sweep takes them, s."""
    made, numbers = program("plain", ("O", "balancing_torque", "guide_force"))
    given = ks.compile(SAW.variants["plain"].scene, "balancing_torque").parameters
    columns = {list(given).index(name.partition(" ")[0]): designs[name].to_numpy()[:, None] for name in designs}
    assert [numbers[place] for place in columns] == [given["crank_length"], given["slider.mass"]]
    angles, start = turn(360), perf_counter()
    for first in range(0, len(designs), 1000):
        block = [columns[place][first : first + 1000] if place in columns else one for place, one in enumerate(numbers)]
        made.by_loop(angles, block, [], (len(block[next(iter(columns))]), 360))
    return perf_counter() - start


def report(variant, count, repeats):
    """For a process of its own: prints least time, s, peak memory and size of the tables, MB."""
    import resource

    designs = ks.designs.random(VARIED[variant], count)
    swept(variant, designs[:10_000])
    spent = []
    for _ in range(repeats):
        table, seconds = swept(variant, designs)
        spent.append(seconds)
    size = sum(frame.memory_usage(deep=True).sum() for frame in (designs, table))
    print(min(spent), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3, size / 1e6)


def reported(variant, count, repeats=3):
    code = f"import test_compiled_speed as here; here.report({variant!r}, {count}, {repeats})"
    return [float(text) for text in run(code, {}).split()]


def test_large_sweep_takes_seconds_and_little_memory(benchmark, tell):
    limits = {"plain": 2.0, "cam-circle": 5.0}
    for variant, limit in limits.items():
        given = variant, MANY
        spent, memory, size = benchmark.pedantic(reported, given, rounds=1) if variant == "plain" else reported(*given)
        benchmark.extra_info[f"{variant}, s"] = spent
        tell(f"{MANY} designs x 360 angles, three reductions, {variant}: {spent:.2f} s, {memory:.0f} MB")
        assert spent < limit
        assert memory < 500
        if variant == "plain":
            spent_10, memory_10, size_10 = reported(variant, 10 * MANY, repeats=1)
            tell(
                f"ten times as many: {spent_10 / spent:.1f} times as long, {memory_10 - memory:.0f} MB more, of which"
                f" the tables of designs and results take {size_10 - size:.0f} MB"
            )
            assert spent_10 < 13 * spent
            assert memory_10 - memory < 2 * (size_10 - size)


def test_cam_sweep_takes_1_6_times_a_plain_one(benchmark, tell):
    """Told besides: a sweep in which the cosine cam itself varies, so that designs have no motion in common."""
    given = {variant: (variant, ks.designs.random(varied, MANY)) for variant, varied in VARIED.items()}
    given["cam-cosine, its cam too"] = "cam-cosine", ks.designs.random({"cam.amplitude": "0.28..0.32 m"}, MANY)
    benchmark.pedantic(swept, given["plain"], rounds=1, warmup_rounds=1)
    times = [[swept(*one)[1] for one in given.values()] for _ in range(4)]
    spent = dict(zip(given, np.min(times, axis=0).tolist(), strict=True))
    shares = {name: seconds / spent["plain"] for name, seconds in spent.items()}
    benchmark.extra_info.update(shares)
    told = ", ".join(f"{name} {spent[name]:.3f} s, {share:.2f} times" for name, share in shares.items())
    tell(f"{MANY} designs x 360 angles, three reductions: {told}")
    assert max(shares[variant] for variant in VARIED) <= 1.6


def test_sweep_takes_twice_its_bare_loop(benchmark, tell):
    designs = ks.designs.random(VARIED["plain"], MANY)
    benchmark.pedantic(swept, ("plain", designs), rounds=1, warmup_rounds=1)
    whole, alone = np.min([(swept("plain", designs)[1], bare(designs)) for _ in range(4)], axis=0)
    benchmark.extra_info["times as long"] = whole / alone
    tell(f"{MANY} designs x 360 angles: sweep {whole:.3f} s, {whole / alone:.2f} times its bare loop, {alone:.3f} s")
    assert whole <= 2 * alone


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_impossible_designs_hardly_slow_a_sweep(benchmark, tell):
    good = ks.designs.random({"coupler_length": "1.8..2.2 m", "slider.mass": "500..700 kg"}, MANY)
    bad = good.copy()
    bad.loc[::200, "coupler_length [m]"] = 0.2
    bad.loc[100::200, "slider.mass [kg]"] = -1.0
    table, _ = benchmark.pedantic(swept, ("plain", bad), rounds=1, warmup_rounds=1)
    least = np.min([[swept("plain", designs)[1] for designs in (good, bad)] for _ in range(3)], axis=0)
    benchmark.extra_info["times as long"] = least[1] / least[0]
    reasons = table["failed"].value_counts()
    tell(f"1 % impossible designs: {least[1] / least[0]:.2f} times as long; {reasons.iloc[1:].to_dict()}")
    assert (table["failed"] != "").to_numpy().nonzero()[0].tolist() == list(range(0, MANY, 100))
    assert least[1] <= 2 * least[0]


def test_dask_is_nearly_as_fast_as_local_processes(benchmark, tell):
    distributed = pytest.importorskip("distributed", reason="distributed is not installed (extra: distributed)")
    designs = ks.designs.random(VARIED["plain"], 2 * MANY)
    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0"}
    with (
        ProcessPoolExecutor(2, mp_context=get_context("spawn")) as processes,
        distributed.LocalCluster(**local) as cluster,
        distributed.Client(cluster) as client,
    ):
        executors = processes, client.get_executor()
        for executor in executors:
            swept("plain", designs[: MANY // 2], executor=executor)
        benchmark.pedantic(swept, ("plain", designs), {"executor": executors[1]}, rounds=1)
        times = [[swept("plain", designs, executor=executor)[1] for executor in executors] for _ in range(3)]
    here, dask = np.min(times, axis=0)
    benchmark.extra_info["throughput of Dask"] = here / dask
    tell(f"{2 * MANY} designs: two processes {here:.2f} s, two workers of Dask {dask:.2f} s, {here / dask:.0%}")
    assert here >= 0.8 * dask
