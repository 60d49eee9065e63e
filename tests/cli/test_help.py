"""The help of the commands: an example of each that runs as it stands, and the options that apply to it."""

import argparse
import shlex
import tomllib

import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from kinetostatics.cli.options import COMMANDS, parser
from support.every import every


def commands():
    """Parser of each command by name."""
    (group,) = (item for item in parser()._actions if isinstance(item, argparse._SubParsersAction))
    return group.choices


@pytest.mark.slow
@every("name", COMMANDS)
def test_each_help_has_an_example_that_is_read(name):
    help_text = commands()[name].format_help()
    example = help_text.partition("example:\n  ")[2].partition("\n")[0]
    program, *arguments = shlex.split(example)
    assert program == "kinetostatics"
    options = parser().parse_args(arguments)
    assert options.word == name
    case = getattr(options, "case", None)
    if case is not None:
        raw = tomllib.loads(ks.shipped_cases()[case].read_text(encoding="utf-8"))
        assert getattr(options, "variant", None) in (None, *raw["variants"])
        assert name != "design" or raw["design"]
        assert name != "drive" or raw["common"]["drive"]


@every("name", COMMANDS)
def test_help_speaks_of_the_formats_that_a_command_has(name):
    known = {option for action in commands()[name]._actions for option in action.option_strings}
    epilog = commands()[name].epilog
    for option in ("--json", "--csv"):
        assert (option in epilog) == (option in known)


@pytest.mark.parametrize("name", ["new", "explain", "report"])
@pytest.mark.parametrize("option", ["--json", "--csv"])
def test_formats_that_do_not_apply_are_refused(name, option, capsys):
    example = commands()[name].epilog.partition("kinetostatics ")[2].partition("\n")[0]
    with pytest.raises(SystemExit):
        main([*shlex.split(example), option])
    assert "unrecognized arguments" in capsys.readouterr().err
