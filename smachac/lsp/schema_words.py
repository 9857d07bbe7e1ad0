"""Completion and hover in the files that are no scripts, from their JSON Schemas."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from smachac.diagnostics.source import Source
from smachac.driver import CODES
from smachac.frontend.text.file_kinds import FileKind
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree
from smachac.lsp.repair import with_mark
from smachac.lsp.session import View
from smachac.lsp.word import Completion
from smachac.records import dataclass, replace
from smachac.report.json_schema import Schema, generated_schemas

ITEM = "-"
"""The step to an item of a list."""


@dataclass(frozen=True, kw_only=True)
class WordPlace:
    """A word of a file: its range, the names from the top of the file to it, without its own if it
    is a key, and the other keys of its mapping."""

    start: int
    end: int
    steps: tuple[str, ...]
    is_key: bool
    siblings: frozenset[str] = frozenset()


def schema_of(kind: FileKind) -> Schema:
    return generated_schemas(CODES)[kind]()


def schema_words(text: str, start: int, end: int, view: View) -> list[Completion]:
    """The words that fit in place of the text from `start` to `end`."""
    if view.kind == "project":
        place = project_place(view.source, start)
        quoted = text[start - 1 : start] in ("'", '"')
        return [*_words(view.kind, place, " = ", "{}" if quoted else '"{}"')] if place else []
    marked = with_mark(text, start, end, view.source.name)
    if marked is None:
        return []
    place = yaml_place(marked[1], marked[2])
    return [*_words(view.kind, place, ": ", "{}")] if place is not None else []


def _words(kind: FileKind, place: WordPlace, then: str, quoted: str) -> Iterator[Completion]:
    schemas = _at(schema_of(kind), place.steps)
    values: dict[str, Completion] = {}
    for schema in schemas if not place.is_key else ():
        known = [*schema.get("enum", ()), *schema.get("examples", ())]
        for value in known:
            word = str(value)
            values.setdefault(word, Completion(word=word, kind="value", text=quoted.format(word)))
        if "boolean" in schema.get("type", ()):
            values |= {word: Completion(word=word, kind="value") for word in ("true", "false")}
    yield from values.values()
    for name, part in _properties(schemas):
        if name not in place.siblings:
            doc = str(part.get("description", ""))
            yield Completion(word=name, kind="field", doc=doc, text=f"{name}{then}")


def schema_hover(view: View, offset: int) -> tuple[str, WordPlace] | None:
    """What a word of a file means, as Markdown, with its place; None if that is not known."""
    text = view.source.text
    if view.kind == "project":
        place = project_place(view.source, offset)
    else:
        place = yaml_place(view.library.parse(view.source, []), offset)
    if place is None:
        return None
    word = text[place.start : place.end]
    steps = (*place.steps, word) if place.is_key else place.steps
    schemas = _at(schema_of(view.kind), steps[:-1])
    part = dict(_properties(schemas)).get(steps[-1]) if steps else None
    if part is None or "description" not in part:
        return None
    lines = [f"**{steps[-1]}**", str(part["description"])]
    for alternative in _alternatives(part):
        if "enum" in alternative:
            lines.append(f"One of {', '.join(f'`{word}`' for word in alternative['enum'])}.")
    if "default" in part and not isinstance(part["default"], bool):
        lines.append(f"Default: `{_shown(part['default'])}`.")
    return "\n\n".join(lines), place


def _shown(value: object) -> str:
    """A value as YAML in one line."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(_shown(item) for item in value)}]"
    return str(value)


def _alternatives(schema: Schema) -> Iterator[Schema]:
    """A schema, those of which one must hold, and those of both cases of a condition."""
    yield schema
    cases = (schema[key] for key in ("then", "else") if key in schema)
    for case_ in (*schema.get("anyOf", ()), *cases):
        yield from _alternatives(case_)


def _at(schema: Schema, steps: Iterable[str]) -> list[Schema]:
    """The schemas of the value behind some steps."""
    found = [*_alternatives(schema)]
    for step in steps:
        found = [part for entry in found for below in _below(entry, step)
                 for part in _alternatives(below)]  # fmt: skip
    return found


def _below(schema: Schema, step: str) -> list[Schema]:
    if step in schema.get("properties", {}):
        return [schema["properties"][step]]
    others = schema.get("items" if step == ITEM else "additionalProperties")
    if isinstance(others, list):
        return others
    return [others] if isinstance(others, dict) else []


def _properties(schemas: Iterable[Schema]) -> Iterator[tuple[str, Schema]]:
    for schema in schemas:
        yield from schema.get("properties", {}).items()


def yaml_place(tree: Tree | None, offset: int) -> WordPlace | None:
    """The place of the word at an offset of a YAML file."""
    steps: list[str] = []
    while tree is not None:
        match tree:
            case Scalar(start=start, end=end):
                inside = start <= offset <= end
                place = WordPlace(start=start, end=end, steps=tuple(steps), is_key=False)
                return place if inside else None
            case Seq(items=items):
                tree = next((item for item in items[::-1] if item.span.start <= offset), None)
                steps.append(ITEM)
            case Map(entries=entries):
                entry = next((entry for entry in entries[::-1] if entry.key.start <= offset), None)
                if entry is None:
                    return None
                key = entry.key
                if offset <= key.end:
                    names = frozenset(str(entry.key.value) for entry in entries) - {str(key.value)}
                    return WordPlace(start=key.start, end=key.end, steps=tuple(steps), is_key=True,
                                     siblings=names)  # fmt: skip
                steps.append(str(key.value))
                tree = entry.value
    return None


_PART = r"""["']?[\w-]+["']?"""
_HEADER = re.compile(r"^[ \t]*\[([^\[\]\n]*)\]", re.MULTILINE)
_KEY = re.compile(rf"^[ \t]*({_PART}(?:\.{_PART})*)[ \t]*=", re.MULTILINE)
_INLINE_KEY = re.compile(rf"[{{,][ \t]*({_PART}(?:\.{_PART})*)[ \t]*=")
_DOTTED = re.compile(rf"[ \t]*((?:{_PART}\.)*)[\"']?")
TOML_WORD = re.compile(r"[\w-]*")
SETTINGS_TABLE = ("tool", "smachac")
"""The table of a pyproject.toml with the settings that a smachac.toml has at its top."""


def project_place(source: Source, offset: int) -> WordPlace | None:
    """The place of the word at an offset of a project file; None outside of its settings."""
    place = toml_place(source.text, offset)
    if place is None or source.file_name != "pyproject.toml":
        return place
    if place.steps[:2] != SETTINGS_TABLE:
        return None
    return replace(place, steps=place.steps[2:])


def toml_place(text: str, offset: int) -> WordPlace | None:
    """The place of the word at an offset of a TOML file, whose values are in one line each."""
    line = text.rfind("\n", 0, offset) + 1
    before = text[line:offset]
    if before.lstrip().startswith(("[", "#")):
        return None
    start = offset
    while start > line and TOML_WORD.fullmatch(text[start - 1]):
        start -= 1
    found = TOML_WORD.match(text, offset)
    end = found.end() if found is not None else offset
    headers = [*_HEADER.finditer(text, 0, line)]
    table = _names(headers[-1][1]) if headers else ()
    key = _KEY.match(before)
    if key is None:
        top = headers[-1].end() if headers else 0
        below = _HEADER.search(text, line)
        others = _KEY.finditer(text, top, below.start() if below is not None else len(text))
        return _key_place(text, line, (start, end), table, others)
    steps = (*table, *_names(key[1]))
    first = line + key.end()
    while text[first:start].lstrip().startswith("{"):
        last = max(text.rfind("{", first, start), text.rfind(",", first, start)) + 1
        inner = _KEY.match(text[last:start])
        if inner is None:
            close = min(
                number
                for number in (text.find("}", start), text.find("\n", start), len(text))
                if number >= 0
            )
            others = _INLINE_KEY.finditer(text, first, close)
            return _key_place(text, last, (start, end), steps, others)
        steps = (*steps, *_names(inner[1]))
        first = last + inner.end()
    in_list = text[first:start].lstrip().startswith("[")
    return WordPlace(start=start, end=end, steps=(*steps, *([ITEM] if in_list else [])),
                     is_key=False)  # fmt: skip


def _key_place(
    text: str,
    first: int,
    word: tuple[int, int],
    table: tuple[str, ...],
    others: Iterable[re.Match[str]],
) -> WordPlace | None:
    """The place of a key of a table, with the keys beside it; a dotted key begins at `first`."""
    start, end = word
    dotted = _DOTTED.fullmatch(text[first:start])
    if dotted is None:
        return None
    prefix = _names(dotted[1].removesuffix("."))
    beside = (_names(other[1]) for other in others if not other.start(1) <= start <= other.end(1))
    names = frozenset(row[len(prefix)] for row in beside
                      if len(row) > len(prefix) and row[: len(prefix)] == prefix)  # fmt: skip
    return WordPlace(start=start, end=end, steps=(*table, *prefix), is_key=True, siblings=names)


def _names(dotted: str) -> tuple[str, ...]:
    """The names of a dotted key."""
    return tuple(part.strip(" \t\"'") for part in dotted.split(".")) if dotted.strip() else ()
