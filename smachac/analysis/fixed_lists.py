"""Fixed lists and mappings: initial values of userdata whose length no state can change.

A list is passed on by reference (docs/semantics.md, Userdata), so each state that can reach it can
make it longer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from smachac.analysis.expression_types import body_of
from smachac.analysis.type_inference import Cell
from smachac.ir import nodes
from smachac.ir.expressions import Attribute, Call, Compare, Constant, Expr, Index, Name, parts
from smachac.ir.nodes import Leaf, StateType, Struct
from smachac.ir.script_code import script_code
from smachac.ir.traversal import expressions

READERS = frozenset(["bool", "len", "list", "max", "min", "sorted", "str", "sum", "tuple"])
"""Functions that read a list without changing it or returning it."""

MOST_CELLS = 100
"""The most keys through which a list is followed."""


def has_fixed_length(cell: Cell) -> bool:
    """Whether the lists in a key are initial values that every state leaves as long as they are."""
    return _is_initial(cell, _leaves)


def lacks_entry(cell: Cell, entry: str, state_types: Mapping[str, StateType]) -> bool:
    """Whether the values in a key are initial mappings without an entry, which no state adds."""
    values = [flow.origin.value for alike in cell.flows.values() for flow in alike]
    for value in values:
        if not isinstance(value, Struct) or any(name == entry for name, _ in value.entries):
            return False

    def leaves(leaf: Leaf, key: str) -> bool:
        facts = state_types[leaf.type].class_facts if leaf.type in state_types else None
        added = facts.entries if facts is not None and not leaf.open else None
        return _leaves(leaf, key) if added is None else entry not in added

    return _is_initial(cell, leaves)


def _is_initial(cell: Cell, leaves: Callable[[Leaf, str], bool]) -> bool:
    """Whether the values in a key are initial values, and every leaf leaves them as they are."""
    flows = [flow.origin for alike in cell.flows.values() for flow in alike]
    if not flows or any(flow.how != "value" or flow.cell.role != "scope" for flow in flows):
        return False
    todo = list(dict.fromkeys(flow.cell for flow in flows))
    seen = set(todo)
    for here in todo:
        if len(todo) > MOST_CELLS or not all(leaves(leaf, key) for leaf, key in _readers(here)):
            return False
        todo += [link for link in dict.fromkeys(here.links) if link not in seen]
        seen.update(here.links)
    return True


def _readers(cell: Cell) -> Iterator[tuple[Leaf, str]]:
    """The leaves that can reach the value in a cell, each with its name for it."""
    node = cell.node
    if isinstance(node, Leaf):
        yield node, cell.key
    if isinstance(node, nodes.Iterator):
        # Its child uses every key as it is (docs/semantics.md, Iterator).
        yield from ((child, cell.key) for child in node.children if isinstance(child, Leaf))


def _leaves(leaf: Leaf, key: str) -> bool:
    """Whether a leaf surely leaves a list as long as it is, and gives it no other name."""
    if not leaf.built_in or leaf.stand_in or leaf.open:
        return False
    return all(_only_reads(code.text, key) for code in expressions(leaf))


def _only_reads(text: str, key: str) -> bool:
    """Whether code over userdata uses a key only to read items or facts of it."""
    fields = script_code(text).fields
    if fields is None:
        return False
    if key not in fields.read:
        return True
    tree = script_code(text).portable
    if tree is None:
        return False
    body, parameters = body_of(tree)
    if key_of(body, parameters) == key:
        return False
    todo = [body]
    while todo:
        expr = todo.pop()
        for part in parts(expr):
            if key_of(part, parameters) != key:
                todo.append(part)
            elif not _reads(expr, part):
                return False
    return True


def _reads(expr: Expr, part: Expr) -> bool:
    """Whether an expression only reads items or facts of a list, which is a part of it."""
    match expr:
        case Index(value, _):
            return value is part
        case Attribute(value, name):  # of a mapping
            return value is part and name in ("get", "items", "keys", "values")
        case Call(Name(name), arguments, ()):
            return name in READERS and len(arguments) == 1
        case Compare():
            return True
    return False


def key_of(expr: Expr, parameters: tuple[str, ...]) -> str | None:
    """The userdata key that an expression is; None if it is another one."""
    match expr:
        case Attribute(Name(name), key) if name in parameters:
            return key
        case Index(Name(name), Constant(str() as key)) if name in parameters:
            return key
    return None
