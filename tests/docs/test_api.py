"""Every public name stands on one page of the API reference, and no other does."""

import re
import types

import kinetostatics as ks
from support.pages import pages, text_of


def listed():
    """Names that the pages list, with how often."""
    texts = [text_of(path) for name, path in pages().items() if name.startswith("api/")]
    blocks = [block for text in texts for block in re.findall(r"```\{api\}\n(.*?)```", text, flags=re.DOTALL)]
    return [line for block in blocks for line in block.split() if not line.startswith(":")]


def public():
    """Names as users call them, without the ``ks.``; a name called in two ways by the shorter one."""
    modules = {name: found for name in ks.__all__ if isinstance(found := getattr(ks, name), types.ModuleType)}
    short = [name for name in ks.__all__ if name not in modules]
    objects = {id(getattr(ks, name)) for name in short if isinstance(getattr(ks, name), type)}
    deep = [
        f"{module}.{name}"
        for module, found in modules.items()
        for name in found.__all__
        if id(getattr(found, name)) not in objects
    ]
    return short + deep


def test_each_public_name_stands_on_one_page():
    assert sorted(listed()) == sorted(public())
