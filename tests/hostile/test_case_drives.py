"""Drives in case files that are wrong: each named with file, key, and what is allowed."""

import pytest

import kinetostatics as ks
from support.case_files import problems
from support.every import every

DRIVE_HEAD = """
title = "t"
reference = "a"
[variants.a]
mechanism = "crank-slider"
crank_speed = "60 rpm"
crank_length = "0.1 m"
coupler_length = "0.4 m"
[variants.a.drive]
"""
KLOSS = {
    "kind": '"kloss"',
    "power": '"55 kW"',
    "speed": '"1475 rpm"',
    "synchronous_speed": '"1500 rpm"',
    "overload": "2.5",
}


def kloss(**other):
    return f"motor = {{ {', '.join(f'{key} = {text}' for key, text in {**KLOSS, **other}.items())} }}"


def table(speed, torque):
    return f'motor = {{ kind = "table", speed = {speed}, torque = {torque} }}'


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    ks.load_case("sawframe_2r63")


MOTOR = "variants.a.drive.motor"
WRONG_DRIVES = {
    "empty": ("", f"{MOTOR} is missing"),
    "motor no table": ('motor = "55 kW"', f"{MOTOR} must be a table with a kind, of 'kloss', 'linear'"),
    "no kind": ("motor = {}", f"{MOTOR}.kind is missing; allowed: 'kloss', 'linear', 'constant', 'table'"),
    "kind misspelt": (kloss(kind='"klos"'), f"{MOTOR}.kind is 'klos', allowed: 'kloss'"),
    "key misspelt": (kloss(transmision="3"), "transmision is not a key here; did you mean 'transmission'?"),
    "key of another kind": (kloss(torque='"1 N m"'), f"{MOTOR}.torque is not a key here"),
    "key missing": ('motor = { kind = "linear", speed = "9 rad/s" }', f"{MOTOR}.torque is missing"),
    "wrong unit": (kloss(power='"55 kN"'), f'{MOTOR}.power "kN" does not measure the same as "W"'),
    "frequency for a speed": (kloss(speed='"25 Hz"'), f'{MOTOR}.speed "Hz" does not measure the same as "rad/s"'),
    "no unit": (kloss(speed="1475"), f"{MOTOR}.speed must be text of a number and a unit that converts to rad/s"),
    "power zero": (kloss(power='"0 W"'), f"{MOTOR}.power must be greater than 0 W, found '0 W'"),
    "overload a text": (kloss(overload='"2.5"'), f"{MOTOR}.overload"),
    "overload true": (kloss(overload="true"), f"{MOTOR}.overload"),
    "overload below 1": (kloss(overload="0.5"), f"{MOTOR} is no motor: overload must be greater than 1, got 0.5"),
    "slower than rated": (
        kloss(synchronous_speed='"1400 rpm"'),
        f"{MOTOR} is no motor: synchronous_speed must be greater than the rated speed",
    ),
    "no transmission": (kloss(transmission="0"), f"{MOTOR} is no motor: transmission must not be 0"),
    "transmission infinite": (kloss(transmission="inf"), f"{MOTOR}.transmission"),
    "transmission not a number": (kloss(transmission="nan"), f"{MOTOR}.transmission"),
    "rotor negative": (kloss(inertia='"-1 kg m^2"'), f"{MOTOR}.inertia must be at least 0 kg m^2"),
    "flywheel a mass": (f'{kloss()}\nflywheel = "1000 kg"', 'variants.a.drive.flywheel "kg" does not measure the same'),
    "flywheel negative": (f'{kloss()}\nflywheel = "-1 kg m^2"', "variants.a.drive.flywheel must be at least 0 kg m^2"),
    "constant of nothing": ('motor = { kind = "constant", torque = "0 N m" }', "is no motor: torque must not be 0"),
    "rows no list": (table('"0 rpm"', '["1 N m"]'), f"{MOTOR}.speed must be a list such as"),
    "rows empty": (table("[]", "[]"), f"{MOTOR}.speed must be a list such as"),
    "rows of two lengths": (table('["0 rpm", "9 rpm"]', '["1 N m"]'), "must be of one length, 2 at least, got 2 and 1"),
    "rows that fall": (table('["9 rpm", "0 rpm"]', '["1 N m", "0 N m"]'), "is no motor: speeds must rise"),
    "row without unit": (table('["0 rpm", 9]', '["1 N m", "0 N m"]'), f"{MOTOR}.speed must be text of a number"),
}


@every(("text", "message"), WRONG_DRIVES.values(), ids=WRONG_DRIVES)
def test_a_wrong_drive_is_named_with_its_key(tmp_path, text, message):
    assert message in "\n".join(problems(tmp_path, DRIVE_HEAD + text))


@pytest.mark.parametrize("text", ['"55 kW"', "true", "[]", "[{}]"])
def test_a_drive_that_is_no_table_is_named(tmp_path, text):
    (found,) = problems(tmp_path, DRIVE_HEAD.replace("[variants.a.drive]", f"drive = {text}"))
    assert found.startswith("variants.a.drive")
