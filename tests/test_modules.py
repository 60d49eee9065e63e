"""Every module has a file of tests of its name, kinetostatics/ROOM/x.py has tests/ROOM/test_x.py, and knows its own."""

import ast
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.machine.group import Group

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent / "kinetostatics"
PROVEN_IN = (
    {"studies/methods/followers.py": "laws/test_followers.py"}
    | {
        f"studies/methods/{module}.py": f"studies/methods/test_{test}.py"
        for test, modules in {
            "certified": ("acting", "enclosures", "independent", "postures"),
            "kane": ("applied", "kane_cams", "kane_equations", "kane_motion", "kane_symbols", "structures"),
            "newton": ("configurations", "constraints"),
        }.items()
        for module in modules
    }
    | {f"studies/methods/{module}.py": "studies/test_precision.py" for module in ("engines", "method")}
)
"""Parts of one method under study, which only mean something as a whole: proven against another method."""

pytestmark = pytest.mark.skipif(not PACKAGE.is_dir(), reason="the package is not beside its tests")


def modules():
    """Paths of modules with code of their own; not what only gathers names, nor `__main__`."""
    return {path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py") if not path.name.startswith("__")}


def file_of_tests(module):
    """Where the tests of a module stand."""
    path = Path(module)
    return TESTS / path.parent / f"test_{path.name}"


def test_every_module_has_its_file_of_tests_or_is_part_of_a_method_proven_elsewhere():
    missing = {module for module in modules() - PROVEN_IN.keys() if not file_of_tests(module).exists()}
    assert not missing, f"write tests/ROOM/test_MODULE.py for {', '.join(sorted(missing))}"


def test_exceptions_are_modules_without_a_file_and_the_proof_is_there():
    for module, proof in PROVEN_IN.items():
        assert module in modules(), f"{module} is no module any longer"
        assert not file_of_tests(module).exists(), f"{module} has its own file of tests and needs no exception"
        assert (TESTS / proof).exists(), f"{module} is said to be proven in {proof}, which is not there"


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


def test_no_module_outside_the_machine_knows_a_kind_of_group():
    """Whoever needs something of a group asks what groups declare, or the builders."""
    public = {name: getattr(ks, name) for name in ks.__all__}
    kinds = {name for name, kind in public.items() if isinstance(kind, type) and issubclass(kind, Group)}
    assert {"SliderGroup", "CamRoller", "Pin", "RollerFollower"} <= kinds
    paths = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}
    knowing = {name: named_in(path, kinds) for name, path in paths.items() if not name.startswith(MAY_NAME_GROUPS)}
    assert not {name: found for name, found in knowing.items() if found}


def test_no_module_is_longer_than_600_lines():
    """A module holds one concept that a reader would look for."""
    lengths = {module: len((PACKAGE / module).read_text(encoding="utf-8").splitlines()) for module in modules()}
    assert {module: length for module, length in lengths.items() if length > 600} == {}
