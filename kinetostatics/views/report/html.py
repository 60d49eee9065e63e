"""The HTML page of a report: data, tables and figures in its template, without external files; and its PDF.

A browser without a window prints the PDF.
"""

import base64
import datetime as dt
import math
import os
import platform
import shutil
import subprocess
import tempfile
import warnings
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from ...cycle.losses import lose
from ...errors import FileError, MissingLibraryError
from ...numbers.formatting import pretty_unit
from ...version import __version__
from ..canvas import display_unit, grouped
from ..movement import movements, turning_sense
from ..page import bundle, packed, source
from . import tables
from .tables import readings

COLOURS = ("#1f4e79", "#b5482f", "#3a7d44", "#8a6d1d", "#6b4a8f", "#3f6f7f", "#8c3b5e", "#5a5a5a")
"""Quiet colours of the machines, in their order."""
DASHES = ("", "6", "2 4 6 4", "2 4", "6 4 2 4", "", "6", "2 4 6 4")
"""Dash arrays of the machines; they distinguish curves in print without colour."""

QUANTITY_GROUPS = {
    "Forces and torques": ("force", "reaction", "friction", "whole"),
    "Forces on the frame": ("ground",),
    "Motion": ("slider", "motion", "rate"),
}
"""Kinds of quantities by the heading of their values."""
PROGRESS_STEPS = 9
"""Steps of the work, each announced by `progress`."""
WIDE_RATIO = 1.7
"""Width over height above which two drawings fill a line."""


def require_jinja():
    """Import Jinja2; an error with the install command if it is missing."""
    try:
        import jinja2
    except ImportError:
        raise MissingLibraryError(
            'a report needs Jinja2, which is not installed: pip install "kinetostatics[report]"'
        ) from None
    return jinja2


def page(subject, progress=lambda text: None):
    """HTML text of the page of a subject, with the warnings of its computation.

    ``progress(text)`` announces each step.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = _contents(subject, progress)
    progress("page")
    jinja2 = require_jinja()
    made = jinja2.Environment(
        loader=jinja2.FunctionLoader(_template),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.policies["json.dumps_kwargs"] = {"separators": (",", ":")}
    return made.get_template("page.html.j2").render(found, remarks=[*remarks(caught), *found["reasons"]])


def remarks(caught):
    """Texts of the user's warnings, each once."""
    return list(dict.fromkeys(str(item.message) for item in caught if issubclass(item.category, UserWarning)))


def _contents(subject, progress):
    """Contents of the template."""
    from markupsafe import Markup

    progress("movement")
    moving = movements(subject.machines)
    progress("values")
    values = readings(subject.machines)
    progress("extremes")
    contents = {"glance": tables.glance(subject), "extremes": tables.extremes(subject)}
    progress("comparisons")
    contents |= {"comparisons": tables.comparisons(subject), "shares": tables.shares(subject)}
    progress("certainty")
    contents |= {"certainty": tables.certainty(subject), "losses": tables.losses(subject)}
    progress("drive")
    contents["parts"] = tables.parts(subject)
    runs, contents["drive"], reasons = tables.drive_tables(subject)
    contents["inputs"] = tables.inputs(subject)
    progress("formulas")
    turning = _turning(subject)
    calculations = tables.calculations(subject, turning["start"])
    progress("figures")
    drawn = _figures(subject, values, runs)
    boxes = [item["box"] for item in moving]
    data = {**turning, "drawings": moving, "quantities": values, "figures": drawn["items"]}
    header, buffers = packed(data | {"colours": COLOURS, "dashes": DASHES})
    return {
        "subject": subject,
        "tables": contents,
        "figures": drawn,
        "reasons": reasons,
        "calculations": {name: Markup(text) for name, text in calculations.items()},
        "groups": {
            head: [name for name in values if values[name]["kind"] in kinds] for head, kinds in QUANTITY_GROUPS.items()
        },
        "values": values,
        "vectors": [name for name, item in values.items() if item["vector"]],
        "reactions": list(dict.fromkeys(name for item in moving for name in item["arrows"])),
        "colours": COLOURS,
        "dashes": DASHES,
        "together": _same_torque_text(subject),
        "wide": any(right - left > WIDE_RATIO * (high - low) for left, low, right, high in boxes),
        "published": _published(subject),
        "made": {"version": __version__, "python": platform.python_version(), "numpy": np.__version__},
        "date": dt.date.today().isoformat(),
        "data": header,
        "arrays": [base64.b64encode(buffer).decode("ascii") for buffer in buffers],
        "style": Markup(source("style.css") + source("report.css")),
        "script": Markup(bundle("report.js")),
        "speeds": [
            {"rpm": mean * 30.0 / math.pi, "turn": 2.0 * math.pi / mean if mean else math.inf}
            for mean in (float(np.mean(np.abs(machine.scene.crank_speed))) for machine in subject.machines.values())
        ],
    }


def _published(subject):
    """Paragraphs on the source and the reading of published figures."""
    if subject.case is None:
        return []
    printed = subject.case.published
    where = f"Published figures: {printed.where} of {subject.source or 'the source'}." if printed.where else ""
    return [text for text in (where, printed.note) if text]


def _same_torque_text(subject):
    """Sentence on machines with equal torque, whose curves coincide; "" if there are none."""
    torques = {name: solution.balancing_torque for name, solution in subject.solutions.items()}

    def alike(name, other):
        first, torque = torques[name], torques[other]
        largest = np.nanmax(np.abs(first), initial=1e-300)
        return first.shape == torque.shape and np.nanmax(np.abs(first - torque)) < 1e-9 * largest

    same = [" and ".join(group) for group in grouped(torques, alike) if len(group) > 1]
    return f"Curves coincide for machines with the same torque: {'; '.join(same)}." if same else ""


def _turning(subject):
    """Selectable angles, the first one shown, and the sense of the crank."""
    machines = list(subject.machines.values())
    first = subject.reference.solution
    torque = np.abs(first.balancing_torque)
    return {
        "step": subject.reference.step,
        "counts": [machine.solution.crank_angle.size for machine in machines],
        "between": [np.degrees(machine.between.crank_angle) for machine in machines],
        "start": int(np.nanargmax(torque)) if np.isfinite(torque).any() else 0,
        "sense": turning_sense(first),
    }


def _figures(subject, values, runs):
    """Figures by name: quantity or curves, height in pixels, and whether in the plane; the choices of the page."""
    joint = "O" if "O" in values else next((name for name, item in values.items() if item["kind"] == "reaction"), None)
    first = next((name for name, item in values.items() if item["kind"] == "slider" and "accel" in name), None)
    explored = first or "balancing_torque"
    made: dict[str, dict[str, Any]] = {"torque": {"quantity": "balancing_torque", "height": 320}}
    if joint:
        made["hodograph"] = {"quantity": joint, "height": 420, "plane": True}
    made["explore"] = {"quantity": explored, "height": 420}
    for name, item in values.items():
        if item["kind"] == "reaction":
            made[f"reaction {name}"] = {"quantity": name, "height": 230}
        if item["kind"] == "ground":
            made[name] = {"quantity": name, "height": 300, "plane": True}
    if any(lose(solution) for solution in subject.solutions.values()) and "friction_loss" in values:
        made["loss"] = {"quantity": "friction_loss", "height": 260}
    if runs:
        ratios = {name: run.motor.transmission if run.motor else 1.0 for name, run in runs.items()}
        torques = {name: ratios[name] * run.motor_torque for name, run in runs.items()}
        speeds = {name: run.speed for name, run in runs.items()}
        for name, found, label, unit in (
            ("speed", speeds, "crank speed", "rad/s"),
            ("motor", torques, "motor torque", "N m"),
        ):
            factor, shown = display_unit(unit, found.values())
            curves = [
                {"x": np.degrees(runs[one].crank_angle), "y": factor * found[one]} if one in runs else None
                for one in subject.machines
            ]
            made[name] = {"curves": curves, "label": label, "unit": pretty_unit(shown), "height": 260}
    return {"items": made, "explored": explored, "joint": joint}


def _template(name):
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


BROWSERS = (
    *("chromium", "chromium-browser", "google-chrome-stable", "google-chrome"),
    *("chrome", "msedge", "microsoft-edge"),
)
"""Browsers that print without a window, in order of preference."""
BROWSER_TIMEOUT = 120.0
"""Time limit of a running browser, s."""
RENDER_TIME = 20_000
"""Milliseconds of the browser's virtual clock for drawing the figures."""


def browser():
    """Path of a browser that prints without a window; `MissingLibraryError` without one, which lists suitable ones."""
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        raise MissingLibraryError(
            f"a PDF needs a browser, but none of {', '.join(BROWSERS)} is installed: install one, or open the "
            "report in any browser and print it from there"
        )
    return found


def print_page(path, pdf):
    """Print a page in a file to a PDF file; `FileError` if the browser does not end, or ends without a PDF."""
    found = browser()
    with tempfile.TemporaryDirectory(prefix="kinetostatics") as folder:
        made = Path(folder) / "page.pdf"
        command = [
            *(found, "--headless", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"),
            "--window-size=1010,1400",
            *(f"--user-data-dir={folder}/profile", f"--virtual-time-budget={RENDER_TIME}", "--no-pdf-header-footer"),
            *(["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []),
            *(f"--print-to-pdf={made}", Path(path).resolve().as_uri()),
        ]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=BROWSER_TIMEOUT, errors="replace")
        except (OSError, subprocess.TimeoutExpired) as error:
            raise FileError(f"{found} could not print the report: {error}") from None
        if not made.is_file() or not made.read_bytes().startswith(b"%PDF"):
            said = next((line for line in reversed(done.stderr.splitlines()) if line.strip()), "it said nothing")
            raise FileError(f"{found} ended with status {done.returncode} and without a PDF: {said}")
        shutil.copyfile(made, pdf)
