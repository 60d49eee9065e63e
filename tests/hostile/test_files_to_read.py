"""What cannot be read as a file, or is no name of one: one clear error each."""

import os
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers.files import read_columns
from kinetostatics.sweeps import designs
from support.every import every


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    designs.distributions({"a": "0..1 m"})
    ks.load_case("sawframe_2r63")


def special(folder, kind):
    path = folder / kind
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path)
    elif kind == "sparse":
        with path.open("wb") as file:
            file.truncate(2 * 10**9)
    elif kind == "large":
        path.write_bytes(b"1,2\n" * 3_000_000)
    return {"device": Path("/dev/zero"), "zero": folder / "a\0b", "long": folder / ("x" * 5000)}.get(kind, path)


KINDS = ["pipe", "device", "folder", "loop", "sparse", "large", "zero", "long", "missing"]


@every("kind", KINDS)
def test_a_pipe_device_folder_or_giant_is_no_table(tmp_path, kind):
    with pytest.raises(ks.CaseError, match=r"cannot be read"):
        read_columns(special(tmp_path, kind), {"force": "N"})


@every("kind", KINDS)
def test_a_pipe_device_folder_or_giant_is_no_case(tmp_path, kind):
    with pytest.raises(ks.CaseError, match=r"cannot be read|no such file"):
        ks.load_case(special(tmp_path, kind))


@every("name", ["a\0b", "x" * 300, "x" * 100_000, "a/" * 3000, "\ud800", "~/saw", "", ".", "\n"])
def test_a_name_that_no_file_can_have_is_no_case(name):
    with pytest.raises(ks.CaseError, match=r"cannot be read|no such file"):
        ks.load_case(name)


NO_PATHS = [
    None,
    3,
    np.nan,
    True,
    b"saw",
    b"\0",
    [],
    ["sawframe_2r63"],
    {},
    object(),
    np.array(["a"]),
    ks.crank_slider,
]


@every("thing", NO_PATHS, ids=range(len(NO_PATHS)))
def test_what_is_neither_path_nor_name_is_no_case(thing):
    with pytest.raises(ks.ParameterError, match=r"^load_case: takes a path or the name of a shipped case, got "):
        ks.load_case(thing)


def test_a_solution_is_no_case():
    case = ks.load_case("sawframe_2r63")
    for thing in (case, case.variant("plain"), case.solve("plain", 12)):
        with pytest.raises(ks.ParameterError, match=r"^load_case: takes a path or the name of a shipped case, got "):
            ks.load_case(thing)


@pytest.mark.parametrize("path", [None, 5, b"case.toml", ["case.toml"], object()])
def test_what_is_no_path_is_no_case(path):
    with pytest.raises(ks.ParameterError, match=r"takes a path or the name of a shipped case"):
        ks.load_case(path)
