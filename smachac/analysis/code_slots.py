"""Code slots: the places of a state whose code the state calls, or takes as a value.

The interface of the state type describes them (docs/state_types.md, Facts).
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from smachac.ir import nodes
from smachac.ir.nodes import (
    Expression,
    FunctionResult,
    Leaf,
    Node,
    StateType,
    Struct,
    Value,
    VariableRole,
)
from smachac.ir.script_code import USERDATA, fields_of, free_names, script_code
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeSlot:
    """Code that a state calls.

    `name` is the variable, or the entry of its mapping. `arguments` are those that the state
    passes; None if they are not known. `must_be_called`: a value that is no function is a fault.
    `quoted`: the script gives text in quotes, which is no code without backticks.
    """

    name: str
    code: Expression
    role: VariableRole
    arguments: tuple[str, ...] | None
    returns: FunctionResult
    must_be_called: bool
    quoted: bool = False

    @property
    def tree(self) -> ast.expr | None:
        return script_code(self.code.text).tree


def code_slots(node: Node, types: Mapping[str, StateType]) -> Iterator[CodeSlot]:
    """The code slots of a state with code in them, in the order of the script."""
    if isinstance(node, Leaf):
        known = types.get(node.type) if node.variables and not node.open else None
        if known is not None:
            for held in node.variables:
                fact = known.variables.get(held.name)
                if fact is not None and (fact.arguments is not None or fact.unquoted == "function"):
                    yield from _slots(held.value, fact)
    elif isinstance(node, nodes.Iterator) and node.items is not None:
        data = node.items.data
        if isinstance(data, Expression):
            tree = script_code(data.text).tree
            alone = isinstance(tree, ast.Lambda) and accepts(tree, 0)  # as SMACH calls it
            yield CodeSlot(
                name="it",
                code=data,
                role="function",
                arguments=() if alone else ("userdata",),
                returns="",
                must_be_called=False,
            )


def _slots(value: Value, fact: nodes.VariableType) -> Iterator[CodeSlot]:
    mapping = fact.role in ("callbacks", "conditions")
    data = value.data
    entries = data.entries if mapping and isinstance(data, Struct) else ((fact.name, data),)
    for name, other in entries if mapping == isinstance(data, Struct) else ():
        quoted = isinstance(other, str) and fact.unquoted != "function"
        code = code_of(other, value)
        if code is None:
            continue
        if not quoted or isinstance(script_code(code.text).tree, ast.Lambda):
            yield CodeSlot(
                name=name,
                code=code,
                role=fact.role,
                arguments=fact.arguments,
                returns=fact.returns,
                must_be_called=mapping or fact.unquoted == "function",
                quoted=quoted,
            )


def code_of(data: nodes.Data, value: Value) -> Expression | None:
    """The code in a value; a text can be code, too."""
    if isinstance(data, str):
        text = data.strip()
        if len(text) > 2 and text[0] == text[-1] == "`":
            text = text[1:-1].strip()
        return Expression(text=text, span=value.span)
    return data if isinstance(data, Expression) else None


def userdata_outside(tree: ast.expr) -> ast.Name | None:
    """The first place where code that is no function reads userdata."""
    if isinstance(tree, ast.Lambda):
        return None
    return next((name for name in free_names(tree) if name.id in USERDATA), None)


def is_value(tree: ast.expr) -> bool:
    """Whether code certainly gives no function. Silent about names and calls of unknown code."""
    if userdata_outside(tree) is not None:
        return True
    match tree:
        case ast.Lambda() | ast.Name() | ast.Attribute() | ast.Subscript() | ast.Await():
            return False
        case ast.Call(func=ast.Name(id=name)):
            from smachac.analysis.expression_types import RESULTS

            return name in RESULTS
        case ast.Call() | ast.NamedExpr():
            return False
        case ast.IfExp(body=then, orelse=otherwise):
            return is_value(then) and is_value(otherwise)
        case ast.BoolOp(values=values):
            return all(map(is_value, values))
    return True


def parameters(tree: ast.Lambda) -> list[ast.arg]:
    """The arguments of a lambda that a call can give by place."""
    return [*tree.args.posonlyargs, *tree.args.args]


def accepts(tree: ast.Lambda, count: int) -> bool:
    """Whether a lambda can be called with so many arguments by place."""
    args, most = tree.args, len(parameters(tree))
    if any(default is None for default in args.kw_defaults):
        return False
    return most - len(args.defaults) <= count and (args.vararg is not None or count <= most)


def called_with_userdata(text: str) -> bool:
    """Whether code is a lambda that needs one argument."""
    tree = script_code(text).tree
    return isinstance(tree, ast.Lambda) and accepts(tree, 1) and not accepts(tree, 0)


def userdata_parameter(slot: CodeSlot) -> str | None:
    """The name by which the lambda in a slot has the userdata; None if there is none."""
    tree = slot.tree
    if slot.arguments is None or "userdata" not in slot.arguments:
        return None
    if not isinstance(tree, ast.Lambda) or not accepts(tree, len(slot.arguments)):
        return None
    if swapped([parameter.arg for parameter in parameters(tree)], slot.arguments):  # SM317
        return None
    at, names = slot.arguments.index("userdata"), parameters(tree)
    return names[at].arg if at < len(names) else None


def swapped(own: Sequence[str], due: tuple[str, ...]) -> tuple[str, ...]:
    """The names of the parameters of a function, if they are those of its state in another
    order."""
    meant = [next((name for name in due if means(arg, name)), "") for arg in own]
    return tuple(own) if tuple(meant) != due and sorted(meant) == sorted(due) else ()


def means(own: str, argument: str) -> bool:
    """Whether a name is that of an argument, its first letters, or a usual abbreviation of it."""
    if argument == "userdata":
        return own in USERDATA
    return (len(own) > 2 and argument.startswith(own)) or own == {"message": "msg"}.get(argument)


def undeclared_slot_reads(
    leaf: Leaf, types: Mapping[str, StateType]
) -> Iterator[tuple[str, Expression]]:
    """The keys that functions of a leaf, other than callbacks and conditions, read although they
    are not among its inputs."""
    inputs = {key.name for key in leaf.inputs}
    for slot in code_slots(leaf, types):
        name, tree = userdata_parameter(slot), slot.tree
        if slot.role in ("callbacks", "conditions", "output_function") or slot.quoted:
            continue
        if name is not None and isinstance(tree, ast.Lambda):
            fields = fields_of(tree.body, {name})
            for key in fields.read if fields is not None else ():
                if key not in inputs:
                    inputs.add(key)
                    yield key, slot.code


def results(tree: ast.Lambda) -> list[ast.expr]:
    """The expressions whose value a lambda can return."""
    found: list[ast.expr] = []
    todo = [tree.body]
    while todo:
        match todo.pop():
            case ast.IfExp(body=then, orelse=otherwise):
                todo += [otherwise, then]
            case other:
                found.append(other)
    return found


def is_condition(slot: CodeSlot) -> bool:
    """Whether a state judges the result of its code as true or false."""
    return slot.role == "conditions" or (slot.name == "cond_cb" and slot.returns == "value")
