"""The errors a user may meet; all are `KinetostaticsError`."""


class KinetostaticsError(Exception):
    """Any fault the library reports on purpose; it can be copied, and sent from one process to another."""

    def __reduce__(self):
        return _restored, (type(self), self.args, vars(self))


def _restored(kind, arguments, state):
    """An error with its message and attributes as they were, whatever its constructor takes."""
    error = kind.__new__(kind, *arguments)
    vars(error).update(state)
    return error


class ParameterError(KinetostaticsError, ValueError):
    """A length, mass, stiffness, angle ... that no machine can have; the message lists every one found.

    Attributes
    ----------
    designs : array of bool or None
        Which designs of a batch it is about, None if all.
    """

    def __init__(self, message, designs=None):
        super().__init__(message)
        self.designs = designs


class AssemblyError(KinetostaticsError, ValueError):
    """The mechanism cannot be put together at some crank angles.

    Attributes
    ----------
    intervals : tuple of (float, float)
        Crank-angle intervals within one turn, in radians, where it does not close. The start lies in [0, 2 pi);
        an interval that runs through 0 ends beyond 2 pi.
    condition : str
        What does not hold, without the advice.
    """

    def __init__(self, condition, intervals=(), remedy=', or pass on_gap="nan" to get NaN there and the rest exact'):
        super().__init__(f"{condition}. Change the lengths{remedy}")
        self.condition = condition
        self.intervals = tuple(intervals)


class JammingError(KinetostaticsError, ValueError):
    """Friction holds the mechanism at some crank angles, or leaves more than one state of its forces.

    Of a guide or pin that rubs alone this is exact. Of several joints of a group it may be so: friction is refused from
    the bound on up to which there is surely one state of forces, whatever loads and senses of motion are.

    Attributes
    ----------
    angles : tuple of float
        Crank angles among those asked for, rad.
    """

    def __init__(self, message, angles=()):
        super().__init__(message)
        self.angles = tuple(angles)


class DriveError(KinetostaticsError, ValueError):
    """The machine cannot run as asked: its motor is too weak, it does not start, nothing sets its speed ...

    Attributes
    ----------
    missing : float
        Torque on the crank that is missing, N m; NaN where that is not what is wrong.
    crank_angle : float
        Where, rad; NaN where it has no place.
    """

    def __init__(self, message, missing=float("nan"), crank_angle=float("nan")):
        super().__init__(message)
        self.missing = missing
        self.crank_angle = crank_angle


class DesignError(KinetostaticsError, ValueError):
    """No machine meets what is asked of a design; the message says why, and how near the best one comes.

    Attributes
    ----------
    values : dict of path to float, or None
        Numbers of the nearest one, where a search was made.
    """

    def __init__(self, message, values=None):
        super().__init__(message)
        self.values = values


class QuantityError(KinetostaticsError, AttributeError):
    """The mechanism has no such joint, link or quantity; the message lists those it has."""


class NotGivenError(KinetostaticsError):
    """A method cannot give this quantity of this mechanism; the message says why."""


class MissingLibraryError(KinetostaticsError, ImportError):
    """A library of an extra is not installed; the message says how to install it."""


class FileError(KinetostaticsError, OSError):
    """A result cannot be written to this file; the message says why."""


class CaseError(KinetostaticsError, ValueError):
    """A case file cannot be used; the message lists every problem with file and key.

    Attributes
    ----------
    problems : tuple of str
        One line for each problem.
    """

    def __init__(self, path, problems):
        self.path = path
        self.problems = tuple(problems)
        count = "1 problem" if len(self.problems) == 1 else f"{len(self.problems)} problems"
        super().__init__("\n".join([f"{path}: {count}", *(f"  {problem}" for problem in self.problems)]))


class HintWarning(UserWarning):
    """Something looks like a slip, of units for instance; what was asked for is computed all the same."""


class ConditionWarning(UserWarning):
    """The result is right for the numbers given, but small changes of them change it much."""


class CacheWarning(UserWarning):
    """Results are right, but machine code or finished parts on disk could not be used, and are made anew."""
