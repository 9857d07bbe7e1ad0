"""The call that adds a state to its container, in the text that a template of the user prints.

Such a template knows neither `error_as_outcome`, for a state that catches its exceptions, nor
`set_contained_state`, which an Iterator has in place of `add`: both are put into the text here.
"""

from __future__ import annotations

import ast

from smachac.ir.nodes import Concurrence, Container, Iterator, Node, Sequence, StateMachine
from smachac.ir.python_code import parse_module
from smachac.records import dataclass
from smachac.targets.python import structure
from smachac.targets.python.formatter import flat


class NotAddedError(Exception):
    """The call is not in the text, or lacks an argument; the message completes a sentence about the
    template."""


class OtherContainerError(Exception):
    """The call adds the state to a container of another kind; `words` is its function."""

    def __init__(self, words: str) -> None:
        super().__init__(words)
        self.words = words


_ADDING = ("StateMachine", "Sequence", "Concurrence")
"""The classes of SMACH with a function `add`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _AddCall:
    """The places of the call and of its argument for the state. `complete`: it was printed by a
    template of smachac, so that nothing is missing in it."""

    call: slice
    state: slice
    complete: bool


def adapted(text: str, node: Node, parent: Container, depth: int, used: dict[str, None]) -> str:
    """The text that a template prints for a state, completed for an Iterator and for a state that
    catches its exceptions; `used` gets the functions around the state. Raises NotAddedError and
    OtherContainerError."""
    _check_owner(text, node, parent)
    in_iterator = isinstance(parent, Iterator)
    if not in_iterator and not node.catches:
        return text
    found = _find(text, node.name)
    if found.complete:
        return text
    made = structure.made(node, text[found.state], used)
    if in_iterator:
        line = structure.add(node, parent, made, depth)
        return f"{text[: found.call.start]}{line}{text[found.call.stop :]}"
    outcomes = [edge.outcome for edge in node.transitions]
    if not isinstance(parent, Concurrence) and node.catches in outcomes:
        quoted = (f"'{node.catches}'", f'"{node.catches}"')
        if not any(word in text[found.call] for word in quoted):
            raise NotAddedError(f"does not print the transition of `{node.catches}`")
    start, end = found.state.start, found.state.stop
    return f"{text[:start]}{flat(made)}{text[end:]}"


def _check_owner(text: str, node: Node, parent: Container) -> None:
    """Raises OtherContainerError if the call in a text is one for another kind of container.

    SMACH accepts `StateMachine.add` in a Sequence, where no outcome then leads to the next state:
    that is right if the script writes where each outcome leads.
    """
    own = structure.kind(parent)
    others = [word for word in _ADDING if word != own and f"smach.{word}.add(" in text]
    if isinstance(parent, Iterator) or not others:
        return
    if isinstance(parent, Sequence) and all(
        transition.origin == "written" for transition in node.transitions
    ):
        others = [other for other in others if other != StateMachine.__name__]
    try:
        tree = parse_module(text)
    except SyntaxError:
        return
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and _state_of(call, node.name) is not None:
            match call.func:
                case ast.Attribute(
                    value=ast.Attribute(value=ast.Name(id="smach"), attr=kind), attr="add"
                ) if kind in others:
                    raise OtherContainerError(f"smach.{kind}.add")


def _find(text: str, name: str) -> _AddCall:
    """The call that adds the state of a name."""
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
        for call in ast.walk(parse_module(text))
        if isinstance(call, ast.Call) and (state := _state_of(call, name)) is not None
    ]
    if len(found) != 1:
        raise NotAddedError("prints no line `smach.{{ parent_type }}.add('{{ name }}', ...)`")
    call, state = found[0]
    return _AddCall(call=span(call), state=span(state), complete=_is_complete(call, state))


def _state_of(call: ast.Call, name: str) -> ast.expr | None:
    """The argument for the state of a call that adds a state under a name; None for other calls."""
    if not isinstance(call.func, ast.Attribute):
        return None
    if call.func.attr not in ("add", "set_contained_state"):
        return None
    given = dict(zip(("label", "state"), call.args, strict=False))
    given |= {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg}
    match given.get("label"):
        case ast.Constant(value=value) if value == name:
            return given.get("state")
    return None


def _is_complete(call: ast.Call, state: ast.expr) -> bool:
    """Whether `structure.add` has printed the call, as `State.tpl.py` does."""
    match call.func, state:
        case ast.Attribute(attr="set_contained_state"), _:
            return True
        case _, ast.Call(func=ast.Name(id="error_as_outcome")):
            return True
    return False
