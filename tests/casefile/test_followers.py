"""Followers in case files: every law and key of Python, files of points, friction, commands, wrong laws."""

import numpy as np
import pytest

import kinetostatics as ks
from support.commands import printed_by
from support.every import every

HEAD = """
title = "Valve drive"
reference = "drive"
[variants.drive]
mechanism = "chain"
crank_speed = "1500 rpm"
gravity = {}
[[variants.drive.groups]]
"""
SEGMENTS = """
cam.kind = "joined"
cam.smooth = "velocity"
cam.segments = [
  { kind = "dwell", position = "40 mm", angle = "60 deg" },
  { kind = "cycloidal", start = "40 mm", end = "50 mm", angle = "60 deg" },
  { kind = "harmonic", start = "50 mm", end = "45 mm", angle = "60 deg" },
  { kind = "modified sine", start = "45 mm", end = "50 mm", angle = "60 deg" },
  { kind = "modified trapezoid", start = "50 mm", end = "45 mm", angle = "60 deg" },
  { kind = "polynomial", start = "45 mm", end = "40 mm", angle = "60 deg", powers = [4, 5, 6, 7] },
]
"""
ROLLER = '{ radius = "12 mm", width = "15 mm", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }'
FACE = '{ width = "15 mm", youngs_modulus = "210 GPa", poissons_ratio = 0.3, cam_youngs_modulus = "110 GPa" }'
SIXTY = np.pi / 3
JOINED = ks.laws.joined(
    ks.laws.dwell(0.04, SIXTY),
    ks.laws.cycloidal(0.04, 0.05, SIXTY),
    ks.laws.harmonic(0.05, 0.045, SIXTY),
    ks.laws.modified_sine(0.045, 0.05, SIXTY),
    ks.laws.modified_trapezoid(0.05, 0.045, SIXTY),
    ks.laws.polynomial(0.045, 0.04, SIXTY, (4, 5, 6, 7)),
    smooth="velocity",
)
MADE = {
    "roller": (
        'kind = "roller follower"\nguide_angle = "90 deg"\nguide_offset = "2 mm"\npin = "S"\n'
        'label = "_1"\nplane = "10 mm"\n'
        'follower = { mass = "0.5 kg", centre = ["1 mm", "2 mm"], inertia = "0.001 kg m^2" }\nroller = '
        + ROLLER
        + SEGMENTS,
        ks.RollerFollower(
            JOINED,
            ks.Guide.at(np.pi / 2, 0.002),
            ks.Link(0.5, (1e-3, 2e-3), 1e-3),
            pin="S",
            label="_1",
            plane=0.01,
            roller=ks.Roller(0.012, 0.015, 210e9, 0.3),
        ),
    ),
    "flat": (
        'kind = "flat follower"\nguide_through = [["0 m", "0 m"], ["0 m", "1 m"]]\nfollower.mass = "0.5 kg"\n'
        'cam = { kind = "cosine", amplitude = "5 mm", mean = "45 mm", phase = "30 deg" }\nface = ' + FACE,
        ks.FlatFollower(
            ks.laws.cosine(0.005, 0.045, np.pi / 6),
            ks.Guide.through((0.0, 0.0), (0.0, 1.0)),
            ks.Link(0.5),
            face=ks.Face(0.015, 210e9, 0.3, cam_youngs_modulus=110e9),
        ),
    ),
    "swinging": (
        'kind = "swinging follower"\narm_length = "100 mm"\npivot = ["120 mm", "0 mm"]\nassembly = -1\n'
        'pivot_name = "P"\n'
        'arm = { mass = "0.5 kg", centre = "mid-length", inertia = "1e-3 kg m^2" }\n'
        'cam = { kind = "cosine", amplitude = "6 deg", mean = "0.5 rad" }\nroller = ' + ROLLER,
        ks.SwingingFollower(
            ks.laws.cosine(np.radians(6.0), 0.5),
            0.1,
            (0.12, 0.0),
            -1,
            ks.Link(0.5, 0.05, 1e-3),
            pivot_name="P",
            roller=ks.Roller(0.012, 0.015, 210e9, 0.3),
        ),
    ),
}
FRICTION = """
[variants.drive.friction.{contact}]
mu = 0.01
pin_radius = "5 mm"
roller_radius = "12 mm"
rolling_arm = "0.1 mm"
"""


def loaded(tmp_path, text):
    path = tmp_path / "drive.toml"
    path.write_text(text)
    return ks.load_case(path)


@pytest.mark.slow
@every("kind", MADE)
def test_a_case_is_what_python_makes(tmp_path, kind):
    text, group = MADE[kind]
    found = loaded(tmp_path, HEAD + text).solve("drive", 60)
    machine = ks.Mechanism("chain", ks.Crank(None), (group,))
    expected = ks.Scene(machine, 50 * np.pi, loads=[ks.Gravity()]).solve(60)
    assert list(found.mechanism.outputs) == list(expected.mechanism.outputs)
    for name in (*found.scalars, "contact_pressure" + group.label):
        read = ks.Solution.pressure if "pressure" in name else ks.Solution.scalar
        assert np.allclose(read(found, name), read(expected, name), rtol=1e-12, atol=1e-12, equal_nan=True)


@pytest.mark.slow
@every("kind", ["roller", "swinging"])
def test_rollers_rub_by_case_file(tmp_path, kind):
    text, group = MADE[kind]
    found = loaded(tmp_path, HEAD + text + FRICTION.format(contact="contact" + group.label)).solve("drive", 60)
    rubs = found.friction["contact" + group.label]
    assert (rubs.mu, rubs.pin_radius, rubs.roller_radius, rubs.rolling_arm) == (0.01, 0.005, 0.012, 1e-4)
    assert found.losses.total > 0.0
    assert found.power_residual < 1e-13


@every(("kind", "heading", "unit"), [("roller", "mm", 1e3), ("swinging", "deg", 180 / np.pi)])
def test_law_by_points_of_a_file(tmp_path, kind, heading, unit):
    law = ks.laws.cosine(0.1, 0.5) if kind == "swinging" else ks.laws.cosine(0.005, 0.045)
    angle = np.arange(0, 360, 5)
    rows = "\n".join(f"{a}, {p * unit:.5f}" for a, p in zip(angle, law(np.radians(angle)).position, strict=True))
    (tmp_path / "law.csv").write_text(f"angle [deg], position [{heading}]\n{rows}\n")
    text = (
        MADE[kind][0].split("cam")[0] + f'cam = {{ kind = "table", table = "law.csv", noise = "2.9e-6 {heading}" }}\n'
    )
    made = loaded(tmp_path, HEAD + text).variants["drive"].scene.mechanism.groups[0]
    turn = np.linspace(0.0, 6.0, 50)
    assert np.allclose(made.cam.law(turn).position, law(turn).position, rtol=1e-4)


@pytest.mark.slow
def test_run_prints_the_forces(tmp_path, capsys):
    law = 'cam = { kind = "cosine", amplitude = "5 mm", mean = "45 mm" }'
    loaded(tmp_path, HEAD + MADE["roller"][0].replace(SEGMENTS, f"\n{law}\n") + FRICTION.format(contact="contact_1"))
    printed = printed_by(["run", str(tmp_path / "drive.toml")], capsys)
    assert "contact force" in printed
    assert "friction loss contact_1" in printed


WRONG = [
    ('cam = { kind = "cosine", amplitude = "5 mm", mean = "45 mm" }', "5 deg", "cam: cosine: a position"),
    ('cam = { kind = "cosine", amplitude = "5 mm" }', None, "cam.mean is missing"),
    ('cam = { kind = "cosin", amplitude = "5 mm", mean = "45 mm" }', None, "did you mean 'cosine'"),
    ('cam = { kind = "circle", radius = "5 mm" }', None, "kind"),
    ('cam = { kind = "cosine", amplitude = "5 kg", mean = "45 mm" }', None, "amplitude"),
    ('cam = { kind = "cosine", amplitude = "nan mm", mean = "45 mm" }', None, "amplitude"),
    ('cam = { kind = "cosine", amplitude = 5, mean = "45 mm" }', None, "amplitude"),
    ('cam = { kind = "cosine", amplitude = "5 mm", mean = "45 mm", phase = "1 mm" }', None, "phase"),
    ('cam = { kind = "cosine", amplitude = "5 mm", mean = "45 mm", lift = "1 mm" }', None, "lift is not a key here"),
    ('cam = { kind = "joined", segments = [] }', None, "segments"),
    ('cam = { kind = "joined", segments = [{ kind = "dwell", position = "40 mm", angle = "90 deg" }] }', None, "turn"),
    (
        'cam = { kind = "joined", segments = [{ kind = "dwel", position = "40 mm", angle = "1 rad" }] }',
        None,
        "did you mean 'dwell'",
    ),
    ('cam = { kind = "table", table = "none.csv" }', None, "none.csv"),
    ('cam = "cosine"', None, "must be a table with a kind"),
    ("", None, "cam is missing"),
]


@every(("cam", "other", "words"), WRONG)
def test_wrong_laws_are_refused(tmp_path, cam, other, words):
    cam = cam.replace("5 mm", other, 1) if other else cam
    with pytest.raises(ks.CaseError) as caught:
        loaded(tmp_path, f'{HEAD}kind = "roller follower"\n{cam}\n').solve("drive", 8)
    assert words in str(caught.value)


def test_swinging_follower_takes_angles(tmp_path):
    text = MADE["swinging"][0].replace("6 deg", "6 mm")
    with pytest.raises(ks.CaseError, match="cam: cosine: a position"):
        loaded(tmp_path, HEAD + text)


def test_numbers_of_a_law_are_no_paths(tmp_path):
    variant = loaded(tmp_path, HEAD + MADE["flat"][0]).variants["drive"]
    assert not [path for path in variant.scene.places if path.startswith("cam")]
