"""What tests share: the reference that imports nothing of the package, and many inputs in one test."""

import ast
import sys
import time
from pathlib import Path

import pytest

from support.every import every, limited


def test_the_reference_imports_only_mpmath():
    """So that it shares nothing with the package, nor with what the other helpers of the tests take from it."""
    tree = ast.parse((Path(__file__).parent / "support" / "multibody.py").read_text(encoding="utf-8"))
    modules = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    modules |= {"." * node.level + (node.module or "") for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert {name for name in modules if name.partition(".")[0] not in sys.stdlib_module_names} == {"mpmath"}


def failure(test, **fixtures):
    with pytest.raises(AssertionError) as caught:
        test(**fixtures)
    return str(caught.value).splitlines()


def test_failing_inputs_are_named_with_reasons():
    @every("value, limit", [(1, 2), (3, 2), (5, 2)])
    def test(value, limit):
        if value > limit:
            raise ValueError(f"{value} is too much")

    assert failure(test) == [
        "2 of 3 inputs fail; the first is traced above",
        "3-2: ValueError: 3 is too much",
        "5-2: ValueError: 5 is too much",
    ]


def test_input_without_its_error_is_named():
    @every("text", ["1", "one"])
    def test(text):
        with pytest.raises(ValueError, match="one"):
            int(text)

    assert [line.split(":")[0] for line in failure(test)[1:]] == ["1"]


def test_inputs_are_skipped_all_or_none():
    """Where a library is missing all are skipped; one that always is would hide behind the others."""

    @every("lacking", [True, True])
    def all_skip(lacking):
        pytest.skip("not installed")

    @every("lacking", [True, False])
    def one_skips(lacking):
        if lacking:
            pytest.skip("not installed")

    with pytest.raises(pytest.skip.Exception, match="not installed"):
        all_skip()
    assert "is skipped but not all" in failure(one_skips)[0]


def work(seconds):
    """Keep this process busy."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


@pytest.mark.slow
def test_each_input_has_the_time_of_a_test():
    @every("seconds", [9.0, 0.0, 0.3, 0.3, 0.3])
    def test(seconds):
        work(seconds)

    with limited(0.8):
        assert failure(test)[1:] == ["9.0: TimeoutError: took more than 0.8 s"]


@pytest.mark.slow
@pytest.mark.parametrize("spend", [work, time.sleep])
def test_slow_test_is_stopped_once(spend):
    def stopped():
        with limited(0.02):
            spend(1.0)

    with pytest.raises(TimeoutError, match=r"more than 0\.02 s"):
        stopped()
    spend(0.05)
