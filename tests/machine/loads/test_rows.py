"""Rows of a table read from a file."""

import pytest

import kinetostatics as ks
from support.every import every


def written(folder, text):
    path = folder / "table.csv"
    path.write_text(text)
    return path


@every(
    ("text", "options", "words"),
    [
        ("crank_angle [deg], force [kN]\n0, 1\n120, 2\n240, 3\n", {}, None),
        ("crank angle [deg], force [kN]\n0, 1\n120, 2\n240, 3\n", {}, None),
        ("# bench 3, 12 May\ncrank_angle [deg], force [kN]\n0, 1\n120, 2\n240, 3\n", {}, None),
        ("crank_angle [rad], torque [N mm]\n0, 1\n2, 2\n4, 3\n", {"unit": "N m"}, None),
        ("travel [mm], pressure [bar]\n0, 1\n1, 2\n", {}, "no column 'force'"),
        ("travel [mm], pressure [kN]\n0, 1\n1, 2\n", {"area": 1.0}, "pressure"),
        ("travel [deg], force [kN]\n0, 1\n1, 2\n", {}, "travel"),
        ("angle [deg], force [kN]\n0, 1\n1, 2\n", {}, "no column 'crank_angle'"),
        ("travel [mm], force [kN]\n1, 1\n1, 2\n", {}, "travel must rise.* for a jump give two travels close together"),
        ("travel [mm], force [kN]\n1, 1\n2, 2\n1, 3\n3, 1\n", {}, "travel must rise.* give the stroke back"),
        ("travel [mm], force [kN]\n1, 1\n", {}, "at least 2 rows"),
        ("travel [mm], force [kN], back [kN]\n1, 1, 5\n2, 1, 5\n", {}, "'back' would not be read.*force_back"),
        ("travel [mm], force [kN], Force back [kN]\n1, 1, 5\n2, 1, 5\n3, 1, 5\n", {}, None),
        ("travel [mm], force [kN], force_return [kN]\n1, 1, 5\n2, 1, 5\n", {}, "'force_return' would not be read"),
        (
            "travel [mm], force [kN], force_bak [kN]\n1, 1, 5\n2, 1, 5\n",
            {},
            "'force_bak' would not be read.*force_back",
        ),
        ("travel [mm], pressure [bar], force_back [kN]\n1, 1, 5\n2, 1, 5\n", {"area": 1.0}, "pressure_back"),
        ("crank_angle [deg], force [N], force_back [N]\n0, 1, 5\n120, 2, 5\n240, 3, 5\n", {}, "over travel"),
        ("travel [m], force [N], pressure [Pa], pressure_back [Pa]\n1, 1, 5, 5\n2, 1, 5, 5\n3, 1, 5, 5\n", {}, None),
    ],
)
def test_tables_from_files_are_read_or_refused_with_the_file_and_the_reason(tmp_path, text, options, words):
    path = written(tmp_path, text)
    if words is None:
        assert ks.Table.from_csv(path, **options).y.size == 3
        return
    with pytest.raises(ks.CaseError, match=words) as caught:
        ks.Table.from_csv(path, **options)
    assert "table.csv" in str(caught.value)
