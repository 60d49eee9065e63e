"""Errors and warnings of the library; every error is a `KinetostaticsError`."""


class KinetostaticsError(Exception):
    """Base of all errors of the library; it can be copied and pickled.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> try:
    ...     ks.crank_slider(0.3, -2.0)
    ... except ks.KinetostaticsError as error:
    ...     print(type(error).__name__, "-", error)
    ParameterError - slider group: coupler length must be greater than 0, got -2.0
    """

    def __reduce__(self):
        return _restored, (type(self), self.args, vars(self))


def _restored(kind, arguments, state):
    """Error with the message and attributes of a pickled one, without a call of its constructor."""
    error = kind.__new__(kind, *arguments)
    vars(error).update(state)
    return error


class ParameterError(KinetostaticsError, ValueError):
    """An input is impossible, such as a negative mass; the message lists all impossible inputs.

    Attributes
    ----------
    designs : array of bool or None
        True for each design of a batch that has the fault; None: all have it.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> try:
    ...     ks.Link(mass=-1.0, inertia=-2.0)
    ... except ks.ParameterError as error:
    ...     print(error)
    Link: mass must be at least 0, got -1.0; inertia must be at least 0, got -2.0
    """

    def __init__(self, message, designs=None):
        super().__init__(message)
        self.designs = designs


class AssemblyError(KinetostaticsError, ValueError):
    """The mechanism cannot be put together at some crank angles.

    Attributes
    ----------
    intervals : tuple of (float, float)
        Crank-angle intervals, rad, in which the mechanism does not close. The start lies in [0, 2 pi); an interval
        through 0 ends beyond 2 pi.
    condition : str
        Violated condition, without the advice.

    Examples
    --------
    The coupler is too short to reach the guide at all crank angles.

    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> short = ks.crank_slider(0.3, 0.35, guide=ks.Guide.at(0.0, 0.1))
    >>> try:
    ...     ks.solve(short, np.radians([0.0, 270.0]), crank_speed=10.0)
    ... except ks.AssemblyError as error:
    ...     print([tuple(round(float(np.degrees(angle)), 3) for angle in interval) for interval in error.intervals])
    [(236.443, 303.557)]
    """

    def __init__(self, condition, intervals=(), remedy=', or pass on_gap="nan" to get NaN there and the rest exact'):
        super().__init__(f"{condition}. Change the lengths{remedy}")
        self.condition = condition
        self.intervals = tuple(intervals)


class JammingError(KinetostaticsError, ValueError):
    """Friction jams the mechanism at some crank angles, or its forces are not unique.

    The condition is exact for one guide or pin with friction. For several joints of a group it is sufficient: friction
    is refused above the bound up to which the forces are unique for all loads and directions of motion.

    Attributes
    ----------
    angles : tuple of float
        Requested crank angles at which friction jams, rad.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 0.6, slider=ks.Link(600))
    >>> try:
    ...     ks.solve(saw, 1.5, crank_speed=30.0, friction={"guide": ks.GuideFriction(2.0)}).balancing_torque
    ... except ks.JammingError as error:
    ...     print(error.angles)
    (1.5,)
    """

    def __init__(self, message, angles=()):
        super().__init__(message)
        self.angles = tuple(angles)


class DriveError(KinetostaticsError, ValueError):
    """The machine cannot run: its motor is too weak, it does not start, nothing determines its speed ...

    Attributes
    ----------
    missing : float
        Missing torque on the crank, N m; NaN for other faults.
    crank_angle : float
        Crank angle of the fault, rad; NaN if it has none.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 1.0, loads=[ks.Gravity(), ks.ProcessForce(9e3)])
    >>> try:
    ...     ks.drive.start(saw, ks.drive.Motor.linear(500.0, 50.0), 1000.0, from_angle=1.57)
    ... except ks.DriveError as error:
    ...     print(round(error.missing))
    2200
    """

    def __init__(self, message, missing=float("nan"), crank_angle=float("nan")):
        super().__init__(message)
        self.missing = missing
        self.crank_angle = crank_angle


class DesignError(KinetostaticsError, ValueError):
    """No machine meets the limits of a design; the message gives the reason and the nearest machine.

    Attributes
    ----------
    values : dict of path to float, or None
        Numbers of the nearest machine after a search.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5, loads=[ks.Gravity()])
    >>> try:
    ...     ks.design.optimise(
    ...         saw,
    ...         vary={"crank_length": (0.2, 0.4)},
    ...         minimise="mean_absolute balancing_torque",
    ...         limits=["largest O <= 1 kN"],
    ...     )
    ... except ks.DesignError as error:
    ...     print(str(error).partition(",")[0])
    no design that keeps all limits was found by the search; the nearest misses largest O <= 1000 N
    """

    def __init__(self, message, values=None):
        super().__init__(message)
        self.values = values


class QuantityError(KinetostaticsError, AttributeError, KeyError):
    """A joint, link or quantity is unknown; the message lists those of the mechanism.

    It is a `KeyError` too, for ``s[name]``, ``s.ground[place]`` and other tables by name.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.crank_slider(0.3, 2.0), 0.0, crank_speed=1.0)
    >>> try:
    ...     s.reaction("C")
    ... except ks.QuantityError as error:
    ...     print(error)
    crank-slider: reaction is 'C', allowed: 'A', 'B', 'guide', 'O'
    """

    __str__ = Exception.__str__


class NotGivenError(KinetostaticsError):
    """A method cannot compute this quantity of this mechanism; the message gives the reason.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.scotch_yoke(0.1), 10.0).solve(8)
    >>> try:
    ...     ks.papers.by_the_papers(s)
    ... except ks.NotGivenError as error:
    ...     print(error)
    no study has formulas for the groups, or this cam, of Scotch yoke
    """


class MissingLibraryError(KinetostaticsError, ImportError):
    """An optional library is not installed; the message gives the command.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> isinstance(ks.MissingLibraryError('numba is not installed: pip install "kinetostatics[fast]"'), ImportError)
    True
    """


class FileError(KinetostaticsError, OSError):
    """A result cannot be written to this file; the message gives the reason.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> try:
    ...     ks.cams.Circle(0.3).export("cam.pdf", roller_radius=0.05)
    ... except ks.FileError as error:
    ...     print(error)
    cam.pdf: the ending is '.pdf', allowed: '.csv', '.dxf', '.svg'; did you mean '.dxf'?
    """


class CaseError(KinetostaticsError, ValueError):
    """A case file cannot be used; the message lists every problem with file and key.

    Attributes
    ----------
    problems : tuple of str
        One line for each problem.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> try:
    ...     ks.load_case("sawframe")
    ... except ks.CaseError as error:
    ...     print(len(error.problems))
    1
    """

    def __init__(self, path, problems):
        self.path = path
        self.problems = tuple(problems)
        count = "1 problem" if len(self.problems) == 1 else f"{len(self.problems)} problems"
        super().__init__("\n".join([f"{path}: {count}", *(f"  {problem}" for problem in self.problems)]))


class HintWarning(UserWarning):
    """An input looks like a mistake, for instance of units; it is used as given.

    Examples
    --------
    >>> import warnings
    >>> import kinetostatics as ks
    >>> with warnings.catch_warnings(record=True) as found:
    ...     warnings.simplefilter("always")
    ...     s = ks.solve(ks.crank_slider(0.3, 2.0), [0.0, 90.0, 180.0, 270.0], crank_speed=1.0)
    >>> print(found[0].message)
    crank-slider: crank angles from 0 to 270 by 90 look like degrees; they are used as radians
    """

    def __str__(self):
        return ": ".join(map(str, self.args))

    @property
    def hint(self):
        """Text without the file, mechanism or function before it."""
        return self.args[-1]


class ConditionWarning(UserWarning):
    """The result is correct for the given numbers, but very sensitive to them.

    Examples
    --------
    Crank and coupler of equal length fold at 90 degrees, where the slider may also stay at O.

    >>> import warnings
    >>> import kinetostatics as ks
    >>> with warnings.catch_warnings(record=True) as found:
    ...     warnings.simplefilter("always")
    ...     s = ks.solve(ks.crank_slider(0.3, 0.3), 1.5707963, crank_speed=1.0)
    >>> print(str(found[0].message).partition(": errors")[0])
    crank-slider: at crank angle 89.9999985 deg it is near a limit position or change point
    """


class CacheWarning(UserWarning):
    """Machine code or results on disk cannot be used and are computed again; results are right.

    Examples
    --------
    >>> import warnings
    >>> import kinetostatics as ks
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", ks.CacheWarning)  # rather stop than compile anew each time
    ...     s = ks.Scene(ks.crank_slider(0.3, 2.0), 33.5).solve(360)
    """
