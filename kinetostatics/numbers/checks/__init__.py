"""Checks of a user's values: kernels trust a value that has passed here. It may import errors and numbers.

``rules`` define valid values, ``values`` recognise and convert values, ``messages`` describe the faults. A `Checked`
dataclass declares a table of rules, field -> rule. All faults of an item are reported in one `ParameterError`. The item
keeps floats and read-only copies of arrays; traced JAX numbers and `arb` enclosures pass unchanged.
"""
# ruff: noqa: F401  the names of this folder that others use

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
    PLAUSIBLE_BY_UNIT,
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
    Truth,
    Word,
    check_values,
    implausibility,
    plausible_range_of,
    single_number,
    single_numbers,
)
from .values import DimensionError, has_known_values, is_quantity, not_a_number, snapshot, to_plain, to_plain_named
