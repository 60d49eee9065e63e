"""What may be written on the line."""

import pytest

import kinetostatics as ks
from kinetostatics.cli import main


@pytest.mark.parametrize("arguments", [["run", "sawframe_2r63", "--angles", "0"], ["runn", "sawframe_2r63"], []])
def test_wrong_usage_ends_with_status_2(arguments):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2


def test_version_is_that_of_the_library(capsys):
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"kinetostatics {ks.__version__}\n"
