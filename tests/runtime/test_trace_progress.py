"""Live progress on streams of every kind."""

from __future__ import annotations

import io
import re
from typing import Any

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.runtime.tracing.progress import Progress, Sugar
from tests.support.ir_machines import leaf, machine, ran


def root() -> Any:
    inner = machine(
        "PICK",
        "ok",
        leaf("MOVE", {"succeeded": "WAIT"}, type="SleepState", time=1.25),
        leaf("WAIT", {"aborted": "ok"}, type="Unknown"),
        to={"ok": "AGAIN"},
    )
    again = machine("AGAIN", "ok", leaf("größe", {"preempted": "ok"}), to={"ok": "done"})
    return machine("sm", "done", inner, again)


def shown(stream: Any = None, **options: Any) -> Any:
    stream = stream or io.StringIO()
    progress = Progress(stream, **options)
    for event in ran(root(), builtin_behaviour())[1]:
        progress(event)
    return stream


def test_states_show_as_they_end_and_containers_as_they_start() -> None:
    assert shown().getvalue() == (
        "sm\n"
        "  PICK\n"
        "    MOVE                                  succeeded  1.25 s\n"
        "    WAIT                                  aborted  0.00 s\n"
        "  PICK                                    ok  1.25 s\n"
        "  AGAIN\n"
        "    größe                                 preempted  0.00 s\n"
        "  AGAIN                                   ok  0.00 s\n"
        "sm                                        done  1.25 s\n"
    )


def test_colours_are_added_and_nothing_else() -> None:
    text = shown(colour=True).getvalue()
    assert "\x1b[32msucceeded\x1b[0m" in text
    assert "\x1b[31maborted\x1b[0m" in text
    assert re.sub(r"\x1b\[\d+m", "", text) == shown().getvalue()


def test_a_stream_that_cannot_encode_a_name_shows_marks() -> None:
    raw = io.BytesIO()
    stream = shown(io.TextIOWrapper(raw, encoding="ascii"))
    assert stream.writable()
    assert b"    gr??e  " in raw.getvalue()


def test_a_stream_that_is_gone_is_left_alone() -> None:
    class Gone(io.StringIO):
        writes = 0

        def write(self, text: str) -> int:
            self.writes += 1
            raise BrokenPipeError

    assert shown(Gone()).writes == 1
    closed = io.StringIO()
    closed.close()
    shown(closed)


def test_errors_and_requests_to_stop_are_told() -> None:
    stream = io.StringIO()
    progress = Progress(stream, Sugar(catching=frozenset({"sm/B"})))
    progress({"event": "start", "path": "sm", "t": 0.0})
    progress({"event": "preempt", "path": "sm", "t": 0.5})
    progress({"event": "preempt", "path": "sm/A", "t": 0.5})
    progress({"event": "enter", "path": "sm/A", "t": 0.5})
    progress({"event": "error", "path": "sm/A", "message": "ValueError: broken", "t": 0.6})
    progress({"event": "error", "path": "sm/B", "message": "ValueError: broken", "t": 0.6})
    assert [line.split() for line in stream.getvalue().splitlines()] == [
        ["sm", "asked", "to", "stop"],
        ["sm"],
        ["A", "error"],  # the report of the run has the message
        ["B", "error:", "ValueError:", "broken"],
    ]
