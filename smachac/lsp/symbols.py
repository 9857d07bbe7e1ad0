"""The structure of a text: its states as symbols, the ranges to fold, the tokens of its code."""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.source import Source, Span
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree
from smachac.ir.expressions import looks_like_expression, parse_expression
from smachac.lsp.place import Body, top_bodies
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Symbol:
    """A state or the script: its name, its type, its range and that of its name."""

    name: str
    detail: str
    is_container: bool
    start: int
    end: int
    name_start: int
    name_end: int
    children: tuple[Symbol, ...] = ()


def symbols(tree: Tree | None) -> list[Symbol]:
    """The states of a text."""
    return [_symbol(body) for body in top_bodies(tree)]


def _symbol(body: Body) -> Symbol:
    name = body.name
    if name is None:
        entry = body.fields.get("name")
        word = entry.value if entry is not None and isinstance(entry.value, Scalar) else None
        start, end = (word.start, word.end) if word is not None else (body.start, body.start)
        shown = body.text("name") or "sm"
    else:
        start, end, shown = name.start, name.end, str(name.value)
    return Symbol(
        name=shown or "?",
        detail=body.text("script") or body.template,
        is_container=bool(body.states),
        start=min(body.start, start),
        end=max(body.end, end),
        name_start=start,
        name_end=end,
        children=tuple(map(_symbol, body.states)),
    )


def all_symbols(found: list[Symbol], above: str = "") -> Iterator[tuple[Symbol, str]]:
    """Symbols and those inside them, with the names of the containers around each."""
    for symbol in found:
        yield symbol, above
        yield from all_symbols(
            list(symbol.children), f"{above}/{symbol.name}" if above else symbol.name
        )


def folds(tree: Tree | None) -> list[tuple[int, int]]:
    """The ranges of collections that take several lines, as offsets."""
    found: dict[tuple[int, int], None] = {}
    todo = [tree] if tree is not None else []
    while todo:
        here = todo.pop()
        match here:
            case Map(entries=entries):
                for entry in entries:
                    if not isinstance(entry.value, Scalar):
                        found[entry.key.start, _last(entry.value)] = None
                        todo.append(entry.value)
            case Seq(items=items):
                todo += [item for item in items if not isinstance(item, Scalar)]
    return sorted(found)


def _last(tree: Tree) -> int:
    while not isinstance(tree, Scalar):
        if isinstance(tree, Map) and tree.entries:
            tree = tree.entries[-1].value
        elif isinstance(tree, Seq) and tree.items:
            tree = tree.items[-1]
        else:
            return tree.span.end
    return tree.end


TOKEN_KINDS = ("keyword", "variable", "property", "number", "string", "operator", "function")

_TOKEN = re.compile(
    r"(?P<string>'[^'\n]*'|\"[^\"\n]*\")|(?P<number>\d[\w.]*)|(?P<word>[^\W\d]\w*)"
    r"|(?P<operator>[-+*/%<>=!]+)"
)
_KEYWORDS = frozenset(["lambda", "and", "or", "not", "in", "if", "else", "True", "False", "None"])


def tokens(tree: Tree | None) -> list[tuple[int, int, int]]:
    """The tokens of the code in a text: offset, length, and number of the kind in TOKEN_KINDS."""
    found: dict[int, tuple[int, int, int]] = {}
    for word in _words(tree):
        text = str(word.value)
        likely = text.startswith("lambda") or looks_like_expression(text)
        if not likely or parse_expression(text) is None:
            continue
        at = word.source.text.find(text, word.start, word.end)
        if at >= 0 and "\n" not in text:
            found |= {at + start: (at + start, size, kind) for start, size, kind in _lexed(text)}
    return [found[at] for at in sorted(found)]


def _lexed(text: str) -> Iterator[tuple[int, int, int]]:
    for token in _TOKEN.finditer(text):
        kind, word = token.lastgroup or "", token.group()
        if kind == "word":
            before, after = text[: token.start()].rstrip(), text[token.end() :].lstrip()
            kind = "keyword" if word in _KEYWORDS else "variable"
            if before.endswith("."):
                kind = "property"
            elif after.startswith("("):
                kind = "function"
        yield token.start(), len(word), TOKEN_KINDS.index(kind)


def _words(tree: Tree | None) -> Iterator[Scalar]:
    todo = [tree] if tree is not None else []
    while todo:
        here = todo.pop()
        match here:
            case Scalar():
                if isinstance(here.value, str):
                    yield here
            case Seq(items=items):
                todo += items
            case Map(entries=entries):
                todo += [entry.value for entry in entries]


def first_line(source: Source) -> Span:
    """The first line that is no comment, where lenses stand."""
    for number, start in enumerate(source.line_starts, 1):
        line = source.line(number)
        if line.strip() and not line.lstrip().startswith("#"):
            return Span(source, start, start + len(line))
    return Span(source, 0, 0)


def is_script(tree: Tree | None) -> bool:
    """Whether a text is a script: not a sub-script, and no interface."""
    return isinstance(tree, Map) and any(body.states for body in top_bodies(tree))
