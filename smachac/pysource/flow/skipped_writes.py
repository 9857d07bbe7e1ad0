"""Skipped writes: the userdata keys that a function sets only on some paths to a `return`.

A lower bound, beside the upper bound of flow.py. A key is skipped where a branch, an exception
or the end of a loop leads past the statement that sets it, straight to a `return`. Conditions are
not evaluated; so a key counts as set wherever a later condition can depend on it, where a condition
was examined before, where a loop may have no round, and behind a chain of `elif` without `else`.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping

from smachac.diagnostics.source import Word
from smachac.pysource.flow.path_ends import PathEnds
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.records import dataclass, field

NONE: frozenset[str] = frozenset()

Skips = Mapping[str, Word]
"""The place at which each key is skipped, by key: the first line of a statement, with its kind. The
kinds are `if` and `else` for a condition that is false or true, `except`, `loop`, `match`, and
`return` in a function that is called."""


@dataclass(frozen=True, slots=True)
class Paths:
    """The keys that are set on each path to a place, and those that are skipped on one."""

    sure: frozenset[str] = NONE
    skipped: Skips = field(default_factory=dict)

    def after(self, keys: frozenset[str], skips: Skips) -> Paths:
        """After code that sets some keys and skips others."""
        sure = self.sure | keys
        left = {key: place for key, place in {**self.skipped, **skips}.items() if key not in sure}
        return Paths(sure, left)

    def trusted(self) -> Paths:
        """After a condition, which can depend on what was skipped."""
        return Paths(self.sure.union(self.skipped))


class SkippedWrites:
    """The skipped keys at each `return` of a function.

    `userdata` is the name of the userdata. `effects` gives the keys that code can set, `skips`
    those that a call in it can skip, `place` the place of a statement or handler with its kind.
    """

    def __init__(
        self,
        path_ends: PathEnds,
        userdata: str,
        effects: Callable[[ast.AST], frozenset[str]],
        skips: Callable[[ast.AST], Skips],
        place: Callable[[str, ast.AST], Word],
    ) -> None:
        self.path_ends = path_ends
        self.userdata = userdata
        self.effects = effects
        self.skips = skips
        self.place = place
        self.returns: dict[ast.Return, Paths] = {}
        self.end: Paths | None = None
        self._examined: set[str] = set()
        self._rounds: list[tuple[list[Paths], list[Paths]]] = []

    def read(self, body: list[ast.stmt]) -> None:
        """Follows the statements of the function; `end` is what holds after them."""
        self.end = self._block(body, Paths())

    def whole(self) -> Skips:
        """The keys that a call of the function can skip."""
        ends = [*self.returns.values(), *([] if self.end is None else [self.end])]
        sure = frozenset.intersection(*(end.sure for end in ends)) if ends else NONE
        found: dict[str, Word] = {}
        for node, returned in self.returns.items():
            ever = NONE.union(*(end.sure for end in ends))
            found |= {key: self.place("return", node) for key in ever - returned.sure}
        for end in ends:
            found |= end.skipped
        return {key: place for key, place in found.items() if key not in sure}

    def _merged(
        self, several: Iterable[Paths | None], kind: str, node: ast.AST | None
    ) -> Paths | None:
        """After paths that meet; None if none of them gets there. Without a node, a key that only
        some of them set is not skipped."""
        reached = [paths for paths in several if paths is not None]
        if not reached:
            return None
        sure = frozenset.intersection(*(paths.sure for paths in reached))
        skips: dict[str, Word] = {}
        for paths in reached:
            if node is not None and paths.sure != sure:
                skips |= dict.fromkeys(paths.sure - sure, self.place(kind, node))
        for paths in reached:
            skips |= paths.skipped
        return Paths(sure, skips)

    def _block(self, body: list[ast.stmt], before: Paths | None) -> Paths | None:
        for statement in body:
            if before is None:
                return None
            before = self._statement(statement, before)
        return before

    def _evaluated(self, node: ast.AST, before: Paths) -> Paths:
        """After an expression or a statement without a branch."""
        skips = self.skips(node)
        return before.after(self.effects(node) - skips.keys(), skips)

    def _statement(self, node: ast.stmt, before: Paths) -> Paths | None:
        match node:
            case ast.Return():
                self.returns[node] = self._evaluated(node, before)
                return None
            case ast.Break() | ast.Continue():
                if self._rounds:
                    self._rounds[-1][isinstance(node, ast.Continue)].append(before)
                return None
            case ast.If():
                return self._if(node, self._evaluated(node.test, before).trusted())
            case ast.For() | ast.While():
                return self._loop(node, before)
            case ast.With() | ast.AsyncWith():
                for item in node.items:
                    before = self._evaluated(item, before)
                return self._block(node.body, before)
            case ast.Try():
                return self._try(node, before)
            case ast.Match():
                head = self._evaluated(node.subject, before).trusted()
                return self._merged([self._block(c.body, head) for c in node.cases], "match", node)
            case ast.Assert():
                return self._evaluated(node, before).trusted()
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                return before
        return None if self.path_ends.statement(node) else self._evaluated(node, before)

    def _if(self, node: ast.If, head: Paths, *, chained: bool = False) -> Paths | None:
        head = head.after(self._tested(node.test), {})
        conditions = {_condition(part) for part in _parts(node.test)}
        examined = not conditions.isdisjoint(self._examined)
        self._examined |= conditions
        then = self._block(node.body, head)
        match node.orelse:
            case [ast.If() as inner]:
                test = self._evaluated(inner.test, head).trusted()
                other = self._if(inner, test, chained=True)
            case []:
                other = head if then is None or not (chained or examined) else None
            case _:
                other = self._block(node.orelse, head)
        if then is None or other is None:
            return then or other
        return self._merged([then, other], "if" if then.sure - other.sure else "else", node)

    def _tested(self, test: ast.expr) -> frozenset[str]:
        """The keys that a condition examines, which its branches can depend on."""
        found = set()
        for node in walk_code(test):
            match node:
                case ast.Attribute(value=ast.Name(id=name), attr=key) if name == self.userdata:
                    found.add(key)
                case ast.Constant(value=str() as key):
                    found.add(key)
        return frozenset(found)

    def _loop(self, node: ast.For | ast.While, before: Paths) -> Paths | None:
        test = node.test if isinstance(node, ast.While) else node.iter
        head = self._evaluated(test, before).trusted()
        self._rounds.append(([], []))
        last = self._block(node.body, head)
        broken, continued = self._rounds.pop()
        over = None
        if not self.path_ends.is_endless(node):
            over = self._merged([last, *continued], "loop", node)
            over = head if over is None and not broken else over
        return self._merged([*broken, self._block(node.orelse, over)], "loop", node)

    def _try(self, node: ast.Try, before: Paths) -> Paths | None:
        after = self._block(node.orelse, self._block(node.body, before))
        failed = before.after(self._surely(node.body), {})
        for handler in node.handlers:
            after = self._merged([after, self._block(handler.body, failed)], "except", handler)
        return self._block(node.finalbody, after)

    def _surely(self, body: list[ast.stmt]) -> frozenset[str]:
        """The keys that statements set before anything in them can raise an exception."""
        found = NONE
        for node in body:
            if any(isinstance(node, ast.Call | ast.Subscript) for node in walk_code(node)):
                break
            found |= self.effects(node)
        return found


def _parts(test: ast.expr) -> list[ast.expr]:
    """The parts of a condition that `and`, `or` and `not` join."""
    match test:
        case ast.BoolOp(values=values):
            return [part for value in values for part in _parts(value)]
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return _parts(operand)
        case ast.NamedExpr(target=target):
            return [target]
    return [test]


_OPPOSITES: dict[type[ast.cmpop], str] = {
    ast.Eq: "==", ast.NotEq: "==", ast.Is: "==", ast.IsNot: "==", ast.Lt: "<", ast.GtE: "<",
    ast.LtE: "<=", ast.Gt: "<=", ast.In: "in", ast.NotIn: "in",
}  # fmt: skip
"""One name for an operator and its opposite."""


def _condition(test: ast.expr) -> str:
    """A text that is equal for a condition and its opposite, and for the ways to write that a value
    is there: `x`, `x is not None`, `len(x) > 0`."""
    match test:
        case ast.Compare(left=left, ops=[operator], comparators=[right]):
            sized = isinstance(left, ast.Call) and ast.unparse(left.func) == "len" and left.args
            there = isinstance(right, ast.Constant) and not right.value
            one = isinstance(right, ast.Constant) and right.value == 1
            few = isinstance(operator, ast.Lt | ast.GtE) and one
            if sized and isinstance(left, ast.Call) and (there or few):
                return ast.unparse(left.args[0])
            if there and isinstance(operator, ast.Is | ast.IsNot | ast.Eq | ast.NotEq):
                return ast.unparse(left)
            name = _OPPOSITES[type(operator)]
            return f"{ast.unparse(left)} {name} {ast.unparse(right)}"
        case ast.Call(func=ast.Name(id="bool" | "len"), args=[value]):
            return ast.unparse(value)
    return ast.unparse(test)
