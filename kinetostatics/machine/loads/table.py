"""Tables of values for loads: by crank angle, or by the travel of a slider."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import CaseError, ParameterError
from ...numbers import checks
from ...numbers.arithmetic import namespace
from ...numbers.parameter_tree import replace_unchecked
from ...numbers.units import to_si
from ..kinematic_state import require_sense
from . import table_pieces
from .dead_centres import dead_centres
from .table_pieces import TRAVEL_TOLERANCE, TURN, WholeTurns, kink_rows, stops_and_crossings

COLUMNS = {"angle": ("crank_angle", "rad"), "travel": ("travel", "m")}
"""Heading and unit of the first column, by `over`."""
DEAD_CENTRES = ("TDC", "BDC")
"""Names of the far and the near dead centre of a slider from the crank: top and bottom dead centre."""
MAX_AREA = checks.PlausibleRange(5.0, "is it in cm2, or in mm2?")
"""Largest plausible area of a piston, m2: 2.5 m in diameter."""
VALUE_HEADINGS = {"N": "force", "N*m": "torque", "N m": "torque", "Pa": "pressure"}
"""Heading of a column of values, by unit."""
SLIDER_WORDS = 'slider is for a table over="travel", or one with zero="TDC" or "BDC"'


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of a table, in order: arrays (N,); `back` is None where both strokes have the same values."""

    x: Any
    y: Any
    back: Any = None

    TABULATED = True


@dataclass(frozen=True, eq=False, init=False)
class Table:
    """Values for any load: linear between rows by crank angle, or by the travel of a slider.

    It passes through every row, adds no extrema between them, and has a kink at each; a jump is two rows close
    together. Extremes, means, `Solution.at` and sweeps evaluate it at any crank angle; programs differentiate it by the
    travel.

    Parameters
    ----------
    x : array (N,)
        Crank angles of one period, rad; the end of the period may repeat the first row. Or coordinates of the slider's
        pin along its guide (B . guide direction), m. Rising or falling.
    y : array (N,)
        Values in the unit of the load, N or N m; pint quantities fit loads of their dimension only.
    over : "angle" or "travel"
    back : array (N,), optional
        Over travel, the values of the stroke with negative velocity of the slider along its guide: an indicator
        diagram. At the ends of the stroke the value jumps where both differ there.
    period : float
        Crank angle after which a table over the angle repeats, rad: 2 pi or a whole multiple of it.
    slider : str, optional
        Slider whose travel or dead centre is read; by default the slider that the load acts on, or the only one of the
        mechanism.
    zero : float, text or "TDC" or "BDC", optional
        Crank angle at which the table's angle is 0, rad from +x, or text with a unit ("90 deg"); by default 0. "TDC" is
        the dead centre of the slider farther from the crank, "BDC" the nearer one; both follow the lengths. Over a
        period of several turns it is the one between -15 and 345 deg; for a later turn add turns to `x`. Without a
        zero, a `HintWarning` reports a force on a slider whose largest value is far from both dead centres.
    sense : +1 or -1
        Direction in which the table's angle increases: +1 counter-clockwise, as the library's crank angle, -1
        clockwise. Degrees after TDC in the sense of rotation need the sign of the crank speed.

    Raises
    ------
    ParameterError
        Over the angle: fewer than three rows, angles that do not rise, rows over more or less than a period, unequal
        ends. Over travel: fewer than two rows, coordinates that do not rise. When a scene is made: a dead centre, or
        travel, of none or several sliders. When it is solved: the slider leaves the table; it has not one far and one
        near dead centre, or the mechanism does not close all round.

    Notes
    -----
    The attributes `x` and `y` hold rising, counter-clockwise angles, from +x or from the dead centre.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2)
    >>> gas = ks.Table([0.15, 0.2, 0.25], [-900.0, -500.0, -100.0], over="travel", back=[0.0, 0.0, 0.0])
    >>> s = ks.solve(pump, [1.0, 5.0], crank_speed=100.0, loads=ks.ProcessForce(gas))
    >>> [round(float(torque), 3) for torque in s.balancing_torque]
    [0.0, 22.287]

    An indicator diagram in degrees after top dead centre, of an engine that turns clockwise:

    >>> engine = ks.crank_slider(0.05, 0.2, guide_angle=np.pi / 2)
    >>> after_tdc = np.radians([0.0, 15.0, 90.0, 180.0, 270.0])
    >>> gas = ks.Table(after_tdc, [-5e3, -9e3, -1e3, 0.0, -1e3], zero="TDC", sense=-1)
    >>> s = ks.solve(engine, np.pi / 2 - after_tdc[1], crank_speed=-100.0, loads=ks.ProcessForce(gas))
    >>> print(f"{s.reaction('B')[1]:.1f} N")
    9000.0 N
    """

    rows: Any = field(repr=False)
    over: str = "angle"
    slider: Any = None
    period: float = field(default=TURN, metadata={"structural": True})
    unit: str = field(default="", metadata={"structural": True})
    zero: Any = field(default=None, metadata={"structural": True})
    sense: int = field(default=1, metadata={"structural": True})

    RULES = checks.Rules("table")

    def __init__(self, x, y, over="angle", back=None, period=TURN, slider=None, zero=None, sense=1):
        given = {"x": x, "y": y} | ({} if back is None else {"back": back})
        unit = table_pieces.unit_of(y) or table_pieces.unit_of(back)
        units = dict.fromkeys(given, unit or "N") | {"x": "m" if over == "travel" else "rad"}
        period, wrong_period = WholeTurns().check(period, "period")
        sense, wrong_sense = checks.Sign().check(sense, "sense")
        zero, wrong_zero = _angle_or_dead_centre(zero)
        by_angle = None if over == "angle" else 'is for a table over="angle"'
        found = checks.check_values(
            "table",
            {name: checks.Number(unit, table=True) for name, unit in units.items()},
            given,
            checks.choice("over", over, tuple(COLUMNS)),
            wrong_period,
            None if slider is None else checks.Name().check(slider, "slider")[1],
            None if back is None or over == "travel" else 'back is for a table over="travel"',
            None if slider is None or over == "travel" or isinstance(zero, str) else SLIDER_WORDS,
            wrong_zero or (zero is not None and by_angle and f"zero {by_angle}") or None,
            wrong_sense or (sense == -1 and by_angle and f"sense {by_angle}") or None,
        )
        try:
            arrays = {name: np.array(values, dtype=float) for name, values in found.items()}
        except TypeError as error:
            raise ParameterError(
                "table: its rows have no values yet, as under jax.jit or jax.grad. Give plain numbers, and let JAX "
                "trace crank angles and numbers of the mechanism; tables have no derivatives by their rows"
            ) from error
        shapes = {values.shape for values in arrays.values()}
        fits = len(shapes) == 1 and arrays["x"].ndim == 1
        checks.require("table", None if fits else f"{' and '.join(arrays)} must be 1-D, of one length")
        checks.require("table", table_pieces.order_problem(arrays["x"], over))
        if arrays["x"][0] > arrays["x"][-1]:
            arrays = {name: values[::-1] for name, values in arrays.items()}
        if over == "angle":
            checks.require("table", table_pieces.angle_problem(arrays["x"], arrays["y"], period))
            if table_pieces.repeats_first_row(arrays["x"], period):
                arrays = {name: values[:-1] for name, values in arrays.items()}
            if sense == -1:
                arrays = {"x": -arrays["x"][::-1], "y": arrays["y"][::-1]}
            if isinstance(zero, float):
                arrays["x"], zero, sense = arrays["x"] + zero, 0.0, 1
        else:
            few = "at least 2 rows are needed, got 1; a value that does not change is no table"
            short = None if period == TURN else "over travel the period is one turn"
            checks.require("table", few if arrays["x"].size < 2 else None, short)
        for values in arrays.values():
            values.setflags(write=False)
        vars(self).update(
            rows=Rows(**arrays), over=over, slider=slider, period=period, unit=unit, zero=zero, sense=sense
        )

    @classmethod
    def from_csv(cls, path, unit="N", area=None, period=TURN, slider=None, over=None, zero=None, sense=1) -> "Table":
        """Read a table with two or three columns, each headed by its name and a unit that converts.

        Parameters
        ----------
        path : path
            First column ``crank_angle [deg]`` or ``travel [mm]``; then ``force [kN]``, ``torque [N m]``, or with an
            `area` ``pressure [bar]``; over travel the same for the stroke back, if any, headed ``force_back [kN]``
            and so on. Before the heading there may be lines of comment that begin with ``#``.
        unit : "N" or "N m"
            Of the load.
        area : float, optional
            Piston area, m2, that turns pressures into forces along the guide; negative if they push against its
            direction.
        period, slider, zero, sense
            As of the table.
        over : "angle" or "travel", optional
            Column to read if the file has both; by default the travel.

        Raises
        ------
        CaseError
            The file cannot be read, or its rows make no table.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> diagram = ks.shipped_cases()["compressor"].parent / "compressor_indicator.csv"  # travel [mm] ...
        >>> pressure = ks.ProcessForce(ks.Table.from_csv(diagram, area=-20e-4))
        >>> pump = ks.crank_slider(0.05, 0.198, slider=ks.Link(1.2))
        >>> s = ks.solve(pump, 0.1, crank_speed=100.0, loads=[pressure])
        >>> round(float(s.balancing_torque), 1)
        1.5
        """
        from ...numbers.files import headings, read_columns

        problems = (
            checks.choice("unit", unit, ("N", "N*m", "N m")),
            None if over is None else checks.choice("over", over, tuple(COLUMNS)),
            "area makes forces of pressures, but this load is a torque" if area is not None and unit != "N" else None,
        )
        number = {} if area is None else {"area": (area, "m**2", {"usual": MAX_AREA})}
        area = checks.single_numbers("table", *problems, **number).get("area")
        names = [name for name, _ in headings(path)]
        if area is None and "pressure" in names and VALUE_HEADINGS[unit] not in names:
            raise CaseError(path, ["no column 'force', but pressures; give the area that they act on, as area"])
        over = over or ("travel" if COLUMNS["travel"][0] in names else "angle")
        column, own = COLUMNS[over]
        of = unit.replace(" ", "*") if area is None else "Pa"
        value = VALUE_HEADINGS[of]
        back = over == "travel" and f"{value}_back" in names
        if problem := table_pieces.unread_column_problem(names, value, over):
            raise CaseError(path, [problem])
        x, *values = read_columns(path, {column: own, value: of} | ({f"{value}_back": of} if back else {}))
        y, back, *_ = *(part if area is None else area * part for part in values), None
        try:
            return replace_unchecked(cls(x, y, over, back, period, slider, zero, sense), unit=unit.replace(" ", "*"))
        except ParameterError as error:
            raise CaseError(path, [str(error)]) from None

    @property
    def x(self):
        """Counter-clockwise angles from +x or from the dead centre `zero`, rad, or coordinates along the guide, m."""
        return self.rows.x

    @property
    def y(self):
        """Values in the unit of the load."""
        return self.rows.y

    @property
    def back(self):
        """Values of the stroke with negative velocity; None if both strokes have the same values."""
        return self.rows.back

    @property
    def strokes(self):
        """Values of each stroke, a list of one or two arrays."""
        return [self.y] if self.back is None else [self.y, self.back]

    @property
    def largest(self):
        """Value of largest magnitude, with its sign."""
        values = np.concatenate(self.strokes)
        return float(values[np.argmax(np.abs(values))])

    @property
    def from_dead_centre(self):
        """Whether its angles count from a dead centre of a slider."""
        return isinstance(self.zero, str)

    @property
    def needs_slider(self):
        """Whether it reads the travel or a dead centre of a slider."""
        return self.over == "travel" or self.from_dead_centre

    def of(self, slider):
        """The table with this slider, if it needs one and names none."""
        return replace_unchecked(self, slider=slider) if self.needs_slider and self.slider is None else self

    def problems(self, mechanism):
        """Problems of the table on a mechanism, as sentences."""
        if not self.needs_slider:
            return
        sliders, title = tuple(mechanism.guides), f"table {'from its ' + self.zero if self.zero else 'over travel'}"
        if self.slider is not None:
            yield checks.choice(f"{title}: slider", self.slider, sliders)
        elif len(sliders) != 1:
            there = f"sliders {', '.join(map(repr, sliders))}: choose one, slider=..." if sliders else "no slider"
            yield f"{title}: the mechanism has {there}"

    def __call__(self, motion):
        return self.read(motion, self.pieces(motion))

    def place(self, motion):
        """Crank angle or angle from the dead centre, rad, or travel of the slider, m, at which it is read."""
        if self.over == "travel":
            return motion.travel(self._slider(motion))
        return motion.crank_angle - self.zero_angle(motion) if self.from_dead_centre else motion.crank_angle

    def zero_angle(self, motion):
        """Crank angle of the dead centre from which its angles count, rad; `ParameterError` where there is none."""
        angle = dead_centres(motion, self._slider(motion))[0][DEAD_CENTRES.index(self.zero)]
        if np.any(missing := np.isnan(angle)):
            raise ParameterError(
                f"table from {self.zero}: {motion.mechanism.name} does not close at all crank angles, so "
                f"{self._slider(motion)!r} has no {self.zero}; give its zero as an angle",
                np.ravel(missing) if np.ndim(angle) else None,
            )
        return angle

    def read(self, motion, pieces, zero=None):
        """Values at a motion, (..., N), from its `pieces`; `zero` is the angle of the dead centre if it is known."""
        start, value, slope = pieces
        if self.over == "travel":
            beyond = motion.elongation(start, self._slider(motion))
        else:
            beyond = (self.place(motion) if zero is None else motion.crank_angle - zero) - start
        return value + slope * beyond

    def _slider(self, motion):
        return self.slider or next(iter(motion.mechanism.guides))

    def pieces(self, motion, number=lambda given: given):
        """Start of the piece read at each crank angle, the value there, and its slope.

        `number` converts floats and arrays to another kind of numbers.

        Raises
        ------
        ParameterError
            The travel leaves the table. While JAX traces, values outside are NaN instead.
        """
        place = self.place(motion)
        returning = None if self.back is None else self.returns(motion)
        try:
            xp, place = np, np.asarray(place, dtype=float)
            returning = returning if returning is None else np.asarray(returning)
        except (TypeError, ValueError):  # while JAX traces
            xp = next(xp for xp in map(namespace, (place, returning)) if xp is not np)
        if self.over == "angle":
            turns = xp.floor((place - self.x[0]) / self.period)
            piece = table_pieces.piece_index(xp, self.closed()[0], place - turns * self.period)
            start, value, slope = table_pieces.piece_lines(xp, *self.closed(number), piece)
            return start + number(turns) * number(self.period), value, slope
        piece = table_pieces.piece_index(xp, self.x, place)
        start, value, slope = table_pieces.piece_lines(xp, *self.closed(number), piece, returning)
        room = TRAVEL_TOLERANCE * (self.x[-1] - self.x[0])
        out = (place < self.x[0] - room) | (place > self.x[-1] + room)
        if xp is not np:
            return start, xp.where(out, xp.nan, value), slope
        if out.any():
            angle = np.degrees(np.broadcast_to(motion.crank_angle, out.shape)[out])
            raise ParameterError(
                f"table over travel: the slider goes from {np.nanmin(place):.9g} to {np.nanmax(place):.9g} m, but the "
                f"table from {self.x[0]:.9g} to {self.x[-1]:.9g} m. Beyond it at {angle.size} crank angles, the first "
                f"{angle[0]:.6g} deg. Travel is the coordinate of the pin along the guide (solution.slider_position)",
                out.any(axis=-1) if out.ndim > 1 else None,
            )
        if self.by_sense:
            require_sense("table over travel: it has other values for the stroke back", motion)
        return start, value, slope

    def closed(self, number=lambda given: given) -> tuple[Any, Any]:
        """Rows and the values of each stroke; over the angle the first row stands again a period behind."""
        x, strokes = number(self.x), [number(y) for y in self.strokes]
        if self.over == "travel":
            return x, strokes
        return np.append(x, x[0] + number(self.period)), [np.append(y, y[0]) for y in strokes]

    def rate(self, motion):
        """First kinematic coefficient of the slider along its guide, m/rad."""
        return motion.placement.travels[self._slider(motion)].first

    @property
    def by_sense(self):
        """Whether its values depend on the sense of rotation of the crank."""
        return self.back is not None

    def returns(self, motion):
        """Whether the slider moves, or is about to move, with negative velocity."""
        return motion.crank_sense * self.rate(motion) < 0

    def period_on(self, mechanism):
        """Period on a mechanism, rad; over travel the period of the motion."""
        return self.period if self.over == "angle" else TURN * mechanism.turns

    def kinks(self, motion):
        """Crank angles of its kinks, (K,), and jumps, (J,), in its period, rad; ends of strokes are among the kinks."""
        if self.over == "angle":
            zero = self.zero_angle(motion) if self.from_dead_centre else 0.0
            return np.ravel(np.mod(self.x + zero, self.period)), np.empty(0)
        ends, passed = (part[~np.isnan(part)] for part in stops_and_crossings(motion, self._slider(motion), self.x))
        return np.concatenate([ends, passed]), ends if self.back is not None else np.empty(0)

    def is_bent(self, straight):
        """Whether it kinks by more than `straight` times its largest value, or may jump at ends of strokes."""
        return straight == 0.0 or self.back is not None or kink_rows(self, straight).size > 0

    def bends(self, motion, straight):
        """Crank angles of kinks larger than `straight` times its largest value, (1 or designs, K), rad, NaN-padded.

        Also which of them are jumps, (K,), and the largest kink left out, relative to its largest value.
        """
        rows, by_angle = kink_rows(self, straight), self.over == "angle"
        inner = self.x[rows]
        x, strokes = self.closed()
        if by_angle:
            x, strokes = np.append(self.x[-1] - self.period, x), [np.append(self.y[-1], y) for y in strokes]
        share = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
        off = np.abs([y[1:-1] - y[:-2] - share * (y[2:] - y[:-2]) for y in strokes]).max(axis=0)
        ignored = np.delete(off if by_angle else np.pad(off, 1), rows)
        rest = float(ignored.max(initial=0.0) / (abs(self.largest) or 1.0))
        if by_angle:
            if self.from_dead_centre:
                inner = inner + dead_centres(motion, self._slider(motion))[0][DEAD_CENTRES.index(self.zero)]
            return np.atleast_2d(np.mod(inner, self.period)), np.zeros(rows.size, dtype=bool), rest
        ends, found = stops_and_crossings(motion, self._slider(motion), inner)
        jumps = ends.shape[1] if self.by_sense else 0
        found = np.column_stack([ends[:, :jumps], found])
        return found, np.arange(found.shape[1]) < jumps, rest

    @property
    def _content(self):
        arrays = (part if part is None else part.tobytes() for part in (self.x, self.y, self.back))
        return *arrays, self.over, self.slider, self.period, self.unit, self.zero, self.sense

    def __eq__(self, other):
        return self._content == other._content if isinstance(other, Table) else NotImplemented

    def __hash__(self):
        return hash(self._content)


def _angle_or_dead_centre(zero):
    """The zero of a table over the angle, rad, or the name of a dead centre, and its problem or None."""
    if zero is None or (isinstance(zero, str) and zero in DEAD_CENTRES):
        return zero, None
    if isinstance(zero, str):
        try:
            return to_si(zero, "rad"), None
        except ValueError as error:
            return zero, f"zero {error}; or write {' or '.join(map(repr, DEAD_CENTRES))}"
    found, problem = checks.Number("rad").check(zero, "zero")
    return found, problem or (None if isinstance(found, float) else "zero must be one angle, not an array")
