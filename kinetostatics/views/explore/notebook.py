"""Explore in a notebook: the public function."""

from ...errors import MissingLibraryError
from ...numbers.output_units import output_units


def explore(what, variant=None, folder=".", units=None):
    """Show a mechanism in a notebook to change it by hand: forces, torque and motion follow while you drag.

    The command `kinetostatics explore` opens the same page in a browser.

    Parameters
    ----------
    what : Case, str, path or Scene
        A case, its name or path, or a scene.
    variant : str, optional
        Variant of the case shown first.
    folder : path
        Folder into which "Save case" writes; it writes nowhere else.
    units : dict of dimension to unit, optional
        Units shown, {"force": "kN", "length": "mm"}, as for `in_units`.

    Returns
    -------
    Widget
        Last in a cell, it is shown. Its `scene` is the `Scene` that is shown, with all changed numbers. Its `state` is
        {"variant": name, "values": {path: number in SI}}, the numbers that differ from the case; set it to show others.

    Raises
    ------
    MissingLibraryError
        anywidget is not installed.
    CaseError, ParameterError
        The case, the scene, the variant or the units cannot be used.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> w = ks.explore("sawframe_2r63", variant="cam-circle")  # doctest: +SKIP
    >>> w.state  # doctest: +SKIP
    {'variant': 'cam-circle', 'values': {'slider.mass': 620.0}}
    >>> ks.extremes(w.scene.solve(360), "balancing_torque").largest  # doctest: +SKIP
    """
    shown = None if units is None else output_units(units, "explore")
    try:
        from .widget import Widget
    except ImportError as error:
        if not (error.name or "").startswith(("anywidget", "ipywidgets", "traitlets")):
            raise
        raise MissingLibraryError(
            'explore in a notebook needs anywidget, which is not installed: pip install "kinetostatics[explore]"'
        ) from None
    return Widget(what, variant, folder, shown)
