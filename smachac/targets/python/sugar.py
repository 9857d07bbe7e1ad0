"""Time limits and retries as calls around a state: `with_timeout(Drive(), 300.0, "DRIVE")`.

The functions (runtime/additions.py) build the containers of frontend/script/desugar.py. A container
that differs from theirs, and one with a state that a template of the user adds, is printed as a
container of SMACH.
"""

from __future__ import annotations

from collections.abc import Callable

from smachac.ir.nodes import Concurrence, Container, Data, Iterator, Leaf, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.records import dataclass
from smachac.targets.python.formatter import Doc, call, literal, names, string

Value = Callable[[str, str, Data], Doc]
"""The code of a value: of the path of a state, the name of the value, and its data."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Layer:
    """A container of sugar around a state: its node, the function that makes it, and the arguments
    after the state."""

    node: Container
    function: str
    arguments: list[tuple[str, Doc]]


def layers(node: Node, path: str, value: Value) -> tuple[list[Layer], Node, str]:
    """The containers of sugar around a state that are calls, the inner one first; the state and its
    path."""
    found: list[Layer] = []
    while True:
        match node:
            case Concurrence(sugar="timeout", children=(inner, Leaf(name="TIMER") as timer)):
                seconds = value(f"{path}/TIMER", "time", timer.variables[0].value.data)
                arguments = [("", seconds), ("", string(inner.name))]
                found.append(Layer(node=node, function="with_timeout", arguments=arguments))
            case Iterator(
                sugar="retry",
                item_key="pause",
                children=(StateMachine(sugar="retry", name="TRY", children=(pause, inner)),),
            ) if pause.name == "PAUSE":
                path += "/TRY"
                arguments = _retries(node, inner, pause)
                found.append(Layer(node=node, function="with_retries", arguments=arguments))
            case Iterator(sugar="retry", item_key="attempt", children=(inner,)):
                arguments = _retries(node, inner)
                found.append(Layer(node=node, function="with_retries", arguments=arguments))
            case _:
                return found[::-1], node, path
        path += f"/{inner.name}"
        node = inner


def _retries(loop: Iterator, inner: Node, pause: Node | None = None) -> list[tuple[str, Doc]]:
    """The arguments of `with_retries` after the state. A stopped pause ends the try as `preempted`,
    or with the first outcome that leads to a new try."""
    assert loop.items is not None
    items = loop.items.data
    assert isinstance(items, tuple)
    again = list(loop.loop_outcomes)
    arguments: list[tuple[str, Doc]] = [("", repr(len(items)))]
    if pause is not None:
        stopped = next(edge.target for edge in pause.transitions if edge.outcome == PREEMPTED)
        again.sort(key=lambda outcome: outcome != stopped)
    arguments.append(("on=", names(again)))
    if pause is not None:
        arguments.append(("delay=", literal(items[-1])))
    return [*arguments, ("label=", string(inner.name))]


def wrapped(made: Doc, around: list[Layer], used: dict[str, None]) -> Doc:
    """The expression for a state, inside the calls of its sugar; `used` gets their functions."""
    for layer in around:
        used[layer.function] = None
        made = call(layer.function, [("", made), *layer.arguments])
        if layer.node.catches:
            used["error_as_outcome"] = None
            made = call("error_as_outcome", [("", made), ("", string(layer.node.catches))])
    return made
