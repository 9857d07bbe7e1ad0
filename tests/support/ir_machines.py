"""Builders of IR nodes with short arguments, and runs of them in the interpreter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from smachac.diagnostics.source import NOWHERE
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Behaviour, Event, InterpreterResult
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Expression,
    Iterator,
    Key,
    Leaf,
    Machine,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    Sequence,
    StateMachine,
    Struct,
    Transition,
    Value,
    Variable,
)
from tests.support.typed_machines import as_built_in


def data(value: Any) -> Data:
    """Plain Python data as data of a script; a string in backticks is an expression."""
    if isinstance(value, list):
        return tuple(data(item) for item in value)
    if isinstance(value, dict):
        return Struct(entries=tuple((key, data(item)) for key, item in value.items()))
    if isinstance(value, str) and value[:1] == value[-1:] == "`":
        return Expression(text=value[1:-1], span=NOWHERE)
    assert value is None or isinstance(value, bool | int | float | str)
    return value


def value(given: Any) -> Value:
    return Value(data=data(given), span=NOWHERE)


def _common(
    outcomes: str, to: Mapping[str, str], ins: str, outs: str, remaps: Mapping[str, str]
) -> dict[str, Any]:
    return {
        "span": NOWHERE,
        "outcomes": tuple(Outcome(name=name, span=NOWHERE) for name in outcomes.split()),
        "inputs": tuple(Key(name=name, span=NOWHERE) for name in ins.split()),
        "outputs": tuple(Key(name=name, span=NOWHERE) for name in outs.split()),
        "transitions": tuple(
            Transition(
                outcome=name,
                target=target.removeprefix("="),
                origin="implicit" if target.startswith("=") else "written",
                span=NOWHERE,
            )
            for name, target in to.items()
        ),
        "remaps": tuple(Remap(key=key, to=outer, span=NOWHERE) for key, outer in remaps.items()),
    }


def _held(presets: Mapping[str, Any]) -> tuple[Preset, ...]:
    return tuple(
        Preset(key=key, value=value(given), span=NOWHERE) for key, given in presets.items()
    )


def leaf(
    name: str,
    to: Mapping[str, str] = {},
    *,
    outcomes: str = "",
    type: str = "Unknown",
    ins: str = "",
    outs: str = "",
    remaps: Mapping[str, str] = {},
    open: bool = False,
    **variables: Any,
) -> Leaf:
    """A leaf; `to` maps outcomes to targets (`=target` for an implicit edge)."""
    made = Leaf(
        name=name,
        type=type,
        open=open,
        variables=tuple(
            Variable(name=key, value=value(given), span=NOWHERE) for key, given in variables.items()
        ),
        **_common(outcomes or " ".join(to), to, ins, outs, remaps),
    )
    return as_built_in(made)


def machine(
    name: str,
    outcomes: str,
    *children: Node,
    to: Mapping[str, str] = {},
    ins: str = "",
    outs: str = "",
    remaps: Mapping[str, str] = {},
    held: Mapping[str, Any] = {},
    initial: str = "",
) -> StateMachine:
    return StateMachine(
        name=name,
        type="StateMachine",
        children=children,
        userdata=_held(held),
        initial=initial or (children[0].name if children else ""),
        **_common(outcomes, to, ins, outs, remaps),
    )


def sequence(
    name: str, outcomes: str, connector: str, *children: Node, to: Mapping[str, str] = {}
) -> Sequence:
    return Sequence(
        name=name,
        type="Sequence",
        children=children,
        connector_outcome=connector,
        initial=children[0].name,
        **_common(outcomes, to, "", "", {}),
    )


def concurrence(
    name: str,
    outcomes: str,
    *children: Node,
    default: str,
    rules: tuple[tuple[str, Mapping[str, str]], ...] = (),
    join: Any = "all",
    to: Mapping[str, str] = {},
    ins: str = "",
    outs: str = "",
    remaps: Mapping[str, str] = {},
    held: Mapping[str, Any] = {},
) -> Concurrence:
    return Concurrence(
        name=name,
        type="Concurrence",
        children=children,
        default_outcome=default,
        join=join,
        userdata=_held(held),
        rules=tuple(
            OutcomeRule(
                outcome=outcome,
                when=tuple(
                    Condition(child=child, outcome=ended, span=NOWHERE)
                    for child, ended in when.items()
                ),
                span=NOWHERE,
            )
            for outcome, when in rules
        ),
        **_common(outcomes, to, ins, outs, remaps),
    )


def iterator(
    name: str,
    outcomes: str,
    *children: Node,
    items: Any = None,
    items_key: str = "",
    item_key: str = "it_data",
    exhausted: str = "exhausted",
    loop: str = "",
    final: Mapping[str, str] = {},
    to: Mapping[str, str] = {},
    ins: str = "",
    outs: str = "",
    remaps: Mapping[str, str] = {},
    held: Mapping[str, Any] = {},
) -> Iterator:
    return Iterator(
        name=name,
        type="Iterator",
        children=children,
        items=None if items is None else value(items),
        items_key=items_key,
        item_key=item_key,
        exhausted_outcome=exhausted,
        loop_outcomes=tuple(loop.split()),
        final_map=tuple(final.items()),
        userdata=_held(held),
        **_common(outcomes, to, ins, outs, remaps),
    )


Act = dict[str, Any]
"""What leaves do: by name an outcome, a list of outcomes by visit (the last repeats), or a function
of the userdata to an outcome."""


def acting(acts: Act) -> Behaviour:
    """A behaviour of leaves by their names; a leaf not named ends with its first outcome."""

    def behave(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
        act = acts.get(node.name, node.outcomes[0].name)
        if isinstance(act, list):
            act = act[min(visit, len(act)) - 1]
        return str(act(userdata)) if callable(act) else str(act)

    return behave


def ran(
    root: StateMachine, acts: Act | Behaviour | None = None, **options: Any
) -> tuple[InterpreterResult, list[Event]]:
    """A run of a machine and its events."""
    events: list[Event] = []
    behaviour = acts if callable(acts) else acting(acts or {})
    return run(Machine(root=root), behaviour, events.append, **options), events


def short(events: list[Event]) -> list[str]:
    """Events as words: `enter sm/A`, `exit sm/A succeeded`, `transition sm/A done -> sm:done`."""
    lines = []
    for event in events:
        words = [event["event"], event["path"]]
        words += [str(event[name]) for name in ("outcome", "key", "message") if name in event]
        words += [repr(event["value"])] if "value" in event else []
        words += ["->", event["to"]] if "to" in event else []
        lines.append(" ".join(words))
    return lines
