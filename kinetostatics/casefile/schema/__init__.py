"""Schema of case files as pydantic models: keys, units, allowed values.

May import numbers, and the classes of `machine`, `drive` and `design` that its tables describe.
"""

from .designs import FrontTable, OneDesign, OptimumTable, TorqueFreeCamTable
from .drives import TorqueTable
from .parts import MADE_OF
from .tables import TAGS, CosineLawTable, HarmonicTable, LinkTable, SampledTable, Table, ValuesTable, key_path, validate
from .variants import (
    VARIANTS,
    CamVariant,
    CaseTable,
    ChainUnitVariant,
    ChainVariant,
    FourBarVariant,
    MechanismVariant,
    ProcessForceTable,
    PublishedTable,
    ScotchYokeVariant,
    SlottedLeverVariant,
)

__all__ = [
    "MADE_OF",
    "TAGS",
    "VARIANTS",
    "CamVariant",
    "CaseTable",
    "ChainUnitVariant",
    "ChainVariant",
    "CosineLawTable",
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
