"""The server of a view: what it serves, and what it refuses."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator, Mapping
from http.client import HTTPConnection, HTTPResponse
from typing import Any

import pytest

from smachac.view.feed import Feed
from smachac.view.server import (
    HOST,
    LONGEST_BODY,
    LONGEST_FIELD,
    MOST_ITEMS,
    MOST_READERS,
    TOKEN,
    ActionError,
    Film,
    ViewServer,
)

PAGE = "<!DOCTYPE html><title>é</title>"


class Server(ViewServer):
    """A server that notes the actions it has done."""

    done: list[Mapping[str, Any]]


@pytest.fixture
def server() -> Iterator[Server]:
    done: list[Mapping[str, Any]] = []

    def control(body: Mapping[str, Any]) -> object:
        if body.get("action") == "impossible":
            raise ActionError("not now")
        done.append(body)
        return {"done": len(done)}

    made = Server(0, lambda: PAGE, Feed(), {"/control": control}, name="sm")
    made.done = done
    made.start()
    yield made
    made.stop()


def answer(
    server: ViewServer,
    method: str = "GET",
    path: str = "/",
    headers: Mapping[str, str] = {},
    body: bytes | None = None,
) -> tuple[int, str, HTTPResponse]:
    connection = HTTPConnection(HOST, server.port, timeout=60)
    connection.request(method, path, body, dict(headers))
    got = connection.getresponse()
    text = got.read().decode()
    connection.close()
    return got.status, text, got


def act(server: ViewServer, **headers: str) -> int:
    body = json.dumps({"action": "pause"}).encode()
    names = {name.replace("_", "-"): content for name, content in headers.items()}
    return answer(server, "POST", "/control", names, body)[0]


def test_it_serves_the_page_and_its_name(server: Server) -> None:
    status, text, got = answer(server)
    assert (status, text) == (200, PAGE)
    assert got.getheader("Content-Type") == "text/html; charset=utf-8"
    assert got.getheader("X-Frame-Options") == "DENY"
    assert got.getheader("Access-Control-Allow-Origin") is None
    assert server.token not in str(got.headers)
    status, text, _ = answer(server, path="/status")
    assert status == 200
    assert json.loads(text)["name"] == "sm"


@pytest.mark.parametrize(
    "path", ["/main.yml", "/../main.yml", "//etc/passwd", "/%2e%2e/x", "/index.html", "/control"]
)
def test_it_serves_nothing_else(server: Server, path: str) -> None:
    status, text, _ = answer(server, path=path)
    assert status == 404
    assert json.loads(text) == {"error": "there is no such page"}


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "HEAD", "PATCH", "TRACE"])
def test_it_knows_no_other_methods(server: Server, method: str) -> None:
    assert answer(server, method)[0] == 501


def test_an_action_needs_the_token(server: Server) -> None:
    assert act(server) == 403
    assert act(server, **{TOKEN: "wrong"}) == 403
    assert act(server, **{TOKEN: "é".encode().decode("latin-1")}) == 403
    assert answer(server, "POST", f"/control?token={server.token}", {}, b"{}")[0] == 403
    assert server.done == []
    assert act(server, **{TOKEN: server.token}) == 200
    assert server.done == [{"action": "pause"}]
    assert answer(server, "POST", "/other", {TOKEN: server.token}, b"{}")[0] == 404


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "", "[", "0.0.0.0"]
)
def test_a_name_that_is_not_loopback_is_refused(server: Server, host: str) -> None:
    """DNS rebinding: a page of another site reaches this server by a name of its own."""
    for path in ("/", "/events", "/status"):
        assert answer(server, path=path, headers={"Host": host})[0] == 403
    assert act(server, Host=host, **{TOKEN: server.token}) == 403
    assert server.done == []


@pytest.mark.parametrize("host", ["localhost:{}", "127.0.0.1:{}", "[::1]:{}", "localhost:9999"])
@pytest.mark.slow
def test_the_names_of_loopback_are_accepted(server: Server, host: str) -> None:
    name = host.format(server.port)
    assert answer(server, headers={"Host": name})[0] == 200
    assert act(server, Host=name, Origin=f"http://{name}", **{TOKEN: server.token}) == 200


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1:{}", ""]
)
def test_another_origin_is_refused(server: Server, origin: str) -> None:
    foreign = {"Origin": origin.format(server.port)}
    assert act(server, **foreign, **{TOKEN: server.token}) == 403
    assert answer(server, path="/events", headers=foreign)[0] == 403
    assert server.done == []


def test_another_site_may_only_open_the_page(server: Server) -> None:
    foreign = {"Sec-Fetch-Site": "cross-site"}
    assert answer(server, headers=foreign)[0] == 200
    assert answer(server, path="/events", headers=foreign)[0] == 403
    assert act(server, Sec_Fetch_Site="same-site", **{TOKEN: server.token}) == 403


@pytest.mark.parametrize(
    ("headers", "body", "status"),
    [
        ({"Content-Length": str(LONGEST_BODY + 1)}, b"", 413),
        ({"Content-Length": "9" * 30}, b"", 413),
        ({}, json.dumps({"action": "rename", "name": "a" * (LONGEST_FIELD + 1)}).encode(), 413),
        ({}, json.dumps({"arguments": {"states": ["b" * (LONGEST_FIELD + 1)]}}).encode(), 413),
        ({}, json.dumps({"a" * (LONGEST_FIELD + 1): 1}).encode(), 413),
        ({}, json.dumps({"states": ["A", "b" * (LONGEST_FIELD + 1)]}).encode(), 413),
        ({}, json.dumps({"states": ["A"] * (MOST_ITEMS + 1)}).encode(), 413),
        ({"Content-Length": "-5"}, b"", 411),
        ({"Content-Length": "x"}, b"", 411),
        ({}, b"", 400),
        ({}, b"[1]", 400),
        ({}, b'{"action": ', 400),
        ({}, b"\xff\xfe", 400),
        ({}, b"[" * 100_000, 400),
        ({}, b'{"action": "impossible"}', 409),
    ],
)
@pytest.mark.slow
def test_bodies_that_are_no_action(
    server: Server, headers: dict[str, str], body: bytes, status: int
) -> None:
    got, text, _ = answer(server, "POST", "/control", {TOKEN: server.token, **headers}, body)
    assert got == status
    assert "error" in json.loads(text)
    assert server.done == []
    assert act(server, **{TOKEN: server.token}) == 200


class Stream:
    """A reader of /events."""

    def __init__(self, server: ViewServer) -> None:
        self._connection = HTTPConnection(HOST, server.port, timeout=60)
        self._connection.request("GET", "/events")
        self.answer = self._connection.getresponse()

    def line(self) -> str:
        """The next line with content, which no sign of life has; the empty text at the end."""
        while (line := self.answer.readline()) == b"\n" or line.startswith(b":"):
            pass
        return line.decode().strip()

    def message(self) -> Any:
        kind, _, text = self.line().partition(": ")
        assert kind == "data"
        return json.loads(text)

    def close(self) -> None:
        self.answer.close()
        self._connection.close()


def test_messages_arrive_as_they_are_published(server: Server) -> None:
    server.feed.publish({"kind": "model", "model": {"name": "a\nb"}})
    stream = Stream(server)
    assert stream.answer.getheader("Content-Type") == "text/event-stream; charset=utf-8"
    assert stream.message() == {"kind": "model", "model": {"name": "a\nb"}}
    server.feed.publish({"kind": "control", "paused": True})
    assert stream.message() == {"kind": "control", "paused": True}
    server.feed.close()
    assert stream.line() == "event: end"
    stream.close()


def test_there_is_a_limit_of_readers(server: Server) -> None:
    server.feed.publish({"kind": "model"})
    streams = [Stream(server) for _ in range(MOST_READERS)]
    assert all(stream.message() == {"kind": "model"} for stream in streams)
    assert answer(server, path="/events")[0] == 503
    for stream in streams:
        stream.close()


def test_a_reader_that_takes_nothing_does_not_hold_up_the_others(server: Server) -> None:
    with socket.create_connection((HOST, server.port)) as dead:
        dead.sendall(f"GET /events HTTP/1.1\r\nHost: {HOST}\r\n\r\n".encode())
        stream = Stream(server)
        text = json.dumps({"kind": "trace", "events": [{"text": "x" * 100_000}]}).encode()
        for _ in range(300):  # 30 MB: more than the buffers of a socket hold
            server.feed.append("trace", text, 1)
        for _ in range(300):
            assert stream.message()["kind"] == "trace"
        stream.close()


def test_a_port_that_is_in_use_is_an_error(server: Server) -> None:
    with pytest.raises(OSError, match="in use"):
        ViewServer(server.port, lambda: PAGE, Feed())


def test_a_film_is_served_where_there_is_one(server: Server) -> None:
    assert answer(server, path="/film")[0] == 404
    server.film = Film("video/mp4", lambda: b"film")
    status, content, response = answer(server, path="/film")
    assert (status, content) == (200, "film")
    assert response.headers["Content-Type"] == "video/mp4"
    assert answer(server, path="/film", headers={"Origin": "http://other"})[0] == 403

    def gone() -> bytes:
        raise FileNotFoundError(2, "No such file or directory")

    server.film = Film("video/mp4", gone)
    status, content, _ = answer(server, path="/film")
    assert (status, json.loads(content)) == (
        404,
        {"error": "the film cannot be read: No such file or directory"},
    )
