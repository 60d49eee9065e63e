"""A module holds one concept that a reader would look for; tests stand by feature, in folders that mirror the rooms."""

import ast
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.machine.group import Group

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent / "kinetostatics"
pytestmark = pytest.mark.skipif(not PACKAGE.is_dir(), reason="the package is not beside its tests")


def modules():
    """Paths of modules with code of their own; not what only gathers names, nor `__main__`."""
    return {path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py") if not path.name.startswith("__")}


MAY_NAME_GROUPS = ("machine/", "casefile/schema/", "studies/methods/", "__init__.py")
"""Where kinds of groups are made, read from case files, computed in another way to compare with, or handed out."""


def named_in(path, kinds):
    """Those of some names that a module's code, not its texts, takes from elsewhere or asks for."""
    text = path.read_text(encoding="utf-8")
    if not any(kind in text for kind in kinds):
        return set()
    tree = ast.parse(text)
    found = {alias.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for alias in node.names}
    return kinds & (found | {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)})


@pytest.mark.slow
def test_only_machine_knows_kinds_of_groups():
    """Whoever needs something of a group asks what groups declare, or the builders."""
    public = {name: getattr(ks, name) for name in ks.__all__}
    kinds = {name for name, kind in public.items() if isinstance(kind, type) and issubclass(kind, Group)}
    assert {"SliderGroup", "CamRoller", "Pin", "RollerFollower"} <= kinds
    paths = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}
    knowing = {name: named_in(path, kinds) for name, path in paths.items() if not name.startswith(MAY_NAME_GROUPS)}
    assert not {name: found for name, found in knowing.items() if found}


def lengths():
    """Lines of each module."""
    return {module: len((PACKAGE / module).read_text(encoding="utf-8").splitlines()) for module in modules()}


def test_every_room_has_a_folder_of_tests():
    rooms = {Path(module).parts[0] for module in modules() if "/" in module}
    assert {room for room in rooms if not any((TESTS / room).rglob("test_*.py"))} == set()


def test_no_module_is_longer_than_600_lines():
    assert {module: length for module, length in lengths().items() if length > 600} == {}


FRAGMENTS = 24
"""Modules of less than 80 lines: each new one needs a reason; none is to hide a part of another's concept."""


def test_fragments_become_no_more():
    found = {module: length for module, length in lengths().items() if length < 80}
    assert len(found) <= FRAGMENTS, f"{len(found)} modules of less than 80 lines; merge one: {sorted(found)}"
