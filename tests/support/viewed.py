"""A process of smachac that serves a view, with a reader of its stream."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from http.client import HTTPConnection
from typing import Any

from smachac.view.server import HOST, TOKEN


class Viewed:
    """A process of smachac that serves a view, and a reader of its stream."""

    def __init__(
        self,
        *words: object,
        python: str = sys.executable,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        self.process = subprocess.Popen(
            [python, "-m", "smachac", *map(str, words)],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self.process.stderr is not None
        self.lines: list[str] = []
        found = None
        while found is None:
            line = self.process.stderr.readline()
            assert line, self.lines
            self.lines.append(line)
            found = re.fullmatch(rf"view: http://{HOST}:(\d+)/#token=(\S+)\n", line)
        self.port, self.token = int(found[1]), found[2]
        self.url = line.split()[1]
        self._open()

    def _open(self) -> None:
        self._connection = HTTPConnection(HOST, self.port, timeout=60)
        self._connection.request("GET", "/events")
        self._stream = self._connection.getresponse()

    def reopen(self) -> None:
        """Read the stream from its beginning."""
        self.close()
        self._open()

    def close(self) -> None:
        """Read the stream no more."""
        self._stream.close()
        self._connection.close()

    def message(self) -> Any:
        """The next message of the stream; None at its end."""
        while line := self._stream.readline():
            if line.startswith(b"event: end"):
                return None
            if line.startswith(b"data: "):
                return json.loads(line[6:])
        return None

    def until(self, condition: Callable[[Any], bool]) -> Any:
        """The next message that fulfils a condition."""
        while (message := self.message()) is not None:
            if condition(message):
                return message
        raise AssertionError("the stream has ended")

    def act(self, **body: str) -> int:
        return self.post("/control", body)[0]

    def post(self, path: str, body: object) -> tuple[int, Any]:
        """Do an action: the status and the content of the answer."""
        connection = HTTPConnection(HOST, self.port, timeout=60)
        connection.request("POST", path, json.dumps(body), {TOKEN: self.token})
        answer = connection.getresponse()
        content = json.loads(answer.read())
        connection.close()
        return answer.status, content

    def page(self) -> str:
        connection = HTTPConnection(HOST, self.port, timeout=60)
        connection.request("GET", "/")
        text = connection.getresponse().read().decode()
        connection.close()
        return text

    def end(self) -> tuple[int, str, str]:
        """Wait for the end: exit code, standard output, standard error."""
        out, err = self.process.communicate(timeout=60)
        return self.process.returncode, out, err


@contextmanager
def starter() -> Iterator[Callable[..., Viewed]]:
    """Starts processes, which end with the context."""
    begun: list[Viewed] = []

    def started(*words: object, **options: Any) -> Viewed:
        begun.append(Viewed(*words, **options))
        return begun[-1]

    yield started
    for item in begun:
        item.close()
        item.process.kill()
        item.process.communicate()
