"""Messages of ROS that the code of a script makes: calls of their classes, as `Bool(data=True)`."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from smachac.analysis.message_code import nested_messages
from smachac.checks.ros.message_values import ValueFault, value_faults
from smachac.diagnostics.source import Span
from smachac.ir.message_types import Definitions, FieldType, Message
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.python_code import parse_code

CHECK_FIELDS = "check_fields"
"""The argument of the classes of ROS 2 that is no field."""


def message_calls(code: Expression, found: Definitions) -> Iterator[tuple[ast.Call, list[Message]]]:
    """The calls in code of the classes of messages, with the messages that they can mean. Calls in
    the arguments of one are parts of it."""
    todo = [_tree(code.text)]
    while todo:
        node = todo.pop()
        name = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
        definitions = found.get(("msg", name), ())
        if isinstance(node, ast.Call) and definitions:
            yield node, [definition.part("message") for definition in definitions]
        else:
            todo += ast.iter_child_nodes(node)


def call_faults(
    call: ast.Call, messages: Sequence[Message], found: Definitions, span: Span
) -> list[ValueFault]:
    """The faults of the arguments of a call that makes a message. Of several definitions one may
    fit."""
    faults = [
        list(value_faults(_arguments(call, [message], found, span), message, found))
        for message in messages
    ]
    return faults[0] if all(faults) else []


def _tree(text: str) -> ast.AST:
    try:
        return parse_code(text.strip())
    except SyntaxError:
        return ast.Module(body=[], type_ignores=[])


def _arguments(call: ast.Call, messages: Sequence[Message], found: Definitions, span: Span) -> Data:
    """The arguments by the names of the fields; code for a call with other arguments."""
    names = [keyword.arg for keyword in call.keywords]
    if call.args or None in names:
        return Expression(text=ast.unparse(call), span=span)
    entries = []
    for keyword in call.keywords:
        name = keyword.arg or ""
        fields = [message.field(name) for message in messages]
        types = [field.type for field in fields if field is not None]
        if name != CHECK_FIELDS or types:
            entries.append((name, _literal(keyword.value, types, found, span)))
    return Struct(entries=tuple(entries))


def _literal(node: ast.expr, types: Sequence[FieldType], found: Definitions, span: Span) -> Data:
    """The value of a literal or of the call of the class of a message; other code stays code."""
    match node:
        case ast.Constant(value=bool() | int() | float() | str() as value):
            return value
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
            return -value
        case ast.List(elts=items) | ast.Tuple(elts=items):
            if not any(isinstance(item, ast.Starred) for item in items):
                inner = [FieldType(name=type_.name) for type_ in types]
                return tuple(_literal(item, inner, found, span) for item in items)
        case ast.Call():
            messages = nested_messages(types, found)
            name = ast.unparse(node.func).rpartition(".")[2]
            if messages and all(message.name.rpartition("/")[2] == name for message in messages):
                return _arguments(node, messages, found, span)
    return Expression(text=ast.unparse(node), span=span)
