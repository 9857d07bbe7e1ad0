"""Messages of ROS in the functions of a state: the types of the arguments and of their fields."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from smachac.analysis.code_slots import CodeSlot, accepts, free_names, parameters, swapped
from smachac.ir.leaf import type_text, variable_of
from smachac.ir.message_types import (
    PARTS,
    Definition,
    DefinitionKind,
    Definitions,
    FieldType,
    Message,
)
from smachac.ir.nodes import DEFINITION_KINDS, Leaf

MOST_CODE = 10_000
"""The longest function that is read, in characters."""

Content: TypeAlias = "tuple[Message | FieldType, ...]"
"""What a part of code can hold, one item for each definition that was found; empty: not known."""


class FieldRead(NamedTuple):
    """A field that code uses: the messages that can be there, and the place and the name of the
    field."""

    messages: tuple[Message, ...]
    place: ast.expr
    name: str


def leaf_definitions(
    leaf: Leaf, found: Definitions
) -> Iterator[tuple[DefinitionKind, tuple[Definition, ...]]]:
    """The definitions of the types that a state names."""
    for role, kind in DEFINITION_KINDS.items():
        named = variable_of(leaf, role)
        if named is not None and (kind, type_text(named)) in found:
            yield kind, found[kind, type_text(named)]


def nested_messages(content: Sequence[Message | FieldType], found: Definitions) -> list[Message]:
    """The messages of some types; empty if one of them is a list, has no definition or is no
    message."""
    messages: list[Message] = []
    for each in content:
        if isinstance(each, Message):
            messages.append(each)
        elif each.array or ("msg", each.name) not in found:
            return []
        else:
            messages += [one.part("message") for one in found["msg", each.name]]
    return messages


def field_reads(slot: CodeSlot, leaf: Leaf, found: Definitions) -> Iterator[FieldRead]:
    """The fields that the function in a slot uses; none if it tests with `hasattr` for fields."""
    arguments = _arguments(slot, leaf, found)
    if not arguments or not isinstance(slot.tree, ast.Lambda):
        return
    parts = list(ast.walk(slot.tree.body))
    if any(isinstance(each, ast.Name) and each.id == "hasattr" for each in parts):
        return
    for node in parts:
        match node:
            case ast.Attribute(value=owner, attr=name):
                place: ast.expr = node
            case ast.Call(
                func=ast.Name(id="setattr"), args=[owner, ast.Constant(value=str(name)) as place, _]
            ):
                pass
            case _:
                continue
        messages = nested_messages(_content(owner, arguments, found), found)
        if messages:
            yield FieldRead(tuple(messages), place, name)


def content_of(slot: CodeSlot, leaf: Leaf, result: ast.expr, found: Definitions) -> Content:
    """What a part of the function in a slot holds."""
    return _content(result, _arguments(slot, leaf, found), found)


def _arguments(slot: CodeSlot, leaf: Leaf, found: Definitions) -> Mapping[ast.Name, Content]:
    """The places where the function in a slot reads an argument that is a message."""
    tree, due = slot.tree, slot.arguments
    if not isinstance(tree, ast.Lambda) or due is None or not accepts(tree, len(due)):
        return {}
    if slot.quoted or len(slot.code.text) > MOST_CODE or swapped(tree, due):
        return {}
    known: dict[str, Content] = {}
    for kind, definitions in leaf_definitions(leaf, found):
        for part in PARTS[kind]:
            known[part] = tuple(each.part(part) for each in definitions)
    own = dict(zip([each.arg for each in parameters(tree)], due, strict=False))
    stored = {
        each.target.id for each in ast.walk(tree.body) if isinstance(each, ast.NamedExpr)
    }  # fmt: skip
    return {
        each: known[own[each.id]]
        for each in free_names(tree.body)
        if own.get(each.id) in known and each.id not in stored
    }


def _content(node: ast.expr, arguments: Mapping[ast.Name, Content], found: Definitions) -> Content:
    """What code holds: an argument, a field of a message or an item of a list."""
    steps: list[ast.Attribute | ast.Subscript] = []
    while isinstance(node, ast.Attribute | ast.Subscript):
        steps.append(node)
        node = node.value
    content = arguments.get(node, ()) if isinstance(node, ast.Name) else ()
    for step in reversed(steps):
        if isinstance(step, ast.Attribute):
            fields = [each.field(step.attr) for each in nested_messages(content, found)]
            content = tuple(each.type for each in fields if each is not None)
            if len(content) != len(fields):
                return ()
        else:
            lists = [each for each in content if isinstance(each, FieldType) and each.array]
            if isinstance(step.slice, ast.Slice) or len(lists) != len(content):
                return ()
            content = tuple(FieldType(name=each.name, longest=each.longest) for each in lists)
    return content
