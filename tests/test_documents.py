"""What README and notebooks show is what runs."""

import ast
import itertools
import json
import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from matplotlib.animation import FuncAnimation

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def test_readme_example_gives_its_numbers_in_at_most_ten_lines(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    exec(compile(code, "README", "exec"), {})
    printed = capsys.readouterr().out
    assert "40578.9411" in printed
    assert "286772" in printed
    residual = float(printed.rsplit(":", 1)[1])
    assert residual < 1e-14


def test_readme_links_lead_to_files():
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if "://" not in link]
    assert links
    assert all((ROOT / link).exists() for link in links)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs_and_is_saved_without_output(path, monkeypatch):
    """Of a film two frames, each of which takes as long to draw as a figure."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert all(not cell["outputs"] and cell["execution_count"] is None for cell in cells)
    pytest.importorskip("IPython", reason="notebooks need the extra: pip install .[notebooks]")
    names: dict = {}
    monkeypatch.setattr(plt, "show", lambda: None)
    frames = FuncAnimation.new_saved_frame_seq
    monkeypatch.setattr(FuncAnimation, "new_saved_frame_seq", lambda film: itertools.islice(frames(film), 2))
    for cell in cells:
        tree = ast.parse("".join(cell["source"]))
        exec(compile(tree, path.name, "exec"), names)
    plt.close("all")
