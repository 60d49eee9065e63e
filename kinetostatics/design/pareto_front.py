"""Pareto fronts: the best of one output for each value of another, between the separate optima of both."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import DesignError
from ..numbers import checks
from ..numbers.formatting import with_units
from .constraints import MEAN, Constraint, limit_list, parse_output
from .duties import in_each, mean_value, read_duties
from .optimisation import ANGLES, named_numbers, optimise
from .problem import scene_of


@with_units()
@dataclass(frozen=True, eq=False)
class Front:
    """Designs that no other design surpasses in both outputs; `pareto` and `balancing.pareto` return it.

    `ks.plots.front` draws it.

    Attributes
    ----------
    outputs : (str, str)
    table : pandas.DataFrame
        A row for each design: both outputs, and the numbers that varied.
    designs : tuple of Found
        From `balancing.pareto`: tuple of Balanced.
    before : (float, float)
        Outputs of the source.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> spring = ks.Spring(600e3, free_position=2.0)
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5, loads=[spring])
    >>> vary = {"spring.stiffness": (100e3, 900e3)}
    >>> found = ks.design.pareto(saw, vary, ("largest_absolute B", "rms balancing_torque"), points=3, angles=90)
    >>> found.outputs, len(found.designs)
    (('largest_absolute B', 'rms balancing_torque'), 3)
    """

    outputs: tuple[str, str]
    table: object = field(repr=False)
    designs: tuple[Any, ...] = field(repr=False)
    before: tuple[float, float]


def pareto(source, vary, minimise, limits=(), *, points=9, variant=None, reference=None, seed=0, starts=1, **options):
    """Pareto front of two outputs.

    Parameters
    ----------
    source, vary, limits, variant, reference, starts, seed
        As for `optimise`; with duties both outputs are weighted means.
    minimise : (str, str)
        Two outputs; a "-" before one maximises it: ("largest_absolute cam_force", "-ratio mean_absolute
        balancing_torque").
    points : int
        Number of designs on the front, at least 2, evenly spaced by the second output (a ratio by its logarithm).
    **options
        `angles`, `engine`, `numbers` and `progress` of `optimise`.

    Returns
    -------
    Front

    Raises
    ------
    ParameterError
        A text cannot be read, or names an unknown output.
    DesignError
        No design keeps the limits.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> vary = {"spring.stiffness": ("600 kN/m", "900 kN/m"), "cam.centre.x": ("-30 mm", "-10 mm")}
    >>> front = ks.design.pareto(
    ...     ks.load_case("sawframe_2r63"), vary, ("largest_absolute cam_force", "mean_absolute balancing_torque"),
    ...     variant="cam-circle", points=3, angles=180,
    ... )
    >>> bool((front.table.iloc[:, 0].diff().dropna() > 0).all())
    True
    """
    import pandas as pd

    texts = isinstance(minimise, list | tuple) and all(isinstance(text, str) for text in minimise)
    checks.require(
        "pareto",
        None if texts and len(minimise) == 2 else f"minimise must be two outputs, got {checks.shown(minimise)}",
        points_problem(points),
        *(checks.choice("option", name, ("angles", "engine", "numbers", "progress")) for name in options),
    )
    pair = [(text.lstrip("- "), text.strip().startswith("-")) for text in minimise]
    parts = named_numbers(source, options.get("numbers", ()))
    duties = read_duties(source, variant, reference)
    shared = {"variant": variant, "reference": reference, "seed": seed, "starts": starts, "angles": ANGLES} | options

    def parsed_pair(_, duty):
        return [parse_output(text, scene_of(duty.source), parts) for text, _ in pair]

    first, second = next(iter(in_each(duties, parsed_pair).values()))
    kept, mean = limit_list(limits), "" if "" in duties else MEAN

    def best(number, more=(), begin=None):
        text, greatest = pair[number]
        goal = {"maximise" if greatest else "minimise": text}
        return optimise(source, vary, limits=(*kept, *more), begin=begin, **goal, **shared)

    def outputs(duties):
        return [float(mean_value(output, duties)) for output in (first, second)]

    ends = [best(0), best(1)]
    levels = [outputs(end.duties())[1] for end in ends]
    spaced: Any = np.geomspace if second.ratio and min(levels) > 0 else np.linspace
    found, relation = ends[:1], ">=" if pair[1][1] else "<="
    for level in spaced(*levels, points)[1:-1].tolist():
        limit = Constraint(second, relation, level, duty=mean)
        try:
            found.append(best(0, (limit,), found[-1].values))
        except DesignError:
            found.append(best(0, (limit,), ends[1].values))
    found.append(ends[1])
    columns = first.column, second.column
    rows = [
        dict(zip(columns, outputs(design.duties()), strict=True)) | design.numbers()["after"].to_dict()
        for design in found
    ]
    return Front((str(first), str(second)), pd.DataFrame(rows), tuple(found), tuple(outputs(duties)))


def points_problem(points):
    """Sentence on a wrong number of designs on a front, or None."""
    return checks.count("points", points) or (None if points > 1 else f"points must be at least 2, got {points}")
