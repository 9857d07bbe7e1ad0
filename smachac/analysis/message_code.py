"""Messages of ROS in the functions of a state: the types of the arguments and of their fields."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from smachac.analysis.code_slots import CodeSlot, accepts, parameters, results, swapped
from smachac.diagnostics.source import Span
from smachac.ir.argument_parts import argument_uses, result_of
from smachac.ir.code_places import node_place
from smachac.ir.function_facts import ArgumentUses, FunctionFacts, Part, Result
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
from smachac.ir.script_code import free_names
from smachac.records import dataclass

MOST_CODE = 10_000
"""The longest function that is read, in characters."""

Content: TypeAlias = "tuple[Message | FieldType, ...]"
"""What a part of code can hold, one item for each definition that was found; empty: not known."""


class FieldRead(NamedTuple):
    """A part of an argument that code uses, and the messages that can have its last field."""

    messages: tuple[Message, ...]
    part: Part


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageCode:
    """What the function in a slot does with the messages that it receives.

    `contents` are the messages by the names of its parameters. `function` are the facts about a
    function in a module; None for a lambda.
    """

    contents: Mapping[str, Content]
    uses: ArgumentUses
    results: tuple[Result, ...]
    function: FunctionFacts | None


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
    for item in content:
        if isinstance(item, Message):
            messages.append(item)
        elif item.array or ("msg", item.name) not in found:
            return []
        else:
            messages += [one.part("message") for one in found["msg", item.name]]
    return messages


def field_reads(code: MessageCode, found: Definitions) -> Iterator[FieldRead]:
    """The fields of messages that a function uses."""
    for part in code.uses.parts:
        messages = owners(part, code, found)
        if messages:
            yield FieldRead(tuple(messages), part)


def owners(part: Part, code: MessageCode, found: Definitions) -> list[Message]:
    """The messages that have the last field of a part of an argument."""
    return nested_messages(_content(code.contents.get(part.parameter, ()), part.steps[:-1], found),
                           found)  # fmt: skip


def content_of(part: Part, code: MessageCode, found: Definitions) -> Content:
    """What a part of an argument holds."""
    return _content(code.contents.get(part.parameter, ()), part.steps, found)


def message_code(
    slot: CodeSlot, leaf: Leaf, found: Definitions, functions: Mapping[str, FunctionFacts]
) -> MessageCode | None:
    """What the function in a slot does with messages; None if it receives none whose definition
    is known, or cannot be read."""
    due = slot.arguments
    if due is None or slot.quoted or len(slot.code.text) > MOST_CODE:
        return None
    known: dict[str, Content] = {}
    for kind, definitions in leaf_definitions(leaf, found):
        for part in PARTS[kind]:
            known[part] = tuple(definition.part(part) for definition in definitions)
    if known.keys().isdisjoint(due):
        return None
    function = functions.get(slot.code.text)
    if function is not None:
        names = function.parameters
        if not function.accepts(len(due)) or swapped(names, due):
            return None
        uses, returned = function.uses, function.results
    else:
        tree = slot.tree
        if not isinstance(tree, ast.Lambda) or not accepts(tree, len(due)):
            return None
        names = tuple(parameter.arg for parameter in parameters(tree))
        if swapped(names, due):
            return None
        uses, returned = _lambda_uses(slot, tree)
    contents = {own: known[name] for own, name in zip(names, due, strict=False) if name in known}
    return MessageCode(contents=contents, uses=uses, results=returned, function=function)


def slot_results(slot: CodeSlot, functions: Mapping[str, FunctionFacts]) -> tuple[Result, ...]:
    """The values that the function in a slot can return; none if it cannot be read."""
    function = functions.get(slot.code.text)
    if function is not None:
        return function.results
    tree = slot.tree
    return _lambda_uses(slot, tree)[1] if isinstance(tree, ast.Lambda) else ()


def _lambda_uses(slot: CodeSlot, tree: ast.Lambda) -> tuple[ArgumentUses, tuple[Result, ...]]:
    """The uses of arguments in a lambda, none if it tests with `hasattr` for fields, and its
    results."""
    nodes = list(ast.walk(tree.body))
    stored = {node.target.id for node in nodes if isinstance(node, ast.NamedExpr)}
    own = {parameter.arg for parameter in parameters(tree)} - stored
    names = {name for name in free_names(tree.body) if name.id in own}
    tested = any(isinstance(node, ast.Name) and node.id == "hasattr" for node in nodes)

    def place(node: ast.expr) -> Span:
        return node_place(slot.code, node)

    uses = argument_uses(nodes, names, place)
    if tested:
        uses = uses._replace(parts=(), operands=())
    return uses, tuple(result_of(result, names, place) for result in results(tree))


def _content(content: Content, steps: Sequence[str | None], found: Definitions) -> Content:
    """What a field of a message, or an item of a list, holds at the end of some steps."""
    for step in steps:
        if step is not None:
            fields = [message.field(step) for message in nested_messages(content, found)]
            content = tuple(field.type for field in fields if field is not None)
            if len(content) != len(fields):
                return ()
        else:
            lists = [type_ for type_ in content if isinstance(type_, FieldType) and type_.array]
            if len(lists) != len(content):
                return ()
            content = tuple(FieldType(name=list_.name, longest=list_.longest) for list_ in lists)
    return content
