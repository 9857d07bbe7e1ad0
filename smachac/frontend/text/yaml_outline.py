"""The outline of a text of YAML in block style: its keys and items by their columns.

It is read from lines, so a text that is no YAML has one too, and a few lines can be moved for trial
without a parser. `form_of` measures how far an outline is from the form of a script.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from smachac.frontend.schema import CONTAINERS, INTERFACE_FIELDS, LONG, REQUIRED, VARIABLES
from smachac.records import dataclass, field


class Row(NamedTuple):
    """A key or an item in the lines `line` to `last`, at the index `start` of the text.

    `column` is that of its first sign, `dashes` are the columns of its dashes, `key_column` is that
    of its key or text. `key` is empty for a text, `value` is the rest of the line.
    """

    line: int
    last: int
    start: int
    column: int
    dashes: tuple[int, ...]
    key_column: int
    key: str
    value: str

    def moved(self, by: int) -> Row:
        return self._replace(
            column=self.column + by,
            dashes=tuple(dash + by for dash in self.dashes),
            key_column=self.key_column + by,
        )


@dataclass(slots=True)
class Part:
    """A mapping, a list or (with neither entries nor items) a text at a column. `entries` are keys
    with their values; None is the value of a key without one."""

    kind: str
    column: int
    value: str = ""
    entries: list[tuple[str, Part | None]] = field(default_factory=list)


_ROW = re.compile(r"( *)((?:- +)*)(?:([\w./$~-]+|'[^']*'|\"[^\"]*\"):(?=[ \t]|$))?[ \t]*(.*)")
_QUOTED = re.compile(r"'[^'\n]*'|\"(?:[^\"\\\n]|\\.)*\"")
_COMMENT = re.compile(r"(?:^|[ \t])#.*")
_BLOCK_TEXT = re.compile(r"[|>][-+0-9]*")


def rows_of(text: str) -> list[Row]:
    """The rows of a text; none if it has a tab in an indentation, or brackets that are not even."""
    rows: list[Row] = []
    start, depth, inside = 0, 0, -1
    for number, line in enumerate(text.split("\n")):
        begin, start = start, start + len(line) + 1
        bare = _COMMENT.sub("", _QUOTED.sub("''", line)).rstrip()
        indent = len(line) - len(line.lstrip(" "))
        if depth > 0 or (inside >= 0 and (indent > inside or not line.strip())):
            rows[-1] = rows[-1]._replace(last=number)
            if depth > 0:
                depth += _surplus(bare)
            continue
        inside = -1
        if not bare.strip() or bare.startswith(("---", "...")):
            continue
        if bare.lstrip(" ").startswith("\t"):
            return []
        found = _ROW.match(line)
        assert found is not None
        dashes = tuple(indent + at for at, sign in enumerate(found[2]) if sign == "-")
        value = _COMMENT.sub("", _QUOTED.sub("''", found[4])).strip()
        if bare.endswith("-") and bare.strip(" -") == "":
            dashes, value = (*dashes, indent + len(found[2])), ""
        key = (found[3] or "").strip("'\"")
        column = indent + len(found[2])
        rows.append(Row(number, number, begin, indent, dashes, column, key, value))
        depth = _surplus(bare)
        if _BLOCK_TEXT.fullmatch(value):
            inside = column if key else indent
        if depth < 0:
            return []
    return [] if depth else _joined(rows)


def _surplus(bare: str) -> int:
    return sum(bare.count(text) for text in "[{") - sum(bare.count(text) for text in "]}")


def _joined(rows: list[Row]) -> list[Row]:
    """The rows without the further lines of texts, which have neither a key nor a dash."""
    found: list[Row] = []
    for row in rows:
        if found and not row.key and not row.dashes:
            found[-1] = found[-1]._replace(last=row.last)
        else:
            found.append(row)
    return found


def outline(rows: Sequence[Row]) -> Part | None:
    """The outline of rows; None if a column is that of no open part."""
    root = Part("", -1, "", [("", None)])
    opened = [root]
    for row in rows:
        for at, column in enumerate(row.dashes):
            part = _opened(opened, column, "list", fresh=at > 0)
            if part is None:
                return None
            part.entries.append(("", None))
        if row.key:
            part = _opened(opened, row.key_column, "map", fresh=bool(row.dashes))
            if part is None:
                return None
            part.entries.append((row.key, Part("text", 0, row.value) if row.value else None))
        elif row.value:
            _fill(opened[-1], Part("text", row.key_column, row.value))
    return root.entries[0][1]


def _fill(part: Part, value: Part) -> None:
    part.entries[-1] = (part.entries[-1][0], value)


def _opened(opened: list[Part], column: int, kind: str, *, fresh: bool) -> Part | None:
    """The open part to which a dash or a key at a column belongs, begun if it is the first of its
    part; None if there is none."""
    while opened[-1].column > column and not fresh:
        opened.pop()
    top = opened[-1]
    if top.column == column and top.kind == "list" and kind == "map":
        opened.pop()
        top = opened[-1]
    if not fresh and top.column == column and top.kind == kind:
        return top
    inside = column > top.column or (column == top.column and top.kind == "map" and kind == "list")
    if not inside or top.entries[-1][1] is not None:
        return None
    part = Part(kind, column)
    _fill(top, part)
    opened.append(part)
    return part


_NAMES = ("transitions", "remapping", "final_outcome_map")
_ADDED = ("timeout", "exhausted", "preempted", "error", "succeeded", "aborted")
"""Outcomes that a state can have without a list of them, or beyond it."""

_WORDS = re.compile(r"\[\s*(\w+(?:\s*,\s*\w+)*)\s*\]")


def form_of(root: Part | None) -> float:
    """How far an outline is from the form of a script, a sub-script or an interface; 0 if it has
    it."""
    if root is None:
        return 10.0
    if root.kind == "list":
        return _of_states(root, "call")
    keys = {LONG.get(key, key) for key, _ in root.entries}
    is_script = "states" in keys or not keys & {"variables", "code"}
    return _of_script(root) if is_script else _of_interface(root)


def _of_script(root: Part) -> float:
    own = [LONG.get(key, key) for key, _ in root.entries]
    known = [key in VARIABLES and "base" in VARIABLES[key].owners for key in own]
    missing = sum(name not in own for name in REQUIRED["base"])
    return known.count(False) + missing + _twice(own) + _of_fields(root, "base")


def _of_interface(root: Part) -> float:
    own = [key for key, _ in root.entries]
    cost = float(sum(key not in INTERFACE_FIELDS for key in own)) + _twice(own)
    for key, value in root.entries:
        nested = value is not None and value.kind == "map"
        if key in ("variables", "outcomes", "input_keys", "output_keys") and nested:
            assert value is not None
            cost += sum(text in INTERFACE_FIELDS for text, _ in value.entries)
            cost += sum(below is None for _, below in value.entries)
    return cost


def _twice(keys: Sequence[str]) -> float:
    return float(len(keys) - len(set(keys)))


def _of_fields(part: Part, owner: str) -> float:
    """The cost of the values of the fields of a state or a script."""
    cost = 0.0
    for key, value in part.entries:
        name = LONG.get(key, key)
        if value is None:
            cost += name in VARIABLES
        elif name == "states":
            cost += _of_states(value, owner) if value.kind == "list" else 1.5
        elif name in _NAMES and value.kind != "text":
            cost += _of_names(value)
        elif name == "outcome_map" and value.kind != "text":
            cost += sum(_of_rules(item) for item in _rules(value))
        elif name in VARIABLES and value.kind != "text" and VARIABLES[name].shape == "name":
            cost += 1
    return cost


def _rules(part: Part) -> Iterator[Part]:
    """The mappings of an outcome map: the only one, or those of a list."""
    if part.kind != "list":
        yield part
        return
    yield from (item for _, item in part.entries if item is not None and item.kind != "text")


def _of_rules(part: Part) -> float:
    """The cost of a mapping of names to mappings of names to names."""
    return sum(1.0 if inner is None or (inner.kind == "text" and inner.value[0] not in "{*[")
               else 0.0 if inner.kind == "text" else _of_names(inner)
               for _, inner in part.entries)  # fmt: skip


def _of_names(part: Part) -> float:
    """The cost of a mapping of names to names."""
    fields = sum(len(key) > 2 and key in VARIABLES and key != "timeout" for key, _ in part.entries)
    nested = sum(value is None or value.kind != "text" for _, value in part.entries)
    return fields + nested + _twice([key for key, _ in part.entries]) + (part.kind != "map")


def _of_states(part: Part, owner: str) -> float:
    cost = 0.0
    for _, item in part.entries:
        if item is None or item.kind != "map":
            cost += item is not None and item.kind == "list"
            cost += 0.5 * (item is None)
            continue
        (name, first), rest = item.entries[0], item.entries[1:]
        cost += name in VARIABLES
        fields = item if first is None else first
        if first is None and rest:
            fields = Part("map", item.column, "", rest)
        elif rest:
            cost += len(rest)
        if fields.kind == "map":
            cost += _of_state(fields, owner)
    if owner == "Iterator":
        cost += 1.5 * max(0, len(part.entries) - 1)
    names = [item.entries[0][0] for _, item in part.entries if item is not None and item.entries]
    return cost + _twice(names)


def _of_state(part: Part, around: str) -> float:
    own = [LONG.get(key, key) for key, _ in part.entries]
    values = dict(zip(own, (value for _, value in part.entries), strict=True))
    given = values.get("template")
    template = given.value if given is not None else ""
    kind = template if template in CONTAINERS else "StateMachine" if "states" in own else "state"
    cost = _twice(own) + _of_fields(part, kind)
    cost += not {"template", "script"} & values.keys()
    cost += 0.5 * sum(
        key in VARIABLES and bool(VARIABLES[key].owners) and kind not in VARIABLES[key].owners
        for key in own
        if key != "default_outcome" or kind != "state"
    )
    cost += sum(key.isupper() and value is not None and value.kind == "map"
                for key, value in part.entries)  # fmt: skip
    if kind != "state":
        cost += ("states" not in own) + sum(key not in VARIABLES for key in own)
    steps = values.get("transitions")
    outcomes = values.get("outcomes")
    listed = _WORDS.fullmatch(outcomes.value) if outcomes is not None else None
    known = {*_ADDED, *(re.findall(r"\w+", listed[1]) if listed is not None else ())}
    cost += 0.5 * sum(key in known and key not in VARIABLES for key in own)
    if around in ("Concurrence", "Iterator"):
        return cost + 0.5 * (steps is not None)
    if steps is not None and steps.kind == "map" and listed is not None:
        cost += 0.3 * sum(key not in known for key, _ in steps.entries)
    return cost + 0.3 * (steps is None and "script" not in own and around != "call")


_TARGET = re.compile(r":\s*([A-Za-z_][\w.-]*)")


def dangling_count(root: Part | None) -> int:
    """The number of transitions that lead to a state in another list of states."""
    lists = [] if root is None else list(_lists_of(root))
    every = {name for states in lists for name, _ in _named(states)}
    found = 0
    for states in lists:
        others = every - {name for name, _ in _named(states)}
        for _, fields in _named(states):
            steps = dict(fields.entries if fields is not None else ()).get("transitions")
            if steps is not None:
                values = [value.value for _, value in steps.entries if value is not None]
                targets = values if steps.kind == "map" else _TARGET.findall(steps.value)
                found += sum(target in others for target in targets)
            elif fields is not None and fields.kind == "text":
                found += sum(target in others for target in _TARGET.findall(fields.value))
    return found


def _lists_of(part: Part) -> Iterator[Part]:
    """All lists of states in a part."""
    todo = [("states" if part.kind == "list" else "", part)]
    while todo:
        key, part = todo.pop()
        if key in ("states", "s") and part.kind == "list":
            yield part
        todo += [(name, value) for name, value in part.entries if value is not None]


def _named(states: Part) -> list[tuple[str, Part | None]]:
    """The states of a list by name, each with its fields."""
    return [item.entries[0] for _, item in states.entries if item is not None and item.entries]


def steps_in(rows: Sequence[Row]) -> Counter[tuple[str, int]]:
    """How often a key or an item is indented by a number of columns more than the row above that
    holds it."""
    found: Counter[tuple[str, int]] = Counter()
    found.update(_steps(rows))
    return found


def _steps(rows: Sequence[Row]) -> Iterator[tuple[str, int]]:
    for above, row in pairwise(rows):
        if not above.value and above.key:
            base = above.column if above.dashes and not row.dashes else above.key_column
            yield f"{bool(above.dashes)}{bool(row.dashes)}", row.column - base


def unusual_steps(rows: Sequence[Row], usual: Counter[tuple[str, int]]) -> float:
    """The number of steps that are not the most frequent ones of their kind."""
    most: dict[str, int] = {}
    for (kind, step), _ in reversed(usual.most_common()):
        most[kind] = step
    return float(sum(step != most.get(kind, step) for kind, step in _steps(rows)))
