"""The classes and functions of FlexBE that the evaluator models.

The signatures are those of flexbe_core 1.2 (ROS 1) to 4.0 (ROS 2). A behavior is an object whose
method `create` builds its state machine. FlexBE accepts the outcomes and keys of states by name
only. Containers of `smachac_flexbe`, the module of generated programs, are built as FlexBE's.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping

from smachac.diagnostics.source import Span
from smachac.pysource.flow.life_cycle import LifeCycle
from smachac.pysource.machines.framework import (
    Framework,
    Run,
    add_child,
    classes,
    copied,
    make_container,
    names_in,
    noted,
    nothing,
    refuse,
    set_interface,
    together,
)
from smachac.pysource.machines.heap import Added
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Adjustable,
    Arguments,
    Const,
    DictValue,
    Frame,
    Instance,
    Interpreter,
    ModuleValue,
    Native,
    TupleValue,
    Unknown,
    Value,
    sequence,
)
from smachac.pysource.machines.wrong_calls import signature

PREEMPTED = "preempted"
"""The outcome with which each state and container can end after a request to stop; it needs no
transition, and ends all containers around it."""

_READY: Mapping[str, tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]] = {
    "CalculationState": (("done",), ("input_value",), ("output_value",)),
    "CheckConditionState": (("true", "false"), ("input_value",), ()),
    "DecisionState": ((), ("input_value",), ()),
    "FlexibleCalculationState": (("done",), (), ("output_value",)),
    "FlexibleCheckConditionState": (("true", "false"), (), ()),
    "InputState": (("received", "aborted", "no_connection", "data_error"), (), ("data",)),
    "LogKeyState": (("done",), ("data",), ()),
    "LogState": (("done",), (), ()),
    "OperatorDecisionState": ((), (), ()),
    "PublisherBoolState": (("done",), ("value",), ()),
    "PublisherEmptyState": (("done",), (), ()),
    "PublisherStringState": (("done",), ("value",), ()),
    "SubscriberState": (("received", "unavailable"), (), ("message",)),
    "WaitState": (("done",), (), ()),
}
"""The states of flexbe_states, each with its outcomes, input keys and output keys."""

_OUTCOMES_AT, _INPUTS_AT = ("DecisionState", "OperatorDecisionState"), (
    "FlexibleCalculationState", "FlexibleCheckConditionState",
)  # fmt: skip
"""The states that get their outcomes as the first argument, or their input keys as the second."""

PRIORITY = "flexbe_core.PriorityContainer"
"""The container that runs alone in a concurrence."""

AUTONOMY = "autonomy"
"""The name under which levels of autonomy are noted that are not known."""

LEVELS = ("Off", "Low", "High", "Full")
"""The levels of autonomy by their numbers; `Inherit` is that of `Off`."""

_OPTIONAL = {"InputState": ("timeout",)}
"""The outcomes that some versions have."""


def _module(cls: str) -> str:
    """The module of a class, as the app of FlexBE names it."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", cls).lower()


def _names(texts: tuple[str, ...]) -> Value:
    return TupleValue(tuple(map(Const, texts)))


def _state(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """The constructor of a state, which takes lists by name only."""
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        outcomes, inputs, outputs, both = (
            names_in(evaluator, arguments.get(-1, name), span or me.span)
            for name in ("outcomes", "input_keys", "output_keys", "io_keys")
        )
        set_interface(evaluator, me, outcomes, together(inputs, both), together(outputs, both))
    return NONE


def _ready(name: str) -> Run:
    """The constructor of a state that is ready to use."""
    outcomes, inputs, outputs = map(_names, _READY[name])

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if not isinstance(me, Instance):
            return NONE
        own, read = outcomes, inputs
        if name in _OUTCOMES_AT:
            own = names_in(evaluator, arguments.get(1, "outcomes", UNKNOWN), span or me.span)
        if name in _INPUTS_AT:
            read = names_in(evaluator, arguments.get(2, "input_keys", UNKNOWN), span or me.span)
        set_interface(evaluator, me, own, read, outputs)
        evaluator.heap.set(me.slots, "$required", read)
        if name in _OPTIONAL:
            evaluator.heap.set(me.slots, "$optional", _names(_OPTIONAL[name]))
        return NONE

    return run


def _container(kind: str) -> Run:
    """The constructor of a container."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if not isinstance(me, Instance):
            return NONE
        _state(evaluator, arguments, span)
        make_container(evaluator, me, kind)
        if any(getattr(cls, "name", "") == PRIORITY for cls in evaluator.classes(me.cls)):
            noted(PRIORITY)(evaluator, Arguments((me,)), span)
        if kind == "Concurrence":
            conditions = arguments.get(1, "conditions", NONE) or UNKNOWN
            evaluator.heap.set(me.slots, "$conditions", conditions)
        return NONE

    return run


def _add(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """`add`: the name, the state, its transitions, autonomy and remapping."""
    label = arguments.get(0, "label", UNKNOWN) or UNKNOWN
    state = arguments.get(1, "state", UNKNOWN) or UNKNOWN
    transitions = arguments.get(2, "transitions", UNKNOWN)
    remapping = arguments.get(4, "remapping")
    evaluator.adds += 1
    if not evaluator.opened:
        evaluator.orphans += 1
        return NONE
    if span is None:
        return NONE
    container = evaluator.opened[-1]
    slots = container.slots if isinstance(container, Instance) else {}
    kind = "concurrence" if slots.get("$kind") == Const("Concurrence") else "add"
    levels = _levels(arguments.get(3, "autonomy"))
    added = Added(label=label, state=state, transitions=copied(transitions),
                  remapping=copied(remapping), span=span, kind=kind,
                  autonomy=tuple((levels or {}).items()))  # fmt: skip
    if levels is None:
        noted(AUTONOMY)(evaluator, Arguments((container,)), span)
    is_added = add_child(evaluator, container, added)
    outcomes = sequence(slots.get("$outcomes")) or ()
    if is_added and isinstance(label, Const) and label in outcomes:
        refuse(evaluator, "state named as outcome", label, span)
    return NONE


def _levels(given: Value | None) -> dict[str, str] | None:
    """The outcomes with another level of autonomy than `Off`, and that level; None: not known."""
    if given is None or given == NONE:
        return {}
    pairs = given.items if isinstance(given, DictValue) else UNKNOWN
    found: dict[str, str] = {}
    for outcome, level in pairs.values() if isinstance(pairs, Mapping) else ((UNKNOWN, UNKNOWN),):
        value = getattr(level, "value", None)
        name = LEVELS[value] if isinstance(value, int) and 0 <= value < len(LEVELS) else value
        if not isinstance(outcome, Const) or name not in ("Inherit", *LEVELS):
            return None
        found[str(outcome.value)] = str(name)
    return {outcome: name for outcome, name in found.items() if name in LEVELS[1:]}


def _behavior(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        evaluator.heap.set(me.slots, "$behaviors", DictValue({"items": {}}))
        evaluator.heap.set(me.slots, "$machines", DictValue({"items": {}}))
    return NONE


def _add_parameter(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """A parameter of a behavior. The operator can give it any value."""
    me, name = arguments.get(0, "self"), arguments.get(1, "name")
    default = arguments.get(2, "default", UNKNOWN) or UNKNOWN
    if isinstance(me, Instance) and isinstance(name, Const):
        word = str(name.value)
        value = Adjustable(reason="a parameter", owner=me, name=word, default=default)
        evaluator.heap.set(me.slots, word, value)
    return NONE


def _add_behavior(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """Makes another behavior a part of this one."""
    me, name = arguments.get(0, "self"), arguments.get(2, "behavior_id")
    made = arguments.get(1, "behavior_class", UNKNOWN) or UNKNOWN
    if isinstance(me, Instance) and name is not None:
        node = arguments.get(3, "node")
        given = Arguments((node,) if node is not None else ())
        made = evaluator.call(made, given, None, _frame())
        _put(evaluator, me, "$behaviors", name, made)
    return NONE


def _use_behavior(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """The state machine of another behavior, which it creates once."""
    me, name = arguments.get(0, "self"), arguments.get(2, "behavior_id", UNKNOWN) or UNKNOWN
    if not isinstance(me, Instance):
        return UNKNOWN
    known = _of(me, "$machines", name)
    behavior = _of(me, "$behaviors", name)
    if known is not None or not isinstance(behavior, Instance):
        cls = arguments.get(1, "behavior_class", UNKNOWN)
        return known or behavior or (cls if isinstance(cls, Unknown) else UNKNOWN)
    given = arguments.get(4, "parameters", NONE)
    pairs = given.items if isinstance(given, DictValue) else {}
    for key, value in pairs.values() if isinstance(pairs, Mapping) else ():
        if isinstance(key, Const):
            evaluator.set_attribute(behavior, str(key.value), value)
    create = evaluator.attribute(behavior, "create", ast.Name("create", ast.Load()), _frame())
    opened, evaluator.opened[:] = [*evaluator.opened], []
    machine = evaluator.call(create, Arguments(), None, _frame())
    evaluator.opened[:] = opened
    if isinstance(machine, Instance):
        evaluator.heap.set(machine.slots, "$behavior", behavior)
        _use_defaults(evaluator, machine, arguments.get(3, "default_keys", NONE) or NONE)
    _put(evaluator, me, "$machines", name, machine)
    return machine


def _use_defaults(evaluator: Interpreter, machine: Instance, given: Value) -> None:
    """Takes the keys with default values from the input keys of a machine, and removes the values
    of the others."""
    inputs = sequence(machine.slots.get("$inputs"))
    defaults = () if given == NONE else sequence(given)
    if inputs is None or defaults is None:
        evaluator.heap.set(machine.slots, "$inputs", UNKNOWN)
        return
    kept = tuple(key for key in inputs if key not in defaults)
    evaluator.heap.set(machine.slots, "$inputs", TupleValue(kept))
    userdata = machine.slots.get("userdata")
    items = userdata.items if isinstance(userdata, DictValue) else None
    if isinstance(userdata, DictValue) and isinstance(items, Mapping):
        names = {key.value for key in kept if isinstance(key, Const)}
        left = {key: pair for key, pair in items.items() if key not in names}
        evaluator.heap.set(userdata.slots, "items", left)


def _put(evaluator: Interpreter, me: Instance, slot: str, name: Value, value: Value) -> None:
    known = me.slots.get(slot)
    if not isinstance(known, DictValue):
        return
    items = known.items
    if isinstance(name, Const) and isinstance(items, Mapping):
        evaluator.heap.set(known.slots, "items", {**items, name.value: (name, value)})
    else:
        evaluator.heap.set(known.slots, "items", UNKNOWN)


def _of(me: Instance, slot: str, name: Value) -> Value | None:
    known = me.slots.get(slot)
    items = known.items if isinstance(known, DictValue) else {}
    if not isinstance(name, Const) or not isinstance(items, Mapping):
        return UNKNOWN
    return items[name.value][1] if name.value in items else None


def _frame() -> Frame:
    return Frame({}, ModuleValue("", {}))


def _unknown(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return UNKNOWN


_STATE: Mapping[str, Run] = {
    "__init__": _state,
    "set_rate": noted("set_rate"),
    **dict.fromkeys(
        ("initialize_ros", "set_name", "set_parent", "on_start", "on_stop", "on_pause",
         "on_resume", "on_enter", "on_exit"), nothing,
    ),
}  # fmt: skip

_CONTAINER: Mapping[str, Run] = {
    **_STATE,
    "add": _add,
    **dict.fromkeys(("confirm", "destroy", "wait", "sleep"), nothing),
}

_BEHAVIOR: Mapping[str, Run] = {
    "__init__": _behavior,
    "add_parameter": _add_parameter,
    "add_behavior": _add_behavior,
    "use_behavior": _use_behavior,
    **dict.fromkeys(("set_up", "prepare_for_execution", "confirm", "preempt"), nothing),
}

_STATES = "State RosState ManuallyTransitionableState LockableState PreemptableState"
_STATES += " OperatableState EventState"
_MACHINES = "StateMachine RosStateMachine LockableStateMachine PreemptableStateMachine"
_MACHINES += " OperatableStateMachine PriorityContainer"

_MODULE: Mapping[str, Value] = {
    **classes("flexbe_core", f"{_STATES} {_MACHINES} ConcurrencyContainer Behavior"),
    "set_node": Native("nothing", nothing),
    "initialize_flexbe": Native("nothing", nothing),
    "UserData": Native("UserData", _unknown),
    "Logger": UNKNOWN,
    "StateLogger": UNKNOWN,
    "BehaviorLibrary": UNKNOWN,
}

FLEXBE = Framework(
    name="FlexBE",
    packages=("flexbe_core", "flexbe_states"),
    modules={
        "flexbe_core": _MODULE,
        "flexbe_core.Autonomy": {level: Const(level) for level in ("Inherit", *LEVELS)},
        "flexbe_core.proxy": {},
        "flexbe_states": classes("flexbe_states", " ".join(_READY)),
        ".smachac_flexbe": {
            **{name: _MODULE[name] for name in
               ("EventState", "OperatableStateMachine", "ConcurrencyContainer")},
            "Join": UNKNOWN,
            "Loop": UNKNOWN,
        },
    },
    methods={
        **{f"flexbe_core.{name}": _STATE for name in _STATES.split()},
        **{f"flexbe_core.{name}": {**_CONTAINER, "__init__": _container("StateMachine")}
           for name in _MACHINES.split()},
        "flexbe_core.ConcurrencyContainer": {**_CONTAINER, "__init__": _container("Concurrence")},
        "flexbe_core.Behavior": _BEHAVIOR,
        **{f"flexbe_states.{name}": {**_STATE, "__init__": _ready(name)} for name in _READY},
    },
    containers=frozenset(
        f"flexbe_core.{name}" for name in (*_MACHINES.split(), "ConcurrencyContainer")
    ),
    static=frozenset(["add", "initialize_ros"]),
    overridden=frozenset(["add", "execute"]),
    signatures={
        f"flexbe_core.{name}.add": signature("label state transitions", "autonomy remapping")
        for name in ("OperatableStateMachine", "PriorityContainer", "ConcurrencyContainer")
    },
    entries=frozenset(["create"]),
    same_name_exits=False,
    exits=(PREEMPTED,),
    code="flexbe",
    places={f"flexbe_states.{name}": f"flexbe_states.{_module(name)}" for name in _READY},
    write_through=True,
    ros=2,
    undeclared_outcomes=True,
    undeclared_keys=True,
    life_cycle=LifeCycle(
        before=("on_enter",), after=("on_exit",), others=("on_resume",), repeated=True
    ),
    effects={
        "SM101": "FlexBE raises an exception when the container starts: none of its states runs",
        "SM102": "FlexBE never takes this transition, and another outcome has none",
        "SM104": "after this outcome FlexBE logs an error, and the state stays active",
        "SM106": "`add` raises an exception for the second one: the program stops",
        "SM201": "the state never runs",
        "SM202": "",
        "SM301": "FlexBE logs an error when the state reads the key, and the state stays active",
        "SM302": "FlexBE logs an error when the state reads the key, and the state stays active",
        "SM303": "FlexBE logs an error when the state reads the key, and the state stays active",
        "SM308": "FlexBE logs an error when the state sets the key, and the state stays active",
        "SM309": "FlexBE logs an error after `execute`, and the state stays active",
        "SM310": "FlexBE logs an error when the state reads the key, and the state stays active",
        "SM403": "FlexBE never ends the container by this condition",
    },
    # Its editor leaves states that no path reaches in behaviors, without a warning.
    works=frozenset(["SM201", "SM202"]),
)  # fmt: skip
