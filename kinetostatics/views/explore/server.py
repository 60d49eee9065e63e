"""Server of the explore page: bound to this machine only, for those who know the token of this start.

The address of the page has the token in its fragment, which browsers do not send; the page sends it in its first
message. A browser is opened with a ticket in its place, which is valid once: other users of the machine see the
arguments of its process.
"""

import asyncio
import contextlib
import gc
import hmac
import secrets
import signal
import threading
import warnings
import webbrowser
from importlib import resources
from pathlib import Path
from typing import Any

from ...casefile.case import Case, load_case
from ...errors import MissingLibraryError, ParameterError
from ...solution.scene import Scene
from ..page import bundle, source
from .conversation import Conversation
from .messages import framed, parsed
from .session import Session

COLLECTION_THRESHOLDS = 700, 10, 10
"""For garbage collection: a server makes machines as long as it runs, and solutions refer to each other in circles."""
ADDRESS = "127.0.0.1"
"""The only address at which the server listens."""
HTTP_PORT = 80
"""Browsers leave this port out of a host."""
MAX_MESSAGE = 1_000_000
"""Largest message from a page, bytes."""
TOKEN_BYTES = 24
"""Random bytes of a token."""
NOT_UNDERSTOOD, REFUSED = 1003, 1008
"""Codes with which a socket closes."""
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self' {sockets}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""What the page may load: only what this server gives."""
POLICY_OF_REPORT = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; sandbox allow-scripts "
    "allow-modals allow-downloads; frame-ancestors 'none'"
)
"""What a report may do: run its own scripts, as a page that has no access to this server."""


def require_tornado():
    """Import Tornado; an error with the install command if it is missing."""
    try:
        import tornado
    except ImportError:
        raise MissingLibraryError(
            'the explore page needs Tornado, which is not installed: pip install "kinetostatics[explore]"'
        ) from None
    return tornado


class Gate:
    """Token of a start, and a ticket in its place that is valid once."""

    def __init__(self):
        self.token, self.ticket = (secrets.token_urlsafe(TOKEN_BYTES) for _ in range(2))

    def admits(self, given):
        """Whether a page may come in; in a time that tells nothing about the token."""
        given = given.encode(errors="replace") if isinstance(given, str) else b""
        by_token, by_ticket = (hmac.compare_digest(given, own.encode()) for own in (self.token, self.ticket))
        if by_ticket:
            self.ticket = secrets.token_urlsafe(TOKEN_BYTES)
        return by_token or by_ticket


class Site:
    """What a server gives to those who are let in, and the pages that are open."""

    def __init__(self, gate, session_of_page, hosts):
        self.gate, self.session_of_page, self.hosts = gate, session_of_page, hosts
        self.policy = POLICY.format(sockets=" ".join(f"ws://{host}" for host in sorted(hosts)))
        self.contents = {
            "/": ("text/html", resources.files(__package__).joinpath("page.html").read_bytes()),
            "/explore.js": ("text/javascript", bundle("page.js").encode()),
            "/explore.css": ("text/css", style().encode()),
        }
        self.reports: dict[str, Path] = {}
        self.pages: set = set()

    def link(self, path):
        """Address of a report, with random letters that others cannot guess."""
        address = f"/report/{secrets.token_urlsafe(TOKEN_BYTES)}"
        self.reports[address] = Path(path)
        return address

    def content(self, path):
        """Kind and content at a path; None if there is nothing."""
        if path in self.reports and self.reports[path].is_file():
            return "text/html", self.reports[path].read_bytes()
        return self.contents.get(path)


def application(site):
    """The Tornado application of a site."""
    require_tornado()
    from tornado.web import Application

    handlers = [("/socket", _socket_handler(site)), (".*", _file_handler(site))]
    return Application(handlers, websocket_max_message_size=MAX_MESSAGE, log_function=lambda handler: None)


def _file_handler(site):
    """Handler of files: the page, its module and style, and reports."""
    from tornado.web import HTTPError, RequestHandler

    class File(RequestHandler):
        def set_default_headers(self):
            self.clear_header("Server")
            policy = POLICY_OF_REPORT if self.request.path in site.reports else site.policy
            for name, value in {**HEADERS, "Content-Security-Policy": policy}.items():
                self.set_header(name, value)

        def prepare(self):  # a name that leads to this machine from a foreign page has another host
            if self.request.host not in site.hosts:
                raise HTTPError(403)

        def get(self):
            found = site.content(self.request.path)
            if found is None:
                raise HTTPError(404)
            kind, content = found
            self.set_header("Content-Type", f"{kind}; charset=utf-8")
            self.finish(content)

    return File


def _socket_handler(site):
    """Handler of requests of one page; it waits until an answer has gone, so a page that does not read is not read."""
    from tornado.web import HTTPError
    from tornado.websocket import WebSocketClosedError, WebSocketHandler

    class Socket(WebSocketHandler):
        def initialize(self):
            self.conversation: Conversation | None = None
            self.sent: asyncio.Future | None = None

        def prepare(self):  # Tornado lets requests without an origin pass
            host, origin = self.request.host, self.request.headers.get("Origin")
            if host not in site.hosts or origin != f"http://{host}":
                raise HTTPError(403)

        def check_origin(self, origin):
            return True

        def open(self):
            self.set_nodelay(True)
            site.pages.add(self)

        async def on_message(self, message):
            try:
                request = parsed(message)
            except ValueError as error:
                self.close(NOT_UNDERSTOOD, str(error))
                return
            if self.conversation is None:
                if request["kind"] != "open" or not site.gate.admits(request.get("token")):
                    self.close(REFUSED, "This address is of an earlier start; open the one printed last.")
                    return
                self.conversation = Conversation(site.session_of_page(), self.send)
            self.conversation.answer(request)
            if self.sent is not None:
                with contextlib.suppress(asyncio.CancelledError):  # the server ends
                    await asyncio.wait([self.sent])

        def send(self, header, buffers):
            if header["kind"] == "open":
                header["token"] = site.gate.token
            if "report" in header:
                header["link"] = site.link(header["report"])
            with contextlib.suppress(WebSocketClosedError):
                self.sent = self.write_message(framed(header, buffers), binary=True)
                self.sent.add_done_callback(lambda sent: sent.cancelled() or sent.exception())  # the page has gone

        def on_close(self):
            site.pages.discard(self)
            if self.conversation:
                self.conversation.end()

        def end(self):
            """Close at once; unsent messages are lost."""
            connection: Any = self.ws_connection  # None once it was told to close
            if connection is not None:
                connection.stream.close()

    return Socket


def style():
    """Style of the page, all of it within the element of the class `explore`."""
    return ".explore {\n" + source("style.css").replace(":root", "&") + "}\n" + source("explore.css")


@contextlib.contextmanager
def listening(session_of_page, port=0):
    """Server in the running event loop, to the end of the block: its address without a fragment, and its gate.

    `ParameterError` if the port cannot be used.
    """
    require_tornado()
    from tornado.httpserver import HTTPServer
    from tornado.netutil import bind_sockets

    try:
        sockets = bind_sockets(port, ADDRESS)
    except OSError as error:
        raise ParameterError(
            f"explore: port {port} cannot be used ({error.strerror}); give another one, or none for a free one"
        ) from None
    number = sockets[0].getsockname()[1]
    gate = Gate()
    ending = "" if number == HTTP_PORT else f":{number}"
    site = Site(gate, session_of_page, {f"{ADDRESS}{ending}", f"localhost{ending}"})
    server = HTTPServer(application(site), max_body_size=MAX_MESSAGE)
    server.add_sockets(sockets)
    try:
        yield f"http://{ADDRESS}{ending}/", gate
    finally:
        server.stop()
        for page in list(site.pages):
            page.end()


def serve(what, variant=None, folder=None, port=0, browser=True, tell=print):
    """Serve the explore page of a case or scene until Ctrl-C or SIGTERM; arguments as for `Session`.

    Port 0 is a free one; `browser` opens the page in the browser, and `tell` is called with its address.
    """
    require_tornado()
    gc.set_threshold(*COLLECTION_THRESHOLDS)
    what = what if isinstance(what, Case | Scene | dict) else load_case(what)
    Session(what, variant, folder)  # a wrong variant ends the command before it serves
    handler, terminated = signal.getsignal(signal.SIGTERM), asyncio.Event()

    async def run():
        loop = asyncio.get_running_loop()
        loop.add_signal_handler(signal.SIGTERM, terminated.set)  # an exception of a handler is lost in the loop
        with listening(lambda: Session(what, variant, folder), port) as (address, gate):
            tell(f"{address}#token={gate.token}")
            if browser:
                threading.Thread(
                    target=open_browser, args=(f"{address}#token={gate.ticket}", loop), daemon=True
                ).start()
            await terminated.wait()

    try:
        asyncio.run(run())
    finally:
        signal.signal(signal.SIGTERM, handler)
    if terminated.is_set():
        signal.raise_signal(signal.SIGTERM)


def open_browser(address, loop):
    """Open an address in the user's browser; a warning in the thread of the loop if there is none."""
    try:
        opened = webbrowser.open(address)
    except (OSError, webbrowser.Error):
        opened = False
    if not opened and not loop.is_closed():
        loop.call_soon_threadsafe(warnings.warn, "no browser could be opened; open the address in one")
