"""Traversal of the state graph: nodes with their paths, and the outcomes, expressions and remapped
keys of one node. All in the order of the script."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from smachac.ir.nodes import (
    Concurrence,
    Container,
    Data,
    Expression,
    Key,
    Leaf,
    Node,
    Struct,
    Transition,
    Value,
)
from smachac.ir.nodes import Iterator as IteratorNode


def walk(node: Node, path: str = "") -> Iterator[tuple[str, Node]]:
    """A node and all nodes below it with their paths, parents before children.

    Iterative, so that deep nesting needs no recursion.
    """
    stack: list[tuple[str, Node]] = [(path or node.name, node)]
    while stack:
        here, current = stack.pop()
        yield here, current
        if not isinstance(current, Leaf):
            stack.extend((f"{here}/{child.name}", child) for child in reversed(current.children))


def enclosing(node: Node) -> dict[str, tuple[str, Container]]:
    """The container around each node below a node, with its path, by the path of the node. Paths
    are not taken apart: a name of a state that is reported may have a `/`."""
    return {
        f"{path}/{child.name}": (path, container)
        for path, container in containers(node)
        for child in container.children
    }


def containers(node: Node) -> Iterator[tuple[str, Container]]:
    """The containers of `walk(node)`, without the cost of visiting leaves."""
    stack = [] if isinstance(node, Leaf) else [(node.name, node)]
    while stack:
        here, current = stack.pop()
        yield here, current
        for child in reversed(current.children):
            if not isinstance(child, Leaf):
                stack.append((f"{here}/{child.name}", child))


def outcome_names(node: Node) -> tuple[str, ...]:
    """The names of the declared outcomes of a node."""
    return tuple([outcome.name for outcome in node.outcomes])


def own_outcomes(node: Node) -> tuple[str, ...]:
    """The outcomes that the state's own code can return: all except `catches`."""
    return tuple([outcome.name for outcome in node.outcomes if outcome.name != node.catches])


def ends_preempted(node: Node) -> bool:
    """Whether a node is the container of a `timeout`, `retry` or `for_each`.

    After a request to stop, such a container ends with `preempted`, whatever the outcome of its
    state is (docs/semantics.md, Preemption).
    """
    return isinstance(node, Concurrence | IteratorNode) and node.sugar != ""


def leads_to_child(transition: Transition, children: frozenset[str]) -> bool:
    """Whether a transition leads to one of `children`, not out of their container (see
    Transition)."""
    return transition.origin != "implicit" and transition.target in children


def expressions(node: Node) -> Iterator[Expression]:
    """The expressions in the values of one node, in the order of the script."""
    for value in values(node):
        yield from expressions_in(value.data)


def values(node: Node) -> Iterator[Value]:
    """The values of one node that may contain code, in the order of the script."""
    for entry in node.variables if isinstance(node, Leaf) else node.userdata:
        yield entry.value
    if isinstance(node, IteratorNode) and node.items is not None:
        yield node.items


def expressions_in(data: Data) -> Iterator[Expression]:
    """The expressions in a value, in the order of the script."""
    match data:
        case Expression():
            yield data
        case Struct(entries=entries):
            for _, value in entries:
                yield from expressions_in(value)
        case tuple():
            for value in data:
                yield from expressions_in(value)


class OuterNames(dict[str, str]):
    """The names of a node's keys in its container, by its own names. A key that is not remapped has
    its own name there."""

    def __missing__(self, key: str) -> str:
        return key


def remapping(node: Node) -> OuterNames:
    """The remapped keys of a node: from its own name of the key to the name in its container."""
    return OuterNames({remap.key: remap.to for remap in node.remaps} if node.remaps else ())


def outer_inputs(node: Node) -> list[str]:
    """The names in its container of the inputs of a node."""
    return _outer(node, node.inputs)


def outer_outputs(node: Node) -> list[str]:
    """The names in its container of the outputs of a node."""
    return _outer(node, node.outputs)


def _outer(node: Node, keys: Iterable[Key]) -> list[str]:
    if not node.remaps:
        return [key.name for key in keys]
    names = remapping(node)
    return [names[key.name] for key in keys]


def inputs_from(node: Node, key: str) -> list[Key]:
    """The inputs of a node that are copied from a key of its container."""
    return [own for own, outer in zip(node.inputs, outer_inputs(node), strict=True) if outer == key]


def outputs_to(node: Node, key: str) -> list[Key]:
    """The outputs of a node that are copied to a key of its container."""
    return [
        own for own, outer in zip(node.outputs, outer_outputs(node), strict=True) if outer == key
    ]
