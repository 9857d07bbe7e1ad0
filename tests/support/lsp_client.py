"""A client of the language server: JSON-RPC over the streams of a real process."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

LONGEST = 300
"""Seconds after which a server that no longer answers is killed, so that no test waits forever."""


class ResponseError(Exception):
    """The server answers a request with an error, or shows one."""


class Client:
    """A running server. Messages are read when they are waited for."""

    def __init__(self, folder: Path, *, encodings: Sequence[str] = ()) -> None:
        self.errors = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = subprocess.Popen(
            [sys.executable, "-m", "smachac", "lsp"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.errors,
        )
        self.guard = threading.Timer(LONGEST, self.process.kill)
        self.guard.start()
        self.complaints = ""
        self.number = 0
        self.version = 0
        self.opened: dict[str, None] = {}
        self.diagnostics: dict[str, dict[str, Any]] = {}
        general = {"general": {"positionEncodings": list(encodings)}} if encodings else {}
        folders = [{"uri": folder.as_uri(), "name": folder.name}]
        self.capabilities = self.ask(
            "initialize",
            processId=None,
            rootUri=folder.as_uri(),
            workspaceFolders=folders,
            capabilities=general,
        )["capabilities"]
        self.tell("initialized")

    def __enter__(self) -> Client:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is not None:
            self.process.kill()
            self.process.wait()
        self.end()

    def end(self) -> str:
        """End the session; what the server wrote to standard error."""
        if not self.errors.closed:
            if self.process.poll() is None:
                self.ask("shutdown")
                self.tell("exit")
            self.process.wait(timeout=60)
            self.guard.cancel()
            self.complaints = self.written_errors()
            for stream in (self.process.stdin, self.process.stdout, self.errors):
                if stream is not None:
                    stream.close()
        return self.complaints

    def written_errors(self) -> str:
        self.errors.seek(0)
        return self.errors.read().decode()

    def send(self, message: dict[str, Any]) -> None:
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin is not None
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
        self.process.stdin.flush()

    def receive(self) -> dict[str, Any]:
        assert self.process.stdout is not None
        size = 0
        while (line := self.process.stdout.readline().strip()) or not size:
            if not line and self.process.poll() is not None:
                raise EOFError(self.written_errors())
            if line.lower().startswith(b"content-length:"):
                size = int(line.split(b":")[1])
        message: dict[str, Any] = json.loads(self.process.stdout.read(size))
        return message

    def note(self, message: dict[str, Any]) -> None:
        """Keep what the server tells, and accept what it asks."""
        if message.get("method") == "textDocument/publishDiagnostics":
            self.diagnostics[message["params"]["uri"]] = message["params"]
        elif "id" in message:
            self.send({"id": message["id"], "result": None})
        elif message.get("method") == "window/showMessage":
            raise ResponseError(f"{message['params']['message']}\n{self.written_errors()}")

    def ask(self, method: str, **params: Any) -> Any:
        """The result of a request."""
        self.number += 1
        self.send({"id": self.number, "method": method, "params": params})
        while (message := self.receive()).get("id") != self.number or "method" in message:
            self.note(message)
        if "error" in message:
            raise ResponseError(message["error"]["message"])
        return message["result"]

    def tell(self, method: str, **params: Any) -> None:
        self.send({"method": method, "params": params})

    # --- documents

    def open(self, path: Path, text: str | None = None) -> str:
        """Open a document; its URI."""
        self.version += 1
        text = path.read_text("utf-8") if text is None else text
        self.opened[path.as_uri()] = None
        document = {"uri": path.as_uri(), "languageId": "yaml", "version": self.version}
        self.tell("textDocument/didOpen", textDocument={**document, "text": text})
        return path.as_uri()

    def close_all(self) -> None:
        """Close the documents that are open."""
        for uri in self.opened:
            self.tell("textDocument/didClose", textDocument={"uri": uri})
        self.opened.clear()

    def change(self, uri: str, text: str) -> None:
        self.version += 1
        document = {"uri": uri, "version": self.version}
        self.tell("textDocument/didChange", textDocument=document, contentChanges=[{"text": text}])

    def findings(self, uri: str) -> list[dict[str, Any]]:
        """The findings in the last version of a document."""
        while self.diagnostics.get(uri, {}).get("version") != self.version:
            self.note(self.receive())
        found: list[dict[str, Any]] = self.diagnostics[uri]["diagnostics"]
        return found

    def at(self, method: str, uri: str, text: str, word: str, **params: Any) -> Any:
        """The answer about a place of a text: that of `|` in `word`, which the text has without."""
        before, _, after = word.partition("|")
        offset = text.index(before + after) + len(before)
        line = text.count("\n", 0, offset)
        column = offset - text.rfind("\n", 0, offset) - 1
        position = {"line": line, "character": column}
        return self.ask(
            f"textDocument/{method}", textDocument={"uri": uri}, position=position, **params
        )
