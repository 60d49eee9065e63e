"""Sweeps of few designs, and loads with spikes that samples miss."""

from functools import partial

import numpy as np
import pandas as pd

import kinetostatics as ks
from kinetostatics.machine.loads import value_of
from kinetostatics.mechanics.quantities import component_sizes
from support.case_files import shipped

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(8)
SAW = shipped("sawframe_2r63")
sweep = partial(ks.sweep, progress=False)


def assert_equal(found, expected):
    pd.testing.assert_frame_equal(found, expected, check_exact=True)


def rising(count=200):
    """Designs of the sawframe of which every tenth cannot be."""
    designs = ks.designs.latin_hypercube({"coupler_length": "0.5..2.5 m", "slider.mass": "100..900 kg"}, count)
    designs.loc[::10, "slider.mass [kg]"] *= -1
    return designs


def spiky(seed):
    """A pump with narrow spikes and flanks: over travel, over travel with a stroke back, over the angle."""
    rng = np.random.default_rng(seed)
    kind, count, width = seed % 3, int(rng.integers(2, 7)), 10.0 ** rng.uniform(-6, -3)
    if kind < 2:
        first = np.sort(rng.uniform(0.12, 0.26, count))
        x = np.sort(np.concatenate([[0.05, 0.4], first, first + width, first + width * rng.uniform(1.1, 3.0)]))
        force = rng.standard_normal(x.size) * 3e3 * (rng.random(x.size) < 0.6)
        back = rng.standard_normal(x.size) * 1e3 if kind else None
        table = ks.Table(x, force, over="travel", back=back)
    else:
        even, odd = np.linspace(0.0, 6.0, 25), np.sort(rng.uniform(0.2, 5.7, count))
        x = np.sort(np.concatenate([even, odd, odd + 10.0 * width]))
        table = ks.Table(x, rng.standard_normal(x.size) * 3e3)
    pump = ks.crank_slider(
        rng.uniform(0.03, 0.06),
        0.19,
        guide_offset=rng.uniform(-0.02, 0.02),
        coupler=ks.Link(1.0, 0.1, 0.01),
        slider=ks.Link(rng.uniform(0.0, 3.0)),
    )
    return ks.Scene(pump, rng.uniform(5.0, 60.0), loads=[ks.ProcessForce(table), ks.Gravity()])


def ends(scene, name):
    """Least and largest value at very many crank angles, and at and between all kinks."""
    kinks = np.sort(np.concatenate(value_of(scene.loads[0]).kinks(scene.solve(4))))
    width = np.diff(kinks, append=kinks[0] + scene.period)
    between = kinks[:, None] + width[:, None] * np.linspace(0.0, 1.0, 33)
    angle = np.concatenate([np.linspace(0.0, scene.period, 50_000), between.ravel()])
    values = component_sizes(scene.solve(angle, engine="numpy"), name)[0]
    return values.min(), values.max()


def means(scene, name):
    """Mean magnitude and root mean square, by Gauss between all kinks on panels of a quarter degree at most."""
    kinks = np.concatenate(value_of(scene.loads[0]).kinks(scene.solve(4)))
    edges = np.unique(np.concatenate([kinks, np.linspace(0.0, scene.period, 1441)]))
    edges = np.sort(np.concatenate([edges[:-1] + np.diff(edges) * share for share in (0.0, 0.3, 0.6)] + [edges[-1:]]))
    width = np.diff(edges)
    angle = edges[:-1, None] + width[:, None] * (0.5 + 0.5 * POINTS)
    values = component_sizes(scene.solve(angle.ravel(), engine="numpy"), name)[0].reshape(angle.shape)
    mean, square = (
        float(((part @ WEIGHTS) * 0.5 * width).sum() / scene.period) for part in (np.abs(values), values**2)
    )
    return mean, np.sqrt(square)
