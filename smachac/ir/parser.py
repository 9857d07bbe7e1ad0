"""Parser of the textual IR (.smir), the inverse of printer.py. The notation is grammars/ir.lark."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any, get_args

from smachac.diagnostics.source import Source, Span
from smachac.grammars import parser_of
from smachac.ir.nodes import (
    Condition,
    Data,
    Expression,
    Key,
    Machine,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    StateMachine,
    Struct,
    Transition,
    Value,
    Variable,
)
from smachac.ir.types import ANY, Type, parse_type

if TYPE_CHECKING:
    from smachac.grammars.standalone.lalr import UnexpectedInput

KINDS: Mapping[str, type[Node]] = {kind.keyword: kind for kind in get_args(Node)}
"""The classes of nodes by keyword."""

FIELDS: Mapping[type[object], Mapping[str, bool]] = {
    owner: {field.name: isinstance(field.default, tuple) for field in fields(owner)}
    for owner in (Machine, *KINDS.values())
}
"""The fields that statements can set, by the class of the node, and whether a field has several
values."""

LONGEST_DECIMAL = 4300
"""Limit on the length of a decimal integer, the same as in Python."""


class IrSyntaxError(Exception):
    """A text is no machine: the message and the position, line and column from 1."""

    def __init__(self, message: str, span: Span):
        super().__init__(f"{span}: {message}")
        self.message = message
        self.span = span
        self.line, self.column = span.source.position(span.start)


def parse_machine(text: str, name: str = "<ir>") -> Machine:
    """The machine of a text; its spans refer to the text, under the name `name`.

    The span of a node is that of its name. Raises IrSyntaxError, and no other exception.
    """
    from smachac.grammars.standalone.lalr import UnexpectedInput

    source = Source(name, text)
    try:
        return _MachineBuilder(source).machine(parser_of("ir").parse(text))
    except UnexpectedInput as error:
        raise _unexpected(error, source) from None
    except RecursionError:
        raise IrSyntaxError("a value is nested too deeply", Span(source, 0, 0)) from None


MOST_SHOWN = 6
"""Limit on the expected tokens in an error message."""


def _unexpected(error: UnexpectedInput, source: Source) -> IrSyntaxError:
    """An error of the lark parser as IrSyntaxError: the text found and the expected tokens."""
    start = error.pos_in_stream
    token = getattr(error, "token", None)
    if start is None or (token is not None and token.type == "$END"):
        start = len(source.text)
    rest = source.text[start : start + 100].split()
    met = f"`{rest[0]}`" if rest else "the end of the text"
    fitting = sorted(map(_shown, _fitting(error)))
    wanted = f"; {', '.join(fitting)} would fit" if 0 < len(fitting) <= MOST_SHOWN else ""
    end = start + len(rest[0]) if rest else start
    return IrSyntaxError(f"unexpected {met}{wanted}", Span(source, start, end))


def _fitting(error: UnexpectedInput) -> set[str]:
    """The terminals that are expected at an error."""
    return set(getattr(error, "accepts", None) or getattr(error, "allowed", None) or ())


def _shown(terminal: str) -> str:
    """A terminal of the grammar as it is written."""
    if terminal == "$END":
        return "the end"
    pattern = parser_of("ir").get_terminal(terminal).pattern
    return f"`{pattern.value}`" if pattern.type == "str" else f"a {terminal.lower()}"


class _MachineBuilder:
    """Builds nodes from the parse tree of a source. Tokens and parse trees have the type `Any`."""

    def __init__(self, source: Source):
        self.source = source

    def machine(self, tree: Any) -> Machine:
        *statements, root = tree.children
        built: dict[int, Node] = {}
        # Parents come before their children here; the reverse order builds children first.
        order = [root]
        for item in order:
            order.extend(child for child in item.children if _is_node(child))
        for item in reversed(order):
            built[id(item)] = self.node(item, built)
        outermost = built[id(root)]
        if not isinstance(outermost, StateMachine):
            raise IrSyntaxError("the outermost container is a `machine`", self.span(root))
        return Machine(root=outermost, **self.fields(statements, Machine, "program"))

    def node(self, tree: Any, built: Mapping[int, Node]) -> Node:
        kind, name, type_, *rest = tree.children
        fields = self.fields([item for item in rest if not _is_node(item)], KINDS[kind], kind)
        children = tuple(built[id(item)] for item in rest if _is_node(item))
        if children and kind == "state":
            raise IrSyntaxError("a state has no states inside", self.span(tree))
        if children:
            fields["children"] = children
        return KINDS[kind](name=_text(name), type=_text(type_), span=self.span(name), **fields)

    def fields(self, statements: list[Any], owner: type[object], kind: str) -> dict[str, Any]:
        """The fields that statements set. Repeatable statements are concatenated."""
        several: dict[str, list[Any]] = {}
        single: dict[str, Any] = {}
        known = FIELDS[owner]
        for tree in statements:
            field = str(tree.data)
            if field not in known:
                raise IrSyntaxError(f"a {kind} has no such statement", self.span(tree))
            read = READERS.get(field)
            if known[field]:
                added = read(self, tree) if read else self.names(tree)
                several.setdefault(field, []).extend(added)
            elif field in single:
                raise IrSyntaxError("this is given twice", self.span(tree))
            else:
                single[field] = read(self, tree) if read else self.name_or_flag(tree)
                place = PLACES.get(field)
                if place:
                    single[place] = self.span(tree.children[0])
        return {**single, **{field: tuple(found) for field, found in several.items()}}

    def span(self, item: Any) -> Span:
        """The span of a token or a tree."""
        place = getattr(item, "meta", item)
        return Span(self.source, place.start_pos, place.end_pos)

    def outcomes(self, tree: Any) -> Iterator[Outcome]:
        for child in tree.children:
            name, doc = child.children
            yield Outcome(name=_text(name), doc=_text(doc), span=self.span(name))

    def key(self, tree: Any) -> Iterator[Key]:
        name, type_, doc = tree.children
        yield Key(name=_text(name), type=self.type(type_), doc=_text(doc), span=self.span(name))

    def type(self, token: Any) -> Type:
        if token is None:
            return ANY
        found = parse_type(_text(token).rstrip())
        if found is None:
            raise IrSyntaxError(f"`{_text(token).rstrip()}` is no type", self.span(token))
        return found

    def names(self, tree: Any) -> Iterator[str]:
        return map(_text, tree.children)

    def transition(self, tree: Any) -> Iterator[Transition]:
        outcome, target, origin = tree.children
        yield Transition(
            outcome=_text(outcome),
            target=_text(target),
            origin="written" if origin is None else str(origin),  # type: ignore[arg-type]
            span=self.span(outcome),
            target_span=self.span(target),
        )

    def remap(self, tree: Any) -> Iterator[Remap]:
        key, to = tree.children
        yield Remap(key=_text(key), to=_text(to), span=self.span(key), to_span=self.span(to))

    def variable(self, tree: Any) -> Iterator[Variable]:
        name, type_, data = tree.children
        yield Variable(
            name=_text(name), type=self.type(type_), value=self.value(data), span=self.span(name)
        )

    def preset(self, tree: Any) -> Iterator[Preset]:
        key, type_, data = tree.children
        yield Preset(
            key=_text(key), type=self.type(type_), value=self.value(data), span=self.span(key)
        )

    def rule(self, tree: Any) -> Iterator[OutcomeRule]:
        outcome, *conditions = tree.children
        when = tuple(map(self.condition, filter(None, conditions)))
        yield OutcomeRule(outcome=_text(outcome), when=when, span=self.span(outcome))

    def condition(self, tree: Any) -> Condition:
        child, outcome = tree.children
        return Condition(child=_text(child), outcome=_text(outcome), span=self.span(child))

    def written(self, tree: Any) -> Iterator[tuple[str, tuple[str, ...]]]:
        outcome, *keys = map(_text, tree.children)
        yield outcome, tuple(keys)

    def final(self, tree: Any) -> Iterator[tuple[str, str]]:
        first, last = tree.children
        yield _text(first), _text(last)

    def name_or_flag(self, tree: Any) -> str | bool:
        return _text(tree.children[0]) if tree.children else True

    def items(self, tree: Any) -> Value:
        return self.value(tree.children[0])

    def value(self, item: Any) -> Value:
        return Value(data=self.data(item), span=self.span(item))

    def data(self, item: Any) -> Data:
        match getattr(item, "data", None) or item.type:
            case "CONSTANT":
                return CONSTANTS[item]
            case "FLOAT":
                return float(item)
            case "INTEGER":
                return self.integer(item)
            case "STRING":
                return _text(item)
            case "EXPRESSION":
                return Expression(text=str(item[1:-1]), span=self.span(item))
            case "code":
                return Expression(text=_text(item.children[0]), span=self.span(item))
            case "list":
                return tuple([self.data(child) for child in item.children])
            case "struct":
                pairs = (child.children for child in item.children)
                return Struct(entries=tuple((_text(name), self.data(data)) for name, data in pairs))
        raise AssertionError(f"the grammar knows a kind of data that the reader does not: {item!r}")

    def integer(self, token: Any) -> int:
        if "x" in token:
            return int(token, 16)
        if len(token) > LONGEST_DECIMAL:
            raise IrSyntaxError("a decimal number has too many digits", self.span(token))
        return int(token)


def _is_node(tree: Any) -> bool:
    return getattr(tree, "data", None) == "node"


def _text(token: Any) -> str:
    """The text of a name, a quoted string or a missing doc."""
    if token is None:
        return ""
    return str(json.loads(token)) if token.type == "STRING" else str(token)


CONSTANTS: Mapping[str, bool | None] = {"true": True, "false": False, "null": None}

READERS: Mapping[str, Callable[[_MachineBuilder, Any], Any]] = {
    "outcomes": _MachineBuilder.outcomes,
    "inputs": _MachineBuilder.key,
    "outputs": _MachineBuilder.key,
    "transitions": _MachineBuilder.transition,
    "remaps": _MachineBuilder.remap,
    "variables": _MachineBuilder.variable,
    "writes": _MachineBuilder.written,
    "userdata": _MachineBuilder.preset,
    "rules": _MachineBuilder.rule,
    "items": _MachineBuilder.items,
    "final_map": _MachineBuilder.final,
}
"""What a statement holds for a field: its value, or the values that it adds to those of the field.
Any other field is a name, a flag, or a list of names."""

PLACES: Mapping[str, str] = {"initial": "initial_span", "default_outcome": "default_span"}
"""Fields whose span is in another field."""
