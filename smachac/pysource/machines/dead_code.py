"""Dead code of one instance: the parts of its methods that do not run with the values of its
attributes, as `if self.target is None:` where the constructor got a target."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import ClassFacts
from smachac.pysource.machines.values import (
    Class,
    Const,
    Function,
    Instance,
    Unknown,
    Value,
    alternatives,
    truth,
)
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.records import replace


class Choice(NamedTuple):
    """A condition of a method whose object is `own`, with the places of facts in the code that runs
    only if it is true, and only if it is false."""

    test: ast.expr
    own: str
    if_true: frozenset[Span]
    if_false: frozenset[Span]


def choices(facts: ClassFacts, classes: Sequence[Value]) -> tuple[Choice, ...]:
    """The conditions on which facts about a class depend. `classes` are the class and its bases.
    Conditions over attributes that a method changes later are left out."""
    methods = [
        value
        for cls in classes
        if isinstance(cls, Class)
        for value in cls.slots.values()
        if isinstance(value, Function) and isinstance(value.node, ast.FunctionDef)
    ]
    changed = {name for method in methods if method.name != "__init__"
               if isinstance(method.node, ast.FunctionDef)
               for name in assigned(method.node)}  # fmt: skip
    words = (*facts.reads, *facts.writes, *facts.returns)
    found = [choice for method in methods for choice in _choices_of(method, words)]
    return tuple(
        choice
        for choice in found
        if (choice.if_true or choice.if_false) and changed.isdisjoint(_attributes(choice.test))
    )


def live_facts(facts: ClassFacts, found: Iterable[Choice], instance: Instance) -> ClassFacts:
    """The facts about a class without those in dead code of an instance."""
    dead: set[Span] = set()
    for choice in found:
        result = _condition(choice.test, choice.own, instance.slots)
        if result is not None:
            dead |= choice.if_false if result else choice.if_true
    if not dead:
        return facts
    return replace(
        facts,
        reads=tuple(word for word in facts.reads if word.span not in dead),
        writes=tuple(word for word in facts.writes if word.span not in dead),
        endings=tuple(ending for ending in facts.endings if ending.outcome.span not in dead),
    )


def unknown_places(found: Iterable[Choice], instance: Instance) -> Iterator[Span]:
    """The places of facts that conditions over attributes select whose values are not known."""
    for choice in found:
        is_unknown = _condition(choice.test, choice.own, instance.slots) is None
        if is_unknown and any(_attributes(choice.test)):
            yield from choice.if_true | choice.if_false


def _attributes(node: ast.AST) -> Iterator[str]:
    return (part.attr for part in walk_code(node) if isinstance(part, ast.Attribute))


def assigned(node: ast.AST) -> Iterator[str]:
    """The attributes that code assigns; of a method, not those of its parameters, as userdata."""
    others: set[str] = set()
    if isinstance(node, ast.FunctionDef):
        others = {argument.arg for argument in node.args.args[1:]}
    for part in walk_code(node):
        if isinstance(part, ast.Attribute) and not isinstance(part.ctx, ast.Load):
            owner = part.value.id if isinstance(part.value, ast.Name) else ""
            if owner not in others:
                yield part.attr


def _choices_of(method: Function, words: Sequence[Word]) -> Iterator[Choice]:
    text, node = method.frame.module.text, method.node
    if text is None or not isinstance(node, ast.FunctionDef) or not node.args.args:
        return
    own = node.args.args[0].arg
    place = text.span(node)
    inside = [word.span for word in words if contains(place, word.span)]

    def within(parts: Sequence[ast.stmt | ast.expr]) -> frozenset[Span]:
        places = [text.span(part) for part in parts]
        return frozenset(span for span in inside for place in places if contains(place, span))

    for part in walk_code(node) if inside else ():
        match part:
            case ast.If(test=test, body=body, orelse=orelse):
                yield Choice(test, own, within(body), within(orelse))
            case ast.IfExp(test=test, body=yes, orelse=no):
                yield Choice(test, own, within([yes]), within([no]))
            case ast.BoolOp(op=op, values=values):
                for at, value in enumerate(values[:-1]):
                    rest, none = within(values[at + 1 :]), frozenset[Span]()
                    is_or = isinstance(op, ast.Or)
                    yield Choice(value, own, none if is_or else rest, rest if is_or else none)


def contains(place: Span, span: Span) -> bool:
    """Whether a place in the code contains another one."""
    return place.source is span.source and place.start <= span.start < place.end


def _condition(test: ast.expr, own: str, known: Mapping[str, Value]) -> bool | None:
    """Whether a condition over attributes holds; None if that is not known."""
    match test:
        case ast.Constant(value=value):
            return bool(value)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            result = _condition(operand, own, known)
            return None if result is None else not result
        case ast.Attribute(value=ast.Name(id=name), attr=attribute) if name == own:
            return truth(known[attribute]) if attribute in known else None
        case ast.Compare(
            left=ast.Attribute(value=ast.Name(id=name), attr=attribute),
            ops=[op],
            comparators=[ast.Constant(value=wanted)],
        ) if name == own:
            same = _equals(known.get(attribute), wanted)
            if same is None or not isinstance(op, ast.Is | ast.IsNot | ast.Eq | ast.NotEq):
                return None
            return same is isinstance(op, ast.Is | ast.Eq)
    return None


def _equals(value: Value | None, wanted: object) -> bool | None:
    """Whether a value is a constant; None if that is not known."""
    match value:
        case Const(value=found):
            return type(found) is type(wanted) and found == wanted
        case None | Unknown():
            return None
    return None if len(alternatives(value)) > 1 or wanted is not None else False
