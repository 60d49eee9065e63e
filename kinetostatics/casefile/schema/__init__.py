"""What a case file may hold, as pydantic models: keys, units, allowed values. `build` turns them into mechanisms.

texts       numbers with units, and words in their place
tables      links, cams, counterweights, files of values
parts       groups and loads, by the rules of their classes
drives      motors and flywheels
designs     what is to be found: what varies, what must hold
variants    mechanisms, and the head of a file
validation  what is wrong with a table, in sentences
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
    "validated",
]
