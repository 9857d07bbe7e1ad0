"""Differences between SMACHA and smachac in a script.

SMACHA's parser replaced words wherever they occurred, and printed values by their look (reference:
its sources). These places are valid in smachac, but have another meaning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Literal

from smachac.diagnostics.source import Span
from smachac.frontend.schema import LONG
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.records import dataclass
from smachac.targets.python.smacha_context import is_dotted_or_call

What = Literal["edit", "changed", "note"]
"""Required action: an edit; none, but the meaning is different; none (information)."""

SMACHA_SHORT = frozenset(LONG) - {"k"}
"""The words that SMACHA replaced by their long form."""

_MERGED = ("script", "params", "userdata", "remapping", "transitions", "template")
"""The fields that SMACHA took from a call, over those of the sub-script."""

_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?|[-+]?(inf|nan|infinity)", re.I)


@dataclass(frozen=True, slots=True, kw_only=True)
class SmachaDifference:
    """A difference at a span: its name, what SMACHA did and what smachac does, and the required
    action. `variable` is the undefined variable of a template, if the difference is about one."""

    span: Span
    name: str
    message: str
    what: What = "changed"
    variable: str = ""


def script_differences(tree: Tree | None) -> Iterator[SmachaDifference]:
    """The differences in a script or sub-script, in the order of the text."""
    found: list[SmachaDifference] = []
    if isinstance(tree, Map):
        found += _state(tree.entries, base=True)
        _states(tree.entries, found, split=False)
    elif isinstance(tree, Seq):
        _items(tree, found, split=False)
    yield from sorted(found, key=lambda difference: difference.span.start)


def _states(entries: tuple[Entry, ...], found: list[SmachaDifference], *, split: bool) -> None:
    value = _value(entries, "states")
    if isinstance(value, Seq):
        _items(value, found, split=split)


def _items(tree: Seq, found: list[SmachaDifference], *, split: bool) -> None:
    """The states of a list. `split`: they are branches of a concurrence."""
    for item in tree.items:
        if not isinstance(item, Map) or not item.entries:
            continue
        first = item.entries[0]
        entries = first.value.entries if isinstance(first.value, Map) else item.entries[1:]
        name = str(first.key.value)
        if name in SMACHA_SHORT:
            message = f"SMACHA renamed this state to `{LONG[name]}`; here it is `{name}`"
            found.append(
                SmachaDifference(span=first.key.span, name="state-renamed", message=message)
            )
        found += _state(entries, base=False)
        userdata = _value(entries, "userdata")
        if split and isinstance(userdata, Map) and userdata.entries:
            message = (
                "SMACHA's program was no Python with userdata here; now the concurrence has it"
            )
            found.append(
                SmachaDifference(
                    span=userdata.span, name="userdata-in-concurrence", message=message
                )
            )
        template = _value(entries, "template")
        inner = isinstance(template, Scalar) and template.value == "Concurrence"
        _states(entries, found, split=inner)


def _value(entries: tuple[Entry, ...], name: str) -> Tree | None:
    """The value of a field by its long name."""
    for entry in entries:
        if LONG.get(str(entry.key.value), str(entry.key.value)) == name:
            return entry.value
    return None


def _state(entries: tuple[Entry, ...], *, base: bool) -> list[SmachaDifference]:
    found: list[SmachaDifference] = []
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
            found.append(
                SmachaDifference(span=entry.key.span, name="manifest", message=message, what="note")
            )
        if calls and name not in _MERGED:
            message = (
                f"SMACHA passed `{name}` of a call over, or lost the state for it; here it counts"
            )
            found.append(
                SmachaDifference(span=entry.key.span, name="call-variable", message=message)
            )
        found += _renamed(entry.value)
        found += _look_ups(entry, names)
        if name == "userdata":
            found += _userdata(entry.value)
    return found


def _renamed(tree: Tree) -> Iterator[SmachaDifference]:
    """Keys of data that SMACHA replaced by long names."""
    if isinstance(tree, Map):
        for entry in tree.entries:
            key = str(entry.key.value)
            if key in SMACHA_SHORT:
                message = f"SMACHA renamed this key to `{LONG[key]}`; here it is `{key}`"
                yield SmachaDifference(span=entry.key.span, name="key-renamed", message=message)
            yield from _renamed(entry.value)
    elif isinstance(tree, Seq):
        for item in tree.items:
            yield from _renamed(item)


def _look_ups(entry: Entry, names: set[str]) -> Iterator[SmachaDifference]:
    """Lists that SMACHA took for look-ups of fields, and look-ups that it ignored."""
    todo: list[tuple[Tree, int, bool]] = [(entry.value, 0, False)]
    while todo:
        tree, depth, listed = todo.pop()
        if isinstance(tree, Map):
            todo += [(entry.value, depth + 1, listed) for entry in tree.entries]
            continue
        if not isinstance(tree, Seq):
            continue
        words = [item.value for item in tree.items if isinstance(item, Scalar)]
        first = words[0] if words and len(words) == len(tree.items) else None
        if first == "params" and len(words) == 2 and depth > 1:
            message = "SMACHA left this look-up a list: it stands too deep; here it is filled in"
            yield SmachaDifference(span=tree.span, name="deep-look-up", message=message)
        elif first != "params" and first in names and len(words) <= 2 and depth <= 1:
            message = (
                f"SMACHA put the variable `{first}` of this state here; here the list stays a list"
            )
            yield SmachaDifference(span=tree.span, name="variable-look-up", message=message)
        # The parts of a string construct stand as deep as the construct itself.
        todo += [(item, depth + listed, True) for item in tree.items]


def _userdata(tree: Tree) -> Iterator[SmachaDifference]:
    for entry in tree.entries if isinstance(tree, Map) else ():
        key = str(entry.key.value)
        if key != key.lower():
            message = f"SMACHA made this `{key.lower()}`, but no other keys; here it is `{key}`"
            yield SmachaDifference(span=entry.key.span, name="key-case", message=message)
        if isinstance(entry.value, Scalar):
            yield from _literal(entry.value)


def _literal(value: Scalar) -> Iterator[SmachaDifference]:
    """Values that SMACHA printed with another meaning."""
    text = value.value
    if text is None:
        yield SmachaDifference(
            span=value.span,
            name="null-as-text",
            message="SMACHA made this the text 'None'; here it is None",
        )
    if not isinstance(text, str):
        return
    if len(text) > 2 and text[0] == text[-1] == "`":
        message = "SMACHA left the backticks in userdata; here this is code"
        yield SmachaDifference(span=value.span, name="code-in-userdata", message=message)
    elif not text.startswith("'") and (is_dotted_or_call(text) or _NUMBER.fullmatch(text)):
        from smachac.ir.expressions import looks_like_expression, parse_expression

        code = value.plain and looks_like_expression(text) and parse_expression(text) is not None
        if not code:
            message = "SMACHA printed this as code, for it looks like it; here it is text"
            yield SmachaDifference(span=value.span, name="text-as-code", message=message)
    elif "'" in text and not text.startswith("'"):
        message = "SMACHA's program was no Python with this text; here it is escaped"
        yield SmachaDifference(span=value.span, name="text-with-quote", message=message)
