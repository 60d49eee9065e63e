"""What a load is: the protocol by which everything else asks it.

A load is a frozen dataclass derived from `Load`. It acts in one of two ways:

    wrenches(motion)    pairs of a link's name and the `Wrench` on it about its reference joint; on the frame they end
    push(motion)        force on the slider `on` along its guide, kept apart as it may nearly cancel with inertia

a spring along a guide says besides by ``spring_rate(motion)`` what it takes, over its elongation from `free_position`,
which is then all of its push, and may by ``parted_rate(motion)`` say how much of that no crank angle changes;

from what a `Motion` knows: places and rates, by arithmetic alone. ``VALUE`` names the field that may hold an array over
the crank angles, a `Table` or a function of the motion instead of a number, ``UNIT`` its unit; whoever asks puts what
such a function gives in its place before (`settled`). ``LENGTHS`` names the fields that hold
lengths and angles of the geometry. ``potential(motion)``, of loads that have one, is their potential energy, J; those
that turn to heat what they take, as dampers do, say so by ``DISSIPATES``. ``misplaced(mechanism)`` says what of a
mechanism it names wrongly, ``refusals(motion)`` where it has no value, if it ``REFUSES`` some motion; ``signs(motion)``
how it is drawn. Where it has kinks and jumps, it or its value may declare: see `kinked`.

What loads declare of their kinks and jumps.

A load, or what gives its value (a `Table`, a function of the motion), declares them by

    kinks(motion)               crank angles (K,) of kinks, and (J,) of jumps, rad, in one period of its own (`period`,
                                one turn unless it has that), whatever crank angles the motion has

and may by ``bends(motion, straight)`` and ``is_bent(straight)`` leave out those that bend by less than a share of its
largest value, as `Table` does, for each of many designs its own. What declares none is sampled, and what it does within
two degrees may pass unseen.
"""

from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.paths import Batched
from .table import Table
from .table_pieces import TURN


class Symbol(NamedTuple):
    """How a load is drawn, in the poses of a motion.

    Attributes
    ----------
    kind : "spring", "damper", "line", "force", "couple", "spiral" or "ring"
        A spring, damper or line is drawn between two places, all else at the first.
    start : array (2, N)
    end : array (2, N), optional
        Of a spring on a slider None: beside its guide, from the end of its way.
    direction : array (2, N), optional
        Of a force: unit vector of a positive one.
    slider : str
        That a spring is on.
    sense : array (N,) or float
        Of a force or couple: -1 where it acts against its positive sense.
    """

    kind: str
    start: Any
    end: Any = None
    direction: Any = None
    slider: str = ""
    sense: Any = 1.0


class Load(checks.Checked, Batched):
    """What all loads have in common; see the module."""

    PATH: ClassVar[str] = ""
    VALUE: ClassVar[str] = ""
    UNIT: ClassVar[str] = "N"
    LENGTHS: ClassVar[tuple[str, ...]] = ()
    REFUSES: ClassVar[bool] = False
    DISSIPATES: ClassVar[bool] = False

    @property
    def value_now(self) -> Any:
        """What stands for its force or moment: a number, an array, a table or a function; None if that is fixed."""
        return getattr(self, self.VALUE) if self.VALUE else None

    @property
    def is_given(self):
        """Whether it is numbers, checked when it was made, and no code of the user's."""
        return not callable(self.value_now)

    @property
    def period(self) -> float:
        """Crank angle after which it repeats, rad."""
        return getattr(self.value_now, "period", TURN)

    @property
    def title(self):
        """What messages call it."""
        return type(self).__name__

    def problems(self, mechanism):
        """What is wrong with it, and with its table, on a mechanism, as sentences."""
        table = self.value_now
        if not isinstance(table, Table):
            return [*self.misplaced(mechanism)]
        own = self.UNIT.replace(" ", "*")
        wrong = f"{self.title}: its value is in {own}, but that of its table in {table.unit}"
        return [*self.misplaced(mechanism), *table.problems(mechanism), wrong if table.unit not in ("", own) else None]

    def misplaced(self, mechanism) -> Any:
        """What is wrong with the joints and links that it names."""
        return ()

    def refusals(self, motion) -> Any:
        """Where it has no value, as sentences."""
        return ()

    def signs(self, motion) -> Any:
        """How it is drawn, each as a `Sign`."""
        return ()

    def sense(self, motion) -> Any:
        """Sign of its value in the poses of a motion, 1 or -1.

        Where it is zero or has none, as beyond a table, that of its largest; 1 for a function.
        """
        value = self.value_now
        if isinstance(value, Table):
            known, here = value.largest, _read(value, motion)
        elif value is None or callable(value):
            return 1.0
        else:
            known = np.asarray(value, dtype=float)
            fits = known.ndim == 0 or any(item is self for item in motion.loads)
            known, here = known.flat[np.argmax(np.abs(known))], known if fits else 0.0
        return np.where(here == 0, -1.0 if known < 0 else 1.0, np.sign(here))


def _read(table, motion):
    """Values of a table in the poses of a motion; zero if it has none in one of them."""
    try:
        return table(motion)
    except ParameterError:
        return 0.0


def has_no_user_code(item):
    """Whether a load is numbers, checked when it was made, and no code of the user's."""
    return isinstance(item, Load) and item.is_given


def value_of(item):
    """What stands for the force or moment of a load, also of one of the user's own; None if that is fixed."""
    return item.value_now if isinstance(item, Load) else getattr(item, "force", None)


def depends_on_sense(item):
    """Whether a load declares that it depends on which way the crank turns."""
    return getattr(value_of(item), "by_sense", False)


def refusals(motion):
    """Where loads have no value at the crank angles of a motion, as sentences."""
    return [text for item in motion.loads if may_refuse(item) for text in item.refusals(motion)]


def may_refuse(item):
    """Whether there are motions for which a load has no value."""
    return isinstance(item, Load) and item.REFUSES


def value_rule(unit):
    """Rule of what is a number, an array over the crank angles, a table, or a function of the motion."""
    return checks.OrFunction(checks.Number(unit, table=True))


def kink_sources(loads):
    """Parts of loads that declare kinks: loads themselves, or their values."""
    parts = (part for item in loads for part in (item, value_of(item)))
    return [part for part in parts if hasattr(part, "kinks")]


def kinks_of(part, motion):
    """Crank angles (K,) of kinks and (J,) of jumps that a part declares, brought into its period.

    Raises
    ------
    ParameterError
        It declares something else than two rows of finite crank angles.
    """
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
    """Whether what declares kinks has some that bend by so much."""
    return not hasattr(part, "is_bent") or part.is_bent(straight)


def significant_kinks(part, motion, straight):
    """Crank angles (1 or designs, K), NaN where a design has fewer, which (K,) jump, by what share it bends besides."""
    if hasattr(part, "bends"):
        return part.bends(motion, straight)
    kinks, jumps = kinks_of(part, motion)
    return np.concatenate([kinks, jumps])[None], np.arange(kinks.size + jumps.size) >= kinks.size, 0.0


def period_on(part, mechanism):
    """Crank angle after which what declares kinks repeats on a mechanism, rad."""
    return part.period_on(mechanism) if hasattr(part, "period_on") else getattr(part, "period", TURN)
