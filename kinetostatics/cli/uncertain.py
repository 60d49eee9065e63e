"""What ``run --uncertain`` tells: the largest values, how sure they are, and why."""

import itertools
from functools import partial

from ..errors import ParameterError
from ..numbers import checks, spreads
from ..numbers.formatting import about, at_most
from ..numbers.units import factor, to_si
from ..solution.uncertainty_table import largest_with_uncertainty, with_uncertainty
from .printed import print_table, say

OF_THE_CASE = "tolerances"
"""Stands for all that the case file's [tolerances] tell."""
OPTION = "--uncertain"


def inputs(case, names, texts):
    """Standard uncertainties, SI, of the numbers of each variant of these names, by path."""
    units = {name: case.variant(name).scene.units for name in names}
    of_case = OF_THE_CASE in texts
    pairs = [_parted(text) for text in texts if text != OF_THE_CASE]
    told = {path: partial(_size, text) for path, text in pairs}
    paths = [path for path, _ in pairs]
    problems = [
        f"{case.path} has no [tolerances]" if of_case and not case.tolerances else None,
        *(f"{path} is given more than once" for path in told if paths.count(path) > 1),
        *(checks.choice("parameter", path, tuple(dict.fromkeys(itertools.chain(*units.values())))) for path in told),
    ]
    read = ({path: partial(_deviation, text) for path, text in case.tolerances.items()} if of_case else {}) | told
    found: dict[str, dict[str, float]] = {name: {} for name in names}
    for name, known in units.items():
        for path in filter(read.__contains__, known):
            try:
                found[name][path] = read[path](known[path])
            except ValueError as error:
                problems.append(f"{path} {error}")
    checks.require(OPTION, *dict.fromkeys(problems))
    return found


def tell(solution, given):
    """Print the largest values of a solution with their uncertainty."""
    if not given:
        say("\nnone of the uncertain numbers is one of this variant")
        return
    table = largest_with_uncertainty(solution, given)
    rounding = table["rounding"].fillna(0.0)
    both = zip(table["largest"], table["tolerance"] + rounding, strict=True)
    columns = {"tolerance": "from tolerances", "rounding": "from rounding"}
    bounds = {"tolerance": list(map(about, table["tolerance"])), "rounding": list(map(at_most, table["rounding"]))}
    shown = table.assign(largest=[with_uncertainty(*pair) for pair in both], **bounds)
    print()
    print_table(shown.rename(columns=columns), _of_two_digits(table))
    say(
        f"\nlargest values, and how sure they are: standard uncertainty from that of {', '.join(sorted(given))}, "
        "independent and to first order, and the proven bound on rounding added to it, rounded up to two digits"
    )


def _of_two_digits(table):
    """Bounds with which shares are told with two digits."""
    return (0.1 * table[["share [%]"]]).reindex(columns=table.columns)


def _parted(text):
    path, equals, size = text.partition("=")
    if not equals:
        raise ParameterError(
            f'{OPTION}: cannot read {text!r}; write path=size, "crank_length=0.01 mm", or "{OF_THE_CASE}" for those of '
            "the case file"
        )
    return path.strip(), size.strip()


def _size(text, unit):
    size = to_si(text, unit)
    if size < 0.0:
        raise ValueError(f"must not be negative, got {text!r}")
    return size


def _deviation(text, unit):
    """Standard deviation of a spread, SI."""
    spread = spreads.spread_of(text)
    return spread.deviation * factor(spread.unit, unit)
