"""Places of the parts of a value: an item, a field, the key of a field.

A value of the state graph has one span. The text in it is parsed again where a finding is about a
part; so no part needs a span of its own.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from smachac.analysis.data_types import type_of_data
from smachac.analysis.type_lattice import (
    FLOAT,
    POINT,
    QUATERNION,
    fields,
    inside,
    length_of,
    misfit,
    present,
)
from smachac.diagnostics.source import Source, Span
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse
from smachac.ir.code_places import attribute_place, node_place
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.script_code import script_code
from smachac.ir.types import Type

TYPE_CHECKING = False  # annotations only: few scripts have faults in code
if TYPE_CHECKING:
    from smachac.analysis.expression_errors import Fault

LONGEST = 20_000
"""In characters. The parts of a longer value are not searched."""

_TEXT_AFTER = re.compile(r"""\s*:\s*(?:"([^"\n]*)"|'([^'\n]*)'|([^\s,}\]#]+))""")


class Part(NamedTuple):
    """A part of a value: the steps that lead to it from the whole value. `key`: the key of the part
    in its mapping is meant, and not its value."""

    steps: tuple[int | str, ...] = ()
    key: bool = False


WHOLE = Part()
"""The whole value."""


def place_of_part(span: Span, steps: Sequence[int | str], *, key: bool = False) -> Span:
    """The place of the part of a value to which the steps lead, or of its key; the place of the
    nearest value around it where the text has an alias or a look-up in its place."""
    if not steps or span.end - span.start > LONGEST:
        return span
    # The spaces keep the first line of a block in its column.
    column = span.column - 1
    tree = parse(Source("", " " * column + span.text), [])
    shift = span.start - column
    if tree is None or tree.span.start != column:
        return span
    found = tree.span
    for number, step in enumerate(steps):
        inner = _part(tree, step)
        if inner is None:
            break
        name, tree = inner
        is_key = key and number == len(steps) - 1 and name is not None
        found = name.span if is_key and name is not None else tree.span
    return Span(span.source, found.start + shift, found.end + shift)


def _part(tree: Tree, step: int | str) -> tuple[Scalar | None, Tree] | None:
    """An item of a list, or a field of a mapping with its key."""
    if isinstance(tree, Seq) and isinstance(step, int) and step < len(tree.items):
        return None, tree.items[step]
    if isinstance(tree, Map):
        entry = tree.get(str(step))
        return (entry.key, entry.value) if entry is not None else None
    return None


def place_of_value(name: Span, text: str) -> Span:
    """The place of a text that is written as the value of a name; else that of the name."""
    found = _TEXT_AFTER.match(name.source.text, name.end)
    if found is None or found[found.lastindex or 0] != text:
        return name
    start, end = found.span(found.lastindex or 0)
    return Span(name.source, start, end)


def steps_to_misfit(data: Data, wanted: Type) -> tuple[int | str, ...]:
    """The steps to the innermost part of a literal that does not fit a type; none if it is the
    literal as a whole, such as a list of a wrong length."""
    for step, part, type_ in parts_of(data, present(wanted)):
        if misfit(type_of_data(part), type_) is not None:
            return (step, *steps_to_misfit(part, type_))
    return ()


def part_at(data: Data, steps: Sequence[int | str]) -> Data:
    """The part of a literal to which the steps lead; None if it has none."""
    for step in steps:
        if isinstance(data, tuple) and isinstance(step, int):
            data = data[step] if step < len(data) else None
        else:
            data = dict(data.entries).get(str(step)) if isinstance(data, Struct) else None
    return data


def type_at(wanted: Type, steps: Sequence[int | str]) -> Type:
    """The type of a part of a literal of a type, by the steps to it."""
    type_ = present(wanted)
    for step in steps:
        type_ = present(fields(type_)[str(step)] if type_.name == "record" else inside(type_))
    return type_


def steps_to_number(data: Data, number: float) -> tuple[int | str, ...]:
    """The steps to the first such number in a literal; none if it is the literal itself."""
    parts: Iterable[tuple[int | str, Data]] = ()
    if isinstance(data, tuple):
        parts = enumerate(data)
    elif isinstance(data, Struct):
        parts = data.entries
    for step, part in parts:
        if isinstance(part, tuple | Struct):
            inner = steps_to_number(part, number)
            if inner:
                return (step, *inner)
        elif part == number and not isinstance(part, bool):
            return (step,)
    return ()


def parts_of(data: Data, wanted: Type) -> Iterator[tuple[int | str, Data, Type]]:
    """The items or fields of a literal, each with the type that it must fit."""
    if isinstance(data, tuple):
        yield from ((at, value, type_) for at, (value, type_) in enumerate(_items(data, wanted)))
    elif isinstance(data, Struct):
        types = fields(wanted) if wanted.name == "record" else {}
        held = dict(data.entries)
        if any(name not in held and type_.name != "optional" for name, type_ in types.items()):
            return
        for name, part in data.entries:
            if wanted.name == "dict":
                yield name, part, inside(wanted)
            elif name in types:
                yield name, part, types[name]


def _items(data: tuple[Data, ...], wanted: Type) -> Iterator[tuple[Data, Type]]:
    count = len(data)
    if wanted in (POINT, QUATERNION) and count == (3 if wanted == POINT else 4):
        yield from ((value, FLOAT) for value in data)
    elif wanted.name in ("Pose", "Transform") and count == 2:
        yield from zip(data, (POINT, QUATERNION), strict=True)
    elif wanted.name in ("list", "array") and length_of(wanted) in (None, count):
        yield from ((value, inside(wanted)) for value in data)


def place_of_fault(code: Expression, fault: Fault) -> Span:
    """The place of a fault: of the name of an attribute, or of the part of the expression."""
    from smachac.ir.expressions import print_expression

    tree, part = script_code(code.text).tree, script_code(print_expression(fault.expr)).tree
    text = ast.dump(part) if part is not None else ""
    for node in ast.walk(tree) if tree is not None else ():
        if isinstance(node, ast.expr) and type(node) is type(part) and ast.dump(node) == text:
            if isinstance(node, ast.Attribute) and node.attr == fault.word:
                return attribute_place(code, node)
            return node_place(code, node)
    return code.span
