"""Names in chains: whatever groups, pins and labels are called, each thing has its own, or the chain is refused."""

import dataclasses
import random

import pytest

import kinetostatics as ks
from kinetostatics.machine.group import RESERVED
from kinetostatics.mechanics.quantities import of_mechanism
from support.every import every

WORDS = (
    *(
        "A",
        "A2",
        "B",
        "B2",
        "C",
        "D",
        "O",
        "O2",
        "P",
        "guide",
        "guide2",
        "dyad1_A",
        "dyad12_A",
        "dyad1_B",
        "slot_force",
    ),
    *("cylinder_force2", "block_position", "crank", "crank_rate", "slider2_rate", "shaking_force", "frame"),
)
LABELS = ("", "2", "_B", "2_B", "_A", "_rate", "12", "_position")
COUNTS = {"slider": (2, 1, 5), "rocker": (2, 2, 3), "dyad": (2, 1, 3), "lever": (2, 1, 4), "cylinder": (2, 1, 4)}
COUNTS |= {"yoke": (2, 1, 6), "pin": (0, 1, 0)}
"""Links, joints and outputs that each kind of group adds."""


def group(kind, choose):
    on, pin, label = choose(("A", "A", "B", "C", "O2")), choose(WORDS), choose(LABELS)
    make = {
        "slider": lambda: ks.SliderGroup(1.0, on=on, pin=pin, label=label),
        "rocker": lambda: ks.RockerGroup(0.4, 0.3, (0.3, 0.1), on=on, pin=pin, pivot_name=choose(WORDS), label=label),
        "dyad": lambda: ks.Dyad(0.4, 0.3, (on, "O"), pin, label=label),
        "lever": lambda: ks.LeverGroup((0.3, 0.1), on=on, pivot_name=pin, label=label),
        "cylinder": lambda: ks.CylinderGroup((0.3, 0.1), on=on, pivot_name=pin, label=label),
        "yoke": lambda: ks.YokeGroup(on=on, pin=pin, label=label),
        "pin": lambda: ks.Pin(on=choose(("crank", "frame", "slider", "dyad1")), at=(0.1, 0.0), name=pin),
    }
    return make[kind]()


@every("seed", range(6))
def test_no_name_is_lost_in_silence(seed):
    random.seed(seed)
    made = refused = 0
    for _ in range(60):
        kinds = random.choices(list(COUNTS), k=random.choice((1, 2, 3)))
        try:
            chain = ks.Mechanism("chain", ks.Crank(0.1), tuple(group(kind, random.choice) for kind in kinds))
        except ks.ParameterError:
            refused += 1
            continue
        made += 1
        links, joints, outputs = (sum(counts) for counts in zip((1, 2, 2), *map(COUNTS.get, kinds), strict=True))
        assert (len(chain.links), len(chain.joints), len(chain.outputs)) == (links, joints, outputs)
        travels, measured = 3 * len(chain.guides), sum(kind in ("lever", "cylinder") for kind in kinds)
        assert len(of_mechanism(chain)) == outputs + len(RESERVED) + travels + measured + 2 * links
    assert made
    assert refused


@every(
    ("parts", "words"),
    [
        ((ks.Dyad(0.4, 0.3, ("A", "O"), "dyad1_A"),), "adds reaction 'dyad1_A' a second time"),
        ((ks.YokeGroup(pin="A"),), "adds joint 'A' a second time"),
        ((ks.LeverGroup((0.1, 0.2), pivot_name="A"),), "adds joint 'A' a second time"),
        ((ks.LeverGroup((0.1, 0.2), pivot_name="slot_force"),), "adds quantity 'slot_force' a second time"),
        ((ks.CylinderGroup((0.1, 0.2), pivot_name="O"),), "adds joint 'O' a second time"),
        ((ks.Pin("crank", (0.1, 0.0), "A"),), "adds joint 'A' a second time"),
        ((ks.Pin("crank", (0.1, 0.0), "crank"),), "adds link 'crank' a second time|adds joint 'crank' a second time"),
        ((ks.LeverGroup((0.1, 0.2)), ks.YokeGroup(label="2"), ks.YokeGroup(pin="C", label="2")), "'slider2' a second"),
        ((ks.LeverGroup((0.1, 0.2)), ks.YokeGroup()), "adds link 'block' a second time"),
    ],
)
def test_what_two_things_would_be_called_is_refused(parts, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.Mechanism("chain", ks.Crank(0.1), parts)


@every("kind", sorted({*COUNTS} - {"pin"}))
def test_group_on_a_link_is_advised_to_use_a_pin(kind):
    made = group(kind, random.Random(1).choice)
    on = ("crank", "A") if kind == "dyad" else "crank"
    with pytest.raises(ks.ParameterError, match="hangs on 'crank', which is a link; put a Pin on that link"):
        ks.Mechanism("chain", ks.Crank(0.1), (dataclasses.replace(made, on=on),))
