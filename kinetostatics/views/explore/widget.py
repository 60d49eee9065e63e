"""The explore page in a notebook: requests and answers are messages between the page and the kernel."""

from functools import cache

from ...errors import MissingLibraryError
from ...numbers.output_units import output_units, shown_in
from ..page import bundle
from .conversation import Conversation
from .server import style
from .session import Session


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
    widget
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
    >>> ks.extremes(w.scene.solve(360), "O").largest  # doctest: +SKIP
    24514.2
    """
    kind = widget_class()
    return kind(what, variant, folder, None if units is None else output_units(units, "explore"))


@cache
def widget_class():
    """The class of widgets; an error with the install command if anywidget is missing."""
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise MissingLibraryError(
            'explore in a notebook needs anywidget, which is not installed: pip install "kinetostatics[explore]"'
        ) from None

    class Widget(anywidget.AnyWidget):
        """Explore page of a case or scene; several pages may show it, each with a session of its own."""

        _esm = bundle("widget.js")
        _css = style()
        state = traitlets.Dict().tag(sync=True)
        address = traitlets.Dict(help="Further fields of the page, such as its curves.").tag(sync=True)

        def __init__(self, what, variant, folder, units):
            self._conversations: dict[str, Conversation] = {}  # first: `close` ends them
            self._session = Session(what, variant, folder)
            self._new_session = lambda: Session(self._session.case or what, variant, folder)
            self._units = units
            super().__init__(state={"variant": self._session.first, "values": {}})
            self.on_msg(self._receive)

        @property
        def scene(self):
            """Scene that is shown."""
            return self._session.scene(self.state)

        def __repr__(self):
            return f"<explore {self._session.title}: run this cell in a notebook to show it>"

        def _receive(self, widget, content, buffers):
            """Take a message of a page: a request, or none when the page is closed."""
            page = content["page"]
            if "request" not in content:
                if page in self._conversations:
                    self._conversations.pop(page).end()
                return
            if page not in self._conversations:
                self._conversations[page] = Conversation(
                    self._new_session(), lambda header, parts: self.send({"page": page, "answer": header}, parts)
                )
            with shown_in(self._units):
                self._conversations[page].answer(content["request"])

        def close(self):
            """Remove the widget from all pages."""
            while self._conversations:
                self._conversations.popitem()[1].end()
            super().close()

    return Widget
