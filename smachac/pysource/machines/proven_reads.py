"""Reads of userdata that need not happen: those under a condition over userdata, which selects the
keys that a state uses, and those in a `try` that catches the error of a missing key."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from smachac.diagnostics.source import Span
from smachac.pysource.machines.dead_code import assigned
from smachac.pysource.machines.values import Class, Function, Value
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code

_ERRORS = frozenset(["KeyError", "LookupError", "AttributeError", "Exception", "BaseException"])
"""The errors that a handler of a missing key can name."""

_EXITS = (ast.Return, ast.Raise, ast.Continue, ast.Break)


def doubtful_places(classes: Sequence[Value]) -> tuple[Span, ...]:
    """The places in the methods of a class at which a read of userdata is not proven. `classes` are
    the class and its bases. Conditions over attributes that methods change can differ from one
    visit of the state to the next."""
    methods = [
        (method, method.node)
        for cls in classes
        if isinstance(cls, Class)
        for method in cls.slots.values()
        if isinstance(method, Function) and isinstance(method.node, ast.FunctionDef)
    ]
    changed = {
        f"self.{name}"
        for method, node in methods
        if method.name != "__init__"
        for name in assigned(node)
    }
    return tuple(place for method, node in methods for place in _of_function(method, node, changed))


def doubtful_in(function: Function) -> tuple[Span, ...]:
    """The places in a callback at which a read of userdata is not proven."""
    node = function.node
    return tuple(_of_function(function, node, set())) if isinstance(node, ast.FunctionDef) else ()


def _of_function(function: Function, node: ast.FunctionDef, changed: set[str]) -> Iterator[Span]:
    text = function.frame.module.text
    if text is None:
        return iter(())
    taken = node.args
    names = {argument.arg for argument in (*taken.posonlyargs, *taken.args, *taken.kwonlyargs)}
    walk = _Walk(text, (names - {"self"}) | changed)
    walk.block(node.body, sure=True)
    return iter(walk.places)


class _Walk:
    """The statements of a function in order. `derived` are the names of values that come from
    userdata, `tried` the keys that a `try` can have set, `places` those that need not run."""

    def __init__(self, text: PythonText, derived: set[str]) -> None:
        self.text = text
        self.derived = derived
        self.tried: set[str] = set()
        self.places: list[Span] = []

    def block(self, body: Sequence[ast.stmt], *, sure: bool) -> bool:
        """Visits statements; whether the next ones run whatever userdata holds."""
        for statement in body:
            if not sure:
                self.places.append(self.text.span(statement))
            sure = self.statement(statement) and sure
        return sure

    def statement(self, node: ast.stmt) -> bool:
        match node:
            case ast.If(test=test, body=body, orelse=orelse):
                self.expression(test)
                free = not self._is_derived(test)
                ends = [self.block(part, sure=free) for part in (body, orelse)]
                return all(ends) if free else not (_leaves(body) or _leaves(orelse))
            case ast.While(test=test, body=body, orelse=orelse):
                self.expression(test)
                self.block(body, sure=not self._is_derived(test))
                return self.block(orelse, sure=True)
            case ast.For(target=target, iter=items, body=body, orelse=orelse):
                self._assign([target], items)
                self.block(body, sure=True)
                return self.block(orelse, sure=True)
            case ast.With(body=body):
                return self.block(body, sure=True)
            case ast.Try(body=body, handlers=handlers, orelse=orelse, finalbody=last):
                caught = any(map(_catches, handlers))
                self.tried.update(name for part in body for name in assigned(part))
                runs = self.block(body, sure=not caught)
                for handler in handlers:
                    self.block(handler.body, sure=False)
                runs = self.block(orelse, sure=runs and not caught) and not caught
                return self.block(last, sure=True) and (
                    runs or not any(_leaves(handler.body) for handler in handlers)
                )
            case ast.Assign(targets=targets, value=value):
                self._assign(targets, value)
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                self._assign([target], value)
            case _:
                self.expression(node)
        return True

    def _assign(self, targets: Sequence[ast.expr], value: ast.expr) -> None:
        self.expression(value)
        if self._is_derived(value):
            for target in targets:
                self.derived.update(_names(target))

    def expression(self, node: ast.AST) -> None:
        """Notes the operands of an expression that only some values of userdata evaluate."""
        for part in walk_code(node):
            match part:
                case ast.Attribute(attr=name) if name in self.tried:
                    self.places.append(self.text.span(part))
                case ast.IfExp(test=test, body=yes, orelse=no) if self._is_derived(test):
                    self.places += [self.text.span(yes), self.text.span(no)]
                case ast.BoolOp(values=values):
                    for at, value in enumerate(values[:-1]):
                        if self._is_derived(value):
                            self.places += [self.text.span(rest) for rest in values[at + 1 :]]
                            break

    def _is_derived(self, node: ast.AST) -> bool:
        return not self.derived.isdisjoint(_names(node))


def _names(node: ast.AST) -> Iterator[str]:
    """The names in an expression; of an attribute of `self` also `self.name`."""
    for part in walk_code(node):
        match part:
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                yield f"self.{name}"
            case ast.Name(id=name) if name != "self":
                yield name


def _leaves(body: Sequence[ast.stmt]) -> bool:
    return any(isinstance(part, _EXITS) for statement in body for part in walk_code(statement))


def _catches(handler: ast.ExceptHandler) -> bool:
    """Whether a handler catches the error of a key that is missing."""
    if handler.type is None:
        return True
    kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return any(getattr(kind, "attr", getattr(kind, "id", "")) in _ERRORS for kind in kinds)
