"""Edits that add a missing key to the `input_keys` or `output_keys` of a state."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise, takewhile
from typing import Literal

from smachac.checks.findings import notation
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import is_plain
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Key, Node
from smachac.ir.script_paths import name_in_script

KeyList = Literal["input_keys", "output_keys"]

MOST_LISTED = 4
"""Limit on the keys of a list that a help repeats."""

_BODY = re.compile(
    r"[ \t]*:[ \t]*(?:(?P<flow>\{)|(?:#[^\n]*)?(?:\r?\n[ \t]*(?:#[^\n]*)?)*(?P<block>\S))"
)
"""The text between the name of a state and the first of its fields."""


def with_input(node: Node, key: str) -> tuple[Edit, ...]:
    """The edit that adds a key to the `input_keys` of a state, where its place is certain."""
    return _with_key(node, node.inputs, "input_keys", key)


def with_output(node: Node, key: str) -> tuple[Edit, ...]:
    """The edit that adds a key to the `output_keys` of a state, where its place is certain."""
    return _with_key(node, node.outputs, "output_keys", key)


def with_key_list(node: Node, part: str, keys: Iterable[str]) -> tuple[Edit, ...]:
    """The edit that begins a list of keys of a state which has none, where its place is certain."""
    names = [*keys]
    return (
        with_field(node.span, f"{part}: [{', '.join(names)}]") if all(map(is_plain, names)) else ()
    )


def with_remapping(node: Node, key: str, to: str) -> tuple[Edit, ...]:
    """The edit that adds an entry to the `remapping` of a state, where its place is certain."""
    if not (is_plain(key) and is_plain(to)):
        return ()
    last = max((remap.to_span for remap in node.remaps), key=lambda span: span.start, default=None)
    if last is None:
        return with_field(node.span, f"remapping: {{{key}: {to}}}")
    source = last.source
    is_flow = "{" in source.text[source.text.rfind("\n", 0, last.start) + 1 : last.start]
    end = Span(source, last.end, last.end)
    return (Edit(span=end, text=f", {key}: {to}"),) if is_flow else ()


def likely(edits: Iterable[Edit], operator: str) -> tuple[Repair, ...]:
    """The repair with these edits, if there are any."""
    repair = Repair(edits=tuple(edits), certainty=Certainty.LIKELY, operator=operator)
    return (repair,) if repair.edits else ()


def adding_outcome(node: Node, outcome: str) -> tuple[Repair, ...]:
    """The repair that adds an outcome to those that a state lists, where its place is certain."""
    here = [outcome.span for outcome in node.outcomes if outcome.span.source is node.span.source]
    after = sorted({span for span in here if span.start > node.span.start})
    while after and after[0].source.text[: after[0].start].rstrip()[-1:] not in ("[", "-"):
        del after[0]  # the name is not the first one of a list
    count = sum(1 for _ in takewhile(_are_in_one_list, pairwise(after)))
    edits = _listed(after[count], outcome) if after and is_plain(outcome) else ()
    return likely(edits, "add the outcome")


def _are_in_one_list(pair: tuple[Span, Span]) -> bool:
    first, second = pair
    return not first.source.text[first.end : second.start].strip(" \t\r\n,-")


def listing(nodes: Iterable[Node], part: KeyList, key: str) -> str:
    """The help that adds a key to a list of keys of some states: the whole list where it is short
    and written in brackets, or where there is none."""
    every = [*nodes]
    names = listed(name_in_script(state) for state in every)
    shown = {_whole_list(state, part, key) for state in every}
    if len(shown) == 1 and (whole := shown.pop()):
        return f"write `{notation.names(every[0], part, whole)}` in {names}"
    return f"add `{key}` to the `{part}` of {names}"


def _whole_list(node: Node, part: KeyList, key: str) -> tuple[str, ...]:
    """The items of a list of keys with one more; none where it is long, or no list."""
    known = node.inputs if part == "input_keys" else node.outputs
    if not known:
        return (key,)
    text = node.span.source.text
    if len(known) > MOST_LISTED or any(key.span.source is not node.span.source for key in known):
        return ()
    first, last = known[0].span, known[-1].span
    in_brackets = (
        text[: first.start].rstrip().endswith("[") and text[last.end :].lstrip()[:1] == "]"
    )
    between = text[first.start : last.end]
    names = [key.name for key in known]
    written = [part.strip().strip("'\"") for part in between.split(",")]
    return (*names, key) if in_brackets and written == names and key not in names else ()


def _with_key(node: Node, known: Iterable[Key], part: str, key: str) -> tuple[Edit, ...]:
    if not is_plain(key):
        return ()
    spans = (key.span for key in known if key.span.source is node.span.source)
    last = max(spans, key=lambda span: span.start, default=None)
    return _listed(last, key) if last is not None else with_field(node.span, f"{part}: [{key}]")


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


def with_field(name: Span, field: str) -> tuple[Edit, ...]:
    """The edit that adds a field as the first one of a state."""
    text = name.source.text
    body = _BODY.match(text, name.end)
    if body is None or name.source is NOWHERE.source:
        return ()
    if body["flow"]:
        place = Span(name.source, body.end(), body.end())
        return (Edit(span=place, text=f"{field}, "),)
    first = body.start("block")
    indent = text[text.rfind("\n", 0, first) + 1 : first]
    at = text.find("\n", name.end) + 1
    if indent.strip() or not name.end < at <= first:
        return ()
    new = f"{indent}{field}{_line_end(text, name.end)}"
    return (Edit(span=Span(name.source, at, at), text=new),)


def _line_end(text: str, at: int) -> str:
    """The line end after an offset, used for new lines too."""
    end = text.find("\n", at)
    return "\r\n" if end > 0 and text[end - 1] == "\r" else "\n"
