"""Energy of a turn: from the motor through its rotor to loads and joints, and the energy stored and returned.

An induction motor transfers torque times synchronous speed through the air gap and torque times shaft speed at the
shaft; the difference heats the rotor. Loads take the rest, and friction of the joints loses it. Flywheel, links,
weights and springs store energy and return all of it within the period.
"""

from dataclasses import dataclass

import numpy as np

from ..errors import QuantityError
from ..machine.friction import NO_FRICTION
from ..mechanics.load_values import numbered_titles
from ..numbers import checks
from ..numbers.formatting import number, with_units
from ..numbers.parameter_tree import replace_unchecked

ROTOR, FLYWHEEL, LINKS = "rotor, by slip", "flywheel and rotor", "links"
SOURCE, LOSS, LOAD, JOINT, HELD = "source", "loss", "load", "joint", "held"
ENERGY_TOLERANCE = 1e-13
"""Negligible energy, relative to the energy exchanged."""


@with_units(energy="J", swing="J")
@dataclass(frozen=True)
class Part:
    """A part that supplies, takes or stores energy.

    Attributes
    ----------
    name : str
    kind : str
        "source" supplies `energy`; "loss", "load" and "joint" take it (negative if they supply it); "held" stores
        energy.
    energy : float
        In a turn, J.
    swing : float
        Largest less smallest stored energy over the period, J; NaN of parts that store none.
    """

    name: str
    kind: str
    energy: float
    swing: float = np.nan


@dataclass(frozen=True)
class EnergyFlow:
    """Energy balance of a turn by part; `Running.energy_flow` returns it.

    Attributes
    ----------
    parts : tuple of Part
        Each with ``.name``, ``.kind``, ``.energy`` in a turn and ``.swing`` of its stored energy, J.
    turn_time : float
        Duration of a turn of the crank, s.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> flow = ks.drive.steady(pump, motor, flywheel=0.05).energy_flow
    >>> [(part.name, part.kind) for part in flow.parts][:2], flow.residual < 1e-12
    ([('through the air gap', 'source'), ('rotor, by slip', 'loss')], True)
    """

    parts: tuple[Part, ...]
    turn_time: float

    def __getitem__(self, name):
        """Energy of a part in a turn, by its name, J."""
        found = {part.name: part.energy for part in self.parts}
        problem = checks.choice("part", name, tuple(found))
        if problem:
            raise QuantityError(f"energy flow: {problem}")
        return found[name]

    def __repr__(self):
        wide = max((len(part.name) for part in self.parts), default=0)
        noise = ENERGY_TOLERANCE * np.nanmax([0.0, *(max(abs(part.energy), part.swing) for part in self.parts)])
        lines = [f"<EnergyFlow: energy in a turn of {self.turn_time:.6g} s"]
        for part in self.parts:
            held = f", {number(part.swing, bound=noise)} J stored and returned" if part.swing == part.swing else ""
            lines.append(f"  {part.name:<{wide}}  {part.kind:<6}  {number(part.energy):>11} J{held}")
        return "\n".join(lines) + ">"

    @property
    def residual(self):
        """Imbalance: energy of the source less that of all other parts, relative to all energies of the turn."""
        given = sum(part.energy for part in self.parts if part.kind == SOURCE)
        taken = sum(part.energy for part in self.parts if part.kind != SOURCE)
        size = sum(abs(part.energy) for part in self.parts)
        size += sum(part.swing for part in self.parts if part.swing == part.swing)
        return abs(given - taken) / size if size else 0.0

    def frame(self):
        """Table with a row for each part, a pandas DataFrame: energy in a turn, mean power, share, stored energy."""
        import pandas as pd

        table = pd.DataFrame(self.parts).set_index("name").rename_axis("part")
        source = table.energy[table.kind == SOURCE].sum()
        power, share = table.energy / self.turn_time, table.energy / source if source > 0.0 else np.nan
        table.insert(2, "mean power [W]", power)
        table.insert(3, "share [1]", share)
        return table.rename(columns={"energy": "energy per turn [J]", "swing": "swing [J]"})


def energy_flow(run) -> EnergyFlow:
    """Energies of a turn of periodic running, each by its own integral; `residual` is their imbalance."""
    pieces, speed, acceleration, inertia = run.on_pieces
    angle, shape = pieces.angle.ravel(), pieces.angle.shape
    moving = replace_unchecked(run.scene, crank_speed=speed.ravel(), crank_acceleration=acceleration.ravel())

    def swing(energy):
        return pieces.largest(energy)[0] + pieces.largest(-energy)[0]

    if run.has_air_gap:
        parts = [Part("through the air gap", SOURCE, run.air_gap_energy_per_turn)]
        parts.append(Part(ROTOR, LOSS, run.rotor_loss_per_turn))
    else:
        parts = [Part("motor" if run.motor is not None else "constant torque", SOURCE, run.energy_per_turn)]
    for name, item in zip(numbered_titles(run.scene.loads), run.scene.loads, strict=True):
        torque = replace_unchecked(moving, loads=(item,), friction=NO_FRICTION).solve(angle).load_torque
        torque = np.broadcast_to(torque, angle.shape).reshape(shape)
        energy = zero_if_rounding(pieces.whole_integral(torque) * run.direction, pieces.whole_integral(np.abs(torque)))
        returned = swing(pieces.integral_from_start(torque)) if energy == 0.0 and np.any(torque) else np.nan
        parts.append(Part(name, LOAD, energy / run.turns, returned))
    for joint in run.scene.friction.acting:
        parts.append(Part(f"friction {joint}", JOINT, run.friction_energy_per_turn_at(joint)))
    kinetic = {FLYWHEEL: 0.5 * run.flywheel * speed**2, LINKS: 0.5 * inertia * speed**2}
    parts += [Part(name, HELD, 0.0, swing(energy)) for name, energy in kinetic.items() if np.any(energy)]
    return EnergyFlow(tuple(parts), run.duration / run.turns)


def zero_if_rounding(energy, flowing):
    """An energy, or 0 if it is rounding of the energy that flows."""
    return 0.0 if abs(energy) <= ENERGY_TOLERANCE * flowing else energy
