"""Static analysis of the user's Python code: parsed with `ast`, never run.

In a template, each expression of Jinja is replaced by a name of the same length, so that positions
stay the same; code that contains one is not analysed, nor is code that cannot be parsed.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.jinja_tags import replaced, tags
from smachac.ir.nodes import Body

LONGEST = 200_000
"""The longest text that is read, in characters."""

_RAW = re.compile(r"\{%[-+]?\s*raw\b")
_NOT_PORTABLE_LINES = re.compile(r"\r(?!\n)|[\f\v]")


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonText:
    """A text with its tree; `filled` are the ranges that Jinja replaces."""

    source: Source
    tree: ast.Module
    filled: tuple[tuple[int, int], ...] = ()

    def span(self, node: ast.stmt | ast.expr) -> Span:
        start = self.offset(node.lineno, node.col_offset)
        end = self.offset(node.end_lineno or node.lineno, node.end_col_offset or 0)
        return Span(self.source, start, end)

    def offset(self, line: int, column: int) -> int:
        """The offset in characters of a column in bytes of UTF-8, as `ast` counts them."""
        before = self.source.line(line).encode("utf-8", "surrogatepass")[:column]
        return self.source.line_starts[line - 1] + len(before.decode("utf-8", "surrogatepass"))

    def is_filled(self, span: Span) -> bool:
        return bool(self.fillings(span))

    def fillings(self, span: Span) -> list[str]:
        """The ranges of Jinja that overlap a range."""
        return [
            self.source.text[start:end]
            for start, end in self.filled
            if start < span.end and end > span.start
        ]


def python_text(source: Source, *, template: bool) -> PythonText | None:
    """A text of Python; None if it cannot be parsed. Raises RecursionError and MemoryError if it
    is nested too deeply."""
    text = source.text
    if len(text) > LONGEST or _NOT_PORTABLE_LINES.search(text):
        return None
    filled: tuple[tuple[int, int], ...] = ()
    if template:
        if _RAW.search(text):
            return None
        filled = tuple(tags(text))
        text = replaced(text, iter(filled), {"{{": "_"})  # a name in place of an expression
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            return PythonText(source=source, tree=ast.parse(text), filled=filled)
    except (SyntaxError, ValueError):
        return None


METHODS = frozenset(["extract", "keys", "merge", "update"])
"""The attributes of userdata that are no keys (smach.user_data)."""


def python_body(source: Source, name: str) -> Body | None:
    """The analysis of `execute` in the class of a state type; None if there is no such method.

    The class has the name of the type, or is the only one with an `execute`.
    """
    try:
        text = python_text(source, template=True)
        function = _execute(text.tree, name) if text is not None else None
        return _Reader(text).body(function) if text is not None and function is not None else None
    except (RecursionError, MemoryError, ValueError):  # ValueError: a name in full-width letters
        return None


def _execute(tree: ast.Module, name: str) -> ast.FunctionDef | None:
    """The method `execute` of the class of a state, if SMACH can call it."""
    found: dict[str, ast.FunctionDef] = {}
    for node in tree.body:
        if not isinstance(node, ast.ClassDef):
            continue
        named = [each for each in ast.walk(node) if getattr(each, "name", "") == "execute"]
        if len(named) == 1 and isinstance(named[0], ast.FunctionDef) and named[0] in node.body:
            found[node.name] = named[0]
        elif named:
            return None
    only = next(iter(found.values())) if len(found) == 1 else None
    function = found.get(name, only)
    if function is None or function.decorator_list or len(function.args.args) != 2:
        return None
    inner = list(ast.walk(function))
    return None if any(isinstance(each, ast.Yield | ast.YieldFrom) for each in inner) else function


class _Reader:
    """Analyses one function of a text."""

    def __init__(self, text: PythonText) -> None:
        self.text = text

    def body(self, function: ast.FunctionDef) -> Body | None:
        span = self.text.span(function)
        inside = self.text.fillings(span)
        if any(text.startswith("{%") for text in inside):
            return None
        returns = list(_returns(function.body))
        silent = None
        if not inside and not _ends(function.body):
            at = span.source.text.index("execute", span.start)
            silent = Span(span.source, at, at + len("execute"))
        reads, writes = self.accesses(function)
        return Body(
            returns=tuple(self.constants(returns)),
            silent=silent,
            always_silent=not any(each.value is not None for each in returns),
            reads=reads,
            writes=writes,
        )

    def constants(self, returns: list[ast.Return]) -> Iterator[Word]:
        """The returned constants, with their spans."""
        for each in returns:
            for value in _alternatives(each.value) if each.value is not None else (each,):
                span = self.text.span(value)
                if self.text.is_filled(span):
                    continue
                if isinstance(value, ast.Return):
                    yield Word("None", span)
                elif isinstance(value, ast.Constant):
                    text = value.value
                    yield Word(text if isinstance(text, str) else repr(text), span)

    def accesses(self, function: ast.FunctionDef) -> tuple[tuple[Word, ...], tuple[Word, ...]]:
        """The keys of the userdata that are read and written; without keys whose presence the code
        tests, and without code in `try`."""
        name = function.args.args[1].arg
        reads: list[Word] = []
        writes: list[Word] = []
        asked: set[str] = set()
        tried: set[ast.AST] = set()
        for node in ast.walk(function):
            match node:
                case ast.Name(id=other, ctx=ast.Store() | ast.Del()) if other == name:
                    return (), ()
                case ast.arg(arg=other) if other == name and node is not function.args.args[1]:
                    return (), ()
                case ast.Compare(left=ast.Constant(str() as word), ops=[ast.In() | ast.NotIn()]):
                    asked.add(word)
                case ast.Try(handlers=[_, *_]):
                    tried.update(inner for each in node.body for inner in ast.walk(each))
        updated = {each.target for each in ast.walk(function) if isinstance(each, ast.AugAssign)}
        for node in ast.walk(function):
            if not isinstance(node, ast.Attribute | ast.Subscript) or node in tried:
                continue
            key = _key(node, name)
            if key is None or key in asked:
                continue
            span = self.text.span(node)
            if self.text.is_filled(span):
                continue
            if isinstance(node.ctx, ast.Load) or node in updated:
                reads.append(Word(key, span))
            if not isinstance(node.ctx, ast.Load):
                writes.append(Word(key, span))
        return tuple(sorted(reads, key=_start)), tuple(sorted(writes, key=_start))


def _start(word: Word) -> int:
    return word.span.start


def _key(node: ast.AST, name: str) -> str | None:
    """The key of the userdata that an expression accesses."""
    match node:
        case ast.Attribute(value=ast.Name(id=owner), attr=key) if owner == name:
            return None if key in METHODS or key.startswith("_") else key
        case ast.Subscript(value=ast.Name(id=owner), slice=ast.Constant(str() as key)):
            return key if owner == name else None
    return None


def _alternatives(value: ast.expr) -> Iterator[ast.expr]:
    if isinstance(value, ast.IfExp):
        yield from _alternatives(value.body)
        yield from _alternatives(value.orelse)
    else:
        yield value


def _returns(body: list[ast.stmt]) -> Iterator[ast.Return]:
    """The return statements of a function, without those of nested functions."""
    todo: list[ast.AST] = [*reversed(body)]
    while todo:
        node = todo.pop()
        if isinstance(node, ast.Return):
            yield node
        elif not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.expr):
            todo.extend(reversed(list(ast.iter_child_nodes(node))))


def _ends(body: list[ast.stmt]) -> bool:
    """Whether control never reaches the end: statements return, raise or loop for ever."""
    return any(map(_is_end, body))


def _is_end(statement: ast.stmt) -> bool:
    match statement:
        case ast.Return() | ast.Raise() | ast.Break() | ast.Continue():
            # A loop with `break` is handled below; `continue` stays in the loop.
            return True
        case ast.If(body=body, orelse=orelse):
            return _ends(body) and _ends(orelse)
        case ast.While(test=ast.Constant(value=test), body=body) if test:
            return not any(_breaks(body))
        case (
            ast.For(body=body, orelse=[_, *_] as orelse)
            | ast.While(body=body, orelse=[_, *_] as orelse)
        ):
            return _ends(orelse) and not any(_breaks(body))
        case ast.With(body=body):
            return _ends(body)
        case ast.Try(body=body, handlers=handlers, orelse=orelse, finalbody=final):
            whole = _ends(body) or _ends(orelse)
            return _ends(final) or (whole and all(_ends(each.body) for each in handlers))
        case ast.Match(cases=cases):
            last = cases[-1]
            whole = isinstance(last.pattern, ast.MatchAs) and last.pattern.pattern is None
            return whole and last.guard is None and all(_ends(each.body) for each in cases)
        case ast.Assert(test=ast.Constant(value=test)):
            return not test
        case ast.Expr(value=ast.Call(func=ast.Name() | ast.Attribute() as function)):
            # Whether a call returns is not known: `sys.exit()`, `self.give_up()`.
            word = function.id if isinstance(function, ast.Name) else function.attr
            return word in ("abort", "exit", "_exit", "fail", "quit")
    return False


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
