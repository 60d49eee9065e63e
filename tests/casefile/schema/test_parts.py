"""Groups and loads of a case file, made of the rules of their classes."""

import pytest

import kinetostatics as ks
from support.case_chains import (
    LOADS,
    PUMP,
    agree,
    rpm,
)
from support.case_files import case_file


@pytest.mark.parametrize("name", LOADS)
def test_a_load_of_each_kind_is_the_one_made_in_python(tmp_path, name):
    text, entry, load, *table = LOADS[name]
    if table:
        (tmp_path / "t.csv").write_text(table[0], encoding="utf-8")
    variant = ks.load_case(case_file(tmp_path, f"{text}[[variants.loaded.loads]]\n{entry}\n")).variant("loaded")
    agree(variant.scene, ks.Scene(variant.mechanism, rpm(60), loads=load), 9)
    assert variant.scene.period == ks.Scene(variant.mechanism, rpm(60), loads=load).period


def test_loads_of_a_kind_are_numbered_after_those_with_tables_of_their_own(tmp_path):
    springs = '[[variants.loaded.loads]]\nkind = "spring"\nstiffness = "{} N/m"\nfree_position = "0.4 m"\n'
    own = 'spring = { stiffness = "1 N/m", free_position = "0 m" }\n'
    variant = ks.load_case(case_file(tmp_path, PUMP + own + springs.format(2) + springs.format(3))).variant("loaded")
    wanted = {"spring.stiffness": 1.0, "spring2.stiffness": 2.0, "spring3.stiffness": 3.0}
    assert {path: variant.parameters[path] for path in wanted} == wanted
    assert {path: variant.scene.parameters[path] for path in wanted} == wanted
