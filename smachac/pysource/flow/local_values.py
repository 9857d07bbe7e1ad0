"""Local variables of `execute`: those that it assigns and does not use, and those that have a value
at a place."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet

from smachac.diagnostics.source import Span, Word
from smachac.pysource.modules.modules import OwnClass
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code


def text_of(own: OwnClass, function: ast.FunctionDef) -> PythonText:
    """The text with a method of a class."""
    return next(module.text for module, node in own.classes if function in node.body)


def unused_values(own: OwnClass, function: ast.FunctionDef) -> tuple[tuple[str, Word], ...]:
    """The local variables that `execute` assigns and does not use, with the key of each."""
    text = text_of(own, function)
    userdata = function.args.args[1].arg
    names = [name for name in walk_code(function) if isinstance(name, ast.Name)]
    used = {name.id for name in names if not isinstance(name.ctx, ast.Store)}
    assigned = [node.targets[0] for node in walk_code(function)
                if isinstance(node, ast.Assign) and len(node.targets) == 1]  # fmt: skip
    local = tuple(
        (node.id, Word(f"{userdata}.{node.id}", text.span(node)))
        for node in assigned
        if isinstance(node, ast.Name) and node.id not in used
    )
    read = {
        attribute.attr
        for _, node in own.classes
        for attribute in walk_code(node)
        if isinstance(attribute, ast.Attribute)
        and not isinstance(attribute.ctx, ast.Store)
        and not (isinstance(attribute.value, ast.Name) and attribute.value.id == userdata)
    }
    kept = tuple(
        (node.attr, Word(f"{userdata}.{node.attr}", text.span(node)))
        for node in assigned
        if isinstance(node, ast.Attribute) and node.attr not in read
        and isinstance(node.value, ast.Name) and node.value.id == "self"
    )  # fmt: skip
    return (*kept, *local)


def local_values(text: PythonText, function: ast.FunctionDef) -> tuple[Word, ...]:
    """The local variables that a function assigns, each with the code in which it has a value: from
    behind the assignment to the end of its block."""
    return tuple(_local_values(text, function.body))


def _local_values(text: PythonText, block: Sequence[ast.stmt]) -> Iterator[Word]:
    end = text.span(block[-1]).end
    for node in block:
        place = text.span(node)
        for name in _assigned(node):
            yield Word(name, Span(place.source, place.end, end))
        match node:
            case ast.If() | ast.For() | ast.While():
                inner = [node.body, node.orelse]
            case ast.With():
                inner = [node.body]
            case ast.Try():
                inner = [
                    node.body,
                    node.orelse,
                    node.finalbody,
                    *(one.body for one in node.handlers),
                ]
            case _:
                inner = []
        for part in inner:
            if part:
                yield from _local_values(text, part)


def _assigned(node: ast.stmt) -> list[str]:
    """The names to which a statement assigns."""
    match node:
        case ast.Assign(targets=targets):
            parts = [
                part
                for target in targets
                for part in (target.elts if isinstance(target, ast.Tuple) else [target])
            ]
        case ast.AnnAssign(target=target, value=ast.expr()):
            parts = [target]
        case _:
            parts = []
    return [part.id for part in parts if isinstance(part, ast.Name)]


def overwritten(nodes: Sequence[ast.AST], name: str) -> frozenset[ast.expr]:
    """The targets of assignments of a local variable that no `return` can see: a later statement of
    the same block assigns the variable on every path. `nodes` are those of a function, each before
    the nodes in it."""
    returning = _around(nodes, ast.Return)
    assigning: set[ast.AST] = set()
    for node in reversed(nodes):
        if _assigns(node, name, assigning):
            assigning.add(node)
    found: set[ast.expr] = set()
    for node in nodes:
        for block in _blocks(node):
            last: list[ast.expr] = []
            for statement in block:
                if statement in returning:
                    last = []
                elif statement in assigning:
                    found.update(last)
                    last = []
                if isinstance(statement, ast.Assign | ast.AnnAssign):
                    last += _targets_of(statement, name)
    return frozenset(found)


def _around(nodes: Sequence[ast.AST], kind: type[ast.AST]) -> set[ast.AST]:
    """The nodes of a kind, and those around them."""
    parents = {inner: node for node in nodes for inner in ast.iter_child_nodes(node)}
    found: set[ast.AST] = set()
    for node in nodes:
        at = node if isinstance(node, kind) else None
        while at is not None and at not in found:
            found.add(at)
            at = parents.get(at)
    return found


def _blocks(node: ast.AST) -> list[list[ast.stmt]]:
    """The blocks of statements in a node."""
    parts = (getattr(node, part, None) for part in ("body", "orelse", "finalbody"))
    return [part for part in parts if isinstance(part, list)]


def _assigns(node: ast.AST, name: str, assigning: AbstractSet[ast.AST]) -> bool:
    """Whether a statement assigns a variable on every path through it; `assigning` are the
    statements in it that do."""
    match node:
        case ast.Assign() | ast.AnnAssign(value=ast.expr()):
            return bool(_targets_of(node, name))
        case ast.If(body=body, orelse=orelse):
            blocks = [body, orelse]
        case ast.With(body=body):
            blocks = [body]
        case ast.Match(cases=[*_, ast.match_case(pattern=ast.MatchAs(pattern=None), guard=None)]):
            blocks = [case.body for case in node.cases]
        case _:
            return False
    return all(any(part in assigning for part in block) for block in blocks)


def _targets_of(node: ast.Assign | ast.AnnAssign, name: str) -> list[ast.expr]:
    """The targets of an assignment that are a variable."""
    return [target for target in assignment_targets(node)
            if isinstance(target, ast.Name) and target.id == name]  # fmt: skip


def assignment_targets(node: ast.Assign | ast.AnnAssign) -> list[ast.expr]:
    """The targets of an assignment."""
    return node.targets if isinstance(node, ast.Assign) else [node.target]
