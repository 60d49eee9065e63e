"""The case-file reference has every key of the schema, each with a meaning and an example that the schema takes."""

import tomllib
import typing

import pytest

from kinetostatics.casefile import schema
from kinetostatics.casefile.schema import MechanismVariant
from kinetostatics.casefile.schema.tables import Table
from support.pages import script

KEYS = script("casefile_keys")
PARTS = KEYS.parts_of_the_reference()
MODELS = {title: model for title, model, _ in KEYS.sections()}


def reached(models):
    """Every table that stands in one of these, or in what stands there."""
    found, left = set(), list(models)
    while left:
        model = left.pop()
        found.add(model)
        kinds = [kind for field in model.model_fields.values() for kind in within(field.annotation)]
        left += [kind for kind in kinds if kind not in found]
    return found - {Table}


def within(annotation):
    """Tables within a type."""
    for kind, _ in KEYS.flattened(annotation):
        if isinstance(kind, type) and issubclass(kind, Table):
            yield kind
        else:
            for part in typing.get_args(kind):
                yield from within(part)


def test_every_table_of_a_case_file_has_a_section():
    whole = reached([schema.CaseTable, *schema.VARIANTS.values(), *KEYS.designs.KINDS.values()])
    told = set(MODELS.values()) - {MechanismVariant}
    assert {model.__name__ for model in whole} == {model.__name__ for model in told}


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.title)
def test_every_key_of_a_table_is_told_of(part):
    elsewhere = set(MechanismVariant.model_fields) if part.title.startswith("Mechanism") else set()
    assert {key.name for key in part.keys} | elsewhere >= set(MODELS[part.title].model_fields)
    for key in part.keys:
        assert key.meaning.endswith("."), key.name
        assert key.takes, key.name
        assert key.default, key.name
        assert key.example, key.name


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.title)
def test_examples_are_toml(part):
    for key in part.keys:
        assert tomllib.loads(key.example)


def test_every_link_of_the_reference_leads_to_a_section():
    page = KEYS.page()
    anchors = {part.anchor for part in PARTS}
    assert len(anchors) == len(PARTS)
    assert all(link.partition(")")[0] in anchors for link in page.split("](#")[1:])


def test_meanings_of_groups_and_loads_are_of_keys_that_there_are():
    keys = {
        name for model in schema.MADE_OF for key in model.model_fields for name in (key, f"{KEYS.word_of(model)}.{key}")
    }
    assert set(KEYS.parts.MEANINGS) <= keys
