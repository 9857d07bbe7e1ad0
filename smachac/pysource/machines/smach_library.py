"""The classes and functions of SMACH and smach_ros that the evaluator models.

The signatures are those of executive_smach 2.5.2 (ROS 1) and 3.0.3 (ROS 2).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from smachac.diagnostics.source import Span
from smachac.pysource.machines.framework import (
    Framework,
    Run,
    add_child,
    classes,
    copied,
    executed,
    listed,
    make_container,
    names_in,
    noted,
    nothing,
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
    Function,
    Instance,
    Interface,
    Interpreter,
    LibraryClass,
    Method,
    Native,
    Partial,
    TupleValue,
    Unknown,
    UseFault,
    Value,
    alternatives,
    sequence,
)
from smachac.pysource.machines.wrong_calls import Signature, signature

_READY = {
    "smach_ros.SimpleActionState": ("succeeded", "aborted", "preempted"),
    "smach_ros.ServiceState": ("succeeded", "aborted", "preempted"),
    "smach_ros.MonitorState": ("valid", "invalid", "preempted"),
    "smach_ros.ConditionState": ("true", "false", "preempted"),
    "smach.ConditionState": ("true", "false", "preempted"),
}
"""The outcomes of the states that are ready to use."""

_PARAMETERS: Mapping[str, tuple[str, ...]] = {
    "smach_ros.SimpleActionState": (
        "action_name", "action_spec", "goal", "goal_key", "goal_slots", "goal_cb", "goal_cb_args",
        "goal_cb_kwargs", "result_key", "result_slots", "result_cb", "result_cb_args",
        "result_cb_kwargs", "slots", "input_keys", "output_keys", "outcomes",
    ),
    "smach_ros.ServiceState": (
        "service_name", "service_spec", "request", "request_key", "request_slots", "request_cb",
        "request_cb_args", "request_cb_kwargs", "response_key", "response_slots", "response_cb",
        "response_cb_args", "response_cb_kwargs", "input_keys", "output_keys", "outcomes",
    ),
    "smach_ros.MonitorState": (
        "topic", "msg_type", "cond_cb", "max_checks", "input_keys", "output_keys",
    ),
    "smach_ros.ConditionState": (
        "cond_cb", "input_keys", "poll_rate", "timeout", "max_checks",
    ),
    "smach.ConditionState": ("cond_cb", "input_keys", "poll_rate", "timeout", "max_checks"),
}  # fmt: skip
"""The parameters of the states that are ready to use, in their order."""

_OTHER_PARAMETERS: Mapping[str, tuple[str, ...]] = {
    "smach.State": ("outcomes", "input_keys", "output_keys", "io_keys"),
    "smach.CBState": (
        "cb", "cb_args", "cb_kwargs", "outcomes", "input_keys", "output_keys", "io_keys",
    ),
    "smach.StateMachine": ("outcomes", "input_keys", "output_keys"),
}  # fmt: skip
"""The parameters of other classes, in their order."""

_READ = ("goal_key", "goal_slots", "request_key", "request_slots")
_WRITTEN = ("result_key", "result_slots", "response_key", "response_slots")


def _state(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        outcomes, inputs, outputs, both = (
            names_in(evaluator, arguments.get(at, name), span or me.span)
            for at, name in enumerate(("outcomes", "input_keys", "output_keys", "io_keys"), 1)
        )
        set_interface(evaluator, me, outcomes, together(inputs, both), together(outputs, both))
    return NONE


def _container(kind: str, inputs_at: int, others: Sequence[tuple[int, str]]) -> Run:
    """The constructor of a container with the places of its arguments."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if not isinstance(me, Instance):
            return NONE
        here = span or me.span
        outcomes = names_in(evaluator, arguments.get(1, "outcomes"), here)
        inputs = names_in(evaluator, arguments.get(inputs_at, "input_keys"), here)
        outputs = names_in(evaluator, arguments.get(inputs_at + 1, "output_keys"), here)
        set_interface(evaluator, me, outcomes, inputs, outputs)
        make_container(evaluator, me, kind)
        for at, name in others:
            value = arguments.get(at, name)
            if value is not None:
                evaluator.heap.set(me.slots, f"${name}", value)
        return NONE

    return run


def _cb_state(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me, function = arguments.get(0, "self"), arguments.get(1, "cb", UNKNOWN)
    if isinstance(me, Instance) and function is not None:
        here = span or me.span
        own = _of_callback(function)
        given = [arguments.get(at, name) for at, name in
                 ((4, "outcomes"), (5, "input_keys"), (6, "output_keys"))]  # fmt: skip
        both = arguments.get(7, "io_keys") or TupleValue(())
        outcomes = together(names_in(evaluator, given[0], here), own[0])
        inputs = together(names_in(evaluator, given[1], here), own[1], both)
        outputs = together(names_in(evaluator, given[2], here), own[2], both)
        set_interface(evaluator, me, outcomes, inputs, outputs)
        evaluator.heap.set(me.slots, "$callback", function)
        values = arguments.get(3, "cb_kwargs")
        if values is not None:
            evaluator.heap.set(me.slots, "$callback_values", copied(values) or NONE)
    return NONE


def _of_callback(function: Value) -> tuple[Value, Value, Value]:
    """The outcomes and keys that `cb_interface` gives to a callback."""
    found = next(functions_of(function), None)
    interface = found.interface if found is not None else None
    if interface is not None:
        return interface.outcomes, interface.input_keys, interface.output_keys
    nothing = TupleValue(())
    known = found is not None or (isinstance(function, Const) and function.value is None)
    return (nothing, nothing, nothing) if known else (UNKNOWN, UNKNOWN, UNKNOWN)


def _ready(name: str) -> Run:
    """The constructor of a state that is ready to use."""
    parameters = _PARAMETERS[name]

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if not isinstance(me, Instance):
            return NONE
        here = span or me.span
        given = _without_node(name, arguments.without_first())
        values = {
            parameter: value
            for at, parameter in enumerate(parameters)
            if (value := given.get(at, parameter)) is not None
        }
        callbacks = [values[key] for key in values if key.endswith("_cb") and key != "cond_cb"]
        interfaces = [_of_callback(value) for value in callbacks]
        outcomes: list[Value] = [TupleValue(tuple(Const(text) for text in _READY[name]))]
        outcomes += [
            names_in(evaluator, values.get("outcomes"), here),
            *(i[0] for i in interfaces),
        ]
        reads = [_one(values[key]) for key in _READ if key in values]
        writes = [_one(values[key]) for key in _WRITTEN if key in values]
        inputs = [names_in(evaluator, values.get("input_keys"), here), *(i[1] for i in interfaces)]
        outputs = [
            names_in(evaluator, values.get("output_keys"), here),
            *(i[2] for i in interfaces),
        ]
        slots = names_in(evaluator, values.get("slots"), here)
        set_interface(evaluator, me, together(*outcomes), together(*inputs, *reads, slots),
                   together(*outputs, *writes, slots))  # fmt: skip
        evaluator.heap.set(me.slots, "$required", together(*reads))
        return NONE

    return run


def takes_node(cls: Value, given: Arguments) -> bool:
    """Whether the first argument for a class of smach_ros is the node of ROS 2."""
    name = cls.name if isinstance(cls, LibraryClass) else ""
    return name in _PARAMETERS and _without_node(name, given) is not given


def _without_node(name: str, given: Arguments) -> Arguments:
    """The arguments without the node, which smach_ros of ROS 2 takes first: an object before a
    name."""
    match given.positional:
        case [Unknown() | Instance(), Const(), *_] if name != "smach_ros.ConditionState":
            return given.without_first()
    return given


def _one(value: Value) -> Value:
    """A key, or a list of keys, as a list."""
    if isinstance(value, Const):
        return TupleValue(() if value.value is None else (value,))
    return value


_ACCEPTS: Mapping[str, tuple[str, ...]] = {
    "add": ("StateMachine", "Sequence"),
    "add_auto": ("StateMachine", "Sequence"),
    "sequence": ("Sequence",),
    "concurrence": ("Concurrence",),
    "iterator": ("Iterator",),
}
"""The kinds of the containers to which each method adds states."""


def _judge_container(evaluator: Interpreter, kind: str, span: Span) -> None:
    """Notes a state that is added by the method of another container than the one opened last."""
    container = evaluator.opened[-1]
    found = container.slots.get("$kind") if isinstance(container, Instance) else None
    if isinstance(found, Const) and found.value not in _ACCEPTS[kind] and evaluator.is_certain:
        names = (_ACCEPTS[kind][-1 if kind == "sequence" else 0], str(found.value))
        evaluator.faults.append(UseFault("other container", span, names))


def _add(kind: str) -> Run:
    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        label, state = arguments.get(0, "label", UNKNOWN), arguments.get(1, "state", UNKNOWN)
        connector = loop = breaks = final = None
        if kind == "add_auto":
            connector = arguments.get(2, "connector_outcomes", UNKNOWN)
            transitions, remapping = arguments.get(3, "transitions"), arguments.get(4, "remapping")
        elif kind == "concurrence":
            transitions, remapping = None, arguments.get(2, "remapping")
        elif kind == "iterator":
            transitions, remapping = None, None
            loop = arguments.get(2, "loop_outcomes")
            breaks = arguments.get(3, "break_outcomes")
            final = arguments.get(4, "final_outcome_map")
        else:
            transitions, remapping = arguments.get(2, "transitions"), arguments.get(3, "remapping")
        evaluator.adds += 1
        if not evaluator.opened:
            evaluator.orphans += 1
            is_sure = evaluator.sees_opened and not evaluator.managers and evaluator.is_certain
            if is_sure and span is not None:
                evaluator.faults.append(UseFault("no container", span))
            return state or UNKNOWN
        if span is None:
            return state or UNKNOWN
        _judge_container(evaluator, kind, span)
        added = Added(
            label=label or UNKNOWN, state=state or UNKNOWN, transitions=copied(transitions),
            remapping=copied(remapping), span=span, kind=kind, connector=connector, loop=loop,
            breaks=breaks, final=copied(final), possible=False,
        )  # fmt: skip
        is_added = add_child(evaluator, evaluator.opened[-1], added)
        if (
            is_added
            and kind == "add"
            and isinstance(transitions, DictValue)
            and isinstance(state, Instance)
        ):
            _write_missing(evaluator, transitions, state, span)
        return state or UNKNOWN

    return run


def _write_missing(
    evaluator: Interpreter, transitions: DictValue, state: Instance, span: Span
) -> None:
    """SMACH writes the outcomes of a state that have no transition into the dictionary it got: a
    second state with the same dictionary then has outcomes that it does not have."""
    items = transitions.items
    outcomes = sequence(state.slots.get("$outcomes"))
    if not isinstance(items, Mapping) or outcomes is None:
        return
    names = [name for name in outcomes if isinstance(name, Const)]
    known = {name.value for name in names}
    first = transitions.slots.get("$filled", {})
    wrong = [key for key in first if key not in known]
    if wrong:
        there = first[wrong[0]]
        evaluator.faults.append(UseFault("shared transitions", span, (str(wrong[0]),), there))
        return
    missing = {name.value: (name, NONE) for name in names if name.value not in items}
    if missing:
        evaluator.heap.set(transitions.slots, "items", {**items, **missing})
        filled = {**first, **dict.fromkeys(missing, span)}
        evaluator.heap.set(transitions.slots, "$filled", filled)


def _set_initial(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        evaluator.heap.set(me.slots, "$initial", arguments.get(1, "initial_states", UNKNOWN))
        if len(arguments.positional) > 2:
            evaluator.heap.set(me.slots, "$exposed", Const(True))
    return NONE


def _register(*slots: str) -> Run:
    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        for slot in slots:
            if isinstance(me, Instance):
                before = me.slots.get(slot, TupleValue(()))
                whole = together(before, arguments.get(1, "keys") or UNKNOWN)
                evaluator.heap.set(me.slots, slot, whole)
        return NONE

    return run


CALLBACKS = ("register_start_cb", "register_transition_cb", "register_termination_cb")
"""The methods of a container that register functions which it calls while it runs."""


_STATE: Mapping[str, Run] = {
    "__init__": _state,
    "execute": executed,
    "register_outcomes": _register("$outcomes"),
    "register_input_keys": _register("$inputs"),
    "register_output_keys": _register("$outputs"),
    "register_io_keys": _register("$inputs", "$outputs"),
    "get_registered_outcomes": listed("$outcomes"),
    "get_registered_input_keys": listed("$inputs"),
    "get_registered_output_keys": listed("$outputs"),
    **dict.fromkeys(
        ("request_preempt", "service_preempt", "recall_preempt", "preempt_requested",
         "set_initial_userdata", "check_consistency", "close"), nothing,
    ),
}  # fmt: skip


def _open(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    if me is not None:
        evaluator.opened.append(me)
    return NONE


def _close(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    if evaluator.opened:
        evaluator.opened.pop()
    return NONE


_CONTAINER: Mapping[str, Run] = {
    **_STATE,
    **{name: noted(name) for name in CALLBACKS},
    "open": _open,
    "close": _close,
    "set_initial_state": _set_initial,
}

_METHODS: Mapping[str, Mapping[str, Run]] = {
    "smach.State": _STATE,
    "smach.CBInterface": {"__get__": nothing},
    "smach.CBState": {**_STATE, "__init__": _cb_state},
    "smach.StateMachine": {
        **_CONTAINER,
        "__init__": _container("StateMachine", 2, ()),
        "add": _add("add"),
        "add_auto": _add("add_auto"),
    },
    "smach.Sequence": {
        **_CONTAINER,
        "__init__": _container("Sequence", 3, ((2, "connector_outcome"),)),
        "add": _add("sequence"),
        "add_auto": _add("add_auto"),
    },
    "smach.Concurrence": {
        **_CONTAINER,
        "__init__": _container(
            "Concurrence", 3,
            ((2, "default_outcome"), (5, "outcome_map"), (6, "outcome_cb"),
             (7, "child_termination_cb")),
        ),
        "add": _add("concurrence"),
    },
    "smach.Iterator": {
        **_CONTAINER,
        "__init__": _container(
            "Iterator", 2, ((4, "it"), (5, "it_label"), (6, "exhausted_outcome"))
        ),
        "set_contained_state": _add("iterator"),
    },
    **{name: {**_STATE, "__init__": _ready(name)} for name in _READY},
}  # fmt: skip


def _user_data(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return DictValue({"items": {}, "$userdata": True})


def _cb_interface(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    nothing = TupleValue(())
    interface = Interface(
        outcomes=arguments.get(0, "outcomes", nothing) or nothing,
        input_keys=arguments.get(1, "input_keys", nothing) or nothing,
        output_keys=arguments.get(2, "output_keys", nothing) or nothing,
    )

    def decorate(evaluator: Interpreter, given: Arguments, span: Span | None) -> Value:
        function = given.get(0, "cb", UNKNOWN) or UNKNOWN
        if isinstance(function, Function):
            function.interface = interface
        return function

    return Native("cb_interface", decorate)


def functions_of(value: Value) -> Iterator[Function]:
    """The functions of the project behind a value."""
    for part in alternatives(value):
        match part:
            case Function():
                yield part
            case Method(function=Function() as inner):
                yield inner
            case Partial(function=inner_):
                yield from functions_of(inner_)


_MODULE: Mapping[str, Value] = {
    **classes("smach", "State CBState StateMachine Sequence Concurrence Iterator"),
    **classes("smach", "ConditionState CBInterface"),
    "cb_interface": Native("cb_interface", _cb_interface),
    "UserData": Native("UserData", _user_data),
    "Container": UNKNOWN,
    **dict.fromkeys(
        ("loginfo", "logwarn", "logerr", "logdebug", "set_loggers", "set_shutdown_check"),
        Native("nothing", nothing),
    ),
}

_ROS_MODULE: Mapping[str, Value] = {
    **classes("smach_ros", "SimpleActionState ServiceState MonitorState ConditionState"),
    "IntrospectionServer": Native("nothing", lambda e, a, s: Unknown(reason="rospy")),
    "set_preempt_handler": Native("nothing", nothing),
    "ActionServerWrapper": Native("nothing", lambda e, a, s: Unknown(reason="rospy")),
}


_KEYS = "input_keys output_keys"

_SIGNATURES: Mapping[str, Signature] = {
    "smach.StateMachine.__init__": signature("self outcomes", _KEYS),
    "smach.Sequence.__init__": signature("self outcomes connector_outcome", _KEYS),
    "smach.Concurrence.__init__": signature(
        "self outcomes default_outcome", f"{_KEYS} outcome_map outcome_cb child_termination_cb"
    ),
    "smach.Iterator.__init__": signature(
        "self outcomes input_keys output_keys", "it it_label exhausted_outcome"
    ),
    "smach.StateMachine.add": signature("label state", "transitions remapping"),
    "smach.StateMachine.add_auto": signature(
        "label state connector_outcomes", "transitions remapping"
    ),
    "smach.Sequence.add": signature("label state", "transitions remapping"),
    "smach.Concurrence.add": signature("label state", "remapping"),
    "smach.Iterator.set_contained_state": signature(
        "label state", "loop_outcomes break_outcomes final_outcome_map"
    ),
}  # fmt: skip

SMACH = Framework(
    name="SMACH",
    packages=("smach", "smach_ros"),
    modules={"smach": _MODULE, "smach_ros": _ROS_MODULE},
    methods=_METHODS,
    containers=frozenset([
        "smach.StateMachine", "smach.Sequence", "smach.Concurrence", "smach.Iterator",
    ]),
    static=frozenset(["add", "add_auto", "set_contained_state"]),  # of the container opened last
    overridden=frozenset(["add", "execute"]),
    lacking={"smach": "smach_ros", "smach_ros": "smach"},
    parameters={**_PARAMETERS, **_OTHER_PARAMETERS},
    code="python",
    signatures=_SIGNATURES,
)  # fmt: skip
