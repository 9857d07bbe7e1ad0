"""The server of a view: one page, one stream of messages, a film, and actions that need a token.

It serves nothing else: no other file, no folder. It listens on loopback and accepts only requests
whose Host names loopback, so that a page of another site cannot reach it by a name that it controls
(DNS rebinding), and whose Origin, if there is one, is the server's own.
"""

from __future__ import annotations

import hmac
import json
import secrets
import threading
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from smachac.version import __version__
from smachac.view.feed import Feed

HOST = "127.0.0.1"
NAMES = frozenset({"127.0.0.1", "localhost", "::1"})
"""The names of loopback. The port may be another one: that of a tunnel."""

TOKEN = "X-Smachac-Token"

LONGEST_BODY = 1_000_000
MOST_READERS = 50
"""The most bytes of an action, and the most streams at a time."""

LONGEST_FIELD, MOST_ITEMS = 10_000, 1_000
"""The most characters of a text in an action, a path or a name, and the most items of a list. Only
`diff`, the patch that was seen, is longer."""

PATIENCE = 15.0
"""Seconds that one write to a reader, or the reading of one request, may take."""

IDLE = 5.0
"""Seconds between two signs of life of an idle stream, which show that a reader has gone."""

FAREWELL = 3.0
"""Seconds that requests have, at the end, to receive what they lack."""

HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Content-Security-Policy": "frame-ancestors 'none'",
}
"""Headers of every answer. The page has the rest of its content security policy in itself."""

Do = Callable[[Mapping[str, Any]], object]
"""An action: from the JSON of the request to that of the answer. Raises ActionError."""


class Film(NamedTuple):
    """A film of a run: its media type, and a function that reads it. `read` may raise OSError."""

    type: str
    read: Callable[[], bytes]


class ActionError(Exception):
    """An action that cannot be done; the message is for the user."""


class ViewServer(ThreadingHTTPServer):
    """Serves the page, the feed and the actions of one view.

    `page` returns the page as it is now. `actions` maps a path, as `/control`, to what a POST to it
    does; a request without `token` does nothing. Raises OSError if the port is in use.
    """

    daemon_threads = True
    block_on_close = False

    def __init__(
        self,
        port: int,
        page: Callable[[], str],
        feed: Feed,
        actions: Mapping[str, Do] = {},
        *,
        name: str = "",
        film: Film | None = None,
    ) -> None:
        self.film = film
        self.page, self.feed, self.actions = page, feed, actions
        self.name = name
        self.token = secrets.token_urlsafe(24)
        self._ended = threading.Condition()
        self._requests = 0
        super().__init__((HOST, port), _Handler)

    @property
    def port(self) -> int:
        """The port, also where 0 was requested."""
        return int(self.server_address[1])

    @property
    def url(self) -> str:
        """The address of the page with the token, which browsers keep to themselves."""
        return f"http://{HOST}:{self.port}/#token={self.token}"

    def start(self) -> None:
        """Serve from a thread of its own."""
        threading.Thread(target=self.serve_forever, name="smachac-server", daemon=True).start()

    def stop(self) -> None:
        """End, after the readers have received what the feed holds, and actions their answers."""
        self.feed.close()
        self._wait_for_requests()
        self.shutdown()
        self._wait_for_requests()  # those that came meanwhile
        self.server_close()

    def _wait_for_requests(self) -> None:
        """Wait until all requests have ended, but FAREWELL at most."""
        with self._ended:
            self._ended.wait_for(lambda: not self._requests, FAREWELL)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Start the thread of a request."""
        with self._ended:
            self._requests += 1
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer a request, in its thread."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            with self._ended:
                self._requests -= 1
                self._ended.notify_all()

    def handle_error(self, request: object, client_address: object) -> None:
        """A reader that has gone is no news."""


class _Handler(BaseHTTPRequestHandler):
    """One request."""

    server: ViewServer  # pyright: ignore[reportIncompatibleVariableOverride]
    server_version = f"smachac/{__version__}"
    sys_version = ""
    timeout = PATIENCE

    def do_GET(self) -> None:
        if not self._is_local():
            return
        match urlsplit(self.path).path:
            case "/":
                self._answer(HTTPStatus.OK, self.server.page().encode(), "text/html")
            case "/status":
                status = {"program": "smachac", "version": __version__, "name": self.server.name}
                self._answer_json(HTTPStatus.OK, status)
            case "/events":
                self._stream()
            case "/film" if self.server.film is not None:
                self._answer_film(self.server.film)
            case _:
                self._refuse(HTTPStatus.NOT_FOUND, "there is no such page")

    def do_POST(self) -> None:
        if not self._is_local():
            return
        given = self.headers.get(TOKEN, "")
        if not hmac.compare_digest(given.encode(), self.server.token.encode()):
            self._refuse(HTTPStatus.FORBIDDEN, "the token is missing or wrong")
            return
        action = self.server.actions.get(urlsplit(self.path).path)
        if action is None:
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such action")
            return
        body = self._body()
        if body is None:
            return
        try:
            answer = action(body)
        except ActionError as error:
            self._refuse(HTTPStatus.CONFLICT, str(error))
            return
        self._answer_json(HTTPStatus.OK, answer)

    def _is_local(self) -> bool:
        """Whether the request comes from the page itself or from no page; otherwise it is
        refused."""
        host = self.headers.get("Host", "")
        origin = self.headers.get("Origin")
        site = self.headers.get("Sec-Fetch-Site", "none")
        try:
            local = urlsplit(f"//{host}").hostname in NAMES
        except ValueError:
            local = False
        if not local or (origin is not None and origin != f"http://{host}"):
            self._refuse(HTTPStatus.FORBIDDEN, "this server answers only its own page")
            return False
        # A link on another site may open the page, but no other site may read or embed anything.
        if site not in ("none", "same-origin") and urlsplit(self.path).path != "/":
            self._refuse(HTTPStatus.FORBIDDEN, "this server answers only its own page")
            return False
        return True

    def _body(self) -> dict[str, Any] | None:
        """The JSON object of a request; None if it was refused."""
        length = self.headers.get("Content-Length", "")
        if not length.isdecimal():
            self._refuse(HTTPStatus.LENGTH_REQUIRED, "the length of the body is missing")
        elif len(length) > 12 or int(length) > LONGEST_BODY:
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "the body is too long")
        else:
            try:
                body = json.loads(self.rfile.read(int(length)))
            except (ValueError, RecursionError):
                body = None
            if isinstance(body, dict) and _is_short(body):
                return body
            if isinstance(body, dict):
                self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "a field of the body is too long")
                return None
            self._refuse(HTTPStatus.BAD_REQUEST, "the body is not a JSON object")
        return None

    def _stream(self) -> None:
        """Send the feed until it ends or the reader has gone."""
        feed = self.server.feed
        if feed.readers >= MOST_READERS:
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE, "there are too many readers")
            return
        reader = feed.open()
        self.close_connection = True
        try:
            self._head(HTTPStatus.OK, "text/event-stream")
            while (messages := reader.wait(IDLE)) is not None:
                for message in messages:
                    self.wfile.write(b"data: " + message + b"\n\n")
                if not messages:
                    self.wfile.write(b": idle\n\n")
            self.wfile.write(b"event: end\ndata: {}\n\n")
        except OSError:
            pass  # the reader has gone, or takes nothing any more
        finally:
            reader.close()

    def _answer_film(self, film: Film) -> None:
        try:
            content = film.read()
        except OSError as error:
            self._refuse(HTTPStatus.NOT_FOUND, f"the film cannot be read: {error.strerror}")
            return
        self._answer(HTTPStatus.OK, content, film.type)

    def _refuse(self, status: HTTPStatus, message: str) -> None:
        self.close_connection = True  # a body that was not read must not become the next request
        self._answer_json(status, {"error": message})

    def _answer_json(self, status: HTTPStatus, content: object) -> None:
        self._answer(status, json.dumps(content).encode(), "application/json")

    def _answer(self, status: HTTPStatus, data: bytes, kind: str) -> None:
        self._head(status, kind, len(data))
        self.wfile.write(data)

    def _head(self, status: HTTPStatus, kind: str, length: int | None = None) -> None:
        self.send_response(status)
        is_text = not kind.startswith(("image/", "video/"))
        self.send_header("Content-Type", f"{kind}; charset=utf-8" if is_text else kind)
        for name, content in HEADERS.items():
            self.send_header(name, content)
        if length is not None:
            self.send_header("Content-Length", str(length))
        self.end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Nothing is logged: the terminal belongs to the run."""


def _is_short(body: Mapping[str, Any]) -> bool:
    """Whether the fields of an action, and what is in them, are within the limits."""
    todo: list[object] = [{name: None if name == "diff" else body[name] for name in body}]
    while todo:
        part = todo.pop()
        if isinstance(part, str) and len(part) > LONGEST_FIELD:
            return False
        if isinstance(part, list | dict):
            if len(part) > MOST_ITEMS:
                return False
            todo += part
            todo += part.values() if isinstance(part, dict) else ()
    return True
