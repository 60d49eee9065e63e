"""Server of the explore page: bound to this machine only, for those who know the token of this start."""

import asyncio
import contextlib
import hmac
import json
import secrets
import webbrowser
from importlib import resources

from ...errors import MissingLibraryError
from ..page import bundle
from .messages import framed, packed
from .session import OF_NEWEST, Session

ADDRESS = "127.0.0.1"
"""The only address at which the server listens."""
PAUSE = 0.05
"""Time until a part that is not ready is asked for again, s."""
MAX_MESSAGE = 1_000_000
"""Largest message from a page, bytes."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""What the page may load: only what this server gives."""


def require_tornado():
    """Import Tornado; an error with the install command if it is missing."""
    try:
        import tornado
    except ImportError:
        raise MissingLibraryError(
            'the explore page needs Tornado, which is not installed: pip install "kinetostatics[explore]"'
        ) from None
    return tornado


def application(session_of_page, token):
    """The Tornado application: the page, its module and style, and the socket; a session for each page."""
    require_tornado()
    from tornado.web import Application, HTTPError, RequestHandler
    from tornado.websocket import WebSocketHandler

    files = {
        "/": ("text/html; charset=utf-8", resources.files(__package__).joinpath("page.html").read_bytes()),
        "/explore.js": ("text/javascript; charset=utf-8", bundle("page.js").encode()),
        "/explore.css": ("text/css; charset=utf-8", _style().encode()),
    }

    def require_own_host(handler):
        if handler.request.host not in handler.application.settings["hosts"]:
            raise HTTPError(403)

    class File(RequestHandler):
        def set_default_headers(self):
            self.set_header("Content-Security-Policy", POLICY)
            self.set_header("X-Content-Type-Options", "nosniff")
            self.set_header("Referrer-Policy", "no-referrer")
            self.set_header("Cache-Control", "no-store")
            self.clear_header("Server")

        def prepare(self):
            require_own_host(self)

        def get(self):
            kind, content = files[self.request.path]
            self.set_header("Content-Type", kind)
            self.finish(content)

    class Socket(WebSocketHandler):
        """Requests of one page, each answered; numbers of an older state are dropped when a newer one is asked for."""

        def initialize(self):
            self.session: Session | None = None
            self.tasks: dict[str, asyncio.Task] = {}

        def prepare(self):
            require_own_host(self)

        def check_origin(self, origin):
            return origin in {f"http://{host}" for host in self.application.settings["hosts"]}

        def on_message(self, message):
            try:
                request = json.loads(message)
                kind = request["kind"]
            except (ValueError, TypeError, KeyError):
                self.close(1003, "a request is JSON with a kind")
                return
            if self.session is None:
                if kind != "open" or not hmac.compare_digest(str(request.get("token")).encode(), token.encode()):
                    self.close(1008, "the address is of an earlier start")
                    return
                self.session = session_of_page()
            found = self.session.answer(request)
            self.drop(OF_NEWEST if kind in ("look", "drag") else [kind])
            if isinstance(found, dict):
                self.send(found)
            else:
                self.tasks[kind] = asyncio.ensure_future(self.send_parts(found))

        def drop(self, kinds):
            for kind in kinds:
                if task := self.tasks.pop(kind, None):
                    task.cancel()

        def send(self, answer):
            self.write_message(framed(*packed(answer)), binary=True)

        async def send_parts(self, answers):
            with contextlib.closing(answers):
                for answer in answers:
                    if answer:
                        self.send(answer)
                    await asyncio.sleep(0 if answer else PAUSE)

        def on_close(self):
            self.drop(list(self.tasks))

    return Application(
        [*((path, File) for path in files), ("/socket", Socket)], websocket_max_message_size=MAX_MESSAGE, hosts=set()
    )


def _style():
    here = resources.files("kinetostatics.views.page")
    return "\n".join(here.joinpath(name).read_text(encoding="utf-8") for name in ("style.css", "explore.css"))


def serve(what, variant=None, folder=None, port=0, browser=True, tell=print):
    """Serve the explore page of a case or scene until interrupted.

    Parameters
    ----------
    what, variant, folder
        As for `Session`.
    port : int
        0: a free one.
    browser : bool
        Open the page in the browser.
    tell : function
        Called with the address of the page.
    """
    require_tornado()
    from tornado.httpserver import HTTPServer
    from tornado.netutil import bind_sockets

    Session(what, variant, folder)  # what is wrong is said before the server starts

    async def run():
        token = secrets.token_urlsafe(24)
        app = application(lambda: Session(what, variant, folder), token)
        sockets = bind_sockets(port, ADDRESS)
        number = sockets[0].getsockname()[1]
        app.settings["hosts"].update({f"{ADDRESS}:{number}", f"localhost:{number}"})
        server = HTTPServer(app)
        server.add_sockets(sockets)
        address = f"http://{ADDRESS}:{number}/#token={token}"
        tell(address)
        if browser:
            webbrowser.open(address)
        await asyncio.Event().wait()

    asyncio.run(run())
