"""Server of the explore page: who may ask, what it sends, and that no request ends it."""

import asyncio
import json
import socket
import sys
from pathlib import Path

import pytest

pytest.importorskip("tornado")
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

import kinetostatics as ks
from kinetostatics.views.explore import server as module
from kinetostatics.views.explore.messages import unframed
from kinetostatics.views.explore.server import ADDRESS, MAX_MESSAGE, Gate, listening
from kinetostatics.views.explore.session import ANSWERS, Session
from support.every import every

PRESS = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(50.0)), 10.0, loads=ks.Gravity())
STATE = {"variant": "crank-slider", "values": {}}


def served(conversation, what=PRESS, folder=None):
    """Result of an async function of a `Client` of a running server."""

    async def run():
        with listening(lambda: Session(what, folder=folder)) as (address, gate):
            return await asyncio.wait_for(conversation(Client(address, gate)), 30)

    return asyncio.run(run())


class Client:
    """Asks a server as a browser does; its host and origin may be others."""

    def __init__(self, address, gate):
        self.address, self.gate, self.host = address, gate, address.split("/")[2]
        self.port = int(self.host.split(":")[1])

    async def get(self, path="", **options):
        """Response to a request of a file."""
        return await AsyncHTTPClient().fetch(self.address + path, raise_error=False, **options)

    async def connect(self, **headers):
        """A socket that has asked nothing."""
        headers = {"Origin": f"http://{self.host}"} | {name: value for name, value in headers.items() if value}
        request = HTTPRequest(f"ws://{self.host}/socket", headers=headers)
        return Page(await websocket_connect(request, max_message_size=10**8))

    async def page(self, **fields):
        """A page that has been let in."""
        page = await self.connect()
        await page.ask("open", token=self.gate.token, **fields)
        return page


class Page:
    """A socket and its numbered requests."""

    def __init__(self, connection):
        self.connection, self.number = connection, 0

    async def send(self, kind, **fields):
        """Send a request."""
        self.number += 1
        await self.connection.write_message(json.dumps({"id": self.number, "kind": kind, **fields}))

    async def answer(self):
        """The next answer; None if the socket closed."""
        message = await self.connection.read_message()
        return message and unframed(message)[0]

    async def ask(self, kind, **fields):
        """The last answer to a request."""
        await self.send(kind, **fields)
        while (found := await self.answer()) and found.get("more"):
            pass
        return found

    @property
    def end(self):
        """Code and reason with which the socket closed."""
        return self.connection.close_code, self.connection.close_reason


def test_it_listens_on_this_machine_alone():
    async def sockets(client):
        tables = (Path(f"/proc/net/{name}").read_text(encoding="ascii").splitlines()[1:] for name in ("tcp", "tcp6"))
        rows = [line.split() for table in tables for line in table]
        return [row[1] for row in rows if row[3] == "0A" and int(row[1].split(":")[1], 16) == client.port]

    if not Path("/proc/net/tcp6").exists():
        pytest.skip("no list of sockets here")
    (found,) = served(sockets)
    assert found.split(":")[0] == bytes(reversed(socket.inet_aton(ADDRESS))).hex().upper()
    assert ADDRESS == "127.0.0.1"


def test_files_are_sent_with_a_policy_that_loads_nothing_from_elsewhere():
    async def files(client):
        return {path: await client.get(path) for path in ("", "explore.js", "explore.css", "no", "../setup.py")}

    found = served(files)
    kinds = {"": "text/html", "explore.js": "text/javascript", "explore.css": "text/css"}
    for path, response in found.items():
        policy = response.headers["Content-Security-Policy"]
        assert "default-src 'none'; script-src 'self'" in policy
        assert "frame-ancestors 'none'" in policy
        assert not {"*", "'unsafe-inline'", "'unsafe-eval'", "https:", "http:"} & set(policy.replace(";", "").split())
        assert response.headers["X-Content-Type-Options"] == "nosniff"
        assert response.headers["Referrer-Policy"] == "no-referrer"
        assert "Server" not in response.headers
        assert response.code == (200 if path in kinds else 404), path
        if path in kinds:
            assert response.headers["Content-Type"] == f"{kinds[path]}; charset=utf-8"
            assert response.body
            for elsewhere in (b"https://", b"//cdn"):
                assert elsewhere not in response.body


@every("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "[::1]", "", "127.0.0.1.evil.example"])
def test_a_page_of_another_host_gets_nothing(host):
    """A name of another site may lead to this machine: DNS rebinding."""

    async def refused(client):
        named = host + f":{client.port}" if host.endswith("example") else host
        codes = [(await client.get(path, headers={"Host": named})).code for path in ("", "explore.js", "report/x")]
        with pytest.raises(HTTPClientError) as error:
            await client.connect(Host=named or " ", Origin=f"http://{named}")
        return {*codes, error.value.code}

    assert served(refused) <= {400, 403}


FOREIGN = ["", "null", "http://evil.example", "http://127.0.0.1:1", "https://{host}", "http://{host}.evil", "{host}"]


@every("origin", FOREIGN)
def test_a_socket_of_another_origin_is_refused(origin):
    async def refused(client):
        headers = {"Origin": origin.format(host=client.host)} if origin else {}
        with pytest.raises(HTTPClientError) as error:
            await websocket_connect(HTTPRequest(f"ws://{client.host}/socket", headers=headers))
        return error.value.code

    assert served(refused) == 403


def test_both_names_of_this_machine_are_own():
    async def opened(client):
        host = f"localhost:{client.port}"
        page = await client.connect(Host=host, Origin=f"http://{host}")
        return (await client.get(headers={"Host": host})).code, await page.ask("open", token=client.gate.token)

    code, answer = served(opened)
    assert (code, answer["title"]) == (200, "crank-slider")


WITHOUT_TOKEN = {
    "another token": {"kind": "open", "token": "x" * 32},
    "no token": {"kind": "open"},
    "a token of another type": {"kind": "open", "token": ["x"]},
    "a token that is no text": {"kind": "open", "token": "\ud800é"},
    "another first request": {"kind": "look", "state": STATE, "token": "{token}"},
}


@every("name", WITHOUT_TOKEN)
def test_a_page_without_the_token_is_closed(name):
    async def closed(client):
        page = await client.connect()
        fields = dict(WITHOUT_TOKEN[name])
        if fields.get("token") == "{token}":
            fields["token"] = client.gate.token
        return await page.ask(**fields), page.end

    assert served(closed) == (None, (1008, "This address is of an earlier start; open the one printed last."))


def test_a_ticket_opens_one_page_which_learns_the_token():
    async def opened(client):
        ticket = client.gate.ticket
        first, second = await client.connect(), await client.connect()
        return client.gate.token, await first.ask("open", token=ticket), await second.ask("open", token=ticket)

    token, answer, other = served(opened)
    assert answer["token"] == token
    assert other is None


def test_tokens_are_random_and_of_one_start():
    one, other = Gate(), Gate()
    assert len({one.token, one.ticket, other.token, other.ticket}) == 4
    assert len(one.token) >= 32
    assert not other.admits(one.token)
    assert one.admits(one.token)
    assert one.admits(one.token)


HOSTILE = {
    "no JSON": "look",
    "no UTF-8": b"\xff\xfe\x00",
    "NaN": '{"id": 2, "kind": "look", "count": NaN}',
    "deep": "[" * 100_000,
    "without a kind": '{"id": 2}',
    "too large": '"' + "x" * MAX_MESSAGE + '"',
}


@pytest.mark.slow
@every("name", HOSTILE)
def test_a_malformed_message_closes_its_socket_alone(name, caplog, capfd):
    async def closed(client):
        page, other = await client.page(), await client.page()
        await page.connection.write_message(HOSTILE[name], binary=isinstance(HOSTILE[name], bytes))
        return await page.answer(), page.end, await other.ask("look", state=STATE)

    answer, (code, _), other = served(closed)
    assert answer is None
    assert code == (1009 if name == "too large" else 1003)
    assert "drawing" in other
    assert not caplog.records
    assert "Traceback" not in "".join(capfd.readouterr())


REFUSED = {
    "unknown kind": {"kind": "run"},
    "unknown variant": {"kind": "look", "state": {"variant": "<b>"}},
    "wrong values": {"kind": "look", "state": {"values": {"crank_length": "1e999"}}},
    "huge number": {"kind": "look", "state": {"values": {"crank_length": 10**300}}},
    "wrong types": {"kind": "drag", "state": STATE, "handle": [1], "x": {}, "y": "0"},
    "wrong search": {"kind": "optimise", "state": STATE, "vary": 3, "goal": "minimise", "output": []},
    "wrong output": {"kind": "sensitivities", "state": STATE, "output": {"a": 1}},
    "wrong tolerances": {"kind": "tolerances", "state": STATE, "spreads": [[]]},
    "wrong rows": {"kind": "ask", "state": STATE, "show": 3},
    "no folder": {"kind": "save", "state": STATE, "name": "press"},
    "no state": {"kind": "report"},
}


def test_a_request_that_cannot_be_answered_ends_in_words(caplog, capfd):
    async def refused(client):
        page = await client.page()
        found = {name: await page.ask(**fields) for name, fields in REFUSED.items()}
        return found, await page.ask("look", state=STATE)

    found, last = served(refused)
    problems = {name: answer.get("problem", "fault of the library") for name, answer in found.items()}
    assert {name: text for name, text in problems.items() if "fault of the library" in text} == {}
    assert "drawing" in last
    assert not caplog.records
    assert "Traceback" not in "".join(capfd.readouterr())


def test_two_pages_have_their_own_states():
    async def both(client):
        one, other = await client.page(), await client.page()
        await one.send("look", state={"values": {"crank_length": 0.12}})
        await other.send("look", state=STATE)
        return await one.answer(), await other.answer()

    one, other = served(both)
    assert (one["values"]["crank_length"], other["values"]["crank_length"]) == (0.12, 0.1)


def test_a_newer_look_ends_the_numbers_of_an_older_one(monkeypatch):
    async def overtaken(client):
        page = await client.page()
        await page.send("slow", state=STATE)
        first = await page.answer()
        last = await page.ask("look", state=STATE)
        return [first["kind"], last["kind"]], ended

    def slow(session, request):
        try:
            yield {"row": 1}
            while True:
                yield None
        finally:
            ended.append(True)

    ended = []
    monkeypatch.setitem(ANSWERS, "slow", slow)
    monkeypatch.setattr("kinetostatics.views.explore.conversation.OF_NEWEST", ("slow",))
    assert served(overtaken) == (["slow", "look"], [True])


def test_a_closed_page_ends_its_numbers(monkeypatch):
    async def left(client):
        page = await client.page()
        await page.send("slow", state=STATE)
        page.connection.close()
        while not ended:
            await asyncio.sleep(0.01)
        return await (await client.page()).ask("look", state=STATE)

    def slow(session, request):
        try:
            while True:
                yield {"row": 1}
        finally:
            ended.append(True)

    ended = []
    monkeypatch.setitem(ANSWERS, "slow", slow)
    assert "drawing" in served(left)


@pytest.mark.slow
def test_a_page_that_does_not_read_is_not_answered_on(monkeypatch):
    """What it has not read stays few answers: its requests wait in its own socket."""
    looks = []

    def large(session, request):
        looks.append(request["id"])
        return {"text": "x" * 1_000_000}

    async def flooded(client):
        reader, writer = await asyncio.open_connection(ADDRESS, client.port)
        head = f"GET /socket HTTP/1.1\r\nHost: {client.host}\r\nOrigin: http://{client.host}\r\nUpgrade: websocket\r\n"
        head += "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        head += "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        writer.write(head.encode())
        await reader.readuntil(b"\r\n\r\n")
        writer.transport.pause_reading()
        requests = [{"id": 1, "kind": "open", "token": client.gate.token}]
        requests += [{"id": number, "kind": "look", "state": STATE} for number in range(2, 202)]
        for request in requests:
            text = json.dumps(request).encode()
            size = bytes([0x80 | len(text)]) if len(text) < 126 else b"\xfe" + len(text).to_bytes(2, "big")
            writer.write(b"\x81" + size + bytes(4) + text)
        await asyncio.sleep(0.3)
        found = len(looks)
        writer.close()
        return found, await (await client.page()).ask("describe", state=STATE)

    monkeypatch.setitem(ANSWERS, "look", large)
    found, other = served(flooded)
    assert 1 <= found < 50
    assert other["parameters"]


def test_a_server_ends_quietly_while_answers_are_under_way(monkeypatch, caplog, capfd):
    async def left(client):
        page = await client.page()
        for _ in range(30):
            await page.send("look", state=STATE)
        await page.answer()

    monkeypatch.setitem(ANSWERS, "look", lambda session, request: {"text": "x" * 1_000_000})
    served(left)
    assert not caplog.records
    assert "Traceback" not in "".join(capfd.readouterr())


def test_a_report_is_shown_without_access_to_the_server(tmp_path, monkeypatch):
    def reported(session, request):
        (tmp_path / "made.html").write_text("<script>1</script>", encoding="utf-8")
        yield {"report": str(tmp_path / "made.html")}

    async def shown(client):
        page = await client.page()
        await page.send("report", state=STATE)
        answer = await page.answer()
        return answer["link"], await client.get(answer["link"][1:]), await client.get("report/made.html")

    monkeypatch.setitem(ANSWERS, "report", reported)
    link, response, guessed = served(shown)
    assert link.startswith("/report/")
    assert "made" not in link
    assert (response.code, response.body, guessed.code) == (200, b"<script>1</script>", 404)
    assert "sandbox allow-scripts" in response.headers["Content-Security-Policy"]
    assert "allow-same-origin" not in response.headers["Content-Security-Policy"]


def test_a_port_that_is_taken_is_named():
    with socket.socket() as taken:
        taken.bind((ADDRESS, 0))
        taken.listen()
        port = taken.getsockname()[1]
        with (
            pytest.raises(ks.ParameterError, match=f"port {port} cannot be used .*; give another one, or none"),
            listening(lambda: None, port),
        ):
            pass


def test_without_tornado_it_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "tornado", None)
    with pytest.raises(ks.errors.MissingLibraryError, match=r"kinetostatics\[explore\]"):
        module.serve(PRESS)
