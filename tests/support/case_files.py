"""Case files written for a test, and tables of reference values."""

import json
import tomllib
from functools import cache

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases

from . import DATA


def case_file(folder, text):
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def problems(folder, text):
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(case_file(folder, text))
    assert str(caught.value).startswith(str(folder / "case.toml"))
    return caught.value.problems


def toml(value):
    """Text of a value, tables in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(item)}" for key, item in value.items()) + "}"
    return "[" + ", ".join(map(toml, value)) + "]" if isinstance(value, list) else json.dumps(value)


def written(folder, case, names, path="", text=""):
    """A shipped case with some of its variants, in the last of them another text at a path."""
    raw = tomllib.loads(shipped_cases()[case].read_text(encoding="utf-8"))
    raw = {key: raw[key] for key in ("title", "reference", "common", "variants")}
    raw["variants"] = {name: raw["variants"][name] for name in dict.fromkeys(names)}
    if path:
        *tables, key = path.split(".")
        table = raw["variants"][names[-1]]
        for name in tables:
            table = table.setdefault(name, {})
        if isinstance(table, list):
            table[("x", "y").index(key)] = text
        else:
            table[key] = text
    file = folder / "case.toml"
    file.write_text("\n".join(f"{json.dumps(key)} = {toml(value)}" for key, value in raw.items()), encoding="utf-8")
    return ks.load_case(file)


@cache
def four_bar_data(name):
    path = DATA / f"fourbar_{name}.json"
    return json.loads(path.read_text(encoding="utf-8"))


def four_bar_table(rho):
    rows = four_bar_data(f"rho{rho}")["rows"]
    return {name: np.array([row[name] for row in rows], dtype=float).T for name in rows[0]}
