"""Run notebooks and keep their outputs, small: ``python docs/execute_notebooks.py [NAME ...]``, all unless told.

Each figure is kept as SVG or PNG, whichever is smaller. ``--check`` runs nothing: it says what is wrong with what is
kept.
"""

import argparse
import base64
import io
import json
import os
import re
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "notebooks"
MOST = 300_000
"""Bytes of pictures in a notebook."""
COLOURS = 128
KERNEL = """c = get_config()
c.InlineBackend.figure_formats = {"png", "svg"}
c.InlineBackend.rc = {"figure.dpi": 96, "svg.hashsalt": "kinetostatics"}
"""
"""How its figures are drawn."""


def executed(path):
    """The notebook with the outputs of this run."""
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=1800, resources={"metadata": {"path": str(path.parent)}}).execute()
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
        for output in cell.get("outputs", ()):
            choose_picture(output.get("data", {}))
    notebook.metadata.pop("widgets", None)
    return nbformat.writes(notebook) + "\n"


def choose_picture(data):
    """Leave one of both pictures of a figure."""
    if "image/png" in data:
        data["image/png"] = base64.b64encode(fewer_colours(base64.b64decode(data["image/png"]))).decode()
    if {"image/png", "image/svg+xml"} <= data.keys():
        small = min(("image/png", "image/svg+xml"), key=lambda kind: len(data[kind]))
        del data["image/png" if small != "image/png" else "image/svg+xml"]


def fewer_colours(png):
    """The same picture with so many colours as drawings need."""
    from PIL import Image

    made = io.BytesIO()
    Image.open(io.BytesIO(png)).convert("RGB").quantize(COLOURS).save(made, format="PNG", optimize=True)
    return min(png, made.getvalue(), key=len)


def problems(path):
    """What is wrong with the outputs that a notebook was saved with."""
    cells = [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    counts = [cell["execution_count"] for cell in cells]
    outputs = [output for cell in cells for output in cell["outputs"]]
    shown = [kind for output in outputs for kind in output.get("data", {})]
    if counts != list(range(1, len(cells) + 1)):
        yield "its cells were not run once, from first to last"
    if any(output["output_type"] == "error" for output in outputs):
        yield "it holds an error"
    if not any(kind.startswith("image/") for kind in shown):
        yield "it shows no picture"
    if any("widget" in kind for kind in shown):
        yield "it holds a widget, which nothing draws on a page"
    if any("://" in link for output in outputs for link in loaded(output)):
        yield "it loads something from elsewhere"
    if (size := pictures(outputs)) > MOST:
        yield f"its pictures take {size} bytes, {MOST} at most"


def loaded(output):
    """Links and sources in the HTML of an output."""
    html = output.get("data", {}).get("text/html", "")
    return re.findall(r"""(?:href|src)=["']([^"']+)""", html if isinstance(html, str) else "".join(html))


def pictures(outputs):
    """Bytes of all pictures."""
    texts = [
        (kind, content if isinstance(content, str) else "".join(content))
        for output in outputs
        for kind, content in output.get("data", {}).items()
        if kind.startswith("image/")
    ]
    return sum(len(text if "svg" in kind else base64.b64decode(text)) for kind, text in texts)


def main():
    """Run or check the notebooks named."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", help="notebooks, without their ending; all unless told")
    parser.add_argument("--check", action="store_true", help="run nothing, look at what is kept")
    asked = parser.parse_args()
    paths = [FOLDER / f"{name}.ipynb" for name in asked.names] or sorted(FOLDER.glob("*.ipynb"))
    if not asked.check:
        with tempfile.TemporaryDirectory() as folder:
            kernel = Path(folder) / "profile_default" / "ipython_kernel_config.py"
            kernel.parent.mkdir()
            kernel.write_text(KERNEL, encoding="utf-8")
            os.environ["IPYTHONDIR"] = folder
            os.environ.pop("MPLBACKEND", None)  # another one would show no figures
            for path in paths:
                path.write_text(executed(path), encoding="utf-8")
                print(path.stem, flush=True)
    found = [f"{path.name}: {problem}" for path in paths for problem in problems(path)]
    sys.exit("\n".join(found) or None)


if __name__ == "__main__":
    main()
