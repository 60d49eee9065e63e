"""Tables of values for loads: by crank angle, or by the travel of a slider."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import CaseError, ParameterError
from ...numbers import checks
from ...numbers.arithmetic import namespace
from ...numbers.parameter_tree import replace_unchecked
from ..kinematic_state import require_sense
from . import table_pieces
from .table_pieces import TRAVEL_TOLERANCE, TURN, WholeTurns, kink_rows, stops_and_crossings

COLUMNS = {"angle": ("crank_angle", "rad"), "travel": ("travel", "m")}
"""Heading and unit of the first column, by `over`."""
MAX_AREA = checks.PlausibleRange(5.0, "is it in cm2, or in mm2?")
"""Largest plausible area of a piston, m2: 2.5 m in diameter."""
VALUE_HEADINGS = {"N": "force", "N*m": "torque", "N m": "torque", "Pa": "pressure"}
"""Heading of a column of values, by unit."""


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
        Slider whose travel is read; by default the slider that the load acts on, or the only one of the mechanism.

    Raises
    ------
    ParameterError
        Over the angle: fewer than three rows, angles that do not rise, rows over more or less than a period, unequal
        ends; over travel: fewer than two rows, coordinates that do not rise. When a scene is solved: the slider leaves
        the table.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2)
    >>> gas = ks.Table([0.15, 0.2, 0.25], [-900.0, -500.0, -100.0], over="travel", back=[0.0, 0.0, 0.0])
    >>> s = ks.solve(pump, [1.0, 5.0], crank_speed=100.0, loads=ks.ProcessForce(gas))
    >>> [round(float(torque), 3) for torque in s.balancing_torque]
    [0.0, 22.287]
    """

    rows: Any = field(repr=False)
    over: str = "angle"
    slider: Any = None
    period: float = field(default=TURN, metadata={"structural": True})
    unit: str = field(default="", metadata={"structural": True})

    RULES = checks.Rules("table")

    def __init__(self, x, y, over="angle", back=None, period=TURN, slider=None):
        given = {"x": x, "y": y} | ({} if back is None else {"back": back})
        unit = table_pieces.unit_of(y) or table_pieces.unit_of(back)
        units = dict.fromkeys(given, unit or "N") | {"x": "m" if over == "travel" else "rad"}
        period, wrong_period = WholeTurns().check(period, "period")
        found = checks.check_values(
            "table",
            {name: checks.Number(unit, table=True) for name, unit in units.items()},
            given,
            checks.choice("over", over, tuple(COLUMNS)),
            wrong_period,
            None if slider is None else checks.Name().check(slider, "slider")[1],
            None if back is None or over == "travel" else 'back is for a table over="travel"',
            None if slider is None or over == "travel" else 'slider is for a table over="travel"',
        )
        try:
            arrays = {name: np.array(values, dtype=float) for name, values in found.items()}
        except TypeError as error:
            raise ParameterError(
                "table: its rows have no values yet, as under jax.jit or jax.grad: give plain numbers, and let JAX "
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
        else:
            few = "at least 2 rows are needed, got 1; a value that does not change is no table"
            short = None if period == TURN else "over travel the period is one turn"
            checks.require("table", few if arrays["x"].size < 2 else None, short)
        for values in arrays.values():
            values.setflags(write=False)
        vars(self).update(rows=Rows(**arrays), over=over, slider=slider, period=period, unit=unit)

    @classmethod
    def from_csv(cls, path, unit="N", area=None, period=TURN, slider=None, over=None):
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
        period, slider
            As of the table.
        over : "angle" or "travel", optional
            Column to read if the file has both; by default the travel.

        Returns
        -------
        Table

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
            return replace_unchecked(cls(x, y, over, back, period, slider), unit=unit.replace(" ", "*"))
        except ParameterError as error:
            raise CaseError(path, [str(error)]) from None

    @property
    def x(self):
        """Crank angles, rad, or coordinates along the guide, m."""
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

    def of(self, slider):
        """The table with this slider, if it is over travel and names none."""
        return self if self.over == "angle" or self.slider is not None else replace_unchecked(self, slider=slider)

    def problems(self, mechanism):
        """Problems of the table on a mechanism, as sentences."""
        if self.over == "angle":
            return
        sliders = tuple(mechanism.guides)
        if self.slider is not None:
            yield checks.choice("table over travel: slider", self.slider, sliders)
        elif len(sliders) != 1:
            there = f"sliders {', '.join(map(repr, sliders))}: say which, slider=..." if sliders else "no slider"
            yield f"table over travel: the mechanism has {there}"

    def __call__(self, motion):
        return self.read(motion, self.pieces(motion))

    def place(self, motion):
        """Crank angle, rad, or travel of the slider, m, at which it is read."""
        return motion.crank_angle if self.over == "angle" else motion.travel(self._slider(motion))

    def read(self, motion, pieces):
        """Values at a motion, (..., N), from its `pieces`."""
        start, value, slope = pieces
        is_angle = self.over == "angle"
        beyond = motion.crank_angle - start if is_angle else motion.elongation(start, self._slider(motion))
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
                f"table from {self.x[0]:.9g} to {self.x[-1]:.9g} m; beyond it at {angle.size} crank angles, the first "
                f"{angle[0]:.6g} deg; travel is the coordinate of the pin along the guide (solution.slider_position)",
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
            return np.mod(self.x, self.period), np.empty(0)
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
            return np.mod(inner, self.period)[None], np.zeros(inner.size, dtype=bool), rest
        ends, found = stops_and_crossings(motion, self._slider(motion), inner)
        jumps = ends.shape[1] if self.by_sense else 0
        found = np.column_stack([ends[:, :jumps], found])
        return found, np.arange(found.shape[1]) < jumps, rest

    @property
    def _content(self):
        arrays = (part if part is None else part.tobytes() for part in (self.x, self.y, self.back))
        return *arrays, self.over, self.slider, self.period, self.unit

    def __eq__(self, other):
        return self._content == other._content if isinstance(other, Table) else NotImplemented

    def __hash__(self):
        return hash(self._content)
