"""Values: from a tree to a value of the graph (literal, list, mapping, expression)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.frontend.text.yaml_tree import Joined, Map, Scalar, Seq, Tree, is_known_wrong
from smachac.ir.nodes import Data, Expression, LookUp, Struct, Value

UNKNOWN = "..."
"""The code in place of a value that was reported: it has no type, so no rule judges it."""


def as_value(tree: Tree, *, code: bool = False) -> Value:
    """The value of a tree. `code`: every string is an expression, as in `callbacks`."""
    return Value(data=_data(tree, code), span=tree.span, look_ups=_look_ups(tree))


def as_written(tree: Tree) -> Value:
    """The value of a tree as SMACHA's templates expect it: backticks stay in strings."""
    return Value(data=_data(tree, False, ticks=True), span=tree.span)


def _look_ups(tree: Tree) -> tuple[LookUp, ...]:
    """The parts of a value that are made of params: string constructs, and the parts whose place is
    outside the value, because a look-up put them there."""
    if isinstance(tree, Joined):
        return (_look_up(tree, ()),)
    return () if isinstance(tree, Scalar) else tuple(_inner_look_ups(tree, ()))


def _inner_look_ups(tree: Seq | Map, path: tuple[str | int, ...]) -> Iterator[LookUp]:
    source, start, end = tree.span.source, tree.span.start, tree.span.end
    for at, item in (
        enumerate(tree.items)
        if isinstance(tree, Seq)
        else ((str(entry.key.value), entry.value) for entry in tree.entries)
    ):
        if isinstance(item, Scalar):
            inside = item.source is source and start <= item.start and item.end <= end
            if not inside or isinstance(item, Joined):
                yield _look_up(item, (*path, at))
            continue
        if item.span.source is not source or not start <= item.span.start < end:
            yield _look_up(item, (*path, at))
        yield from _inner_look_ups(item, (*path, at))


def _look_up(tree: Tree, path: tuple[str | int, ...]) -> LookUp:
    found = tree.parts if isinstance(tree, Joined) else ()
    parts = tuple(part if isinstance(part, str) else _look_up(part, ()) for part in found)
    return LookUp(path=path, span=tree.span, data=_data(tree, False), parts=parts)


def _data(tree: Tree, code: bool, ticks: bool = False) -> Data:
    if isinstance(tree, Scalar):
        data = _scalar(tree, code)
        if not ticks or not isinstance(tree.value, str):
            return data
        if isinstance(data, Expression):
            return data if tree.value == data.text else tree.value.strip()
        if tree.plain and "(" in tree.value and _is_python(tree.value):
            return Expression(text=tree.value.strip(), span=tree.span)
        return data
    if isinstance(tree, Seq):
        return tuple([_data(item, code, ticks) for item in tree.items])
    return Struct(
        entries=tuple(
            (str(entry.key.value), _data(entry.value, code, ticks)) for entry in tree.entries
        )
    )


def _is_python(text: str) -> bool:
    """Whether a text is an expression of Python; SMACHA prints a text with a call as code."""
    from smachac.ir.python_code import parse_code

    try:
        parse_code(text.strip())
    except SyntaxError:
        return False
    return True


def _scalar(tree: Scalar, code: bool) -> Data:
    """An expression is a text in backticks, or a plain scalar that is a call or a dotted name."""
    value = tree.value
    if not isinstance(value, str):
        return value
    if is_known_wrong(tree):
        return Expression(text=UNKNOWN, span=tree.span)
    text = value.strip()
    if len(text) > 2 and text[0] == text[-1] == "`":
        return Expression(text=text[1:-1].strip(), span=tree.span)
    if code:
        return Expression(text=text, span=tree.span)
    if tree.plain and _is_expression(value):
        return Expression(text=text, span=tree.span)
    return value


def _is_expression(text: str) -> bool:
    """Whether a plain text is code: a call or a dotted name. Most are words, which are neither."""
    if text.isidentifier():
        return False
    from smachac.ir.expressions import looks_like_expression, parse_expression

    return looks_like_expression(text) and parse_expression(text) is not None
