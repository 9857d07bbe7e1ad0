"""The classes and functions of YASMIN that the evaluator models.

The signatures are those of YASMIN 3.0.0 to 6.1.1. The outcomes `canceled` and `timeout` of the
states of yasmin_ros depend on the version and on arguments: they are optional.
"""

from __future__ import annotations

from collections.abc import Mapping

from smachac.diagnostics.source import Span
from smachac.pysource.machines import yasmin_runtime
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
    refuse,
    set_interface,
    together,
)
from smachac.pysource.machines.heap import Added, Children
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
from smachac.pysource.machines.wrong_calls import signature

OUTCOMES = {
    "SUCCEED": "succeeded", "ABORT": "aborted", "FAIL": "failed", "CANCEL": "canceled",
    "TIMEOUT": "timeout", "RETRY": "retry",
}  # fmt: skip
"""The constants of `yasmin_ros.basic_outcomes`; FAIL and RETRY were in 3.1 to 6.0."""

_OPTIONAL = ("canceled", "timeout")

_READY: Mapping[str, tuple[int, tuple[str, ...], tuple[str, ...]]] = {
    "ActionState": (4, ("succeeded", "aborted"), _OPTIONAL),
    "ServiceState": (4, ("succeeded", "aborted"), _OPTIONAL),
    "MonitorState": (3, (), _OPTIONAL),
    "PublisherState": (0, ("succeeded",), _OPTIONAL[:1]),
    "GetParametersState": (0, ("succeeded", "aborted"), _OPTIONAL[:1]),
    "TfBufferState": (0, ("succeeded", "aborted"), ()),
    "RosSerializePyState": (0, ("succeed", "type_error", "error"), ()),
    "RosDeserializePyState": (0, ("succeed", "type_error", "error"), ()),
}
"""The states of yasmin_ros: the place of the argument `outcomes` (0: they have none), the outcomes
that each has besides, and those that it can have."""


_PARAMETERS = {
    name: tuple(words.split())
    for name, words in {
        "yasmin.State": "outcomes",
        "yasmin.CbState": "outcomes callback",
        "yasmin_ros.ActionState": "action_type action_name create_goal_handler outcomes"
        " result_handler feedback_handler callback_group node wait_timeout response_timeout"
        " maximum_retry",
        "yasmin_ros.ServiceState": "srv_type srv_name create_request_handler outcomes"
        " response_handler callback_group node wait_timeout response_timeout maximum_retry",
        "yasmin_ros.MonitorState": "msg_type topic_name outcomes monitor_handler qos"
        " callback_group msg_queue node timeout maximum_retry",
        "yasmin_ros.PublisherState": "msg_type topic_name create_message_handler qos"
        " callback_group node",
        "yasmin_ros.GetParametersState": "parameters node",
    }.items()
}
"""The parameters of the constructors in YASMIN 6.1."""


def _names(texts: tuple[str, ...]) -> Value:
    return TupleValue(tuple(map(Const, texts)))


_NOTHING = TupleValue(())


def _state(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        outcomes = names_in(evaluator, arguments.get(1, "outcomes"), span or me.span)
        set_interface(evaluator, me, outcomes, _NOTHING, _NOTHING)
    return NONE


def _callback_state(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    _state(evaluator, arguments, span)
    if isinstance(me, Instance):
        callback = arguments.get(2, "callback") or arguments.get(2, "cb", UNKNOWN)
        evaluator.heap.set(me.slots, "$callback", callback)
    return NONE


def _join_state(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.get(0, "self")
    if isinstance(me, Instance):
        outcome = arguments.get(2, "outcome", Const("joined")) or UNKNOWN
        set_interface(evaluator, me, TupleValue((outcome,)), _NOTHING, _NOTHING)
    return NONE


def _ready(at: int, outcomes: tuple[str, ...], optional: tuple[str, ...]) -> Run:
    """The constructor of a state that is ready to use."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if isinstance(me, Instance):
            given = arguments.get(at, "outcomes") if at else None
            own = names_in(evaluator, given, span or me.span)
            own = _NOTHING if own == NONE else own
            set_interface(evaluator, me, together(own, _names(outcomes)), _NOTHING, _NOTHING)
            evaluator.heap.set(me.slots, "$optional", _names(optional))
        return NONE

    return run


def _machine(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """The constructor of a state machine, which can begin with a name."""
    me, first = arguments.get(0, "self"), arguments.get(1, "outcomes")
    if isinstance(me, Instance):
        is_name = isinstance(first, Const) and len(arguments.positional) > 2
        named = dict(arguments.named)
        if is_name or ("outcomes" in named and len(arguments.positional) > 1):
            first = named.get("outcomes", arguments.get(2, "outcomes"))
        outcomes = names_in(evaluator, first, span or me.span)
        set_interface(evaluator, me, outcomes, _NOTHING, _NOTHING)
        make_container(evaluator, me, "StateMachine")
    return NONE


def _concurrence(at: int) -> Run:
    """The constructor of a container whose states run at the same time; `at` is the place of the
    default outcome, before which the states can be."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.get(0, "self")
        if not isinstance(me, Instance):
            return NONE
        default = arguments.get(at, "default_outcome", UNKNOWN) or UNKNOWN
        rules = arguments.get(at + 1, "outcome_map", DictValue({"items": {}})) or UNKNOWN
        outcomes = together(copied(rules) or UNKNOWN, TupleValue((default,)))
        set_interface(evaluator, me, outcomes, _NOTHING, _NOTHING)
        make_container(evaluator, me, "Concurrence")
        evaluator.heap.set(me.slots, "$default_outcome", default)
        evaluator.heap.set(me.slots, "$outcome_map", rules)
        _note_mappings(evaluator, arguments, at + 2, span)
        if at > 1:
            _add_states(evaluator, me, arguments.get(1, "states", UNKNOWN), span or me.span)
        return NONE

    return run


def _add_states(
    evaluator: Interpreter, me: Instance, states: Value | None, span: Span | None
) -> None:
    """Adds the states of a dictionary to a concurrence."""
    items = states.items if isinstance(states, DictValue) else UNKNOWN
    if not isinstance(items, Mapping) or span is None:
        evaluator.heap.set(me.slots, "$children", Children((), complete=False))
        return
    for name, state in items.values():
        evaluator.adds += 1
        place = name.span if isinstance(name, Const) and name.span is not None else span
        place = place if place.source is span.source else span
        added = Added(label=name, state=state, transitions=None, remapping=None, span=place,
                      kind="concurrence")  # fmt: skip
        add_child(evaluator, me, added)


def _note_mappings(
    evaluator: Interpreter, arguments: Arguments, at: int, span: Span | None
) -> None:
    """Notes the argument with mappings of parameters, if there is one."""
    if arguments.get(at, "parameter_mappings") is not None:
        noted("set_parameter_mappings")(evaluator, arguments, span)


def _add(kind: str) -> Run:
    """A method that adds a state: its name, the state, and for a state machine the transitions."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me, name = arguments.get(0, "self"), arguments.get(1, "name", UNKNOWN) or UNKNOWN
        state = arguments.get(2, "sm" if kind == "concurrence" else "state", UNKNOWN) or UNKNOWN
        transitions = arguments.get(3, "transitions") if kind == "add" else None
        remapping = arguments.get(4, "remappings") if kind == "add" else None
        evaluator.adds += 1
        if span is None or not isinstance(me, Instance):
            return NONE
        added = Added(label=name, state=state, transitions=copied(transitions),
                      remapping=copied(remapping), span=span, kind=kind)  # fmt: skip
        add_child(evaluator, me, added)
        if kind == "add":
            _note_mappings(evaluator, arguments, 5, span)
        outcomes = sequence(me.slots.get("$outcomes")) or ()
        if kind == "add" and isinstance(name, Const) and name in outcomes:
            refuse(evaluator, "state named as outcome", name, span)
        return NONE

    return run


def _set_start(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """`set_start_state`, which refuses a state that is not added yet."""
    me, name = arguments.get(0, "self"), arguments.get(1, "state_name", UNKNOWN) or UNKNOWN
    if not isinstance(me, Instance):
        return NONE
    evaluator.heap.set(me.slots, "$initial", TupleValue((name,)))
    children = me.slots.get("$children")
    if span is not None and isinstance(name, Const) and isinstance(children, Children):
        known = [child.label for child in children.added]
        is_whole = children.complete and all(isinstance(label, Const) for label in known)
        if is_whole and name not in known:
            refuse(evaluator, "no such start state", name, span)
    return NONE


def _blackboard(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """A blackboard: a dictionary; a copy of another one has the same values."""
    other = arguments.get(0, "other")
    return DictValue({"items": {}}, span) if other is None else other


def _run(*, injects: bool) -> Run:
    """A method that runs a state. The userdata of a machine is what its blackboard holds then, with
    the default values of its keys if it `injects` them."""

    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me, blackboard = arguments.get(0, "self"), arguments.get(1, "blackboard", NONE)
        if isinstance(me, Instance) and "$children" in me.slots:
            values = blackboard.items if isinstance(blackboard, DictValue) else {}
            defaults = me.slots.get("$defaults") if injects else None
            more = defaults.items if isinstance(defaults, DictValue) else {}
            is_other = blackboard != NONE and not isinstance(blackboard, DictValue)
            again = bool(values) and "$executed" in me.slots
            if is_other or again or not (isinstance(values, Mapping) and isinstance(more, Mapping)):
                noted(BLACKBOARD)(evaluator, arguments, span)
            elif values or more:
                whole = DictValue({"items": {**more, **values}})
                evaluator.heap.set(me.slots, "$blackboard", whole)
        if isinstance(blackboard, DictValue):  # the states have changed it
            evaluator.heap.set(blackboard.slots, "items", UNKNOWN)
        return executed(evaluator, Arguments((me,) if me is not None else ()), span)

    return run


def _add_input_key(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """`add_input_key`, which describes a key, and can give it a default value."""
    me, key = arguments.get(0, "self"), arguments.get(1, "key_name", UNKNOWN)
    default = arguments.get(3, "default_value")
    if not isinstance(me, Instance) or default is None:
        return NONE
    if "$children" not in me.slots or not isinstance(key, Const):
        return noted("add_input_key")(evaluator, arguments, span)
    known = me.slots.get("$defaults")
    pairs = known.items if isinstance(known, DictValue) else {}
    items = {**pairs, key.value: (key, default)} if isinstance(pairs, Mapping) else UNKNOWN
    evaluator.heap.set(me.slots, "$defaults", DictValue({"items": items}, span))
    return NONE


BLACKBOARD = "Blackboard"
"""The name under which a blackboard is noted of which the values are not known."""

_STATE: Mapping[str, Run] = {
    "__init__": _state,
    "__call__": _run(injects=True),
    "execute": _run(injects=False),
    "get_outcomes": listed("$outcomes"),
    "add_input_key": _add_input_key,
    **{name: noted(name) for name in ("declare_parameter", "set_parameter")},
    **dict.fromkeys(
        ("configure", "cancel_state", "set_description", "set_outcome_description",
         "add_output_key"), nothing,
    ),
}  # fmt: skip

_CONTAINER: Mapping[str, Run] = {
    **_STATE,
    **{name: noted(name) for name in
       ("add_start_cb", "add_transition_cb", "add_end_cb", "set_parameter_mappings")},
    **dict.fromkeys(("validate", "set_name", "set_sigint_handler", "cancel_state_machine"),
                    nothing),
}  # fmt: skip

_LOGS = (
    "YASMIN_LOG_ERROR YASMIN_LOG_WARN YASMIN_LOG_INFO YASMIN_LOG_DEBUG set_loggers set_log_level"
    " set_default_loggers set_py_loggers"
)


def _unknown(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return UNKNOWN


YASMIN = Framework(
    name="YASMIN",
    packages=("yasmin", "yasmin_ros", "yasmin_viewer", yasmin_runtime.NAME),
    modules={
        "yasmin": {
            **classes("yasmin", "State CbState StateMachine Concurrence OrthogonalState JoinState"),
            "Blackboard": Native("Blackboard", _blackboard),
            **dict.fromkeys(_LOGS.split(), Native("nothing", nothing)),
        },
        "yasmin_ros": {
            **classes("yasmin_ros", " ".join(_READY)),
            "set_ros_loggers": Native("nothing", nothing),
        },
        "yasmin_ros.basic_outcomes": {name: Const(text) for name, text in OUTCOMES.items()},
        "yasmin_viewer": {"YasminViewerPub": Native("YasminViewerPub", _unknown)},
        yasmin_runtime.NAME: yasmin_runtime.MODULE,
    },
    methods={
        "yasmin.State": _STATE,
        "yasmin.CbState": {**_STATE, "__init__": _callback_state},
        "yasmin.JoinState": {**_STATE, "__init__": _join_state},
        "yasmin.StateMachine": {
            **_CONTAINER,
            "__init__": _machine,
            "add_state": _add("add"),
            "set_start_state": _set_start,
        },
        "yasmin.Concurrence": {**_CONTAINER, "__init__": _concurrence(2)},
        "yasmin.OrthogonalState": {
            **_CONTAINER,
            "__init__": _concurrence(1),
            "add_region": _add("concurrence"),
        },
        **{f"yasmin_ros.{name}": {**_STATE, "__init__": _ready(*what)}
           for name, what in _READY.items()},
        **yasmin_runtime.METHODS,
    },
    containers=yasmin_runtime.CONTAINERS.union(
        ["yasmin.StateMachine", "yasmin.Concurrence", "yasmin.OrthogonalState"]
    ),
    adds=frozenset(["add_state", "add_region"]),
    overridden=frozenset(["add_state", "add_region", "execute"]),
    parameters=_PARAMETERS,
    signatures={
        "yasmin.StateMachine.add_state": signature(
            "self name state", "transitions remappings parameter_mappings"
        ),
    },
    jumps=True,
    code="yasmin",
    parts={"yasmin.JoinState": "it waits for another region of an orthogonal state"},
    one_rule=True,
    effects={
        "SM101": "YASMIN raises an exception when the machine starts: none of its states runs",
        "SM102": "`add_state` raises an exception for such a transition: the program stops",
        "SM104": "after this outcome YASMIN raises an exception: the machine stops",
        "SM106": "`add_state` raises an exception for the second one: the program stops",
        "SM201": "the state never runs; YASMIN 6.1 raises an exception when the machine starts",
        "SM202": "",
        "SM309": "YASMIN raises an exception after `execute`: the machine stops",
        "SM403": "YASMIN raises an exception when it makes the concurrence: the program stops",
    },
    works=frozenset(["SM202"]),  # an endless loop can be wanted
)  # fmt: skip
