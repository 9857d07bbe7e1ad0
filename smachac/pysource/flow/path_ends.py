"""Path ends: the statements behind which control never gets, as `return` and endless loops."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator

from smachac.ir.code_slips import texts_of
from smachac.pysource.modules.modules import Names
from smachac.records import dataclass

_STOPS = ("abort", "assert_never", "exit", "_exit", "fail", "quit")
"""Functions that do not return, by their usual names: `sys.exit()`, `self.fail()`."""

_ENDLESS = ("count", "cycle", "repeat")
"""The iterators of itertools without an end; `repeat` if it has no second argument."""


@dataclass(frozen=True, slots=True)
class PathEnds:
    """Whether statements end each path, in a module with `names`.

    `never_returns` decides on a called function, `never_exhausted` on one whose call gives items.
    Where it cannot be judged whether a path goes on, the answer is that it ends.
    """

    names: Names
    never_returns: Callable[[ast.expr], bool]
    never_exhausted: Callable[[ast.expr], bool] = lambda _: False

    def block(self, body: list[ast.stmt]) -> bool:
        """Whether control never reaches the end of statements: they return, raise or loop for
        ever."""
        return any(map(self.statement, body))

    def statement(self, node: ast.stmt) -> bool:
        """Whether control never reaches the place after a statement."""
        match node:
            case ast.Return() | ast.Raise() | ast.Break() | ast.Continue():
                # A loop with `break` is handled below; `continue` stays in the loop.
                return True
            case ast.If(body=body, orelse=orelse):
                return self.block(body) and self.block(orelse)
            case ast.For() | ast.While() if self.is_endless(node):
                return not any(_breaks(node.body))
            case (
                ast.For(body=body, orelse=[_, *_] as orelse)
                | ast.While(body=body, orelse=[_, *_] as orelse)
            ):
                return self.block(orelse) and not any(_breaks(body))
            case ast.With(body=body):
                return self.block(body)
            case ast.Try(body=body, handlers=handlers, orelse=orelse, finalbody=final):
                whole = self.block(body) or self.block(orelse)
                return self.block(final) or (
                    whole and all(self.block(handler.body) for handler in handlers)
                )
            case ast.Match(cases=cases):
                return self._covers(node) and all(self.block(case_.body) for case_ in cases)
            case ast.Assert(test=ast.Constant(value=test)):
                return not test
            case ast.Expr(value=ast.Call(func=ast.Name() | ast.Attribute() as function)):
                word = function.id if isinstance(function, ast.Name) else function.attr
                return word in _STOPS or word.startswith("raise_") or self.never_returns(function)
        return False

    def open_end(self, body: list[ast.stmt]) -> tuple[str, ast.AST]:
        """Where control comes from at the end of statements that do not end: the kind of place
        (`if`, `match`, `except`, `loop`; `text`, `value` or `call` alone in the last line; or none
        of these), and its statement or handler."""
        last = body[-1]
        match last:
            case ast.If(orelse=[]):
                return "if", last
            case ast.If(body=inner, orelse=other):
                return self.open_end(other if self.block(inner) else inner)
            case ast.With(body=inner):
                return self.open_end(inner)
            case ast.Match(cases=cases):
                case = next((case_ for case_ in cases if not self.block(case_.body)), None)
                return ("match", last) if case is None else self.open_end(case.body)
            case ast.Try(handlers=handlers, body=inner):
                handler = next(
                    (handler for handler in handlers if not self.block(handler.body)), None
                )
                if self.block(inner) and handler is not None:
                    return "except", handler
                if handler is None:
                    return self.open_end(last.orelse or inner)
            case ast.For() | ast.While():
                return "loop", last
            case ast.Expr(value=value) if texts_of(value):
                return "text", last
            case ast.Expr(value=ast.Name() | ast.Subscript() | ast.IfExp()):
                return "value", last
            case ast.Expr(value=ast.Call()):
                return "call", last
        return "", last

    def is_endless(self, loop: ast.For | ast.While) -> bool:
        """Whether the head of a loop never ends it."""
        if isinstance(loop, ast.While):
            return isinstance(loop.test, ast.Constant) and bool(loop.test.value)
        match loop.iter:
            case ast.Call(func=ast.Name(id="enumerate"), args=[inner, *_]):
                items = inner
            case items:
                pass
        if isinstance(items, ast.Call) and self.never_exhausted(items.func):
            return True
        match items:
            case ast.Call(func=ast.Attribute(value=ast.Name(id="itertools"), attr=name)):
                pass
            case ast.Call(func=ast.Name(id=name)) if self._is_imported(name):
                pass
            case _:
                return False
        return name in _ENDLESS and not (name == "repeat" and len(items.args + items.keywords) > 1)

    def _is_imported(self, name: str) -> bool:
        """Whether a name is that of a function of itertools."""
        bound = self.names.get(name, ())
        return bool(bound) and all(
            isinstance(node, ast.ImportFrom) and node.module == "itertools" for node in bound
        )

    def _covers(self, node: ast.Match) -> bool:
        """Whether a match has a case for every value, as far as its patterns show: a pattern of a
        class may be the last one that is possible."""
        patterns = [
            plain
            for case in node.cases
            if case.guard is None
            for plain in _alternatives(case.pattern)
        ]
        singletons = {
            pattern.value for pattern in patterns if isinstance(pattern, ast.MatchSingleton)
        }
        if {True, False} <= singletons:
            return True
        members: dict[str, set[str]] = {}
        for pattern in patterns:
            match pattern:
                case ast.MatchAs() | ast.MatchClass():
                    if all(map(_is_any, _parts(pattern))):
                        return True
                case ast.MatchSequence(patterns=parts):
                    subject = node.subject
                    items = subject.elts if isinstance(subject, ast.Tuple) else []
                    if len(items) == len(parts) and all(map(_is_any, parts)):
                        return True
                case ast.MatchValue(value=ast.Attribute(value=owner, attr=name)):
                    members.setdefault(ast.unparse(owner), set()).add(name)
        return any(self._members(owner) <= seen for owner, seen in members.items())

    def _members(self, name: str) -> set[str]:
        """The members of an enumeration of the module; empty if it is not known."""
        match self.names.get(name, ()):
            case (ast.ClassDef(body=body),):
                assigned = [assignment for assignment in body if isinstance(assignment, ast.Assign)]
                targets = [target for assignment in assigned for target in assignment.targets]
                return {target.id for target in targets if isinstance(target, ast.Name)}
        return set()


def _alternatives(pattern: ast.pattern) -> Iterator[ast.pattern]:
    """The patterns one of which a value must match, without the names that they bind."""
    match pattern:
        case ast.MatchOr(patterns=several):
            for node in several:
                yield from _alternatives(node)
        case ast.MatchAs(pattern=inner) if inner is not None:
            yield from _alternatives(inner)
        case _:
            yield pattern


def _parts(pattern: ast.MatchAs | ast.MatchClass) -> list[ast.pattern]:
    if isinstance(pattern, ast.MatchAs):
        return []
    return [*pattern.patterns, *pattern.kwd_patterns]


def _is_any(pattern: ast.pattern) -> bool:
    """Whether every value matches a pattern: `_`, a name, `*rest`."""
    if isinstance(pattern, ast.MatchAs):
        return pattern.pattern is None
    return isinstance(pattern, ast.MatchStar)


def _breaks(body: list[ast.stmt]) -> Iterator[bool]:
    """True for each `break` that leaves the loop with this body."""
    todo: list[ast.AST] = [*body]
    while todo:
        node = todo.pop()
        if isinstance(node, ast.Break):
            yield True
        loops = ast.For | ast.While | ast.AsyncFor | ast.FunctionDef | ast.ClassDef | ast.expr
        if not isinstance(node, loops):
            todo.extend(ast.iter_child_nodes(node))
        elif isinstance(node, ast.For | ast.While):
            todo.extend(node.orelse)
