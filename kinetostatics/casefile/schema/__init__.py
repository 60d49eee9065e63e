"""Schema of case files as pydantic models: keys, units, allowed values.

May import numbers, and the classes of `machine`, `drive` and `design` that its tables describe.
"""

from .designs import FrontTable, OneDesign, OptimumTable, TorqueFreeCamTable
from .drives import TorqueTable
from .parts import MADE_OF
from .tables import TAGS, CosineLawTable, HarmonicTable, LinkTable, SampledTable, Table, ValuesTable, key_path, validate
from .texts import BALANCE_THE_SLIDER, MID_LENGTH
from .variants import (
    VARIANTS,
    CamVariant,
    CaseTable,
    ChainUnitVariant,
    ChainVariant,
    CrankSliderVariant,
    FourBarVariant,
    MechanismVariant,
    ProcessForceTable,
    PublishedTable,
    ScotchYokeVariant,
    SlottedLeverVariant,
)

__all__ = [
    "BALANCE_THE_SLIDER",
    "MADE_OF",
    "MID_LENGTH",
    "TAGS",
    "VARIANTS",
    "CamVariant",
    "CaseTable",
    "ChainUnitVariant",
    "ChainVariant",
    "CosineLawTable",
    "CrankSliderVariant",
    "FourBarVariant",
    "FrontTable",
    "HarmonicTable",
    "LinkTable",
    "MechanismVariant",
    "OneDesign",
    "OptimumTable",
    "ProcessForceTable",
    "PublishedTable",
    "SampledTable",
    "ScotchYokeVariant",
    "SlottedLeverVariant",
    "Table",
    "TorqueFreeCamTable",
    "TorqueTable",
    "ValuesTable",
    "key_path",
    "validate",
]
