"""The line by which a template of the user's adds its state, found in what it prints: there a state
comes to catch its exceptions, and to stand in an Iterator, for which SMACH has no `add`.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass

from smachac.ir.nodes import Concurrence, Container, Iterator, Node
from smachac.targets.python import structure
from smachac.targets.python.formatter import flat


class NotAddedError(Exception):
    """The line is not to be found, or does not do what it has to; the words say what is missing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Added:
    """Where the line stands in the text, and the state in it."""

    line: slice
    state: slice


def adapted(text: str, node: Node, parent: Container, depth: int) -> str:
    """What a template prints for a state, with what it cannot know of. Raises NotAddedError."""
    inside = isinstance(parent, Iterator)
    if not inside and not node.catches:
        return text
    if "error_as_outcome(" in text or "set_contained_state(" in text:
        return text  # printed by `State.tpl.py`, which has it from us
    found = _find(text, node.name)
    made = structure.made(node, text[found.state])
    if inside:
        line = structure.add(node, parent, made, depth)
        return f"{text[: found.line.start]}{line}{text[found.line.stop :]}"
    led = [edge.outcome for edge in node.transitions]
    if not isinstance(parent, Concurrence) and node.catches in led:
        quoted = (f"'{node.catches}'", f'"{node.catches}"')
        if not any(each in text[found.line] for each in quoted):
            raise NotAddedError(f"does not print the transition of `{node.catches}`")
    start, end = found.state.start, found.state.stop
    return f"{text[:start]}{flat(made)}{text[end:]}"


def _find(text: str, name: str) -> _Added:
    """The call of `add` with the name of the state."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    lines = text.splitlines()

    def at(line: int, column: int) -> int:
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    def span(node: ast.expr) -> slice:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return slice(at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset))

    found = [
        (call, state)
        for call in ast.walk(ast.parse(text))
        if isinstance(call, ast.Call) and (state := _state_of(call, name)) is not None
    ]
    if len(found) != 1:
        raise NotAddedError("prints no line `smach.{{ parent_type }}.add('{{ name }}', ...)`")
    call, state = found[0]
    return _Added(line=span(call), state=span(state))


def _state_of(call: ast.Call, name: str) -> ast.expr | None:
    """The state that a call adds under a name."""
    if not isinstance(call.func, ast.Attribute) or call.func.attr != "add":
        return None
    given = dict(zip(("label", "state"), call.args, strict=False))
    given |= {each.arg: each.value for each in call.keywords if each.arg}
    match given.get("label"):
        case ast.Constant(value=value) if value == name:
            return given.get("state")
    return None
