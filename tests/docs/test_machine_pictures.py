"""Each page of a machine has its picture in the list of machines, drawn by docs/draw_machines.py."""

import re

import pytest

from support import pages
from support.every import every

pytestmark = pages.needed
drawing = pages.script("draw_machines")
INDEX = pages.DOCS / "machines" / "index.md"


@pytest.mark.slow
def test_each_page_of_a_machine_has_a_picture():
    text = pages.text_of(INDEX)
    listed = re.search(r":caption: Machines\n\n(.*?)```", text, flags=re.DOTALL)[1].split()
    assert re.findall(r"\(pictures/(\w+)\.svg\) [^\]]+\]\((\w+)\.md\)", text) == [(name, name) for name in listed]
    assert {path.stem for path in drawing.FOLDER.glob("*.svg")} == set(listed) == drawing.machines().keys()


def test_pictures_are_small():
    assert all(path.stat().st_size < 20_000 for path in drawing.FOLDER.glob("*.svg"))


@pytest.mark.slow
@every("name", sorted(path.stem for path in drawing.FOLDER.glob("*.svg")) if drawing else ())
def test_a_picture_is_drawn_as_it_is_kept(name):
    pages.same_picture(pages.text_of(drawing.FOLDER / f"{name}.svg"), drawing.drawn(name))
