"""Scripts of the pages: one module of several."""

import re
from importlib import resources

import pytest

from kinetostatics.views import page
from kinetostatics.views.page import bundle

FILES = {
    "main.js": 'import { b } from "./b.js";\nimport {\n  c,\n} from "./c.js";\nexport default b + c;\n',
    "b.js": 'import { c } from "./c.js";\nexport const b = c;\nexport function d() {}\n',
    "c.js": "export const c = 1; // export\n",
}
SCRIPTS = sorted(item.name for item in resources.files(page).iterdir() if item.name.endswith(".js"))
DECLARED = re.compile(r"^(?:export )?(?:default )?(?:async )?(class|function|const|let) (\w+)(.*)", re.M)
"""Kind, first name and rest of a declaration at the outermost level of a script."""


def names_of(text):
    for kind, name, rest in DECLARED.findall(text):
        yield name
        yield from re.findall(r", (\w+) = ", rest) if kind in ("const", "let") else ()


def test_a_bundle_has_each_module_once_before_its_users():
    assert bundle("main.js", FILES.get) == (
        "const c = 1; // export\n\nconst b = c;\nfunction d() {}\n\nexport default b + c;\n"
    )


@pytest.mark.parametrize("script", SCRIPTS)
def test_modules_of_a_bundle_declare_different_names(script):
    names = list(names_of(bundle(script)))
    assert names
    assert sorted(names) == sorted(set(names))


@pytest.mark.parametrize("script", SCRIPTS)
def test_scripts_make_no_text_into_elements_and_need_no_ids(script):
    text = page.source(script)
    assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|getElementById|\beval\b", text)
    assert "</script" not in text
