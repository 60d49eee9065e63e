"""Checks of the values a user hands in. Kernels trust what has passed here.

measured
    Quantities of pint, converted to the unit wanted.
values
    What a value is: a number, an array, a truth value, a text ...; copies that nobody writes to.
meant
    Which of the allowed words is meant by another: synonyms, and what is spelled alike.
problems
    What is wrong, as sentences, and the one `ParameterError` that lists them: ``require(owner, *problems)``.
single
    Single numbers, where no arrays of designs are taken.
rules
    What a value must be: `Number`, `Pair`, `Name` ...
usual
    What is beyond the sizes that a number usually has looks like a slip of units, and is asked about.
checked
    `Checked` dataclasses, whose fields keep to a table of `Rules`.

A dataclass that is `Checked` says what its fields must be by a table of rules, field -> rule. Where every value is a
plain number in range nothing more is looked at; otherwise each is examined, all that is wrong is said at once, and the
object keeps floats and locked copies of arrays, so nothing it holds changes behind its back. A traced JAX number or an
`arb` enclosure passes as it is.
"""

from .messages import (
    ANGLE,
    MEMORY,
    Problem,
    case,
    choice,
    count,
    fitting,
    hint,
    mapping,
    mechanism,
    names,
    nearest,
    quantity,
    require,
    seed,
    shown,
    solution,
    truth,
)
from .rules import (
    UNSURE,
    Checked,
    Made,
    Name,
    Number,
    Optional,
    OrFunction,
    Own,
    Pair,
    Rules,
    Series,
    Sign,
    Usual,
    examined,
    single,
    singles,
    unusual,
    usual_of,
)
from .values import DimensionError, converted, is_quantity, kept, known, plain, unfit

__all__ = [
    "ANGLE",
    "MEMORY",
    "UNSURE",
    "Checked",
    "DimensionError",
    "Made",
    "Name",
    "Number",
    "Optional",
    "OrFunction",
    "Own",
    "Pair",
    "Problem",
    "Rules",
    "Series",
    "Sign",
    "Usual",
    "case",
    "choice",
    "converted",
    "count",
    "examined",
    "fitting",
    "hint",
    "is_quantity",
    "kept",
    "known",
    "mapping",
    "mechanism",
    "names",
    "nearest",
    "plain",
    "quantity",
    "require",
    "seed",
    "shown",
    "single",
    "singles",
    "solution",
    "truth",
    "unfit",
    "unusual",
    "usual_of",
]
