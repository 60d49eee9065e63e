"""Springs that balance a slider of a scene, including their own mass.

At the crank speed w the end of a spring of stiffness c and mass m has the dynamic stiffness c z cot z, z = w sqrt(m/c)
(`machine.loads.surge`). It balances the mass m3 if m3 w^2 = c z cot z. With the uncorrected stress tau and the largest
speed v of the slider, z = v sqrt(2 rho G) / tau for push-pull springs. It is twice that for opposed pairs that stay
pressed, for any wire and count. For z >= pi / 2 no balance exists.
"""

from dataclasses import dataclass, field, fields
from typing import ClassVar

import numpy as np

from ..cycle.means import closed_turn
from ..design.follower_speed import peak_of, spring_surge
from ..errors import ParameterError
from ..machine.cams.profile import POSITIVE
from ..machine.loads import Spring
from ..machine.loads.surge import end_stiffness
from ..numbers import checks
from ..solution.scene import Scene, scene_problem
from .result import Row, warn_of_notes
from .springs import SAFE, HelicalSpring, helical_spring, lightest

MAX_ITERATIONS, TOLERANCE = 500, 1e-13
"""Iterations for the balancing stiffness; relative change of the last step."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class BalancingSpring(HelicalSpring):
    """A `HelicalSpring` that balances a slider, `spring_for` returns it.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> spring = ks.Spring.balancing(2.0, 60.0, free_position=0.3)
    >>> scene = ks.Scene(ks.crank_slider(0.02, 0.3, slider=ks.Link(2.0)), 60.0, loads=spring)
    >>> found = ks.sizing.spring_for(scene, index=6.0)
    >>> print(f"{found.stiffness:.0f} N/m, {found.mass:.3f} kg")
    7262 N/m, 0.052 kg
    """

    carried_mass: float
    surge_excitation: float
    stiffness_by_third: float = field(init=False)
    mass_by_third: float = field(init=False)

    ROWS: ClassVar[dict[str, Row]] = HelicalSpring.ROWS | {
        "carried_mass": Row("kg", "mass that the spring balances", "m3 w^2 = c z cot z, z = w sqrt(m / c), Wahl 1963"),
        "stiffness_by_third": Row("N/m", "stiffness, if it stretches evenly", "m3 w^2 = c - m w^2 / 3, at this m / c"),
        "mass_by_third": Row("kg", "mass, if it stretches evenly", "m3 w^2 = c - m w^2 / 3, at this m / c"),
        "surge_excitation": Row("m", "harmonic of the travel nearest to surge", "Fourier series of the travel"),
    }

    def __post_init__(self):
        super().__post_init__()
        ratio, square = self.mass / self.stiffness, self.crank_speed**2
        third = self.carried_mass * square / (1.0 - ratio * square / 3.0)
        vars(self).update(stiffness_by_third=third, mass_by_third=ratio * third)

    def _notes(self):
        yield from super()._notes()
        if self.mass > self.carried_mass or self.fatigue_safety < SAFE:
            weighs = f"{self.mass:.4g} kg of steel for {self.carried_mass:.4g} kg"
            yield f"{weighs}: use gas springs (ks.GasSpring), or none"


def spring_for(scene, spring="spring", **options):
    """Lightest helical springs that replace a scene's spring, including their own mass in the balance.

    The scene's spring states the balance: the dynamic stiffness of its end at the crank speed (its `stiffness` if it
    has no mass). The new springs have the same dynamic stiffness, waves included. A scene neglects waves; it would need
    `stiffness_by_third`. The travel is twice the largest elongation.

    Parameters
    ----------
    scene : Scene
        One design, at its crank speed.
    spring : str
        Name of the `Spring`, as in the paths of its numbers: "spring", "spring2".
    options
        As for `helical_spring`, without stiffness, travel and crank_speed.

    Returns
    -------
    BalancingSpring

    Raises
    ------
    ParameterError
        The spring is unknown or has a cubic term. The machine is at rest, or its mechanism does not close all round. No
        spring balances the slider, because its mass grows faster than its stiffness.

    Warns
    -----
    HintWarning
        Each note of the result.

    Examples
    --------
    Steel at 400 MPa does not balance the study's saw.

    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").variants["cam-circle"].scene
    >>> steel = {"arrangement": "opposed", "allowed_stress": 400e6, "correction": "none"}
    >>> ks.sizing.spring_for(saw, **steel)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    kinetostatics.errors.ParameterError: spring_for: no opposed springs of music wire balance 600 kg: ...
    """
    defaults = {name: value for name, value in (helical_spring.__kwdefaults__ or {}).items() if name != "crank_speed"}
    unknown = (checks.choice("option", name, tuple(defaults)) for name in options)
    checks.require("spring_for", scene_problem(scene), *unknown)
    solution, rate, travel, speed, balance = _balance(scene, spring)
    options = defaults | options | {"travel": travel, "crank_speed": speed}
    stiffness = balance
    for _ in range(MAX_ITERATIONS):
        found = lightest("spring_for", stiffness=stiffness, **options)
        z = speed * np.sqrt(found.mass / found.stiffness)
        before, stiffness = stiffness, float(balance * np.tan(z) / z) if z < np.pi / 2.0 else np.inf
        if stiffness == np.inf or abs(stiffness - before) <= TOLERANCE * stiffness:
            break
    if stiffness == np.inf or abs(stiffness - before) > TOLERANCE * stiffness:
        raise ParameterError(
            f"spring_for: no {found.arrangement} springs of {found.material.name} balance {balance / speed**2:.6g} kg: "
            f"their surge ratio is {np.pi / z:.3g}, and at 2 or less their own mass uses up all stiffness. Allow more "
            "stress, or use gas springs (ks.GasSpring), or none"
        )
    given = {item.name: getattr(found, item.name) for item in fields(found) if item.init}
    surge = spring_surge(solution, found.mass * rate / found.stiffness)
    given |= {"carried_mass": balance / speed**2, "surge_excitation": surge.excitation}
    return warn_of_notes("spring_for", BalancingSpring(**given))


def _balance(scene, name):
    """Solution with only one spring, its stiffness, travel, size of the crank speed, dynamic stiffness of its end."""
    places = {path.removesuffix(".stiffness"): place for path, place in scene.places.items()}
    owners = {key: place._replace(steps=place.steps[:-1]).value(scene) for key, place in places.items()}
    springs = {key: owner for key, owner in owners.items() if isinstance(owner, Spring) and "." not in key}
    problem = checks.choice("spring", name, tuple(springs)) if springs else "the scene has no Spring among its loads"
    checks.require("spring_for", problem)
    load = springs[name]
    found = checks.single_numbers(
        "spring_for",
        f"the spring must have no cubic term, got {checks.shown(load.cubic)}" if np.any(load.cubic) else None,
        stiffness=(load.stiffness, "N/m", POSITIVE),
        mass=(load.mass, "kg", {}),
        crank_speed=(scene.crank_speed, "rad/s", {"unequal": 0.0}),
    )
    solution = Scene(scene.mechanism, scene.crank_speed, loads=load).unsolved(np.zeros(1))
    closed_turn(solution, "spring_for")
    speed, mass, stiffness = abs(found["crank_speed"]), found["mass"], found["stiffness"]
    if speed * np.sqrt(mass / stiffness) >= np.pi / 2.0:
        raise ParameterError(
            f"spring_for: the spring's own mass uses up its stiffness at {speed:.6g} rad/s, so it cannot balance: "
            f"{mass:.6g} kg, {stiffness:.6g} N/m; give it less mass or more stiffness"
        )
    balance = float(end_stiffness(stiffness, mass, speed)) if mass else stiffness
    reach = peak_of(solution, lambda at: np.abs(at.placement.travels[load.on].position - load.free_position))
    return solution, stiffness, 2.0 * reach.value, speed, balance
