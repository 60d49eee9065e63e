"""The tolerances of a case file: what is wrong with them, and units that look like slips."""

from ..errors import KinetostaticsError
from ..numbers.formatting import heading, si_columns
from ..numbers.spreads import read, spread_of
from ..numbers.units import base_factor

FAR_OFF = 300.0
"""How many times a tolerance may be above or below its parameter before its unit is doubted."""


def spread_problems(spreads, variants):
    """What is wrong with the tolerances: texts that cannot be read, parameters and units that no variant has."""
    known = {path: unit for item in variants.values() if item for path, unit in item.units.items()}
    for name, text in spreads.items():
        columns = [name]
        try:
            columns = [heading(name, read({name: text}, spread_of)[name].unit)]
        except KinetostaticsError as error:
            yield f"tolerances: {str(error).removeprefix('designs: ')}"
        if all(variants.values()):
            yield from (f"tolerances: {problem}" for problem in si_columns(columns, known)[1])


def far_off(spreads, variants):
    """Tolerances whose size is far from that of their parameter in every variant that has it, as a sentence each."""
    for name, text in spreads.items():
        spread = spread_of(text)
        size = max(abs(spread.median), spread.deviation) * base_factor(spread.unit)
        nominal = [abs(value) for item in variants.values() if (value := _nominal(item, name))]
        if nominal and all(not 1 / FAR_OFF < size / value < FAR_OFF for value in nominal):
            si = next(paths[name] for item in variants.values() if name in (paths := item.units))
            yield (
                f"tolerances: {name} = {text!r} is of the size {size:.6g} {si}, but the parameter of "
                f"{nominal[0]:.6g} {si}; is the unit right?"
            )


def _nominal(variant, path):
    """Value of a parameter, also where the file has a word for it; None if the variant has none."""
    value = variant.parameters.get(path)
    value = variant.scene.parameters.get(path) if isinstance(value, str) else value
    return value if isinstance(value, float) else None
