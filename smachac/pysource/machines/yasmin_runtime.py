"""The classes of `smachac_yasmin`, the module that the programs of `--target yasmin` import, as the
evaluator models them: a generated module is read as the machine of its script.

The states are objects of the SMACH program, so that their keys are not known, and their outcomes
are those of their transitions.
"""

from __future__ import annotations

from collections.abc import Mapping

from smachac.diagnostics.source import Span
from smachac.pysource.machines.framework import (
    Run,
    add_child,
    classes,
    copied,
    make_container,
    set_interface,
    together,
)
from smachac.pysource.machines.heap import Added
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Arguments,
    Const,
    DictValue,
    Instance,
    Interpreter,
    Native,
    TupleValue,
    Value,
    sequence,
)

NAME = "smachac_yasmin"
"""The name of the module, which lies beside the programs, in a package or not."""


def _named(arguments: Arguments, name: str, default: Value = NONE) -> Value:
    return arguments.get(-1, name, default) or default


def _made(kind: str, evaluator: Interpreter, arguments: Arguments) -> Instance | None:
    """Makes an object a container with the name, outcomes and keys of its arguments; None if there
    is no object."""
    me, path = arguments.get(0, "self"), arguments.get(1, "path")
    if not isinstance(me, Instance):
        return None
    caught = _named(arguments, "catches")
    more = TupleValue(() if caught == NONE else (caught,))
    nothing = TupleValue(())
    inputs, outputs = (_named(arguments, name, nothing) for name in ("inputs", "outputs"))
    outcomes = together(_named(arguments, "outcomes", UNKNOWN), more)
    set_interface(evaluator, me, outcomes, inputs, outputs)
    make_container(evaluator, me, kind)
    if isinstance(path, Const):
        name = Const(str(path.value).rpartition("/")[2])
        evaluator.heap.set(me.slots, "$name", name)
    return me


def _machine(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    _made("StateMachine", evaluator, arguments)
    return NONE


def _concurrence(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = _made("Concurrence", evaluator, arguments)
    if me is None:
        return NONE
    pairs = [sequence(rule) or () for rule in sequence(_named(arguments, "rules")) or ()]
    rules = {at: (pair[0], pair[1]) for at, pair in enumerate(pairs) if len(pair) == 2}
    evaluator.heap.set(me.slots, "$outcome_map", DictValue({"items": rules}))
    evaluator.heap.set(me.slots, "$default_outcome", _named(arguments, "default"))
    if _named(arguments, "first_ends") == Const(True):
        ends = Native("first ends", lambda evaluator, arguments, span: Const(True))
        evaluator.heap.set(me.slots, "$child_termination_cb", ends)
    return NONE


def _repeat(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = _made("Iterator", evaluator, arguments)
    if me is not None:
        slots = {"items": "$it", "item": "$it_label", "again": "$again",
                 "exhausted": "$exhausted_outcome", "renamed": "$renamed"}  # fmt: skip
        for name, slot in slots.items():
            evaluator.heap.set(me.slots, slot, _named(arguments, name))
    return NONE


def _add(at: int) -> Run:
    """A method that adds a state; `at` is the place of the remapping, before which a state machine
    has the transitions."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me, name = arguments.get(0, "self"), arguments.get(1, "name", UNKNOWN) or UNKNOWN
        state = arguments.get(2, "state", UNKNOWN) or UNKNOWN
        evaluator.adds += 1
        if span is None or not isinstance(me, Instance):
            return NONE
        is_machine = at > 3
        if is_machine and name in (sequence(me.slots.get("$outcomes")) or ()):
            name = Const(f"{name.value!s} (state)") if isinstance(name, Const) else name
        added = Added(
            label=name, state=state, span=span, kind="add" if is_machine else "concurrence",
            transitions=copied(arguments.get(3, "transitions")) if is_machine else None,
            remapping=copied(arguments.get(at, "remapping")), loop=me.slots.get("$again"),
            final=me.slots.get("$renamed"),
        )  # fmt: skip
        add_child(evaluator, me, added)
        return NONE

    return run


def _set_start(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me, name = arguments.get(0, "self"), arguments.get(1, "name", UNKNOWN) or UNKNOWN
    if isinstance(me, Instance):
        evaluator.heap.set(me.slots, "$initial", TupleValue((name,)))
    return NONE


def _unknown(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return UNKNOWN


MODULE: Mapping[str, Value] = {
    **classes(NAME, "Machine Concurrence Repeat"),
    **{name: Native(name, _unknown) for name in ("Skill", "Native", "Program")},
}
CONTAINERS = frozenset(f"{NAME}.{name}" for name in ("Machine", "Concurrence", "Repeat"))
METHODS: Mapping[str, Mapping[str, Run]] = {
    f"{NAME}.Machine": {"__init__": _machine, "add": _add(4), "set_start_state": _set_start},
    f"{NAME}.Concurrence": {"__init__": _concurrence, "add": _add(3)},
    f"{NAME}.Repeat": {"__init__": _repeat, "add": _add(-1)},
}
