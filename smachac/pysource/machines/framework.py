"""Tables of frameworks for state machines (`Framework`), and functions that the models of their
classes share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from smachac.diagnostics.source import Span
from smachac.pysource.flow.life_cycle import LifeCycle
from smachac.pysource.machines.heap import Added, Children
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Arguments,
    Class,
    Const,
    DictValue,
    Instance,
    Interpreter,
    LibraryClass,
    ListValue,
    TupleValue,
    UseFault,
    UseKind,
    Value,
    alternatives,
    sequence,
    truth,
)
from smachac.pysource.machines.wrong_calls import Signature
from smachac.records import dataclass, field, replace

Run = Callable[[Interpreter, Arguments, "Span | None"], Value]
"""A model of a function: what a call returns and changes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Framework:
    """A framework for state machines.

    `packages` are its top packages, `modules` the names in its modules that the evaluator models, a
    module that is not listed being the top package that it is in; `.name` is the module of a name
    in any package. `methods` are the methods of its
    classes by full name (`smach.StateMachine`), `static` those that need no object, `parameters`
    the parameters of the constructors in their order, where an import needs them, `signatures` the
    parameters of methods by full name, of those that are the same in all versions. `containers` are
    the classes of containers; `adds` are the methods that add states, and a class that overrides
    one of `overridden` changes how they are added or run. `lacking` are modules that have none of
    the names of another one, each with that one. `entries` are the methods of its classes that
    return a machine which the framework runs. `life_cycle` are the methods of a state that it
    calls.

    `same_name_exits`: an outcome without a transition ends the container if that has an outcome of
    this name. `jumps`: it leads to the state of this name, if there is one. `exits` are the
    outcomes that each container has: they need no transition, and end the containers around it too.
    `undeclared_outcomes`: a transition for an outcome that the state does not declare is accepted,
    and taken if the code returns it. `undeclared_keys`: a remapping of a key that the state does
    not have is accepted, and has no effect.
    `effects` are the codes of the rules whose errors are faults in this framework too, each with
    the effect in its terms, or an empty text for that of the rule; None: all rules are about it.
    With those in `works` a machine works all the same: only a check with all rules reports them.

    For the import: `code` is the key of its classes in the `code` of interfaces. `places` are the
    modules of classes that a script can name. `parts` are classes that only work in another one,
    each with the reason. `one_rule`: a concurrence of which two rules hold stops with an exception.
    `write_through`: the userdata of a container is made anew at each entry, from its first values,
    and what is written to its outputs is in the containers around it at once.
    `ros` is the version of ROS that its target needs, 0 for that of the code.
    """

    name: str
    packages: tuple[str, ...]
    modules: Mapping[str, Mapping[str, Value]]
    methods: Mapping[str, Mapping[str, Run]]
    containers: frozenset[str]
    adds: frozenset[str] = frozenset()
    static: frozenset[str] = frozenset()
    overridden: frozenset[str]
    parameters: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    lacking: Mapping[str, str] = field(default_factory=dict)
    signatures: Mapping[str, Signature] = field(default_factory=dict)
    entries: frozenset[str] = frozenset()
    life_cycle: LifeCycle = LifeCycle()
    same_name_exits: bool = True
    jumps: bool = False
    exits: tuple[str, ...] = ()
    undeclared_outcomes: bool = False
    undeclared_keys: bool = False
    effects: Mapping[str, str] | None = None
    works: frozenset[str] = frozenset()
    code: str
    places: Mapping[str, str] = field(default_factory=dict)
    parts: Mapping[str, str] = field(default_factory=dict)
    one_rule: bool = False
    write_through: bool = False
    ros: int = 0


def classes(prefix: str, names: str) -> dict[str, Value]:
    """Classes of a library by their short names, which `names` lists."""
    return {name: LibraryClass(f"{prefix}.{name}") for name in names.split()}


def nothing(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """A function without an effect on machines."""
    return NONE


def names_in(evaluator: Interpreter, value: Value | None, span: Span | None) -> Value:
    """A list of names. Of a text, each letter is a name: a fault."""
    if value is None:
        return TupleValue(())
    if isinstance(value, Const) and isinstance(value.value, str) and value.value and span:
        place = value.span or span
        evaluator.faults.append(UseFault("text as list", place, (value.value,)))
    return value


def together(*values: Value) -> Value:
    """The items of several lists as one list."""
    parts = [sequence(value) for value in values]
    if any(part is None for part in parts):
        return UNKNOWN
    return TupleValue(tuple(item for part in parts for item in part or ()))


def set_interface(
    evaluator: Interpreter, me: Instance, outcomes: Value, inputs: Value, outputs: Value
) -> None:
    """Sets the outcomes and keys of a state."""
    for slot, value in (("$outcomes", outcomes), ("$inputs", inputs), ("$outputs", outputs)):
        if isinstance(value, ListValue):  # a copy: the framework makes a set of it
            items = value.items
            value = TupleValue(items) if isinstance(items, tuple) else value
        evaluator.heap.set(me.slots, slot, value)
    if "$noted" not in me.slots:  # so that a call under a condition is one of several possibilities
        evaluator.heap.set(me.slots, "$noted", TupleValue(()))


def make_container(evaluator: Interpreter, me: Instance, kind: str) -> None:
    """Makes an object a container without states; `kind` is the class of IR nodes."""
    slots: dict[str, object] = {
        "$kind": Const(kind),
        "$children": Children(),
        "$initial": NONE,
        "userdata": DictValue({"items": {}, "$userdata": True}),
        "$userdata": Const(True),
    }
    for slot, value in slots.items():
        evaluator.heap.set(me.slots, slot, value)


def add_child(evaluator: Interpreter, container: Value, added: Added) -> bool:
    """Adds a state to a container; whether it is one. A key that a dictionary has twice is a
    fault."""
    if not isinstance(container, Instance):
        return False
    children = container.slots.get("$children")
    if not isinstance(children, Children):
        return False
    _judge(evaluator, added)
    whole = (*children.added, added)
    if len(whole) > MOST_STATES:
        whole = children.added
        children = Children(whole, False)
    evaluator.heap.set(container.slots, "$children", Children(whole, children.complete))
    for given in (added.transitions, added.remapping):
        for key, is_same in given.repeated if isinstance(given, DictValue) else ():
            if is_same and given is added.remapping:
                continue
            fault = UseFault("repeated key", key.span or added.span, (str(key.value),))
            if fault not in evaluator.faults:
                evaluator.faults.append(fault)
    return True


def _judge(evaluator: Interpreter, added: Added) -> None:
    """Notes a class in place of a state, and other values in place of dictionaries."""
    if not evaluator.is_certain:
        return
    if isinstance(added.state, Class | LibraryClass):
        name = added.state.name.rpartition(".")[2]
        evaluator.faults.append(UseFault("class as state", added.span, (name,)))
    for name, value in (("transitions", added.transitions), ("remapping", added.remapping)):
        if isinstance(value, ListValue | TupleValue) and sequence(value):
            evaluator.faults.append(UseFault("no dictionary", added.span, (name,)))


def copied(value: Value | None) -> Value | None:
    """A dictionary as it is now: code can change it later."""
    if not isinstance(value, DictValue):
        return value
    return DictValue({**value.slots}, value.span, value.repeated)


MOST_STATES = 5_000
"""The most states of a container."""


def executed(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """The method that runs a machine: other code can set its keys if it gets any."""
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        evaluator.heap.set(me.slots, "$executed", Const(True))
        if len(arguments.positional) + len(arguments.named) > 1:
            evaluator.heap.set(me.slots, "$exposed", Const(True))
    return UNKNOWN


MOST_NOTED = 100
"""The most calls that are noted for an object. If there are more, none of them is certain."""


class Call(NamedTuple):
    """A call of a method of an object: its arguments are without the object. They are open if the
    call is not certain."""

    name: str
    arguments: Arguments
    span: Span | None


def noted(name: str) -> Run:
    """A method whose call has an effect that is no part of a graph."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if isinstance(me, Instance):
            given = Arguments(arguments.positional[1:], arguments.named, arguments.open)
            calls = [*noted_of(me), Call(name, given, span)]
            if len(calls) > MOST_NOTED:
                known = (replace(call.arguments, open=True) for call in calls[:MOST_NOTED])
                calls = [call._replace(arguments=given)
                         for call, given in zip(calls, known, strict=False)]  # fmt: skip
            evaluator.heap.set(me.slots, "$noted", TupleValue(tuple(map(_as_value, calls))))
        return NONE

    return run


def noted_of(me: Instance) -> list[Call]:
    """The calls that are noted for an object."""
    held = [sequence(calls) or () for calls in alternatives(me.slots.get("$noted", TupleValue(())))]
    if len(held) == 1:
        return [*_calls(held[0], certain=True)]
    return [*_calls(dict.fromkeys(call for calls in held for call in calls), certain=False)]


def _as_value(call: Call) -> Value:
    """A call as a value, which the store can join with others."""
    name, arguments, span = call
    words = TupleValue(tuple(Const(word) for word, _ in arguments.named))
    values = TupleValue(tuple(value for _, value in arguments.named))
    given = TupleValue(arguments.positional)
    return TupleValue((Const(name, span), given, words, values, Const(arguments.open)))


def _calls(values: Iterable[Value], *, certain: bool) -> Iterator[Call]:
    for value in values:
        match sequence(value):
            case (Const(value=str() as name, span=span), given, words, held, is_open):
                names = (str(getattr(word, "value", "")) for word in sequence(words) or ())
                named = zip(names, sequence(held) or (), strict=True)
                more = not certain or truth(is_open) is True
                arguments = Arguments(sequence(given) or (), tuple(named), more)
                yield Call(name, arguments, span)


def userdata_of(container: Instance) -> Value | None:
    """The values that the keys of a container have before it starts."""
    found: Value | None = container.slots.get("$blackboard", container.slots.get("userdata"))
    return found


def listed(slot: str) -> Run:
    """A method that returns the names in a slot as a list."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        found = me.slots.get(slot, UNKNOWN) if isinstance(me, Instance) else UNKNOWN
        items = sequence(found)
        return UNKNOWN if items is None else evaluator.new_list(items)

    return run


def refuse(evaluator: Interpreter, kind: UseKind, name: Const, span: Span) -> None:
    """Notes that a framework refuses a call, at the name in it."""
    own = name.span
    is_inside = own is not None and own.source is span.source and span.start <= own.start < span.end
    fault = UseFault(kind, own if own is not None and is_inside else span, (str(name.value),))
    evaluator.faults.append(fault)
