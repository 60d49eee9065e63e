"""Protocol of loads, and of their kinks and jumps.

A load is a frozen dataclass derived from `Load`. It acts in one of two ways, computed from a `Motion` by arithmetic:

    wrenches(motion)    pairs of a link's name, or the frame's, and the `Wrench` on it about its reference joint
    push(motion)        force on the slider `on` along its guide, N

A spring along a guide also has ``spring_rate(motion)``, N/m; its push is minus that rate times the elongation from
`free_position`. ``parted_rate(motion)`` may split the rate into a constant and a remainder. Both save digits where
spring force and inertia nearly cancel.

    VALUE, UNIT             field that may hold an array over the crank angles, a `Table` or a function of the motion
                            instead of a number, and its unit; `evaluate_load` replaces it by values first
    LENGTHS                 fields that hold lengths and angles of the geometry
    potential(motion)       potential energy, J, if it has one; DISSIPATES marks dampers
    misplaced(mechanism)    problems of the joints and links it names
    refusals(motion)        sentences on crank angles at which it has no value; REFUSES: it may have some
    signs(motion)           symbols by which it is drawn
    dimensions(mechanism)   lengths of a drawing (`machine.dimensions`)
    shaking(motion)         inertia force on the frame, a `Support`, of its masses that turn with the crank; then also
                            ``crank_inertia``, added to the crank, kg m2 or None, and ``plane`` along the crankshaft, m
    rests_on_frame(mechanism)  whether it puts a force or couple on the frame
    support(motion)         its force and couple on the frame, a `Support`; by default its wrenches about O

A load or its value (a `Table`, a function of the motion) may declare kinks and jumps:

    kinks(motion)               crank angles of kinks, (K,), and of jumps, (J,), rad, in its own `period` (one turn by
                                default), for any crank angles of the motion
    bends(motion, straight),    the same for each of many designs, without kinks smaller than `straight` times its
    is_bent(straight)           largest value, as `Table` does

A load that jumps where a motion changes its sense has a `Jumps` in its field `jumps`. STROKE marks a load that uses
the dead centres of its slider; a program sets their coordinates in its field `ends`.

Functions without declared kinks are sampled at the resolution of the scene; narrower features may be missed.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import reduce
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.paths import Batched
from ..group import FRAME
from ..kinematic_state import SENSE_REMEDY, has_no_sense
from ..links import Wrench
from ..supports import Support
from .table import Table
from .table_pieces import TURN


class Symbol(NamedTuple):
    """Symbol of a load in drawings, in the poses of a motion.

    Attributes
    ----------
    kind : "spring", "damper", "line", "force", "couple", "spiral", "ring" or "shaft"
        Springs, dampers and lines run from `start` to `end`; all others stand at `start`. A damper on a slider stands
        for a cylinder with gas, a shaft for a wheel with a weight.
    start : array (2, N)
    end : array (2, N), optional
        None for a spring or gas spring on a slider, which is drawn along the guide.
    direction : array (2, N), optional
        Unit vector of a positive force, or to the weight of a shaft.
    slider : str
        Slider of a spring along a guide.
    sense : array (N,) or float
        -1 where a force or couple acts against its positive sense, else 1. A spring along a guide stands ahead of its
        slider, with -1 behind it.
    """

    kind: str
    start: Any
    end: Any = None
    direction: Any = None
    slider: str = ""
    sense: Any = 1.0


class Load(checks.Checked, Batched):
    """Base of all loads; the module describes the protocol."""

    PATH: ClassVar[str] = ""
    VALUE: ClassVar[str] = ""
    UNIT: ClassVar[str] = "N"
    LENGTHS: ClassVar[tuple[str, ...]] = ()
    REFUSES: ClassVar[bool] = False
    DISSIPATES: ClassVar[bool] = False
    STROKE: ClassVar[bool] = False
    jumps: Any = None

    @property
    def value_now(self) -> Any:
        """Force or moment: a number, an array, a table or a function; None for springs, dampers and weight."""
        return getattr(self, self.VALUE) if self.VALUE else None

    @property
    def period(self) -> float:
        """Period, rad of the crank."""
        return getattr(self.value_now, "period", TURN)

    @property
    def title(self):
        """Name of the load in messages."""
        on = getattr(self, "on", None)
        return type(self).__name__ if on is None else f"{type(self).__name__} on {on!r}"

    def problems(self, mechanism):
        """Problems of the load and its table on a mechanism, as sentences or None."""
        table = self.value_now
        if not isinstance(table, Table):
            return [*self.misplaced(mechanism)]
        own = self.UNIT.replace(" ", "*")
        wrong = f"{self.title}: its value is in {own}, but that of its table in {table.unit}"
        return [*self.misplaced(mechanism), *table.problems(mechanism), wrong if table.unit not in ("", own) else None]

    def misplaced(self, mechanism) -> Any:
        """Problems of the joints and links that it names, as sentences or None."""
        return ()

    def refusals(self, motion) -> Any:
        """Sentences on the crank angles at which it has no value."""
        return ()

    def signs(self, motion) -> Any:
        """Symbols by which it is drawn, each a `Symbol`."""
        return ()

    def dimensions(self, mechanism) -> Any:
        """What its numbers measure on a drawing, by their steps (`machine.dimensions`)."""
        return {}

    def rests_on_frame(self, mechanism) -> bool:
        """Whether it puts a force or couple on the frame: by default if it has wrenches."""
        return hasattr(self, "wrenches")

    def support(self: Any, motion) -> Support:
        """Its force and couple on the frame."""
        on_frame = (wrench for link, wrench in self.wrenches(motion) if link == FRAME)
        total = reduce(Wrench.plus, on_frame, Wrench(None, None))
        return Support(total.force, None, total.moment)

    def sense(self, motion) -> Any:
        """Sign of its value in the poses of a motion, 1 or -1; where it is 0 or missing, of its largest value."""
        here: Any = 0.0
        value = self.value_now
        if isinstance(value, Table):
            largest = value.largest
            with suppress(ParameterError):
                here = value(motion)
        elif value is None or callable(value):
            return 1.0
        else:
            known = np.asarray(value, dtype=float)
            largest = known.flat[np.argmax(np.abs(known))]
            if known.ndim == 0 or any(item is self for item in motion.loads):
                here = known
        return np.where(here == 0, -1.0 if largest < 0 else 1.0, np.sign(here))


@dataclass(frozen=True)
class Jumps:
    """Jumps of a load where the motion that it opposes changes its sense, or its work begins or ends.

    `angles` gives their crank angles over the period of a motion, (1 or designs, J), rad, padded by NaN.
    """

    angles: Callable[[Any], Any]

    def kinks(self, motion):
        found = self.angles(motion)
        return np.empty(0), found[~np.isnan(found)]

    def bends(self, motion, straight):
        found = self.angles(motion)
        return found, np.ones(found.shape[1], dtype=bool), 0.0

    def is_bent(self, straight):
        return True

    def period_on(self, mechanism):
        return TURN * mechanism.turns


def unknown_sense(item, motion):
    """Sentence on a load against the motion where the crank rests and its sense is unknown; at most one."""
    still = has_no_sense(motion)
    if still.any():
        yield checks.Problem(f"{item.title}: it acts against the motion, {SENSE_REMEDY}", still)


def has_no_user_code(item):
    """Whether a load consists of checked numbers, without code of the user's."""
    return isinstance(item, Load) and not callable(item.value_now)


def angles_text(motion, where):
    """Words for the crank angles of a motion at which a mask holds, the first three in degrees."""
    angle = np.degrees(np.unique(np.broadcast_to(motion.crank_angle, where.shape)[where]))
    many = ", ".join(f"{part:.6g}" for part in angle[:3])
    return f"at {angle.size} crank angles, {'the first ' * (angle.size > 3)}{many} deg"


def value_of(item):
    """Force or moment of a load, also of one of the user's own: see `Load.value_now`."""
    return item.value_now if isinstance(item, Load) else getattr(item, "force", None)


def refusals(motion):
    """Sentences on the crank angles of a motion at which loads have no value."""
    return [text for item in motion.loads if getattr(item, "REFUSES", False) for text in item.refusals(motion)]


def value_rule(unit):
    """Rule of a value that is a number, an array over the crank angles, a table, or a function of the motion."""
    return checks.OrFunction(checks.Number(unit, table=True))


def kink_sources(loads):
    """List of loads, values and jumps that declare kinks."""
    parts = (part for item in loads for part in (item, value_of(item), item.jumps if isinstance(item, Load) else None))
    return [part for part in parts if hasattr(part, "kinks")]


def kinks_of(part, motion):
    """Crank angles of kinks, (K,), and of jumps, (J,), that a part declares, rad, wrapped into its period."""
    found = part.kinks(motion)
    try:
        kinks, jumps = (np.ravel(np.asarray(angles, dtype=float)) for angles in found)
    except (TypeError, ValueError):
        kinks = jumps = np.full(1, np.nan)
    if not (np.isfinite(kinks).all() and np.isfinite(jumps).all()):
        name = getattr(part, "__name__", type(part).__name__)
        raise ParameterError(
            f"{name}.kinks must return two arrays of finite crank angles, those of kinks and those of jumps, got "
            f"{checks.shown(found)}"
        )
    period = period_on(part, motion.mechanism)
    return np.mod(kinks, period), np.mod(jumps, period)


def has_significant_kinks(part, straight):
    """Whether a part has kinks larger than `straight` times its largest value, or jumps."""
    return not hasattr(part, "is_bent") or part.is_bent(straight)


def significant_kinks(part, motion, straight):
    """Crank angles of the kinks larger than `straight` times the largest value of a part, rad, (1 or designs, K).

    Rows end with NaN where a design has fewer. Also a mask of the jumps, (K,), and the largest kink left out,
    relative to the largest value.
    """
    if hasattr(part, "bends"):
        return part.bends(motion, straight)
    kinks, jumps = kinks_of(part, motion)
    return np.concatenate([kinks, jumps])[None], np.arange(kinks.size + jumps.size) >= kinks.size, 0.0


def period_on(part, mechanism):
    """Period of a part that declares kinks on a mechanism, rad."""
    return part.period_on(mechanism) if hasattr(part, "period_on") else getattr(part, "period", TURN)
