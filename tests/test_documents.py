"""What the README shows is what runs."""

import re
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def python_blocks():
    return re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)


def test_readme_example_is_short_and_right(capsys):
    code = python_blocks()[0]
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    exec(compile(code, "README", "exec"), {})
    printed = capsys.readouterr().out
    assert "40578.9" in printed
    assert "286772" in printed
    residual = float(printed.rsplit(":", 1)[1])
    assert residual < 1e-14


def test_readme_shaper_runs_and_balances_its_powers(capsys):
    names: dict = {"np": np, "ks": ks, "turn": np.linspace(0, 2 * np.pi, 720, endpoint=False)}
    exec(compile(python_blocks()[1], "README", "exec"), names)
    assert float(capsys.readouterr().out.rsplit(":", 1)[1]) > 800.0
    assert names["s"].power_residual < 1e-14


def test_readme_shows_what_needs_says():
    code, shown = python_blocks()[2].removeprefix(">>> ").split("\n", 1)
    said = str(eval(code, {"ks": ks}))
    number = r"error [-+.e\d]+"
    assert re.sub(number, "", said) == re.sub(number, "", shown.strip())


def test_readme_sweep_runs():
    names: dict = {"ks": ks}
    code = python_blocks()[3].replace(":40", ":3").replace(":30", ":2")
    exec(compile(code.replace('"cam-circle")', '"cam-circle", progress=False)'), "README", "exec"), names)
    assert len(names["table"]) == 6
    assert (names["table"]["failed"] == "").all()


def test_readme_program_gives_torque_and_slope():
    turn = np.linspace(0, 2 * np.pi, 360, endpoint=False)
    names: dict = {"ks": ks, "turn": turn}
    exec(compile(python_blocks()[4], "README", "exec"), names)
    before = names["scene"].solve(turn).balancing_torque
    assert np.abs(names["slope"]).max() > 0.1
    np.testing.assert_allclose(names["torque"] - before, 0.5 * names["slope"], rtol=1e-9, atol=1e-12)


def test_readme_saw_needs_as_little_torque_as_it_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names: dict = {"ks": ks}
    exec(compile(python_blocks()[5], "README", "exec"), names)
    gain, reaction = map(float, capsys.readouterr().out.rsplit("\n", 2)[1].split())
    assert gain == pytest.approx(411.4, abs=0.1)
    assert ks.extremes(names["found"].scene.solve(), "O").largest == pytest.approx(753.0, abs=1.0)
    study = names["saw"].variants["cam-circle"].solve()
    assert ks.compare(study, names["found"].scene.solve()).mean_torque_ratio == pytest.approx(67.7, abs=0.2)
    assert reaction > 300.0
    assert (tmp_path / "cam.svg").stat().st_size > 10_000


def test_readme_links_lead_to_files():
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if "://" not in link]
    assert links
    assert all((ROOT / link).exists() for link in links)


def test_version_is_in_changelog_and_citation():
    section = re.search(r"^## (\S+) - (\S+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert section is not None
    assert section[1] == ks.__version__
    assert f"\nversion: {section[1]}\n" in citation
    assert f'\ndate-released: "{section[2]}"\n' in citation


def test_changelog_lists_changes_of_each_version():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        assert set(re.findall(r"^### (.*)$", section, flags=re.MULTILINE)) <= {"Added", "Changed", "Fixed", "Removed"}
    assert max(map(len, text.splitlines())) <= 130
