"""The page as PDF, printed by a browser without a window."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from ...errors import FileError, MissingLibraryError

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome-stable",
    "google-chrome",
    "chrome",
    "msedge",
    "microsoft-edge",
)
"""Names of browsers that print without a window, the first found is taken."""
PATIENCE = 120.0
"""Seconds after which a browser that does not end is given up."""
DRAWING = 20_000
"""Milliseconds, of the browser's own clock, that figures have to be drawn in."""


def browser():
    """Path of a browser that prints without a window.

    Raises
    ------
    MissingLibraryError
        There is none; the message names those looked for.
    """
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        raise MissingLibraryError(
            f"a PDF is printed by a browser, and none of {', '.join(BROWSERS)} is found: install one, or open the "
            "report in any browser and print it from there"
        )
    return found


def print_page(path, pdf):
    """Print a page in a file to a PDF file.

    Raises
    ------
    FileError
        The browser ended without a PDF, or did not end.
    """
    found = browser()
    with tempfile.TemporaryDirectory(prefix="kinetostatics") as folder:
        made = Path(folder) / "page.pdf"
        command = [
            *(
                found,
                "--headless",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--no-first-run",
                "--window-size=1010,1400",
            ),
            *(f"--user-data-dir={folder}/profile", f"--virtual-time-budget={DRAWING}", "--no-pdf-header-footer"),
            *(["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []),
            *(f"--print-to-pdf={made}", Path(path).resolve().as_uri()),
        ]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, errors="replace")
        except (OSError, subprocess.TimeoutExpired) as error:
            raise FileError(f"{found} could not print the report: {error}") from None
        if not made.is_file() or not made.read_bytes().startswith(b"%PDF"):
            said = next((line for line in reversed(done.stderr.splitlines()) if line.strip()), "it said nothing")
            raise FileError(f"{found} ended with status {done.returncode} and without a PDF: {said}")
        shutil.copyfile(made, pdf)
