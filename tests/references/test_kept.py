"""Results of the whole package beside those that were kept before its internals changed (`make_kept.py`)."""

import pytest

from support import kept
from support.case_files import shipped, unlike_variants
from support.every import every

pytestmark = pytest.mark.skipif(
    not kept.FOLDER.is_dir(), reason="nothing is kept: python tests/references/make_kept.py writes it"
)
CASES = kept.CASES
QUICK = "compressor", "pumpjack", "yoke_pump"
"""Cases whose values take less than half a second."""
COMPILED = (
    ("sawframe_2r63", "plain"),
    ("sawframe_2r63_friction", "cam-cosine"),
    ("chain_unit", "rho-0.5"),
)
"""Structures that compile in some seconds each."""


def _compared(name, found):
    before = kept.read(name)
    tables = (
        frozenset(variant for variant, made in shipped(name).variants.items() if kept.has_table_loads(made.scene))
        if name in CASES
        else frozenset()
    )
    context = kept.Context(before, tables, kept.has_other_arithmetic(), kept.SEARCHED.get(name, frozenset()))
    compared = {path.split("/", 2)[1] for path in found} | {"exact", "bounds"}
    before = {path: result for path, result in before.items() if path.split("/", 2)[1] in compared}
    wrong = [f"{name}, {difference}" for difference in kept.differences(before, found, context)]
    assert not wrong, f"{len(wrong)} results are not as they were kept\n" + "\n".join(wrong)


@pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in CASES]
)
def test_values_of_shipped_cases_are_kept(name):
    _compared(name, kept.of_case(name, [kept.values]))


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_extremes_and_means_are_kept(name):
    scenes = {variant: made.scene for variant, made in shipped(name).variants.items()}
    _compared(
        name,
        {
            f"{variant}/{path}": found
            for variant, scene in scenes.items()
            for path, found in kept.extremes(scene).items()
        },
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_bounds_cover_true_errors_closely(name):
    before = kept.read(name)
    wrong = [
        f"{name}, {problem}"
        for variant in unlike_variants(name)
        if variant not in kept.SEARCHED.get(name, ())  # the exact values are of inputs to the last bit
        for problem in kept.bound_problems(before, variant, shipped(name).variants[variant].scene)
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.slow
@pytest.mark.parametrize("name", list(kept.STUDIES))
def test_studies_are_kept(name):
    _compared(name, kept.STUDIES[name]())


@pytest.mark.slow
@pytest.mark.usefixtures("numba")
@pytest.mark.parametrize(("name", "variant"), COMPILED)
def test_compiled_values_are_kept_but_for_rounding(name, variant):
    before = kept.read(name)
    now = {
        f"{variant}/{path}": found
        for path, found in kept.values(shipped(name).variants[variant].scene, "compiled").items()
    }
    before = {path: result for path, result in before.items() if path.startswith(f"{variant}/values/")}
    now = {path: result for path, result in now.items() if path in before}
    context = kept.Context(kept.read(name), other_arithmetic=True)
    wrong = [f"{name}, {difference}" for difference in kept.differences(before, now, context)]
    assert not wrong, "\n".join(wrong)


@every(
    ("text", "same"),
    [
        ("reaction O  N  63.3033  355.308", True),
        ("reaction O  N   63.3034  355.309", True),
        ("reaction O  N  63.3036  355.308", False),
        ("reaction P  N  63.3033  355.308", False),
        ("reaction O  N  63.3033  -355.308", False),
        ("reaction O  N  63.303  355.308", False),
    ],
)
def test_printed_numbers_differ_by_one_last_unit(text, same):
    assert kept.same_text("reaction O  N  63.3033  355.308", text) == same
