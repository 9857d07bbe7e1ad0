"""Edits that add a missing key to the `input_keys` or `output_keys` of a state."""

from __future__ import annotations

import re
from collections.abc import Iterable

from smachac.diagnostics.diagnostic import Edit
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import is_plain
from smachac.ir.nodes import Container, Key, Node

_BODY = re.compile(
    r"[ \t]*:[ \t]*(?:(?P<flow>\{)|(?:#[^\n]*)?(?:\r?\n[ \t]*(?:#[^\n]*)?)*(?P<block>\S))"
)
"""The text between the name of a state and the first of its fields."""


def with_input(container: Container, key: str) -> tuple[Edit, ...]:
    """The edit that adds a key to the `input_keys` of a container, where its place is certain."""
    return _with_key(container, container.inputs, "input_keys", key)


def with_output(node: Node, key: str) -> tuple[Edit, ...]:
    """The edit that adds a key to the `output_keys` of a state, where its place is certain."""
    return _with_key(node, node.outputs, "output_keys", key)


def with_key_list(node: Node, part: str, keys: Iterable[str]) -> tuple[Edit, ...]:
    """The edit that begins a list of keys of a state which has none, where its place is certain."""
    names = [*keys]
    return _begun(node.span, part, ", ".join(names)) if all(map(is_plain, names)) else ()


def _with_key(node: Node, known: Iterable[Key], part: str, key: str) -> tuple[Edit, ...]:
    if not is_plain(key):
        return ()
    spans = (each.span for each in known if each.span.source is node.span.source)
    last = max(spans, key=lambda span: span.start, default=None)
    return _listed(last, key) if last is not None else _begun(node.span, part, key)


def _listed(last: Span, key: str) -> tuple[Edit, ...]:
    """The edit that adds an item after the last one of a list."""
    text = last.source.text
    if last.source is NOWHERE.source or text[last.end :].lstrip(" \t").startswith(":"):
        return ()
    start = text.rfind("\n", 0, last.start) + 1
    if text[start : last.start].strip() != "-":
        return (Edit(span=Span(last.source, last.end, last.end), text=f", {key}"),)
    line, _ = last.source.position(last.start)
    end = start + len(last.source.line(line))
    new = f"{_line_end(text, last.end)}{text[start : last.start]}{key}"
    return (Edit(span=Span(last.source, end, end), text=new),)


def _begun(name: Span, part: str, key: str) -> tuple[Edit, ...]:
    """The edit that adds a list with one item as the first field of a state."""
    text = name.source.text
    body = _BODY.match(text, name.end)
    if body is None or name.source is NOWHERE.source:
        return ()
    if body["flow"]:
        place = Span(name.source, body.end(), body.end())
        return (Edit(span=place, text=f"{part}: [{key}], "),)
    first = body.start("block")
    indent = text[text.rfind("\n", 0, first) + 1 : first]
    at = text.find("\n", name.end) + 1
    if indent.strip() or not name.end < at <= first:
        return ()
    new = f"{indent}{part}: [{key}]{_line_end(text, name.end)}"
    return (Edit(span=Span(name.source, at, at), text=new),)


def _line_end(text: str, at: int) -> str:
    """The line end after an offset, used for new lines too."""
    end = text.find("\n", at)
    return "\r\n" if end > 0 and text[end - 1] == "\r" else "\n"
