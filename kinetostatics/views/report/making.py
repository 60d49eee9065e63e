"""The public door: a report of a case or of scenes, written whole or not at all."""

from pathlib import Path

from ...casefile.case import Case, load_case
from ...errors import ParameterError
from ...numbers import checks, files
from ...solution.scene import Scene
from . import figures, html
from .subject import subject_of

SHOWN_AFTER = 1.0
"""Seconds of work after which a bar appears."""


def report(what, path, *, variant=None, title=None, pdf=None, command="", progress=False):
    """Write a report: one HTML file that needs no other and makes no request, to read, to turn by hand and to print.

    In it the mechanism turns by slider, play button or arrow keys, with its reactions as arrows; beside it stand
    figures to zoom, values at the chosen angle, extremes, comparison with published figures, certainty, friction,
    drive, and what the machines are made of.

    Parameters
    ----------
    what : Case, str, path, Scene or mapping of label to Scene
        A case, the name or path of one, or scenes; the first scene is what the others are compared with.
    path : path
        File to write, .html.
    variant : str, optional
        Of a case, only this variant beside the reference.
    title : str, optional
        In place of the case's title, or of the names of the mechanisms.
    pdf : path, optional
        File to print the report to as well, .pdf, by a browser that is installed.
    command : str
        What made it, as it stands in the report.
    progress : bool
        Whether a bar shows how far it has come, when it takes over a second.

    Returns
    -------
    Path
        Of the HTML file.

    Raises
    ------
    FileError
        A file cannot be written.
    MissingLibraryError
        Bokeh is not installed, or no browser for the PDF.
    CaseError, ParameterError
        The case or the scenes cannot be used.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> press = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(mass=50.0)), 10.0, loads=ks.ProcessForce(-2e3))
    >>> ks.report(press, "press.html", title="Press")  # doctest: +SKIP
    PosixPath('press.html')
    """
    case = _case_of(what)
    inputs = case.files if isinstance(case, Case) else ()
    checks.require(
        "report",
        files.unwritable(path, inputs=inputs, endings=(".html", ".htm")),
        None if pdf is None else files.unwritable(pdf, inputs=inputs, endings=(".pdf",)),
        None if title is None or (isinstance(title, str) and title.strip()) else f"title must be a text, got {title!r}",
    )
    figures.require()
    if pdf is not None:
        html.browser()
    subject = subject_of(case, variant, title, command)
    from tqdm import tqdm

    with tqdm(
        desc="report",
        total=html.PARTS + (pdf is not None),
        unit=" parts",
        delay=SHOWN_AFTER,
        leave=False,
        disable=not progress,
    ) as bar:

        def tell(text):
            bar.set_postfix_str(text, refresh=False)
            bar.update()

        text = html.page(subject, tell)
        with files.written_whole(path) as temporary:
            Path(temporary).write_text(text, encoding="utf-8", errors="replace")  # names of files may be no text
        if pdf is not None:
            tell("PDF")
            with files.written_whole(pdf) as temporary:
                html.print_page(path, temporary)
    return Path(path)


def _case_of(what):
    """The case that is meant, read; scenes as they are."""
    if isinstance(what, Case | Scene) or hasattr(what, "items"):
        return what
    try:
        return load_case(what)
    except ParameterError:
        raise ParameterError(
            f"report takes a case, the name or path of one, a Scene or a mapping of label to Scene, got a "
            f"{type(what).__name__}"
        ) from None
