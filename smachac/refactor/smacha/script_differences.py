"""Where a script of SMACHA's relies on what SMACHA did, and smachac does something else.

SMACHA's parser replaced words wherever it found them, and wrote values into the program as they
looked (reference: its sources). None of this is a fault here; who moves over should know of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from smachac.diagnostics.source import Span
from smachac.frontend.schema import LONG
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Seq, Tree

What = Literal["edit", "changed", "told"]
"""It has to be edited; it means something else here; it is told and works as before."""

SMACHA_SHORT = frozenset(LONG) - {"k"}
"""The words that SMACHA replaced by others."""

_MERGED = ("script", "params", "userdata", "remapping", "transitions", "template")
"""What SMACHA took over from a call, whatever the sub-script had."""

_RAW = re.compile(r"\D+[.]\D+|.*\(.*\)")
"""What SMACHA printed as code."""

_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?|[-+]?(inf|nan|infinity)", re.I)


@dataclass(frozen=True, slots=True, kw_only=True)
class Quirk:
    """A place, the name of the quirk, what SMACHA did there and what happens here; `what` it is to
    the reader."""

    span: Span
    name: str
    message: str
    what: What = "changed"


def quirks(tree: Tree | None) -> Iterator[Quirk]:
    """The quirks in a script or sub-script, in the order of the text."""
    found: list[Quirk] = []
    if isinstance(tree, Map):
        found += _state(tree.entries, base=True)
        _states(tree.entries, found, split=False)
    elif isinstance(tree, Seq):
        _items(tree, found, split=False)
    yield from sorted(found, key=lambda quirk: quirk.span.start)


def _states(entries: tuple[Entry, ...], found: list[Quirk], *, split: bool) -> None:
    value = _value(entries, "states")
    if isinstance(value, Seq):
        _items(value, found, split=split)


def _items(tree: Seq, found: list[Quirk], *, split: bool) -> None:
    """The states of a list; `split`: they are those of a concurrence."""
    for item in tree.items:
        if not isinstance(item, Map) or not item.entries:
            continue
        first = item.entries[0]
        entries = first.value.entries if isinstance(first.value, Map) else item.entries[1:]
        name = str(first.key.value)
        if name in SMACHA_SHORT:
            message = f"SMACHA renamed this state to `{LONG[name]}`; here it is `{name}`"
            found.append(Quirk(span=first.key.span, name="state-renamed", message=message))
        found += _state(entries, base=False)
        userdata = _value(entries, "userdata")
        if split and isinstance(userdata, Map) and userdata.entries:
            message = (
                "SMACHA's program was no Python with userdata here; now the concurrence has it"
            )
            found.append(Quirk(span=userdata.span, name="userdata-in-concurrence", message=message))
        template = _value(entries, "template")
        inner = isinstance(template, Scalar) and template.value == "Concurrence"
        _states(entries, found, split=inner)


def _value(entries: tuple[Entry, ...], name: str) -> Tree | None:
    """The value of a variable by its long name."""
    for entry in entries:
        if LONG.get(str(entry.key.value), str(entry.key.value)) == name:
            return entry.value
    return None


def _state(entries: tuple[Entry, ...], *, base: bool) -> list[Quirk]:
    found: list[Quirk] = []
    names = {LONG.get(str(entry.key.value), str(entry.key.value)) for entry in entries}
    calls = "script" in names
    for entry in entries:
        name = LONG.get(str(entry.key.value), str(entry.key.value))
        if name == "states":
            continue
        if base and name == "manifest":
            message = (
                "SMACHA called `roslib.load_manifest` with this, which does nothing for packages of"
                " catkin; here it has no effect"
            )
            found.append(Quirk(span=entry.key.span, name="manifest", message=message, what="told"))
        if calls and name not in _MERGED:
            message = (
                f"SMACHA passed `{name}` of a call over, or lost the state for it; here it counts"
            )
            found.append(Quirk(span=entry.key.span, name="call-variable", message=message))
        found += _renamed(entry.value)
        found += _look_ups(entry, names)
        if name == "userdata":
            found += _userdata(entry.value)
    return found


def _renamed(tree: Tree) -> Iterator[Quirk]:
    """Keys of data that SMACHA took for its short names."""
    if isinstance(tree, Map):
        for entry in tree.entries:
            key = str(entry.key.value)
            if key in SMACHA_SHORT:
                message = f"SMACHA renamed this key to `{LONG[key]}`; here it is `{key}`"
                yield Quirk(span=entry.key.span, name="key-renamed", message=message)
            yield from _renamed(entry.value)
    elif isinstance(tree, Seq):
        for item in tree.items:
            yield from _renamed(item)


def _look_ups(entry: Entry, names: set[str]) -> Iterator[Quirk]:
    """Lists that SMACHA took for look-ups of other variables, and look-ups it did not see."""
    todo: list[tuple[Tree, int, bool]] = [(entry.value, 0, False)]
    while todo:
        tree, depth, listed = todo.pop()
        if isinstance(tree, Map):
            todo += [(each.value, depth + 1, listed) for each in tree.entries]
            continue
        if not isinstance(tree, Seq):
            continue
        words = [item.value for item in tree.items if isinstance(item, Scalar)]
        first = words[0] if words and len(words) == len(tree.items) else None
        if first == "params" and len(words) == 2 and depth > 1:
            message = "SMACHA left this look-up a list: it stands too deep; here it is filled in"
            yield Quirk(span=tree.span, name="deep-look-up", message=message)
        elif first != "params" and first in names and len(words) <= 2 and depth <= 1:
            message = (
                f"SMACHA put the variable `{first}` of this state here; here the list stays a list"
            )
            yield Quirk(span=tree.span, name="variable-look-up", message=message)
        # The parts of a string construct stand as deep as the construct itself.
        todo += [(item, depth + listed, True) for item in tree.items]


def _userdata(tree: Tree) -> Iterator[Quirk]:
    for entry in tree.entries if isinstance(tree, Map) else ():
        key = str(entry.key.value)
        if key != key.lower():
            message = f"SMACHA made this `{key.lower()}`, but no other keys; here it is `{key}`"
            yield Quirk(span=entry.key.span, name="key-case", message=message)
        if isinstance(entry.value, Scalar):
            yield from _literal(entry.value)


def _literal(value: Scalar) -> Iterator[Quirk]:
    """Values that SMACHA printed otherwise than they were meant."""
    text = value.value
    if text is None:
        yield Quirk(
            span=value.span,
            name="null-as-text",
            message="SMACHA made this the text 'None'; here it is None",
        )
    if not isinstance(text, str):
        return
    if len(text) > 2 and text[0] == text[-1] == "`":
        message = "SMACHA left the backticks in userdata; here this is code"
        yield Quirk(span=value.span, name="code-in-userdata", message=message)
    elif not text.startswith("'") and (_RAW.match(text) or _NUMBER.fullmatch(text)):
        from smachac.ir.expressions import looks_like_expression, parse_expression

        code = value.plain and looks_like_expression(text) and parse_expression(text) is not None
        if not code:
            message = "SMACHA printed this as code, for it looks like it; here it is text"
            yield Quirk(span=value.span, name="text-as-code", message=message)
    elif "'" in text and not text.startswith("'"):
        message = "SMACHA's program was no Python with this text; here it is escaped"
        yield Quirk(span=value.span, name="text-with-quote", message=message)
