"""Dead code of one instance: the parts of its methods that do not run with the values of its
attributes, as `if self.target is None:` where the constructor got a target."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

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


def live_facts(facts: ClassFacts, instance: Instance, classes: Sequence[Value]) -> ClassFacts:
    """The facts about a class without those in dead code of an instance. `classes` are its class
    and the base classes."""
    methods = [
        value
        for cls in classes
        if isinstance(cls, Class)
        for value in cls.slots.values()
        if isinstance(value, Function) and isinstance(value.node, ast.FunctionDef)
    ]
    changed = {name for method in methods if method.name != "__init__"
               for name in _assigned(method.node)}  # fmt: skip
    known = {name: value for name, value in instance.slots.items() if name not in changed}
    dead = [span for method in methods for span in _dead_spans(method, known)]
    if not dead:
        return facts
    return replace(
        facts,
        reads=_outside(facts.reads, dead),
        writes=_outside(facts.writes, dead),
        endings=tuple(each for each in facts.endings if not _inside(each.outcome.span, dead)),
    )


def _assigned(function: ast.AST) -> Iterator[str]:
    """The attributes that code assigns, of any object."""
    for node in ast.walk(function):
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            yield node.attr


def _outside(words: Iterable[Word], dead: Sequence[Span]) -> tuple[Word, ...]:
    return tuple(word for word in words if not _inside(word.span, dead))


def _inside(span: Span, dead: Sequence[Span]) -> bool:
    return any(part.source is span.source and part.start <= span.start < part.end for part in dead)


def _dead_spans(method: Function, known: Mapping[str, Value]) -> Iterator[Span]:
    """The places of the parts of a method that do not run if attributes have known values."""
    text, node = method.frame.module.text, method.node
    if text is None or not isinstance(node, ast.FunctionDef) or not node.args.args:
        return
    own = node.args.args[0].arg
    for part in ast.walk(node):
        for dead in _dead_parts(part, own, known):
            yield text.span(dead)


def _dead_parts(
    node: ast.AST, own: str, known: Mapping[str, Value]
) -> Sequence[ast.stmt | ast.expr]:
    match node:
        case ast.If(test=test, body=body, orelse=orelse):
            result = _condition(test, own, known)
            return () if result is None else orelse if result else body
        case ast.IfExp(test=test, body=yes, orelse=no):
            result = _condition(test, own, known)
            return () if result is None else [no if result else yes]
        case ast.BoolOp(op=op, values=values):
            for at, value in enumerate(values):
                if _condition(value, own, known) is isinstance(op, ast.Or):
                    return values[at + 1 :]
    return ()


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
