"""How fast: the plain sawframe, all reactions and torque, against rivals timed in the same process.

Run by ``python -m pytest tests/benchmarks --benchmark-only``. Every ratio is of least times of several rounds in which
the rivals take turns; limits are generous, the figures themselves are printed and kept in the benchmark's `extra_info`.
"""

import numpy as np

import kinetostatics as ks
from support.speed import (
    COUPLER_INERTIA,
    COUPLER_MASS,
    CRANK,
    GRAVITY,
    PLAIN,
    SLIDER_MASS,
    SPEED,
    assert_same,
    flat,
    results,
    run,
    seconds,
    turn,
)


def newton_euler(A, B, centre, centre_acceleration, angular_acceleration, slider_acceleration):
    """The same by assembling and solving three equations of each of three bodies, all angles at once."""
    O_, A_, B_ = slice(0, 2), slice(2, 4), slice(4, 6)
    N, M, T = 6, 7, 8
    constant = np.zeros((9, 9))
    constant[0:2, O_], constant[0:2, A_] = np.eye(2), -np.eye(2)
    constant[2, T] = 1.0
    constant[3:5, A_], constant[3:5, B_] = np.eye(2), -np.eye(2)
    constant[6:8, B_], constant[7, N] = np.eye(2), 1.0
    constant[8, M] = 1.0

    (x, y), (to_A_x, to_A_y), (to_B_x, to_B_y) = A, A - centre, B - centre
    matrix = np.repeat(constant[None], x.size, axis=0)
    matrix[:, 2, 2], matrix[:, 2, 3] = y, -x
    matrix[:, 5, 2], matrix[:, 5, 3] = -to_A_y, to_A_x
    matrix[:, 5, 4], matrix[:, 5, 5] = to_B_y, -to_B_x

    right = np.zeros((x.size, 9))
    right[:, 3:5] = COUPLER_MASS * centre_acceleration.T
    right[:, 4] += COUPLER_MASS * GRAVITY
    right[:, 5] = COUPLER_INERTIA * angular_acceleration
    right[:, 6:8] = SLIDER_MASS * slider_acceleration.T
    right[:, 7] += SLIDER_MASS * GRAVITY
    found = np.linalg.solve(matrix, right[..., None])[..., 0].T
    return found[O_], found[A_], found[B_], found[N], found[M], found[T]


def motion(angles):
    """What `newton_euler` needs to know."""
    s = ks.solve(PLAIN, angles, crank_speed=SPEED)
    positions = (s.position(point) for point in ("A", "B", "coupler"))
    return *positions, s.acceleration("coupler"), s.angular_acceleration("coupler"), s.acceleration("B")


def test_one_turn_takes_half_of_newton_euler(benchmark, tell):
    """Newton-Euler gets the motion for nothing."""
    angles = turn(360)
    known = motion(angles)
    assert_same(benchmark(results, PLAIN, angles), newton_euler(*known))
    ours, theirs = seconds(lambda: results(PLAIN, angles), lambda: newton_euler(*known))
    benchmark.extra_info["times faster than Newton-Euler"] = theirs / ours
    tell(f"360 angles: {ours * 1e6:.0f} us; 9x9 Newton-Euler {theirs * 1e6:.0f} us, {theirs / ours:.1f} times as long")
    assert theirs >= 2 * ours


def test_one_turn_takes_three_times_a_flat_script(benchmark, tell):
    angles = turn(360)
    assert_same(benchmark(results, PLAIN, angles), flat(angles))
    ours, theirs = seconds(lambda: results(PLAIN, angles), lambda: flat(angles))
    benchmark.extra_info["times slower than flat script"] = ours / theirs
    tell(f"360 angles: {ours * 1e6:.0f} us, {ours / theirs:.2f} times as long as a flat script, {theirs * 1e6:.0f} us")
    assert ours <= 3 * theirs


def test_time_is_linear_in_the_number_of_angles(benchmark, tell):
    """In a fresh process for each number, as past allocations of other sizes change the price of memory by glibc.

    By default it gives freed memory back at once, and the page faults cost more than the arithmetic; told to keep it
    (second figure) it leaves the arithmetic alone.
    """
    counts = (360, 3600, 36000, 1_000_000)
    keep = {"MALLOC_TRIM_THRESHOLD_": "9999999999", "MALLOC_MMAP_THRESHOLD_": "9999999999"}
    benchmark.pedantic(results, (PLAIN, turn(counts[-1])), rounds=3)
    each = {count: nanoseconds_an_angle(count, {}) for count in counts}
    for count, (ours, theirs) in each.items():
        kept = nanoseconds_an_angle(count, keep)
        benchmark.extra_info[f"{count} angles, ns an angle"] = ours
        tell(
            f"{count:8d} angles: {ours:4.0f} ns an angle, flat script {theirs:4.0f};"
            f" memory kept: {kept[0]:4.0f} and {kept[1]:4.0f}"
        )
    assert each[1_000_000][0] <= 1.5 * each[36000][0]


def nanoseconds_an_angle(count, environment):
    """Of `results` and of `flat`, in a process of its own."""
    code = (
        f"from support.speed import *; angles = turn({count});"
        f" print(*seconds(lambda: results(PLAIN, angles), lambda: flat(angles), rounds=6) / {count} * 1e9)"
    )
    return [float(text) for text in run(code, environment).split()]


def test_many_designs_in_one_call(benchmark, tell):
    designs = 1000
    angles = turn(360)
    lengths = np.linspace(1.5, 2.5, designs)[:, None]
    masses = np.linspace(100.0, 200.0, designs)[:, None]

    def variant(length, mass):
        coupler = ks.Link(mass, length / 2, COUPLER_INERTIA)
        return ks.crank_slider(CRANK, length, coupler=coupler, slider=ks.Link(SLIDER_MASS))

    def at_once():
        return results(variant(lengths, masses), angles)

    def one_by_one():
        pairs = zip(lengths.flat, masses.flat, strict=True)
        return [results(variant(float(length), float(mass)), angles) for length, mass in pairs]

    together, apart = benchmark.pedantic(at_once, rounds=5), one_by_one()
    assert_same([together[0][:, 700], together[-1][700]], [apart[700][0], apart[700][-1]])
    ours, theirs = seconds(at_once, one_by_one, rounds=5) / (designs * angles.size)
    benchmark.extra_info["ns a design and angle"] = ours * 1e9
    benchmark.extra_info["times faster than a loop over designs"] = theirs / ours
    tell(f"1000 designs x 360 angles: {ours * 1e9:.0f} ns each; loop over designs {theirs * 1e9:.0f} ns")


def test_import_takes_little_longer_than_that_of_numpy(benchmark, tell):
    def seconds_to_import(name):
        return float(run(f"from time import perf_counter as now; t = now(); import {name}; print(now() - t)", {}))

    benchmark.pedantic(seconds_to_import, ("kinetostatics",), rounds=3, warmup_rounds=1)
    times = [[seconds_to_import(name) for name in ("kinetostatics", "numpy")] for _ in range(10)]
    ours, theirs = np.min(times, axis=0)
    benchmark.extra_info["times as long as NumPy"] = ours / theirs
    tell(f"import: {ours * 1e3:.0f} ms, {ours / theirs:.2f} times as long as that of NumPy, {theirs * 1e3:.0f} ms")
    assert ours <= 1.6 * theirs
