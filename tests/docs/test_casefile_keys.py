"""The case-file reference has every key of the schema, each with a meaning and an example that the schema takes."""

import tomllib

import pytest

from kinetostatics.casefile import schema
from kinetostatics.casefile.schema import MechanismVariant
from support.pages import script

KEYS = script("casefile_keys")
PARTS = KEYS.parts_of_the_reference()
MODELS = {title: model for title, model, _ in KEYS.sections.sections()}


def test_every_table_of_a_case_file_has_a_section():
    whole = KEYS.sections.reached([schema.CaseTable, *schema.VARIANTS.values(), *schema.designs.KINDS.values()])
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


def test_reference_links_lead_to_sections():
    page = KEYS.page()
    anchors = {part.anchor for part in PARTS}
    assert len(anchors) == len(PARTS)
    assert all(link.partition(")")[0] in anchors for link in page.split("](#")[1:])


def test_documented_meanings_belong_to_known_keys():
    keys = {
        name for model in schema.MADE_OF for key in model.model_fields for name in (key, f"{KEYS.word_of(model)}.{key}")
    }
    assert set(KEYS.parts.MEANINGS) <= keys
