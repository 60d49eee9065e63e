"""Scripts of the pages: one module of several, and arrays beside their JSON."""

import json
import re
from importlib import resources

import numpy as np
import pytest

from kinetostatics.views import page
from kinetostatics.views.page import bundle, split_arrays

FILES = {
    "main.js": 'import { b } from "./b.js";\nimport {\n  c,\n} from "./c.js";\nexport default b + c;\n',
    "b.js": 'import { c } from "./c.js";\nexport const b = c;\nexport function d() {}\n',
    "c.js": "export const c = 1; // export\n",
}
SCRIPTS = sorted(item.name for item in resources.files(page).iterdir() if item.name.endswith(".js"))
NAMES = re.compile(r"^(?:export )?(?:async )?(?:class|function|const|let) (\w+)|(?<=, )(\w+)(?= = )", re.M)
"""Names that a script declares at its outermost level."""


def test_a_bundle_has_each_module_once_before_its_users():
    assert bundle("main.js", FILES.get) == (
        "const c = 1; // export\n\nconst b = c;\nfunction d() {}\n\nexport default b + c;\n"
    )


@pytest.mark.parametrize("script", SCRIPTS)
def test_modules_of_a_bundle_declare_different_names(script):
    lines = [line for line in bundle(script).splitlines() if re.match(r"(export )?(async )?\w", line)]
    names = [first or other for line in lines for first, other in NAMES.findall(line)]
    assert names
    assert sorted(names) == sorted(set(names))


@pytest.mark.parametrize("script", SCRIPTS)
def test_scripts_make_no_text_into_elements_and_need_no_ids(script):
    text = page.source(script)
    assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|getElementById|\beval\b", text)
    assert "</script" not in text


def test_arrays_are_split_from_their_message():
    value = {"a": [np.arange(3.0), {"b": np.float32([[1, 2]])}], "c": "text", "d": (1, None)}
    header, arrays = split_arrays(value)
    kinds = [{"array": 0, "kind": "f8"}, {"array": 1, "kind": "f4"}]
    assert json.loads(json.dumps(header)) == {"a": [kinds[0], {"b": kinds[1]}], "c": "text", "d": [1, None]}
    assert [array.tobytes() for array in arrays] == [np.arange(3.0).tobytes(), np.float32([1, 2]).tobytes()]
