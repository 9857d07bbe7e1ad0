"""The events of a recorded trace, for the page that replays it."""

from __future__ import annotations

import json
from typing import Any

from smachac.ir.nodes import Machine
from smachac.runtime.tracing.values import shown_value
from smachac.runtime.tracing.writer import LONGEST_LINE, LONGEST_NAME
from smachac.targets import OptionError

LONGEST_VALUE = 1_000
"""Characters of an event up to which its value is passed on as it is."""

NAMES = ("event", "path", "outcome", "to", "key")
"""The fields of events that have names."""


def read_event(line: str | bytes) -> dict[str, Any] | None:
    """The event in a line of a trace, a long value of it cut; None if there is none."""
    if len(line) > LONGEST_LINE:
        return None
    try:
        event = json.loads(line)
    except (ValueError, RecursionError):
        return None
    if not isinstance(event, dict):
        return None
    if not isinstance(event.get("event"), str) or not isinstance(event.get("path"), str):
        return None
    if any(isinstance(text, str) and len(text) > LONGEST_NAME for text in map(event.get, NAMES)):
        return None
    if "value" in event and len(line) > LONGEST_VALUE:
        event["value"] = shown_value(event["value"])
    return event


def read_trace(machine: Machine, text: str) -> list[dict[str, Any]]:
    """The events of a trace of a machine. Raises OptionError."""
    events = []
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip():
            continue
        event = read_event(line)
        if event is None:
            raise OptionError(f"`trace`: line {number} is no event of a trace")
        if event["path"].partition("/")[0] != machine.root.name:
            raise OptionError(
                f"`trace`: line {number} is of another machine than `{machine.root.name}`"
            )
        events.append(event)
    return events
