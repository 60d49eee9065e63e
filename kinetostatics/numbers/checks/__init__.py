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
    BYTES_PER_ANGLE,
    MAX_TABLE_MEMORY,
    Problem,
    broadcast_problem,
    case,
    choice,
    count,
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
    UNDECIDED,
    Checked,
    HasMembers,
    InstanceOf,
    Name,
    Number,
    Optional,
    OrFunction,
    Pair,
    PlausibleRange,
    Rules,
    Series,
    Sign,
    check_values,
    implausibility,
    plausible_range_of,
    single_number,
    single_numbers,
)
from .values import DimensionError, has_known_values, is_quantity, not_a_number, snapshot, to_plain, to_plain_named

__all__ = [
    "BYTES_PER_ANGLE",
    "MAX_TABLE_MEMORY",
    "UNDECIDED",
    "Checked",
    "DimensionError",
    "InstanceOf",
    "Name",
    "Number",
    "Optional",
    "OrFunction",
    "HasMembers",
    "Pair",
    "Problem",
    "Rules",
    "Series",
    "Sign",
    "PlausibleRange",
    "case",
    "choice",
    "to_plain_named",
    "count",
    "check_values",
    "broadcast_problem",
    "hint",
    "is_quantity",
    "snapshot",
    "has_known_values",
    "mapping",
    "mechanism",
    "names",
    "nearest",
    "to_plain",
    "quantity",
    "require",
    "seed",
    "shown",
    "single_number",
    "single_numbers",
    "solution",
    "truth",
    "not_a_number",
    "implausibility",
    "plausible_range_of",
]
