"""The explore page as a widget of a notebook: requests and answers are messages between page and kernel."""

import anywidget
import traitlets

from ...numbers.output_units import shown_in
from ..page import bundle
from .conversation import Conversation
from .server import style
from .session import Session


class Widget(anywidget.AnyWidget):
    """Explore page of a case or scene in a notebook; `explore` makes it.

    Parameters
    ----------
    what, variant, folder
        As for `Session`.
    units : OutputUnits or None

    Attributes
    ----------
    state : dict
        Variant and changed numbers that are shown, as in `Session`; set it to show others.
    """

    _esm = bundle("widget.js")
    _css = style()
    state = traitlets.Dict().tag(sync=True)
    address = traitlets.Dict(help="Further fields of the page, such as its curves.").tag(sync=True)

    def __init__(self, what, variant, folder, units):
        self._session = Session(what, variant, folder)
        self._new_session = lambda: Session(self._session.case or what, variant, folder)
        self._units = units
        self._conversations: dict[str, Conversation] = {}
        super().__init__(state={"variant": self._session.first, "values": {}})
        self.on_msg(self._receive)

    @property
    def scene(self):
        """Scene that is shown."""
        return self._session.scene(self.state)

    def __repr__(self):
        return f"Widget(explore {self._session.title}: run this cell in a notebook to show it)"

    def _receive(self, widget, content, buffers):
        """A message of one of the pages that show this widget."""
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
            self._conversations[page].take(content["request"])

    def close(self):
        """Remove the widget from all pages."""
        while self._conversations:
            self._conversations.popitem()[1].end()
        super().close()
