"""Case files with faults in mechanisms, loads, designs or drives: each message names the key and the remedy."""

import re

import pytest

import kinetostatics as ks
from support.case_files import case_file, problems, saw_with
from support.every import every

HEAD = 'title = "t"\nreference = "a"\n'
CHAIN = """
[variants.a]
crank_speed = "60 rpm"
crank_length = "0.1 m"
[[variants.a.groups]]
kind = "slider"
coupler_length = "0.4 m"
slider = { mass = "2 kg" }
"""
GROUP = "[[variants.a.groups]]\n"
LOAD = "[[variants.a.loads]]\n"
FORCE = LOAD + 'kind = "force"\nvalue = "1 N"\nat = "B"\n'


WRONG = {
    "no kind": (GROUP + 'on = "A"', "variants.a.groups[2].kind is missing; allowed: 'slider', 'rocker'"),
    "kind of a load": (GROUP + 'kind = "torque"', "variants.a.groups[2].kind is 'torque', allowed: 'slider', 'rocker'"),
    "kind misspelt": (LOAD + 'kind = "point_spring"', "variants.a.loads[1].kind is 'point_spring', allowed: 'spring'"),
    "kind no text": (LOAD + "kind = 5", "variants.a.loads[1].kind is 5, allowed: 'spring', 'process force'"),
    "kind a list": (LOAD + 'kind = ["force"]', "variants.a.loads[1].kind is ['force'], allowed: 'spring'"),
    "empty": (LOAD, "variants.a.loads[1].kind is missing; allowed: 'spring'"),
    "key misspelt": (
        GROUP + 'kind = "pin"\non = "crank"\nat = ["1 m", "0 m"]\nnam = "Q"',
        "variants.a.groups[2].nam is not a key here; did you mean 'name'? (allowed: kind, on, at, name, plane)",
    ),
    "key of another kind": (
        FORCE + 'between = ["A", "B"]',
        "variants.a.loads[1].between is not a key here (allowed: k",
    ),
    "key missing": (LOAD + 'kind = "force"\nat = "B"', "variants.a.loads[1].value is missing"),
    "length missing": (GROUP + 'kind = "slider"', "variants.a.groups[2].coupler_length is missing"),
    "wrong unit": (FORCE.replace("1 N", "1 N m"), 'variants.a.loads[1].value "N m" does not measure the same as "N"'),
    "no unit": (
        FORCE.replace("1 N", "1"),
        'variants.a.loads[1].value has no unit; write for example "1 N"; or write a',
    ),
    "a bare number": (FORCE.replace('"1 N"', "1"), "variants.a.loads[1].value must be text of a number and a unit"),
    "list of values": (FORCE.replace('"1 N"', '["1 N"]'), "variants.a.loads[1].value must be text of a number and a"),
    "not finite": (FORCE.replace("1 N", "nan N"), "variants.a.loads[1].value must be text of a number and a unit"),
    "negative stiffness": (
        LOAD + 'kind = "point spring"\nstiffness = "-1 N/m"\nbetween = ["B", ["0 m", "1 m"]]',
        "variants.a.loads[1].stiffness must be at least 0 N/m, found '-1 N/m'",
    ),
    "length of nothing": (
        GROUP + 'kind = "dyad"\nlength1 = "0 m"\nlength2 = "1 m"',
        "variants.a.groups[2].length1 must be greater than 0 m, found '0 m'",
    ),
    "one joint twice": (
        GROUP + 'kind = "dyad"\nlength1 = "1 m"\nlength2 = "1 m"\non = ["B", "B"]',
        "variants.a.groups[2].on must name two different joints, got 'B' twice",
    ),
    "label no text": (
        GROUP + 'kind = "slider"\ncoupler_length = "1 m"\nlabel = 2',
        "variants.a.groups[2].label must be a name, a text of one line, got 2",
    ),
    "assembly": (
        GROUP + 'kind = "rocker"\ncoupler_length = "1 m"\nrocker_length = "1 m"\npivot = ["1 m", "0 m"]\nassembly = 0',
        "variants.a.groups[2].assembly must be 1 or -1, or one of 'open', 'crossed', found 0",
    ),
    "assembly of a dyad in words": (
        GROUP + 'kind = "dyad"\nlength1 = "1 m"\nlength2 = "1 m"\nassembly = "open"',
        "variants.a.groups[2].assembly must be 1 or -1, found 'open'",
    ),
    "pivot no pair": (
        GROUP + 'kind = "lever"\npivot = "1 m"',
        'variants.a.groups[2].pivot must be a pair such as ["0.1 m"',
    ),
    "a name of three": (
        FORCE.replace('"B"', '["coupler", "0 m", "0 m", "0 m"]'),
        'variants.a.loads[1].at must be a joint ("B"), a place on a link',
    ),
    "point of numbers": (
        FORCE.replace('"B"', "[1.0, 0.0]"),
        "variants.a.loads[1].at must be text of a number and a unit",
    ),
    "point of one unit": (FORCE.replace('"B"', '["1 m", "0 kg"]'), 'variants.a.loads[1].at "kg" does not measure the'),
    "comma": (
        FORCE.replace('"B"', '["1,5 m", "0 m"]'),
        "variants.a.loads[1].at must be text of a number and a unit that",
    ),
    "one point": (
        LOAD + 'kind = "point damper"\ncoefficient = "1 N s/m"\nbetween = "B"',
        "variants.a.loads[1].between must be a pair of points, each a joint",
    ),
    "group as a table": (
        '[variants.b]\ncrank_speed = "1 rpm"\ngroups = {}',
        "variants.b.groups must be a list of tables, each",
    ),
    "no group at all": (
        '[variants.b]\ncrank_speed = "1 rpm"\ngroups = []',
        "variants.b.groups must be a list of tables, each under [[groups]], 1 at least",
    ),
    "group no table": (
        '[variants.b]\ncrank_speed = "1 rpm"\ngroups = ["slider"]',
        "variants.b.groups[1] must be a table with a kind, of 'slider', 'rocker'",
    ),
    "groups of a crank-slider": (
        '[variants.b]\nmechanism = "crank-slider"\ngroups = []',
        "variants.b.groups is not a key here",
    ),
    "both ways of a guide": (
        GROUP + 'kind = "yoke"\nguide_angle = "1 deg"\nguide_through = [["0 m", "0 m"], ["1 m", "0 m"]]',
        "variants.a.groups[2]: give either guide_through or guide_angle and guide_offset",
    ),
    "slot along the guide": (
        GROUP + 'kind = "yoke"\nslot_angle = "180 deg"',
        "variants.a.groups[2]: yoke group: slot_angle 3.14159 rad makes the slot parallel to the guide",
    ),
    "mid-length of a slider": (
        GROUP + 'kind = "slider"\ncoupler_length = "1 m"\nlabel = "2"\npin = "D"\nslider = { centre = "mid-length" }',
        'variants.a.groups[2]: centre "mid-length" needs a link between two joints',
    ),
    "joint that is not there": (
        GROUP + 'kind = "slider"\ncoupler_length = "1 m"\nlabel = "2"\npin = "D"\non = "Q"',
        "variants.a: chain: SliderGroup is attached to joint 'Q', which no part before it places",
    ),
    "joint twice": (
        GROUP + 'kind = "slider"\ncoupler_length = "1 m"\nlabel = "2"',
        "variants.a: chain: SliderGroup adds joint 'B' a second time",
    ),
    "force on no joint": (FORCE.replace('"B"', '"Q"'), "variants.a.loads[1]: Force: at is 'Q', allowed: 'O', 'A', 'B'"),
    "force on no link": (
        FORCE.replace('"B"', '["couplr", "1 m"]'),
        "variants.a.loads[1]: Force: link of at is 'couplr', allowed: 'crank', 'coupler', 'slider', 'frame'; did you",
    ),
    "torque on a joint": (
        LOAD + 'kind = "torque"\nvalue = "1 N m"\non = "B"',
        "variants.a.loads[1]: Torque: on is 'B', allowed: 'crank', 'coupler', 'slider'",
    ),
    "spring on no slider": (
        LOAD + 'kind = "spring"\nstiffness = "balance the slider"\nfree_position = "1 m"\non = "slider2"',
        "variants.a.loads[1]: Spring: on is 'slider2', allowed: 'slider'",
    ),
    "no such file": (FORCE.replace('"1 N"', '{ file = "none.csv" }'), "none.csv: cannot be read: No such file"),
    "no file": (FORCE.replace('"1 N"', '{ over = "angle" }'), "variants.a.loads[1].value.file is missing"),
    "file no text": (
        FORCE.replace('"1 N"', "{ file = 5 }"),
        "variants.a.loads[1].value.file: input should be a valid str",
    ),
    "over what": (
        FORCE.replace('"1 N"', '{ file = "t.csv", over = "time" }'),
        "variants.a.loads[1].value.over: input should be 'angle' or 'travel', found 'time'",
    ),
    "period": (
        FORCE.replace('"1 N"', '{ file = "t.csv", period = "500 deg" }'),
        "variants.a.loads[1].value.period must be a whole number of turns",
    ),
}


@every("name", WRONG)
def test_wrong_part_is_named_by_key_and_allowed(tmp_path, name):
    text, message = WRONG[name]
    found = problems(tmp_path, HEAD + CHAIN + text + "\n")
    assert any(line.startswith(message) or message in line for line in found), found
    assert all(len(line) < 600 for line in found)


def test_all_faults_of_a_chain_are_listed(tmp_path):
    """Of tables, then of files and of what loads name: a file that is missing hides no other problem."""
    keys = [
        ("groups[1].coupler_length", 'coupler_length = "0.4 m"', 'coupler_length = "0.4 kg"'),
        ("groups[1].kind", 'kind = "slider"', 'kind = "slidr"'),
        ("loads[1].value", '"1 N"', "1"),
        ("loads[2].stiffness", "2 N/m", "-2 N/m"),
        ("loads[3].valu", "value =", "valu ="),
        ("loads[3].value", "", ""),
    ]
    spring = LOAD + 'kind = "point spring"\nstiffness = "2 N/m"\nbetween = ["B", ["0 m", "1 m"]]\n'
    text = HEAD + CHAIN + FORCE + spring + FORCE.replace("value", "valu")
    for _, before, after in keys[:4]:
        text = text.replace(before, after, 1)
    found = problems(tmp_path, text)
    assert sorted(line.split()[0].removeprefix("variants.a.") for line in found) == sorted(key for key, *_ in keys)
    text = HEAD + CHAIN + FORCE.replace('"1 N"', '{ file = "none.csv" }') + FORCE.replace('"B"', '"Q"')
    found = problems(tmp_path, text + spring.replace('"B"', '"P"').replace("0 m", "0 mm"))
    assert [line.split(":")[0] for line in found] == [
        f"variants.a.loads[{n}]{e}" for n, e in ((1, ".value"), (2, ""), (3, ""))
    ]


def test_fault_in_common_is_reported_once(tmp_path):
    text = (HEAD + CHAIN + FORCE).replace("variants.a", "common").replace('"1 N"', '{ file = "none.csv" }')
    (found,) = problems(tmp_path, text.replace('"0.4 m"', '"4 dm"') + "[variants.a]\n[variants.b]\n")
    assert found.startswith("common.loads[1].value: ")
    found = problems(tmp_path, text.replace('"0.4 m"', '"0.4 kg"') + "[variants.a]\n[variants.b]\n")
    assert found == (
        'common.groups[1].coupler_length "kg" does not measure the same as "m"; give a unit that converts to it',
    )


# Tables of values

ANGLES = "crank_angle [deg], force [kN]\n0, 1\n90, 3\n180, 2\n270, 0\n"
TRAVEL = "travel [mm], pressure [bar], pressure_back [bar]\n300, 8, 2\n400, 4, 1\n500, 1, 0\n"
AREA = 'area = "10 cm^2"'
WRONG_TABLES = {
    "a gap": (ANGLES.replace("3", ""), "", "column 'force [kN]', line 3: not a number: ''"),
    "wrong unit": (ANGLES.replace("kN", "kg"), "", '"kg" does not measure the same as "N"'),
    "a torque": (
        ANGLES.replace("force [kN]", "torque [N m]"),
        "",
        "no column 'force'; it has 'crank_angle [deg]', 'to",
    ),
    "no unit": (ANGLES.replace(" [kN]", ""), "", "column 'force': has no unit; head it for example \"force [N]\""),
    "angles in metres": (ANGLES.replace("deg", "mm"), "", '"mm" does not measure the same as "rad"'),
    "pressure without area": (TRAVEL, "", "no column 'force', but pressures; give the area"),
    "area without pressure": (ANGLES, AREA, "no column 'pressure'; it has 'crank_angle [deg]', 'force [kN]'"),
    "area in metres": (TRAVEL, 'area = "10 cm"', '"cm" does not measure the same as "m^2"'),
    "pressure in newtons": (TRAVEL.replace("bar", "N", 1), AREA, '"N" does not measure the same as "Pa"'),
    "unsorted travel": (TRAVEL.replace("400", "200"), AREA, "travel must rise, but 0.2 m follows 0.3 m in row 2"),
    "unsorted falling travel": (
        "travel [mm], force [N]\n500, 1\n600, 2\n400, 3\n300, 1\n",
        "",
        "travel must fall, but 0.6 m follows 0.5 m in row 2",
    ),
    "one row of travel": ("travel [m], force [N]\n0.3, 1\n", "", "at least 2 rows are needed, got 1"),
    "degrees as radians": (ANGLES.replace("deg", "rad"), "", "more than the period of 360 deg; are they degrees"),
    "half a turn": (ANGLES.replace("90", "45").replace("180", "90").replace("270", "135"), "", "rows are missing"),
    "travel too short": (
        TRAVEL.replace("300", "310"),
        AREA,
        "the slider goes from 0.3 to 0.5 m, but the table from 0.31 to 0.5 m",
    ),
    "travel from the dead centre": (
        TRAVEL.replace("300", "0").replace("400", "100").replace("500", "200"),
        AREA,
        "Travel is the coordinate of the pin along the guide",
    ),
    "travel of no slider": (TRAVEL, f'{AREA}, slider = "slider2"', "slider is 'slider2', allowed: 'slider'"),
    "slider of an angle": (ANGLES, 'slider = "slider"', 'slider is for a table over="travel"'),
    "over a column that is not there": (ANGLES, 'over = "travel"', "no column 'travel'; it has 'crank_angle [deg]'"),
    "period over travel": (TRAVEL, f'{AREA}, period = "720 deg"', "over travel the period is one turn"),
}


@every("name", WRONG_TABLES)
def test_wrong_table_names_key_file_and_row(tmp_path, name):
    content, options, message = WRONG_TABLES[name]
    (tmp_path / "t.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
    entry = f'{{ file = "t.csv"{", " if options else ""}{options} }}'
    found = problems(tmp_path, HEAD + CHAIN + FORCE.replace('"1 N"', entry))
    assert message in found[0]
    assert all(line.startswith("variants.a.loads[1]") for line in found)


GOOD_TABLES = {
    "that ends a turn later": ((ANGLES + "360, 1\n").encode(), ""),
    "falling": (b"travel [m], force [N]\n0.5, 1\n0.3, 2\n", ""),
    "in other units": (TRAVEL.replace("bar", "kPa").replace("mm", "cm").replace("00,", "0,").encode(), AREA),
    "with columns to spare": (TRAVEL.replace("\n", ", 1\n").replace("[bar], 1", "[bar], row [1]").encode(), AREA),
}


@every("name", GOOD_TABLES)
def test_a_table_as_programs_write_them_is_read(tmp_path, name):
    content, options = GOOD_TABLES[name]
    (tmp_path / "t.csv").write_bytes(content)
    entry = f'{{ file = "t.csv"{", " if options else ""}{options} }}'
    case = ks.load_case(case_file(tmp_path, HEAD + CHAIN + FORCE.replace('"1 N"', entry)))
    assert re.match("(angle|travel)", case.variant("a").loads[0].value.over)


# Designs in case files that are wrong

INTRO = '[design.one]\nkind = "optimum"\nvariant = "cam-circle"\n'
VARY = 'vary = { "spring.stiffness" = ["600 kN/m", "900 kN/m"] }\n'
AIM = 'minimise = "largest O"\n'
CAM = '[design.one]\nkind = "torque-free-cam"\nvariant = "cam-cosine"\n'
SPREADS = '"slider.mass" = "normal 0 % +- 1 %"'
WRONG_DESIGNS = {
    "no table": ("[design]\none = 3\n", "design.one must be a table of keys and values, found 3"),
    "no kind": ("[design.one]\n", "design.one.kind is missing; allowed: 'optimum', 'torque-free-cam', 'front'"),
    "kind misspelt": (
        f"{INTRO}{VARY}{AIM}".replace("optimum", "optimun"),
        "design.one.kind is 'optimun', allowed: 'optimum'",
    ),
    "key misspelt": (f"{INTRO}{VARY}{AIM}limit = []\n", "design.one.limit is not a key here; did you mean 'limits'?"),
    "key of another kind": (f"{INTRO}{VARY}{AIM}cosine = 3\n", "design.one.cosine is not a key here"),
    "nothing varies": (f"{INTRO}{AIM}", "design.one.vary is missing"),
    "no aim": (f"{INTRO}{VARY}", "design.one needs either minimise or maximise"),
    "variant not there": (
        f'[design.one]\nkind = "optimum"\nvariant = "cam-circl"\n{VARY}{AIM}',
        "design.one.variant is 'cam-circl', allowed: 'plain', 'cam-circle', 'cam-cosine', 'upright-plain', "
        "'upright-circle', 'upright-cosine', 'upright-optimal'; did you mean 'cam-circle'?",
    ),
    "reference not there": (f'{INTRO}{VARY}{AIM}reference = "plane"\n', "design.one.reference is 'plane', allowed"),
    "variant is itself": (
        '[design.cam-circle]\nkind = "torque-free-cam"\nvariant = "cam-circle"\n',
        "design.cam-circle.variant is the name of the result: give another",
    ),
    "number not there": (
        f'{INTRO}{AIM}vary = {{ "spring.stifness" = ["6 N/m", "9 N/m"] }}\n',
        "design.one.vary: parameter is 'spring.stifness', allowed",
    ),
    "bounds fall": (
        f'{INTRO}{AIM}vary = {{ "spring.stiffness" = ["9 N/m", "6 N/m"] }}\n',
        "design.one.vary: bounds of spring.stiffness must be (low, high), got ('9 N/m', '6 N/m'): they must be finite",
    ),
    "bounds of another unit": (
        f'{INTRO}{AIM}vary = {{ "spring.stiffness" = ["9 N", "60 N"] }}\n',
        '"N" does not measure the same as "N/m"',
    ),
    "output misspelt": (f'{INTRO}{VARY}minimise = "largest Q"\n', "design.one.minimise: cam-balanced crank-slider: "),
    "output a place": (
        f'{INTRO}{VARY}minimise = "largest_at O"\n',
        "design.one.minimise: output 'largest_at O' is a pl",
    ),
    "limit of no form": (
        f'{INTRO}{VARY}{AIM}limits = ["largest O < 3 kN"]\n',
        "design.one.limits[1]: limit 'largest O < 3 kN' must be an output, a relation and a value",
    ),
    "limit of another unit": (
        f'{INTRO}{VARY}{AIM}limits = ["mean O <= 3 kN", "largest O <= 3 m"]\n',
        'design.one.limits[2]: limit \'largest O <= 3 m\': "m" does not measure the same as "N"',
    ),
    "no counterweight": (f'{CAM}counterweight = "0 kg"\n', "design.one: counterweight must be greater than 0, got 0.0"),
    "limits a text": (
        f'{INTRO}{VARY}{AIM}limits = "largest O <= 3 kN"\n',
        "design.one.limits: input should be a valid t",
    ),
    "ratio to what the reference has not": (
        f'{INTRO}{VARY}maximise = "ratio largest cam_force"\n',
        "design.one.maximise: crank-slider: quantity is 'cam_force', allowed",
    ),
    "starts none": (f"{INTRO}{VARY}{AIM}starts = 0\n", "design.one.starts: input should be greater than or equal to 1"),
    "starts a million": (f"{INTRO}{VARY}{AIM}starts = 1000000\n", "design.one.starts: input should be less than or"),
    "seed below 0": (f"{INTRO}{VARY}{AIM}seed = -1\n", "design.one.seed: input should be greater than or equal to 0"),
    "angles few": (f"{INTRO}{VARY}{AIM}angles = 3\n", "design.one.angles: input should be greater than or equal to 12"),
    "harmonics none": (f"{CAM}cosine = 0\n", "design.one.cosine: input should be greater than or equal to 1, found 0"),
    "harmonics half": (f"{CAM}sine = 2.5\n", "design.one.sine: input should be a valid integer"),
    "ends one": (f'{CAM}ends = ["1.7 m"]\n', "design.one.ends must be a pair"),
    "ends without unit": (f"{CAM}ends = [1.7, 2.3]\n", "design.one.ends must be text of a number and a unit"),
    "counterweight below 0": (f'{CAM}counterweight = "-3 kg"\n', "design.one.counterweight must be at least 0 kg"),
    "coupler spring on the wrong side": (
        f'{CAM}coupler_spring = "90 deg"\n',
        "design.one: coupler_spring, a free angle, must be negative, got 1.5708 rad",
    ),
    "quantile beyond 1": (
        f"{CAM}robust = {{ quantile = 2.0, spreads = {{ {SPREADS} }} }}\n",
        "design.one.robust is no spread: quantile must lie between 0 and 1, got 2.0",
    ),
    "spread of what is not there": (
        f'{CAM}robust = {{ quantile = 0.1, spreads = {{ "slider.mas" = "normal 0 % +- 1 %" }} }}\n',
        "design.one.robust.spreads: parameter is 'slider.mas', allowed",
    ),
    "spread of no form": (
        f'{CAM}robust = {{ quantile = 0.1, spreads = {{ "slider.mass" = "1 %" }} }}\n',
        "design.one.robust is no spread: cannot read '1 %' for slider.mass",
    ),
    "front of one": (f'[design.one]\nkind = "front"\n{VARY}minimise = ["largest O"]\n', "design.one.minimise: "),
}


@pytest.mark.parametrize("name", WRONG_DESIGNS)
def test_a_wrong_design_is_told_with_its_key(tmp_path, name):
    text, message = WRONG_DESIGNS[name]
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(saw_with(text, tmp_path))
    assert len(caught.value.problems) == 1
    assert message in caught.value.problems[0]


def test_problems_of_all_designs_are_told_at_once(tmp_path):
    some = ("kind misspelt", "number not there", "limit of no form", "harmonics none", "quantile beyond 1")
    text = "".join(
        WRONG_DESIGNS[name][0].replace("[design.one", f"[design.{place}")
        for place, name in zip("abcde", some, strict=True)
    )
    with pytest.raises(ks.CaseError) as caught:
        ks.load_case(saw_with(text, tmp_path))
    assert [problem.split(".")[1][0] for problem in caught.value.problems] == list("abcde")


# Drives in case files that are wrong

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
    "rows of two lengths": (
        table('["0 rpm", "9 rpm"]', '["1 N m"]'),
        "must have the same length, at least 2, got 2 and 1",
    ),
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
