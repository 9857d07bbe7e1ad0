"""The items of an Iterator as an argument of the containers for other executives."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.ir import nodes
from smachac.ir.nodes import Expression, Machine
from smachac.ir.python_code import parse_code
from smachac.ir.traversal import walk
from smachac.targets.errors import unsupported_by_target
from smachac.targets.python.formatter import Doc, literal, string


def refused_items(machine: Machine, target: str) -> Iterator[Diagnostic]:
    """A finding for items whose code needs names of the program, which a container has not."""
    for path, node in walk(machine.root):
        if isinstance(node, nodes.Iterator) and node.items is not None:
            data = node.items.data
            if isinstance(data, Expression) and _function(data) is None:
                message = f"the items `{data.text}` need names of the program"
                help_ = "write the items in userdata, and their key as `it`"
                yield unsupported_by_target(node.items.span, target, message, help_, (path,))


def items(node: nodes.Iterator) -> Doc:
    """The items: a list, or a function of the userdata of the container."""
    if node.items_key:
        return f"lambda ud: ud[{string(node.items_key)}]"
    if node.items is None:
        return "()"
    data = node.items.data
    return _function(data) or "()" if isinstance(data, Expression) else literal(data)


def _function(code: Expression) -> str | None:
    """The code of items as a function of userdata; None if it needs other names."""
    try:
        tree = parse_code(code.text.strip())
    except SyntaxError:
        return None
    parts = [*ast.walk(tree)]
    used = [node for node in parts if isinstance(node, ast.Name)]
    bound = {node.arg for node in parts if isinstance(node, ast.arg)}
    bound |= {node.id for node in used if not isinstance(node.ctx, ast.Load)}
    text = code.text.strip()
    if not isinstance(tree, ast.Lambda):
        parameter = "userdata" if any(name.id == "userdata" for name in used) else "ud"
        bound.add(parameter)
        text = f"lambda {parameter}: {text}"
    elif not tree.args.args:
        text = f"lambda ud: ({text})()"
    return text if all(name.id in bound or hasattr(builtins, name.id) for name in used) else None
