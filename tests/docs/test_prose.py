"""Documents, docstrings and messages are in plain English: docs/check_prose.py."""

import json

import pytest

from support.every import every
from support.pages import script

PROSE = script("check_prose")

REJECTED = [
    "A product stays as what is exact there.",
    "The pin carries what moves with it.",
    "It returns such a machine.",
    "So much for the saw.",
    "This is that of which the mean is zero.",
    "The number is asked about by a warning.",
    "Here each number is told.",
    "A label tells groups apart.",
    "The report says which of them failed.",
    "The ram hangs on the lever.",
    "Its couple rubs too.",
    "Pieces are parted there.",
    "Numbers are taken wherever they come.",
    "They grow without bound, which extremes say.",
    "Tables say NaN where none is.",
    "What does a cam buy me?",
    "Friction goes by joint.",
    "A function stands for a number.",
    "It finds true extrema.",
    "It is the same but for rounding.",
    "Draw it anew.",
    "It says by how much the goal changes.",
    "Its structure owes to lengths a sign.",
    "One limit gives way.",
    "Variants are read with what they have in common.",
    "Nobody waits for these calls.",
    "The engine is there too.",
]
"""One sentence for each pattern of PROSE.PHRASES, in its order."""
PLAIN = [
    "What is new in this version?",
    "Joint forces grow without bound; `extremes` warns.",
    "Links such as the coupler are rigid.",
    "Any number may be a pint quantity, and `what is told` is code.",
    "Rubber mounts are taken from the [catalogue](what-is-told.md).",
]
LONG = "the crank turns " * 10


def complaints(blocks):
    return [complaint for _, complaint in PROSE.findings(blocks)]


@every("pattern, sentence", list(zip(PROSE.PHRASES, REJECTED, strict=True)) if PROSE else [])
def test_each_phrase_is_found(pattern, sentence):
    advice = PROSE.PHRASES[pattern]
    assert any(advice in complaint for complaint in complaints([(1, sentence, True)]))


@every("sentence", PLAIN)
def test_plain_sentences_pass(sentence):
    assert complaints([(1, sentence, True)]) == []


@every("words, count", [(LONG + "once.", 1), (LONG[:-6] + ".", 0), (LONG[:24] + ". " + LONG[:24] + ".", 0)])
def test_long_sentences_are_found(words, count):
    assert len(complaints([(1, words, True)])) == count


PAGE = f"""---
title: what is told
---
# Such a page

Plain text
that hangs on a link:

```python
anew = "what is told"
```

| anew | `anew` |
|---|---|
| {LONG} once | told |

```{{note}}
Nobody knows.
```
"""


def test_pages_are_read_without_code():
    found = [(line, complaint.split("'")[1]) for line, complaint in PROSE.findings(PROSE.markdown(PAGE))]
    assert found == [(4, "Such"), (6, "hangs on"), (13, "anew"), (15, "told"), (18, "Nobody")]


def test_only_the_unreleased_changes_are_read():
    text = "# Changelog\n\n## Unreleased\n\n- Such.\n\n## 1.0 - 2026-01-01\n\n- Such.\n"
    assert [line for line, _ in PROSE.findings(PROSE.unreleased(text))] == [5]


MODULE = '''
def area(length):
    """Area that hangs on a length.

    length : float
        What is given.

    >>> area("anew")
    """
    if length < 0:
        raise ValueError(f"{length} is told to be such")
    return "anew"
'''


def test_docstrings_and_messages_are_read():
    found = [(line, complaint.split("'")[1]) for line, complaint in PROSE.findings(PROSE.module(MODULE))]
    assert sorted(found) == [(3, "hangs on"), (6, "What is"), (11, "such"), (11, "told")]


def test_cells_of_text_are_read():
    cells = [{"cell_type": "code", "source": ["told"]}, {"cell_type": "markdown", "source": ["# A\n", "\n", "Told."]}]
    [(number, blocks)] = PROSE.notebook(json.dumps({"cells": cells}))
    assert (number, [line for line, _ in PROSE.findings(blocks)]) == (2, [3])


@pytest.mark.slow
@pytest.mark.skipif(not PROSE, reason="the pages are not beside the tests")
def test_documents_are_in_plain_english():
    assert [complaint for path in PROSE.paths() for complaint in PROSE.checked(path)] == []
